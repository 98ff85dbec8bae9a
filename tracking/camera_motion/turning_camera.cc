// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_motion/turning_camera.h"

#include <ceres/crs_matrix.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/base/hash_random.h"
#include "geometry/base/percentile.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFewestOfPair = 12, kMostPointsOfCost = 120, kMoreKeys = 80, kFocalPairs = 40;
constexpr double kSigmaSmallPx = 0.3, kExplainedSmallPx = 1.5, kReweightSmallPx = 2;
constexpr double kCauchy = 2;

/// Places of points in two frames, from the picture's centre.
struct PlacesInTwoFrames {
  int anchor = 0;  ///< index of the anchor
  int frame = 0;
  std::vector<Vector2d> from, to;
  double shift_px = 0;  ///< median
};

std::vector<PlacesInTwoFrames> PairsOf(const BackgroundTracks& tracks) {
  const Vector2d centre(0.5 * (tracks.width - 1), 0.5 * (tracks.height - 1));
  std::vector<PlacesInTwoFrames> pairs;
  for (size_t k = 0; k < tracks.anchors.size() && (k == 0 || !tracks.anchors[k].after_break); ++k) {
    const BackgroundTracks::Anchor& anchor = tracks.anchors[k];
    for (const BackgroundTracks::Sight& sight : anchor.sights) {
      PlacesInTwoFrames pair;
      pair.anchor = static_cast<int>(k);
      pair.frame = sight.frame;
      std::vector<double> shifts;
      for (size_t i = 0; i < sight.pixels.size(); ++i) {
        if (!sight.pixels[i].allFinite()) continue;
        pair.from.emplace_back(anchor.pixels[i].cast<double>() - centre);
        pair.to.emplace_back(sight.pixels[i].cast<double>() - centre);
        shifts.push_back((pair.to.back() - pair.from.back()).norm());
      }
      if (static_cast<int>(shifts.size()) < kFewestOfPair) continue;
      pair.shift_px = Percentile(shifts, 50);
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

Vector3d RayOf(const Vector2d& from_centre, double focal) {
  return Vector3d(from_centre.x() / focal, from_centre.y() / focal, 1).normalized();
}

std::vector<Vector3d> RaysOf(const std::vector<Vector2d>& points, double focal) {
  std::vector<Vector3d> rays;
  rays.reserve(points.size());
  for (const Vector2d& point : points) rays.push_back(RayOf(point, focal));
  return rays;
}

/// R that takes a to b, of least squares.
Matrix3d Aligned(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b, const std::vector<double>& weights) {
  Matrix3d sum = Matrix3d::Zero();
  for (size_t i = 0; i < a.size(); ++i) sum += weights[i] * b[i] * a[i].transpose();
  return NearestRotation(sum);
}

/// Rotation of a pair for a focal length of either frame: consensus of two points at a time, unless a start is given,
/// and reweighting (Geman–McClure).
struct FittedRotation {
  Matrix3d rotation = Matrix3d::Identity();
  double cost = 0;  ///< Σ min(distance², 3² · scale²) / scale², angles
};
FittedRotation FitRotation(const PlacesInTwoFrames& pair, double focal, double zoom, double small_px,
                           const Matrix3d* start) {
  const std::vector<Vector3d> a = RaysOf(pair.from, focal), b = RaysOf(pair.to, focal * std::exp(zoom));
  const double scale = kReweightSmallPx * small_px / focal;
  FittedRotation fit;
  const auto truncated = [&](const Matrix3d& rotation) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i)
      sum += std::min(9.0, (rotation * a[i] - b[i]).squaredNorm() / (scale * scale));
    return sum;
  };
  if (start != nullptr) {
    fit.rotation = *start;
  } else {
    constexpr int kHypotheses = 40;
    HashRandom random(1, {static_cast<uint64_t>(pair.frame), static_cast<uint64_t>(pair.anchor)});
    double best = 1e300;
    for (int n = 0; n < kHypotheses; ++n) {
      const size_t i = random.Below(a.size());
      const size_t j = random.Below(a.size());
      if (a[i].cross(a[j]).norm() < 0.02) continue;
      const Matrix3d rotation = Aligned({a[i], a[j]}, {b[i], b[j]}, {1, 1});
      if (const double cost = truncated(rotation); cost < best) best = cost, fit.rotation = rotation;
    }
  }
  std::vector<double> weights(a.size());
  for (int pass = 0; pass < 6; ++pass) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      const double r2 = (fit.rotation * a[i] - b[i]).squaredNorm() / (scale * scale);
      weights[i] = 1 / ((1 + r2) * (1 + r2));
      sum += weights[i];
    }
    if (!(sum > 1e-6)) break;
    fit.rotation = Aligned(a, b, weights);
  }
  fit.cost = truncated(fit.rotation);
  return fit;
}

