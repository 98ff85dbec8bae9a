// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/dense_clips.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <stdexcept>

#include "data_tools/evaluation/metrics_image.h"
#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/frame_cost.h"
#include "tracking/terms/dense/dense.h"

namespace bodyloom {

DenseFaultOptions DenseFaults(const std::string& noise) {
  DenseFaultOptions faults;
  BODYLOOM_CHECK(noise == "pixel" || noise == "uv" || noise == "densepose", "--noise is '", noise,
                 "', expected pixel, uv or densepose");
  if (noise != "uv") faults.pixel_sigma_px = 1;
  if (noise != "pixel") faults.uv_sigma = 0.02;
  if (noise != "densepose") return faults;
  faults.quantise_uv = true;
  faults.outlier_probability = 0.05;
  faults.missing_part_share = 0.05;
  return faults;
}

Motion FirstFrames(Motion motion, int frames) {
  if (frames > 0 && frames < motion.num_frames()) {
    motion.poses.conservativeResize(frames, motion.poses.cols());
    motion.trans.conservativeResize(frames, 3);
    motion.timestamps.resize(frames);
  }
  return motion;
}

KeypointSequence FirstFrames(KeypointSequence keypoints, int frames) {
  if (frames > 0 && frames < keypoints.num_frames()) {
    keypoints.timestamps.resize(frames);
    keypoints.points.resize(static_cast<size_t>(frames) * keypoints.num_points());
  }
  return keypoints;
}

void LeaveOutFeet(KeypointSequence* keypoints) {
  for (int k = 0; k < keypoints->num_points(); ++k) {
    const std::string& name = keypoints->names[k];
    if (name.find("toe") == std::string::npos && name.find("heel") == std::string::npos) continue;
    for (int t = 0; t < keypoints->num_frames(); ++t) keypoints->at(t, k).confidence = 0;
  }
}

std::string MotionName(const std::string& path) { return std::filesystem::path(path).stem().string().substr(0, 16); }

namespace {

using Eigen::MatrixXd;

Eigen::Vector3d PointInCamera(const BodyModel& body, const MatrixX3d& vertices, const DenseKeypoint& point) {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c) x += point.barycentric[c] * vertices.row(body.data().faces(point.face, c)).transpose();
  return x;
}

/// The keypoints of frame t whose label is not an outlier's.
std::vector<DenseKeypoint> Inliers(const BodyModel& body, const SynthClip& clip, int t, const MatrixX3d& vertices,
                                   double outlier_sigmas) {
  std::vector<DenseKeypoint> result;
  const Camera camera = clip.truth.CameraAt(t);
  for (size_t i = 0; i < clip.dense.frames[t].size(); ++i) {
    const DenseKeypoint& point = clip.dense.frames[t][i];
    Eigen::Vector2d at_label, at_truth;
    if (!camera.Project(PointInCamera(body, vertices, point), &at_label) ||
        !camera.Project(PointInCamera(body, vertices, clip.dense_truth.frames[t][i]), &at_truth)) {
      continue;
    }
    if ((at_label - at_truth).norm() <= outlier_sigmas * point.sigma_px) result.push_back(point);
  }
  return result;
}

/// d pixel / d parameters of the chosen vertices, 2n × num_columns.
MatrixXd VertexJacobian(const FrameLayout& layout, const FrameState& state, const Eigen::VectorXd& betas, int step) {
  Kinematics kinematics;
  kinematics.Set(*layout.model, betas, state.rotations, state.translation, true);
  PointEvaluator evaluator;
  PointEvaluator::VertexCache cache;
  cache.NewFrame(kinematics);
  const int count = (layout.model->num_vertices() + step - 1) / step;
  MatrixXd J = MatrixXd::Zero(2 * count, layout.num_columns);
  for (int i = 0; i < count; ++i) {
    const int corners[3] = {i * step, i * step, i * step};
    const double barycentric[3] = {1, 0, 0};
    const Eigen::Vector3d x = evaluator.Evaluate(kinematics, corners, barycentric, &cache, true);
    Eigen::Vector2d pixel;
    Matrix2x3d d_pixel;
    if (!layout.camera.Project(x, &pixel, &d_pixel)) continue;
    auto rows = J.middleRows(2 * i, 2);
    for (int j : evaluator.joints()) {
      const int column = layout.column_of_joint[j];
      if (column >= 0) rows.middleCols(column, 3) = d_pixel * evaluator.JointJacobian(kinematics, j);
    }
    rows.middleCols(layout.translation_column, 3) = d_pixel;
    rows.middleCols(layout.beta_column, layout.num_betas) = d_pixel * evaluator.ShapeJacobian();
  }
  return J;
}

/// Second differences of the frames' parameters as right increments, (T−2)×p: rotations 3 a joint, then translation.
MatrixXd SecondDifferences(const std::vector<FrameState>& states) {
  const int J = static_cast<int>(states[0].rotations.size());
  MatrixXd d(states.size() - 2, 3 * J + 3);
  for (size_t t = 1; t + 1 < states.size(); ++t) {
    const FrameState &a = states[t - 1], &b = states[t], &c = states[t + 1];
    for (int j = 0; j < J; ++j) {
      d.block<1, 3>(t - 1, 3 * j) = (AxisAngleFromRotation(b.rotations[j].transpose() * c.rotations[j]) -
                                     AxisAngleFromRotation(a.rotations[j].transpose() * b.rotations[j]))
                                        .transpose();
    }
    d.block<1, 3>(t - 1, 3 * J) = (c.translation - 2 * b.translation + a.translation).transpose();
  }
  return d;
}

/// Σ_t (x_{t−1} − 2x_t + x_{t+1})²/σ² in each parameter, σ as in this motion. Timestamps are taken as even.
void AddSmoothness(const std::vector<FrameState>& states, ClipInformation* information) {
  const int T = static_cast<int>(states.size());
  if (T < 3) return;
  const Eigen::Index p = information->band[0][0].rows();
  constexpr double kSmallest = 1e-5;  // radians or metres: a joint that never moves still may
  const Eigen::VectorXd weight = (SecondDifferences(states).colwise().squaredNorm().transpose().array() / (T - 2))
                                     .max(kSmallest * kSmallest)
                                     .inverse();
  for (int k = 1; k <= 2; ++k) information->band.emplace_back(T - k, MatrixXd::Zero(p, p));
  const double stencil[3] = {1, -2, 1};
  for (int t = 0; t + 2 < T; ++t) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; i + k < 3; ++k) {
        information->band[k][t + i].diagonal() += stencil[i] * stencil[i + k] * weight;
      }
    }
  }
}

}  // namespace

