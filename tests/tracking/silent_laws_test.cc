// SPDX-License-Identifier: Apache-2.0
// People for whom the laws of the room do not hold: a track with ground, contacts and balance must be as good as one
// without. Feet glide, the floor gives way, or what carries the person moves.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/math/rotation.h"
#include "tests/support/clip_input.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom::silent_laws_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kFrames = 80;
constexpr double kFps = 20, kG = 9.81;

Motion Walk() { return DemoMotion(BuiltinBody(), kFrames, kFps); }

/// The first frame of the walk, which stands, in every frame; `root(t)` turns it about the pelvis and moves it.
template <typename Root>
Motion Stand(const Root& root) {
  Motion motion = Walk();
  const Vector3d rest = motion.trans.row(0).transpose();
  const Eigen::RowVectorXd pose = motion.poses.row(0);
  for (int t = 0; t < kFrames; ++t) {
    motion.poses.row(t) = pose;
    const Eigen::Isometry3d moved = root(t / kFps);
    const Matrix3d before = RotationFromAxisAngle(pose.head<3>().transpose());
    motion.poses.row(t).head<3>() = AxisAngleFromRotation(moved.linear() * before).transpose();
    motion.trans.row(t) = (rest + moved.translation()).transpose();
  }
  return motion;
}

Eigen::Isometry3d Moved(const Vector3d& by, const Matrix3d& turned = Matrix3d::Identity()) {
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.linear() = turned;
  moved.translation() = by;
  return moved;
}

/// Legs that walk on, on a body that goes back as fast: feet that seem to stand glide at twice its speed.
Motion Moonwalk() {
  Motion motion = Walk();
  const Vector3d start = motion.trans.row(0).transpose();
  for (int t = 0; t < kFrames; ++t) {
    for (const int axis : {0, 2}) motion.trans(t, axis) = 2 * start[axis] - motion.trans(t, axis);
  }
  return motion;
}

/// On a circle of 2.5 m at 2 m/s, leaning towards its middle by atan(v²/(r g)): both feet glide.
Motion Skate() {
  constexpr double kRadius = 2.5, kSpeed = 2;
  const double lean = std::atan(kSpeed * kSpeed / (kRadius * kG));
  return Stand([=](double t) {
    const double at = kSpeed * t / kRadius;
    const Vector3d out(std::cos(at), 0, std::sin(at)), along(-std::sin(at), 0, std::cos(at));
    // About the pelvis, which is some 0.9 m above the feet; these stay on the circle.
    const Matrix3d leans = RotationFromAxisAngle(lean * along);
    const Vector3d feet(0, -0.9, 0);
    return Moved(kRadius * (out - Vector3d::UnitX()) + feet - leans * feet,
                 leans * RotationFromAxisAngle(Vector3d(0, -at, 0)));
  });
}

/// The bed of a trampoline goes down by 15 cm and up again with the feet.
Motion Bounce() {
  constexpr double kRest = 0.15;
  return Stand([=](double t) { return Moved(Vector3d(0, kRest * std::sin(std::sqrt(kG / kRest) * t), 0)); });
}

/// Face down in the water, 1 m/s towards the head, rolling from side to side.
Motion Swim() {
  return Stand([](double t) {
    const Matrix3d prone = RotationFromAxisAngle(Vector3d(M_PI / 2, 0, 0));
    const Matrix3d roll = RotationFromAxisAngle(Vector3d(0, 0, 0.5 * std::sin(2 * M_PI * 0.7 * t)));
    return Moved(Vector3d(0, 0.4, t), roll * prone);
  });
}

/// Somebody who lies in another's arms at the height of the hips, and goes through the room.
Motion Carried() {
  return Stand([](double t) {
    const Matrix3d supine = RotationFromAxisAngle(Vector3d(-M_PI / 2, 0, 0));
    return Moved(Vector3d(0.8 * t, 0.1 + 0.02 * std::sin(2 * M_PI * 2 * t), 0),
                 RotationFromAxisAngle(Vector3d(0, M_PI / 2, 0)) * supine);
  });
}

