// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/joint_hypotheses.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "geometry/check.h"
#include "geometry/direction_bins.h"
#include "geometry/posed_body.h"
#include "geometry/rotation.h"
#include "tracking/initialise/viterbi.h"
#include "tracking/robust.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr int kNumYaw = 24, kNumTilt = 7;
constexpr double kTiltStep = kPi / 9;     // 20°: tilts −60° … 60°
constexpr double kUprightTilt = kPi / 9;  // σ of the trunk's lean towards or away from a level camera
enum Coco {
  kNose = 0,
  kLeftEye,
  kRightEye,
  kLeftEar,
  kRightEar,
  kLeftShoulder,
  kRightShoulder,
  kLeftHip = 11,
  kRightHip
};

/// One frame's detections as normalised rays (x/z, y/z) with confidences, in CocoNames() order.
struct Rays {
  std::array<Vector2d, 17> ray;
  std::array<double, 17> confidence{};
  std::array<bool, 17> seen{};
  [[nodiscard]] bool has_torso() const {
    return seen[kLeftShoulder] && seen[kRightShoulder] && seen[kLeftHip] && seen[kRightHip];
  }
};

double Logistic(double x) { return 1 / (1 + std::exp(-x)); }
double Saturated(double squared, double limit) { return limit * squared / (limit + squared); }

/// Lengths of the body that the hypotheses need, metres.
struct Lengths {
  double torso, upper[4], lower[4];
  MatrixX3d rest;
  explicit Lengths(const MatrixX3d& rest_points) : rest(rest_points) {
    torso =
        ((rest.row(kLeftShoulder) + rest.row(kRightShoulder)) - (rest.row(kLeftHip) + rest.row(kRightHip))).norm() / 2;
    for (int l = 0; l < 4; ++l) {
      upper[l] = (rest.row(kLimbs[l][1]) - rest.row(kLimbs[l][0])).norm();
      lower[l] = (rest.row(kLimbs[l][2]) - rest.row(kLimbs[l][1])).norm();
    }
  }
};

std::vector<Rays> RaysOfFrames(const KeypointSequence& keypoints, const Camera& camera, const std::vector<int>& frames,
                               const JointHypothesesOptions& options) {
  std::array<int, 17> column;
  for (int k = 0; k < 17; ++k) {
    const auto it = std::find(keypoints.names.begin(), keypoints.names.end(), CocoNames()[k]);
    column[k] = it == keypoints.names.end() ? -1 : static_cast<int>(it - keypoints.names.begin());
  }
  std::vector<Rays> result;
  for (int t : frames) {
    Rays rays;
    for (int k = 0; k < 17; ++k) {
      rays.ray[k].setConstant(std::numeric_limits<double>::quiet_NaN());
      if (column[k] < 0) continue;
      const Keypoint& point = keypoints.at(t, column[k]);
      if (!(point.confidence > 0) || !std::isfinite(point.x) || !std::isfinite(point.y)) continue;
      rays.ray[k] = camera.Unproject({point.x, point.y});
      rays.confidence[k] = point.confidence;
      rays.seen[k] = point.confidence >= options.confidence && rays.ray[k].allFinite();
    }
    for (const auto& [a, b] : {std::pair(kLeftShoulder, kRightShoulder), std::pair(kLeftHip, kRightHip)}) {
      if (!options.hidden_pairs || rays.seen[a] == rays.seen[b]) continue;
      const int from = rays.seen[a] ? a : b, to = rays.seen[a] ? b : a;
      rays.ray[to] = rays.ray[from];
      rays.seen[to] = true;
    }
    result.push_back(rays);
  }
  return result;
}

