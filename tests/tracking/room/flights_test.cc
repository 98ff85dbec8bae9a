// SPDX-License-Identifier: Apache-2.0
// Stature by jumps with known truth: falling bodies, their errors, and what is no flight.
#include "tracking/room/flights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/centre_of_mass.h"
#include "geometry/math/rotation.h"

namespace bodyloom::flights_test {
namespace {

using Eigen::Vector3d;

constexpr double kRate = 60, kStature = 1.75;

/// A body whose lowest point is `lift_m(t)` over the ground and whose centre of mass is a metre above that.
struct Clip {
  std::vector<FlightFrame> frames;
  std::vector<double> timestamps;
  std::vector<char> cuts;

  Clip(int count, const std::function<double(double)>& lift_m) : cuts(count, 0) {
    for (int t = 0; t < count; ++t) {
      timestamps.push_back(t / kRate);
      frames.push_back({1 + lift_m(t / kRate), lift_m(t / kRate), 0.1});
    }
  }
  [[nodiscard]] FlightSummary Told() const { return StatureFromFlights(frames, timestamps, cuts, kStature); }
};

/// Heights of somebody of `scale` times the assumed size, in metres of that size: a jump of `seconds` every second.
std::function<double(double)> Jumps(double scale, double seconds) {
  return [=](double t) {
    const double since = std::fmod(t, 1.0) - 0.2;
    return since < 0 || since > seconds ? 0 : RiseInFlight(since, seconds - since) / scale;
  };
}

TEST(Flights, AFallingBodyTellsItsStature) {
  for (const double scale : {0.7, 0.93, 1.0, 1.1}) {
    for (const double seconds : {0.4, 0.6}) {
      const FlightSummary told = Clip(240, Jumps(scale, seconds)).Told();
      EXPECT_EQ(told.flights, 4);
      EXPECT_NEAR(told.stature_m, scale * kStature, 1e-6) << scale << ", " << seconds;
      EXPECT_EQ(told.assumed_m, kStature);
    }
  }
  EXPECT_EQ(Clip(240, Jumps(0.95, 0.5)).Told().BriefReport(),
            "4 jumps say that the person is 1.66 m +- 0.08 m tall; 1.75 m was assumed");
}

TEST(Flights, SigmaFallsWithTheirNumberAndLength) {
  const double one = Clip(60, Jumps(1, 0.5)).Told().sigma_m, four = Clip(240, Jumps(1, 0.5)).Told().sigma_m;
  EXPECT_LT(four, 0.9 * one);
  EXPECT_GT(four, kCommonSigma * kStature);
  EXPECT_GT(Clip(60, Jumps(1, 0.36)).Told().sigma_m, 1.1 * Clip(60, Jumps(1, 0.7)).Told().sigma_m);
}

/// Errors as stated: of the clip, of the flight, and of the positions that bend its path.
TEST(Flights, StatedSigmaCovers) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  int within_one = 0, within_two = 0;
  constexpr int kClips = 600;
  for (int k = 0; k < kClips; ++k) {
    const int flights = 1 + k % 5;  // long enough that errors do not refuse them
    const double seconds = 0.45 + 0.1 * (k % 3), scale = 0.95, common = std::exp(kCommonSigma * normal(random));
    Clip clip(60 * flights, [](double) { return 0.0; });
    for (int i = 0; i < flights; ++i) {
      const double in_metres = scale * common * std::exp(kFlightSigma * normal(random));
      const double bend = kCentreSigmaM * normal(random);
      for (int t = 0; t < 60; ++t) {
        const double since = t / kRate - 0.2;
        if (since < 0 || since > seconds) continue;
        FlightFrame& frame = clip.frames[60 * i + t];
        frame.lowest_m = RiseInFlight(since, seconds - since) / in_metres;
        // The part of the flight that is fitted is where it is 6 cm up, without its ends.
        const double fitted = (1 - 2 * kFlightEnds) * std::sqrt(seconds * seconds - 8 * kClearM * in_metres / kGravity);
        const double off = 2 * (since - seconds / 2) / fitted;
        frame.centre_m = 1 + frame.lowest_m + bend * off * off;
      }
    }
    const FlightSummary told = clip.Told();
    ASSERT_GT(told.flights, 0);
    const double sigmas = std::abs(told.stature_m - scale * kStature) / told.sigma_m;
    within_one += sigmas < 1 ? 1 : 0;
    within_two += sigmas < 2 ? 1 : 0;
  }
  EXPECT_NEAR(within_one / double(kClips), 0.68, 0.06);
  EXPECT_NEAR(within_two / double(kClips), 0.95, 0.03);
}

TEST(Flights, OneThatDisagreesHardlyCounts) {
  Clip clip(300, Jumps(0.95, 0.5));
  for (int t = 60; t < 120; ++t) {
    FlightFrame& frame = clip.frames[t];
    frame.centre_m = 1 + (frame.centre_m - 1) * 0.95 / 1.2;
  }
  const FlightSummary told = clip.Told();
  EXPECT_EQ(told.flights, 5);
  EXPECT_NEAR(told.stature_m, 0.95 * kStature, 0.01 * kStature);
}

TEST(Flights, WhoeverDoesNotFallSaysNothing) {
  const FlightSummary dances = Clip(120, [](double t) { return 0.02 + 0.03 * std::sin(7 * t); }).Told();
  EXPECT_EQ(dances.flights, 0);
  EXPECT_EQ(dances.why, "nobody leaves the ground");
  EXPECT_EQ(dances.BriefReport(), "");
  // On a wire, on a box, in somebody's arms.
  const auto held_up = [](double t) { return t < 0.3 || t > 0.9 ? 0.0 : 0.2; };
  EXPECT_EQ(Clip(120, held_up).Told().flights, 0);
  EXPECT_NE(Clip(120, held_up).Told().why.find("once off the ground"), std::string::npos);
  // As on the moon: a sixth of g.
  const auto moon = [](double t) { return t < 0.2 || t > 1.1 ? 0.0 : RiseInFlight(t - 0.2, 1.1 - t) / 6; };
  EXPECT_EQ(Clip(120, moon).Told().flights, 0);
  // Longer than anybody flies.
  const auto far = [](double t) { return t < 0.2 || t > 1.6 ? 0.0 : RiseInFlight(t - 0.2, 1.6 - t); };
  EXPECT_EQ(Clip(120, far).Told().flights, 0);
}

TEST(Flights, SomersaultsCutsAndHolesSayNothing) {
  const Clip jumps(60, Jumps(1, 0.5));
  EXPECT_EQ(jumps.Told().flights, 1);
  Clip turns = jumps;
  turns.frames[26].trunk_lean = 2;
  EXPECT_EQ(turns.Told().flights, 0);
  Clip cut = jumps;
  cut.cuts[26] = 1;
  EXPECT_EQ(cut.Told().flights, 0);
  Clip hole = jumps;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  hole.frames[26] = {kNan, kNan, kNan};
  EXPECT_EQ(hole.Told().flights, 0);
  Clip begins = jumps;
  begins.frames.erase(begins.frames.begin(), begins.frames.begin() + 22);
  begins.timestamps.resize(begins.frames.size());
  begins.cuts.resize(begins.frames.size());
  EXPECT_EQ(begins.Told().flights, 0);
  begins.cuts.pop_back();
  EXPECT_THROW(begins.Told(), std::invalid_argument);
}

/// The feet stay on a bed that is a spring: somebody bounces and hardly leaves it, 15 cm about the rest.
TEST(Flights, ATrampolineIsNoGround) {
  const double rest_m = 0.15, frequency = std::sqrt(kGravity / rest_m);
  const Clip bounces(240, [=](double t) { return 0.149 * std::sin(frequency * t); });
  const FlightSummary told = bounces.Told();
  EXPECT_EQ(told.flights, 0);
  EXPECT_NE(told.why.find("times off the ground"), std::string::npos) << told.why;
}

/// The built-in body in its T-pose before a level camera: lifts in metres of its own size.
struct Jumper {
  SequenceProblem problem;
  Track track;
  FrameGround ground;

