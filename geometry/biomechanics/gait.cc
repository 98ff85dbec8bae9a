// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/gait.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/base/units.h"
#include "geometry/biomechanics/joint_angles.h"
#include "geometry/biomechanics/track_angles.h"
#include "geometry/body/centre_of_mass.h"

namespace bodyloom {
namespace {

// Stretches without gaps, slopes and extremes of signals over time.

/// A maximum of a signal.
struct Extreme {
  size_t index = 0;    ///< of the highest sample
  double seconds = 0;  ///< vertex of the parabola through it and its neighbours
};

using Eigen::Vector2d;

constexpr double kMinStretch_s = 1, kMaxGapSteps = 2.5, kSlopeHalfWindow_s = 0.5, kMeanHalfWindow_s = 0.05;
constexpr double kClockRounding_s = 1e-6;

/// Indices [first, last] of the times within `half` of the i-th.
std::pair<size_t, size_t> TimesWithin(const std::vector<double>& times, size_t i, double half) {
  const auto first = std::lower_bound(times.begin(), times.end(), times[i] - half - kClockRounding_s);
  const auto end = std::upper_bound(times.begin(), times.end(), times[i] + half + kClockRounding_s);
  return {static_cast<size_t>(first - times.begin()), static_cast<size_t>(end - times.begin()) - 1};
}

std::vector<double> Averaged(const std::vector<double>& times, const std::vector<double>& values) {
  std::vector<double> means;
  for (size_t i = 0; i < values.size(); ++i) {
    auto [first, last] = TimesWithin(times, i, kMeanHalfWindow_s);
    const size_t reach = std::min(i - first, last - i);  // the same on both sides: a slope stays where it is
    double sum = 0;
    for (size_t k = i - reach; k <= i + reach; ++k) sum += values[k];
    means.push_back(sum / double(2 * reach + 1));
  }
  return means;
}

/// Vertex of the parabola through samples i − 1, i, i + 1; the sample's own time at the ends.
double Vertex(const std::vector<double>& times, const std::vector<double>& values, size_t i) {
  if (i == 0 || i + 1 >= values.size()) return times[i];
  const double before = times[i - 1] - times[i], after = times[i + 1] - times[i];
  const double fall_before = (values[i - 1] - values[i]) / before, fall_after = (values[i + 1] - values[i]) / after;
  const double bend = (fall_after - fall_before) / (after - before), slope = fall_before - bend * before;
  return bend < 0 ? times[i] + std::clamp(-slope / (2 * bend), before, after) : times[i];
}

/// Stretches [begin, end) of known frames, at least a second long, without a step of more than 2.5 median ones.
std::vector<std::pair<size_t, size_t>> KnownStretches(const std::vector<double>& times,
                                                      const std::vector<bool>& known) {
  std::vector<double> steps;
  for (size_t t = 1; t < times.size(); ++t) steps.push_back(times[t] - times[t - 1]);
  const double max_step = kMaxGapSteps * Percentile(steps, 50);
  std::vector<std::pair<size_t, size_t>> stretches;
  size_t begin = 0;
  for (size_t t = 0; t <= times.size(); ++t) {
    const bool goes_on = t < times.size() && known[t] && (t == begin || times[t] - times[t - 1] <= max_step);
    if (goes_on) continue;
    if (t > begin && times[t - 1] - times[begin] >= kMinStretch_s) stretches.emplace_back(begin, t);
    begin = t < times.size() && known[t] ? t : t + 1;
  }
  return stretches;
}

/// Slope of the line fitted to the points within 0.5 s of each time; zero where there is one point alone.
std::vector<Vector2d> LocalSlopes(const std::vector<double>& times, const std::vector<Vector2d>& points) {
  std::vector<Vector2d> slopes;
  for (size_t i = 0; i < points.size(); ++i) {
    const auto [first, last] = TimesWithin(times, i, kSlopeHalfWindow_s);
    double mean = 0;
    for (size_t k = first; k <= last; ++k) mean += times[k] / double(last - first + 1);
    Vector2d sum = Vector2d::Zero();
    double squares = 0;
    for (size_t k = first; k <= last; ++k) {
      sum += (times[k] - mean) * points[k];
      squares += (times[k] - mean) * (times[k] - mean);
    }
    slopes.emplace_back(squares > 0 ? Vector2d(sum / squares) : Vector2d::Zero());
  }
  return slopes;
}

/// Maxima of the signal averaged over 0.1 s, before and after which it falls by `swing` and more.
std::vector<Extreme> Maxima(const std::vector<double>& times, const std::vector<double>& values, double swing) {
  std::vector<Extreme> maxima;
  const std::vector<double> smooth = Averaged(times, values);
  if (smooth.empty()) return maxima;
  size_t highest = 0, lowest = 0;
  bool rising = false;  // a swing up from the lowest sample has been seen
  for (size_t i = 1; i < smooth.size(); ++i) {
    if (rising) {
      if (smooth[i] > smooth[highest]) highest = i;
      if (smooth[i] <= smooth[highest] - swing) {
        maxima.push_back({highest, Vertex(times, smooth, highest)});
        rising = false;
        lowest = i;
      }
    } else {
      if (smooth[i] < smooth[lowest]) lowest = i;
      if (smooth[i] >= smooth[lowest] + swing) {
        rising = true;
        highest = i;
      }
    }
  }
  return maxima;
}

constexpr double kMinSpeed = 0.1, kMaxSpeed = 0.77;  // of √(gL)
constexpr double kFacing_deg = 60, kMinSwing = 0.15, kMinStep = 0.15;
constexpr double kStandingSpeed = 0.5, kStandingSpeed_mps = 0.3, kMaxFlightShare = 0.2;
constexpr double kMinStepTime_s = 0.25, kMaxStepTime_s = 1.5;
constexpr size_t kMinStrikes = 4;

struct Strike {
  Extreme at;
  Foot foot = Foot::kLeft;
  double ahead_m = 0;  ///< of the other ankle
};

/// A stretch of frames in which the pelvis moves forwards at a walk.
struct MovingStretch {
  size_t begin = 0, end = 0;
  std::vector<Vector2d> direction;  ///< by frame of the stretch
};

/// Frames that are none of walking, by reason.
struct Rejections {
  size_t known = 0, slow = 0, fast = 0, turned = 0;
  bool few_strikes = false, flight = false;

