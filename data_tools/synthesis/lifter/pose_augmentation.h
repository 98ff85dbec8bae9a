// SPDX-License-Identifier: Apache-2.0
/// Augmentation of a stretch of recorded motion, so that no two windows are alike.
#pragma once

#include <array>
#include <vector>

#include "data_tools/synthesis/lifter/lifter_clips.h"
#include "data_tools/synthesis/lifter/lifter_window_options.h"
#include "geometry/body/body_model.h"

namespace bodyloom {

/// Limits of joint turns in the form that windows need (tracking/terms/joint_limits.h).
class PoseLimits {
 public:
  explicit PoseLimits(const BodyModel& body);
  /// Knees and elbows bent the wrong way are bent the right way; then every limited joint is brought into its box.
  void Apply(PoseSequence* poses) const;

 private:
  struct Range {
    bool limited = false;
    Eigen::Array3f lower, upper;
  };
  std::array<Range, kPoseJoints> ranges_;
};

/// Picks clips with a probability proportional to √(duration): short rare clips weigh more than their length.
class ClipChoice {
 public:
  explicit ClipChoice(const std::vector<LifterClip>& clips);
  [[nodiscard]] size_t operator()(HashRandom* random) const;

 private:
  std::vector<double> up_to_;
};

/// Limbs and spine move as in other clips, sometimes as those of the other side.
void ExchangeLimbs(const std::vector<LifterClip>& clips, const ClipChoice& choice, const LifterWindowOptions& options,
                   double step_s, HashRandom random, PoseSequence* poses);

/// Squats and lunges, raised legs, kicks, raised arms, reaching, bending and leaning: each swells and fades within the
/// window.
void AddExercises(const LifterWindowOptions& options, HashRandom random, PoseSequence* poses);

/// The whole body turns about the vertical (a spin), or over, about a horizontal axis, within 0.4 to 2.5 s; it ends
/// there or, turned over, comes up again. What it stands on then is what is lowest: `clearance` stays.
void AddTurns(const LifterWindowOptions& options, HashRandom random, PoseSequence* poses);

/// Every joint turns a little more, smoothly in time: shoulders by 0.5 rad, elbows and knees 0.4, hips 0.3, root and
/// head 0.2, spine, collars and ankles 0.1 to 0.2, times a level that is uniform up to options.perturbation; the root
/// by `root` of that.
void PerturbPoses(const LifterWindowOptions& options, float share, float root_share, HashRandom random,
                  PoseSequence* poses);

}  // namespace bodyloom
