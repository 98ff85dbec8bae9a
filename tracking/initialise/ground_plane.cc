// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/ground_plane.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/robust.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUpKernelRad = 0.17, kMaxUpSpreadDeg = 20;
constexpr double kAcrossM = 0.02;  ///< σ of a stance's place across the view
constexpr double kRadToDeg = 180 / M_PI;
constexpr double kMaxStandingStepS = 0.25;
constexpr size_t kMinStandingPairs = 10;

double WeightedMedian(std::vector<std::pair<double, double>> value_weight) {
  std::sort(value_weight.begin(), value_weight.end());
  double total = 0, sum = 0;
  for (const auto& [value, weight] : value_weight) total += weight;
  for (const auto& [value, weight] : value_weight) {
    sum += weight;
    if (2 * sum >= total) return value;
  }
  return 0;
}

/// The component of d across the view: perpendicular to the ray to the foot.
Vector3d AcrossView(const Vector3d& d, const FootPlace& place) {
  const Vector3d ray = (place.ankle_m - place.camera_m).normalized();
  return d - ray.dot(d) * ray;
}

double TotalSeconds(const std::vector<Stance>& stances) {
  double total = 0;
  for (const Stance& stance : stances) total += stance.seconds;
  return total;
}

/// Keeps the stances on the plane of `ground`, moved towards it. Returns the seconds that they last.
double Stand(std::vector<Stance> stances, const GroundPlaneOptions& options, GroundPlane* ground) {
  const double total = TotalSeconds(stances);
  double on_ground = 0;
  std::vector<std::pair<double, double>> off;
  for (Stance& stance : stances) {
    const double height = ground->normal.dot(stance.place_m) - ground->offset_m;
    off.emplace_back(std::abs(height), stance.seconds);
    if (!(std::abs(height) <= options.off_ground_m)) continue;
    on_ground += stance.seconds;
    const Vector3d ray = stance.Ray();
    const Vector3d step =
        kAcrossM * kAcrossM * ground->normal + options.depth_m * options.depth_m * ray * ray.dot(ground->normal);
    stance.place_m -= step * height / (ground->normal.dot(step) + options.height_m * options.height_m);
    ground->stances.push_back(stance);
  }
  ground->share = on_ground / total;
  ground->spread_m = 1.4826 * WeightedMedian(std::move(off));
  return on_ground;
}

/// Marks the plane of Stand() as found if `accepted`; otherwise sets the reason `why` not.
GroundPlane Accepted(GroundPlane ground, bool accepted, const std::string& why) {
  ground.found = accepted;
  ground.why = accepted ? std::to_string(ground.stances.size()) + " stances on it" : why;
  if (!accepted) ground.stances.clear();
  return ground;
}

constexpr const char* kNobodyStands = "no foot is seen to stand for long enough";

void CheckFeet(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps) {
  BODYLOOM_CHECK(feet.size() == timestamps.size(), "ground: ", feet.size(), " frames of feet but ", timestamps.size(),
                 " timestamps");
}

}  // namespace

UpEstimate EstimateUp(std::span<const LiftedFrame> frames) {
  UpEstimate estimate;
  Vector3d mean = Vector3d::Zero();
  for (int pass = 0; pass < 6; ++pass) {
    Vector3d sum = Vector3d::Zero();
    for (const LiftedFrame& frame : frames) {
      if (!frame.seen || !frame.up.allFinite()) continue;
      double weight = 1 / std::max(1e-4, frame.up_sigma * frame.up_sigma);
      if (pass > 0) weight /= 1 + (frame.up - mean).squaredNorm() / (kUpKernelRad * kUpKernelRad);
      sum += weight * frame.up;
    }
    if (!(sum.norm() > 0)) return estimate;
    mean = sum.normalized();
  }
  std::vector<std::pair<double, double>> angles;
  for (const LiftedFrame& frame : frames) {
    if (!frame.seen || !frame.up.allFinite()) continue;
    angles.emplace_back(kRadToDeg * std::acos(std::clamp(frame.up.dot(mean), -1.0, 1.0)), 1);
  }
  estimate.up = mean;
  estimate.spread_deg = WeightedMedian(std::move(angles));
  estimate.found = estimate.spread_deg <= kMaxUpSpreadDeg;
  return estimate;
}

UpEstimate EstimateUp(std::span<const LiftedFrame> frames, std::span<const CameraPose> camera_from_scene) {
  std::vector<LiftedFrame> turned(frames.begin(), frames.end());
  for (size_t t = 0; t < turned.size(); ++t) {
    turned[t].up = camera_from_scene[t].camera_from_world_rotation.transpose() * frames[t].up;
  }
  return EstimateUp(turned);
}