ProjectionBound DenseBound(const BodyModel& body, const SynthClip& clip, const DenseBoundOptions& options) {
  const int T = clip.truth.num_frames();
  const int num_betas = std::min(body.num_betas(), 10);
  std::vector<int> joints(body.num_joints());
  std::iota(joints.begin(), joints.end(), 0);
  const FrameLayout layout = FrameLayout::Make(body, CameraKnowledge::kKnown, clip.truth.camera, joints, num_betas);
  const int p = layout.num_frame_columns();
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(num_betas);
  const Eigen::VectorXd& true_betas = clip.truth.motion.betas;
  betas.head(std::min<Eigen::Index>(num_betas, true_betas.size())) =
      true_betas.head(std::min<Eigen::Index>(num_betas, true_betas.size()));

  ClipInformation information;
  information.band.emplace_back();
  information.shared = MatrixXd::Identity(num_betas, num_betas) / (options.beta_sigma * options.beta_sigma);
  std::vector<FrameState> states;
  FrameEvaluator evaluator;
  for (int t = 0; t < T; ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(body, clip.truth.motion.poses.row(t).transpose(), clip.truth.motion.trans.row(t).transpose());
    states.push_back({pose.rotations, pose.trans});
    const std::vector<DenseKeypoint> inliers =
        Inliers(body, clip, t, PoseVertices(body, betas, pose), options.outlier_sigmas);
    FrameData data;
    data.Get<DenseTerm>().points = &inliers;
    data.Get<DenseTerm>().kernel = 1e6;  // no robust weights: the bound of the Gaussian part
    FrameSystem system;
    evaluator.Evaluate(layout, data, states.back(), SharedValues{betas, 0, {}}, true, &system);
    MatrixXd H = system.H.selfadjointView<Eigen::Lower>();
    H.diagonal().head(3 * body.num_joints()).array() += 1 / (options.rotation_sigma_rad * options.rotation_sigma_rad);
    information.band[0].emplace_back(H.topLeftCorner(p, p));
    information.coupling.emplace_back(H.block(0, layout.beta_column, p, num_betas));
    information.shared += H.block(layout.beta_column, layout.beta_column, num_betas, num_betas);
  }
  if (options.smooth) AddSmoothness(states, &information);
  const ClipCovariance covariance = MarginalCovariances(information);
  if (!covariance.is_finite) throw std::runtime_error("Cramér–Rao bound: " + covariance.message);
  ProjectionBoundAccumulator bound;
  for (int t = 0; t < T; ++t) {
    bound.Add(VertexJacobian(layout, states[t], betas, options.vertex_step), covariance.WithShared(t));
  }
  return bound.Result(SquareImageScale(layout.camera.width, layout.camera.height, options.image_side_px));
}

}  // namespace bodyloom
