// SPDX-License-Identifier: Apache-2.0
/// A person made from one or several photos: a body of the person's shape with clothes, and a complete texture for it.
/// A skirt, dress or coat is simulated cloth (geometry/cloth).
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
    int rim_measured = 0;    ///< contour vertices at which the clothes' offset was measured
    double texels_seen = 0;  ///< share of the body's texels
  };
  std::vector<Photo> photos;
  double seen = 0, mirrored = 0, behind = 0, hair = 0, limb_neighbour = 0,
         smooth_fill = 0;                          ///< shares of the whole texture, by TexelSource
  double clothes_median_m = 0, clothes_max_m = 0;  ///< offsets of the body's vertices
  /// Pixels in which the first photo's mask and the dressed body differ, as a share of the mask: with clothes close to
  /// the skin alone, and with the best loose garment (render/garment/fit_clothes.h).
  double mask_error_tight = 0, mask_error_with_garment = 0;
  double garment_length_m = 0;  ///< of the loose garment along the cloth; 0: none
  StageSeconds seconds;
};

/// Limits for removing a photo's light and for applying it.
inline constexpr ShadingLimits kPhotoShading = {.minimum = 0.35, .maximum = 2};

/// Light that a person is rendered in, camera frame: that of the first photo, scaled to mean shading 1 over the person,
/// unless another is set.
struct ShownLight {
  ShLighting coefficients = GreyLight(EvenLight());
  ShadingLimits limits = kPhotoShading;
};

struct PhotoPerson {
  std::shared_ptr<const BodyModel> body;  ///< clothed, followed by the garment; zero betas give the person
  /// `body` without its garment; the same where it has none.
  std::shared_ptr<const BodyModel> clothed;
  LooseGarmentOptions cut = {.length_m = 0};  ///< of the garment; length_m 0: none
  LooseGarment garment;                       ///< cut for `clothed`
  std::shared_ptr<const BodyModel> bare;      ///< body that the photos were fitted with; `betas` are its
  Eigen::VectorXd betas;
  Image texture;  ///< as in even light
  ShownLight light;
  /// Source of each texel's colour: white seen, blue mirrored, green from behind, yellow mirrored back, brown hair,
  /// orange limb neighbour, red smooth fill, black off the atlas.
  Image sources;
  /// Label of each texel (PersonLabel, render/photo_avatar/texel_labels.h); empty: not known.
  std::vector<uint8_t> labels;
  std::vector<Track> tracks;  ///< a frame each, of `bare`: the person in each photo
  PhotoPersonReport report;
};

/// Transfers the motion of a track of `bare` to this person: a track of person.body with zero betas. Absolute height is
/// known from neither photos nor track, so the person is as tall in the image as the track's own unless `placed` says
/// otherwise. Throws std::invalid_argument for a track whose camera moves, and as WithShape().
Track MovedByPerson(const PhotoPerson& person, const Track& track, PersonPlacing placed = PersonPlacing::kInImage);

/// Vertices of person.body in the only frame of `moved` (MovedByPerson), metres, camera frame: the garment at rest.
MatrixX3d StillVertices(const PhotoPerson& person, const Track& moved);

}  // namespace bodyloom
