// SPDX-License-Identifier: Apache-2.0
#include "tracking/room/common_ground.h"

#include <ceres/ceres.h>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/initialise/ground_plane.h"
#include "tracking/solvers/residuals/ceres_functions.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kKernel = 3;         ///< c of ρ, and the distance in σ within which a foot is on the plane
constexpr double kMaxSizeSigmas = 3;  ///< of log s, of somebody who stands on the plane
constexpr double kMinShare = 0.5;     ///< of their standing time on it

double Seconds(const StandingPerson& person) {
  double sum = 0;
  for (const StandingFoot& stance : person.stances) sum += stance.seconds;
  return sum;
}

double SigmaOf(const StandingFoot& stance, const Vector3d& up) {
  const GroundPlaneOptions feet;
  return std::hypot(feet.height_m, up.dot(stance.place_m.normalized()) * feet.depth_m);
}

/// Median height of the camera above the person's stances, weighted by time.
double CameraHeightAbove(const StandingPerson& person, const Vector3d& up) {
  std::vector<std::pair<double, double>> heights;  // of the places, seconds
  for (const StandingFoot& stance : person.stances) heights.emplace_back(up.dot(stance.place_m), stance.seconds);
  std::sort(heights.begin(), heights.end());
  const double total = Seconds(person);
  double sum = 0;
  for (const auto& [height, seconds] : heights) {
    sum += seconds;
    if (2 * sum >= total) return -height;
  }
  return -heights.back().first;
}

struct Fit {
  Vector3d up;
  double height_m = 0;
  std::vector<double> log_size;  ///< of everybody
  double cost = std::numeric_limits<double>::infinity();
};

class Solver {
 public:
  Solver(const std::vector<StandingPerson>& people, const Vector3d& up, double size_sigma)
      : people_(people), up_(up), size_sigma_(size_sigma) {}

  [[nodiscard]] Fit Best(const std::vector<char>& stands, bool sizes) const {
    Fit best;
    std::vector<Fit> starts = {OfSizeOne(stands)};
    if (sizes) {
      if (auto start = OnOnePlane(stands)) starts.push_back(std::move(*start));
    }
    for (Fit& start : starts) {
      Solve(stands, sizes, &start);
      if (start.cost < best.cost) best = std::move(start);
    }
    return best;
  }
  /// Seconds for which the person is on the plane.
  [[nodiscard]] double SecondsOn(const Fit& fit, size_t person) const {
    double sum = 0;
    for (const StandingFoot& stance : people_[person].stances) {
      const double off = fit.up.dot(stance.place_m) + fit.height_m * std::exp(-fit.log_size[person]);
      if (std::abs(off) <= kKernel * SigmaOf(stance, up_)) sum += stance.seconds;
    }
    return sum;
  }

