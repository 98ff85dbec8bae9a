// SPDX-License-Identifier: Apache-2.0
#include "render/uv_maps/live_descriptors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "geometry/uv_maps/surface_velocity.h"
#include "render/uv_maps/descriptor_frames.h"
#include "tests/data_tools/descriptors/swinging_track.h"

namespace bodyloom::live_descriptors_test {
namespace {

using ::testing::HasSubstr;

LiveDescriptorsOptions Small(int past) {
  LiveDescriptorsOptions options;
  options.texels.width = options.texels.height = 48;
  options.past = past;
  return options;
}

/// Backward differences of a whole track.
DescriptorOptions Same(const LiveDescriptorsOptions& live) {
  DescriptorOptions options;
  options.texels = live.texels;
  options.past = live.past;
  options.normals = live.normals;
  options.velocity.scheme = VelocityScheme::kBackward;
  options.velocity.longest_step_s = live.longest_step_s;
  return options;
}

TEST(LiveDescriptors, AreThoseOfTheTrackByBackwardDifferences) {
  Track track = Swinging(40);
  track.frame_status[12] = FrameStatus::kLost;
  track.motion.poses.row(12).setConstant(std::nan(""));
  for (int t = 25; t < 40; ++t) track.motion.timestamps[t] += 0.5;  // nothing came for half a second
  const auto poses = PosesInFrame(ToyBody(), track, SurfaceFrame::kCamera);
  for (const int past : {0, 1, 4}) {
    const LiveDescriptorsOptions options = Small(past);
    LiveDescriptors live(ToyBody(), options);
    DescriptorFrames whole(ToyBody(), track, Same(options));
    ASSERT_EQ(live.frame_size(), whole.frame_size());
    ASSERT_EQ(live.channels(), whole.channels());
    std::vector<float> planes(live.frame_size(), 7.0F), expected(live.frame_size());
    const size_t map = 3 * 48 * 48;
    for (int t = 0; t < 40; ++t) {
      live.Push(track.motion.timestamps[t], poses[t] ? &*poses[t] : nullptr, track.motion.betas, planes);
      whole.Planes(t, expected);
      // The first frame of a run looks forward in a whole track, and is at rest in a live one.
      for (const int first : {0, 13, 25}) {
        const int k = t - first;
        if (k < 0 || k >= past || (first == 0 && t >= 12) || (first == 13 && t >= 25)) continue;
        std::fill_n(expected.begin() + static_cast<std::ptrdiff_t>(map * (1 + k)), map, 0.0F);
      }
      ASSERT_EQ(std::memcmp(planes.data(), expected.data(), planes.size() * sizeof(float)), 0) << past << " " << t;
    }
  }
}

TEST(LiveDescriptors, AChangeOfShapeIsNoMotion) {
  LiveDescriptors live(ToyBody(), Small(2));
  std::vector<float> planes(live.frame_size());
  const BodyPose pose = PoseFromAxisAngle(ToyBody(), Eigen::VectorXd::Zero(72), Eigen::Vector3d(0, 0, 2));
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(1);
  live.Push(0, &pose, betas, planes);
  betas[0] = 2;
  live.Push(0.03, &pose, betas, planes);
  float fastest = 0, normals = 0;
  for (size_t i = 0; i < planes.size(); ++i) {
    (i < size_t{3 * 48 * 48} ? normals : fastest) += std::abs(planes[i]);
  }
  EXPECT_EQ(fastest, 0);
  EXPECT_GT(normals, 100);
}

TEST(LiveDescriptors, RefusalsChangeNothing) {
  const Track track = Swinging(6);
  const auto poses = PosesInFrame(ToyBody(), track, SurfaceFrame::kCamera);
  LiveDescriptors live(ToyBody(), Small(3)), other(ToyBody(), Small(3));
  std::vector<float> planes(live.frame_size()), undisturbed(live.frame_size());
  const auto refusal = [&](const std::function<void()>& call) {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  for (int t = 0; t < 6; ++t) {
    const double now = track.motion.timestamps[t];
    live.Push(now, &*poses[t], track.motion.betas, planes);
    other.Push(now, &*poses[t], track.motion.betas, undisturbed);
    ASSERT_EQ(planes, undisturbed);
    EXPECT_THAT(refusal([&] { live.Push(now, &*poses[t], track.motion.betas, planes); }), HasSubstr("a later one"));
    EXPECT_THAT(refusal([&] { live.Push(std::nan(""), nullptr, {}, planes); }), HasSubstr("a later one"));
    BodyPose bad = *poses[t];
    bad.trans[1] = std::nan("");
    EXPECT_THAT(refusal([&] { live.Push(now + 0.01, &bad, {}, planes); }), HasSubstr("not finite"));
    bad.rotations.pop_back();
    EXPECT_THAT(refusal([&] { live.Push(now + 0.01, &bad, {}, planes); }), HasSubstr("23 joints"));
    EXPECT_THAT(refusal([&] { live.Push(now + 0.01, nullptr, {}, std::span(planes).first(2)); }), HasSubstr("room"));
    EXPECT_THAT(refusal([&] { live.Push(now + 0.01, &*poses[t], Eigen::VectorXd::Zero(99), planes); }),
                HasSubstr("99"));
  }
  LiveDescriptorsOptions options = Small(3);
  options.longest_step_s = 0;
  EXPECT_THAT(refusal([&] { LiveDescriptors(ToyBody(), options); }), HasSubstr("longest_step_s"));
  options = Small(-1);
  EXPECT_THAT(refusal([&] { LiveDescriptors(ToyBody(), options); }), HasSubstr("past is -1"));
}

}  // namespace
}  // namespace bodyloom::live_descriptors_test
