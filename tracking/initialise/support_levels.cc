// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/support_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr double kMaxFrame_s = 0.1;     ///< a frame stands for no longer time
constexpr double kSystematicM = 0.015;  ///< σ of what all frames are off together
/// Of the scatter of heights about their level, apart from kSystematicM, which no time averages. The whole error of
/// what touches the ground lasts longer: kTouchErrorLasts_s (terms/surface_contact/clip_contacts.h).
constexpr double kScatterLasts_s = 0.5;
constexpr double kMaxTiltSigmas = 3;    ///< a height that so many of the vertical's σ explain is no level
constexpr size_t kMaxLevels = 12;       ///< more are not levels but a slope or errors
constexpr double kRestWeight = 0.5;     ///< w / Δt of a frame at rest
constexpr double kFallWindow_s = 0.14;  ///< on each side of a frame, at least; at most twice that

struct RestingFrame {
  double height_m = 0, weight = 0, seconds = 0;
  bool rests = false;
};

/// True if the lowest point was lower before frame t and is lower after it, by a fall of kMaxFall on each side. False
/// where too little is seen around it.
bool IsTop(std::span<const LowestPoint> points, const Vector3d& up, size_t t) {
  const auto at = [&](size_t i) { return points[i].seconds; };
  size_t first = t, last = t;
  while (first > 0 && at(t) - at(first) < kFallWindow_s) --first;
  while (last + 1 < points.size() && at(last) - at(t) < kFallWindow_s) ++last;
  for (const size_t other : {first, last}) {
    const double seconds = std::abs(at(t) - at(other));
    if (seconds < kFallWindow_s || seconds > 2 * kFallWindow_s || !points[other].supports) return false;
    if (up.dot(points[t].place_m - points[other].place_m) < 0.5 * kMaxFall * seconds * seconds) return false;
  }
  return true;
}

std::vector<RestingFrame> Weigh(std::span<const LowestPoint> points, const Vector3d& up) {
  std::vector<RestingFrame> frames(points.size());
  for (size_t t = 0; t < points.size(); ++t) {
    if (!points[t].supports || IsTop(points, up, t)) continue;
    const size_t before = t > 0 ? t - 1 : t, after = t + 1 < points.size() ? t + 1 : t;
    const double span = points[after].seconds - points[before].seconds;
    const double seconds = std::min(kMaxFrame_s, after > before ? span / static_cast<double>(after - before) : 0.0);
    const double slow = points[t].speed_mps / kRestSpeed, share = 1 / (1 + slow * slow);
    frames[t] = {up.dot(points[t].place_m), seconds * share, seconds, share >= kRestWeight};
  }
  return frames;
}

/// The level of the window with the largest weight among the frames farther than `apart_m` from all levels.
SupportLevel Heaviest(const std::vector<RestingFrame>& frames, const std::vector<SupportLevel>& levels,
                      double apart_m) {
  std::vector<std::pair<double, double>> left;  // height, weight
  for (const RestingFrame& frame : frames) {
    if (!(frame.weight > 0)) continue;
    const bool far = std::all_of(levels.begin(), levels.end(), [&](const SupportLevel& level) {
      return std::abs(frame.height_m - level.level_m) > apart_m;
    });
    if (far) left.emplace_back(frame.height_m, frame.weight);
  }
  std::sort(left.begin(), left.end());
  SupportLevel best;
  double sum = 0, moment = 0, square = 0;
  for (size_t first = 0, end = 0; first < left.size(); ++first) {
    for (; end < left.size() && left[end].first <= left[first].first + 2 * kLevelHalfWidthM; ++end) {
      const double from_first = left[end].first - left.front().first;
      sum += left[end].second;
      moment += left[end].second * from_first;
      square += left[end].second * from_first * from_first;
    }
    if (sum > best.seconds) {
      const double mean = moment / sum, variance = std::max(0.0, square / sum - mean * mean);
      best = {left.front().first + mean, sum,
              std::sqrt(variance / std::max(1.0, sum / kScatterLasts_s) + kSystematicM * kSystematicM)};
    }
    const double from_first = left[first].first - left.front().first;
    sum -= left[first].second;
    moment -= left[first].second * from_first;
    square -= left[first].second * from_first * from_first;
  }
  return best;
}