/// Depth of the root for every frame: body length over its apparent length, the apparent length being the 85th
/// percentile over ±1.5 s (bones only ever look shorter), smoothed over the same window.
std::vector<double> RootDepths(const std::vector<Rays>& rays, const std::vector<double>& times,
                               const Lengths& lengths) {
  const size_t T = rays.size();
  std::vector<double> size(T, std::numeric_limits<double>::quiet_NaN());
  const double body = lengths.torso + (lengths.upper[2] + lengths.upper[3] + lengths.lower[2] + lengths.lower[3]) / 2;
  for (size_t t = 0; t < T; ++t) {
    const Rays& r = rays[t];
    if (!r.has_torso()) continue;
    const double torso =
        ((r.ray[kLeftShoulder] + r.ray[kRightShoulder]) - (r.ray[kLeftHip] + r.ray[kRightHip])).norm() / 2;
    double legs = 0;
    int count = 0;
    for (int l = 2; l < 4; ++l) {
      if (!r.seen[kLimbs[l][1]] || !r.seen[kLimbs[l][2]]) continue;
      legs += (r.ray[kLimbs[l][1]] - r.ray[kLimbs[l][0]]).norm() + (r.ray[kLimbs[l][2]] - r.ray[kLimbs[l][1]]).norm();
      ++count;
    }
    // Without legs the torso alone stands for the body.
    size[t] = count > 0 ? torso + legs / count : torso * body / lengths.torso;
  }
  const auto percentile = [&](size_t t, double half_window, double q) {
    std::vector<double> values;
    for (size_t u = 0; u < T; ++u) {
      if (std::abs(times[u] - times[t]) <= half_window && std::isfinite(size[u])) values.push_back(size[u]);
    }
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const size_t k = static_cast<size_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
    return values[k];
  };
  std::vector<double> envelope(T), depth(T);
  for (size_t t = 0; t < T; ++t) {
    envelope[t] = percentile(t, 1.5, 0.85);
    if (!std::isfinite(envelope[t])) envelope[t] = percentile(t, std::numeric_limits<double>::infinity(), 0.85);
  }
  for (size_t t = 0; t < T; ++t) {
    double sum = 0, weight = 0;
    for (size_t u = 0; u < T; ++u) {
      const double w = 1 - std::abs(times[u] - times[t]) / 1.5;
      if (w > 0) {
        sum += w * envelope[u];
        weight += w;
      }
    }
    depth[t] = body * weight / sum;
  }
  return depth;
}

/// camera-from-torso for heading `yaw` (0: facing the camera), tilt of the spine towards the camera and roll in the
/// image.
Matrix3d TorsoRotation(double yaw, double tilt, double roll) {
  const Matrix3d facing = Vector3d(1, -1, -1).asDiagonal();  // body left → image right, up → −y, front → towards camera
  return RotationFromAxisAngle({0, 0, roll}) * RotationFromAxisAngle({tilt, 0, 0}) * facing *
         RotationFromAxisAngle({0, yaw, 0});
}

/// What the limbs' directions cost in the torso frame: −log density, and the depth cue of confidences.
class LimbCosts {
 public:
  LimbCosts(const PosePrior* prior, const Lengths& lengths, const JointHypothesesOptions& options)
      : lengths_(lengths), options_(options) {
    if (prior != nullptr && prior->num_directions > 0) {
      prior_ = prior;
      bins_.emplace(prior->num_directions);
    }
  }

  /// −log density of a limb's two unit bone directions in the torso frame; 0 for the most common ones is not implied.
  [[nodiscard]] double Density(int limb, Vector3d upper, Vector3d lower) const {
    if (prior_ == nullptr) return 0;
    if (limb % 2 == 1) {
      upper.x() = -upper.x();
      lower.x() = -lower.x();
    }
    const RowMatrixXf& table = limb < 2 ? prior_->arm_log_density : prior_->leg_log_density;
    return -table(bins_->Nearest(upper), bins_->Nearest(lower));
  }

