// SPDX-License-Identifier: Apache-2.0
/// A person from one photo or several: a body of the person's own shape, clothes included, and a whole texture for it.
/// A skirt, dress or coat is cloth that hangs from the body (geometry/cloth).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/base/stopwatch.h"
#include "geometry/body/body_model.h"
#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"
#include "geometry/scene/track_edits.h"
#include "render/image/image.h"
#include "render/lighting/lit_surface.h"
#include "render/lighting/sh_lighting.h"

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
  /// Pixels in which the first photo's mask and the dressed body differ, as a share of the mask: with clothes close to
  /// the skin alone, and with the best loose garment (render/garment/fit_clothes.h).
  double unlike_close = 0, unlike_loose = 0;
  double garment_length_m = 0;  ///< of the loose garment along the cloth; 0: none
  StageSeconds seconds;
};

/// Of a photo's own light, taken away and given alike.
inline constexpr ShadingLimits kPhotoShading = {.least = 0.35, .most = 2};

/// What a person is drawn in, camera frame: the light of the first photo, whose shading has the mean 1 over the person
/// in it, unless another is set.
struct ShownLight {
  ShLighting coefficients = GreyLight(EvenLight());
  ShadingLimits limits = kPhotoShading;
};

struct PhotoPerson {
  std::shared_ptr<const BodyModel> body;  ///< clothed, the garment behind it; zero betas are the person
  /// `body` without its garment; the same where it has none.
  std::shared_ptr<const BodyModel> clothed;
  LooseGarmentOptions cut = {.length_m = 0};  ///< of the garment; length_m 0: none
  LooseGarment garment;                       ///< cut for `clothed`
  std::shared_ptr<const BodyModel> bare;      ///< what the photos were fitted with, whose betas follow
  Eigen::VectorXd betas;
  Image texture;  ///< as in even light
  ShownLight light;
  /// Where each texel's colour is from: white seen, blue mirrored, green from behind, yellow across, brown hair, orange
  /// around, red spread, black where the atlas is empty.
  Image sources;
  /// What each texel shows (PersonLabel, render/photo_avatar/texel_labels.h); empty: nobody knows.
  std::vector<uint8_t> labels;
  std::vector<Track> tracks;  ///< a frame each, of `bare`: the person in each photo
  PhotoPersonReport report;
};

/// The motion of a track of `bare` by this person: for person.body, with zero betas. Neither the photos nor the track
/// say how tall anybody is, so the person is as tall in the picture as the track's own unless `placed` says otherwise.
/// Throws std::invalid_argument for a track whose camera moves, and as WithShape().
Track MovedByPerson(const PhotoPerson& person, const Track& track, PersonPlacing placed = PersonPlacing::kInPicture);

/// Vertices of person.body in the only frame of `moved` (MovedByPerson), metres, camera frame: the garment at rest.
MatrixX3d StillVertices(const PhotoPerson& person, const Track& moved);

}  // namespace bodyloom
