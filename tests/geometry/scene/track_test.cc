// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/track.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>

#include "geometry/scene/observations.h"

namespace bodyloom::track_test {
namespace {

TEST(Track, CameraOfAFrame) {
  Track track;
  track.motion.poses.setZero(3, 72);
  track.camera = MakePinhole(640, 480, 500);
  EXPECT_EQ(track.CameraAt(2).fx, 500);
  track.camera.model = CameraModel::kWeakPerspective;
  EXPECT_THROW((void)track.CameraAt(0), std::invalid_argument);  // no rows in weak_camera
  track.weak_camera.resize(3, 3);
  track.weak_camera << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  EXPECT_EQ(track.CameraAt(1).scale, 4);
  EXPECT_EQ(track.CameraAt(1).tx, 5);
  EXPECT_EQ(track.CameraAt(2).ty, 9);
  EXPECT_EQ(track.CameraAt(2).cx, 319.5);
  EXPECT_THROW((void)track.CameraAt(3), std::invalid_argument);
  EXPECT_THROW((void)track.CameraAt(-1), std::invalid_argument);
}

TEST(Track, StatusNamesDiffer) {
  std::set<std::string> names;
  for (int status = 0; status < 4; ++status) names.insert(ToString(static_cast<FrameStatus>(status)));
  EXPECT_EQ(names, (std::set<std::string>{"tracked", "weak", "interpolated", "lost"}));
}

TEST(Observations, CocoNames) {
  ASSERT_EQ(CocoNames().size(), 17u);
  EXPECT_EQ(CocoNames()[0], "nose");
  EXPECT_EQ(CocoNames()[5], "left_shoulder");
  EXPECT_EQ(CocoNames()[16], "right_ankle");
}

}  // namespace
}  // namespace bodyloom::track_test
