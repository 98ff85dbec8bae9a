// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/metrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/math/procrustes.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

/// Sum and number of the finite values it was given.
struct FiniteMean {
  double sum = 0;
  int64_t count = 0, missing = 0;
  void Add(double value) {
    if (std::isfinite(value)) {
      sum += value;
      ++count;
    } else {
      ++missing;
    }
  }
  [[nodiscard]] double Value() const { return count > 0 ? sum / static_cast<double>(count) : kNotMeasured; }
};

void CheckSameShape(const char* what, Clip a, Clip b) {
  BODYLOOM_CHECK(a.size() == b.size(), what, ": prediction has ", a.size(), " frames, truth has ", b.size());
  for (size_t t = 0; t < a.size(); ++t) {
    BODYLOOM_CHECK(a[t].rows() == b[t].rows() && a[t].rows() == a[0].rows(), what, ": frame ", t, " has ", a[t].rows(),
                   " predicted and ", b[t].rows(), " true points, frame 0 has ", a[0].rows());
  }
}

}  // namespace

ErrorStatistics Summarize(std::span<const double> values) {
  const std::vector<double> sorted = SortedFinite(values);
  ErrorStatistics s;
  s.count = static_cast<int64_t>(sorted.size());
  s.missing = static_cast<int64_t>(values.size() - sorted.size());
  if (sorted.empty()) return s;
  const auto n = static_cast<double>(sorted.size());
  double sum = 0, squares = 0;
  for (double v : sorted) sum += v;
  s.mean = sum / n;
  for (double v : sorted) squares += (v - s.mean) * (v - s.mean);
  s.std_dev = std::sqrt(squares / n);
  s.median = SortedPercentile(sorted, 50);
  s.p95 = SortedPercentile(sorted, 95);
  s.max = sorted.back();
  return s;
}

double PercentAbove(std::span<const double> values, double limit) {
  int64_t finite = 0, above = 0;
  for (const double value : values) {
    finite += std::isfinite(value) ? 1 : 0;
    above += std::isfinite(value) && value > limit ? 1 : 0;
  }
  return finite > 0 ? 100.0 * static_cast<double>(above) / static_cast<double>(finite) : kNotMeasured;
}

std::vector<bool> HasResults(const Track& track, int frames) {
  std::vector<bool> has_result(frames);
  for (int t = 0; t < frames; ++t) has_result[t] = track.HasResult(t);
  return has_result;
}

std::vector<int> NearestFramesWithResult(const std::vector<bool>& has_result) {
  const int T = static_cast<int>(has_result.size());
  std::vector<int> nearest(T, -1);
  int last = -1;
  for (int t = 0; t < T; ++t) {
    if (has_result[t]) last = t;
    nearest[t] = last;
  }
  if (last < 0) return {};
  int next = -1;
  for (int t = T - 1; t >= 0; --t) {
    if (has_result[t]) next = t;
    if (next >= 0 && (nearest[t] < 0 || next - t < t - nearest[t])) nearest[t] = next;
  }
  return nearest;
}

MatrixX3d RootPositions(Clip points, const std::vector<int>& root) {
  BODYLOOM_CHECK(!root.empty(), "RootPositions: no root point is named");
  MatrixX3d result(points.size(), 3);
  for (size_t t = 0; t < points.size(); ++t) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (int p : root) {
      BODYLOOM_CHECK(p >= 0 && p < points[t].rows(), "RootPositions: root point ", p, " is outside the ",
                     points[t].rows(), " points of frame ", t);
      sum += points[t].row(p);
    }
    result.row(t) = sum / static_cast<double>(root.size());
  }
  return result;
}

std::vector<MatrixX3d> RelativeTo(Clip points, const MatrixX3d& roots) {
  BODYLOOM_CHECK(roots.rows() == static_cast<Eigen::Index>(points.size()), "RelativeTo: ", points.size(), " frames, ",
                 roots.rows(), " roots");
  std::vector<MatrixX3d> result(points.begin(), points.end());
  for (size_t t = 0; t < result.size(); ++t) result[t].rowwise() -= Eigen::RowVector3d(roots.row(t));
  return result;
}