  [[nodiscard]] std::string Reason() const {
    if (known == 0) return "no stretch of a second in which the person is known";
    if (flight) return "both feet leave the ground, as in running";
    if (few_strikes) return "the feet do not strike in turn, four times and more, ahead of each other";
    const size_t most = std::max({slow, fast, turned});
    if (slow == most) return "the pelvis does not move as fast as in walking";
    return fast == most ? "the pelvis moves faster than in walking" : "the person moves sideways or backwards";
  }
};

Vector2d Horizontal(const MatrixX3d& places, size_t t) {
  return {places(static_cast<Eigen::Index>(t), 0), places(static_cast<Eigen::Index>(t), 2)};
}

class GaitAnalysis {
 public:
  explicit GaitAnalysis(const GaitPlaces& places) : places_(places), pace_(std::sqrt(kGravity * places.leg_length_m)) {}

  GaitReport Report() {
    for (const auto& [begin, end] : KnownStretches(places_.timestamps, IsKnown())) AddKnown(begin, end);
    report_.walks = report_.num_steps > 0;
    if (!report_.walks) {
      report_.reason = rejections_.Reason();
      return report_;
    }
    std::sort(report_.events.begin(), report_.events.end(),
              [](const GaitEvent& a, const GaitEvent& b) { return a.seconds < b.seconds; });
    report_.step_time_s = walked_s_ / report_.num_steps;
    report_.cadence_per_min = 60 / report_.step_time_s;
    report_.speed_mps = walked_m_ / walked_s_;
    for (const size_t foot : {0, 1}) report_.step_length_m[foot] = length_sum_[foot] / length_count_[foot];
    return report_;
  }

 private:
  [[nodiscard]] std::vector<bool> IsKnown() const {
    std::vector<bool> known(places_.timestamps.size(), true);
    for (size_t t = 0; t < known.size(); ++t) {
      const auto row = static_cast<Eigen::Index>(t);
      for (const size_t side : {0, 1}) {
        known[t] = known[t] && places_.hips[side].row(row).allFinite() && places_.ankles[side].row(row).allFinite() &&
                   places_.balls[side].row(row).allFinite();
      }
    }
    return known;
  }

  [[nodiscard]] Vector2d MidHip(size_t t) const {
    return 0.5 * (Horizontal(places_.hips[0], t) + Horizontal(places_.hips[1], t));
  }

  /// Splits a stretch without gaps into those that move at a walk.
  void AddKnown(size_t begin, size_t end) {
    rejections_.known += end - begin;
    std::vector<Vector2d> mid_hip;
    for (size_t t = begin; t < end; ++t) mid_hip.push_back(MidHip(t));
    const std::vector<double> times(places_.timestamps.begin() + static_cast<std::ptrdiff_t>(begin),
                                    places_.timestamps.begin() + static_cast<std::ptrdiff_t>(end));
    const std::vector<Vector2d> velocity = LocalSlopes(times, mid_hip);
    MovingStretch stretch;
    for (size_t t = begin; t <= end; ++t) {
      if (t < end && MovesForwards(t, velocity[t - begin])) {
        if (stretch.direction.empty()) stretch.begin = t;
        stretch.direction.push_back(velocity[t - begin].normalized());
      } else if (!stretch.direction.empty()) {
        stretch.end = t;
        AddMoving(stretch);
        stretch = {};
      }
    }
  }

