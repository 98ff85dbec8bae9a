// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/metrics_image.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Compared in float, as the files hold it: 0.3 in a file is not above 0.3.
bool IsUsed(const Keypoint& p, double min_confidence) {
  return p.confidence > static_cast<float>(min_confidence) && std::isfinite(p.x) && std::isfinite(p.y);
}

void CheckAgainstDetections(const char* what, PixelClip prediction, const KeypointSequence& detections) {
  BODYLOOM_CHECK(static_cast<int>(prediction.size()) <= detections.num_frames(), what, ": prediction has ",
                 prediction.size(), " frames, the detections have ", detections.num_frames());
  for (size_t t = 0; t < prediction.size(); ++t) {
    BODYLOOM_CHECK(prediction[t].rows() == detections.num_points(), what, ": frame ", t, " has ", prediction[t].rows(),
                   " points, the detections have ", detections.num_points());
  }
}

double TorsoPx(const KeypointSequence& detections, int frame, double min_confidence) {
  const auto index = [&](const char* name) {
    const auto it = std::find(detections.names.begin(), detections.names.end(), name);
    BODYLOOM_CHECK(it != detections.names.end(), "PCK of the torso: the detections have no '", name, "'");
    return static_cast<int>(it - detections.names.begin());
  };
  const auto diagonal = [&](const char* shoulder, const char* hip) {
    const Keypoint a = detections.at(frame, index(shoulder)), b = detections.at(frame, index(hip));
    return IsUsed(a, min_confidence) && IsUsed(b, min_confidence) ? std::hypot(double{a.x} - b.x, double{a.y} - b.y)
                                                                  : kNotMeasured;
  };
  const double first = diagonal("left_shoulder", "right_hip");
  return std::isfinite(first) ? first : diagonal("right_shoulder", "left_hip");
}

}  // namespace

MatrixX2d ProjectPoints(const Camera& camera, const MatrixX3d& points_in_camera) {
  MatrixX2d pixels(points_in_camera.rows(), 2);
  for (Eigen::Index i = 0; i < pixels.rows(); ++i) {
    Eigen::Vector2d pixel;
    const Eigen::Vector3d point = points_in_camera.row(i).transpose();
    if (!point.allFinite() || !camera.Project(point, &pixel)) pixel.setConstant(kNotMeasured);
    pixels.row(i) = pixel.transpose();
  }
  return pixels;
}

double SquareImageScale(int width, int height, int side) {
  BODYLOOM_CHECK(width > 0 && height > 0 && side > 0, "SquareImageScale: ", width, "x", height, " to ", side,
                 " pixels, expected positive sizes");
  return static_cast<double>(side) / std::max(width, height);
}

void ProjectionErrorAccumulator::AddFrame(const MatrixX2d& prediction_px, const MatrixX2d& truth_px) {
  BODYLOOM_CHECK(prediction_px.rows() == truth_px.rows(), "per-vertex projection error: frame ", frame_means_.size(),
                 " has ", prediction_px.rows(), " predicted and ", truth_px.rows(), " true vertices");
  double frame_sum = 0;
  int64_t frame_count = 0;
  for (Eigen::Index v = 0; v < truth_px.rows(); ++v) {
    const double e = scale_ * (prediction_px.row(v) - truth_px.row(v)).norm();
    if (!std::isfinite(e)) {
      ++missing_;
      continue;
    }
    frame_sum += e;
    squares_ += e * e;
    ++frame_count;
  }
  frame_means_.push_back(frame_count > 0 ? frame_sum / static_cast<double>(frame_count) : kNotMeasured);
  sum_ += frame_sum;
  count_ += frame_count;
}

