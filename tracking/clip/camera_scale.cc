// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/camera_scale.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/scene/camera_path.h"
#include "tracking/problem/robust.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kScaleKernel = 3;
constexpr double kLastKernel =
    1;  // of either foot: during a change of feet neither stands, and all such steps bias s in one direction
constexpr double kMaxRunStepS = 0.25;
constexpr int kReweightings = 30;
constexpr double kSizeSigma = 0.04;  // of log s, by the body's size
constexpr double kRollMps = 0.05;    // standing feet's mean velocity over a clip
constexpr double kPlaceStepS = 0.5, kPlaceCorrelationS = 1, kPlaceMps = 0.25;
constexpr size_t kMaxStarts = 256;                     // from either foot: each costs a pass over the clip
constexpr double kFrameSigma = 0.04, kModeKernel = 1;  // of log s of one frame
constexpr double kFloorFramesS = 0.4, kFloorShare = 0.4, kFloorAgrees = 0.1, kErrorsLastS = 0.3;
constexpr int kModePasses = 30;
constexpr size_t kMaxModeStarts = 256;  // each costs a pass over the clip

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

using Feet = std::vector<std::array<FootPlace, 2>>;

std::vector<StandingRun> StandingRuns(const Feet& feet, std::span<const double> timestamps,
                                      const std::vector<char>& cut_before, std::span<const CameraPose> unit_path,
                                      const CameraScaleOptions& options) {
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

/// Of the run's reweighted least squares at s; with a kernel of 0, of plain least squares.
Normal NormalOf(const StandingRun& run, double s, double kernel) {
  Normal normal;
  for (const Offset& e : run) {
    const double weight = kernel > 0 ? GemanMcClure((e.a + s * e.b).squaredNorm(), kernel).weight : 1;
    normal.H += weight * e.b.squaredNorm();
    normal.g += weight * e.a.dot(e.b);
  }
  return normal;
}

/// Points of both feet over one step of time, of those that are seen at both ends.
struct Step {
  std::vector<Offset> points;
};

std::vector<Step> StepsOf(std::span<const Feet> points, std::span<const double> timestamps,
                          const std::vector<char>& cut_before, std::span<const CameraPose> unit_path,
                          const CameraScaleOptions& options) {
  std::vector<Step> steps;
  const size_t T = timestamps.size();
  for (size_t begin = 0, end = 0; begin < T; ++begin) {
    bool is_cut = false;
    for (end = begin + 1; end < T && timestamps[end] - timestamps[begin] < options.step_s; ++end) {
      is_cut = is_cut || cut_before[end] != 0;
    }
    if (end >= T || is_cut || cut_before[end] != 0) continue;
    if (timestamps[end] - timestamps[begin] > options.step_s + kMaxRunStepS) continue;
    Step step;
    for (const Feet& feet : points) {
      for (int foot = 0; foot < 2; ++foot) {
        const FootPlace &from = feet[begin][foot], &to = feet[end][foot];
        if (!from.seen || !to.seen || !from.ankle_m.allFinite() || !to.ankle_m.allFinite()) continue;
        // Each deviates from their mean by half of their distance, once before and once after.
        const StandingRun run =
            MakeRun({feet[begin], feet[end]}, std::array{unit_path[begin], unit_path[end]}, foot, 0, 2, options);
        step.points.push_back({std::sqrt(2.0) * run[0].a, std::sqrt(2.0) * run[0].b});
      }
    }
    if (!step.points.empty()) steps.push_back(std::move(step));
  }
  return steps;
}

/// The point that moves least at scale s.
const Offset& SlowestPoint(const Step& step, double s) {
  return *std::min_element(step.points.begin(), step.points.end(), [s](const Offset& a, const Offset& b) {
    return (a.a + s * a.b).squaredNorm() < (b.a + s * b.b).squaredNorm();
  });
}

double CostAt(const std::vector<Step>& steps, double s) {
  double cost = 0;
  for (const Step& step : steps) {
    const Offset& e = SlowestPoint(step, s);
    cost += 0.5 * GemanMcClure((e.a + s * e.b).squaredNorm(), kScaleKernel).rho;
  }
  return cost;
}

/// The positive start of minimum cost; 0 when none costs less than s = 0.
template <typename Feet>
double BestStart(const Feet& feet, const std::vector<double>& starts) {
  double best = 0, best_cost = CostAt(feet, 0);
  for (const double s : starts) {
    const double cost = s > 0 ? CostAt(feet, s) : best_cost;
    if (cost < best_cost) best = s, best_cost = cost;
  }
  return best;
}

/// The second estimate of the header: one of the two feet stands at any time.
CameraScale ScaleOfUnnamedFeet(const std::vector<Step>& steps, double seconds_a_frame,
                               const CameraScaleOptions& options) {
  CameraScale result;
  result.why = steps.empty() ? "no foot is seen" : "the feet do not tell it";
  std::vector<double> starts;
  for (size_t i = 0; i < steps.size(); i += 1 + steps.size() / kMaxStarts) {
    for (const Offset& point : steps[i].points) {
      if (point.b.squaredNorm() > 0) starts.push_back(-point.a.dot(point.b) / point.b.squaredNorm());
    }
  }
  double best = BestStart(steps, starts);
  if (!(best > 0)) return result;
  const auto at = [&](double s, double kernel) {
    Normal sum;
    for (const Step& step : steps) {
      const Normal normal = NormalOf({SlowestPoint(step, s)}, s, kernel);
      sum.H += normal.H;
      sum.g += normal.g;
    }
    return sum;
  };
  for (int pass = 0; pass < kReweightings; ++pass) {
    const Normal sum = at(best, pass < kReweightings / 2 ? kScaleKernel : kLastKernel);
    if (!(sum.H > 0)) return result;
    best = -sum.g / sum.H;
  }
  const double information = at(best, kScaleKernel).H * std::min(1.0, seconds_a_frame / options.correlation_s);
  result.scale_m = best;
  result.sigma_m = information > 0 ? 1 / std::sqrt(information) : best;
  result.found = best > 0 && result.sigma_m <= options.max_relative_sigma * best &&
                 CostAt(steps, best) <= (1 - options.min_gain) * CostAt(steps, 0);
  if (result.found) result.why = "one of both feet stands at any time";
  return result;
}

/// The first estimate of the header: runs of feet that the lifter calls standing, of `num_points` points of each.
CameraScale ScaleOfStandingFeet(const std::vector<StandingRun>& runs, size_t num_points,
                                const CameraScaleOptions& options) {
  CameraScale result;
  std::vector<double> starts;
  for (const StandingRun& run : runs) {
    const Normal normal = NormalOf(run, 0, 0);
    if (normal.H > 0) starts.push_back(-normal.g / normal.H);
  }
  double best = BestStart(runs, starts);
  if (!(best > 0)) {
    result.why = runs.empty() ? "no foot is seen to stand" : "standing feet do not tell it";
    return result;
  }
  double information = 0;
  for (int pass = 0; pass < kReweightings; ++pass) {
    Normal sum;
    information = 0;
    for (const StandingRun& run : runs) {
      const Normal normal = NormalOf(run, best, kScaleKernel);
      sum.H += normal.H;
      sum.g += normal.g;
      information += normal.H / static_cast<double>(run.size() * num_points);
    }
    if (!(sum.H > 0)) break;
    best = -sum.g / sum.H;
  }
  result.scale_m = best;
  result.sigma_m = information > 0 ? 1 / std::sqrt(information) : best;
  result.found = best > 0 && result.sigma_m <= options.max_relative_sigma * best;
  result.why = result.found ? std::to_string((runs.size() + num_points - 1) / num_points) + " times that a foot stands"
                            : "the camera hardly moves while a foot stands";
  return result;
}

/// σ of log s by the mean velocity of standing feet (header): their way adds to or takes from that of the camera.
double SigmaByRolling(double scale_m, std::span<const double> timestamps, const std::vector<char>& cut_before,
                      std::span<const CameraPose> unit_path) {
  Vector3d way = Vector3d::Zero();
  double squares = 0;
  for (size_t t = 1; t < timestamps.size(); ++t) {
    const double seconds = timestamps[t] - timestamps[t - 1];
    if (cut_before[t] != 0 || !(seconds > 0)) continue;
    const Vector3d step = CentreOf(unit_path[t]) - CentreOf(unit_path[t - 1]);
    way += step;
    squares += step.squaredNorm() / seconds;
  }
  return squares > 0 ? kRollMps * way.norm() / (scale_m * squares) : 0;
}

/// The surer one of those that are found.
const CameraScale& BetterOf(const CameraScale& named, const CameraScale& unnamed, const CameraScaleOptions& options) {
  if (!named.found || !unnamed.found) return unnamed.found ? unnamed : named;
  if (named.sigma_m < options.sure_relative_sigma * named.scale_m) return named;
  return unnamed.sigma_m * named.scale_m < named.sigma_m * unnamed.scale_m ? unnamed : named;
}

}  // namespace

