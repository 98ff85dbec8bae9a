// SPDX-License-Identifier: Apache-2.0
/// Augmentation of recorded motion for training windows.
#pragma once

#include <array>
#include <vector>

#include "data_tools/synthesis/lifter/lifter_body.h"
#include "data_tools/synthesis/lifter/lifter_window_options.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

// Motions in compact form, sampled at any speed.

/// A motion at about kLifterClipRate frames a second.
struct LifterClip {
  double rate = 0, duration_s = 0;
  PoseSequence poses;
};

inline constexpr double kLifterClipRate = 60;  ///< faster motions are resampled to it

/// `motion`: 24 or more joints, y up, on a flat floor when has_floor. The floor's height is measured with this body
/// (sources differ in the pelvis' height): the 10th percentile of the heights of the body's lowest point. Clearances up
/// to 2 cm become 0, those from 8 cm on are kept. Throws std::invalid_argument with the reason when the motion cannot
/// be used (inconsistent arrays, non-finite values, y not up, irregular or missing timestamps, one frame).
LifterClip CompactClip(const Motion& motion, bool has_floor, const LifterBody& body);

/// Frames at start_s + i·step_s; beyond the clip's ends time is reflected.
void SampleClip(const LifterClip& clip, double start_s, double step_s, int num_frames, PoseSequence* poses);

/// The same for the listed joints alone, written into `poses` (which has frames already): target[i] takes the rotations
/// of source[i], mirrored when requested.
void SampleJoints(const LifterClip& clip, double start_s, double step_s, const std::vector<int>& source,
                  const std::vector<int>& target, bool mirror, PoseSequence* poses);

/// Mirrors left and right: x → −x.
void MirrorPoses(PoseSequence* poses);

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
