// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/describe_track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/data_tools/descriptors/swinging_track.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/toy_body.h"

namespace bodyloom::describe_track_test {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

DescribeTrackOptions Small() {
  DescribeTrackOptions options;
  options.texels.width = options.texels.height = 48;
  options.past = 4;
  return options;
}

struct Described {
  NdArray array;
  std::vector<float> values;
  nlohmann::json header;
  DescribeTrackSummary summary;
  std::string bytes;
  [[nodiscard]] float at(int t, int c, int p) const {
    return values[(size_t(t) * array.shape[1] + c) * array.shape[2] * array.shape[3] + p];
  }
};

Described Describe(const Track& track, const DescribeTrackOptions& options) {
  const TemporaryFolder folder;
  const std::string path = folder.File("d.npy");
  Described result;
  result.summary = DescribeTrack(ToyBody(), track, path, options);
  result.bytes = ReadFileBytes(path);
  result.array = ReadNpyBytes(result.bytes, path);
  result.values = result.array.ToFloats();
  result.header = nlohmann::json::parse(ReadFileBytes(folder.File("d.json")));
  for (const float x : result.values) {
    if (!std::isfinite(x)) {
      ADD_FAILURE() << "a value is not finite";
      break;
    }
  }
  return result;
}

TEST(DescribeTrack, HoldsNormalsAndVelocitiesOfThePosedSurface) {
  const BodyModel& body = ToyBody();
  const Track track = Swinging(20);
  for (const SurfaceFrame frame : {SurfaceFrame::kCamera, SurfaceFrame::kWorld, SurfaceFrame::kBody}) {
    DescribeTrackOptions options = Small();
    options.frame = frame;
    options.velocity.scheme = VelocityScheme::kCentral;
    options.camera_pose = {RotationFromAxisAngle(Vector3d(2, 0.4, -0.1)), Vector3d(0.3, -1, 4)};
    const Described d = Describe(track, options);
    ASSERT_EQ(d.array.shape, (std::vector<int64_t>{20, 15, 48, 48}));
    // The slow way: vertices in double, differences, no streaming.
    const auto poses = PosesInFrame(body, track, frame, options.camera_pose);
    const UvTexelTable& table = d.summary.texels;
    const MeshNormals normals_of(body.data().faces, body.num_vertices());
    for (const int t : {5, 11}) {
      const MatrixX3d before = PoseVertices(body, Eigen::VectorXd(), *poses[t - 1]);
      const MatrixX3d after = PoseVertices(body, Eigen::VectorXd(), *poses[t + 1]);
      const MatrixX3f now = PoseVertices(body, Eigen::VectorXd(), *poses[t]).cast<float>();
      const MatrixX3d velocity = (after - before) * 15;
      MatrixX3f normals(body.num_vertices(), 3);
      NormalScratch scratch;
      normals_of.Compute({now.data(), size_t(now.size())}, {normals.data(), size_t(normals.size())}, &scratch);
      int checked = 0;
      for (size_t i = 0; i < table.size(); i += 3, ++checked) {
        Vector3d n = Vector3d::Zero(), v = Vector3d::Zero(), found_n, found_v;
        for (int k = 0; k < 3; ++k) {
          const int vertex = body.data().faces(table.face[i], k);
          n += double{table.barycentric[i][k]} * normals.row(vertex).transpose().cast<double>();
          v += double{table.barycentric[i][k]} * velocity.row(vertex).transpose();
        }
        for (int c = 0; c < 3; ++c) {
          found_n[c] = d.at(t, c, table.pixel[i]);
          found_v[c] = d.at(t, 3 + c, table.pixel[i]);
        }
        ASSERT_LT((found_n - n.normalized()).norm(), 1e-4);
        ASSERT_LT((found_v - v).norm(), 1e-4 * (1 + v.norm()));
      }
      EXPECT_GT(checked, 300);
    }
    EXPECT_EQ(d.header["frame"], ToString(frame));
  }
}

TEST(DescribeTrack, ACameraThatMovesTurnsTheAxesAndAddsNoVelocity) {
  Track track = Swinging(12);
  const Described scene = Describe(track, Small());
  for (int t = 0; t < 12; ++t) {
    track.camera_from_scene.push_back(
        {RotationFromAxisAngle(Vector3d(0.05 * t, -0.1 * t, 0.02 * t)), Vector3d(0.3 * t, 0, 0.1)});
  }
  const Described seen = Describe(track, Small());
  int moving = 0;
  for (const int t : {0, 5, 11}) {
    const Eigen::Matrix3d& R = track.camera_from_scene[size_t(t)].camera_from_world_rotation;
    for (int p = 0; p < 48 * 48; p += 7) {
      for (const int map : {0, 1}) {  // N, V
        Vector3d in_scene, in_camera;
        for (int c = 0; c < 3; ++c) {
          in_scene[c] = scene.at(t, 3 * map + c, p);
          in_camera[c] = seen.at(t, 3 * map + c, p);
        }
        ASSERT_LT((in_camera - R * in_scene).norm(), 1e-5 * (1 + in_scene.norm()));
        moving += map == 1 && in_scene.norm() > 0.1;
      }
    }
  }
  EXPECT_GT(moving, 100);
  // Normals are those of the body as the camera has it; what shows and what does not is the camera's too.
  DescribeTrackOptions options = Small();
  options.seen_only = true;
  options.past = 0;
  const Described of_scene = Describe(track, options), of_cameras = Describe(TrackInCameras(ToyBody(), track), options);
  ASSERT_EQ(of_scene.values.size(), of_cameras.values.size());
  int different = 0;
  for (size_t i = 0; i < of_scene.values.size(); ++i) {
    different += std::abs(of_scene.values[i] - of_cameras.values[i]) > 1e-3F;
  }
  EXPECT_LT(different, static_cast<int>(of_scene.values.size()) / 500)
      << "texels at the silhouette may round otherwise";
}

TEST(DescribeTrack, PastMapsAreThoseOfThePastFrames) {
  const Described d = Describe(Swinging(40), Small());
  const int pixels = 48 * 48;
  for (const int t : {0, 1, 3, 20, 31, 32, 33, 39}) {
    for (int k = 0; k < 4; ++k) {
      for (int c = 0; c < 3; ++c) {
        for (int p = 0; p < pixels; ++p) {
          const float expected = t - k >= 0 ? d.at(t - k, 3 + c, p) : 0.0F;
          ASSERT_EQ(d.at(t, 3 + 3 * k + c, p), expected);
        }
      }
    }
  }
  EXPECT_EQ(d.summary.velocity_maps, 40);  // one a frame, not four
  EXPECT_EQ(d.summary.frames_skinned, 40);
}

TEST(DescribeTrack, SkipsChangeNoByte) {
  const Track track = Swinging(45);
  for (const bool analytic : {false, true}) {
    for (const int every : {1, 3}) {
      DescribeTrackOptions options = Small();
      options.analytic = analytic;
      options.every = every;
      const Described with = Describe(track, options);
      options.reuse_past = false;
      const Described without = Describe(track, options);
      EXPECT_TRUE(with.bytes == without.bytes) << analytic << every;
      EXPECT_LE(with.summary.velocity_maps, 45);
      EXPECT_GT(without.summary.velocity_maps, every == 1 ? 160 : 45);
    }
  }
}

TEST(DescribeTrack, SameBytesForAnyNumberOfThreads) {
  const Track track = Swinging(70);
  for (const bool analytic : {false, true}) {
    DescribeTrackOptions options = Small();
    options.analytic = analytic;
    options.half = analytic;
    options.seen_only = true;
    const Described one = Describe(track, options);
    for (const int threads : {2, 5}) {
      options.num_threads = threads;
      EXPECT_TRUE(Describe(track, options).bytes == one.bytes) << threads;
    }
  }
}

TEST(DescribeTrack, AnalyticVelocitiesAreCloseToDifferences) {
  const Track track = Swinging(30, 60);
  DescribeTrackOptions options = Small();
  const Described differences = Describe(track, options);
  options.analytic = true;
  const Described analytic = Describe(track, options);
  double squares = 0, error = 0;
  for (size_t i = 0; i < analytic.values.size(); ++i) {
    squares += analytic.values[i] * analytic.values[i];
    error += std::pow(analytic.values[i] - differences.values[i], 2);
  }
  EXPECT_LT(std::sqrt(error / squares), 1e-2);
  EXPECT_GT(error, 0);
}

TEST(DescribeTrack, HalvesAreTheFloatsRounded) {
  const Track track = Swinging(8);
  DescribeTrackOptions options = Small();
  const Described whole = Describe(track, options);
  options.half = true;
  const Described half = Describe(track, options);
  EXPECT_EQ(half.array.dtype, DType::kF16);
  EXPECT_EQ(half.header["dtype"], "float16");
  for (size_t i = 0; i < whole.values.size(); ++i) {
    ASSERT_NEAR(half.values[i], whole.values[i], std::max(std::abs(whole.values[i]) / 2048, 3e-8F));
  }
}

TEST(DescribeTrack, LostFramesAreZeroAndSplitTheClip) {
  Track track = Swinging(30);
  track.frame_status[12] = FrameStatus::kLost;
  track.motion.poses.row(12).setConstant(std::nan(""));
  track.frame_status[14] = FrameStatus::kLost;  // 13 stands alone
  const Described d = Describe(track, Small());
  EXPECT_THAT(d.summary.frames_without_fit, ElementsAre(12, 14));
  EXPECT_EQ(d.header["frames_without_fit"], (std::vector<int>{12, 14}));
  EXPECT_EQ(d.summary.runs, 3);
  EXPECT_EQ(d.summary.frames_without_velocity, 1);
  const int p = d.summary.texels.pixel[d.summary.texels.size() / 2];
  for (int c = 0; c < 15; ++c) {
    EXPECT_EQ(d.at(12, c, p), 0);
    EXPECT_EQ(d.at(14, c, p), 0);
    EXPECT_TRUE(c < 3 || d.at(13, c, p) == 0);  // the past ends where the run begins
    EXPECT_TRUE(c < 6 || d.at(15, c, p) == 0);
  }
  EXPECT_NE(d.at(13, 0, p), 0);
  EXPECT_NE(d.at(15, 3, p), 0);
  EXPECT_NE(d.at(18, 12, p), 0);
  // A clip in which nobody was found is all zeros.
  for (FrameStatus& status : track.frame_status) status = FrameStatus::kLost;
  const Described none = Describe(track, Small());
  EXPECT_EQ(*std::max_element(none.values.begin(), none.values.end()), 0);
}

TEST(DescribeTrack, ChosenChannelsAndFramesAreThoseOfTheWhole) {
  const Track track = Swinging(23);
  const Described all = Describe(track, Small());
  DescribeTrackOptions options = Small();
  options.every = 5;
  const Described some = Describe(track, options);
  ASSERT_EQ(some.array.shape[0], 5);
  EXPECT_EQ(some.header["track_frames"], (std::vector<int>{0, 5, 10, 15, 20}));
  options = Small();
  options.past = 0;
  const Described normals = Describe(track, options);
  ASSERT_EQ(normals.array.shape[1], 3);
  EXPECT_EQ(normals.summary.velocity_maps, 0);
  options = Small();
  options.normals = false;
  const Described velocities = Describe(track, options);
  ASSERT_EQ(velocities.array.shape[1], 12);
  EXPECT_EQ(velocities.header["channels"][3], "velocity[t-1].x");
  for (int p = 0; p < 48 * 48; ++p) {
    for (int c = 0; c < 15; ++c) ASSERT_EQ(some.at(2, c, p), all.at(10, c, p));
    for (int c = 0; c < 3; ++c) ASSERT_EQ(normals.at(7, c, p), all.at(7, c, p));
    for (int c = 0; c < 12; ++c) ASSERT_EQ(velocities.at(7, c, p), all.at(7, 3 + c, p));
  }
  // Frames far apart: what lies between is not posed.
  options = Small();
  options.past = 0;
  options.every = 10;
  EXPECT_EQ(Describe(track, options).summary.frames_skinned, 3);
}

TEST(DescribeTrack, SeenOnlyKeepsWhatTheCameraSees) {
  const Track track = Swinging(3);
  const Described all = Describe(track, Small());
  for (const SurfaceFrame frame : {SurfaceFrame::kCamera, SurfaceFrame::kBody}) {
    DescribeTrackOptions options = Small();
    options.seen_only = true;
    options.frame = frame;
    const Described seen = Describe(track, options);
    const UvTexelTable& table = seen.summary.texels;
    EXPECT_GT(seen.summary.mean_seen, 0.25);
    EXPECT_LT(seen.summary.mean_seen, 0.6);
    int kept = 0, turned_away = 0;
    for (size_t i = 0; i < table.size(); ++i) {
      const int p = table.pixel[i];
      if (seen.at(1, 0, p) == 0 && seen.at(1, 1, p) == 0) continue;
      ++kept;
      if (frame == SurfaceFrame::kCamera) {
        for (int c = 0; c < 15; ++c) ASSERT_EQ(seen.at(1, c, p), all.at(1, c, p));
        turned_away += all.at(1, 2, p) > 0.5F;
      }
    }
    EXPECT_GT(kept, 200);
    EXPECT_LT(turned_away, kept / 50 + 1);  // gutter texels show the other side of a seam
  }
}

TEST(DescribeTrack, DrawsAPreview) {
  DescribeTrackOptions options = Small();
  options.preview_frames = 3;
  const Described d = Describe(Swinging(12), options);
  const Image& sheet = d.summary.preview;
  ASSERT_GT(sheet.width, 5 * 256);
  ASSERT_GT(sheet.height, 3 * 256);
  int coloured = 0;
  for (int y = 0; y < sheet.height; ++y) {
    for (int x = 0; x < sheet.width; ++x) coloured += std::abs(sheet.at(x, y).red - sheet.at(x, y).blue) > 40;
  }
  EXPECT_GT(coloured, 20000);
}

std::string RefusalOf(const Track& track, const DescribeTrackOptions& options) {
  const TemporaryFolder folder;
  std::string message = "nothing thrown";
  try {
    DescribeTrack(ToyBody(), track, folder.File("d.npy"), options);
  } catch (const std::invalid_argument& error) {
    message = error.what();
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.File("")));
  return message;
}

