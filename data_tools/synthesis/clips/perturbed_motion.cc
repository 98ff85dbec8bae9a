// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/clips/perturbed_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "data_tools/synthesis/clips/smooth_curve.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/parallel.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

enum PerturbationStream : uint64_t { kDrifting = 101, kConstant, kShape };

double JointSize(const PerturbationOptions& o, const BodyModel& body, int joint) {
  const std::string name = body.data().joint_names.empty() ? "" : body.data().joint_names[joint];
  if (joint == 0) return o.root_rad;
  const std::pair<const char*, double> kinds[] = {
      {"spine", o.spine_rad}, {"neck", o.spine_rad}, {"collar", o.spine_rad},      {"head", o.end_rad},
      {"hip", o.hip_rad},     {"knee", o.knee_rad},  {"shoulder", o.shoulder_rad}, {"elbow", o.elbow_rad}};
  for (const auto& [kind, size] : kinds) {
    if (name.find(kind) != std::string::npos) return size;
  }
  return o.end_rad;
}

/// T values of mean 0, variance 1: a constant part and a drifting part.
std::vector<double> SmoothError(const std::vector<double>& times, const PerturbationOptions& o, uint64_t seed,
                                uint64_t channel) {
  std::vector<double> values = SmoothDrift(times, o.time_constant_s, HashRandom(seed, {kDrifting, channel}));
  const double constant = std::sqrt(o.constant_share) * HashRandom(seed, {kConstant, channel}).Normal();
  for (double& value : values) value = constant + std::sqrt(1 - o.constant_share) * value;
  return values;
}

/// Unit-size errors; Apply scales them.
struct ErrorField {
  RowMatrixXd angles;     ///< T×3J
  MatrixX3d translation;  ///< T×3
  Eigen::VectorXd shape;

  ErrorField(const BodyModel& body, const Motion& truth, const PerturbationOptions& o, uint64_t seed)
      : angles(truth.num_frames(), truth.poses.cols()), translation(truth.num_frames(), 3), shape(truth.betas) {
    const auto fill = [&](auto column, double size, uint64_t channel) {
      const std::vector<double> values = SmoothError(truth.timestamps, o, seed, channel);
      for (int t = 0; t < truth.num_frames(); ++t) column(t) = size * values[t];
    };
    for (int c = 0; c < angles.cols(); ++c) fill(angles.col(c), JointSize(o, body, c / 3), static_cast<uint64_t>(c));
    for (int c = 0; c < 3; ++c)
      fill(translation.col(c), c < 2 ? o.sideways_m : o.depth_m, 100000 + static_cast<uint64_t>(c));
    HashRandom random(seed, {kShape});
    for (double& value : shape) value = o.shape * random.Normal();
  }

  [[nodiscard]] Motion Apply(const Motion& truth, double size) const {
    Motion motion = truth;
    for (int t = 0; t < truth.num_frames(); ++t) {
      for (int j = 0; j < truth.poses.cols() / 3; ++j) {
        const Vector3d angle = truth.poses.row(t).segment<3>(3 * j).transpose();
        const Vector3d error = size * angles.row(t).segment<3>(3 * j).transpose();
        motion.poses.row(t).segment<3>(3 * j) =
            AxisAngleFromRotation(RotationFromAxisAngle(angle) * RotationFromAxisAngle(error)).transpose();
      }
    }
    motion.trans += size * translation;
    motion.betas += size * shape;
    return motion;
  }
};

}  // namespace

double MeanProjectionError(const BodyModel& body, const Camera& camera, const Motion& a, const Motion& b,
                           int num_threads) {
  BODYLOOM_CHECK(a.num_frames() == b.num_frames() && a.num_frames() > 0, "projection error: ", a.num_frames(), " and ",
                 b.num_frames(), " frames");
  BODYLOOM_CHECK(camera.width > 0 && camera.height > 0, "projection error: the camera has no image size");
  std::vector<double> sums(a.num_frames(), 0.0);
  std::vector<int> counts(a.num_frames(), 0);
  const auto vertices_of = [&](const Motion& motion, int t) {
    return PoseVertices(body, motion.betas,
                        PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose()));
  };
  ParallelFor(a.num_frames(), num_threads, [&](int t) {
    const MatrixX3d x = vertices_of(a, t), y = vertices_of(b, t);
    for (int v = 0; v < x.rows(); ++v) {
      Eigen::Vector2d p, q;
      if (!camera.Project(x.row(v).transpose(), &p) || !camera.Project(y.row(v).transpose(), &q)) continue;
      sums[t] += (p - q).norm();
      ++counts[t];
    }
  });
  double sum = 0;
  int64_t count = 0;
  for (int t = 0; t < a.num_frames(); ++t) sum += sums[t], count += counts[t];
  return count > 0 ? sum / static_cast<double>(count) * 512 / std::max(camera.width, camera.height) : 0;
}

PerturbedMotion PerturbMotion(const BodyModel& body, const Camera& camera, const Motion& truth, double target_px,
                              const PerturbationOptions& options, uint64_t seed, int num_threads) {
  BODYLOOM_CHECK(target_px > 0 && std::isfinite(target_px), "initialiser: error of ", target_px,
                 " px, expected positive");
  const ErrorField errors(body, truth, options, seed);
  const auto error_at = [&](double size) {
    return MeanProjectionError(body, camera, truth, errors.Apply(truth, size), num_threads);
  };
  double low = 0, low_px = 0, high = 1, high_px = error_at(high);
  while (high_px < target_px && high < 8) {
    low = high, low_px = high_px;
    high *= 2;
    high_px = error_at(high);
  }
  BODYLOOM_CHECK(high_px >= target_px, "initialiser: an error of ", target_px,
                 " px at 512 px is out of reach, the largest is ", high_px, " px");
  // The error is nearly proportional to the size, so false position meets it in a few steps.
  double size = high, size_px = high_px;
  for (int i = 0; i < 40 && std::abs(size_px - target_px) > 0.004 * target_px; ++i) {
    const double share = std::clamp((target_px - low_px) / (high_px - low_px), 0.05, 0.95);
    size = low + share * (high - low);
    size_px = error_at(size);
    (size_px < target_px ? low : high) = size;
    (size_px < target_px ? low_px : high_px) = size_px;
  }
  return {errors.Apply(truth, size), size_px};
}

}  // namespace bodyloom
