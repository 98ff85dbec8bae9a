// SPDX-License-Identifier: Apache-2.0
// Two people before one camera of unknown focal length.
#include "tracking/people/track_people.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tests/support/clip_input.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/stature.h"

namespace bodyloom::track_people_test {
namespace {

SynthClip Clip(uint64_t seed) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  options.seed = seed;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 40, 15), options);
}

constexpr double kCameraHeight = 1.6;

/// Of a camera that looks 12° down.
Eigen::Matrix3d CameraFromWorld() {
  const Eigen::Matrix3d level = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return RotationFromAxisAngle(Eigen::Vector3d(12 * M_PI / 180, 0, 0)) * level;
}

struct SeenPerson {
  KeypointSequence keypoints;
  double depth_m = 0;  ///< of the mid-hip, mean
};

/// The demo's person, larger as a whole by `size`, on one floor and seen by one camera with the others. Detections err
/// by 2 px.
SeenPerson OnFloor(double size, const Eigen::Vector3d& place, uint64_t seed) {
  const BodyModel& body = BuiltinBody();
  const Motion motion = DemoMotion(body, 90, 15);
  const Camera camera = MakePinhole(1280, 720, 1000);
  SeenPerson person;
  KeypointSequence& seen = person.keypoints;
  seen.names = CocoNames();
  for (const char* name :
       {"left_big_toe", "left_small_toe", "left_heel", "right_big_toe", "right_small_toe", "right_heel"}) {
    seen.names.emplace_back(name);
  }
  seen.timestamps = motion.timestamps;
  seen.image_width = camera.width;
  seen.image_height = camera.height;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 2);
  for (int t = 0; t < motion.num_frames(); ++t) {
    const BodyPose pose = PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    const MatrixX3d points = PoseLandmarks(body, Eigen::VectorXd(), pose, seen.names);
    for (int k = 0; k < points.rows(); ++k) {
      const Eigen::Vector3d in_world = size * points.row(k).transpose() + place;
      const Eigen::Vector3d in_camera = CameraFromWorld() * (in_world - Eigen::Vector3d(0, kCameraHeight, 6));
      if (seen.names[k].ends_with("_hip")) person.depth_m += in_camera.z() / (2 * motion.num_frames());
      Eigen::Vector2d pixel;
      EXPECT_TRUE(camera.Project(in_camera, &pixel));
      seen.points.push_back({float(pixel.x() + noise(random)), float(pixel.y() + noise(random)), 0.9F});
    }
  }
  return person;
}

/// Of the mid-hip, mean, metres.
double DepthOf(const Track& track) {
  double sum = 0;
  for (const MatrixX3d& points : track.coco17) sum += 0.5 * (points(11, 2) + points(12, 2));
  return sum / double(track.coco17.size());
}

double StatureOf(const Track& track) {
  Eigen::VectorXd gradient;
  return StatureOfMeanShape(BuiltinBody(), int(track.motion.betas.size()), &gradient) +
         gradient.dot(track.motion.betas);
}