  /// The four hypotheses of a limb that starts at `start` (camera frame): end points of both bones. Bones that look
  /// longer than they are lie in the image plane.
  void Hypotheses(const Rays& rays, int limb, const Vector3d& start, Vector3d middle[4], Vector3d end[4]) const {
    for (int h = 0; h < 4; ++h) {
      middle[h] = OnRay(rays.ray[kLimbs[limb][1]], start, lengths_.upper[limb], (h & 1) != 0);
      end[h] = OnRay(rays.ray[kLimbs[limb][2]], middle[h], lengths_.lower[limb], (h & 2) != 0);
    }
  }

  [[nodiscard]] bool Usable(const Rays& rays, int limb) const {
    return rays.seen[kLimbs[limb][1]] && rays.seen[kLimbs[limb][2]];
  }

  /// Cost of one hypothesis of a limb.
  [[nodiscard]] double Cost(const Rays& rays, int limb, const Matrix3d& torso, const Vector3d& torso_centre,
                            const Vector3d& start, const Vector3d& middle, const Vector3d& end) const {
    double cost = options_.density_weight * Density(limb, torso.transpose() * (middle - start).normalized(),
                                                    torso.transpose() * (end - middle).normalized());
    if (limb < 2) {
      cost += options_.occlusion_weight * (Occlusion(rays.confidence[kLimbs[limb][1]], middle, torso, torso_centre) +
                                           Occlusion(rays.confidence[kLimbs[limb][2]], end, torso, torso_centre));
    }
    return cost;
  }

 private:
  /// The point of the ray at distance `length` from `start`, nearer or farther; the closest one if none is.
  static Vector3d OnRay(const Vector2d& ray, const Vector3d& start, double length, bool far) {
    const Vector3d d = Vector3d(ray.x(), ray.y(), 1).normalized();
    const double along = d.dot(start), discriminant = along * along - start.squaredNorm() + length * length;
    if (discriminant <= 0) return along * d;
    return (along + (far ? 1 : -1) * std::sqrt(discriminant)) * d;
  }

  /// A joint behind the torso is detected with low confidence (0.1), one in front with high (0.7).
  static double Occlusion(double confidence, const Vector3d& point, const Matrix3d& torso, const Vector3d& centre) {
    const Vector3d offset = point - centre, up = torso.col(1);
    const Vector3d across = offset - up * up.dot(offset);
    const double sideways = std::hypot(across.x(), across.y());
    const bool hidden = sideways < 0.16 && std::abs(up.dot(offset)) < 0.35 && offset.z() > 0.09;
    const double expected = hidden ? 0.12 : 0.7;
    const double z = (std::min(confidence, 0.7) - expected) / 0.25;
    return Saturated(z * z, 4);
  }

  const Lengths& lengths_;
  const JointHypothesesOptions& options_;
  const PosePrior* prior_ = nullptr;
  std::optional<DirectionBins> bins_;
};

/// How badly the face's visibility fits a head that points along the torso's front.
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
  // Sideways position of the nose between or before the ears tells which way the head looks.
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

struct TorsoState {
  double yaw = 0, tilt = 0;
  Matrix3d rotation;
};

Vector3d Centroid(const MatrixX3d& points, const std::array<int, 4>& ids) {
  Vector3d sum = Vector3d::Zero();
  for (int k : ids) sum += points.row(k).transpose() / 4;
  return sum;
}

constexpr std::array<int, 4> kTorso = {kLeftShoulder, kRightShoulder, kLeftHip, kRightHip};

/// The roll that best turns the state's projected torso onto the observed one, and the remaining squared distance in
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

