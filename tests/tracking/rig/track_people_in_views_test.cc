// SPDX-License-Identifier: Apache-2.0
// Two synthetic people of known truth in two and three views, whose clocks differ.
#include "tracking/rig/track_people_in_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/hash_random.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/track_edits.h"
#include "tracking/room/picture_vertical.h"

namespace bodyloom::track_people_in_views_test {
namespace {

using testing::HasSubstr;

constexpr double kFps = 30, kOffset_s = 0.7;
constexpr int kFrames = 60;

/// Two people who move differently, 1.6 m apart.
const Motion& MotionOfPerson(int person) {
  static const std::vector<Motion> motions = [] {
    const Motion whole = DemoMotion(BuiltinBody(), 5 * kFrames, kFps);
    std::vector<Motion> made = {FramesOfMotion(whole, 0, kFrames), FramesOfMotion(whole, 2 * kFrames, 3 * kFrames)};
    for (int t = 0; t < kFrames; ++t) made[1].timestamps[t] = made[0].timestamps[t];
    made[1].trans.rowwise() += made[0].trans.row(0) - made[1].trans.row(0) + Eigen::RowVector3d(1.6, 0, 0.3);
    return made;
  }();
  return motions[static_cast<size_t>(person)];
}

/// A camera around the first person, which saw these people in this order; 3 px of white noise.
struct View {
  CameraPose camera_from_world;
  std::vector<SynthClip> clips;