double ClipScale(Clip prediction, Clip truth) {
  CheckSameShape("ClipScale", prediction, truth);
  double product = 0, square = 0;
  for (size_t t = 0; t < prediction.size(); ++t) {
    for (Eigen::Index p = 0; p < prediction[t].rows(); ++p) {
      const Eigen::RowVector3d a = prediction[t].row(p), b = truth[t].row(p);
      if (!a.allFinite() || !b.allFinite()) continue;
      product += a.dot(b);
      square += a.squaredNorm();
    }
  }
  return square > 0 ? product / square : kNotMeasured;
}

void PositionErrorAccumulator::AddFrame(const Eigen::VectorXd& distances) {
  if (frame_means_.empty()) {
    point_sum_ = Eigen::VectorXd::Zero(distances.size());
    point_count_.assign(distances.size(), 0);
  }
  BODYLOOM_CHECK(distances.size() == point_sum_.size(), "PositionErrorAccumulator: frame ", frame_means_.size(),
                 " has ", distances.size(), " points, frame 0 has ", point_sum_.size());
  FiniteMean frame;
  for (Eigen::Index p = 0; p < distances.size(); ++p) {
    frame.Add(distances[p]);
    if (!std::isfinite(distances[p])) continue;
    point_sum_[p] += distances[p];
    ++point_count_[p];
  }
  missing_ += frame.missing;
  frame_means_.push_back(frame.Value());
}

PositionError PositionErrorAccumulator::Result() const {
  PositionError result;
  result.frames = Summarize(frame_means_);
  result.of_frame = frame_means_;
  result.missing = missing_;
  result.per_point = Eigen::VectorXd::Constant(point_sum_.size(), kNotMeasured);
  for (Eigen::Index p = 0; p < point_sum_.size(); ++p) {
    if (point_count_[p] > 0) result.per_point[p] = point_sum_[p] / static_cast<double>(point_count_[p]);
    result.count += point_count_[p];
  }
  if (result.count > 0) result.mean = point_sum_.sum() / static_cast<double>(result.count);
  return result;
}

PositionError MeanPositionError(Clip prediction, Clip truth, double scale) {
  CheckSameShape("MeanPositionError", prediction, truth);
  PositionErrorAccumulator errors;
  for (size_t t = 0; t < prediction.size(); ++t) {
    errors.AddFrame((scale * prediction[t] - truth[t]).rowwise().norm());
  }
  return errors.Result();
}

PositionError ProcrustesPositionError(Clip prediction, Clip truth) {
  CheckSameShape("ProcrustesPositionError", prediction, truth);
  PositionErrorAccumulator errors;
  for (size_t t = 0; t < prediction.size(); ++t) {
    const AlignmentResult alignment = AlignPoints(prediction[t], truth[t]);
    errors.AddFrame((alignment.target_from_source.Apply(prediction[t]) - truth[t]).rowwise().norm());
  }
  return errors.Result();
}

RootError RootPositionError(const MatrixX3d& prediction, const MatrixX3d& truth) {
  BODYLOOM_CHECK(prediction.rows() == truth.rows(), "RootPositionError: prediction has ", prediction.rows(),
                 " frames, truth has ", truth.rows());
  std::vector<double> distances;
  FiniteMean lateral, depth;
  for (Eigen::Index t = 0; t < truth.rows(); ++t) {
    const Eigen::RowVector3d d = prediction.row(t) - truth.row(t);
    distances.push_back(d.norm());
    if (!d.allFinite()) continue;
    lateral.Add(d.head<2>().norm());
    depth.Add(std::abs(d.z()));
  }
  return {Summarize(distances), lateral.Value(), depth.Value()};
}