/// A pair's rotation and the logarithm of the second frame's focal length over the first's: at first the median growth
/// of distances between points, then both in turns.
FittedRotation FitZooming(const PlacesInTwoFrames& pair, double focal, double small_px, double* zoom) {
  constexpr size_t kDistances = 500;
  HashRandom random(2, {static_cast<uint64_t>(pair.frame)});
  std::vector<double> growths;
  for (size_t n = 0; n < kDistances; ++n) {
    const size_t i = random.Below(pair.from.size());
    const size_t j = random.Below(pair.from.size());
    const double before = (pair.from[i] - pair.from[j]).norm(), after = (pair.to[i] - pair.to[j]).norm();
    if (before > 40 * small_px && after > 0) growths.push_back(std::log(after / before));
  }
  *zoom = growths.empty() ? 0 : std::clamp(Percentile(growths, 50), -1.5, 1.5);
  FittedRotation fit = FitRotation(pair, focal, *zoom, small_px, nullptr);
  for (int pass = 0; pass < 12; ++pass) {
    const double scale = 2 * kReweightSmallPx * small_px;
    double up = 0, down = 0;
    for (size_t i = 0; i < pair.from.size(); ++i) {
      const Vector3d ray = fit.rotation * (pair.from[i] / focal).homogeneous();
      if (!(ray.z() > 0.1)) continue;
      const Vector2d expected = focal * ray.head<2>() / ray.z();
      const double r2 = (std::exp(*zoom) * expected - pair.to[i]).squaredNorm() / (scale * scale);
      const double weight = 1 / ((1 + r2) * (1 + r2));
      up += weight * expected.dot(pair.to[i]);
      down += weight * expected.squaredNorm();
    }
    if (!(down > 0 && up > 0)) break;
    *zoom = std::clamp(std::log(up / down), -1.5, 1.5);
    fit = FitRotation(pair, focal, *zoom, small_px, &fit.rotation);
  }
  return fit;
}

/// Distance of a point from where the homography puts it; infinite behind the camera.
double Distance(const Vector2d& from, const Vector2d& to, const Matrix3d& rotation, double focal, double zoom) {
  const Vector3d ray = rotation * Vector3d(from.x() / focal, from.y() / focal, 1);
  if (!(ray.z() > 1e-3)) return std::numeric_limits<double>::infinity();
  return (focal * std::exp(zoom) * ray.head<2>() / ray.z() - to).norm();
}

/// Pairs whose points moved farthest, spread over the clip: the farthest of each of `count` stretches of pairs.
std::vector<const PlacesInTwoFrames*> FarthestPairs(const std::vector<PlacesInTwoFrames>& pairs, int count) {
  std::vector<const PlacesInTwoFrames*> chosen;
  const auto size = static_cast<int>(pairs.size());
  const int stretches = std::min(count, size);
  for (int s = 0; s < stretches; ++s) {
    const auto begin = pairs.begin() + std::ptrdiff_t(s) * size / stretches,
               end = pairs.begin() + std::ptrdiff_t(s + 1) * size / stretches;
    chosen.push_back(&*std::max_element(
        begin, end, [](const PlacesInTwoFrames& a, const PlacesInTwoFrames& b) { return a.shift_px < b.shift_px; }));
  }
  return chosen;
}

