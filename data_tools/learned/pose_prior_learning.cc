// SPDX-License-Identifier: Apache-2.0
#include "data_tools/learned/pose_prior_learning.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/direction_bins.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

int MirrorJoint(const BodyModel& body, int j) {
  std::string name = body.data().joint_names[j];
  if (name.rfind("l_", 0) == 0) {
    name[0] = 'r';
  } else if (name.rfind("r_", 0) == 0) {
    name[0] = 'l';
  }
  const int mirror = body.FindJoint(name);
  return mirror < 0 ? j : mirror;
}

struct PoseSample {
  VectorXd pose;  ///< 3J axis-angle
  double weight;
};

std::vector<PoseSample> CollectSamples(const std::vector<Motion>& motions, const BodyModel& body, double rate) {
  std::vector<PoseSample> samples;
  for (const Motion& motion : motions) {
    BODYLOOM_CHECK(motion.poses.cols() == 3 * body.num_joints(), "pose prior: a motion has ", motion.poses.cols(),
                   " pose values, the body has 3J = ", 3 * body.num_joints());
    std::vector<int> frames;
    double next = -std::numeric_limits<double>::infinity();
    for (int t = 0; t < motion.num_frames(); ++t) {
      if (motion.timestamps[t] < next - 1e-9) continue;
      frames.push_back(t);
      next = motion.timestamps[t] + 1 / rate;
    }
    const double weight = frames.empty() ? 0 : 1 / std::sqrt(static_cast<double>(frames.size()));
    for (int t : frames) {
      const VectorXd pose = motion.poses.row(t).transpose();
      if (!pose.allFinite()) continue;
      samples.push_back({pose, weight});
      samples.push_back({MirrorPose(body, pose), weight});
    }
  }
  return samples;
}

/// Log density of a Gaussian given the lower Cholesky factor of its covariance.
double LogGaussian(const VectorXd& x, const VectorXd& mean, const Eigen::LLT<MatrixXd>& factor) {
  const VectorXd z = factor.matrixL().solve(x - mean);
  return -0.5 * z.squaredNorm() - factor.matrixLLT().diagonal().array().log().sum() -
         0.5 * static_cast<double>(x.size()) * std::log(2 * std::numbers::pi);
}

void FitMixture(const MatrixXd& X, const VectorXd& weights, const LearnPosePriorOptions& options, PosePrior* prior) {
  const Eigen::Index n = X.cols(), dim = X.rows();
  const int K = std::min<int>(options.num_components, static_cast<int>(n));
  std::mt19937_64 random(options.seed);
  // Start: k-means++ centres, hard assignment.
  MatrixXd centres(dim, K);
  VectorXd distance = VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  for (int k = 0; k < K; ++k) {
    Eigen::Index chosen = 0;
    if (k > 0) {
      const VectorXd mass = weights.cwiseProduct(distance);
      double target = std::uniform_real_distribution<double>(0, mass.sum())(random);
      while (chosen + 1 < n && (target -= mass[chosen]) > 0) ++chosen;
    }
    centres.col(k) = X.col(chosen);
    for (Eigen::Index i = 0; i < n; ++i) distance[i] = std::min(distance[i], (X.col(i) - centres.col(k)).squaredNorm());
  }
  MatrixXd responsibility = MatrixXd::Zero(K, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index nearest;
    (centres.colwise() - X.col(i)).colwise().squaredNorm().minCoeff(&nearest);
    responsibility(nearest, i) = 1;
  }
  prior->log_weights.resize(K);
  prior->means.resize(K, dim);
  prior->covariances.assign(K, MatrixXd());
  const double total = weights.sum();
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    std::vector<Eigen::LLT<MatrixXd>> factors;
    for (int k = 0; k < K; ++k) {
      const VectorXd w = responsibility.row(k).transpose().cwiseProduct(weights);
      const double mass = std::max(w.sum(), 1e-12);
      const VectorXd mean = X * w / mass;
      const MatrixXd centred = (X.colwise() - mean) * w.cwiseSqrt().asDiagonal();
      MatrixXd covariance = centred * centred.transpose() / mass;
      const VectorXd diagonal = covariance.diagonal();
      covariance *= 1 - options.shrinkage;
      covariance.diagonal() += options.shrinkage * diagonal;
      covariance.diagonal().array() += options.floor_rad * options.floor_rad;
      prior->log_weights[k] = std::log(mass / total);
      prior->means.row(k) = mean.transpose();
      factors.emplace_back(covariance);
      prior->covariances[k] = std::move(covariance);
    }
    if (iteration + 1 == options.iterations) break;
    for (Eigen::Index i = 0; i < n; ++i) {
      VectorXd log_density(K);
      for (int k = 0; k < K; ++k) {
        log_density[k] = prior->log_weights[k] + LogGaussian(X.col(i), prior->means.row(k).transpose(), factors[k]);
      }
      const double largest = log_density.maxCoeff();
      const VectorXd e = (log_density.array() - largest).exp();
      responsibility.col(i) = e / e.sum();
    }
  }
}

struct Limb {
  const char *start, *middle, *end;
};

