// SPDX-License-Identifier: Apache-2.0
/// A person from one photo or several: a body of the person's own shape, clothes included, and a whole texture for it.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

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

/// The motion of a track of `bare` by this person: for person.body, with zero betas. Throws std::invalid_argument for a
/// track whose camera moves, and as WithShape().
Track MovedByPerson(const PhotoPerson& person, const Track& track);

}  // namespace bodyloom
