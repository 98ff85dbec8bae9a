// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/dense_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/video/image_file.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/observations.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"
#include "tests/support/write_iuv.h"

namespace bodyloom::dense_history_test {
namespace {

constexpr int kPast = 3;

PersonFramesOptions Small() {
  PersonFramesOptions options;
  options.uv_size = 8;
  options.past = 1;
  options.window.max_side = 96;
  return options;
}

class DenseHistoryTest : public ::testing::Test {
 protected:
  void Describe(const Track& track, const PersonFramesOptions& options = Small()) {
    track_ = track;
    frames_ = std::make_unique<PersonFrames>(BuiltinBody(), track_, options);
    history_ = std::make_unique<DenseHistory>(*frames_, kPast);
    width_ = frames_->window().width, height_ = frames_->window().height;
  }
  std::vector<float> Maps(int t) const {
    std::vector<float> maps(size_t(history_->channels()) * width_ * height_);
    history_->Maps(t, maps);
    return maps;
  }
  /// Channel c of the frame k frames before.
  float At(const std::vector<float>& maps, int k, int c, int x, int y) const {
    return maps[((size_t(k) * DenseHistory::kChannelsOfFrame + c) * height_ + y) * width_ + x];
  }
  /// Checks that entry k of frame t's maps is the content of frame s at its position in the image.
  void ExpectShows(int t, int k, int s) const {
    const size_t area = size_t(width_) * height_;
    std::vector<float> uv(2 * area), body(area);
    frames_->BodyMaps(s, uv, body);
    const std::vector<float> maps = Maps(t);
    const Eigen::Vector2i moved = frames_->window().corner[s] - frames_->window().corner[t];
    double inside = 0;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const int from_x = x - moved.x(), from_y = y - moved.y();
        const bool seen = from_x >= 0 && from_x < width_ && from_y >= 0 && from_y < height_;
        const size_t from = size_t(std::max(0, from_y)) * width_ + std::max(0, from_x);
        ASSERT_NEAR(At(maps, k, 0, x, y), seen ? uv[from] : 0, 1.0 / 65535) << x << ", " << y;
        ASSERT_NEAR(At(maps, k, 1, x, y), seen ? uv[area + from] : 0, 1.0 / 65535);
        ASSERT_EQ(At(maps, k, 2, x, y), seen ? body[from] : 0);
        inside += At(maps, k, 2, x, y);
      }
    }
    EXPECT_GT(inside, 200) << "nobody to be seen";
  }

  Track track_;
  std::unique_ptr<PersonFrames> frames_;
  std::unique_ptr<DenseHistory> history_;
  int width_ = 0, height_ = 0;
};

TEST_F(DenseHistoryTest, ShowsEachFrameWhereItWas) {
  PersonFramesOptions options = Small();
  options.window.max_side = 64;
  options.window.margin = 0;  // so that the window has to follow
  Describe(ShortTrack(), options);
  ASSERT_EQ(history_->channels(), 18);
  const std::vector<Eigen::Vector2i>& corner = frames_->window().corner;
  int t = 2;
  while (t + 1 < track_.num_frames() && corner[t] == corner[t - 2]) ++t;
  ASSERT_NE(corner[t], corner[t - 2]) << "the window stays where it is";
  for (int k = 0; k < kPast; ++k) ExpectShows(t, k, t - k);
}

TEST_F(DenseHistoryTest, KeypointsAreOnTheirSideWhereTheCameraSeesThem) {
  Describe(ShortTrack());
  const int t = 4;
  const BodyPose pose =
      PoseFromAxisAngle(BuiltinBody(), track_.motion.poses.row(t).transpose(), track_.motion.trans.row(t).transpose());
  const MatrixX3d points = PoseLandmarks(BuiltinBody(), track_.motion.betas, pose, CocoNames());
  const Camera camera = CameraInWindow(track_.CameraAt(t), frames_->window(), t);
  const double sigma = DenseHistory::kKeypointSigma * std::max(width_, height_);
  const std::vector<float> maps = Maps(t);
  std::vector<std::vector<Eigen::Vector2d>> sides(3);
  for (size_t k = 0; k < CocoNames().size(); ++k) {
    Eigen::Vector2d pixel;
    ASSERT_TRUE(camera.Project(points.row(Eigen::Index(k)).transpose(), &pixel));
    const std::string& name = CocoNames()[k];
    sides[name[0] == 'l' ? 0 : name[0] == 'r' ? 1 : 2].push_back(pixel);
  }
  EXPECT_EQ(sides[0].size(), 8U);
  EXPECT_EQ(sides[2].size(), 1U) << "the nose";
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        double largest = 0;
        for (const Eigen::Vector2d& pixel : sides[c]) {
          const double distance = (pixel - Eigen::Vector2d(x, y)).squaredNorm();
          largest = std::max(largest, std::exp(-distance / (2 * sigma * sigma)));
        }
        ASSERT_NEAR(At(maps, 0, 3 + c, x, y), largest, 0.012) << "cut off at three deviations";
      }
    }
  }
}

