// SPDX-License-Identifier: Apache-2.0
/// Fits the clothes of one image: their offsets from the body, and a skirt, dress or coat.
///
/// A loose garment is a tube of cloth (geometry/cloth/loose_garment.h). Garments of a few pinned heights and
/// fullnesses, as long as the legs, are simulated on the bare body in the image's pose; each is shortened to the length
/// that maximises the person's pixels it covers beside the bare body minus the background pixels it covers. The best
/// are simulated again at that length, with gravity rotated in the image plane, because cloth of a moving person does
/// not hang straight down. The best of all is kept if, with E the pixels in which the mask and the dressed body differ,
/// as a share of the mask,
///   E(clothes close to the skin alone) − E(with the garment) ≥ min_gain,
/// where offsets beyond close_m do not count as close to the skin. Clothes close to the skin are fitted by
/// FitClothesOffsets(), without measurements where the garment covers the body. A silhouette shows neither slits nor a
/// garment hidden between the legs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_run.h"
#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"
#include "render/garment/clothes_offsets.h"

namespace bodyloom {

struct FitClothesOptions {
  ClothesOffsetOptions offsets;
  bool loose = true;  ///< search for a loose garment; a body without SMPL's joints has none
  double min_gain = 0.006;
  double close_m = 0.05;
  double shortest_m = 0.25;      ///< of the garment, along the cloth
  double spacing_m = 0.03;       ///< of the garment's vertices
  int compared_height_px = 240;  ///< maximum height of the person in the compared image
  int num_threads = 1;           ///< the clothes are the same for any number
};

struct FittedClothes {
  ClothesOffsets offsets;
  LooseGarmentOptions garment = {.length_m = 0};  ///< length_m 0: none. Heights are of the shaped body in T-pose
  double swing_rad = 0;                           ///< rotation of gravity in the image plane
  double mask_error_tight = 0;                    ///< E of clothes close to the skin
  double mask_error_with_garment = 0;             ///< E with the best garment, or mask_error_tight
};

/// `photo`: a track of one frame with a result, of the bare body. Throws std::invalid_argument as FitClothesOffsets().
FittedClothes FitClothes(const BodyModel& body, const Track& photo, const LabelImage& mask,
                         const FitClothesOptions& options = {});

/// Vertices of the shaped body (V×3, T-pose) that the garment hides: those of trunk and legs between the pinned ring
/// and the hem. One value per vertex, 1 if hidden.
std::vector<uint8_t> CoveredByGarment(const BodyModel& body, const MatrixX3d& rest_vertices,
                                      const LooseGarmentOptions& garment);

/// Upward direction in the camera frame of a track (render/view/floor.h), rotated in the image plane by the swing;
/// gravity acts along its opposite.
Eigen::Vector3d SwungUp(const Track& track, double swing_rad);

/// Simulation options for a static image: few body poses, and cloth that settles quickly.
ClothRunOptions HangingCloth(const Track& photo, double swing_rad);

}  // namespace bodyloom
