// SPDX-License-Identifier: Apache-2.0
#include "render/garment/person_cloth.h"

#include <utility>

#include "geometry/base/check.h"
#include "geometry/cloth/cloth_run.h"
#include "render/garment/fit_clothes.h"
#include "render/view/overlay.h"

namespace bodyloom {
namespace {

constexpr double kRestDamping = 4;  ///< 1/s

/// Frames without a pose get that of the frame before; leading ones that of the first frame with a pose.
Motion WithoutGaps(Motion motion) {
  int first = 0;
  while (first < motion.num_frames() && !motion.HasPose(first)) ++first;
  BODYLOOM_CHECK(first < motion.num_frames(), "a garment's motion: no frame has a pose");
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (motion.HasPose(t)) continue;
    const int from = t < first ? first : t - 1;
    motion.poses.row(t) = motion.poses.row(from).eval();
    motion.trans.row(t) = motion.trans.row(from).eval();
  }
  return motion;
}

/// More damping while settling than for datasets, as this runs interactively: undamped cloth swings for seconds,
/// without relation to the motion.
ClothRunOptions OptionsFor(const Track& track, const PersonClothOptions& shown) {
  ClothRunOptions options;
  options.up = SwungUp(track, shown.swing_rad);
  options.tick_s = 1.0 / 30;
  options.move_in_s = 0.8;
  options.settle_s = 0.8;
  options.rest_damping = kRestDamping;
  options.cloth = PerturbedOptions(options.cloth, shown.run);
  return options;
}

}  // namespace

LooseGarment CutGarment(const BodyModel& clothed, LooseGarmentOptions* cut) {
  constexpr uint64_t kSeed = 1;  // of the initial wrinkles
  LooseGarment garment = ClothCollisionBody(clothed, Eigen::VectorXd(), {}).Cut(*cut, kSeed);
  cut->columns = garment.columns;
  return garment;
}

PersonCloth::PersonCloth(const BodyModel& clothed, const LooseGarment& garment, const Track& moved,
                         const PersonClothOptions& options) {
  if (garment.empty()) return;
  wearer_.emplace(clothed, moved.motion.betas, std::vector<double>());
  wearer_->Wear(garment);
  run_.emplace(*wearer_, WithoutGaps(moved.motion), OptionsFor(moved, options));
}

const std::vector<Eigen::Vector3d>& PersonCloth::At(int t) {
  BODYLOOM_CHECK(t >= last_, "a garment's frame ", t, " was requested after frame ", last_);
  for (; run_ && last_ < t; ++last_) cloth_ = run_->Next();
  return cloth_;
}

}  // namespace bodyloom