TrackSequenceResult Tracked(const SynthClip& clip, const GroundOptions& ground) {
  TrackSequenceOptions options;
  options.num_threads = 2;
  options.ground = ground;
  return FitClip(KnownCameraInput(clip), options);
}

/// Mean error of all joints after a similarity a frame, and in the camera's frame, mm.
struct Errors {
  double pose_mm = 0, place_mm = 0;
};

Errors ErrorsOf(const TrackSequenceResult& result, const SynthClip& clip) {
  return {1000 * ProcrustesPositionError(result.track.joints, clip.truth.joints).frames.mean,
          1000 * MeanPositionError(result.track.joints, clip.truth.joints).frames.mean};
}

/// Errors with the laws less those without, of the same clips.
struct Differences {
  double with = 0, without = 0, squares = 0;
  int count = 0;
  void Add(double error_with, double error_without) {
    with += error_with;
    without += error_without;
    squares += std::pow(error_with - error_without, 2);
    ++count;
  }
  [[nodiscard]] double MeanWith() const { return with / count; }
  [[nodiscard]] double MeanWithout() const { return without / count; }
  [[nodiscard]] double Mean() const { return (with - without) / count; }
  [[nodiscard]] double StandardError() const { return std::sqrt((squares / count - Mean() * Mean()) / (count - 1)); }
};

struct SilentClip {
  const char* name;
  Motion (*motion)();
  bool rests;  ///< on something at times, which may be taken for a ground
};

class SilentLaws : public testing::TestWithParam<SilentClip> {};

TEST_P(SilentLaws, TheTrackIsAsGoodAsWithoutThem) {
  constexpr int kClips = 6;
  GroundOptions without;
  without.contact_weight = without.surface_weight = without.balance_weight = 0;
  Differences place_mm, pose_mm;
  for (int seed = 1; seed <= kClips; ++seed) {
    SynthClipOptions options;
    options.dense_per_frame = 0;
    options.seed = seed;
    options.camera.yaw_deg = 60 * seed;
    const SynthClip clip = MakeSynthClip(BuiltinBody(), GetParam().motion(), options);
    const TrackSequenceResult with_laws = Tracked(clip, {}), without_laws = Tracked(clip, without);
    ASSERT_TRUE(with_laws.summary.IsUsable()) << with_laws.summary.message;
    ASSERT_TRUE(without_laws.summary.IsUsable()) << without_laws.summary.message;
    const Errors with = ErrorsOf(with_laws, clip), left_out = ErrorsOf(without_laws, clip);
    // Laws move whole bodies in depth, by up to a fifth of what they are off either way in the moonwalk, where feet are
    // held rightly; a false ground doubles it and more.
    EXPECT_LT(with.place_mm, 1.3 * left_out.place_mm) << seed;
    place_mm.Add(with.place_mm, left_out.place_mm);
    pose_mm.Add(with.pose_mm, left_out.pose_mm);
    const GroundSummary& ground = with_laws.summary.ground;
    EXPECT_FALSE(ground.why.empty());
    if (!GetParam().rests) {
      EXPECT_FALSE(ground.has_plane) << ground.why;
    }
  }
  RecordProperty("place_mm", std::to_string(place_mm.MeanWith()));
  RecordProperty("place_without_laws_mm", std::to_string(place_mm.MeanWithout()));
  EXPECT_LT(place_mm.Mean(), 2 * place_mm.StandardError() + 0.01 * place_mm.MeanWithout());
  EXPECT_LT(pose_mm.Mean(), 2 * pose_mm.StandardError() + 0.01 * pose_mm.MeanWithout());
}

INSTANTIATE_TEST_SUITE_P(Clips, SilentLaws,
                         testing::Values(SilentClip{"moonwalk", &Moonwalk, true}, SilentClip{"skate", &Skate, false},
                                         SilentClip{"trampoline", &Bounce, true}, SilentClip{"swim", &Swim, false},
                                         SilentClip{"carried", &Carried, true}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace bodyloom::silent_laws_test