double StartLogFocal(const std::vector<PlacesInTwoFrames>& pairs, const TurningCameraOptions& options,
                     double small_px) {
  if (options.focal_known) return options.focal.log_mean;
  constexpr int kSteps = 17;
  const double range = 3 * options.focal.log_sigma;
  const std::vector<const PlacesInTwoFrames*> chosen = FarthestPairs(pairs, kFocalPairs);
  double best = 1e300, best_log = options.focal.log_mean;
  for (int n = 0; n < kSteps; ++n) {
    const double off = range * (2.0 * n / (kSteps - 1) - 1), log_focal = options.focal.log_mean + off;
    double cost = off * off / (options.focal.log_sigma * options.focal.log_sigma);
    for (const PlacesInTwoFrames* pair : chosen) {
      double zoom = 0;
      cost += options.zooms ? FitZooming(*pair, std::exp(log_focal), small_px, &zoom).cost
                            : FitRotation(*pair, std::exp(log_focal), 0, small_px, nullptr).cost;
    }
    if (cost < best) best = cost, best_log = log_focal;
  }
  return best_log;
}

/// State of a key frame.
struct KeyFrame {
  Vector3d w = Vector3d::Zero();
  double zoom = 0;
};

/// σ of a key frame's rotation and of log f from the Jacobian's normal equations, whose columns are in the order of
/// `blocks`.
struct Sigmas {
  std::map<const double*, double> of_block;
};
Sigmas SigmasOf(ceres::Problem* problem, const std::vector<double*>& blocks, double variance, int num_threads) {
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = blocks;
  evaluate.num_threads = num_threads;
  ceres::CRSMatrix jacobian;
  Sigmas sigmas;
  if (blocks.empty() || !problem->Evaluate(evaluate, nullptr, nullptr, nullptr, &jacobian)) return sigmas;
  MatrixXd normal = MatrixXd::Identity(jacobian.num_cols, jacobian.num_cols) * 1e-9;
  for (int row = 0; row < jacobian.num_rows; ++row) {
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
      for (int j = jacobian.rows[row]; j < jacobian.rows[row + 1]; ++j) {
        normal(jacobian.cols[i], jacobian.cols[j]) += jacobian.values[i] * jacobian.values[j];
      }
    }
  }
  const MatrixXd covariance = normal.llt().solve(MatrixXd::Identity(normal.rows(), normal.cols()));
  int at = 0;
  for (const double* block : blocks) {
    const int size = problem->ParameterBlockSize(block);
    sigmas.of_block[block] = std::sqrt(variance * covariance.diagonal().segment(at, size).mean());
    at += size;
  }
  return sigmas;
}

}  // namespace

double SmallPixel(const BackgroundTracks& tracks) {
  return std::max(1.0, std::max(tracks.width, tracks.height) / 640.0);
}

bool TurnedPointCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Eigen::Map<const Vector3d> w_from(parameters[0]), w_to(parameters[1]);
  const double focal_from = std::exp(parameters[2][0] + parameters[3][0]),
               focal_to = std::exp(parameters[2][0] + parameters[4][0]);
  const Vector3d a(from_.x() / focal_from, from_.y() / focal_from, 1);
  const Matrix3d from_transposed = RotationFromAxisAngle(-w_from), to = RotationFromAxisAngle(w_to);
  const Vector3d in_scene = from_transposed * a, ray = to * in_scene;
  if (!(ray.z() > 1e-3)) return false;
  const Vector2d projected = focal_to * ray.head<2>() / ray.z();
  Eigen::Map<Vector2d>(residuals, 2) = (projected - to_) / sigma_px_;
  if (jacobians == nullptr) return true;
  Eigen::Matrix<double, 2, 3> by_ray;
  by_ray << 1, 0, -ray.x() / ray.z(), 0, 1, -ray.y() / ray.z();
  by_ray *= focal_to / (ray.z() * sigma_px_);
  using RowMajor23 = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
  if (jacobians[0] != nullptr) {
    Eigen::Map<RowMajor23> by_from(jacobians[0]);
    by_from = by_ray * to * from_transposed * Skew(a) * RightJacobian(-w_from);
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<RowMajor23> by_to(jacobians[1]);
    by_to = -by_ray * to * Skew(in_scene) * RightJacobian(w_to);
  }
  const Vector2d by_focal_from = by_ray * to * from_transposed * Vector3d(-a.x(), -a.y(), 0);
  const Vector2d by_focal_to = projected / sigma_px_;
  if (jacobians[2] != nullptr) Eigen::Map<Vector2d>(jacobians[2], 2) = by_focal_from + by_focal_to;
  if (jacobians[3] != nullptr) Eigen::Map<Vector2d>(jacobians[3], 2) = by_focal_from;
  if (jacobians[4] != nullptr) Eigen::Map<Vector2d>(jacobians[4], 2) = by_focal_to;
  return true;
}

