// SPDX-License-Identifier: Apache-2.0
// Contacts and balance of a clip with known truth: somebody who stands, jumps, hovers, stands on something, leans.
#include "tracking/terms/surface_contact/clip_contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/centre_of_mass.h"
#include "geometry/math/rotation.h"
#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/view_observations.h"
#include "tracking/problem/mass_centre.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/terms/balance/balance.h"
#include "tracking/terms/balance/clip_balance.h"
#include "tracking/terms/landmarks.h"
#include "tracking/terms/surface_contact/surface_contact.h"

namespace bodyloom::clip_contacts_test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kRate = 15;

/// The built-in body in its T-pose before a level camera, on the ground but for a lift and a turn of the whole body.
class Clip {
 public:
  Clip(int frames, const std::function<double(double)>& lift_m, double lean_rad = 0) {
    problem_.layout = FrameLayout::Make(body_, CameraKnowledge::kKnown, MakePinhole(1280, 720, 1000), {0}, 0);
    problem_.frames.resize(frames);
    problem_.states.resize(frames);
    problem_.cut_before.assign(frames, 0);
    const double sole = body_.data().v_template.col(1).minCoeff();
    ground_ = {Vector3d(0, -1, 0), -1.2};
    ground_.measured_up_sigma_rad = 0.06;
    for (int t = 0; t < frames; ++t) {
      problem_.timestamps.push_back(t / kRate);
      FrameState& state = problem_.states[t];
      state.rotations.assign(body_.num_joints(), Eigen::Matrix3d::Identity());
      state.rotations[0] = RotationFromAxisAngle(Vector3d(M_PI, 0, 0));
      state.translation = Vector3d(0, 1.2 + sole - lift_m(t / kRate), 4);
      problem_.frames[t].ground = &ground_;
      if (lean_rad == 0) continue;
      // About the soles.
      const Vector3d place = body_.RestJoints({}).row(0).transpose() + state.translation, pivot(0, 1.2, 4);
      const Eigen::Matrix3d turn = RotationFromAxisAngle(Vector3d(lean_rad, 0, 0));
      state.rotations[0] = turn * state.rotations[0];
      state.translation += turn * (place - pivot) - (place - pivot);
    }
  }

  /// `whole`: frames of the long clip of which these are a part; 0: it is no part.
  void Start(int round = 0, int whole = 0) {
    ClipContacts contacts(Input());
    contacts.Observe(&problem_);
    contacts.BeginRounds(std::vector<int>(size_t(whole)), whole > 0);
    contacts.StartRound(round, {}, &problem_);
  }
  void GiveGround(const KnownGround* ground) { input_.ground = ground; }
  void LetSlide() { options_.ground.hold_weight = 0; }
  [[nodiscard]] int NumHeld(int t) const {
    int count = 0;
    for (const auto& contact : problem_.frames[t].Get<SurfaceContactTerm>().contacts) count += contact.held_m ? 1 : 0;
    return count;
  }
  /// A landmark of one foot is seen in these frames, by the first camera or by another.
  void SeeFoot(const std::string& ankle, int begin, int end, bool by_other_camera) {
    const std::vector<int> vertex = {body_.data().faces(0, 0)};
    foot_ = CompilePoint(body_, vertex, std::vector<double>{1}, 0);
    foot_.bones[0].joint = body_.FindJoint(ankle);
    foot_.bones.resize(1);
    for (int t = begin; t < end; ++t) {
      FrameData& frame = problem_.frames[t];
      if (by_other_camera) frame.views.emplace_back();
      TermList& terms = by_other_camera ? frame.views.back().terms : frame.terms;
      terms.Get<LandmarkTerm>().seen = {{&foot_}};
    }
  }
  void StartBalance() {
    balance_ = std::make_unique<ClipBalance>(Input());
    balance_->Observe(&problem_);
    balance_->StartRound(0, {}, &problem_);
  }
  [[nodiscard]] int NumTouching(int t) const {
    int count = 0;
    for (const auto& contact : problem_.frames[t].Get<SurfaceContactTerm>().contacts) count += contact.touches ? 1 : 0;
    return count;
  }
  [[nodiscard]] const FrameData& Frame(int t) const { return problem_.frames[t]; }
  [[nodiscard]] const BodyModel& body() const { return body_; }
  SequenceProblem* problem() { return &problem_; }
  FrameGround* ground() { return &ground_; }

