// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/floor_scale.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/scene/camera_path.h"
#include "tracking/problem/robust.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Feet = std::vector<std::array<FootPlace, 2>>;

constexpr double kFrameSigma = 0.04, kModeKernel = 1;  // of log s of one frame
constexpr double kFloorFramesS = 0.4, kFloorShare = 0.4, kFloorAgrees = 0.1, kErrorsLastS = 0.3;
constexpr int kModePasses = 30;
constexpr size_t kMaxModeStarts = 256;  // each costs a pass over the clip

}  // namespace

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

}  // namespace bodyloom