bool FocalPriorCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  residuals[0] = (parameters[0][0] - prior_.log_mean) / prior_.log_sigma;
  if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = 1 / prior_.log_sigma;
  return true;
}

namespace {

/// The solve of a clip.
class TurningSolve {
 public:
  TurningSolve(const BackgroundTracks& tracks, const TurningCameraOptions& options)
      : tracks_(tracks), options_(options), small_px_(SmallPixel(tracks)), pairs_(PairsOf(tracks)) {}

  TurningCamera Run() {
    TurningCamera camera;
    if (pairs_.empty()) return camera;
    log_focal_ = StartLogFocal(pairs_, options_, small_px_);
    ChooseKeys();
    if (!SolveKeys(&camera)) return camera;
    AddOtherFrames(&camera);
    Measure(&camera);
    return camera;
  }

 private:
  [[nodiscard]] double focal() const { return std::exp(log_focal_); }
  [[nodiscard]] int FrameOf(int anchor) const { return tracks_.anchors[size_t(anchor)].frame; }

  /// Anchors one after the other, and the frames that tell most.
  void ChooseKeys() {
    keys_[FrameOf(pairs_.front().anchor)] = KeyFrame();
    for (const PlacesInTwoFrames& pair : pairs_) {
      const auto from = keys_.find(FrameOf(pair.anchor));
      if (from == keys_.end() || !IsAnchor(pair.frame) || keys_.count(pair.frame) > 0) continue;
      keys_[pair.frame] = FittedTo(pair, from->second);
    }
    for (const PlacesInTwoFrames* pair : FarthestPairs(pairs_, kMoreKeys)) {
      const auto from = keys_.find(FrameOf(pair->anchor));
      if (from != keys_.end() && keys_.count(pair->frame) == 0) keys_[pair->frame] = FittedTo(*pair, from->second);
    }
  }

  /// The frame's rotation and zoom from those of the anchor's.
  [[nodiscard]] KeyFrame FittedTo(const PlacesInTwoFrames& pair, const KeyFrame& from) const {
    KeyFrame key;
    const double focal_from = focal() * std::exp(from.zoom);
    const Matrix3d turn = options_.zooms ? FitZooming(pair, focal_from, small_px_, &key.zoom).rotation
                                         : FitRotation(pair, focal_from, 0, small_px_, nullptr).rotation;
    key.w = AxisAngleFromRotation(NearestRotation(turn * RotationFromAxisAngle(from.w)));
    key.zoom += from.zoom;
    return key;
  }

  [[nodiscard]] bool IsAnchor(int frame) const {
    return std::any_of(tracks_.anchors.begin(), tracks_.anchors.end(),
                       [&](const BackgroundTracks::Anchor& anchor) { return anchor.frame == frame; });
  }