TEST(TrackPeople, FeetOnOneFloorTellWhoIsTaller) {
  constexpr double kTall = 1.05, kSmall = 0.88;
  const SeenPerson tall = OnFloor(kTall, {-0.9, 0, -0.5}, 1), small = OnFloor(kSmall, {0.9, 0, 0.3}, 2);
  const SynthClip clip = Clip(1);  // for what is not of the people
  std::vector<TrackSequenceInput> inputs(2, UnknownFocalInput(clip));
  inputs[0].keypoints = &tall.keypoints;
  inputs[1].keypoints = &small.keypoints;
  for (TrackSequenceInput& input : inputs) input.camera = MakePinhole(1280, 720, 1000);
  TrackSequenceOptions options = UnknownFocalOptions();
  options.camera_knowledge = CameraKnowledge::kKnown;
  const TrackPeopleResult together = TrackPeople(inputs, options);
  const SharedScene& scene = together.summary.scene;
  ASSERT_TRUE(scene.ground.has_plane) << scene.why;
  EXPECT_NEAR(scene.size[0] / scene.size[1], kTall / kSmall, 0.04 * kTall / kSmall);
  EXPECT_LT(std::acos(std::min(1.0, scene.ground.up.dot(CameraFromWorld().col(1)))), 6 * M_PI / 180)
      << "as well as the lifter sees it";
  const Track &first = together.people[0].track, &second = together.people[1].track;
  EXPECT_NEAR(StatureOf(first) / StatureOf(second), scene.size[0] / scene.size[1], 0.01);
  EXPECT_NEAR(StatureOf(first), together.people[0].summary.stature_m, 0.01);
  // Both have the other's floor: the feet of each lie as high as the other's, on the plane.
  for (const TrackSequenceResult& person : together.people) {
    ASSERT_TRUE(person.summary.ground.has_plane) << person.summary.ground.why;
    EXPECT_NEAR(person.summary.ground.camera_height_m, scene.ground.camera_height_m, 1e-9);
    double sum = 0, seconds = 0;
    for (const StandingFoot& stance : person.summary.ground.stances) {
      sum += stance.seconds * (scene.ground.up.dot(stance.place_m) + scene.ground.camera_height_m);
      seconds += stance.seconds;
    }
    EXPECT_LT(std::abs(sum / seconds), 0.04) << "metres off the plane";
  }
  // The same with the shape kept: nobody has another size.
  options.estimate_shape = false;
  const TrackPeopleResult kept = TrackPeople(inputs, options);
  EXPECT_EQ(kept.summary.scene.size, (std::vector<double>{1, 1}));
  // A stature that is known is kept, and gives the scene its scale.
  options.estimate_shape = true;
  TrackSequenceInput mean = inputs[0];
  inputs[0].stature_m = kTall * AssumedStature(mean);
  const TrackPeopleResult known = TrackPeople(inputs, options);
  EXPECT_NEAR(StatureOf(known.people[0].track), inputs[0].stature_m, 0.01);
  EXPECT_NEAR(StatureOf(known.people[1].track), kSmall * AssumedStature(mean), 0.05 * AssumedStature(mean));
  EXPECT_NEAR(DepthOf(known.people[0].track), tall.depth_m, 0.04 * tall.depth_m);
  EXPECT_NEAR(DepthOf(known.people[1].track), small.depth_m, 0.05 * small.depth_m);
  EXPECT_GT(DepthOf(FitClip(inputs[1], options).track), 1.1 * small.depth_m) << "alone, of average stature";
}

TEST(TrackPeople, FeetAreComparedAtOneFocalLength) {
  constexpr double kTall = 1.05, kSmall = 0.88;
  const SeenPerson tall = OnFloor(kTall, {-0.9, 0, -0.5}, 1), small = OnFloor(kSmall, {0.9, 0, 0.3}, 2);
  const SynthClip clip = Clip(1);
  std::vector<TrackSequenceInput> inputs(2, UnknownFocalInput(clip));
  inputs[0].keypoints = &tall.keypoints;
  inputs[1].keypoints = &small.keypoints;
  for (TrackSequenceInput& input : inputs) input.camera.width = 1280, input.camera.height = 720;
  TrackSequenceOptions options = UnknownFocalOptions();
  int fits = 0;
  std::string stage;
  options.progress = [&](const TrackProgress& at) {
    fits += at.stage == "initialise" && stage != at.stage;
    stage = at.stage;
    return true;
  };
  const TrackPeopleResult together = TrackPeople(inputs, options);
  EXPECT_EQ(fits, 6) << "alone, with the joined focal length, and with the ground";
  const SharedScene& scene = together.summary.scene;
  ASSERT_TRUE(scene.ground.has_plane) << scene.why;
  EXPECT_NEAR(scene.size[0] / scene.size[1], kTall / kSmall, 0.06 * kTall / kSmall);
  EXPECT_GT(scene.focal_log_sigma, 0.1) << "one that was joined is not known";
  for (const TrackSequenceResult& person : together.people) {
    EXPECT_EQ(person.track.camera.fx, scene.focal_px);
    EXPECT_EQ(person.summary.focal_log_sigma, scene.focal_log_sigma);
  }
  // Without ground estimation there is nothing to compare.
  fits = 0;
  options.ground = GroundOptions::Off();
  TrackPeople(inputs, options);
  EXPECT_EQ(fits, 4);
}