  View(double yaw_deg, double offset_s, const std::vector<int>& order) {
    SynthClipOptions options;
    options.dense_per_frame = 0;
    options.detection.noise = 0;
    options.detection.swap_probability = 0;
    options.camera.yaw_deg = yaw_deg;
    options.camera.fill = 0.6;
    const SynthCamera camera = PlaceSynthCamera(BuiltinBody(), MotionOfPerson(0), options.camera);
    camera_from_world = camera.pose;
    for (const int person : order) {
      SynthClip& clip = clips.emplace_back(MakeSynthClip(BuiltinBody(), MotionOfPerson(person), camera, options));
      HashRandom random(static_cast<uint64_t>(yaw_deg + 100 * person), {3});
      for (Keypoint& point : clip.keypoints.points) {
        point.x += static_cast<float>(3 * random.Normal());
        point.y += static_cast<float>(3 * random.Normal());
      }
      for (double& time : clip.keypoints.timestamps) time += offset_s;
    }
  }
  [[nodiscard]] ObservedScene Scene() const {
    ObservedScene scene;
    for (const SynthClip& clip : clips) scene.people.push_back(&clip.keypoints);
    return scene;
  }
};

TrackPeopleInViewsResult Track(const std::vector<const View*>& views, const TrackSequenceOptions& given = {}) {
  TrackSequenceInput common;
  common.body = &BuiltinBody();
  common.prior = &BuiltinPosePrior();
  common.lifter = &BuiltinLifter();
  TrackSequenceOptions options = given;
  options.num_threads = 2;
  options.solver = SequenceSolver::kChain;
  options.estimate_uncertainty = false;
  std::vector<ObservedScene> scenes;
  for (const View* view : views) scenes.push_back(view->Scene());
  return TrackPeopleInViews(scenes, common, options);
}

const View& First() {
  static const View view(0, 0, {0, 1});
  return view;
}
const View& Second() {
  static const View view(70, kOffset_s, {1, 0});
  return view;
}

double RotationErrorDeg(const ViewSummary& found, const View& view, const View& first) {
  const CameraPose truth = Compose(view.camera_from_world, Inverse(first.camera_from_world));
  return RotationAngleBetween(found.camera_from_scene.camera_from_world_rotation, truth.camera_from_world_rotation) *
         180 / M_PI;
}

TEST(TrackPeopleInViews, EverybodyIsFoundInBothViewsAndFittedInOneWorld) {
  std::vector<double> fractions;
  TrackSequenceOptions options;
  options.progress = [&](const TrackProgress& at) {
    fractions.push_back(at.fraction);
    return true;
  };
  const TrackPeopleInViewsResult result = Track({&First(), &Second()}, options);
  ASSERT_GE(result.leader, 0) << result.left_out[1];
  EXPECT_EQ(result.left_out, std::vector<std::string>(2));
  EXPECT_EQ(result.person_in_view, (std::vector<std::vector<int>>{{0, 1}, {1, 0}}));
  EXPECT_LT(RotationErrorDeg(result.cameras[0], Second(), First()), 4);
  EXPECT_NEAR(result.cameras[0].offset_s, kOffset_s, 0.02);
  for (int i = 0; i < 2; ++i) {
    const TrackSequenceResult& person = result.people[static_cast<size_t>(i)];
    ASSERT_TRUE(person.summary.IsUsable()) << person.summary.message;
    const auto& truth = First().clips[static_cast<size_t>(i)].truth;
    EXPECT_LT(1000 * ProcrustesPositionError(person.track.joints, truth.joints).frames.mean, 25) << i;
    EXPECT_EQ(person.track.camera.fx, result.scene.focal_px);
    ASSERT_TRUE(person.track.world.has_value());
    EXPECT_EQ(person.track.world->rotation, result.people[0].track.world->rotation);
    EXPECT_EQ(person.track.world->translation, result.people[0].track.world->translation);
  }
  // They stand as far from each other as they do.
  const auto apart = [](const MatrixX3d& a, const MatrixX3d& b) { return (a.row(0) - b.row(0)).norm(); };
  const double truth = apart(First().clips[0].truth.joints[30], First().clips[1].truth.joints[30]);
  EXPECT_NEAR(apart(result.people[0].track.joints[30], result.people[1].track.joints[30]), truth, 0.15 * truth);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_LE(fractions.back(), 1);
  EXPECT_GT(fractions.back(), 0.8);
}

TEST(TrackPeopleInViews, WhoIsInTheFirstViewAloneIsFittedFromItAndAnEmptyViewIsLeftOut) {
  const View second(70, kOffset_s, {0}), empty(120, 0, {});
  const TrackPeopleInViewsResult result = Track({&First(), &second, &empty});
  EXPECT_EQ(result.leader, 0);
  EXPECT_EQ(result.person_in_view, (std::vector<std::vector<int>>{{0, 0, -1}, {1, -1, -1}}));
  EXPECT_EQ(result.left_out[1], "");
  EXPECT_THAT(result.left_out[2], HasSubstr("nobody whom the first view shows"));
  EXPECT_TRUE(result.people[1].summary.IsUsable());
  EXPECT_TRUE(result.people[1].summary.views.empty());
  EXPECT_EQ(result.people[0].summary.views.size(), 1U);
}

TEST(TrackPeopleInViews, WithoutACommonMotionNobodyIsFittedAndItSaysWhy) {
  const View first(0, 0, {0}), other(70, 0, {1});
  const TrackPeopleInViewsResult result = Track({&first, &other});
  EXPECT_EQ(result.leader, -1);
  EXPECT_FALSE(result.people[0].summary.IsUsable());
  EXPECT_FALSE(result.left_out[1].empty());
  EXPECT_EQ(result.people[0].summary.message, result.left_out[1]);
}

TEST(TrackPeopleInViews, KnownCamerasAndClocksAreUsedAsTheyAre) {
  std::vector<ObservedScene> scenes;
  for (const View* view : {&First(), &Second()}) {
    ObservedScene& scene = scenes.emplace_back(view->Scene());
    scene.camera.knowledge = CameraKnowledge::kKnown;
    scene.camera.camera = view->clips[0].truth.camera;
    scene.camera.camera_from_rig = view->camera_from_world;
    scene.camera.offset_s = view == &First() ? 0 : kOffset_s;
  }
  TrackSequenceInput common;
  common.body = &BuiltinBody();
  common.prior = &BuiltinPosePrior();
  common.lifter = &BuiltinLifter();
  TrackSequenceOptions options;
  options.solver = SequenceSolver::kChain;
  options.estimate_uncertainty = false;
  const TrackPeopleInViewsResult result = TrackPeopleInViews(scenes, common, options);
  ASSERT_GE(result.leader, 0) << result.left_out[1];
  EXPECT_EQ(result.person_in_view, (std::vector<std::vector<int>>{{0, 1}, {1, 0}}));
  EXPECT_LT(RotationErrorDeg(result.cameras[0], Second(), First()), 1e-6);
  for (size_t i = 0; i < 2; ++i) {
    const auto& truth = First().clips[i].truth;
    EXPECT_LT(1000 * ProcrustesPositionError(result.people[i].track.joints, truth.joints).frames.mean, 22) << i;
  }
}

/// A vertical as lines of a picture tell it, within a degree.
PictureVertical LinesOf(const View& view) {
  PictureVertical lines;
  lines.found = true;
  lines.up = view.clips[0].up_in_camera;
  lines.focal_px = view.clips[0].truth.camera.fx;
  lines.covariance = std::pow(M_PI / 180, 2) * (Eigen::Matrix3d::Identity() - lines.up * lines.up.transpose());
  return lines;
}

TEST(TrackPeopleInViews, LinesOfEitherPictureTellTheVertical) {
  const auto tilt_deg = [](const PictureVertical* first, const PictureVertical* second, bool known) {
    TrackSequenceInput common;
    common.body = &BuiltinBody();
    common.prior = &BuiltinPosePrior();
    common.lifter = &BuiltinLifter();
    TrackSequenceOptions options;
    options.solver = SequenceSolver::kChain;
    options.estimate_uncertainty = false;
    std::vector<ObservedScene> scenes(2);
    scenes[0].people = {&First().clips[0].keypoints};
    scenes[1].people = {&Second().clips[1].keypoints};
    scenes[0].camera.picture_vertical = first;
    scenes[1].camera.picture_vertical = second;
    for (const View* view : {&First(), &Second()}) {
      ObservedView& camera = scenes[view == &First() ? 0 : 1].camera;
      if (!known) continue;
      camera.knowledge = CameraKnowledge::kKnown;
      camera.camera = view->clips[0].truth.camera;
      camera.camera_from_rig = view->camera_from_world;
    }
    const TrackPeopleInViewsResult result = TrackPeopleInViews(scenes, common, options);
    EXPECT_GE(result.leader, 0);
    return std::acos(std::min(1.0, result.scene.ground.up.dot(First().clips[0].up_in_camera))) * 180 / M_PI;
  };
  const PictureVertical first = LinesOf(First()), second = LinesOf(Second());
  const double without = tilt_deg(nullptr, nullptr, false);
  EXPECT_GT(without, 1.5);
  EXPECT_LT(tilt_deg(&first, nullptr, false), 0.7 * without);
  EXPECT_LT(tilt_deg(&first, &second, false), 1);
  // The second picture's lines say as much as is known of the cameras.
  EXPECT_LT(tilt_deg(nullptr, &second, true), 0.7 * tilt_deg(nullptr, nullptr, true));
}

TEST(TrackPeopleInViews, ACallbackStopsIt) {
  int calls = 0;
  TrackSequenceOptions options;
  options.progress = [&](const TrackProgress&) { return ++calls < 3; };
  const TrackPeopleInViewsResult result = Track({&First(), &Second()}, options);
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(result.leader, -1);
}

TEST(TrackPeopleInViews, OneViewAndAFirstViewWithoutPeopleAreRefused) {
  TrackSequenceInput common;
  common.body = &BuiltinBody();
  EXPECT_THROW(TrackPeopleInViews({First().Scene()}, common, {}), std::invalid_argument);
  EXPECT_THROW(TrackPeopleInViews({ObservedScene(), First().Scene()}, common, {}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::track_people_in_views_test