std::vector<MatrixX3d> TimeDerivative(Clip points, const std::vector<double>& timestamps, int order,
                                      double max_step_s) {
  const size_t T = points.size();
  BODYLOOM_CHECK(order >= 1 && order <= 3, "TimeDerivative: order ", order, ", expected 1, 2 or 3");
  BODYLOOM_CHECK(timestamps.size() == T, "TimeDerivative: ", T, " frames, ", timestamps.size(), " timestamps");
  std::vector<double> steps;
  for (size_t t = 1; t < T; ++t) {
    BODYLOOM_CHECK(timestamps[t] > timestamps[t - 1], "TimeDerivative: timestamp ", t, " (", timestamps[t],
                   " s) does not follow ", timestamps[t - 1], " s");
    BODYLOOM_CHECK(points[t].rows() == points[0].rows(), "TimeDerivative: frame ", t, " has ", points[t].rows(),
                   " points, frame 0 has ", points[0].rows());
    steps.push_back(timestamps[t] - timestamps[t - 1]);
  }
  const double max_step = max_step_s > 0 ? max_step_s : 1.5 * Percentile(steps, 50);

  // Newton's table of divided differences, one column an order: [x_t … x_{t+k}] = ([x_{t+1} …] − [x_t …]) / Δ.
  std::vector<MatrixX3d> table(points.begin(), points.end());
  double factorial = 1;
  for (int k = 1; k <= order; ++k) {
    factorial *= k;
    if (table.empty()) return {};
    for (size_t t = 0; t + 1 < table.size(); ++t) {
      table[t] = (table[t + 1] - table[t]) / (timestamps[t + k] - timestamps[t]);
      if (k == 1 && steps[t] > max_step) table[t].setConstant(kNotMeasured);
    }
    table.pop_back();
  }
  for (MatrixX3d& derivative : table) derivative *= factorial;
  return table;
}

MotionError AccelerationError(Clip prediction, Clip truth, const std::vector<double>& timestamps, double max_step_s) {
  CheckSameShape("AccelerationError", prediction, truth);
  const std::vector<MatrixX3d> a = TimeDerivative(prediction, timestamps, 2, max_step_s);
  const std::vector<MatrixX3d> b = TimeDerivative(truth, timestamps, 2, max_step_s);
  FiniteMean error, mean_prediction, mean_truth;
  for (size_t t = 0; t < a.size(); ++t) {
    for (Eigen::Index p = 0; p < a[t].rows(); ++p) {
      error.Add((a[t].row(p) - b[t].row(p)).norm());
      mean_prediction.Add(a[t].row(p).norm());
      mean_truth.Add(b[t].row(p).norm());
    }
  }
  return {error.Value(), mean_prediction.Value(), mean_truth.Value(), error.count, error.missing};
}

double Jitter(Clip points, const std::vector<double>& timestamps, double max_step_s) {
  FiniteMean mean;
  for (const MatrixX3d& jerk : TimeDerivative(points, timestamps, 3, max_step_s)) {
    for (Eigen::Index p = 0; p < jerk.rows(); ++p) mean.Add(jerk.row(p).norm());
  }
  return mean.Value();
}

JointAngleError MeanJointAngleError(const RowMatrixXd& prediction, const RowMatrixXd& truth) {
  BODYLOOM_CHECK(prediction.rows() == truth.rows() && prediction.cols() == truth.cols() && truth.cols() % 3 == 0,
                 "MeanJointAngleError: prediction is ", prediction.rows(), "x", prediction.cols(), ", truth ",
                 truth.rows(), "x", truth.cols(), ", expected the same T×3J");
  const Eigen::Index T = truth.rows(), J = truth.cols() / 3;
  std::vector<FiniteMean> joints(J);
  std::vector<double> frame_means;
  FiniteMean body;
  for (Eigen::Index t = 0; t < T; ++t) {
    FiniteMean frame;
    for (Eigen::Index j = 0; j < J; ++j) {
      const Eigen::Vector3d a = prediction.row(t).segment<3>(3 * j), b = truth.row(t).segment<3>(3 * j);
      const double angle_deg =
          a.allFinite() && b.allFinite()
              ? RotationAngleBetween(RotationFromAxisAngle(a), RotationFromAxisAngle(b)) * 180 / std::numbers::pi
              : kNotMeasured;
      joints[j].Add(angle_deg);
      if (j == 0) continue;
      frame.Add(angle_deg);
      body.Add(angle_deg);
    }
    frame_means.push_back(frame.Value());
  }
  JointAngleError result;
  result.mean_deg = body.Value();
  result.frames = Summarize(frame_means);
  result.per_joint_deg.resize(J);
  for (Eigen::Index j = 0; j < J; ++j) {
    result.per_joint_deg[j] = joints[j].Value();
    result.count += joints[j].count;
    result.missing += joints[j].missing;
  }
  if (J > 0) result.root_deg = joints[0].Value();
  return result;
}

}  // namespace bodyloom
