// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/speed_response.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::speed_response_test {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 64, kHeight = 60, kFrames = 40;
constexpr double kFocal = 50, kDepth_m = 2;  // 25 px a metre
constexpr double kPixelsPerMetre = kFocal / kDepth_m;

/// Someone whose pelvis stands in the middle of the picture and whose pose changes at `rate` radians a second; after
/// frame `cut` a second passes (negative: never).
Track Moving(int frames, double rate, int cut = -1) {
  Track track;
  track.motion.body = "bodyloom";
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses = RowMatrixXd::Zero(frames, 72);
  track.motion.trans = MatrixX3d::Zero(frames, 3);
  track.motion.trans.col(2).setConstant(kDepth_m);
  double time = 0;
  for (int t = 0; t < frames; ++t) {
    time += t == 0 ? 0 : t == cut + 1 && cut >= 0 ? 1 : 1 / 30.0;
    track.motion.timestamps.push_back(time);
    track.motion.poses(t, 5) = rate * t / 30.0;
    MatrixX3d joints = MatrixX3d::Zero(24, 3);
    joints.col(2).setConstant(kDepth_m);
    track.joints.push_back(joints);
  }
  track.camera = MakePinhole(kWidth, kHeight, kFocal);
  track.frame_status.assign(frames, FrameStatus::kTracked);
  return track;
}

/// A skirt's picture: columns [left, right), rows [20, 40).
Image Skirt(int left, int right) {
  Image labels(kWidth, kHeight);
  for (int y = 20; y < 40; ++y) {
    for (int x = left; x < right; ++x) {
      for (int c = 0; c < 3; ++c) labels.bgr[3 * (y * kWidth + x) + c] = static_cast<uint8_t>(PersonLabel::kBottom);
    }
  }
  return labels;
}

TEST(SpeedResponse, ExtentsOfARectangle) {
  const Track track = Moving(1, 0);
  const double centre_x = track.camera.cx, centre_y = track.camera.cy;
  const LabelExtent extent = MeasureLabelExtent(Skirt(10, 50), PersonLabel::kBottom, track, 0);
  EXPECT_NEAR(extent.values[0], (10 + 0.03 * 40 - centre_x) / kPixelsPerMetre, 1e-12);
  EXPECT_NEAR(extent.values[1], (10 + 0.97 * 40 - centre_x) / kPixelsPerMetre, 1e-12);
  EXPECT_NEAR(extent.values[2], (20 + 0.97 * 20 - centre_y) / kPixelsPerMetre, 1e-12);
  EXPECT_NEAR(extent.values[3], 40 * 20 / (kPixelsPerMetre * kPixelsPerMetre), 1e-12);
  EXPECT_TRUE(std::isnan(MeasureLabelExtent(Skirt(10, 50), PersonLabel::kTop, track, 0).values[0]));
}

TEST(SpeedResponse, PairsShowTheSamePoses) {
  const auto pairs = PairFramesByPose(Moving(40, 2), Moving(80, 1), 10);
  ASSERT_EQ(pairs.size(), 30U);
  for (int i = 0; i < 30; ++i) EXPECT_EQ(pairs[i], std::pair(10 + i, 20 + 2 * i));
  // After a cut both have nothing behind them.
  for (const auto& [t, u] : PairFramesByPose(Moving(40, 2, 19), Moving(80, 1, 39), 10)) {
    EXPECT_EQ(u, 2 * t);
    EXPECT_TRUE(t < 20 || t >= 30) << t;
  }
  EXPECT_TRUE(PairFramesByPose(Moving(40, 2), Moving(40, 2.1), 39).empty());
  // Someone who stands still: each frame once, in order.
  const auto still = PairFramesByPose(Moving(15, 0), Moving(20, 0), 0);
  ASSERT_EQ(still.size(), 15U);
  for (int i = 0; i < 15; ++i) EXPECT_EQ(still[i], std::pair(i, i));
}

/// Writes a set whose skirt reaches from 20 − left(t) to 40 and returns it.
SinglePersonDataset Dressed(const std::string& path, const Track& track, const std::function<int(int)>& left,
                            bool has_labels = true) {
  SinglePersonDatasetInfo info;
  info.num_frames = track.num_frames(), info.width = kWidth, info.height = kHeight, info.fps = 30;
  info.has = {has_labels, false, false, false};
  const SinglePersonDatasetWriter writer(path, info, track);
  for (int t = 0; t < track.num_frames(); ++t) {
    PersonFrame frame;
    frame.rgb = Image(kWidth, kHeight);
    if (has_labels) frame.labels = Skirt(20 - left(t), 40);
    writer.Write(t, frame);
  }
  writer.Finish();
  return SinglePersonDataset(path);
}