TEST(TrackSequence, DistanceFollowsTheStatureThatIsGiven) {
  const SynthClip clip = Clip(3);
  TrackSequenceInput input = UnknownFocalInput(clip);
  TrackSequenceOptions options = UnknownFocalOptions();
  options.camera_knowledge = CameraKnowledge::kKnown;
  input.camera = clip.truth.camera;
  const TrackSequenceResult mean = FitClip(input, options);
  EXPECT_EQ(mean.summary.stature_m, 0);
  input.stature_m = 0.85 * AssumedStature(input);
  const TrackSequenceResult smaller = FitClip(input, options);
  EXPECT_NEAR(StatureOf(smaller.track), input.stature_m, 0.01);
  EXPECT_EQ(smaller.summary.stature_m, input.stature_m);
  const double ratio = smaller.track.motion.trans.col(2).mean() / mean.track.motion.trans.col(2).mean();
  EXPECT_NEAR(ratio, 0.85, 0.02);
  EXPECT_LT(smaller.summary.reprojection_median_px, 1.2 * mean.summary.reprojection_median_px);
  for (const double impossible : {-1.7, 0.3, 170.0, std::nan("")}) {
    input.stature_m = impossible;
    EXPECT_THROW(FitClip(input, options), std::invalid_argument) << impossible;
  }
  input.stature_m = 1.7;
  options.estimate_shape = false;
  EXPECT_THROW(FitClip(input, options), std::invalid_argument);
}

TEST(TrackPeople, OnePersonIsTrackedAsAlone) {
  const SynthClip clip = Clip(1);
  const TrackSequenceResult alone = FitClip(UnknownFocalInput(clip), UnknownFocalOptions());
  const TrackPeopleResult together = TrackPeople({UnknownFocalInput(clip)}, UnknownFocalOptions());
  ASSERT_EQ(together.people.size(), 1U);
  EXPECT_EQ(together.people[0].track.motion.poses, alone.track.motion.poses);
  EXPECT_EQ(together.people[0].track.motion.trans, alone.track.motion.trans);
  EXPECT_EQ(together.summary.fitted_again[0], 0);
  EXPECT_NEAR(together.summary.scene.focal_px, alone.summary.focal_px, 1e-9 * alone.summary.focal_px);
}

TEST(TrackPeople, HaveOneFocalLengthAndOneVertical) {
  const SynthClip a = Clip(1), b = Clip(2);
  const double f_a = FitClip(UnknownFocalInput(a), UnknownFocalOptions()).track.camera.fx;
  const double f_b = FitClip(UnknownFocalInput(b), UnknownFocalOptions()).track.camera.fx;
  ASSERT_NE(f_a, f_b);
  std::vector<double> fractions;
  TrackSequenceOptions options = UnknownFocalOptions();
  options.progress = [&](const TrackProgress& at) {
    fractions.push_back(at.fraction);
    return true;
  };
  const TrackPeopleResult together = TrackPeople({UnknownFocalInput(a), UnknownFocalInput(b)}, options);
  const double f = together.summary.scene.focal_px;
  EXPECT_EQ(together.people[0].track.camera.fx, f);
  EXPECT_EQ(together.people[1].track.camera.fx, f);
  // Between the fits' answers and what is known of cameras beforehand, and surer than that.
  const double before = StartFocalPx(a.truth.camera.width, a.truth.camera.height);
  EXPECT_GT(f, std::min({f_a, f_b, before}));
  EXPECT_LT(f, std::max({f_a, f_b, before}));
  EXPECT_GT(together.summary.scene.focal_log_sigma, 0.1);
  EXPECT_LT(together.summary.scene.focal_log_sigma, 0.25);
  ASSERT_TRUE(together.summary.scene.has_up);
  for (const TrackSequenceResult& person : together.people) {
    EXPECT_GT(person.summary.ground.up.dot(together.summary.scene.ground.up), std::cos(2 * M_PI / 180));
  }
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_LE(fractions.back(), 1);
}

TEST(TrackPeople, FocalLengthsWhoseSpreadIsNotKnownAreNotTakenForKnownOnes) {
  const SynthClip a = Clip(1), b = Clip(2);
  TrackSequenceOptions options = UnknownFocalOptions();
  options.estimate_uncertainty = false;
  const TrackPeopleResult together = TrackPeople({UnknownFocalInput(a), UnknownFocalInput(b)}, options);
  EXPECT_EQ(together.summary.scene.focal_px, 0);
  for (const TrackSequenceResult& person : together.people) {
    EXPECT_TRUE(std::isnan(person.summary.focal_log_sigma));
    EXPECT_GT(person.track.camera.fx, 0);
  }
}

