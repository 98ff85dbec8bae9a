// SPDX-License-Identifier: Apache-2.0
/// Augmentation of recorded motion for training windows.
#pragma once

#include <array>
#include <vector>

#include "data_tools/synthesis/lifter/lifter_clips.h"
#include "data_tools/synthesis/lifter/lifter_window_options.h"
#include "geometry/body/body_model.h"

namespace bodyloom {

/// Limits of joint rotations for PoseSequence (tracking/terms/joint_limits.h).
class PoseLimits {
 public:
  explicit PoseLimits(const BodyModel& body);
  /// Inverts knees and elbows that are bent the wrong way, then clamps every limited joint to its box.
  void Apply(PoseSequence* poses) const;

 private:
  struct Range {
    bool limited = false;
    Eigen::Array3f lower, upper;
  };
  std::array<Range, kPoseJoints> ranges_;
};

/// Picks clips with a probability proportional to √(duration): short clips weigh more than by their length.
class ClipChoice {
 public:
  explicit ClipChoice(const std::vector<LifterClip>& clips);
  [[nodiscard]] size_t operator()(HashRandom* random) const;

 private:
  std::vector<double> up_to_;
};

/// Replaces the motion of limbs and spine by that of other clips, sometimes of the other side.
void ExchangeLimbs(const std::vector<LifterClip>& clips, const ClipChoice& choice, const LifterWindowOptions& options,
                   double step_s, HashRandom random, PoseSequence* poses);

/// Adds squats and lunges, raised legs, kicks, raised arms, reaching, bending and leaning, each fading in and out
/// within the window.
void AddExercises(const LifterWindowOptions& options, HashRandom random, PoseSequence* poses);

/// Rotates the whole body about the vertical (a spin) or about a horizontal axis (a tumble) within 0.4 to 2.5 s; after
/// a tumble it may come up again. `clearance` is kept, so it stands on its lowest point.
void AddTurns(const LifterWindowOptions& options, HashRandom random, PoseSequence* poses);

/// Adds smooth random rotations to every joint: shoulders by 0.5 rad, elbows and knees 0.4, hips 0.3, root and head
/// 0.2, spine, collars and ankles 0.1 to 0.2, times a level that is uniform up to options.perturbation; the root by
/// `root` of that.
void PerturbPoses(const LifterWindowOptions& options, float share, float root_share, HashRandom random,
                  PoseSequence* poses);

}  // namespace bodyloom