  explicit Jumper(double scale) : ground{Vector3d(0, -1, 0), -1.2} {
    const BodyModel& body = BuiltinBody();
    problem.layout = FrameLayout::Make(body, CameraKnowledge::kKnown, MakePinhole(1280, 720, 1000), {0}, 0);
    const auto lift_m = Jumps(scale, 0.5);
    const double sole = body.data().v_template.col(1).minCoeff();
    const MatrixX3d rest = body.RestJoints({});
    const Eigen::Matrix3d upright = RotationFromAxisAngle(Vector3d(M_PI, 0, 0));
    constexpr int kFrames = 180;
    problem.frames.resize(kFrames);
    problem.cut_before.assign(kFrames, 0);
    for (int t = 0; t < kFrames; ++t) {
      problem.timestamps.push_back(t / kRate);
      FrameState state;
      state.rotations.assign(body.num_joints(), Eigen::Matrix3d::Identity());
      state.rotations[0] = upright;
      state.translation = Vector3d(0, 1.2 + sole - lift_m(t / kRate), 4);
      problem.frames[t].ground = &ground;
      const Eigen::RowVector3d root = rest.row(0);
      const MatrixX3d about_root = (rest.rowwise() - root) * upright.transpose();
      track.joints.push_back(about_root.rowwise() + (root + state.translation.transpose()));
      track.frame_status.push_back(FrameStatus::kTracked);
      problem.states.push_back(state);
    }
  }
  [[nodiscard]] FlightSummary Told() const { return StatureFromFlights(problem, track, 2); }
};

TEST(Flights, OfASolution) {
  Jumper jumper(0.92);
  const FlightSummary told = jumper.Told();
  EXPECT_EQ(told.flights, 3);
  const auto heights = BuiltinBody().data().v_template.col(1);
  EXPECT_NEAR(told.stature_m, 0.92 * (heights.maxCoeff() - heights.minCoeff()), 1e-6);
  jumper.track.frame_status[24] = FrameStatus::kInterpolated;
  EXPECT_EQ(jumper.Told().flights, 2);
  for (FrameData& frame : jumper.problem.frames) frame.ground = nullptr;
  EXPECT_EQ(jumper.Told().why, "there is no ground");
  jumper.track.camera_from_scene.resize(180);
  EXPECT_EQ(jumper.Told().why, "the camera moves");
}

}  // namespace
}  // namespace bodyloom::flights_test