  /// Standard deviations by the normal equations: of the vertical with the sizes unknown where they are, of the height
  /// at the sizes and the vertical found.
  void SetSigmas(const std::vector<char>& stands, bool sizes, const Fit& fit, KnownGround* ground) const {
    const auto n = static_cast<Eigen::Index>(people_.size());
    const Vector3d along = fit.up.unitOrthogonal(), across = fit.up.cross(along);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3 + n, 3 + n);
    H(0, 0) = H(1, 1) = 1 / (GroundPlaneOptions().up_rad * GroundPlaneOptions().up_rad);
    for (Eigen::Index i = 0; i < n; ++i) {
      const StandingPerson& person = people_[static_cast<size_t>(i)];
      const bool free = sizes && stands[i] && !person.size_known;
      H(3 + i, 3 + i) = free ? 1 / (size_sigma_ * size_sigma_) : 1;  // 1: of a column that stays empty
      if (!stands[i]) continue;
      const double smaller = std::exp(-fit.log_size[i]);
      for (const StandingFoot& stance : person.stances) {
        const double sigma = SigmaOf(stance, up_);
        const double r = (fit.up.dot(stance.place_m) + fit.height_m * smaller) / sigma;
        VectorXd row = VectorXd::Zero(3 + n);
        row[0] = along.dot(stance.place_m) / sigma;
        row[1] = across.dot(stance.place_m) / sigma;
        row[2] = smaller / sigma;
        if (free) row[3 + i] = -fit.height_m * smaller / sigma;
        H += std::min(1.0, stance.seconds) * GemanMcClure(r * r, kKernel).weight * row * row.transpose();
      }
    }
    if (!(H(2, 2) > 0)) return;
    const Eigen::MatrixXd covariance = H.inverse();
    ground->up_sigma_deg = 180 / M_PI * std::sqrt(covariance(0, 0) + covariance(1, 1));
    ground->height_sigma_m = std::sqrt(1 / H(2, 2));
  }

 private:
  [[nodiscard]] Fit OfSizeOne(const std::vector<char>& stands) const {
    StandingPerson all;
    for (size_t i = 0; i < people_.size(); ++i) {
      if (!stands[i]) continue;
      all.stances.insert(all.stances.end(), people_[i].stances.begin(), people_[i].stances.end());
    }
    return {up_, CameraHeightAbove(all, up_), std::vector<double>(people_.size(), 0)};
  }
  /// Start with everybody on one plane: h is the geometric mean of people's own heights. None when the camera is above
  /// some and below others.
  [[nodiscard]] std::optional<Fit> OnOnePlane(const std::vector<char>& stands) const {
    Fit fit{up_, 0, std::vector<double>(people_.size(), 0)};
    // People of known size determine the height of the camera.
    bool any_known = false;
    for (size_t i = 0; i < people_.size(); ++i) any_known = any_known || (stands[i] && people_[i].size_known);
    double sum = 0, sign = 0;
    int count = 0;
    for (size_t i = 0; i < people_.size(); ++i) {
      if (!stands[i]) continue;
      const double own = CameraHeightAbove(people_[i], up_);
      if (own == 0 || own * sign < 0) return std::nullopt;
      sign = own;
      fit.log_size[i] = std::log(std::abs(own));
      if (any_known && !people_[i].size_known) continue;
      sum += fit.log_size[i];
      ++count;
    }
    const double log_height = sum / count;
    fit.height_m = std::copysign(std::exp(log_height), sign);
    for (size_t i = 0; i < people_.size(); ++i) {
      fit.log_size[i] = stands[i] && !people_[i].size_known ? log_height - fit.log_size[i] : 0;
    }
    return fit;
  }

  void Solve(const std::vector<char>& stands, bool sizes, Fit* fit) const {
    ceres::Problem problem;
    double* up = fit->up.data();
    problem.AddParameterBlock(up, 3, new ceres::SphereManifold<3>());
    RowMatrixXd across(2, 3);
    across.row(0) = up_.unitOrthogonal().transpose();
    across.row(1) = up_.cross(up_.unitOrthogonal()).transpose();
    across /= GroundPlaneOptions().up_rad;
    problem.AddResidualBlock(new LinearCost(across, VectorXd::Zero(2)), nullptr, up);
    for (size_t i = 0; i < people_.size(); ++i) {
      if (!stands[i]) continue;
      double* log_size = &fit->log_size[i];
      problem.AddParameterBlock(log_size, 1);
      if (sizes && !people_[i].size_known) {
        problem.AddResidualBlock(new LinearCost(RowMatrixXd::Constant(1, 1, 1 / size_sigma_), VectorXd::Zero(1)),
                                 nullptr, log_size);
      } else {
        problem.SetParameterBlockConstant(log_size);
      }
      for (const StandingFoot& stance : people_[i].stances) {
        problem.AddResidualBlock(
            new StanceCost(stance.place_m, SigmaOf(stance, up_)),
            new ceres::ScaledLoss(new GemanMcClureLoss(kKernel), std::min(1.0, stance.seconds), ceres::TAKE_OWNERSHIP),
            up, &fit->height_m, log_size);
      }
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-14;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    fit->cost = summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity();
  }

  const std::vector<StandingPerson>& people_;
  const Vector3d up_;
  const double size_sigma_;
};