TEST_F(DenseHistoryTest, BeforeARunsFirstFrameThePersonStoodStill) {
  Track track = ShortTrack();
  for (int t = 5; t < track.num_frames(); ++t) track.motion.timestamps[t] += 3;  // a cut
  track.motion.trans.row(9).setConstant(std::nan(""));
  track.frame_status[9] = FrameStatus::kLost;
  Describe(track);
  for (int k = 0; k < kPast; ++k) ExpectShows(0, k, 0);
  ExpectShows(6, 1, 5);
  ExpectShows(6, 2, 5);
  const std::vector<float> lost = Maps(9);
  EXPECT_TRUE(std::all_of(lost.begin(), lost.end(), [](float v) { return v == 0; }));
}

TEST_F(DenseHistoryTest, ATurnedViewIsAnotherImage) {
  PersonFramesOptions options = Small();
  options.yaw_deg.assign(ShortTrack().num_frames(), 180);
  Describe(ShortTrack());
  const Eigen::Matrix<double, Eigen::Dynamic, 2> front = frames_->Keypoints(3);
  Describe(ShortTrack(), options);
  for (int k = 0; k < kPast; ++k) ExpectShows(3, k, 3 - k);
  // From behind the shoulders (5 left, 6 right) change sides.
  const Eigen::Matrix<double, Eigen::Dynamic, 2> back = frames_->Keypoints(3);
  EXPECT_LT((front(5, 0) - front(6, 0)) * (back(5, 0) - back(6, 0)), 0);
}

TEST_F(DenseHistoryTest, EstimatesStandInForTheBody) {
  const ScratchFolder scratch;
  PersonFramesOptions options = Small();
  options.window.scale = 1;  // the picture's own pixels
  Describe(ShortTrack(), options);
  const EstimatedPixels estimated(BuiltinBody(), WriteIuv(track_, scratch / "iuv"), track_.num_frames());
  const size_t area = size_t(width_) * height_;
  std::vector<float> uv(2 * area), body(area), found(2 * area), mask(area);
  frames_->BodyMaps(4, uv, body);
  estimated.BodyMaps(frames_->window(), 4, found, mask);
  int shown = 0, near = 0;
  for (size_t i = 0; i < area; ++i) {
    ASSERT_LE(mask[i], body[i]) << "on the body alone";
    if (mask[i] == 0) {
      ASSERT_EQ(found[i], 0);
      continue;
    }
    ++shown;
    // Charts are rounded to 1/255, and are smaller in the atlas than they are.
    near += std::hypot(found[i] - uv[i], found[area + i] - uv[area + i]) < 0.005 ? 1 : 0;
  }
  EXPECT_GT(shown, 1000);
  EXPECT_GT(near, 0.99 * shown);
  // The history of estimates: the same pictures, and the keypoints of the body.
  const DenseHistory history(*frames_, kPast, &estimated);
  std::vector<float> maps(size_t(history.channels()) * area);
  history.Maps(4, maps);
  const std::vector<float> of_body = Maps(4);
  for (size_t i = 0; i < area; ++i) {
    ASSERT_NEAR(maps[i], found[i], 1.0 / 65535);
    ASSERT_EQ(maps[2 * area + i], mask[i]);
    ASSERT_EQ(maps[3 * area + i], of_body[3 * area + i]);
  }
}

TEST_F(DenseHistoryTest, EstimatesAreOfThisClip) {
  const ScratchFolder scratch;
  Describe(ShortTrack());
  const std::string folder = WriteIuv(track_, scratch / "iuv");
  EXPECT_THROW(EstimatedPixels(BuiltinBody(), folder, track_.num_frames() + 1), std::runtime_error);
  WriteImage(folder + "/000001.png", Image(30, 20));
  const EstimatedPixels estimated(BuiltinBody(), folder, track_.num_frames());
  std::vector<float> uv(size_t(2) * width_ * height_), mask(size_t(width_) * height_);
  EXPECT_THROW(estimated.BodyMaps(frames_->window(), 1, uv, mask), std::runtime_error) << "of another size";
  // Beside other pictures those named _IUV count.
  WriteImage(folder + "/a_IUV.png", Image(30, 20));
  EXPECT_THROW(EstimatedPixels(BuiltinBody(), folder, 2), std::runtime_error);
}

TEST_F(DenseHistoryTest, RefusesTheWrongSizes) {
  Describe(ShortTrack());
  std::vector<float> small(3);
  EXPECT_THROW(history_->Maps(0, small), std::invalid_argument);
  EXPECT_THROW(DenseHistory(*frames_, 0), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::dense_history_test