JoinedUps JoinUps(std::span<const UpOfView> views) {
  Vector3d mean = Vector3d::Zero();
  for (const UpOfView& view : views) mean += view.up;
  mean.normalize();
  Eigen::Matrix<double, 2, 3> across;
  across.row(0) = mean.unitOrthogonal().transpose();
  across.row(1) = mean.cross(across.row(0).transpose()).transpose();
  Eigen::Matrix3d H = Eigen::Vector3d(0, 0, 1 / (kUpAlongRad * kUpAlongRad)).asDiagonal();
  Vector3d rhs = Vector3d::Zero();
  for (const UpOfView& view : views) {
    Eigen::Matrix<double, 2, 3> J;
    J << Eigen::Matrix2d::Identity(), across * view.axis;
    H += J.transpose() * J / (kUpAcrossRad * kUpAcrossRad);
    rhs += J.transpose() * (across * view.up) / (kUpAcrossRad * kUpAcrossRad);
  }
  const Eigen::Matrix3d covariance = H.inverse();
  const Vector3d x = covariance * rhs;
  return {(mean + across.transpose() * x.head<2>()).normalized(),
          std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)))};
}

std::vector<Stance> FindStances(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                                const GroundPlaneOptions& options) {
  CheckFeet(feet, timestamps);
  const int T = static_cast<int>(feet.size());
  std::vector<Stance> stances;
  for (int foot = 0; foot < 2; ++foot) {
    const auto stands = [&](int t) {
      const FootPlace& place = feet[t][foot];
      if (!place.seen || !(place.contact >= options.min_contact) || !place.ankle_m.allFinite()) return false;
      const int before = std::max(0, t - 1), after = std::min(T - 1, t + 1);
      const double seconds = timestamps[after] - timestamps[before];
      const Vector3d moved = feet[after][foot].ankle_m - feet[before][foot].ankle_m;
      return !(seconds > 0) || AcrossView(moved, place).norm() <= options.max_speed * seconds;
    };
    for (int t = 0; t < T;) {
      if (!stands(t)) {
        ++t;
        continue;
      }
      Stance stance;
      stance.foot = foot;
      stance.begin = t;
      Vector3d sum = Vector3d::Zero(), cameras = Vector3d::Zero();
      for (; t < T && stands(t); ++t) {
        const Vector3d& at = feet[t][foot].ankle_m;
        if (t > stance.begin && AcrossView(at - sum / (t - stance.begin), feet[t][foot]).norm() > options.max_drift_m)
          break;
        sum += at;
        cameras += feet[t][foot].camera_m;
      }
      stance.end = t;
      stance.place_m = sum / (stance.end - stance.begin);
      stance.camera_m = cameras / (stance.end - stance.begin);
      stance.seconds = timestamps[stance.end - 1] - timestamps[stance.begin];
      if (stance.seconds >= options.min_stance_s) stances.push_back(stance);
    }
  }
  return stances;
}

double StandingSpeed(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                     const GroundPlaneOptions& options) {
  CheckFeet(feet, timestamps);
  std::vector<std::pair<double, double>> speeds;
  for (size_t t = 1; t < feet.size(); ++t) {
    const double seconds = timestamps[t] - timestamps[t - 1];
    for (int foot = 0; foot < 2; ++foot) {
      const FootPlace &before = feet[t - 1][foot], &after = feet[t][foot];
      if (!(before.seen && after.seen && seconds <= kMaxStandingStepS)) continue;
      if (!(std::min(before.contact, after.contact) >= options.min_contact)) continue;
      const double speed = AcrossView(after.ankle_m - before.ankle_m, after).norm() / seconds;
      if (std::isfinite(speed)) speeds.emplace_back(speed, 1);
    }
  }
  if (speeds.size() < kMinStandingPairs) return std::numeric_limits<double>::quiet_NaN();
  return WeightedMedian(std::move(speeds));
}

