// SPDX-License-Identifier: Apache-2.0
/// The clothes of one picture: how far they stand off the body, and the skirt, dress or coat that hangs from it.
///
/// A loose garment is a tube of cloth (geometry/cloth/loose_garment.h). Cut with each of a few pinned heights and
/// fullnesses and as long as the legs, it is let down on the bare body in the picture's pose; of each the length is
/// kept with which it covers most pixels of the person beside the bare body, pixels of nobody counted against it. The
/// best are let down again at that length, and swung: someone who moves does not wear cloth that hangs, so gravity is
/// turned in the picture's plane. The best of all is kept if it is worth it: with E the pixels in which the mask and
/// the dressed body differ, as a share of the mask,
///   E(clothes close to the skin alone) − E(with the garment) ≥ least_gain,
/// where clothes that stand off further than close_m are not close. Clothes close to the skin are fitted by
/// FitClothesOffsets(), and nothing is measured on what the garment covers. A
/// silhouette does not show slits, nor a garment that hides between the legs.
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
  bool loose = true;  ///< look for a loose garment at all; a body without SMPL's joints has none
  double least_gain = 0.006;
  double close_m = 0.05;
  double shortest_m = 0.25;      ///< of the garment, along the cloth
  double spacing_m = 0.03;       ///< of the garment's vertices
  int compared_height_px = 240;  ///< of the person in the picture that is compared, at most
  int num_threads = 1;           ///< the clothes are the same for any number
};

struct FittedClothes {
  ClothesOffsets offsets;
  LooseGarmentOptions garment = {.length_m = 0};  ///< length_m 0: none. Its heights are of the shaped body in T-pose
  double swing_rad = 0;                           ///< how far the cloth is swung in this picture (fit_clothes.h)
  double unlike_close = 0;                        ///< E of clothes close to the skin
  double unlike_loose = 0;                        ///< E with the best garment; that of the above where none was tried
};

/// `photo`: a track of one frame with a result, of the bare body. Throws std::invalid_argument as FitClothesOffsets().
FittedClothes FitClothes(const BodyModel& body, const Track& photo, const LabelImage& mask,
                         const FitClothesOptions& options = {});

/// Which of the shaped body's vertices (V×3, T-pose) the garment hides: of trunk and legs, between the pinned ring and
/// the hem. One a vertex.
std::vector<uint8_t> CoveredByGarment(const BodyModel& body, const MatrixX3d& rest_vertices,
                                      const LooseGarmentOptions& garment);

// Cloth in a picture of someone who moves: it does not hang straight down, but as if gravity were turned in the
// picture's plane.

/// Up in the camera frame of a track (render/view/floor.h), turned by the swing: cloth falls the other way.
Eigen::Vector3d SwungUp(const Track& track, double swing_rad);

/// For cloth that is looked at once and only has to hang: bodies are posed seldom, and rest soon.
ClothRunOptions HangingCloth(const Track& photo, double swing_rad);

}  // namespace bodyloom