Eigen::VectorXd EstimateShape(const KeypointSequence& keypoints, const Camera& camera, const BodyModel& model,
                              int num_betas, const JointHypothesesOptions& options) {
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(num_betas);
  std::vector<int> frames;
  const int step = std::max(1, keypoints.num_frames() / 1000);
  for (int t = 0; t < keypoints.num_frames(); t += step) frames.push_back(t);
  const std::vector<Rays> rays = RaysOfFrames(keypoints, camera, frames, options);

  // Bones as pairs of point groups: torso, then the two bones of each limb, left and right together.
  const auto midpoint = [](const auto& points, int a, int b) -> Vector2d { return (points(a) + points(b)) / 2; };
  constexpr int kNumBones = 5;
  std::array<std::vector<double>, kNumBones> seen;
  for (const Rays& r : rays) {
    if (!r.has_torso()) continue;
    const auto at = [&](int k) -> Vector2d { return r.ray[k]; };
    std::array<double, kNumBones> length{};
    std::array<int, kNumBones> count{};
    length[0] = (midpoint(at, kLeftShoulder, kRightShoulder) - midpoint(at, kLeftHip, kRightHip)).norm();
    count[0] = 1;
    for (int l = 0; l < 4; ++l) {
      for (int b = 0; b < 2; ++b) {
        const int from = kLimbs[l][b], to = kLimbs[l][b + 1];
        if (!r.seen[from] || !r.seen[to] || std::min(r.confidence[from], r.confidence[to]) < 0.5) continue;
        // The longer of left and right: the other is foreshortened.
        double& longest = length[1 + 2 * (l / 2) + b];
        longest = std::max(longest, (at(to) - at(from)).norm());
        count[1 + 2 * (l / 2) + b] = 1;
      }
    }
    if (count[0] + count[3] + count[4] < 3) continue;
    const double size = length[0] + length[3] + length[4];
    for (int b = 0; b < kNumBones; ++b) {
      if (count[b] > 0) seen[b].push_back(length[b] / size);
    }
  }
  Eigen::VectorXd log_seen(kNumBones);
  for (int b = 0; b < kNumBones; ++b) {
    if (seen[b].size() < 30) return betas;
    // The ratio to the body's apparent size is noisy both ways for torso and legs (median), and only shortened for
    // arms.
    const size_t k = static_cast<size_t>((b == 0 || b >= 3 ? 0.5 : 0.85) * static_cast<double>(seen[b].size() - 1));
    std::nth_element(seen[b].begin(), seen[b].begin() + static_cast<std::ptrdiff_t>(k), seen[b].end());
    log_seen[b] = std::log(seen[b][k]);
  }
  const auto log_lengths = [&](const Eigen::VectorXd& shape) {
    BodyPose rest;
    rest.rotations.assign(model.num_joints(), Matrix3d::Identity());
    const Lengths lengths(PoseLandmarks(model, shape, rest, CocoNames()));
    Eigen::VectorXd result(kNumBones);
    result << lengths.torso, (lengths.upper[0] + lengths.upper[1]) / 2, (lengths.lower[0] + lengths.lower[1]) / 2,
        (lengths.upper[2] + lengths.upper[3]) / 2, (lengths.lower[2] + lengths.lower[3]) / 2;
    const double size = result[0] + result[3] + result[4];
    return Eigen::VectorXd((result / size).array().log());
  };
  const Eigen::VectorXd mean = log_lengths(betas);
  Eigen::MatrixXd A(kNumBones, num_betas);
  for (int b = 0; b < num_betas; ++b) A.col(b) = log_lengths(Eigen::VectorXd::Unit(num_betas, b)) - mean;
  constexpr double kSigma = 0.03;
  const Eigen::MatrixXd H = A.transpose() * A / (kSigma * kSigma) + Eigen::MatrixXd::Identity(num_betas, num_betas);
  return H.ldlt().solve(A.transpose() * (log_seen - mean) / (kSigma * kSigma));
}

bool TorsoFrame(const MatrixX3d& p, Matrix3d* rotation) {
  const Vector3d up = (p.row(kLeftShoulder) + p.row(kRightShoulder) - p.row(kLeftHip) - p.row(kRightHip)).transpose();
  const Vector3d left = (p.row(kLeftShoulder) - p.row(kRightShoulder) + p.row(kLeftHip) - p.row(kRightHip)).transpose();
  const Vector3d y = up.normalized();
  const Vector3d x = left - y * y.dot(left);
  if (!(up.norm() > 1e-6) || !(x.norm() > 1e-6)) return false;
  rotation->col(0) = x.normalized();
  rotation->col(1) = y;
  rotation->col(2) = rotation->col(0).cross(y);
  return true;
}