  bool MovesForwards(size_t t, const Vector2d& velocity) {
    const double speed = velocity.norm();
    if (!(speed >= kMinSpeed * pace_)) return ++rejections_.slow, false;
    if (speed > kMaxSpeed * pace_) return ++rejections_.fast, false;
    const Vector2d right = Horizontal(places_.hips[1], t) - Horizontal(places_.hips[0], t);
    const Vector2d forward(right.y(), -right.x());  // up × right
    if (forward.dot(velocity) < std::cos(kFacing_deg * kDegree) * forward.norm() * speed) {
      return ++rejections_.turned, false;
    }
    return true;
  }

  [[nodiscard]] std::vector<Extreme> ExtremesOf(const MovingStretch& stretch, const MatrixX3d& foot,
                                                double sign) const {
    std::vector<double> times, ahead;
    for (size_t t = stretch.begin; t < stretch.end; ++t) {
      times.push_back(places_.timestamps[t]);
      ahead.push_back(sign * (Horizontal(foot, t) - MidHip(t)).dot(stretch.direction[t - stretch.begin]));
    }
    std::vector<Extreme> maxima = Maxima(times, ahead, kMinSwing * places_.leg_length_m);
    for (Extreme& maximum : maxima) maximum.index += stretch.begin;
    return maxima;
  }

  void AddMoving(const MovingStretch& stretch) {
    std::vector<Strike> strikes;
    std::array<std::vector<Extreme>, 2> offs;
    for (const size_t side : {0, 1}) {
      for (const Extreme& at : ExtremesOf(stretch, places_.ankles[side], 1)) {
        const Vector2d ahead =
            Horizontal(places_.ankles[side], at.index) - Horizontal(places_.ankles[1 - side], at.index);
        strikes.push_back({at, static_cast<Foot>(side), ahead.dot(stretch.direction[at.index - stretch.begin])});
      }
      offs[side] = ExtremesOf(stretch, places_.balls[side], -1);
    }
    std::sort(strikes.begin(), strikes.end(),
              [](const Strike& a, const Strike& b) { return a.at.seconds < b.at.seconds; });
    size_t first = 0;
    for (size_t i = 1; i <= strikes.size(); ++i) {
      if (i < strikes.size() && Follows(strikes[i - 1], strikes[i])) continue;
      AddBout({strikes.begin() + static_cast<std::ptrdiff_t>(first), strikes.begin() + static_cast<std::ptrdiff_t>(i)},
              offs);
      first = i;
    }
    if (strikes.size() < kMinStrikes) rejections_.few_strikes = true;
  }

  [[nodiscard]] bool Follows(const Strike& before, const Strike& after) const {
    const double step_s = after.at.seconds - before.at.seconds, min_step_m = kMinStep * places_.leg_length_m;
    return before.foot != after.foot && step_s >= kMinStepTime_s && step_s <= kMaxStepTime_s &&
           before.ahead_m >= min_step_m && after.ahead_m >= min_step_m;
  }

  /// Share of the frames in (first, last), which is within a stretch, at which no foot stands.
  [[nodiscard]] double FlightShare(size_t first, size_t last) const {
    int in_flight = 0;
    for (size_t t = first + 1; t < last; ++t) {
      const double seconds = places_.timestamps[t + 1] - places_.timestamps[t - 1];
      const auto speed = [&](const Vector2d& before, const Vector2d& after) {
        return (after - before).norm() / seconds;
      };
      const double slow = std::max(kStandingSpeed * speed(MidHip(t - 1), MidHip(t + 1)), kStandingSpeed_mps);
      bool stands = false;
      for (const size_t side : {0, 1}) {
        for (const MatrixX3d* of : {&places_.ankles[side], &places_.balls[side]}) {
          stands = stands || speed(Horizontal(*of, t - 1), Horizontal(*of, t + 1)) < slow;
        }
      }
      in_flight += stands ? 0 : 1;
    }
    return double(in_flight) / double(std::max<size_t>(last - first, 2) - 1);
  }

