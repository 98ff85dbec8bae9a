// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_motion/unseen_frames.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

constexpr double kSeenS = 0.25;
constexpr size_t kMaxStretches = 200;  // of a gap: each is interpolated

/// Mean squares along an axis.
struct Squares {
  double rad = 0, place = 0;
};

double Parabola(double after_s, double gap_s) { return after_s * (gap_s - after_s) / 2; }

/// a² of the header by stretches of this time; false: no seen part lasts for it.
bool AccelerationOver(const CameraPath& path, double gap_s, Squares* a2) {
  Squares sum;
  double parabolas = 0;
  const size_t count = path.poses.size(), step = 1 + count / kMaxStretches;
  for (size_t i = 0; i + 2 < count; i += step) {
    size_t j = i;
    while (j + 1 < count && path.timestamps[j] - path.timestamps[i] < gap_s - 1e-6 &&
           path.timestamps[j + 1] - path.timestamps[j] <= kSeenS) {
      ++j;
    }
    const double lasts = path.timestamps[j] - path.timestamps[i];
    if (j < i + 2 || lasts < gap_s - 1e-6) continue;
    for (size_t k = i + 1; k < j; ++k) {
      const double after = path.timestamps[k] - path.timestamps[i];
      const CameraPose bridged = InterpolatePoses(path.poses[i], path.poses[j], after / lasts);
      const double turn =
          RotationAngleBetween(bridged.camera_from_world_rotation, path.poses[k].camera_from_world_rotation);
      sum.rad += turn * turn / 3;
      sum.place += (CentreOf(bridged) - CentreOf(path.poses[k])).squaredNorm() / 3;
      parabolas += Parabola(after, lasts) * Parabola(after, lasts);
    }
  }
  if (!(parabolas > 0)) return false;
  *a2 = {sum.rad / parabolas, sum.place / parabolas};
  return true;
}

Squares AccelerationOf(const CameraPath& path, double gap_s) {
  Squares a2;
  for (double over_s = gap_s; over_s > gap_s / 64; over_s /= 2) {
    if (AccelerationOver(path, over_s, &a2)) return a2;
  }
  double turns = 0, goes = 0;
  for (const CameraPose& pose : path.poses) {
    turns = std::max(
        turns, RotationAngleBetween(pose.camera_from_world_rotation, path.poses.front().camera_from_world_rotation));
    goes = std::max(goes, (CentreOf(pose) - CentreOf(path.poses.front())).norm());
  }
  const double middle = Parabola(gap_s / 2, gap_s);
  return {std::pow(turns / middle, 2), std::pow(goes / middle, 2)};
}

}  // namespace

PoseSigmas SigmasAt(std::span<const double> timestamps, const CameraPath& path, const PoseSigmas& of_poses) {
  const std::vector<double>& known = path.timestamps;
  BODYLOOM_CHECK(!known.empty() && known.size() == path.poses.size() && of_poses.rad.size() == known.size() &&
                     (of_poses.place.empty() || of_poses.place.size() == known.size()),
                 "deviations of a camera path: ", known.size(), " times, ", path.poses.size(), " poses, ",
                 of_poses.rad.size(), " and ", of_poses.place.size(), " deviations, expected as many of each");
  PoseSigmas sigmas;
  size_t gap = 0;  // its end; 0: none yet
  Squares a2;
  for (const double t : timestamps) {
    const auto next = static_cast<size_t>(std::lower_bound(known.begin(), known.end(), t) - known.begin());
    const size_t j = std::min(next, known.size() - 1), i = next == 0 || next == known.size() ? j : next - 1;
    const double lasts = known[j] - known[i], after = t - known[i];
    Squares bridged;
    if (lasts > kSeenS) {
      if (gap != j) gap = j, a2 = AccelerationOf(path, lasts);
      const double parabola = Parabola(after, lasts);
      bridged = {a2.rad * parabola * parabola, a2.place * parabola * parabola};
    }
    const double u = lasts > 0 ? after / lasts : 0;
    const auto between = [&](const std::vector<double>& of, double added) {
      return std::hypot((1 - u) * of[i] + u * of[j], std::sqrt(added));
    };
    sigmas.rad.push_back(between(of_poses.rad, bridged.rad));
    if (!of_poses.place.empty()) sigmas.place.push_back(between(of_poses.place, bridged.place));
  }
  return sigmas;
}

}  // namespace bodyloom
