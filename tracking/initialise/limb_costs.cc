// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/limb_costs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/math/rotation.h"

namespace bodyloom::hypotheses_internal {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// The point of the ray at distance `length` from `start`, nearer or farther; the closest one if none is.
Vector3d OnRay(const Vector2d& ray, const Vector3d& start, double length, bool far) {
  const Vector3d d = Vector3d(ray.x(), ray.y(), 1).normalized();
  const double along = d.dot(start), discriminant = along * along - start.squaredNorm() + length * length;
  if (discriminant <= 0) return along * d;
  return (along + (far ? 1 : -1) * std::sqrt(discriminant)) * d;
}

/// A joint behind the torso is detected with low confidence (0.1), one in front with high (0.7).
double Occlusion(double confidence, const Vector3d& point, const Matrix3d& torso, const Vector3d& centre) {
  const Vector3d offset = point - centre, up = torso.col(1);
  const Vector3d across = offset - up * up.dot(offset);
  const double sideways = std::hypot(across.x(), across.y());
  const bool hidden = sideways < 0.16 && std::abs(up.dot(offset)) < 0.35 && offset.z() > 0.09;
  const double expected = hidden ? 0.12 : 0.7;
  const double z = (std::min(confidence, 0.7) - expected) / 0.25;
  return Saturated(z * z, 4);
}

}  // namespace

LimbCosts::LimbCosts(const PosePrior* prior, const Lengths& lengths, const JointHypothesesOptions& options)
    : lengths_(lengths), options_(options) {
  if (prior != nullptr && prior->num_directions > 0) {
    prior_ = prior;
    bins_.emplace(prior->num_directions);
  }
}

/// −log density of a limb's two unit bone directions in the torso frame; its minimum is not normalised to 0.
double LimbCosts::Density(int limb, Vector3d upper, Vector3d lower) const {
  if (prior_ == nullptr) return 0;
  if (limb % 2 == 1) {
    upper.x() = -upper.x();
    lower.x() = -lower.x();
  }
  const RowMatrixXf& table = limb < 2 ? prior_->arm_log_density : prior_->leg_log_density;
  return -table(bins_->Nearest(upper), bins_->Nearest(lower));
}

void LimbCosts::Hypotheses(const Rays& rays, int limb, const Vector3d& start, Vector3d middle[4],
                           Vector3d end[4]) const {
  for (int h = 0; h < 4; ++h) {
    middle[h] = OnRay(rays.ray[kLimbs[limb][1]], start, lengths_.upper[limb], (h & 1) != 0);
    end[h] = OnRay(rays.ray[kLimbs[limb][2]], middle[h], lengths_.lower[limb], (h & 2) != 0);
  }
}

double LimbCosts::Cost(const Rays& rays, int limb, const Matrix3d& torso, const Vector3d& torso_centre,
                       const Vector3d& start, const Vector3d& middle, const Vector3d& end) const {
  double cost = options_.density_weight * Density(limb, torso.transpose() * (middle - start).normalized(),
                                                  torso.transpose() * (end - middle).normalized());
  if (limb < 2) {
    cost += options_.occlusion_weight * (Occlusion(rays.confidence[kLimbs[limb][1]], middle, torso, torso_centre) +
                                         Occlusion(rays.confidence[kLimbs[limb][2]], end, torso, torso_centre));
  }
  return cost;
}

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kNumYaw = 24, kNumTilt = 7;
constexpr double kTiltStep = kPi / 9;     // 20°: tilts −60° … 60°
constexpr double kUprightTilt = kPi / 9;  // σ of the trunk's lean towards or away from a level camera

double Logistic(double x) { return 1 / (1 + std::exp(-x)); }

/// camera-from-torso for heading `yaw` (0: facing the camera), tilt of the spine towards the camera and roll in the
/// image.
Matrix3d TorsoRotation(double yaw, double tilt, double roll) {
  const Matrix3d facing = Vector3d(1, -1, -1).asDiagonal();  // body left → image right, up → −y, front → towards camera
  return RotationFromAxisAngle({0, 0, roll}) * RotationFromAxisAngle({tilt, 0, 0}) * facing *
         RotationFromAxisAngle({0, yaw, 0});
}

