// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/person_frames.h"
#include "render/uv_maps/posed_track.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/descriptors/describe_track.h"
#include "data_tools/formats/npz.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "render/raster/visibility_buffer.h"
#include "tests/support/short_track.h"

namespace bodyloom::person_frames_test {
namespace {

namespace fs = std::filesystem;

PersonFramesOptions Small() {
  PersonFramesOptions options;
  options.uv_size = 32;
  options.past = 4;
  options.window.max_side = 96;
  return options;
}

std::vector<float> Maps(const PersonFrames& frames, int t) {
  std::vector<float> maps(size_t(frames.channels()) * 32 * 32);
  frames.MotionMaps(t, maps);
  return maps;
}

TEST(ScaleToSize, LeavesImagesOfNearlyTheSameSizeAlone) {
  EXPECT_EQ(ScaleToSize(46.9, 46.67), 1);  // two clips of one camera
  EXPECT_EQ(ScaleToSize(98.1, 100), 1);
  EXPECT_NEAR(ScaleToSize(97, 100), 0.97, 1e-12);
  EXPECT_NEAR(ScaleToSize(103, 100), 1.03, 1e-12);
  EXPECT_NEAR(ScaleToSize(60, 120), 0.5, 1e-12);
}

TEST(PersonFrames, MapsAreTheDescriptorsOfTheTrack) {
  const Track track = ShortTrack();
  const PersonFrames frames(BuiltinBody(), track, Small());
  ASSERT_EQ(frames.channels(), 15);
  DescribeTrackOptions options;
  options.texels.width = options.texels.height = 32;
  options.past = 4;
  const std::string path = (fs::path(::testing::TempDir()) / "person_frames.npy").string();
  DescribeTrack(BuiltinBody(), track, path, options);
  const std::vector<float> expected = ReadNpy(path).ToFloats();
  const size_t map = 3 * 32 * 32, record = 5 * map;
  for (int t = 0; t < track.num_frames(); ++t) {
    const std::vector<float> maps = Maps(frames, t);
    for (size_t i = 0; i < record; ++i) {
      const float scale = i < map ? 1.0F : static_cast<float>(1 / PersonFrames::kBodyLength);
      const float value = std::clamp(scale * expected[record * t + i], -5.0F, 5.0F);
      // Half precision: 11 bits.
      ASSERT_NEAR(maps[i], value, 1e-3F * std::abs(value) + 1e-6F) << "frame " << t << ", value " << i;
    }
  }
  EXPECT_FALSE(fs::exists(fs::path(::testing::TempDir()) / "motion_maps_0.npy"));
}

TEST(PersonFrames, ATurnedViewTurnsMotionAndImage) {
  const Track track = ShortTrack();
  PersonFramesOptions options = Small();
  const PersonFrames plain(BuiltinBody(), track, options);
  options.yaw_deg.assign(track.num_frames(), 0);
  const PersonFrames same(BuiltinBody(), track, options);
  options.yaw_deg.assign(track.num_frames(), 90);
  const PersonFrames turned(BuiltinBody(), track, options);
  const int t = 7;
  EXPECT_EQ(Maps(same, t), Maps(plain, t));
  const std::vector<float> before = Maps(plain, t), after = Maps(turned, t);
  const size_t texels = 32 * 32;
  double moved = 0;
  for (size_t map = 0; map < 5; ++map) {
    for (size_t i = 0; i < texels; ++i) {
      const auto at = [&](const std::vector<float>& maps, int c) { return maps[(3 * map + c) * texels + i]; };
      // 90° about y (down): x takes the place of z, z of −x.
      ASSERT_NEAR(at(after, 0), at(before, 2), 1e-5);
      ASSERT_NEAR(at(after, 1), at(before, 1), 1e-5);
      ASSERT_NEAR(at(after, 2), -at(before, 0), 1e-5);
      moved += std::abs(at(after, 0) - at(before, 0));
    }
  }
  EXPECT_GT(moved, 10);
}

/// The same person, through a camera that pans by 3° a frame about its own centre.
Track SeenByAPanningCamera(const Track& track) {
  Track panned = track;
  const Eigen::Vector3d rest_root = BuiltinBody().RestJoints(track.motion.betas).row(0);
  for (int t = 0; t < track.num_frames(); ++t) {
    const Eigen::Matrix3d pan = Eigen::AngleAxisd(0.05 * t, Eigen::Vector3d::UnitY()).toRotationMatrix();
    panned.motion.poses.row(t).head<3>() =
        AxisAngleFromRotation(pan * RotationFromAxisAngle(track.motion.poses.row(t).head<3>().transpose()));
    panned.motion.trans.row(t) = pan * (rest_root + track.motion.trans.row(t).transpose()) - rest_root;
  }
  return panned;
}

TEST(PersonFrames, ACameraThatMovesIsNoMotionInTheBodysAxes) {
  const Track track = ShortTrack(), panned = SeenByAPanningCamera(track);
  PersonFramesOptions options = Small();
  const auto largest_difference = [&](SurfaceFrame frame) {
    options.motion.frame = frame;
    const PersonFrames still(BuiltinBody(), track, options), moving(BuiltinBody(), panned, options);
    const std::vector<float> a = Maps(still, 4), b = Maps(moving, 4);
    float largest = 0;
    for (size_t i = 3 * 32 * 32; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
  };
  EXPECT_LT(largest_difference(SurfaceFrame::kBody), 2e-3);
  EXPECT_GT(largest_difference(SurfaceFrame::kCamera), 0.3) << "the camera hardly moves";
}

TEST(PersonFrames, AxesAndVelocitiesAreThoseRequested) {
  const Track track = ShortTrack();
  PersonFramesOptions options = Small();
  const std::vector<float> by_default = Maps(PersonFrames(BuiltinBody(), track, options), 5);
  SetVelocity("backward", &options.motion);
  options.motion.frame = SurfaceFrame::kWorld;
  options.motion.camera_pose = LevelCamera();
  const PersonFrames frames(BuiltinBody(), track, options);
  const std::vector<float> world = Maps(frames, 5);
  DescriptorOptions expected_options;
  static_cast<SurfaceMotion&>(expected_options) = options.motion;
  expected_options.texels.width = expected_options.texels.height = 32;
  expected_options.past = 4;
  DescriptorFrames expected(BuiltinBody(), track, expected_options);
  std::vector<float> planes(expected.frame_size());
  expected.Planes(5, planes);
  const size_t map = 3 * 32 * 32;
  double off_default = 0;
  for (size_t i = 0; i < world.size(); ++i) {
    const float value = planes[i] * (i < map ? 1.0F : static_cast<float>(1 / PersonFrames::kBodyLength));
    ASSERT_NEAR(world[i], value, 1e-3F * std::abs(value) + 1e-6F) << i;
    off_default += std::abs(world[i] - by_default[i]);
  }
  EXPECT_GT(off_default, 100);
  // A view turned by 90°: the world's y is up, so x takes the place of −z there.
  options.yaw_deg.assign(track.num_frames(), 90);
  const std::vector<float> turned = Maps(PersonFrames(BuiltinBody(), track, options), 5);
  options.motion.frame = SurfaceFrame::kBody;
  const std::vector<float> body_turned = Maps(PersonFrames(BuiltinBody(), track, options), 5);
  options.yaw_deg.clear();
  EXPECT_EQ(Maps(PersonFrames(BuiltinBody(), track, options), 5), body_turned) << "body axes know of no view";
  for (size_t i = 0; i < 32 * 32; ++i) {
    ASSERT_NEAR(turned[i], -world[2 * 32 * 32 + i], 1e-5);
    ASSERT_NEAR(turned[32 * 32 + i], world[32 * 32 + i], 1e-5);
    ASSERT_NEAR(turned[2 * 32 * 32 + i], world[i], 1e-5);
  }
}

TEST(SurfaceMotion, NamesAreThoseOfTheCommand) {
  SurfaceMotion motion;
  for (const std::string& name : VelocityNames()) {
    SetVelocity(name, &motion);
    EXPECT_EQ(VelocityName(motion), name);
  }
  for (const std::string& name : SurfaceFrameNames()) EXPECT_EQ(ToString(SurfaceFrameNamed(name)), name);
  EXPECT_THROW(SetVelocity("forward", &motion), std::invalid_argument);
  EXPECT_THROW(SurfaceFrameNamed("ground"), std::invalid_argument);
}

TEST(PersonFrames, PixelsShowTheBodyWhereItIs) {
  const Track track = ShortTrack();
  const PersonFrames frames(BuiltinBody(), track, Small());
  const PersonWindow& window = frames.window();
  const size_t area = size_t(window.width) * window.height;
  std::vector<float> uv(2 * area), mask(area);
  frames.BodyMaps(3, uv, mask);
  const BodyPose pose =
      PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(3).transpose(), track.motion.trans.row(3).transpose());
  VisibilityBuffer buffer;
  buffer.Render(PoseVertices(BuiltinBody(), track.motion.betas, pose), BuiltinBody().data().faces,
                CameraInWindow(track.CameraAt(3), window, 3));
  int covered = 0;
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      const size_t i = size_t(y) * window.width + x;
      ASSERT_EQ(mask[i] == 1, buffer.FaceAt(x, y) >= 0);
      covered += mask[i] == 1;
      ASSERT_EQ(uv[i] != 0 || uv[area + i] != 0, mask[i] == 1);
      ASSERT_TRUE(uv[i] >= 0 && uv[i] <= 1 && uv[area + i] >= 0 && uv[area + i] <= 1);
    }
  }
  EXPECT_GT(covered, static_cast<int>(area) / 12);
  EXPECT_GT(window.scale_y * PixelsPerMetre(BuiltinBody(), track), 20);
}