  void AddBout(const std::vector<Strike>& strikes, const std::array<std::vector<Extreme>, 2>& offs) {
    if (strikes.size() < kMinStrikes) {
      rejections_.few_strikes = true;
      return;
    }
    if (FlightShare(strikes.front().at.index, strikes.back().at.index) > kMaxFlightShare) {
      rejections_.flight = true;
      return;
    }
    const double begin = strikes.front().at.seconds, end = strikes.back().at.seconds;
    const double half_step = 0.5 * (end - begin) / double(strikes.size() - 1);
    std::vector<GaitEvent> events;
    for (const Strike& strike : strikes) {
      events.push_back({strike.at.seconds, static_cast<int>(strike.at.index), strike.foot, GaitEventKind::kFootStrike});
      const Foot other = strike.foot == Foot::kLeft ? Foot::kRight : Foot::kLeft;
      for (const Extreme& off : offs[size_t(other)]) {
        const double after = off.seconds - strike.at.seconds;
        if (std::abs(after) > half_step) continue;
        events.push_back({off.seconds, static_cast<int>(off.index), other, GaitEventKind::kFootOff});
      }
    }
    report_.events.insert(report_.events.end(), events.begin(), events.end());
    report_.bouts_s.emplace_back(begin, end);
    report_.num_steps += static_cast<int>(strikes.size()) - 1;
    walked_s_ += end - begin;
    for (size_t i = 1; i < strikes.size(); ++i) {
      const Vector2d way = MidHip(strikes[i].at.index) - MidHip(strikes[i - 1].at.index);
      walked_m_ += way.norm();
      const auto side = size_t(strikes[i].foot);
      const Vector2d step = Horizontal(places_.ankles[side], strikes[i].at.index) -
                            Horizontal(places_.ankles[1 - side], strikes[i - 1].at.index);
      length_sum_[side] += step.dot(way.normalized());
      length_count_[side] += 1;
    }
  }

  const GaitPlaces& places_;
  double pace_;  ///< √(gL), m/s
  GaitReport report_;
  Rejections rejections_;
  double walked_s_ = 0, walked_m_ = 0;
  std::array<double, 2> length_sum_{}, length_count_{};
};

}  // namespace

GaitReport::GaitReport()
    : cadence_per_min(std::numeric_limits<double>::quiet_NaN()),
      step_time_s(cadence_per_min),
      step_length_m{cadence_per_min, cadence_per_min},
      speed_mps(cadence_per_min) {}

std::string GaitReport::BriefReport() const {
  if (!walks) return "no walking: " + reason;
  char text[200];
  std::snprintf(
      text, sizeof text, "walking, %d steps: %.0f a minute, %.2f s each, %.2f m long (left %.2f, right %.2f), %.2f m/s",
      num_steps, cadence_per_min, step_time_s, mean_step_length_m(), step_length_m[0], step_length_m[1], speed_mps);
  return text;
}

GaitReport AnalyseGait(const GaitPlaces& places) {
  const auto T = static_cast<Eigen::Index>(places.timestamps.size());
  for (const size_t side : {0, 1}) {
    BODYLOOM_CHECK(places.hips[side].rows() == T && places.ankles[side].rows() == T && places.balls[side].rows() == T,
                   "gait: ", places.hips[side].rows(), " hips, ", places.ankles[side].rows(), " ankles and ",
                   places.balls[side].rows(), " balls of the feet at ", T, " times");
  }
  BODYLOOM_CHECK(places.leg_length_m > 0, "gait: the leg length is ", places.leg_length_m, ", expected above 0");
  return GaitAnalysis(places).Report();
}

GaitReport AnalyseGait(const BodyModel& body, const Track& track, const WorldFrame& world) {
  const Motion& motion = track.motion;
  BODYLOOM_CHECK(motion.poses.cols() <= 3 * body.num_joints(), "gait: the track has ", motion.poses.cols() / 3,
                 " joints, the body '", body.name(), "' ", body.num_joints());
  const MatrixX3d rest = body.RestJoints(motion.betas);
  GaitPlaces places;
  places.timestamps = motion.timestamps;
  std::array<std::array<int, 3>, 2> joints{};
  for (const size_t side : {0, 1}) {
    const std::string prefix = side == 0 ? "l_" : "r_";
    const auto joint = [&](const char* name) { return RequireJoint(body, prefix + name, "gait"); };
    joints[side] = {joint("hip"), joint("ankle"), joint("foot")};
    const int knee = joint("knee");
    places.leg_length_m += 0.5 * ((rest.row(joints[side][0]) - rest.row(knee)).norm() +
                                  (rest.row(knee) - rest.row(joints[side][1])).norm());
    for (MatrixX3d* of : {&places.hips[side], &places.ankles[side], &places.balls[side]}) {
      of->setConstant(motion.num_frames(), 3, std::numeric_limits<double>::quiet_NaN());
    }
  }
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (!motion.HasPose(t)) continue;
    const MatrixX3d in_world = SkeletonInWorld(body, rest, motion, t, world).joints;
    for (const size_t side : {0, 1}) {
      places.hips[side].row(t) = in_world.row(joints[side][0]);
      places.ankles[side].row(t) = in_world.row(joints[side][1]);
      places.balls[side].row(t) = in_world.row(joints[side][2]);
    }
  }
  return AnalyseGait(places);
}

}  // namespace bodyloom