/// The person whose size deviates by the largest amount, if that is too large; of several equal ones, the one with the
/// shortest standing time.
std::optional<size_t> OfImpossibleSize(const std::vector<StandingPerson>& people, const std::vector<char>& stands,
                                       const Fit& fit, double size_sigma) {
  double maximum = 0;
  for (size_t i = 0; i < people.size(); ++i) {
    if (stands[i]) maximum = std::max(maximum, std::abs(fit.log_size[i]));
  }
  if (!(maximum > kMaxSizeSigmas * size_sigma)) return std::nullopt;
  std::optional<size_t> found;
  for (size_t i = 0; i < people.size(); ++i) {
    if (!stands[i] || std::abs(fit.log_size[i]) < 0.99 * maximum) continue;
    if (!found || Seconds(people[i]) < Seconds(people[*found])) found = i;
  }
  return found;
}

/// The person who stands on the plane for the smallest share of their time, if that is too small.
std::optional<size_t> OnSomethingElse(const std::vector<StandingPerson>& people, const std::vector<char>& stands,
                                      const Solver& solver, const Fit& fit) {
  double minimum = kMinShare;
  std::optional<size_t> found;
  for (size_t i = 0; i < people.size(); ++i) {
    if (!stands[i]) continue;
    const double share = solver.SecondsOn(fit, i) / Seconds(people[i]);
    if (share < minimum) minimum = share, found = i;
  }
  return found;
}

}  // namespace

CommonGround FindCommonGround(const std::vector<StandingPerson>& people, const Vector3d& up,
                              const CommonGroundOptions& options) {
  BODYLOOM_CHECK(std::abs(up.norm() - 1) < 1e-6, "common ground: the vertical has length ", up.norm(),
                 ", expected a unit vector");
  CommonGround result;
  result.size.assign(people.size(), 1);
  result.stands.assign(people.size(), 0);
  double total_s = 0;
  int num_standing = 0;
  for (size_t i = 0; i < people.size(); ++i) {
    total_s += Seconds(people[i]);
    result.stands[i] = Seconds(people[i]) >= GroundPlaneOptions().min_total_s;
    num_standing += result.stands[i];
  }
  if (num_standing < 2) {
    result.why = num_standing == 0 ? "nobody's feet show a ground" : "one person's feet relate to nobody's";
    return result;
  }
  const Solver solver(people, up, options.size_sigma);
  bool sizes = options.size_sigma > 0;
  for (; num_standing >= 2; --num_standing) {
    Fit fit = solver.Best(result.stands, sizes);
    // Near the plane sizes change heights by less than σ of a standing foot, which more stances do not reduce: heels
    // are raised alike in all of them.
    const bool near = sizes && std::abs(fit.height_m) * options.size_sigma < GroundPlaneOptions().height_m;
    if (near) fit = solver.Best(result.stands, sizes = false);
    std::optional<size_t> other;
    if (sizes) other = OfImpossibleSize(people, result.stands, fit, options.size_sigma);
    if (!other) other = OnSomethingElse(people, result.stands, solver, fit);
    if (other) {
      result.stands[*other] = 0;
      continue;
    }
    double on_plane_s = 0;
    for (size_t i = 0; i < people.size(); ++i) {
      if (!result.stands[i]) continue;
      on_plane_s += solver.SecondsOn(fit, i);
      result.size[i] = std::exp(fit.log_size[i]);
    }
    result.found = 2 * on_plane_s > total_s;
    if (!result.found) break;
    result.ground = {.up = fit.up, .has_plane = true, .camera_height_m = fit.height_m};
    solver.SetSigmas(result.stands, sizes, fit, &result.ground);
    result.why = Concatenate("feet of ", num_standing, " people stand on it");
    if (!sizes && options.size_sigma > 0) result.why += "; the camera is too near it to show their sizes";
    return result;
  }
  result.size.assign(people.size(), 1);
  result.why = "people's feet do not stand on one plane";
  return result;
}

}  // namespace bodyloom
