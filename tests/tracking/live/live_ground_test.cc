// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "geometry/math/rotation.h"
#include "tests/support/toy_body.h"

namespace bodyloom::live_ground_test {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 1.0 / 30;

/// Somebody who stands 4 m before a camera `height_m` above the ground that looks down by `pitch`, and shifts from
/// place to place with feet apart: frame t.
struct Walk {
  double pitch_rad = 0.2, height_m = 1.4;

  [[nodiscard]] Vector3d Up() const { return RotationFromAxisAngle({pitch_rad, 0, 0}) * -Vector3d::UnitY(); }
  /// J×3, camera frame: all joints over the ankles, which stand kAnkleHeight above the ground.
  [[nodiscard]] MatrixX3d Joints(int t) const {
    const Vector3d up = Up(), right = Vector3d::UnitX(), ahead = right.cross(up).normalized();
    const double shift = 0.8 * std::floor(t / 45) - 1;  // stands for a second and a half each time
    MatrixX3d joints(24, 3);
    for (int j = 0; j < 24; ++j) {
      const bool is_left = j == 7 || j == 10;
      const double above = j == 7 || j == 8 ? kAnkleHeight : j == 10 || j == 11 ? 0.05 : 1;
      const Vector3d foot = (is_left ? 0.15 : -0.15) * right + 0.3 * shift * right + (4 + 0.4 * shift) * -ahead;
      joints.row(j) = ((above - height_m) * up + foot).transpose();
    }
    return joints;
  }
  [[nodiscard]] LiveFrame Frame(int t, bool standing) const {
    LiveFrame frame;
    frame.index = t;
    frame.timestamp = t * kStep_s;
    frame.status = FrameStatus::kTracked;
    if (standing) frame.standing = {Up(), 0.05, {0.9, 0.9}};
    return frame;
  }
};

TEST(LiveGround, IsWhereTheFeetStand) {
  const Walk walk;
  LiveGround ground(ToyBody());
  for (int t = 0; t < 300; ++t) ground.Add(walk.Frame(t, true), walk.Joints(t));
  EXPECT_EQ(ground.world().source, WorldSource::kGround);
  EXPECT_NEAR(ground.world().camera_height_m(), 1.4, 0.02);
  EXPECT_LT((ground.world().up_in_camera() - walk.Up()).norm(), 0.03);
  EXPECT_TRUE(std::isfinite(ground.world().height_sigma_m));
}

TEST(LiveGround, LiesUnderTheLowestJointUntilItIsFound) {
  const Walk walk;
  LiveGround ground(ToyBody());
  const WorldFrame first = ground.Add(walk.Frame(0, true), walk.Joints(0));
  EXPECT_EQ(first.source, WorldSource::kVertical);
  EXPECT_LT((first.up_in_camera() - walk.Up()).norm(), 1e-9);
  LiveGround without_lifter(ToyBody());
  EXPECT_EQ(without_lifter.Add(walk.Frame(0, false), walk.Joints(0)).source, WorldSource::kLevelCamera);
  LiveFrame lost = walk.Frame(1, true);
  lost.status = FrameStatus::kLost;
  EXPECT_EQ(without_lifter.Add(lost, MatrixX3d()).source, WorldSource::kLevelCamera);
}

TEST(LiveGround, MovesWithoutJumps) {
  // The camera is put down elsewhere after five seconds.
  const Walk before, after = {-0.1, 0.9};
  LiveGround ground(ToyBody(), 4);
  double last = 0;
  for (int t = 0; t < 600; ++t) {
    const Walk& walk = t < 150 ? before : after;
    const double height = ground.Add(walk.Frame(t, true), walk.Joints(t)).camera_height_m();
    EXPECT_TRUE(t == 0 || std::abs(height - last) < 0.5 * kStep_s * 1.5) << t;
    last = height;
  }
  EXPECT_NEAR(last, 0.9, 0.03);
  EXPECT_LT((ground.world().up_in_camera() - after.Up()).norm(), 0.05);
}

TEST(LiveGround, RefusesNoTime) { EXPECT_THROW(LiveGround(ToyBody(), 0), std::invalid_argument); }

}  // namespace
}  // namespace bodyloom::live_ground_test