CameraScale EstimateCameraScale(std::span<const Feet> points, std::span<const double> timestamps,
                                const std::vector<char>& cut_before, std::span<const CameraPose> unit_path,
                                const CameraScaleOptions& options) {
  std::vector<StandingRun> runs;
  for (const Feet& feet : points) {
    BODYLOOM_CHECK(
        feet.size() == timestamps.size() && feet.size() == cut_before.size() && feet.size() == unit_path.size(),
        "camera scale: ", feet.size(), " frames of feet, ", timestamps.size(), " timestamps, ", cut_before.size(),
        " cuts and ", unit_path.size(), " cameras, expected as many of each");
    const std::vector<StandingRun> of_point = StandingRuns(feet, timestamps, cut_before, unit_path, options);
    runs.insert(runs.end(), of_point.begin(), of_point.end());
  }
  const CameraScale named = ScaleOfStandingFeet(runs, std::max<size_t>(1, points.size()), options);
  if (timestamps.size() < 2) return named;
  const double seconds_a_frame = (timestamps.back() - timestamps.front()) / static_cast<double>(timestamps.size() - 1);
  const CameraScale unnamed =
      ScaleOfUnnamedFeet(StepsOf(points, timestamps, cut_before, unit_path, options), seconds_a_frame, options);
  CameraScale scale = BetterOf(named, unnamed, options);
  if (scale.found) {
    const double rolling = SigmaByRolling(scale.scale_m, timestamps, cut_before, unit_path);
    scale.sigma_m = std::hypot(scale.sigma_m, rolling * scale.scale_m);
  }
  return scale;
}