TEST(PersonFrames, TheSurfaceOfAPixelIsThatOfTheBodyThere) {
  const Track track = ShortTrack();
  const PersonFrames frames(BuiltinBody(), track, Small());
  const BodySurface surface = frames.Surface(3);
  const size_t area = size_t(frames.window().width) * frames.window().height;
  ASSERT_EQ(surface.parts.size(), area);
  std::vector<float> uv(2 * area), mask(area);
  frames.BodyMaps(3, uv, mask);
  const Camera camera = CameraInWindow(track.CameraAt(3), frames.window(), 3);
  VisibilityBuffer buffer;
  const MatrixX3d vertices = PosedTrack(BuiltinBody(), track).Vertices(3);
  const MatrixX3i& faces = BuiltinBody().data().faces;
  buffer.Render(vertices, faces, camera);
  int alike = 0, shown = 0;
  for (size_t i = 0; i < area; ++i) {
    ASSERT_EQ(surface.parts[i] != 0, mask[i] == 1);
    const Eigen::Vector3d n(surface.normals[i], surface.normals[area + i], surface.normals[2 * area + i]);
    if (mask[i] == 0) {
      ASSERT_EQ(n.norm(), 0);
      continue;
    }
    ASSERT_NEAR(n.norm(), 1, 1e-5);
    const int face = buffer.FaceAt(static_cast<int>(i % surface.width), static_cast<int>(i / surface.width));
    ASSERT_EQ(surface.parts[i], BuiltinBody().data().face_part[face]);
    const Eigen::Vector3d a = vertices.row(faces(face, 0)), b = vertices.row(faces(face, 1)),
                          c = vertices.row(faces(face, 2));
    ++shown;
    alike += n.dot((b - a).cross(c - a).normalized()) > 0.9 ? 1 : 0;
  }
  EXPECT_GT(shown, 500);
  EXPECT_GT(alike, 0.95 * shown) << "of the face, but for what is smoothed over creases";
}