/// Mean place of the frames on a level, weighted.
Vector3d PlaceOn(const SupportLevel& level, std::span<const LowestPoint> points,
                 const std::vector<RestingFrame>& frames) {
  Vector3d sum = Vector3d::Zero();
  double weight = 0;
  for (size_t t = 0; t < frames.size(); ++t) {
    if (!(frames[t].weight > 0) || std::abs(frames[t].height_m - level.level_m) > kOnLevelM) continue;
    sum += frames[t].weight * points[t].place_m;
    weight += frames[t].weight;
  }
  return weight > 0 ? Vector3d(sum / weight) : sum;
}

/// Weight of the frames on a level.
double WeightOn(const SupportLevel& level, const std::vector<RestingFrame>& frames) {
  double weight = 0;
  for (const RestingFrame& frame : frames) {
    if (std::abs(frame.height_m - level.level_m) <= kOnLevelM) weight += frame.weight;
  }
  return weight;
}

/// Seconds of frames at rest on a level.
double SecondsAtRest(const SupportLevel& level, const std::vector<RestingFrame>& frames) {
  double seconds = 0;
  for (const RestingFrame& frame : frames) {
    if (frame.rests && std::abs(frame.height_m - level.level_m) <= kOnLevelM) seconds += frame.seconds;
  }
  return seconds;
}

std::vector<int> AssignFrames(const std::vector<RestingFrame>& frames, const std::vector<SupportLevel>& levels) {
  const auto T = static_cast<int>(frames.size());
  std::vector<int> own(frames.size(), -1), before(frames.size(), -1), of_frame(frames.size(), 0);
  for (int t = 0; t < T; ++t) {
    double nearest = kOnLevelM;
    for (size_t k = 0; frames[t].rests && k < levels.size(); ++k) {
      const double off = std::abs(frames[t].height_m - levels[k].level_m);
      if (off > nearest) continue;
      nearest = off;
      own[t] = static_cast<int>(k);
    }
    before[t] = own[t] >= 0 ? own[t] : t > 0 ? before[t - 1] : -1;
  }
  int after = -1;
  for (int t = T; t-- > 0;) {
    if (own[t] >= 0) after = own[t];
    const bool only_after = before[t] < 0 || (after >= 0 && levels[after].level_m < levels[before[t]].level_m);
    of_frame[t] = std::max(0, own[t] >= 0 ? own[t] : only_after ? after : before[t]);
  }
  return of_frame;
}

}  // namespace

SupportLevels FindSupportLevels(std::span<const LowestPoint> points, const Vector3d& up, double up_sigma_rad,
                                std::optional<double> main_level_m) {
  SupportLevels result;
  result.of_frame.assign(points.size(), 0);
  const std::vector<RestingFrame> frames = Weigh(points, up);
  double rest_s = 0;
  for (const RestingFrame& frame : frames) rest_s += frame.weight;
  SupportLevel main;
  if (main_level_m) {
    main = {*main_level_m, 0, std::numeric_limits<double>::quiet_NaN()};
    main.seconds = WeightOn(main, frames);
  } else {
    main = Heaviest(frames, {}, 0);
    const double weight = main.seconds > 0 ? WeightOn(main, frames) : 0;
    if (!(SecondsAtRest(main, frames) >= kMinRest_s)) {
      result.why = "nothing is seen to rest for long enough";
      return result;
    }
    if (!(weight >= kMinRestShare * rest_s)) {
      result.why = "the body does not rest at one height";
      return result;
    }
    main.seconds = weight;
  }
  result.why = Concatenate("the body rests on it for ", std::round(10 * SecondsAtRest(main, frames)) / 10, " s");
  result.levels.push_back(main);
  const Vector3d main_place = PlaceOn(main, points, frames);
  while (result.levels.size() < kMaxLevels) {
    SupportLevel other = Heaviest(frames, result.levels, kApartM);
    if (!(other.seconds >= kMinLevel_s && SecondsAtRest(other, frames) >= kMinRest_s)) break;
    Vector3d apart = PlaceOn(other, points, frames) - main_place;
    apart -= up.dot(apart) * up;
    // A slope of the whole clip: what lies still farther is one as well.
    if (std::abs(other.level_m - main.level_m) <= kMaxTiltSigmas * up_sigma_rad * apart.norm()) break;
    other.seconds = WeightOn(other, frames);
    result.levels.push_back(other);
  }
  result.of_frame = AssignFrames(frames, result.levels);
  return result;
}

}  // namespace bodyloom