CameraScale ScaleByPlace(std::span<const Vector3d> places_m, std::span<const double> timestamps,
                         const std::vector<char>& cut_before, std::span<const CameraPose> unit_path) {
  BODYLOOM_CHECK(places_m.size() == timestamps.size() && places_m.size() == cut_before.size() &&
                     places_m.size() == unit_path.size(),
                 "camera scale: ", places_m.size(), " places, ", timestamps.size(), " timestamps, ", cut_before.size(),
                 " cuts and ", unit_path.size(), " cameras, expected as many of each");
  CameraScale result;
  result.why = "the person's place does not tell it";
  const size_t T = timestamps.size();
  const auto in_scene = [&](size_t t) -> Vector3d {
    return unit_path[t].camera_from_world_rotation.transpose() * places_m[t];
  };
  std::vector<Offset> velocities;
  double seconds = 0;
  for (size_t begin = 0, end = 0; begin < T; ++begin) {
    bool is_cut = false;
    for (end = begin + 1; end < T && timestamps[end] - timestamps[begin] < kPlaceStepS; ++end) {
      is_cut = is_cut || cut_before[end] != 0;
    }
    if (end >= T || is_cut || cut_before[end] != 0) continue;
    const double step = timestamps[end] - timestamps[begin];
    if (step > kPlaceStepS + kMaxRunStepS) continue;
    velocities.push_back(
        {(in_scene(end) - in_scene(begin)) / step, (CentreOf(unit_path[end]) - CentreOf(unit_path[begin])) / step});
    seconds += timestamps[begin + 1] - timestamps[begin];
  }
  const Normal normal = NormalOf(velocities, 0, 0);
  if (!(normal.H > 0)) return result;
  const double s = -normal.g / normal.H;
  double squares = 0;
  for (const Offset& v : velocities) squares += (v.a + s * v.b).squaredNorm();
  const auto count = static_cast<double>(velocities.size());
  const double independent = std::max(1.0, seconds / kPlaceCorrelationS);
  result.scale_m = s;
  result.sigma_m = std::sqrt((squares / count + kPlaceMps * kPlaceMps) / (independent * normal.H / count));
  result.found = s > 0 && result.sigma_m <= CameraScaleOptions().max_relative_sigma * s;
  if (result.found) result.why = "the person is taken to stay in one place";
  return result;
}