TEST(PersonFrames, LostFramesAreEmptyAndNothingReachesAcrossThem) {
  Track track = ShortTrack();
  track.motion.poses.row(5).setConstant(std::nan(""));
  track.motion.trans.row(5).setConstant(std::nan(""));
  track.frame_status[5] = FrameStatus::kLost;
  const PersonFrames frames(BuiltinBody(), track, Small());
  const std::vector<float> lost = Maps(frames, 5), next = Maps(frames, 7);
  const std::vector<uint8_t> parts = frames.Surface(5).parts;
  EXPECT_TRUE(std::all_of(parts.begin(), parts.end(), [](uint8_t part) { return part == 0; }));
  EXPECT_TRUE(std::all_of(lost.begin(), lost.end(), [](float v) { return v == 0; }));
  const size_t map = 3 * 32 * 32;
  // Frame 7 may look back to frame 6, not beyond the gap.
  EXPECT_TRUE(std::any_of(next.begin() + map, next.begin() + 2 * map, [](float v) { return v != 0; }));
  EXPECT_TRUE(std::all_of(next.begin() + 3 * map, next.end(), [](float v) { return v == 0; }));
  for (const float v : next) ASSERT_TRUE(std::isfinite(v));
  EXPECT_EQ(frames.Segment(4), frames.Segment(0));
  EXPECT_EQ(frames.Segment(5), -1);
  EXPECT_NE(frames.Segment(6), frames.Segment(4));
  EXPECT_EQ(frames.Segment(7), frames.Segment(6));
  EXPECT_EQ(frames.window().corner[5], frames.window().corner[4]);
}

TEST(PersonFrames, RefusesTheWrongSizes) {
  const Track track = ShortTrack();
  const PersonFrames frames(BuiltinBody(), track, Small());
  std::vector<float> small(3);
  EXPECT_THROW(frames.MotionMaps(0, small), std::invalid_argument);
  EXPECT_THROW(frames.BodyMaps(0, small, small), std::invalid_argument);
  PersonFramesOptions options = Small();
  options.yaw_deg = {1, 2};
  EXPECT_THROW(PersonFrames(BuiltinBody(), track, options), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::person_frames_test
