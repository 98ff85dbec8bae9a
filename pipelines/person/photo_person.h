// SPDX-License-Identifier: Apache-2.0
/// A person from one photo or several: a body of the person's own shape, clothes included, and a whole texture for it.
/// Nothing is trained and no video is needed.
///
/// Each photo by itself: people are detected, the body is fitted to the person's landmarks and mask, clothes and hair
/// stand off as the mask says (render/person/clothes_offsets.h), and the texels of the clothed body look their colours up
/// in the picture. Photos are merged texel by texel, the one that sees it best; the first gives shape and clothes. What no
/// photo shows is guessed (render/person/whole_texture.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/track/track_request.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

struct PhotoPersonRequest {
  std::vector<std::string> images;  ///< photos of the person, at least one
  /// The body, the detector, the focal length, the person's height and how to solve; `person` is who of a photo, 0: the
  /// largest. Its video, observations and outputs are not used.
  TrackRequest fit;
  int texture_size = 1024;  ///< texels a side, 64 to 8192
};

struct PhotoPersonReport {
  struct Photo {
    std::string image;
    int width = 0, height = 0;
    int people = 0;          ///< found in it
    int rim_measured = 0;    ///< vertices of the contour at which clothes were measured
    double texels_seen = 0;  ///< share of the body's texels
  };
  std::vector<Photo> photos;
  double seen = 0, mirrored = 0, behind = 0, hair = 0, around = 0,
         spread = 0;                               ///< shares of the whole texture, by TexelSource
  double clothes_median_m = 0, clothes_max_m = 0;  ///< offsets of the body's vertices
  StageSeconds seconds;
};

struct PhotoPerson {
  std::shared_ptr<const BodyModel> body;  ///< clothed; zero betas are the person
  std::shared_ptr<const BodyModel> bare;  ///< what the photos were fitted with, whose betas follow
  Eigen::VectorXd betas;
  Image texture;
  /// Where each texel's colour is from: white seen, blue mirrored, green from behind, yellow across, brown hair, orange
  /// around, red spread, black where the atlas is empty.
  Image sources;
  std::vector<Track> tracks;  ///< a frame each, of `bare`: the person in each photo
  PhotoPersonReport report;
};

/// Throws RequestError for a request that contradicts itself, NothingToTrack naming a photo in which nobody is found or
/// could be fitted, std::runtime_error naming a file that cannot be used, Cancelled.
PhotoPerson MakePhotoPerson(const PhotoPersonRequest& request, const PipelineCallbacks& callbacks = {});

/// The motion of a track of `bare` by this person: for person.body, with zero betas. Throws std::invalid_argument for a
/// track whose camera moves, and as WithShape().
Track MovedByPerson(const PhotoPerson& person, const Track& track);

}  // namespace bodyloom