JointHypothesesResult FindJointHypotheses(const KeypointSequence& keypoints, const Camera& camera,
                                          const MatrixX3d& rest_points, const PosePrior* prior,
                                          const JointHypothesesOptions& options) {
  BODYLOOM_CHECK(rest_points.rows() == 17, "joint hypotheses: ", rest_points.rows(), " rest points, expected 17");
  const Lengths lengths(rest_points);
  JointHypothesesResult result;
  // Frames for the trellis: about frame_rate a second, and only those that show a torso.
  std::vector<double> times;
  double next = -std::numeric_limits<double>::infinity();
  std::vector<int> candidates;
  for (int t = 0; t < keypoints.num_frames(); ++t) {
    if (keypoints.timestamps[t] < next - 1e-9) continue;
    const Rays rays = RaysOfFrames(keypoints, camera, {t}, options)[0];
    if (!rays.has_torso()) continue;
    candidates.push_back(t);
    times.push_back(keypoints.timestamps[t]);
    next = keypoints.timestamps[t] + 1 / options.frame_rate;
  }
  if (candidates.empty()) return result;
  result.frames = candidates;
  const std::vector<Rays> rays = RaysOfFrames(keypoints, camera, candidates, options);
  const size_t T = rays.size();
  const std::vector<double> depth = RootDepths(rays, times, lengths);
  const LimbCosts limb_costs(prior, lengths, options);

  const auto start_of_limb = [&](size_t t, const Matrix3d& torso, int limb) {
    // The torso is a rigid plate whose centre lies on the mean ray at the root's depth.
    Vector2d centre_ray = Vector2d::Zero();
    for (int k : kTorso) centre_ray += rays[t].ray[k] / 4;
    const Vector3d centre(centre_ray.x() * depth[t], centre_ray.y() * depth[t], depth[t]);
    const Vector3d offset = torso * (lengths.rest.row(kLimbs[limb][0]).transpose() - Centroid(lengths.rest, kTorso));
    // The observed ray is trusted across the view, the plate for the depth.
    const double z = centre.z() + offset.z();
    const Vector2d& ray = rays[t].ray[kLimbs[limb][0]];
    return Vector3d(ray.x() * z, ray.y() * z, z);
  };
  const auto centre_of = [&](size_t t, const Matrix3d& torso) {
    Vector3d sum = Vector3d::Zero();
    for (int l = 0; l < 4; ++l) sum += start_of_limb(t, torso, l) / 4;
    return sum;
  };

  // Torso trellis.
  std::vector<std::vector<TorsoState>> states(T);
  std::vector<std::vector<double>> unary(T);
  for (size_t t = 0; t < T; ++t) {
    for (int y = 0; y < kNumYaw; ++y) {
      for (int p = 0; p < kNumTilt; ++p) {
        TorsoState state;
        state.yaw = 2 * kPi * y / kNumYaw;
        state.tilt = (p - kNumTilt / 2) * kTiltStep;
        double roll;
        double cost = FitRoll(rays[t], TorsoRotation(state.yaw, state.tilt, 0), depth[t], lengths, &roll);
        cost = Saturated(cost, 30);
        state.rotation = TorsoRotation(state.yaw, state.tilt, roll);
        const double lean = state.tilt / kUprightTilt;
        cost += 0.5 * options.upright_weight * Saturated(lean * lean, 6);
        cost += options.face_weight * FaceCost(rays[t], state.rotation, depth[t]);
        const Vector3d centre = centre_of(t, state.rotation);
        for (int limb = 0; limb < 4; ++limb) {
          if (!limb_costs.Usable(rays[t], limb)) continue;
          Vector3d middle[4], end[4];
          const Vector3d start = start_of_limb(t, state.rotation, limb);
          limb_costs.Hypotheses(rays[t], limb, start, middle, end);
          double best = std::numeric_limits<double>::infinity();
          for (int h = 0; h < 4; ++h) {
            best = std::min(best, limb_costs.Cost(rays[t], limb, state.rotation, centre, start, middle[h], end[h]));
          }
          cost += best;
        }
        states[t].push_back(state);
        unary[t].push_back(cost);
      }
    }
  }
  const std::vector<int> torso_path = Viterbi(unary, [&](size_t t, int a, int b) {
    const double dt = times[t] - times[t - 1];
    const double cosine = ((states[t - 1][a].rotation.cwiseProduct(states[t][b].rotation)).sum() - 1) / 2;
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    const double z = angle / (options.angular_speed * dt);
    return Saturated(z * z, 25) * 0.5;
  });

  // Limbs, each on its own, given the torso.
  std::vector<Matrix3d> torso(T);
  for (size_t t = 0; t < T; ++t) {
    torso[t] = states[t][torso_path[t]].rotation;
    result.cost += unary[t][torso_path[t]];
  }
  result.hypotheses.resize(T);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (size_t t = 0; t < T; ++t) {
    JointHypothesis& hypothesis = result.hypotheses[t];
    hypothesis.points.setConstant(17, 3, nan);
    hypothesis.torso_rotation = torso[t];
    hypothesis.depth = depth[t];
    for (int l = 0; l < 4; ++l) hypothesis.points.row(kLimbs[l][0]) = start_of_limb(t, torso[t], l).transpose();
    const double head_depth = (hypothesis.points(kLeftShoulder, 2) + hypothesis.points(kRightShoulder, 2)) / 2;
    for (int k = 0; k < 5; ++k) {
      if (rays[t].seen[k])
        hypothesis.points.row(k) << rays[t].ray[k].x() * head_depth, rays[t].ray[k].y() * head_depth, head_depth;
    }
  }
  for (int limb = 0; limb < 4; ++limb) {
    std::vector<size_t> steps;
    for (size_t t = 0; t < T; ++t) {
      if (limb_costs.Usable(rays[t], limb)) steps.push_back(t);
    }
    if (steps.empty()) continue;
    std::vector<std::array<Vector3d, 4>> middles(steps.size()), ends(steps.size());
    std::vector<std::vector<double>> limb_unary(steps.size());
    for (size_t i = 0; i < steps.size(); ++i) {
      const size_t t = steps[i];
      const Vector3d start = start_of_limb(t, torso[t], limb), centre = centre_of(t, torso[t]);
      limb_costs.Hypotheses(rays[t], limb, start, middles[i].data(), ends[i].data());
      for (int h = 0; h < 4; ++h) {
        limb_unary[i].push_back(limb_costs.Cost(rays[t], limb, torso[t], centre, start, middles[i][h], ends[i][h]));
        // Transitions compare positions relative to the limb's start, so that the root's motion does not count.
        middles[i][h] -= start;
        ends[i][h] -= start;
      }
    }
    const std::vector<int> path = Viterbi(limb_unary, [&](size_t i, int a, int b) {
      const double sigma = options.limb_speed * (times[steps[i]] - times[steps[i - 1]]);
      const double z2 =
          ((middles[i][b] - middles[i - 1][a]).squaredNorm() + (ends[i][b] - ends[i - 1][a]).squaredNorm()) /
          (sigma * sigma);
      return 0.5 * Saturated(z2, 25);
    });
    for (size_t i = 0; i < steps.size(); ++i) {
      JointHypothesis& hypothesis = result.hypotheses[steps[i]];
      const Vector3d start = hypothesis.points.row(kLimbs[limb][0]).transpose();
      hypothesis.points.row(kLimbs[limb][1]) = (start + middles[i][path[i]]).transpose();
      hypothesis.points.row(kLimbs[limb][2]) = (start + ends[i][path[i]]).transpose();
    }
  }
  return result;
}

}  // namespace bodyloom