 private:
  ClipTermInput Input() {
    return {.input = input_,
            .options = options_,
            .layout = problem_.layout,
            .landmarks = landmarks_,
            .lifted = lifted_,
            .lifted_landmarks = lifted_landmarks_,
            .views = views_};
  }

  const BodyModel& body_ = BuiltinBody();
  TrackSequenceInput input_;
  TrackSequenceOptions options_;
  ObservedLandmarks landmarks_;
  LiftedStart lifted_;
  LiftedLandmarks lifted_landmarks_;
  std::vector<ViewObservations> views_;
  SequenceProblem problem_;
  FrameGround ground_;
  CompiledPoint foot_;
  std::unique_ptr<ClipBalance> balance_;
};

TEST(ContactPoints, AreSolesHandsSeatAndHead) {
  const BodyModel& body = BuiltinBody();
  const std::vector<ContactPoint> points = FindContactPoints(body);
  EXPECT_GT(points.size(), 60U);
  EXPECT_LT(points.size(), 200U);
  const auto& rest = body.data().v_template;
  int soles = 0;
  bool lowest = false, highest = false, left = false, back = false;
  for (const ContactPoint& point : points) {
    soles += point.sole ? 1 : 0;
    EXPECT_TRUE(!point.sole || rest(point.vertex, 1) < rest.col(1).minCoeff() + 0.0151);
    lowest |= rest(point.vertex, 1) < rest.col(1).minCoeff() + 0.006;  // a corner of the sole
    highest |= rest(point.vertex, 1) == rest.col(1).maxCoeff();
    left |= rest(point.vertex, 0) == rest.col(0).maxCoeff();
    back |= rest(point.vertex, 2) == rest.col(2).minCoeff();
  }
  EXPECT_GE(soles, 8);
  EXPECT_TRUE(lowest);
  EXPECT_TRUE(highest);
  EXPECT_TRUE(left);
  EXPECT_TRUE(back);
}

TEST(ClipContacts, SolesOfSomebodyWhoStandsTouch) {
  Clip clip(10, [](double) { return 0.0; });
  clip.Start();
  for (int t = 0; t < 10; ++t) {
    const auto& term = clip.Frame(t).Get<SurfaceContactTerm>();
    EXPECT_GE(clip.NumTouching(t), 8);
    EXPECT_GT(term.weight, 0);
    for (const auto& contact : term.contacts) {
      EXPECT_TRUE(!contact.touches || clip.body().data().v_template(contact.vertex, 1) < -0.9);
    }
  }
}

TEST(ClipContacts, AFootThatNoCameraSeesIsNotHeld) {
  for (const bool by_other : {false, true}) {
    Clip both(10, [](double) { return 0.0; });
    both.Start();
    Clip clip(10, [](double) { return 0.0; });
    clip.SeeFoot("l_ankle", 0, 10, by_other);
    clip.Start();
    EXPECT_EQ(2 * clip.NumHeld(5), both.NumHeld(5)) << by_other;
  }
}

TEST(ClipContacts, APartOfALongClipLeavesTheGroundWhereItIs) {
  Clip part(10, [](double) { return 0.03; }), whole(10, [](double) { return 0.03; });
  const double level_m = part.ground()->level_m;
  part.Start(0, 11);
  whole.Start(0, 10);
  EXPECT_EQ(part.ground()->level_m, level_m);
  EXPECT_GT(std::abs(whole.ground()->level_m - level_m), 0.01);
}

TEST(ClipContacts, RestingSolesAreHeldUnlessSwitchedOff) {
  Clip clip(10, [](double) { return 0.0; });
  clip.Start();
  EXPECT_GE(clip.NumHeld(5), 8);
  EXPECT_EQ(clip.Frame(5).Get<SurfaceContactTerm>().hold_weight, kHoldWeight);
  clip.LetSlide();
  clip.Start();
  EXPECT_EQ(clip.NumHeld(5), 0);
  EXPECT_GE(clip.NumTouching(5), 8);
}

/// A jump of 0.6 s rises by 44 cm: nothing pulls it down. The same height for as long without falling is no jump.
TEST(ClipContacts, FlightsAreLeftAloneAndHoveringIsNot) {
  const auto jump = [](double s) { return s < 0.4 || s > 1.0 ? 0.0 : RiseInFlight(s - 0.4, 1.0 - s); };
  Clip flies(21, jump);
  flies.Start();
  for (int t = 8; t <= 13; ++t) EXPECT_EQ(flies.NumTouching(t), 0) << t;
  EXPECT_GE(flies.NumTouching(0), 8);
  Clip hovers(21, [](double s) { return s < 0.4 || s > 1.0 ? 0.0 : 0.12; });
  hovers.Start();
  for (int t = 8; t <= 13; ++t) EXPECT_GT(hovers.NumTouching(t), 0) << t;
}

