// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/metrics_image.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bodyloom::metrics_image_test {
namespace {

constexpr double kTolerance = 1e-12;

/// A standing figure of COCO-17 detections, 400 px high and 120 px wide, left shoulder to right hip 100 px.
KeypointSequence Detections(int frames) {
  KeypointSequence s;
  s.convention = "coco17";
  s.names = CocoNames();
  s.image_width = 1920;
  s.image_height = 1080;
  for (int t = 0; t < frames; ++t) {
    s.timestamps.push_back(t / 60.0);
    for (int k = 0; k < 17; ++k) {
      const float side = k == 0 ? 0.0F : (k % 2 == 1 ? 1.0F : -1.0F);
      s.points.push_back({960 + 30 * side, 100 + 25.0F * static_cast<float>(k), 0.9F});
    }
    s.at(t, 15) = {900, 500, 0.9F};
    s.at(t, 16) = {1020, 500, 0.9F};
    s.at(t, 5) = {1000, 200, 0.9F};  // left shoulder
    s.at(t, 12) = {940, 280, 0.9F};  // right hip
  }
  return s;
}

std::vector<MatrixX2d> Pixels(const KeypointSequence& s, double dx, double dy) {
  std::vector<MatrixX2d> pixels;
  for (int t = 0; t < s.num_frames(); ++t) {
    MatrixX2d frame(s.num_points(), 2);
    for (int k = 0; k < s.num_points(); ++k) frame.row(k) << s.at(t, k).x + dx, s.at(t, k).y + dy;
    pixels.push_back(frame);
  }
  return pixels;
}

double Pck(const std::vector<MatrixX2d>& pixels, const KeypointSequence& detections, double fraction,
           PckReference reference) {
  CorrectKeypoints counts;
  AddCorrectKeypoints(pixels, detections, fraction, reference, 0.3, &counts);
  return counts.Share();
}

TEST(MetricsImageTest, ProjectionErrorScalesByTheLongerSide) {
  const std::vector<MatrixX2d> truth(4, MatrixX2d::Constant(10, 2, 300));
  std::vector<MatrixX2d> estimate(4, MatrixX2d::Constant(10, 2, 300));
  for (MatrixX2d& frame : estimate) frame.rowwise() += Eigen::RowVector2d(3, 4);
  EXPECT_NEAR(PerVertexProjectionError(estimate, truth, 512, 512).mean_px, 5, kTolerance);
  EXPECT_NEAR(PerVertexProjectionError(estimate, truth, 1920, 1080).mean_px, 5 * 512.0 / 1920, kTolerance);
  EXPECT_NEAR(PerVertexProjectionError(estimate, truth, 576, 1024).mean_px, 2.5, kTolerance);
  EXPECT_NEAR(PerVertexProjectionError(estimate, truth, 1000, 500, 1000).mean_px, 5, kTolerance);
}

TEST(MetricsImageTest, ProjectionErrorSpreads) {
  const std::vector<MatrixX2d> truth(2, MatrixX2d::Zero(2, 2));
  std::vector<MatrixX2d> estimate = truth;
  estimate[0].row(0) << 1, 0;  // frame means 0.5 and 3.5
  estimate[1].row(0) << 0, 3;
  estimate[1].row(1) << 4, 0;
  const ProjectionError e = PerVertexProjectionError(estimate, truth, 512, 512);
  EXPECT_NEAR(e.mean_px, 2, kTolerance);
  EXPECT_NEAR(e.std_frames_px, 1.5, kTolerance);
  EXPECT_NEAR(e.std_vertices_px, std::sqrt(2.5), kTolerance);  // of 1, 0, 3, 4
  EXPECT_NEAR(e.rms_px, std::sqrt(6.5), kTolerance);

  estimate[1].row(1).setConstant(kNotMeasured);
  const ProjectionError with_gap = PerVertexProjectionError(estimate, truth, 512, 512);
  EXPECT_EQ(with_gap.missing, 1);
  EXPECT_NEAR(with_gap.mean_px, 4.0 / 3, kTolerance);
}

TEST(MetricsImageTest, ProjectPointsMarksWhatTheCameraCannotSee) {
  const Camera camera = MakePinhole(640, 480, 500);
  MatrixX3d points(3, 3);
  points << 0.2, -0.1, 2, 0, 0, -1, kNotMeasured, 0, 1;
  const MatrixX2d pixels = ProjectPoints(camera, points);
  EXPECT_NEAR(pixels(0, 0), 319.5 + 50, kTolerance);
  EXPECT_NEAR(pixels(0, 1), 239.5 - 25, kTolerance);
  EXPECT_TRUE(std::isnan(pixels(1, 0)) && std::isnan(pixels(2, 1)));
}

TEST(MetricsImageTest, ReprojectionErrorInPixelsAndHeights) {
  KeypointSequence detections = Detections(3);
  detections.at(1, 7).confidence = 0.3F;  // not above the threshold
  detections.at(2, 8).x = NAN;
  std::vector<MatrixX2d> pixels = Pixels(Detections(3), 6, 8);
  pixels[0].row(3).setConstant(kNotMeasured);
  ReprojectionErrors errors;
  AddReprojectionErrors(pixels, detections, 0.3, &errors);
  EXPECT_EQ(errors.px.size(), 3u * 17 - 3);
  EXPECT_EQ(errors.missing, 1);
  const ErrorStatistics px = Summarize(errors.px), percent = Summarize(errors.percent_of_height);
  EXPECT_NEAR(px.median, 10, 1e-5);
  EXPECT_NEAR(px.p95, 10, 1e-5);
  EXPECT_NEAR(percent.median, 2.5, 1e-5);  // of 400 px
  AddReprojectionErrors(pixels, detections, 0.3, &errors);
  EXPECT_EQ(errors.px.size(), 2 * (3u * 17 - 3));
}

TEST(MetricsImageTest, PersonHeightNeedsFivePoints) {
  KeypointSequence detections = Detections(1);
  EXPECT_DOUBLE_EQ(DetectionBoxSidePx(detections, 0, 0.3), 400);
  for (int k = 5; k < 17; ++k) detections.at(0, k).confidence = 0;
  EXPECT_DOUBLE_EQ(DetectionBoxSidePx(detections, 0, 0.3), 100);
  detections.at(0, 2).confidence = 0;
  EXPECT_TRUE(std::isnan(DetectionBoxSidePx(detections, 0, 0.3)));
}

TEST(MetricsImageTest, PckThresholds) {
  const KeypointSequence detections = Detections(2);
  const auto pck = [&](double offset, double fraction, PckReference reference) {
    return Pck(Pixels(detections, offset, 0), detections, fraction, reference);
  };
  EXPECT_EQ(pck(19.9, 0.05, PckReference::kBox), 1);  // 20 px of 400
  EXPECT_EQ(pck(20.1, 0.05, PckReference::kBox), 0);
  EXPECT_EQ(pck(39.9, 0.1, PckReference::kBox), 1);
  EXPECT_EQ(pck(40.1, 0.1, PckReference::kBox), 0);
  EXPECT_EQ(pck(19.9, 0.2, PckReference::kTorso), 1);  // 20 px of 100
  EXPECT_EQ(pck(20.1, 0.2, PckReference::kTorso), 0);
}

TEST(MetricsImageTest, PckCountsMissingPredictionsAsWrongAndSkipsFramesWithoutAReference) {
  KeypointSequence detections = Detections(3);
  std::vector<MatrixX2d> pixels = Pixels(detections, 0, 0);
  pixels[0].setConstant(kNotMeasured);
  EXPECT_NEAR(Pck(pixels, detections, 0.1, PckReference::kBox), 2.0 / 3, kTolerance);
  // Without left shoulder the other diagonal serves; without right shoulder too the frame has no torso.
  detections.at(2, 5).confidence = 0;
  EXPECT_NEAR(Pck(pixels, detections, 0.2, PckReference::kTorso), 33.0 / 50, kTolerance);
  detections.at(2, 6).confidence = 0;
  EXPECT_NEAR(Pck(pixels, detections, 0.2, PckReference::kTorso), 0.5, kTolerance);
  EXPECT_TRUE(std::isnan(Pck({}, detections, 0.2, PckReference::kTorso)));
}

TEST(MetricsImageTest, BrokenContractsThrow) {
  const KeypointSequence detections = Detections(2);
  ReprojectionErrors errors;
  EXPECT_THROW(AddReprojectionErrors(Pixels(Detections(3), 0, 0), detections, 0.3, &errors), std::invalid_argument);
  EXPECT_THROW(AddReprojectionErrors(std::vector<MatrixX2d>(2, MatrixX2d::Zero(16, 2)), detections, 0.3, &errors),
               std::invalid_argument);
  EXPECT_THROW(Pck(Pixels(detections, 0, 0), detections, 0, PckReference::kBox), std::invalid_argument);
  EXPECT_THROW(PerVertexProjectionError(std::vector<MatrixX2d>(2, MatrixX2d::Zero(5, 2)),
                                        std::vector<MatrixX2d>(2, MatrixX2d::Zero(6, 2)), 512, 512),
               std::invalid_argument);
  EXPECT_THROW(SquareImageScale(0, 480), std::invalid_argument);
  KeypointSequence no_hips = detections;
  for (std::string& name : no_hips.names) name += "?";
  EXPECT_THROW(Pck(Pixels(no_hips, 0, 0), no_hips, 0.2, PckReference::kTorso), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::metrics_image_test