ProjectionError ProjectionErrorAccumulator::Result() const {
  ProjectionError result;
  result.frames_px = Summarize(frame_means_);
  result.count = count_;
  result.missing = missing_;
  if (count_ == 0) return result;
  const auto n = static_cast<double>(count_);
  result.mean_px = sum_ / n;
  result.rms_px = std::sqrt(squares_ / n);
  result.std_frames_px = result.frames_px.std_dev;
  result.std_vertices_px = std::sqrt(std::max(0.0, squares_ / n - result.mean_px * result.mean_px));
  return result;
}

ProjectionError PerVertexProjectionError(PixelClip prediction_px, PixelClip truth_px, int width, int height, int side) {
  BODYLOOM_CHECK(prediction_px.size() == truth_px.size(), "PerVertexProjectionError: prediction has ",
                 prediction_px.size(), " frames, truth has ", truth_px.size());
  ProjectionErrorAccumulator errors(SquareImageScale(width, height, side));
  for (size_t t = 0; t < truth_px.size(); ++t) errors.AddFrame(prediction_px[t], truth_px[t]);
  return errors.Result();
}

double DetectionBoxSidePx(const KeypointSequence& detections, int frame, double min_confidence) {
  constexpr int kFewestPoints = 5;
  double x_min = INFINITY, x_max = -INFINITY, y_min = INFINITY, y_max = -INFINITY;
  int count = 0;
  for (int k = 0; k < detections.num_points(); ++k) {
    const Keypoint& p = detections.at(frame, k);
    if (!IsUsed(p, min_confidence)) continue;
    x_min = std::min(x_min, double{p.x});
    x_max = std::max(x_max, double{p.x});
    y_min = std::min(y_min, double{p.y});
    y_max = std::max(y_max, double{p.y});
    ++count;
  }
  return count >= kFewestPoints ? std::max(x_max - x_min, y_max - y_min) : kNotMeasured;
}

void AddReprojectionErrors(PixelClip prediction_px, const KeypointSequence& detections, double min_confidence,
                           ReprojectionErrors* errors) {
  CheckAgainstDetections("AddReprojectionErrors", prediction_px, detections);
  for (size_t t = 0; t < prediction_px.size(); ++t) {
    const int frame = static_cast<int>(t);
    const double height_px = DetectionBoxSidePx(detections, frame, min_confidence);
    for (int k = 0; k < detections.num_points(); ++k) {
      const Keypoint& p = detections.at(frame, k);
      if (!IsUsed(p, min_confidence)) continue;
      const double e = (prediction_px[t].row(k) - Eigen::RowVector2d(p.x, p.y)).norm();
      if (!std::isfinite(e)) {
        ++errors->missing;
        continue;
      }
      errors->px.push_back(e);
      if (height_px > 0) errors->percent_of_height.push_back(100 * e / height_px);
    }
  }
}

double CorrectKeypoints::Share() const {
  return total > 0 ? static_cast<double>(correct) / static_cast<double>(total) : kNotMeasured;
}

void AddCorrectKeypoints(PixelClip prediction_px, const KeypointSequence& detections, double fraction,
                         PckReference reference, double min_confidence, CorrectKeypoints* counts) {
  CheckAgainstDetections("AddCorrectKeypoints", prediction_px, detections);
  BODYLOOM_CHECK(fraction > 0, "AddCorrectKeypoints: fraction ", fraction, " must be positive");
  for (size_t t = 0; t < prediction_px.size(); ++t) {
    const int frame = static_cast<int>(t);
    const double size_px = reference == PckReference::kBox ? DetectionBoxSidePx(detections, frame, min_confidence)
                                                           : TorsoPx(detections, frame, min_confidence);
    if (!(size_px > 0)) continue;
    for (int k = 0; k < detections.num_points(); ++k) {
      const Keypoint& p = detections.at(frame, k);
      if (!IsUsed(p, min_confidence)) continue;
      ++counts->total;
      if ((prediction_px[t].row(k) - Eigen::RowVector2d(p.x, p.y)).norm() <= fraction * size_px) ++counts->correct;
    }
  }
}

}  // namespace bodyloom