TEST(DescribeTrack, RefusesWhatItCannotDescribe) {
  Track track = Swinging(6);
  DescribeTrackOptions options = Small();
  options.past = -1;
  EXPECT_THAT(RefusalOf(track, options), HasSubstr("past is -1"));
  options = Small();
  options.every = 0;
  EXPECT_THAT(RefusalOf(track, options), HasSubstr("every"));
  options = Small();
  options.normals = false;
  options.past = 0;
  EXPECT_THAT(RefusalOf(track, options), HasSubstr("neither"));
  track.motion.timestamps[4] = track.motion.timestamps[3];
  EXPECT_THAT(RefusalOf(track, Small()), HasSubstr("frame 4"));
  track.motion.timestamps[4] = 0;
  EXPECT_THAT(RefusalOf(track, Small()), HasSubstr("frame 4"));
  track = Swinging(6);
  options = Small();
  options.seen_only = true;
  track.camera.width = 0;
  EXPECT_THAT(RefusalOf(track, options), HasSubstr("how large"));
  EXPECT_THAT(RefusalOf(Swinging(0), Small()), HasSubstr("no frames"));
  const TemporaryFolder folder;
  FileErrorOf(folder.File("absent/d.npy"),
              [&] { DescribeTrack(ToyBody(), Swinging(2), folder.File("absent/d.npy"), Small()); });
  // Stopped half-way: nothing is left.
  EXPECT_THROW(DescribeTrack(ToyBody(), Swinging(70), folder.File("d.npy"), Small(),
                             [](double fraction) {
                               if (fraction > 0) throw std::runtime_error("stop");
                             }),
               std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.File("")));
}

}  // namespace
}  // namespace bodyloom::describe_track_test
