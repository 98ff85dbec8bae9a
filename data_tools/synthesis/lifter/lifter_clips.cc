// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/lifter/lifter_clips.h"

#include <algorithm>
#include <cmath>

#include "data_tools/motion/motion_tools.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/track.h"

namespace bodyloom {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr double kFloorShare = 0.1;  // share of the frames in which the body reaches below its floor

// Feet of retargeted motion hover by a few centimetres; such clearances become zero, slightly larger ones are reduced.
constexpr float kHover = 0.02F, kSurelyOff = 0.08F;

struct Instant {
  int before, after;
  float part;
};

/// Reflects `time_s` into the clip.
Instant At(const LifterClip& clip, double time_s) {
  const double period = 2 * clip.duration_s;
  double t = std::fmod(time_s, period);
  if (t < 0) t += period;
  if (t > clip.duration_s) t = period - t;
  const double at = t * clip.rate;
  const int before = std::clamp(static_cast<int>(at), 0, clip.poses.num_frames - 2);
  return {before, before + 1, static_cast<float>(std::clamp(at - before, 0.0, 1.0))};
}

}  // namespace

LifterClip CompactClip(const Motion& motion, bool has_floor, const LifterBody& body) {
  CheckMotion(motion, "lifter windows");
  BODYLOOM_CHECK(motion.num_frames() >= 2, "lifter windows: a motion of ", motion.num_frames(),
                 " frames, expected at least two");
  BODYLOOM_CHECK(motion.poses.cols() >= 3 * kPoseJoints, "lifter windows: a motion of ", motion.poses.cols() / 3,
                 " joints, expected at least 24");
  BODYLOOM_CHECK(motion.up == Motion::Up::kY, "lifter windows: expected a motion with y up");
  const double rate = FrameRate(motion);
  BODYLOOM_CHECK(rate > 0, "lifter windows: expected a motion with a regular clock");
  const Motion at_rate = rate > 1.01 * kLifterClipRate ? ResampleMotion(motion, kLifterClipRate) : motion;
  LifterClip clip;
  clip.rate = rate > 1.01 * kLifterClipRate ? kLifterClipRate : rate;
  PoseSequence& poses = clip.poses;
  poses.num_frames = at_rate.num_frames();
  poses.has_floor = has_floor;
  BODYLOOM_CHECK(poses.num_frames >= 2, "lifter windows: a motion of ", motion.num_frames(), " frames at ", rate,
                 " a second, expected two at ", kLifterClipRate);
  clip.duration_s = (poses.num_frames - 1) / clip.rate;
  poses.rotations.resize(static_cast<size_t>(poses.num_frames) * kPoseJoints);
  poses.trans.resize(poses.num_frames);
  poses.clearance.assign(poses.num_frames, 0);
  const LifterPerson person = body.Person(motion.betas);
  PosedPerson posed;
  std::vector<float> lowest(poses.num_frames);
  for (int t = 0; t < poses.num_frames; ++t) {
    for (int j = 0; j < kPoseJoints; ++j) {
      const Eigen::Vector3d w = at_rate.poses.block<1, 3>(t, 3 * j);
      poses.at(t, j) = Eigen::Quaterniond(RotationFromAxisAngle(w)).cast<float>();
    }
    poses.trans[t] = at_rate.trans.row(t).cast<float>();
    body.Pose(person, &poses.at(t, 0), poses.trans[t], &posed);
    lowest[t] = body.Lowest(person, posed) / person.size;
    poses.trans[t] /= person.size;
  }
  if (!has_floor) return clip;
  std::vector<float> sorted = lowest;
  const auto low = sorted.begin() + static_cast<long>(kFloorShare * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), low, sorted.end());
  for (int t = 0; t < poses.num_frames; ++t) {
    const float height = lowest[t] - *low;
    poses.clearance[t] = height * std::clamp((height - kHover) / (kSurelyOff - kHover), 0.0F, 1.0F);
  }
  return clip;
}

void SampleClip(const LifterClip& clip, double start_s, double step_s, int num_frames, PoseSequence* poses) {
  poses->num_frames = num_frames;
  poses->has_floor = clip.poses.has_floor;
  poses->rotations.resize(static_cast<size_t>(num_frames) * kPoseJoints);
  poses->trans.resize(num_frames);
  poses->clearance.resize(num_frames);
  for (int t = 0; t < num_frames; ++t) {
    const Instant at = At(clip, start_s + t * step_s);
    for (int j = 0; j < kPoseJoints; ++j)
      poses->at(t, j) = Between(clip.poses.at(at.before, j), clip.poses.at(at.after, j), at.part);
    poses->trans[t] = (1 - at.part) * clip.poses.trans[at.before] + at.part * clip.poses.trans[at.after];
    poses->clearance[t] = (1 - at.part) * clip.poses.clearance[at.before] + at.part * clip.poses.clearance[at.after];
  }
}

void SampleJoints(const LifterClip& clip, double start_s, double step_s, const std::vector<int>& source,
                  const std::vector<int>& target, bool mirror, PoseSequence* poses) {
  for (int t = 0; t < poses->num_frames; ++t) {
    const Instant at = At(clip, start_s + t * step_s);
    for (size_t i = 0; i < source.size(); ++i) {
      const Quaternionf q = Between(clip.poses.at(at.before, source[i]), clip.poses.at(at.after, source[i]), at.part);
      poses->at(t, target[i]) = mirror ? MirrorRotation(q) : q;
    }
  }
}

void MirrorPoses(PoseSequence* poses) {
  for (int t = 0; t < poses->num_frames; ++t) {
    for (int j = 0; j < kPoseJoints; ++j) {
      const int twin = MirrorJoint(j);
      if (twin < j) continue;
      const Quaternionf own = MirrorRotation(poses->at(t, j));
      poses->at(t, j) = MirrorRotation(poses->at(t, twin));
      poses->at(t, twin) = own;
    }
    poses->trans[t].x() *= -1;
  }
}

}  // namespace bodyloom