/// A rectangle of the person's keypoints in every frame.
PartLabelSequence MasksOf(const SynthClip& clip) {
  PartLabelSequence masks;
  masks.timestamps = clip.keypoints.timestamps;
  masks.image_width = clip.truth.camera.width;
  masks.image_height = clip.truth.camera.height;
  const Eigen::AlignedBox2d whole(Eigen::Vector2d(1, 1),
                                  Eigen::Vector2d(masks.image_width - 2, masks.image_height - 2));
  for (int t = 0; t < clip.keypoints.num_frames(); ++t) {
    Eigen::AlignedBox2d box;
    for (int k = 0; k < clip.keypoints.num_points(); ++k) {
      const Keypoint& point = clip.keypoints.at(t, k);
      if (point.confidence > 0) box.extend(Eigen::Vector2d(point.x, point.y));
    }
    box = box.intersection(whole);
    const Eigen::Vector2i min = box.min().cast<int>(), size = box.sizes().cast<int>();
    LabelImage image{min.x(), min.y(), size.x(), size.y(), {}};
    image.labels.assign(static_cast<size_t>(size.prod()), 1);
    masks.frames.emplace_back(image);
  }
  masks.AsMask();
  return masks;
}

TEST(TrackPeople, MasksAreInEverybodysLastFit) {
  // Known camera, no vertical and ground, and one person after the other: masks alone ask for a second fit.
  SynthClip a = Clip(1), b = Clip(2);
  for (double& time : b.keypoints.timestamps) time += 100;
  const PartLabelSequence masks_a = MasksOf(a), masks_b = MasksOf(b);
  std::vector<TrackSequenceInput> people = {UnknownFocalInput(a), UnknownFocalInput(b)};
  people[0].part_labels = &masks_a;
  people[1].part_labels = &masks_b;
  for (TrackSequenceInput& person : people) {
    person.camera = a.truth.camera;
    person.lifter = nullptr;
  }
  TrackSequenceOptions options = UnknownFocalOptions();
  options.camera_knowledge = CameraKnowledge::kKnown;
  options.ground = GroundOptions::Off();
  const TrackPeopleResult result = TrackPeople(people, options);
  for (size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(result.people[i].summary.IsUsable());
    EXPECT_EQ(result.summary.fitted_again[i], 1);
    const auto& costs = result.people[i].summary.costs;
    EXPECT_TRUE(
        std::any_of(costs.begin(), costs.end(), [](const TermCost& cost) { return cost.term == "silhouette"; }));
  }
}

TEST(TrackPeople, PeopleWithMasksAloneAreFitted) {
  const SynthClip a = Clip(1), b = Clip(2);
  const PartLabelSequence masks_a = MasksOf(a), masks_b = MasksOf(b);
  std::vector<TrackSequenceInput> people = {UnknownFocalInput(a), UnknownFocalInput(b)};
  people[0].part_labels = &masks_a;
  people[1].part_labels = &masks_b;
  people[0].initialiser = &a.truth.motion;
  people[1].initialiser = &b.truth.motion;
  TrackSequenceOptions options = UnknownFocalOptions();
  options.camera_knowledge = CameraKnowledge::kKnown;
  for (TrackSequenceInput& person : people) {
    person.camera = a.truth.camera;
    person.lifter = nullptr;
    person.keypoints = nullptr;
  }
  for (const TrackSequenceResult& person : TrackPeople(people, options).people) {
    EXPECT_TRUE(person.summary.IsUsable());
  }
}

TEST(TrackPeople, StopsWhenItIsTold) {
  const SynthClip a = Clip(1), b = Clip(2);
  TrackSequenceOptions options = UnknownFocalOptions();
  options.progress = [](const TrackProgress&) { return false; };
  const TrackPeopleResult stopped = TrackPeople({UnknownFocalInput(a), UnknownFocalInput(b)}, options);
  EXPECT_EQ(stopped.people.size(), 2U);
  EXPECT_EQ(stopped.summary.fitted_again[0] + stopped.summary.fitted_again[1], 0);
}

TEST(TrackPeople, NobodyAndTwoCamerasAreRefused) {
  EXPECT_THROW(TrackPeople({}, UnknownFocalOptions()), std::invalid_argument);
  const SynthClip clip = Clip(1);
  TrackSequenceInput other = UnknownFocalInput(clip);
  ++other.camera.width;
  EXPECT_THROW(TrackPeople({UnknownFocalInput(clip), other}, UnknownFocalOptions()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::track_people_test
