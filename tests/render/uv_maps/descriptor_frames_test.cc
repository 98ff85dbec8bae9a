// SPDX-License-Identifier: Apache-2.0
#include "render/uv_maps/descriptor_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "data_tools/descriptors/describe_track.h"
#include "data_tools/formats/npz.h"
#include "tests/data_tools/descriptors/swinging_track.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::descriptor_frames_test {
namespace {

using ::testing::HasSubstr;

/// The values of the file that DescribeTrack() writes.
std::vector<float> Written(const Track& track, const DescriptorOptions& options) {
  const TemporaryFolder folder;
  DescribeTrackOptions describe;
  static_cast<DescriptorOptions&>(describe) = options;
  DescribeTrack(ToyBody(), track, folder.File("d.npy"), describe);
  return ReadNpy(folder.File("d.npy")).ToFloats();
}

DescriptorOptions Small() {
  DescriptorOptions options;
  options.texels.width = options.texels.height = 48;
  options.past = 4;
  return options;
}

/// Every kind of descriptor, over a clip with a gap that is longer than what is held at a time.
std::vector<DescriptorOptions> Kinds() {
  std::vector<DescriptorOptions> kinds(7, Small());
  kinds[1].velocity.scheme = VelocityScheme::kBackward;
  kinds[2].analytic = true;
  kinds[3].normals = false;
  kinds[4].past = 0;
  kinds[5].seen_only = true;
  kinds[5].num_threads = 2;
  kinds[6].frame = SurfaceFrame::kBody;
  kinds[6].past = 40;
  return kinds;
}

Track WithGap() {
  Track track = Swinging(50);
  for (const int t : {12, 13, 41}) {
    track.frame_status[t] = FrameStatus::kLost;
    track.motion.poses.row(t).setConstant(std::nan(""));
  }
  return track;
}

void ExpectSameBytes(const DescriptorFrames& frames, std::span<const float> planes, const std::vector<float>& written,
                     int t) {
  ASSERT_EQ(std::memcmp(planes.data(), &written[frames.frame_size() * t], frames.frame_size() * sizeof(float)), 0) << t;
}

TEST(DescriptorFrames, GivesTheBytesOfTheFileFrameByFrame) {
  const Track track = WithGap();
  for (const DescriptorOptions& options : Kinds()) {
    const std::vector<float> written = Written(track, options);
    DescriptorFrames frames(ToyBody(), track, options);
    ASSERT_EQ(frames.num_frames(), 50);
    ASSERT_EQ(frames.channels(), options.channels());
    ASSERT_EQ(frames.frame_size() * 50, written.size());
    std::vector<float> planes(frames.frame_size());
    for (int t = 0; t < 50; ++t) {
      frames.Planes(t, planes);
      ExpectSameBytes(frames, planes, written, t);
    }
  }
}

TEST(DescriptorFrames, GivesThemInAnyOrder) {
  const Track track = WithGap();
  for (const DescriptorOptions& options : Kinds()) {
    const std::vector<float> written = Written(track, options);
    DescriptorFrames frames(ToyBody(), track, options);
    std::vector<float> planes(frames.frame_size(), 7.0F);
    for (const int t : {30, 3, 49, 0, 12, 31, 31, 14, 45, 44}) {
      frames.Planes(t, planes);
      ExpectSameBytes(frames, planes, written, t);
    }
    EXPECT_FALSE(frames.HasFit(12));
    EXPECT_TRUE(frames.HasFit(14));
  }
}

TEST(DescriptorFrames, GivesSeveralAtOnce) {
  const Track track = WithGap();
  DescriptorOptions options = Small();
  options.num_threads = 3;
  const std::vector<float> written = Written(track, options);
  DescriptorFrames frames(ToyBody(), track, options);
  std::vector<int> all(50);
  std::iota(all.begin(), all.end(), 0);
  std::vector<float> planes(frames.frame_size() * all.size());
  frames.Planes(all, planes);
  EXPECT_EQ(std::memcmp(planes.data(), written.data(), written.size() * sizeof(float)), 0);
  const std::vector<int> some = {2, 17, 40};
  planes.resize(frames.frame_size() * some.size());
  DescriptorFrames moved = std::move(frames);
  moved.Planes(some, planes);
  for (size_t i = 0; i < some.size(); ++i) {
    ExpectSameBytes(moved, std::span(planes).subspan(moved.frame_size() * i, moved.frame_size()), written, some[i]);
  }
}

TEST(DescriptorFrames, RefusesWhatItDoesNotHave) {
  const Track track = Swinging(6);
  DescriptorFrames frames(ToyBody(), track, Small());
  std::vector<float> planes(frames.frame_size());
  const auto refusal = [&](const std::function<void()>& call) {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  EXPECT_THAT(refusal([&] { frames.Planes(6, planes); }), HasSubstr("frame 6"));
  EXPECT_THAT(refusal([&] { frames.Planes(-1, planes); }), HasSubstr("frame -1"));
  EXPECT_THAT(refusal([&] { frames.Planes(0, std::span(planes).first(3)); }), HasSubstr("room for 3"));
  planes.resize(2 * frames.frame_size());
  const std::vector<int> falling = {3, 2};
  EXPECT_THAT(refusal([&] { frames.Planes(falling, planes); }), HasSubstr("frame 2 after frame 3"));
  DescriptorOptions options = Small();
  options.past = -1;
  EXPECT_THAT(refusal([&] { DescriptorFrames(ToyBody(), track, options); }), HasSubstr("past is -1"));
  EXPECT_THAT(refusal([&] { DescriptorFrames(ToyBody(), Swinging(0), Small()); }), HasSubstr("no frames"));
}

}  // namespace
}  // namespace bodyloom::descriptor_frames_test