GroundPlane EstimateGroundPlane(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                                const Vector3d& up, const GroundPlaneOptions& options) {
  GroundPlane ground;
  ground.normal = up;
  const std::vector<Stance> stances = FindStances(feet, timestamps, options);
  if (TotalSeconds(stances) < options.min_total_s) return Accepted(ground, false, kNobodyStands);

  // Heights above a plane through the camera that is tilted by (a, b) about up: linear in a, b and the offset.
  const Vector3d e1 = up.unitOrthogonal(), e2 = up.cross(e1);
  std::vector<std::pair<double, double>> heights;
  heights.reserve(stances.size());
  for (const Stance& stance : stances) heights.emplace_back(up.dot(stance.place_m), stance.seconds);
  Vector3d x(0, 0, WeightedMedian(heights));  // a, b, offset
  for (int pass = 0; pass < 10; ++pass) {
    Matrix3d H = Matrix3d::Zero();
    H(0, 0) = H(1, 1) = 1 / (options.up_rad * options.up_rad);
    Vector3d rhs = Vector3d::Zero();
    for (const Stance& stance : stances) {
      const Vector3d& p = stance.place_m;
      const double along = up.dot(stance.Ray()) * options.depth_m;
      const double information = 1 / (options.height_m * options.height_m + along * along);
      const Vector3d row(e1.dot(p), e2.dot(p), -1);
      const double residual = up.dot(p) + row.dot(x);
      // The weight is proportional to the seconds of standing, up to one second: longer stances are still one position.
      const double weight =
          std::min(1.0, stance.seconds) * information * GemanMcClure(residual * residual * information, 3).weight;
      H += weight * row * row.transpose();
      rhs -= weight * up.dot(p) * row;
    }
    if (!(H(2, 2) > 0)) break;
    x = H.ldlt().solve(rhs);
    const Matrix3d covariance = H.inverse();
    ground.up_sigma_rad = std::sqrt(covariance(0, 0) + covariance(1, 1));
    ground.offset_sigma_m = std::sqrt(1 / H(2, 2));
  }
  const double length = (up + x[0] * e1 + x[1] * e2).norm();
  ground.normal = (up + x[0] * e1 + x[1] * e2) / length;
  ground.offset_m = x[2] / length;

  const double on_ground = Stand(stances, options, &ground);
  const bool accepted =
      on_ground >= options.min_total_s && ground.share >= options.min_share && ground.spread_m <= options.max_spread_m;
  return Accepted(std::move(ground), accepted, "feet do not stand at one height");
}

GroundPlane StandOnPlane(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                         const Vector3d& normal, double offset_m, const GroundPlaneOptions& options) {
  GroundPlane ground;
  ground.normal = normal;
  ground.offset_m = offset_m;
  std::vector<Stance> stances = FindStances(feet, timestamps, options);
  if (TotalSeconds(stances) < options.min_total_s) return Accepted(ground, false, kNobodyStands);
  const double on_ground = Stand(std::move(stances), options, &ground);
  return Accepted(std::move(ground), on_ground >= options.min_total_s, "feet do not stand on the given plane");
}

namespace {

constexpr float kSeenConfidence = 0.3F;

}  // namespace

std::vector<std::array<FootPlace, 2>> ObservedFeet(const SequenceProblem& problem, const std::vector<int>& frames,
                                                   const std::vector<LiftedFrame>& lifted,
                                                   const LiftedLandmarks& landmarks, const KeypointSequence& keypoints,
                                                   int left_point) {
  std::array<int, 2> column{-1, -1};
  for (int foot = 0; foot < 2; ++foot) {
    const std::string& name = LifterPointNames()[kLifterLeftAnkle + foot];
    const auto it = std::find(keypoints.names.begin(), keypoints.names.end(), name);
    if (it != keypoints.names.end()) column[foot] = static_cast<int>(it - keypoints.names.begin());
  }
  Kinematics kinematics;
  PointEvaluator points;
  std::vector<std::array<FootPlace, 2>> feet(frames.size());
  for (size_t i = 0; i < frames.size(); ++i) {
    const int t = frames[i];
    const FrameState& state = problem.states[i];
    kinematics.Set(*problem.layout.model, problem.betas, state.rotations, Eigen::Vector3d::Zero(), false);
    for (int foot = 0; foot < 2; ++foot) {
      FootPlace& place = feet[i][foot];
      place.ankle_m =
          points.Evaluate(kinematics, landmarks.points[left_point + foot], false) + problem.layout.BodyPlace(state);
      if (const CameraPose* camera = problem.frames[i].camera_from_scene; camera != nullptr) {
        place.camera_m = CentreOf(*camera);
      }
      place.contact = lifted[t].contact[foot];
      place.seen = column[foot] >= 0 && keypoints.at(t, column[foot]).confidence >= kSeenConfidence;
    }
  }
  return feet;
}

}  // namespace bodyloom