/// Off the ground for 0.4 s a body rises by 20 cm. One that is 7 cm up for that time does not fly, and is pulled down;
/// of three steps nobody can tell.
TEST(ClipContacts, AShortFlightFallsToo) {
  Clip hops(21, [](double s) { return s < 0.4 || s > 0.8 ? 0.0 : RiseInFlight(s - 0.4, 0.8 - s); });
  hops.Start();
  for (int t = 7; t <= 11; ++t) EXPECT_EQ(hops.NumTouching(t), 0) << t;
  const auto raised = [](double until_s) { return [=](double s) { return s < 0.41 || s > until_s ? 0.0 : 0.07; }; };
  Clip hovers(21, raised(0.79));
  hovers.Start();
  for (int t = 7; t <= 11; ++t) EXPECT_GT(hovers.NumTouching(t), 0) << t;
  Clip too_short(21, raised(0.55));
  too_short.Start();
  for (int t = 7; t <= 8; ++t) EXPECT_EQ(too_short.NumTouching(t), 0) << t;
}

TEST(ClipContacts, SomebodyHalfAMetreUpStandsOnSomethingElse) {
  Clip clip(15, [](double) { return 0.5; });
  clip.Start();
  for (int t = 0; t < 15; ++t) EXPECT_EQ(clip.NumTouching(t), 0);
}

/// Whoever slides over the ground does not stand on it.
TEST(ClipContacts, SkatersDoNotTouch) {
  Clip clip(15, [](double) { return 0.03; });
  for (int t = 0; t < 15; ++t) clip.problem()->states[t].translation.x() = 1.0 * t / kRate;
  clip.Start();
  for (int t = 0; t < 15; ++t) EXPECT_EQ(clip.NumTouching(t), 0);
}

TEST(ClipContacts, ALevelThatIsWrongMovesToTheSoles) {
  Clip clip(15, [](double) { return -0.04; });
  const double before = clip.Frame(3).ground->level_m;
  clip.Start();
  EXPECT_NEAR(clip.Frame(3).ground->level_m, before - 0.04, 1e-4);
  Clip given(15, [](double) { return -0.04; });
  KnownGround ground;
  ground.has_plane = true;
  given.GiveGround(&ground);
  given.Start();
  EXPECT_EQ(given.Frame(3).ground->level_m, before) << "a ground that is given stays";
}

/// Somebody stands at seven places, 0.5 m apart, and the vertical is stated 4° wrong: what touches the ground tells it,
/// unless it is surely known.
TEST(ClipContacts, APathTellsTheVertical) {
  const Vector3d truth(0, -1, 0), wrong = RotationFromAxisAngle(Vector3d(0, 0, 4 * M_PI / 180)) * truth;
  const auto run = [&](double sigma_rad) {
    Clip clip(70, [](double) { return 0.0; });
    for (int t = 0; t < 70; ++t) clip.problem()->states[t].translation.x() = 0.5 * (t / 10) - 1.5;
    clip.ground()->up = clip.ground()->measured_up = wrong;
    clip.ground()->measured_up_sigma_rad = sigma_rad;
    clip.ground()->level_m = wrong.dot(Vector3d(0, 1.2, 4));
    for (int round = 0; round < 3; ++round) clip.Start(round);
    return *clip.ground();
  };
  const auto off_deg = [&](const FrameGround& ground) { return 180 / M_PI * std::acos(ground.up.dot(truth)); };
  const FrameGround found = run(0.06), known = run(0.001);
  EXPECT_LT(off_deg(found), 1);
  EXPECT_LT(found.up_sigma_rad, 0.06);
  EXPECT_NEAR(found.up.dot(Vector3d(0, 1.2, 4)), found.level_m, 0.01);
  EXPECT_NEAR(off_deg(known), 4, 0.1);
  // Three independent measurements, since a track's errors last: sure in their middle, less so at the ends of the path
  // and unknown far from it.
  const double across = found.HeightVariance(Vector3d(0, 1.2, 4)), end = found.HeightVariance(Vector3d(1.5, 1.2, 4));
  EXPECT_NEAR(std::sqrt(across),
              std::hypot(kTouchSigmaM, 0.12 * 1.2 / 4.2) / std::sqrt(70 / kRate / kTouchErrorLasts_s), 0.01);
  EXPECT_GT(end, 1.5 * across);
  EXPECT_LT(end, 0.05 * 0.05);
  EXPECT_GT(found.HeightVariance(Vector3d(0, 1.2, 9)), 0.1 * 0.1);
}