TEST(SpeedResponse, AShareOfTheChangeIsTheSlope) {
  const TemporaryFolder folder;
  const Track fast = Moving(kFrames, 2), slow = Moving(2 * kFrames, 1);
  // The truth flies 0 to 12 px further out when fast; results: half of that, the other way, nothing.
  const auto flies = [](int t) { return 4 * (t % 4); };
  const auto hangs = [](int) { return 0; };
  const SinglePersonDataset truth = Dressed(folder.File("truth"), fast, flies),
                            other = Dressed(folder.File("other"), slow, hangs);
  const auto reaction = [&](const std::string& name, const std::function<int(int)>& left) {
    return MeasureSpeedResponse(truth, Dressed(folder.File(name), fast, left), other, other, PersonLabel::kBottom, 2);
  };
  const SpeedResponse same = reaction("same", flies), half = reaction("half", [&](int t) { return flies(t) / 2; }),
                      away = reaction("away", [&](int t) { return -flies(t) / 2; }), none = reaction("none", hangs);
  EXPECT_EQ(half.pairs, 30);
  EXPECT_NEAR(same.extents[0].slope, 1, 1e-12);
  EXPECT_NEAR(same.extents[0].correlation, 1, 1e-12);
  EXPECT_NEAR(same.result_iou, same.truth_iou, 1e-12);
  // Left of a rectangle from x0: x0 + 0.03·(40 − x0), linear in x0.
  EXPECT_NEAR(half.extents[0].slope, 0.5, 1e-12);
  EXPECT_NEAR(half.extents[0].correlation, 1, 1e-12);
  EXPECT_NEAR(half.extents[0].truth_std, 2 * half.extents[0].result_std, 1e-12);
  EXPECT_NEAR(half.extents[3].slope, 0.5, 1e-12);
  EXPECT_NEAR(away.extents[0].slope, -0.5, 1e-12);
  EXPECT_NEAR(away.extents[0].correlation, -1, 1e-12);
  EXPECT_EQ(none.extents[0].slope, 0);
  EXPECT_TRUE(std::isnan(none.extents[0].correlation));
  EXPECT_NEAR(none.result_iou, 1, 1e-12);
  double iou = 0;
  for (int t = 10; t < kFrames; ++t) iou += 20.0 / (20 + flies(t)) / 30;
  EXPECT_NEAR(none.truth_iou, iou, 1e-12);
  // Frames 10 to 39 in order of how far the skirt flies: 7 of 0 px, 7 of 4, 8 of 8, 8 of 12.
  const std::array<std::array<int, 4>, 4> flown = {{{7, 1, 0, 0}, {0, 6, 1, 0}, {0, 0, 7, 1}, {0, 0, 0, 7}}};
  for (int q = 0; q < 4; ++q) {
    double between = 0, halves = 0;
    int pairs = 0;
    for (int k = 0; k < 4; ++k) {
      pairs += flown[q][k];
      between += flown[q][k] * 20.0 / (20 + 4 * k), halves += flown[q][k] * (20.0 + 2 * k) / (20 + 4 * k);
    }
    EXPECT_EQ(none.quarters[q].pairs, pairs) << q;
    EXPECT_NEAR(none.quarters[q].between_speeds, between / pairs, 1e-12) << q;
    EXPECT_NEAR(none.quarters[q].iou, between / pairs, 1e-12) << q;
    EXPECT_NEAR(half.quarters[q].iou, halves / pairs, 1e-12) << q;
    EXPECT_NEAR(same.quarters[q].iou, 1, 1e-12) << q;
    EXPECT_NEAR(none.quarters[q].other_iou, 1, 1e-12) << q;
  }
  // Judged at the other speed, whoever hangs is right and whoever flies too far is not.
  const SpeedResponse swapped =
      MeasureSpeedResponse(other, other, truth, Dressed(folder.File("still"), fast, hangs), PersonLabel::kBottom, 2);
  EXPECT_NEAR(swapped.quarters[3].iou, 1, 1e-12);
  EXPECT_NEAR(swapped.quarters[3].other_iou, 20.0 / 32, 1e-12);
}

TEST(SpeedResponse, SaysWhatDoesNotFit) {
  const TemporaryFolder folder;
  const auto hangs = [](int) { return 0; };
  const Track fast = Moving(kFrames, 2), slow = Moving(2 * kFrames, 1);
  const SinglePersonDataset truth = Dressed(folder.File("truth"), fast, hangs),
                            other = Dressed(folder.File("other"), slow, hangs),
                            bare = Dressed(folder.File("bare"), fast, hangs, false),
                            elsewhere = Dressed(folder.File("elsewhere"), Moving(kFrames, -2), hangs);
  const auto error = [&](const SinglePersonDataset& a, const SinglePersonDataset& b, const SinglePersonDataset& c,
                         const SinglePersonDataset& d) {
    return FileErrorOf(folder.File(""), [&] { (void)MeasureSpeedResponse(a, b, c, d, PersonLabel::kBottom, 1); });
  };
  EXPECT_THAT(error(truth, other, other, other), HasSubstr("other: 80 frames of 64x60, expected 40"));
  EXPECT_THAT(error(truth, bare, other, other), HasSubstr("bare: has no labels"));
  EXPECT_THAT(error(truth, truth, elsewhere, elsewhere), HasSubstr("elsewhere: shows none of the poses"));
  Track without_joints = fast;
  without_joints.joints.clear();
  const SinglePersonDataset jointless = Dressed(folder.File("jointless"), without_joints, hangs);
  EXPECT_THAT(error(jointless, jointless, other, other), HasSubstr("jointless/track.npz: has no joints"));
}

}  // namespace
}  // namespace bodyloom::speed_response_test