  bool SolveKeys(TurningCamera* camera) {
    ceres::Problem problem;
    std::vector<double*> blocks;
    auto* loss = new ceres::CauchyLoss(kCauchy);
    size_t points = 0;
    for (const PlacesInTwoFrames& pair : pairs_) {
      const auto from = keys_.find(FrameOf(pair.anchor)), to = keys_.find(pair.frame);
      if (from == keys_.end() || to == keys_.end()) continue;
      const size_t step = 1 + pair.from.size() / kMostPointsOfCost;
      for (size_t i = 0; i < pair.from.size(); i += step) {
        // Points far off are what moves by itself, or was taken for another.
        const Matrix3d turn = RotationFromAxisAngle(to->second.w) * RotationFromAxisAngle(from->second.w).transpose();
        const double focal_from = focal() * std::exp(from->second.zoom);
        if (!(Distance(pair.from[i], pair.to[i], turn, focal_from, to->second.zoom - from->second.zoom) <
              kOutlierSmallPx * small_px_)) {
          continue;
        }
        problem.AddResidualBlock(new TurnedPointCost(pair.from[i], pair.to[i], kSigmaSmallPx * small_px_), loss,
                                 from->second.w.data(), to->second.w.data(), &log_focal_, &from->second.zoom,
                                 &to->second.zoom);
        ++points;
      }
    }
    if (points < size_t(kFewestOfPair)) return false;
    problem.AddResidualBlock(new FocalPriorCost(options_.focal), nullptr, &log_focal_);
    if (options_.focal_known) problem.SetParameterBlockConstant(&log_focal_);
    bool is_first = true;
    for (auto& [frame, key] : keys_) {
      if (!problem.HasParameterBlock(key.w.data())) continue;
      if (is_first) problem.SetParameterBlockConstant(key.w.data());
      if (is_first || !options_.zooms) problem.SetParameterBlockConstant(&key.zoom);
      if (!is_first) blocks.push_back(key.w.data());
      is_first = false;
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.max_num_iterations = 50;
    solver.num_threads = options_.num_threads;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (!summary.IsSolutionUsable() || !std::isfinite(log_focal_)) return false;
    if (!options_.focal_known) blocks.push_back(&log_focal_);
    // The points' own scatter replaces the assumed σ.
    const double variance = std::max(0.05, 2 * summary.final_cost / (2.0 * static_cast<double>(points)));
    const Sigmas sigmas = SigmasOf(&problem, blocks, variance, options_.num_threads);
    for (const auto& [frame, key] : keys_) {
      const auto found = sigmas.of_block.find(key.w.data());
      sigma_of_key_[frame] = found == sigmas.of_block.end() ? 0 : found->second;
    }
    const auto of_focal = sigmas.of_block.find(&log_focal_);
    camera->log_focal = log_focal_;
    camera->log_focal_sigma = of_focal == sigmas.of_block.end() ? 0 : of_focal->second;
    camera->solved = true;
    return true;
  }

  void AddOtherFrames(TurningCamera* camera) {
    for (const auto& [frame, key] : keys_) {
      all_[frame] = key;
      sigma_[frame] = sigma_of_key_[frame];
    }
    for (const PlacesInTwoFrames& pair : pairs_) {
      const auto from = keys_.find(FrameOf(pair.anchor));
      if (from == keys_.end() || all_.count(pair.frame) > 0) continue;
      all_[pair.frame] = FittedTo(pair, from->second);
      const double own = kSigmaSmallPx * small_px_ / (focal() * std::sqrt(static_cast<double>(pair.from.size())));
      sigma_[pair.frame] = std::hypot(own, sigma_of_key_[FrameOf(pair.anchor)]);
    }
    for (const auto& [frame, key] : all_) {
      camera->frames.push_back(frame);
      camera->camera_from_first.push_back(RotationFromAxisAngle(key.w));
      camera->zoom.push_back(key.zoom);
      camera->sigma_rad.push_back(sigma_[frame]);
    }
  }

  void Measure(TurningCamera* camera) const {
    std::vector<double> distances;
    size_t explained = 0;
    for (const PlacesInTwoFrames& pair : pairs_) {
      const auto from = all_.find(FrameOf(pair.anchor)), to = all_.find(pair.frame);
      if (from == all_.end() || to == all_.end()) continue;
      const Matrix3d turn = RotationFromAxisAngle(to->second.w) * RotationFromAxisAngle(from->second.w).transpose();
      for (size_t i = 0; i < pair.from.size(); ++i) {
        const double distance = Distance(pair.from[i], pair.to[i], turn, focal() * std::exp(from->second.zoom),
                                         to->second.zoom - from->second.zoom);
        distances.push_back(std::min(distance, 1e6));
        explained += distance < kExplainedSmallPx * small_px_ ? 1 : 0;
      }
    }
    if (distances.empty()) return;
    camera->median_px = Percentile(distances, 50);
    camera->explained = static_cast<double>(explained) / static_cast<double>(distances.size());
  }

  static constexpr double kOutlierSmallPx = 12;

  const BackgroundTracks& tracks_;
  TurningCameraOptions options_;
  double small_px_;
  std::vector<PlacesInTwoFrames> pairs_;
  double log_focal_ = 0;
  std::map<int, KeyFrame> keys_, all_;  ///< by frame
  std::map<int, double> sigma_of_key_, sigma_;
};

}  // namespace

TurningCamera SolveTurningCamera(const BackgroundTracks& tracks, const TurningCameraOptions& options) {
  return TurningSolve(tracks, options).Run();
}

}  // namespace bodyloom