/// Depth is along the ray from the camera, wherever the origin of the scene is.
TEST(ClipContacts, TheGroundIsTheSameFromACameraThatIsElsewhereInTheScene) {
  const Vector3d wrong = RotationFromAxisAngle(Vector3d(0, 0, 4 * M_PI / 180)) * Vector3d(0, -1, 0);
  const auto run = [&](const Vector3d& elsewhere) {
    Clip clip(70, [](double) { return 0.0; });
    const CameraPose camera{Eigen::Matrix3d::Identity(), -elsewhere};
    for (int t = 0; t < 70; ++t) {
      clip.problem()->frames[t].camera_from_scene = &camera;
      clip.problem()->states[t].translation += Vector3d(0.5 * (t / 10) - 1.5, 0, 0) + elsewhere;
    }
    clip.ground()->up = clip.ground()->measured_up = wrong;
    clip.ground()->level_m = wrong.dot(Vector3d(0, 1.2, 4) + elsewhere);
    for (int round = 0; round < 3; ++round) clip.Start(round);
    return *clip.ground();
  };
  const Vector3d elsewhere(3, -1, 2), place(1.5, 1.2, 4);
  const FrameGround here = run(Vector3d::Zero()), there = run(elsewhere);
  EXPECT_LT((here.up - there.up).norm(), 1e-6);
  EXPECT_NEAR(there.level_m - there.up.dot(elsewhere), here.level_m, 1e-6);
  EXPECT_NEAR(there.up_sigma_rad, here.up_sigma_rad, 1e-6);
  EXPECT_NEAR(std::sqrt(there.HeightVariance(place + elsewhere)), std::sqrt(here.HeightVariance(place)), 1e-6);
}

/// Somebody who runs touches nothing for long, but cannot be 30 cm below the ground.
TEST(ClipContacts, ARunBoundsTheGround) {
  const Vector3d truth(0, -1, 0), wrong = RotationFromAxisAngle(Vector3d(0, 0, -5 * M_PI / 180)) * truth;
  Clip clip(60, [](double) { return 0.0; });
  for (int t = 0; t < 60; ++t) clip.problem()->states[t].translation.x() = t < 20 ? 0 : 3.0 * (t - 20) / kRate;
  clip.ground()->up = clip.ground()->measured_up = wrong;
  clip.ground()->level_m = wrong.dot(Vector3d(0, 1.2, 4));
  const auto below = [&](int t) {
    const Vector3d at(clip.problem()->states[t].translation.x(), 1.2, 4);
    return clip.ground()->level_m - clip.ground()->up.dot(at);
  };
  const double before = std::max(below(0), below(59));
  EXPECT_GT(before, 0.5);
  for (int round = 0; round < 3; ++round) clip.Start(round);
  EXPECT_LT(std::max(below(0), below(59)), 0.25 * before);
}

/// A body that leans backwards by 20° as a whole has its centre of mass some 25 cm behind its heels; one that stands
/// upright needs no term.
TEST(ClipBalance, PullsTheCentreOfMassOverTheFeet) {
  Clip upright(15, [](double) { return 0.0; });
  upright.StartBalance();
  EXPECT_TRUE(upright.Frame(7).Get<BalanceTerm>().is_empty());
  const double lean = -20 * M_PI / 180;
  Clip leans(
      15, [](double) { return 0.0; }, lean);
  leans.StartBalance();
  const auto& term = leans.Frame(7).Get<BalanceTerm>();
  ASSERT_FALSE(term.is_empty());
  EXPECT_NEAR(term.weight, 1, 1e-6);
  Kinematics kinematics;
  PointEvaluator points;
  const FrameState& state = leans.problem()->states[7];
  kinematics.Set(leans.body(), {}, state.rotations, state.translation, false);
  PointEvaluator::VertexCache cache;
  cache.NewFrame(kinematics);
  const Vector3d centre = points.Evaluate(kinematics, *term.centre_of_mass, false);
  const Vector3d support = term.share * PointEvaluator::VertexPosition(kinematics, term.vertices[0], &cache) +
                           (1 - term.share) * PointEvaluator::VertexPosition(kinematics, term.vertices[1], &cache);
  const double beside = (term.horizontal * (centre - support + term.offset_m)).norm();
  EXPECT_GT(beside, 0.2);
  EXPECT_LT(beside, 0.4);
}