/// Cost of the face's visibility for a head that points along the torso's front.
double FaceCost(const Rays& rays, const Matrix3d& torso, double depth) {
  const Vector3d to_camera(0, 0, -1);
  const double front = torso.col(2).dot(to_camera), left = torso.col(0).dot(to_camera);
  const auto mismatch = [&](int k, double expected) {
    const double z = (std::min(rays.confidence[k], 1.0) - expected) / 0.35;
    return Saturated(z * z, 4);
  };
  // The head turns by ±60° against the torso, so the visibility curves are wider than those of a head alone.
  double cost = mismatch(kNose, 0.95 * Logistic((front + 0.5) / 0.3)) +
                0.5 * mismatch(kLeftEye, 0.95 * Logistic((front * 0.9 + left * 0.4 + 0.3) / 0.3)) +
                0.5 * mismatch(kRightEye, 0.95 * Logistic((front * 0.9 - left * 0.4 + 0.3) / 0.3)) +
                0.5 * mismatch(kLeftEar, 0.9 * Logistic((left + 0.35) / 0.3)) +
                0.5 * mismatch(kRightEar, 0.9 * Logistic((-left + 0.35) / 0.3));
  // Sideways position of the nose between or before the ears shows which way the head looks.
  Vector2d ears = Vector2d::Zero();
  int count = 0;
  for (int k : {kLeftEar, kRightEar}) {
    if (rays.seen[k]) {
      ears += rays.ray[k];
      ++count;
    }
  }
  if (rays.seen[kNose] && count > 0 && rays.confidence[kNose] > 0.4) {
    Vector2d nose = (rays.ray[kNose] - ears / count) * depth;
    // A single ear sits 7 cm off the middle, on its side.
    if (count == 1) nose += (rays.seen[kLeftEar] ? 1 : -1) * 0.07 * torso.col(0).head<2>();
    const double z = (nose.x() / 0.11 - torso(0, 2)) / 0.6;
    cost += Saturated(z * z, 4);
  }
  return cost;
}

/// The roll that best aligns the state's projected torso with the observed one, and the remaining squared distance in
/// units of the detection noise.
double FitRoll(const Rays& rays, const Matrix3d& unrolled, double depth, const Lengths& lengths, double* roll) {
  const Vector3d rest_centre = Centroid(lengths.rest, kTorso);
  Vector2d seen_centre = Vector2d::Zero();
  for (int k : kTorso) seen_centre += rays.ray[k] / 4;
  std::array<Vector2d, 4> model, seen;
  double dot = 0, cross = 0;
  for (int i = 0; i < 4; ++i) {
    model[i] = (unrolled * (lengths.rest.row(kTorso[i]).transpose() - rest_centre)).head<2>();
    seen[i] = (rays.ray[kTorso[i]] - seen_centre) * depth;
    dot += model[i].dot(seen[i]);
    cross += model[i].x() * seen[i].y() - model[i].y() * seen[i].x();
  }
  *roll = std::atan2(cross, dot);
  const double c = std::cos(*roll), s = std::sin(*roll);
  double cost = 0;
  for (int i = 0; i < 4; ++i) {
    const Vector2d turned(c * model[i].x() - s * model[i].y(), s * model[i].x() + c * model[i].y());
    cost += (turned - seen[i]).squaredNorm();
  }
  return cost / (0.035 * 0.035);
}

}  // namespace

Vector3d Centroid(const MatrixX3d& points, const std::array<int, 4>& ids) {
  Vector3d sum = Vector3d::Zero();
  for (int k : ids) sum += points.row(k).transpose() / 4;
  return sum;
}

std::vector<TorsoState> TorsoStates(const Rays& rays, double depth, const Lengths& lengths,
                                    const JointHypothesesOptions& options) {
  std::vector<TorsoState> states;
  for (int y = 0; y < kNumYaw; ++y) {
    for (int p = 0; p < kNumTilt; ++p) {
      const int steps = p - kNumTilt / 2;
      const double yaw = 2 * kPi * y / kNumYaw, tilt = steps * kTiltStep;
      TorsoState state;
      double roll;
      state.cost = Saturated(FitRoll(rays, TorsoRotation(yaw, tilt, 0), depth, lengths, &roll), 30);
      state.rotation = TorsoRotation(yaw, tilt, roll);
      const double lean = tilt / kUprightTilt;
      state.cost += 0.5 * options.upright_weight * Saturated(lean * lean, 6);
      state.cost += options.face_weight * FaceCost(rays, state.rotation, depth);
      states.push_back(state);
    }
  }
  return states;
}

}  // namespace bodyloom::hypotheses_internal