/// Unit directions of a limb's two bones in the torso frame (x left, y up, z front).
bool LimbDirections(const BodyModel& body, const MatrixX3d& joints, const Limb& limb, Vector3d* upper,
                    Vector3d* lower) {
  const auto at = [&](const char* name) -> Vector3d { return joints.row(body.FindJoint(name)).transpose(); };
  const Vector3d up = at("l_shoulder") + at("r_shoulder") - at("l_hip") - at("r_hip");
  const Vector3d left = at("l_shoulder") - at("r_shoulder") + at("l_hip") - at("r_hip");
  Eigen::Matrix3d torso;
  torso.col(1) = up.normalized();
  torso.col(0) = (left - torso.col(1) * torso.col(1).dot(left)).normalized();
  torso.col(2) = torso.col(0).cross(torso.col(1));
  *upper = torso.transpose() * (at(limb.middle) - at(limb.start)).normalized();
  *lower = torso.transpose() * (at(limb.end) - at(limb.middle)).normalized();
  return upper->allFinite() && lower->allFinite();
}

RowMatrixXf LimbDensity(const std::vector<PoseSample>& samples, const std::vector<MatrixX3d>& joints,
                        const BodyModel& body, const Limb& limb, const LearnPosePriorOptions& options) {
  const DirectionBins bins(options.num_directions);
  const int N = bins.size();
  MatrixXd counts = MatrixXd::Zero(N, N);
  for (size_t i = 0; i < samples.size(); ++i) {
    Vector3d upper, lower;
    if (!LimbDirections(body, joints[i], limb, &upper, &lower)) continue;
    counts(bins.Nearest(upper), bins.Nearest(lower)) += samples[i].weight;
  }
  // Smoothing on the sphere by a von Mises–Fisher kernel, each column normalised.
  const double sigma = options.direction_sigma_deg * std::numbers::pi / 180, kappa = 1 / (sigma * sigma);
  MatrixXd kernel(N, N);
  for (int a = 0; a < N; ++a) {
    for (int b = 0; b < N; ++b) kernel(a, b) = std::exp(kappa * (bins.direction(a).dot(bins.direction(b)) - 1));
  }
  kernel.array().rowwise() /= kernel.colwise().sum().eval().array();
  MatrixXd density = kernel * counts * kernel.transpose();
  density /= density.sum();
  density = (1 - options.uniform_share) * density.array() * N * N + options.uniform_share;
  return density.array().log().matrix().cast<float>();
}

}  // namespace

bool LearnPosePriorOptions::IsValid(std::string* why) const {
  if (num_components < 1 || num_directions < 2 || iterations < 1 || !(sample_rate > 0)) {
    *why = "components, directions, iterations and sample rate must be positive";
    return false;
  }
  if (!(floor_rad > 0) || !(shrinkage >= 0 && shrinkage <= 1) || !(uniform_share > 0 && uniform_share < 1) ||
      !(direction_sigma_deg > 0)) {
    *why = "floor_rad and direction_sigma_deg must be positive, shrinkage in [0, 1], uniform_share in (0, 1)";
    return false;
  }
  return true;
}

VectorXd MirrorPose(const BodyModel& body, const VectorXd& axis_angle) {
  VectorXd result(axis_angle.size());
  for (int j = 0; j < body.num_joints(); ++j) {
    const Vector3d w = axis_angle.segment<3>(3 * j);
    result.segment<3>(3 * MirrorJoint(body, j)) = Vector3d(w.x(), -w.y(), -w.z());
  }
  return result;
}

PosePrior LearnPosePrior(const std::vector<Motion>& motions, const BodyModel& body,
                         const LearnPosePriorOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "pose prior: ", why);
  const std::vector<PoseSample> samples = CollectSamples(motions, body, options.sample_rate);
  BODYLOOM_CHECK(!samples.empty(), "pose prior: the motions hold no usable frame");
  PosePrior prior;
  std::vector<int> joints;
  for (int j = 1; j < body.num_joints(); ++j) {
    const std::string& name = body.data().joint_names[j];
    if (name == "l_hand" || name == "r_hand") continue;  // motion capture holds them still
    joints.push_back(j);
    prior.joints.push_back(name);
  }
  MatrixXd X(3 * joints.size(), samples.size());
  VectorXd weights(samples.size());
  std::vector<MatrixX3d> positions;
  for (size_t i = 0; i < samples.size(); ++i) {
    const BodyPose pose = PoseFromAxisAngle(body, samples[i].pose, Vector3d::Zero());
    positions.push_back(PoseSkeleton(body, body.joint_template(), pose).joints);
    for (size_t k = 0; k < joints.size(); ++k) {
      X.block<3, 1>(3 * k, i) = AxisAngleFromRotation(pose.rotations[joints[k]]);
    }
    weights[i] = samples[i].weight;
  }
  FitMixture(X, weights, options, &prior);
  prior.num_directions = options.num_directions;
  prior.arm_log_density = LimbDensity(samples, positions, body, {"l_shoulder", "l_elbow", "l_wrist"}, options);
  prior.leg_log_density = LimbDensity(samples, positions, body, {"l_hip", "l_knee", "l_ankle"}, options);
  return prior;
}

}  // namespace bodyloom
