// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/camera_scale.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/camera_path.h"
#include "bodyloom/tracking/robust.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kScaleKernel = 3;
constexpr double kMaxRunStepS = 0.25;
constexpr int kReweightings = 30;

/// One frame of a run: its whitened offset from the run's mean, a + s b.
struct Offset {
  Vector3d a, b;
};
using StandingRun = std::vector<Offset>;

/// Frames [begin, end) of one foot as offsets.
StandingRun MakeRun(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const CameraPose> unit_path, int foot,
                    size_t begin, size_t end, const CameraScaleOptions& options) {
  Vector3d mean_q = Vector3d::Zero(), mean_c = Vector3d::Zero();
  const auto in_scene = [&](size_t t) -> Vector3d {
    return unit_path[t].camera_from_world_rotation.transpose() * feet[t][foot].ankle_m;
  };
  for (size_t t = begin; t < end; ++t) {
    mean_q += in_scene(t) / static_cast<double>(end - begin);
    mean_c += CentreOf(unit_path[t]) / static_cast<double>(end - begin);
  }
  StandingRun run;
  for (size_t t = begin; t < end; ++t) {
    const Vector3d ray = in_scene(t).normalized();
    const Matrix3d whitening =
        Matrix3d::Identity() / options.across_m + (1 / options.along_m - 1 / options.across_m) * ray * ray.transpose();
    run.push_back({whitening * (in_scene(t) - mean_q), whitening * (CentreOf(unit_path[t]) - mean_c)});
  }
  return run;
}

std::vector<StandingRun> StandingRuns(const std::vector<std::array<FootPlace, 2>>& feet,
                                      std::span<const double> timestamps, const std::vector<char>& cut_before,
                                      std::span<const CameraPose> unit_path, const CameraScaleOptions& options) {
  std::vector<StandingRun> runs;
  const size_t T = feet.size();
  for (int foot = 0; foot < 2; ++foot) {
    const auto stands = [&](size_t t) {
      const FootPlace& place = feet[t][foot];
      return place.seen && place.contact >= options.min_contact && place.ankle_m.allFinite();
    };
    for (size_t begin = 0, end = 0; begin < T; begin = std::max(end, begin + 1)) {
      for (end = begin; end < T && stands(end); ++end) {
        if (end > begin && (cut_before[end] != 0 || timestamps[end] - timestamps[end - 1] > kMaxRunStepS)) break;
      }
      if (end < begin + 3 || timestamps[end - 1] - timestamps[begin] < options.min_run_s) continue;
      runs.push_back(MakeRun(feet, unit_path, foot, begin, end, options));
    }
  }
  return runs;
}

double CostAt(const std::vector<StandingRun>& runs, double s) {
  double cost = 0;
  for (const StandingRun& run : runs) {
    for (const Offset& e : run) cost += 0.5 * GemanMcClure((e.a + s * e.b).squaredNorm(), kScaleKernel).rho;
  }
  return cost;
}

struct Normal {
  double H = 0, g = 0;
};

/// Of the run's reweighted least squares at s; with `robust` false, of plain least squares.
Normal NormalOf(const StandingRun& run, double s, bool robust) {
  Normal normal;
  for (const Offset& e : run) {
    const double weight = robust ? GemanMcClure((e.a + s * e.b).squaredNorm(), kScaleKernel).weight : 1;
    normal.H += weight * e.b.squaredNorm();
    normal.g += weight * e.a.dot(e.b);
  }
  return normal;
}

}  // namespace

CameraScale EstimateCameraScale(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                                const std::vector<char>& cut_before, std::span<const CameraPose> unit_path,
                                const CameraScaleOptions& options) {
  BODYLOOM_CHECK(
      feet.size() == timestamps.size() && feet.size() == cut_before.size() && feet.size() == unit_path.size(),
      "camera scale: ", feet.size(), " frames of feet, ", timestamps.size(), " timestamps, ", cut_before.size(),
      " cuts and ", unit_path.size(), " cameras, expected as many of each");
  CameraScale result;
  const std::vector<StandingRun> runs = StandingRuns(feet, timestamps, cut_before, unit_path, options);
  double best = 0, best_cost = CostAt(runs, 0);
  for (const StandingRun& run : runs) {
    const Normal normal = NormalOf(run, 0, false);
    const double s = normal.H > 0 ? -normal.g / normal.H : 0;
    const double cost = s > 0 ? CostAt(runs, s) : best_cost;
    if (cost < best_cost) best = s, best_cost = cost;
  }
  if (!(best > 0)) {
    result.why = runs.empty() ? "no foot is seen to stand" : "standing feet do not tell it";
    return result;
  }
  double information = 0;
  for (int pass = 0; pass < kReweightings; ++pass) {
    Normal sum;
    information = 0;
    for (const StandingRun& run : runs) {
      const Normal normal = NormalOf(run, best, true);
      sum.H += normal.H;
      sum.g += normal.g;
      information += normal.H / static_cast<double>(run.size());
    }
    if (!(sum.H > 0)) break;
    best = -sum.g / sum.H;
  }
  result.scale_m = best;
  result.sigma_m = information > 0 ? 1 / std::sqrt(information) : best;
  result.found = best > 0 && result.sigma_m <= options.max_relative_sigma * best;
  result.why = result.found ? std::to_string(runs.size()) + " times that a foot stands"
                            : "the camera hardly moves while a foot stands";
  return result;
}

}  // namespace bodyloom
