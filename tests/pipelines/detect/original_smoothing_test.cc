// SPDX-License-Identifier: Apache-2.0
/// MediaPipe's pipeline with our networks: frame by frame, landmarks and regions smoothed by its One Euro filters. It
/// must reproduce MediaPipe's published results of a clip, up to later training of the network. Skipped where the
/// recording or the networks (./dev models) are missing.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "data_tools/observations/load_detections.h"
#include "data_tools/video/video_reader.h"
#include "tests/support/paths.h"
#include "tests/support/real_video.h"
#include "tracking/detection/pose_detector.h"

namespace bodyloom::original_smoothing_test {
namespace {

/// Casiez, Roussel, Vogel, "1€ Filter", CHI 2012, as MediaPipe has it: the speed that opens the filter is relative to
/// the person's size, and taken between raw values.
class OneEuro {
 public:
  OneEuro(double min_cutoff, double beta) : min_cutoff_(min_cutoff), beta_(beta) {}

  double Smooth(double value, double size) {
    constexpr double kFrequency = 30, kSpeedCutoff = 1;
    const auto share = [](double cutoff) { return 1 / (1 + kFrequency / (2 * std::numbers::pi * cutoff)); };
    if (!smooth_) {
      raw_ = value;
      smooth_ = value;
      return value;
    }
    const double speed = (value - raw_) / size * kFrequency;
    speed_ += share(kSpeedCutoff) * (speed - speed_);
    *smooth_ += share(min_cutoff_ + beta_ * std::abs(speed_)) * (value - *smooth_);
    raw_ = value;
    return *smooth_;
  }

 private:
  double min_cutoff_, beta_, raw_ = 0, speed_ = 0;
  std::optional<double> smooth_;
};

class OneEuroPoint {
 public:
  OneEuroPoint(double min_cutoff, double beta) : x_(min_cutoff, beta), y_(min_cutoff, beta) {}
  Eigen::Vector2d Smooth(const Eigen::Vector2d& point, double size) {
    return {x_.Smooth(point.x(), size), y_.Smooth(point.y(), size)};
  }

 private:
  OneEuro x_, y_;
};

double MeanDistance(const std::vector<std::vector<Eigen::Vector2d>>& found, const KeypointSequence& reference) {
  double sum = 0;
  for (size_t t = 0; t < found.size(); ++t) {
    for (size_t k = 0; k < 33; ++k) {
      const Keypoint& expected = reference.at(int(t), int(k));
      sum += (found[t][k] - Eigen::Vector2d(expected.x, expected.y)).norm();
    }
  }
  return sum / double(33 * found.size());
}

TEST(OriginalSmoothing, GivesWhatWasPublishedForTheSquats) {
  const std::string data = SharedDir() + "/data/tfjs_pose/", video = data + "pose_squats.mp4";
  if (const std::string why = WhyNoDetection(video); !why.empty()) GTEST_SKIP() << why;
  const KeypointSequence reference = LoadDetections(data + "pose_squats.full.json");
  PoseDetector detector(ReadPoseModels("", PoseNetworkSize::kFull), false);
  std::vector<OneEuroPoint> landmarks(33, {0.05, 80}), region_points(2, {0.01, 10});
  std::vector<std::vector<Eigen::Vector2d>> smooth, raw;
  VideoReader reader(video);
  PoseRegion region;
  Image frame;
  while (reader.Read(&frame)) {
    if (raw.empty()) {
      const std::vector<PoseRegion> people = detector.FindPeople(frame, TileRegions(frame.width, frame.height, 1)[0]);
      ASSERT_FALSE(people.empty());
      region = people[0];
    }
    const DetectedPose pose = detector.PoseIn(frame, region);
    ASSERT_GT(pose.presence, 0.5) << "frame " << raw.size();
    const double size = 2 * (pose.rim - pose.hips).norm();
    std::vector<Eigen::Vector2d>& points = raw.emplace_back();
    std::vector<Eigen::Vector2d>& smoothed = smooth.emplace_back();
    for (size_t k = 0; k < 33; ++k) {
      points.push_back(pose.landmarks[k].pixel);
      smoothed.push_back(landmarks[k].Smooth(points.back(), size));
    }
    region = RegionAroundBody(region_points[0].Smooth(pose.hips, size), region_points[1].Smooth(pose.rim, size));
  }
  ASSERT_EQ(int(raw.size()), reference.num_frames());
  RecordProperty("mean_raw_px", std::to_string(MeanDistance(raw, reference)));
  RecordProperty("mean_px", std::to_string(MeanDistance(smooth, reference)));
  // Of a person 780 px tall. An independent run of the genuine networks had 3.98 px, 6.9 px without the filter.
  EXPECT_LT(MeanDistance(smooth, reference), 4.5);
  EXPECT_GT(MeanDistance(raw, reference), MeanDistance(smooth, reference) + 1);
}

}  // namespace
}  // namespace bodyloom::original_smoothing_test