/// Fast motion has angular momentum, which the term leaves out.
TEST(ClipBalance, SaysNothingOfFastMotion) {
  Clip clip(
      15, [](double) { return 0.0; }, 20 * M_PI / 180);
  for (int t = 0; t < 15; ++t) clip.problem()->states[t].translation.x() = 0.2 * std::sin(2 * M_PI * t / kRate);
  clip.StartBalance();
  for (int t = 2; t < 13; ++t) {
    const double acceleration = std::abs(0.2 * 4 * M_PI * M_PI * std::sin(2 * M_PI * t / kRate));
    EXPECT_TRUE(acceleration <= 6 || clip.Frame(t).Get<BalanceTerm>().is_empty()) << t;
  }
}

using Held = std::vector<std::optional<Vector3d>>;

constexpr double kHeldRate = 30;
constexpr size_t kHeldFrames = 30;

Held HoldPath(const std::function<Vector3d(double)>& place, std::vector<char> touches = {},
              std::vector<char> begins = {}) {
  std::vector<Vector3d> path;
  std::vector<double> timestamps;
  for (size_t t = 0; t < kHeldFrames; ++t) {
    timestamps.push_back(static_cast<double>(t) / kHeldRate);
    path.push_back(place(timestamps.back()));
  }
  if (touches.empty()) touches.assign(kHeldFrames, 1);
  if (begins.empty()) begins.assign(kHeldFrames, 0);
  return HeldPlaces(path, touches, begins, timestamps);
}

int Count(const Held& held) {
  int count = 0;
  for (const auto& place : held) count += place ? 1 : 0;
  return count;
}

/// To and fro by 1 cm about a place, over whole periods: held in their mean.
TEST(HeldPlaces, APointThatStaysIsHeldAtItsMean) {
  const Held held = HoldPath([](double s) { return Vector3d(1 + 0.01 * std::sin(2 * M_PI * 5 * s), 2, 3); });
  ASSERT_EQ(Count(held), static_cast<int>(kHeldFrames));
  for (const auto& place : held) EXPECT_LT((*place - Vector3d(1, 2, 3)).norm(), 1e-12);
}

/// Also one that slides so slowly that it touches: its stretches end at their edges.
TEST(HeldPlaces, WhatSlidesIsFree) {
  for (const double speed : {0.15, 0.25, 1.0}) {
    const Held held = HoldPath([&](double s) { return Vector3d(speed * s, 0, 3); });
    // The rest after the last whole stretch may be too short to tell.
    EXPECT_LE(Count(held), static_cast<int>(kHeldFrames) / 3) << speed;
    EXPECT_FALSE(held.front()) << speed;
  }
}

/// Half a turn a second on the ball of the foot, whose heel is 20 cm behind.
TEST(HeldPlaces, AFootThatTurnsIsHeldAtItsBallAlone) {
  EXPECT_EQ(Count(HoldPath([](double) { return Vector3d(0, 0, 3); })), static_cast<int>(kHeldFrames));
  const auto heel = [](double s) { return Vector3d(0.2 * std::cos(M_PI * s), 0, 3 + 0.2 * std::sin(M_PI * s)); };
  EXPECT_EQ(Count(HoldPath(heel)), 0);
}

TEST(HeldPlaces, TouchesCutsAndTimeEndAStretch) {
  const auto still = [](double) { return Vector3d(0, 1, 3); };
  std::vector<char> touches(kHeldFrames, 0), begins(kHeldFrames, 0);
  for (size_t t = 10; t < 16; ++t) touches[t] = 1;  // 0.17 s
  EXPECT_EQ(Count(HoldPath(still, touches)), 0);
  touches[16] = touches[17] = 1;
  EXPECT_EQ(Count(HoldPath(still, touches)), 8);
  begins[13] = 1;
  EXPECT_EQ(Count(HoldPath(still, touches, begins)), 0);
  EXPECT_THROW(HoldPath(still, {1}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::clip_contacts_test
