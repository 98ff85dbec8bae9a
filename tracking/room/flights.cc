// SPDX-License-Identifier: Apache-2.0
#include "tracking/room/flights.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "geometry/body/centre_of_mass.h"
#include "tracking/problem/contact_points.h"
#include "tracking/problem/robust.h"

namespace bodyloom {
namespace {

constexpr int kMinFlightFrames = 5;  ///< a parabola leaves two of them to tell its error

struct Flight {
  double log_scale = 0, sigma = 0;
};

/// Acceleration of the parabola fitted to the centre of mass in [begin, end), m/s², downwards positive.
double FallIn(std::span<const FlightFrame> frames, std::span<const double> at, size_t begin, size_t end) {
  const auto n = static_cast<Eigen::Index>(end - begin);
  Eigen::MatrixX3d powers(n, 3);
  Eigen::VectorXd heights(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double s = at[begin + k] - at[begin + n / 2];
    powers.row(k) << 1, s, s * s;
    heights[k] = frames[begin + k].centre_m;
  }
  return -2 * powers.colPivHouseholderQr().solve(heights)[2];
}

/// Stretches without contact by the reason for which they are no flights; `flights`: the others.
struct Stretches {
  std::vector<Flight> flights;
  int other = 0;  ///< too short, too long, not upright or not falling
};

Stretches FindStretches(std::span<const FlightFrame> frames, std::span<const double> at,
                        const std::vector<char>& cut_before) {
  const size_t T = frames.size();
  Stretches found;
  const auto goes_on = [&](size_t t) { return t < T && cut_before[t] == 0; };
  const auto sunk = [&](size_t begin, size_t end) {
    for (size_t t = begin; t > 0 && goes_on(t) && at[begin] - at[t - 1] <= 1; --t) {
      if (frames[t - 1].lowest_m < -kSunkM) return true;
    }
    for (size_t t = end; goes_on(t) && at[t] - at[end - 1] <= 1; ++t) {
      if (frames[t].lowest_m < -kSunkM) return true;
    }
    return false;
  };
  for (size_t begin = 0, end = 0; begin < T; begin = end) {
    end = begin + 1;
    if (!(frames[begin].lowest_m > kClearM)) continue;
    while (goes_on(end) && frames[end].lowest_m > kClearM) ++end;
    if (begin == 0 || !goes_on(begin) || !goes_on(end)) continue;
    if (!(frames[begin - 1].lowest_m <= kClearM && frames[end].lowest_m <= kClearM)) continue;
    const auto left_out = static_cast<size_t>(std::lround(kFlightEnds * static_cast<double>(end - begin)));
    const size_t first = begin + left_out, last = end - left_out;
    const double seconds = at[last - 1] - at[first];
    const bool upright = std::all_of(frames.begin() + static_cast<std::ptrdiff_t>(first),
                                     frames.begin() + static_cast<std::ptrdiff_t>(last),
                                     [](const FlightFrame& frame) { return frame.trunk_lean <= kMaxTrunkLean; });
    const bool long_enough = last - first >= kMinFlightFrames && seconds >= kMinFlight_s;
    if (!long_enough || at[end] - at[begin] > kMaxFlight_s || !upright || sunk(begin, end)) {
      ++found.other;
      continue;
    }
    const double scale = kGravity / FallIn(frames, at, first, last);
    if (!(scale >= kMinFlightScale && scale <= kMaxFlightScale)) {
      ++found.other;
      continue;
    }
    found.flights.push_back(
        {std::log(scale), std::hypot(kFlightSigma, 8 * kCentreSigmaM / (kGravity * seconds * seconds))});
  }
  return found;
}

}  // namespace

FlightSummary StatureFromFlights(std::span<const FlightFrame> frames, std::span<const double> timestamps,
                                 const std::vector<char>& cut_before, double assumed_stature_m) {
  BODYLOOM_CHECK(frames.size() == timestamps.size() && frames.size() == cut_before.size(), frames.size(), " frames, ",
                 timestamps.size(), " timestamps, ", cut_before.size(), " cuts");
  FlightSummary summary;
  summary.assumed_m = assumed_stature_m;
  const auto [flights, other] = FindStretches(frames, timestamps, cut_before);
  if (flights.empty()) {
    summary.why = other == 0 ? "nobody leaves the ground"
                             : (other == 1 ? std::string("once") : std::to_string(other) + " times") +
                                   " off the ground, never for long enough in free fall";
    return summary;
  }
  std::vector<double> logs;
  for (const Flight& flight : flights) logs.push_back(flight.log_scale);
  double mean = Percentile(logs, 50), weights = 0, chi2 = 0;
  for (int pass = 0; pass < 20; ++pass) {
    double sum = 0;
    weights = chi2 = 0;
    for (const Flight& flight : flights) {
      const double off = (flight.log_scale - mean) / flight.sigma;
      const double weight = GemanMcClure(off * off, kFlightKernel).weight / (flight.sigma * flight.sigma);
      sum += weight * flight.log_scale;
      weights += weight;
      chi2 += weight * flight.sigma * flight.sigma * off * off;
    }
    mean = sum / weights;
  }
  const double spread = flights.size() > 1 ? std::max(1.0, chi2 / static_cast<double>(flights.size() - 1)) : 1;
  summary.flights = static_cast<int>(flights.size());
  summary.stature_m = assumed_stature_m * std::exp(mean);
  summary.sigma_m = summary.stature_m * std::sqrt(spread / weights + kCommonSigma * kCommonSigma);
  return summary;
}

FlightSummary StatureFromFlights(const SequenceProblem& problem, const Track& track, int num_threads) {
  Eigen::VectorXd by_beta;
  const auto num_betas = static_cast<int>(problem.betas.size());
  const double at_mean_m = StatureOfMeanShape(*problem.layout.model, num_betas, &by_beta);
  const double assumed_stature_m = at_mean_m + by_beta.dot(problem.betas);
  const auto none = [&](const char* why) {
    FlightSummary summary;
    summary.assumed_m = assumed_stature_m;
    summary.why = why;
    return summary;
  };
  if (problem.layout.knowledge == CameraKnowledge::kWeak) return none("weak perspective knows no distances");
  if (!problem.views.empty()) return none("there are several cameras");
  if (track.HasMovingCamera()) return none("the camera moves");
  const std::vector<FrameData>& frames = problem.frames;
  if (std::all_of(frames.begin(), frames.end(), [](const FrameData& frame) { return frame.ground == nullptr; })) {
    return none("there is no ground");
  }
  const BodyModel& model = *problem.layout.model;
  const Eigen::VectorXd mass = MassByJoint(model);
  if (mass.size() == 0) return none("the body lacks joints of the table of masses");
  const int neck = model.FindJoint("neck");
  const std::vector<ContactPoint> points = FindContactPoints(model);
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<FlightFrame> measured(frames.size(), {kUnknown, kUnknown, kUnknown});
  ParallelFor(static_cast<int>(frames.size()), num_threads, [&](int t) {
    thread_local ContactPlaces places;
    const FrameGround* ground = frames[t].ground;
    if (ground == nullptr || track.frame_status[t] != FrameStatus::kTracked) return;
    Eigen::Matrix3Xd at;
    places.Evaluate(problem, t, points, &at);
    const MatrixX3d& joints = track.joints[t];
    const Eigen::Vector3d trunk = (joints.row(neck) - joints.row(0)).transpose();
    measured[t] = {ground->up.dot(CentreOfMass(joints, mass)),
                   (ground->up.transpose() * at).minCoeff() - ground->level_m,
                   std::acos(std::clamp(ground->up.dot(trunk.normalized()), -1.0, 1.0))};
  });
  return StatureFromFlights(measured, problem.timestamps, problem.cut_before, assumed_stature_m);
}

}  // namespace bodyloom