CameraScale ScaleByFloor(std::span<const Feet> points, std::span<const double> heights_m,
                         std::span<const double> timestamps, std::span<const CameraPose> unit_path,
                         const PointsFloor& floor) {
  BODYLOOM_CHECK(points.size() == heights_m.size() && timestamps.size() == unit_path.size(),
                 "scale by the floor: ", points.size(), " points of the feet with ", heights_m.size(), " heights, ",
                 timestamps.size(), " timestamps and ", unit_path.size(), " cameras, expected as many of each");
  CameraScale result;
  result.why = floor.why;
  if (!floor.found || timestamps.size() < 2) return result;
  std::vector<double> logs, off_floor;
  for (size_t t = 0; t < timestamps.size(); ++t) {
    const double units = floor.HeightOf(CentreOf(unit_path[t]));
    double metres = 0;
    Vector3d lowest = Vector3d::Zero();
    for (size_t k = 0; k < points.size(); ++k) {
      for (const FootPlace& foot : points[k][t]) {
        if (!foot.seen || !foot.ankle_m.allFinite()) continue;
        const Vector3d from_camera = unit_path[t].camera_from_world_rotation.transpose() * foot.ankle_m;
        const double below = heights_m[k] - floor.up.dot(from_camera);
        if (below > metres) metres = below, lowest = from_camera;
      }
    }
    if (!(units > 0) || !(metres > 0)) continue;
    logs.push_back(std::log(metres / units));
    off_floor.push_back(floor.SigmaAt(CentreOf(unit_path[t]) + lowest * (units / metres)) / units);
  }
  result.why = "no foot is seen on the floor";
  const double seconds_a_frame = (timestamps.back() - timestamps.front()) / static_cast<double>(timestamps.size() - 1);
  if (double(logs.size()) * seconds_a_frame < kFloorFramesS) return result;
  const auto weight = [&](double log, double mode) {
    const double off = (log - mode) / kFrameSigma;
    return GemanMcClure(off * off, kModeKernel).weight;
  };
  // The start is the place where most frames agree; from there the mode is a fixed point.
  double mode = 0, most = 0;
  for (size_t i = 0; i < logs.size(); i += 1 + logs.size() / kMaxModeStarts) {
    double sum = 0;
    for (const double log : logs) sum += weight(log, logs[i]);
    if (sum > most) most = sum, mode = logs[i];
  }
  for (int pass = 0; pass < kModePasses; ++pass) {
    double sum = 0, weights = 0;
    for (const double log : logs) sum += weight(log, mode) * log, weights += weight(log, mode);
    mode = sum / weights;
  }
  double agree = 0, squares = 0;
  for (const double log : logs) {
    if (std::abs(log - mode) > kFloorAgrees) continue;
    agree += 1;
    squares += (log - mode) * (log - mode);
  }
  result.why = "feet are seldom at one height above the floor";
  if (agree * seconds_a_frame < kFloorFramesS || agree < kFloorShare * double(logs.size())) return result;
  const double independent = std::max(1.0, agree * std::min(1.0, seconds_a_frame / kErrorsLastS));
  const double of_frames = std::sqrt((squares / agree + kFrameSigma * kFrameSigma) / independent);
  const double of_floor = Percentile(off_floor, 50);
  result.scale_m = std::exp(mode);
  result.sigma_m = result.scale_m * std::hypot(of_frames, of_floor);
  result.found = result.sigma_m <= CameraScaleOptions().max_relative_sigma * result.scale_m;
  result.why = "feet on the floor, " + floor.why;
  return result;
}

CameraScale JoinScales(const CameraScale& feet, const CameraScale& floor) {
  CameraScale joined = floor.found ? floor : feet;
  if (!joined.found) return joined;
  double relative = joined.sigma_m / joined.scale_m;
  if (feet.found && floor.found) {
    const double of_feet = std::pow(feet.scale_m / feet.sigma_m, 2),
                 of_floor = std::pow(floor.scale_m / floor.sigma_m, 2);
    joined.scale_m =
        std::exp((of_feet * std::log(feet.scale_m) + of_floor * std::log(floor.scale_m)) / (of_feet + of_floor));
    relative = 1 / std::sqrt(of_feet + of_floor);
    joined.why = floor.why + "; " + feet.why;
  }
  joined.sigma_m = joined.scale_m * std::hypot(relative, kSizeSigma);
  return joined;
}

}  // namespace bodyloom
