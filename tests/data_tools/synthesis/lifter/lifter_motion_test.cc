// SPDX-License-Identifier: Apache-2.0
// Augmentation of the motion before projection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "data_tools/synthesis/lifter/fast_random.h"
#include "data_tools/synthesis/lifter/floor_poses.h"
#include "geometry/body/posed_body.h"
#include "tests/data_tools/synthesis/lifter/lifter_support.h"
#include "tracking/terms/joint_limits.h"

namespace bodyloom::lifter_motion_test {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3d;
using Eigen::Vector3f;

std::vector<Quaternionf> RotationsAt(const Motion& motion, int t) {
  std::vector<Quaternionf> q;
  q.reserve(kPoseJoints);
  for (int j = 0; j < kPoseJoints; ++j)
    q.push_back(TurnBy(motion.poses.block<1, 3>(t, 3 * j).transpose().cast<float>()));
  return q;
}

TEST(LifterBody, LandmarksAreThoseOfThePosedBodyWithoutCorrectives) {
  BodyModelData data = ToyBodyData();
  data.posedirs = {};
  const BodyModel plain(data);
  const LifterBody body(plain);
  Motion motion = ShortDemoMotion();
  Eigen::VectorXd betas(6);
  betas << 1, -0.5, 0.7, -1, 0.3, 0.2;
  const LifterPerson person = body.Person(betas);
  PosedPerson posed;
  for (int t = 0; t < motion.num_frames(); t += 40) {
    const Vector3d trans = motion.trans.row(t);
    const BodyPose pose = PoseFromAxisAngle(plain, motion.poses.row(t).transpose(), trans);
    const MatrixX3d expected = PoseLandmarks(plain, betas, pose, LifterPointNames());
    body.Pose(person, RotationsAt(motion, t).data(), trans.cast<float>(), &posed);
    for (int k = 0; k < kLifterPoints; ++k) {
      // Small weights ride on the main bone: millimetres.
      EXPECT_LT((posed.point[k].cast<double>() - expected.row(k).transpose()).norm(), 0.006) << LifterPointNames()[k];
    }
  }
}

TEST(LifterBody, ReferenceLengthIsThatOfTheRestPose) {
  const LifterBody body(ToyBody());
  Eigen::VectorXd tall = Eigen::VectorXd::Zero(6);
  tall[0] = 2;  // stature: 9 % longer in every direction
  const LifterPerson mean = body.Person({}), person = body.Person(tall);
  EXPECT_FLOAT_EQ(mean.size, 1);
  EXPECT_NEAR(person.size, 1.09, 1e-4);
  EXPECT_NEAR(person.reference_length, 1.09 * mean.reference_length, 1e-4);
}

TEST(LifterBody, RandomPeopleDifferAsAsked) {
  const LifterBody body(ToyBody());
  const LifterPersonSpread none{};
  EXPECT_EQ(body.RandomPerson(none, HashRandom(3, {})).local, body.Person({}).local);
  const LifterPersonSpread bones{0, 1, 0, 0, 0};
  double sum = 0, sum2 = 0;
  constexpr int kPeople = 2000;
  const std::vector<Quaternionf> straight(kPoseJoints, Quaternionf::Identity());
  PosedPerson mean, posed;
  body.Pose(body.Person({}), straight.data(), Vector3f::Zero(), &mean);
  const float thigh = (mean.joint[kLeftKnee] - mean.joint[kLeftHip]).norm();
  for (int i = 0; i < kPeople; ++i) {
    body.Pose(body.RandomPerson(bones, HashRandom(i, {})), straight.data(), Vector3f::Zero(), &posed);
    const double ratio = (posed.joint[kLeftKnee] - posed.joint[kLeftHip]).norm() / thigh - 1;
    sum += ratio;
    sum2 += ratio * ratio;
  }
  EXPECT_NEAR(sum / kPeople, 0, 0.005);
  EXPECT_NEAR(std::sqrt(sum2 / kPeople), std::hypot(0.06, 0.02), 0.004);
}

TEST(LifterBody, RejectsABodyWithoutLandmarks) {
  BodyModelData data = ToyBodyData();
  data.landmarks.pop_back();
  EXPECT_THROW(LifterBody{BodyModel(data)}, std::invalid_argument);
}

TEST(LifterClips, SamplesAtFramesAndBounces) {
  const LifterBody body(ToyBody());
  const Motion motion = ShortDemoMotion();
  const LifterClip clip = CompactClip(motion, true, body);
  EXPECT_NEAR(clip.duration_s, 359 / 60.0, 1e-6);
  PoseSequence poses;
  SampleClip(clip, 50 / 60.0, 3 / 60.0, 20, &poses);
  for (int t = 0; t < 20; ++t) {
    for (int j = 0; j < kPoseJoints; ++j) {
      EXPECT_NEAR(std::abs(poses.at(t, j).dot(RotationsAt(motion, 50 + 3 * t)[j])), 1, 1e-5);
    }
  }
  PoseSequence forth, back;
  SampleClip(clip, clip.duration_s - 0.1, 0.05, 5, &forth);  // −0.1, −0.05, end, −0.05, −0.1
  SampleClip(clip, -0.1, 0.05, 5, &back);
  for (int j = 0; j < kPoseJoints; ++j) {
    EXPECT_NEAR(std::abs(forth.at(0, j).dot(forth.at(4, j))), 1, 1e-6);
    EXPECT_NEAR(std::abs(back.at(1, j).dot(back.at(3, j))), 1, 1e-6);
  }
}

TEST(LifterClips, FasterMotionsAreResampled) {
  const Motion fast = DemoMotion(ToyBody(), 360, 120);
  const LifterClip clip = CompactClip(fast, false, LifterBody(ToyBody()));
  EXPECT_EQ(clip.rate, kLifterClipRate);
  EXPECT_NEAR(clip.poses.num_frames, 180, 1);
}

TEST(LifterClips, ClearanceIsMeasuredFromTheFloorThatTheMotionStandsOn) {
  const LifterBody body(ToyBody());
  Motion motion = ShortDemoMotion();
  const PoseSequence plain = CompactClip(motion, true, body).poses;
  motion.trans.col(1).array() += 0.3;
  const PoseSequence raised = CompactClip(motion, true, body).poses;
  std::vector<float> sorted = plain.clearance;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted[sorted.size() / 2], 0);
  for (int t = 0; t < plain.num_frames; ++t) EXPECT_NEAR(plain.clearance[t], raised.clearance[t], 1e-4);
  for (int t = 100; t < 150; ++t) motion.trans(t, 1) += 0.4;  // a jump
  const PoseSequence jumping = CompactClip(motion, true, body).poses;
  EXPECT_NEAR(jumping.clearance[120], 0.4, 0.04);
  for (const float c : CompactClip(motion, false, body).poses.clearance) EXPECT_EQ(c, 0);
}

TEST(LifterClips, MirroredPosesAreMirroredLandmarks) {
  const LifterBody body(ToyBody());
  const LifterPerson person = body.Person({});
  PoseSequence poses;
  SampleClip(CompactClip(ShortDemoMotion(), true, body), 0.3, 0.11, 40, &poses);
  PoseSequence mirrored = poses;
  MirrorPoses(&mirrored);
  PosedPerson a, b;
  const auto twin = [](int k) { return k == 0 ? 0 : k + (k % 2 == 1 ? 1 : -1); };
  for (int t = 0; t < 40; ++t) {
    body.Pose(person, &poses.at(t, 0), poses.trans[t], &a);
    body.Pose(person, &mirrored.at(t, 0), mirrored.trans[t], &b);
    for (int k = 1; k < kLifterPoints; ++k) {  // the toy body's nose lies off its plane
      const Vector3f expected(-a.point[twin(k)].x(), a.point[twin(k)].y(), a.point[twin(k)].z());
      ASSERT_LT((b.point[k] - expected).norm(), 2e-3) << LifterPointNames()[k];
    }
  }
}

TEST(PoseAugmentation, LimitsHoldAndKneesBendForward) {
  const LifterBody body(ToyBody());
  const PoseLimits limits(ToyBody());
  PoseSequence poses;
  SampleClip(CompactClip(ShortDemoMotion(), true, body), 0, 0.05, 81, &poses);
  poses.at(5, kLeftKnee) = TurnBy({-0.8F, 0, 0});
  poses.at(5, kLeftElbow + 1) = TurnBy({0, -0.9F, 0});
  LifterWindowOptions options;
  options.perturbation = 5;
  PerturbPoses(options, 1, 1, HashRandom(8, {}), &poses);
  poses.at(5, kLeftKnee) = TurnBy({-0.8F, 0, 0});
  poses.at(5, kLeftElbow + 1) = TurnBy({0, -0.9F, 0});
  limits.Apply(&poses);
  for (const JointLimits::Range& range : JointLimits::ForBody(ToyBody()).ranges) {
    if (range.joint >= kLeftWrist) continue;
    for (int t = 0; t < 81; ++t) {
      const Vector3d excess = LimitExcess(range, AxisAngleOf(poses.at(t, range.joint)).cast<double>());
      ASSERT_LT(excess.norm(), 1e-4) << "joint " << range.joint << " frame " << t;
    }
  }
  EXPECT_NEAR(AxisAngleOf(poses.at(5, kLeftKnee)).x(), 0.8, 1e-4);
  EXPECT_NEAR(AxisAngleOf(poses.at(5, kLeftElbow + 1)).y(), 0.9, 1e-4);
}

TEST(PoseAugmentation, ClipsAreChosenByTheRootOfTheirLength) {
  std::vector<LifterClip> clips(3);
  clips[0].duration_s = 1;
  clips[1].duration_s = 4;
  clips[2].duration_s = 9;
  const ClipChoice choice(clips);
  std::array<int, 3> count{};
  HashRandom random(5, {});
  for (int i = 0; i < 60000; ++i) ++count[choice(&random)];
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(count[c], 10000 * (c + 1), 500);
}

TEST(PoseAugmentation, ExchangedArmsComeFromElsewhere) {
  Motion still = ShortDemoMotion(), other = still;
  still.poses.setZero();
  other.poses.setZero();
  for (const int j : {16, 17, 18, 19}) other.poses.col(3 * j).setConstant(0.3);
  const LifterBody body(ToyBody());
  const std::vector<LifterClip> clips = {CompactClip(still, false, body), CompactClip(other, false, body)};
  LifterWindowOptions options = PlainOptions();
  options.arm_exchange = 1;
  int changed[2] = {0, 0};
  for (uint64_t seed = 0; seed < 400; ++seed) {
    PoseSequence poses;
    SampleClip(clips[0], 0, 0.05, 3, &poses);
    ExchangeLimbs(clips, ClipChoice(clips), options, 0.05, HashRandom(seed, {}), &poses);
    for (int side = 0; side < 2; ++side) changed[side] += AxisAngleOf(poses.at(1, kLeftShoulder + side)).x() > 0.2F;
    EXPECT_LT(AxisAngleOf(poses.at(1, kLeftHip)).norm(), 1e-6);
  }
  for (const int c : changed) EXPECT_NEAR(c, 200, 50);  // each arm from either clip
}

TEST(FastRandom, NormalIsNormal) {
  FastNormal normal(HashRandom(1, {}));
  double sum = 0, sum2 = 0, sum4 = 0;
  constexpr int kDraws = 200000;
  int beyond2 = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = normal();
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
    beyond2 += std::abs(x) > 2;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.01);
  EXPECT_NEAR(sum2 / kDraws, 1, 0.01);
  EXPECT_NEAR(sum4 / kDraws, 3, 0.1);
  EXPECT_NEAR(beyond2 / double(kDraws), 0.0455, 0.002);
}

TEST(FastRandom, SmoothNoiseHasUnitVarianceAndNoJumps) {
  FastNormal normal(HashRandom(2, {}));
  std::vector<float> values;
  double sum2 = 0, largest_step = 0;
  for (int round = 0; round < 400; ++round) {
    SmoothNoise(81, 10, &normal, &values);
    ASSERT_EQ(values.size(), 81U);
    for (int t = 0; t < 81; ++t) {
      sum2 += values[t] * values[t] / (400.0 * 81);
      if (t > 0) largest_step = std::max<double>(largest_step, std::abs(values[t] - values[t - 1]));
    }
  }
  EXPECT_NEAR(sum2, 1, 0.08);
  EXPECT_LT(largest_step, 0.6);
}

class FloorPoses : public ::testing::TestWithParam<int> {};

TEST_P(FloorPoses, RestLowOnSeveralPoints) {
  const LifterBody body(ToyBody());
  const LifterPerson person = body.Person({});
  int stands = 0;
  constexpr int kPeople = 60;
  for (int i = 0; i < kPeople; ++i) {
    HashRandom random(i, {77});
    const auto pose = RandomFloorPose(GetParam(), body, person, &random);
    for (const Quaternionf& q : pose) ASSERT_NEAR(q.norm(), 1, 1e-4);
    PosedPerson posed;
    body.Pose(person, pose.data(), Vector3f::Zero(), &posed);
    const float floor = body.Lowest(person, posed);
    // Upright, the pelvis stands 0.92 m high; a bear on straight legs comes near.
    const bool upside_down = std::string(FloorPoseName(GetParam())) == "upside down";
    EXPECT_LT(posed.joint[kPelvis].y() - floor, upside_down ? 1.4 : 0.84) << FloorPoseName(GetParam()) << " " << i;
    std::array<Vector3f, LifterBody::kNumBalls> bottoms;
    body.BallBottoms(person, posed, &bottoms);
    const auto near =
        std::count_if(bottoms.begin(), bottoms.end(), [&](const Vector3f& b) { return b.y() < floor + 0.05F; });
    stands += near >= 2;
  }
  EXPECT_GE(stands, kPeople * 6 / 10) << FloorPoseName(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, FloorPoses, ::testing::Range(0, NumFloorPoses()));

TEST(FloorPoses, LyingIsLyingAndTheFaceLooksTheRightWay) {
  const LifterBody body(ToyBody());
  const LifterPerson person = body.Person({});
  int checked = 0;
  for (int kind = 0; kind < NumFloorPoses(); ++kind) {
    const std::string name = FloorPoseName(kind);
    const bool back = name.starts_with("back"), belly = name.starts_with("belly");
    if (!back && !belly) continue;
    for (int i = 0; i < 50; ++i) {
      HashRandom random(i, {78});
      const auto pose = RandomFloorPose(kind, body, person, &random);
      const Vector3f front = pose[kPelvis] * Vector3f::UnitZ(), head = pose[kPelvis] * Vector3f::UnitY();
      EXPECT_GT(back ? front.y() : -front.y(), 0.7) << name;
      EXPECT_LT(std::abs(head.y()), 0.7) << name;
      ++checked;
    }
  }
  EXPECT_EQ(checked, 250);
}

/// Angle between the pelvis' axis and its own at the start, largest over the window.
float LargestTurn(const PoseSequence& poses, const Vector3f& axis) {
  float largest = 0;
  for (int t = 0; t < poses.num_frames; ++t) {
    const float cosine = (poses.at(t, kPelvis) * axis).dot(poses.at(0, kPelvis) * axis);
    largest = std::max(largest, std::acos(std::clamp(cosine, -1.0F, 1.0F)));
  }
  return largest;
}

TEST(AddTurns, SpinsKeepThePersonUprightAndTumblesTurnItOver) {
  LifterWindowOptions options = PlainOptions();
  PoseSequence standing;
  standing.num_frames = 81;
  standing.rotations.assign(size_t{81} * kPoseJoints, Quaternionf::Identity());
  int spun = 0, turned_over = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    PoseSequence spin = standing, tumble = standing;
    options.spin = 1;
    options.tumble = 0;
    AddTurns(options, HashRandom(seed, {1}), &spin);
    EXPECT_LT(LargestTurn(spin, Vector3f::UnitY()), 1e-3F);
    spun += LargestTurn(spin, Vector3f::UnitZ()) > 2;
    options.spin = 0;
    options.tumble = 1;
    AddTurns(options, HashRandom(seed, {1}), &tumble);
    turned_over += LargestTurn(tumble, Vector3f::UnitY()) > 1.2;
    for (int t = 0; t < 81; ++t) {
      for (int j = 1; j < kPoseJoints; ++j) ASSERT_EQ(tumble.at(t, j).w(), 1) << "all of the body turns, no joint";
    }
  }
  EXPECT_GT(spun, 100);
  EXPECT_GT(turned_over, 120);
  options.spin = options.tumble = 0;
  PoseSequence still = standing;
  AddTurns(options, HashRandom(1, {1}), &still);
  EXPECT_EQ(LargestTurn(still, Vector3f::UnitZ()), 0);
}

TEST(AddExercises, WhoReachesStretchesAnArmToTheFront) {
  LifterWindowOptions options = PlainOptions();
  options.reach = 1;
  PoseSequence standing;  // arms out to the sides
  standing.num_frames = 81;
  standing.rotations.assign(size_t{81} * kPoseJoints, Quaternionf::Identity());
  int both = 0, far = 0;
  constexpr int kWindows = 300;
  for (uint64_t seed = 0; seed < kWindows; ++seed) {
    PoseSequence poses = standing;
    AddExercises(options, HashRandom(seed, {2}), &poses);
    int stretched = 0;
    for (int side = 0; side < 2; ++side) {
      const Vector3f out = side == 0 ? Vector3f::UnitX() : Vector3f(-Vector3f::UnitX());
      float front = 0;
      for (int t = 0; t < 81; ++t) {
        Quaternionf trunk = Quaternionf::Identity();
        for (const int j : std::array<int, 4>{kSpine1, kSpine2, kSpine3, kLeftCollar + side})
          trunk = trunk * poses.at(t, j);
        const Vector3f upper = trunk * poses.at(t, kLeftShoulder + side) * out;
        front = std::max(front, upper.z());
        EXPECT_GT(upper.z(), -0.57F) << "the other shoulder goes back with the trunk, by 0.6 rad at most";
        EXPECT_LT(AxisAngleOf(poses.at(t, kLeftElbow + side)).norm(), 1) << "nearly straight";
      }
      far += front > 0.7F ? 1 : 0;
      stretched += AxisAngleOf(poses.at(40, kLeftShoulder + side)).norm() > 0 ? 1 : 0;
      for (const int leg : {kLeftHip, kLeftKnee, kLeftAnkle}) EXPECT_EQ(poses.at(40, leg + side).w(), 1);
    }
    both += stretched == 2 ? 1 : 0;
  }
  EXPECT_GT(far, kWindows / 2);
  EXPECT_GT(both, 0.1 * kWindows);
  EXPECT_LT(both, 0.45 * kWindows);
  options.reach = 0;
  PoseSequence still = standing;
  AddExercises(options, HashRandom(1, {2}), &still);
  for (const Quaternionf& q : still.rotations) EXPECT_EQ(q.w(), 1);
}

TEST(WorldMotion, StandsOnTheFloorWhateverThePoses) {
  const LifterBody body(ToyBody());
  LifterWindowOptions options;
  options.floor_poses = 1;
  for (uint64_t seed = 0; seed < 30; ++seed) {
    const LifterPerson person = body.RandomPerson({1.2, 1, 0.008, 0, 0}, HashRandom(seed, {}));
    PoseSequence poses;
    SampleClip(CompactClip(ShortDemoMotion(), true, body), 0.1 * seed, 0.05, 41, &poses);
    if (seed % 2 == 0) AddFloorPoses(body, person, options, HashRandom(seed, {}), &poses);
    const WorldMotion motion = PoseInWorld(body, person, poses, 20);
    for (int t = 0; t < 41; ++t) {
      float lowest = 1e9F;
      for (int k = 0; k < kLifterPoints; ++k) lowest = std::min(lowest, motion.points[t * kLifterPoints + k].y());
      ASSERT_GT(lowest, -0.02) << seed << " " << t;
      ASSERT_LT(lowest - person.size * poses.clearance[t], 0.2) << "shoulder and hip balls are up to 11 cm thick";
    }
  }
}

TEST(WorldMotion, ContactIsOfFeetThatStandAndStandStill) {
  const LifterBody body(ToyBody());
  const LifterPerson person = body.Person({});
  PoseSequence poses;
  poses.num_frames = 30;
  poses.rotations.assign(30 * kPoseJoints, Quaternionf::Identity());
  poses.trans.assign(30, Vector3f::Zero());
  poses.clearance.assign(30, 0);
  poses.has_floor = true;
  for (int t = 10; t < 20; ++t) poses.at(t, kLeftHip) = TurnBy({-1.2F, 0, 0});  // the left leg is up
  for (int t = 25; t < 30; ++t) poses.clearance[t] = 0.2F;                      // in the air
  for (const bool has_floor : {true, false}) {
    poses.has_floor = has_floor;
    const WorldMotion motion = PoseInWorld(body, person, poses, 20);
    const auto contact = [&](int t, int side) { return motion.contact[2 * t + side]; };
    for (const int t : {2, 8, 22}) EXPECT_EQ(contact(t, 0) + contact(t, 1), 2) << t;
    for (const int t : {10, 15, 19}) EXPECT_EQ(contact(t, 0), 0) << t;
    EXPECT_EQ(contact(15, 1), 1);
    if (has_floor) {
      EXPECT_EQ(contact(28, 0) + contact(28, 1), 0);
    }
  }
  for (int t = 0; t < 30; ++t) poses.trans[t].x() = 0.05F * static_cast<float>(t);  // slides at 1 m/s
  poses.has_floor = true;
  const WorldMotion sliding = PoseInWorld(body, person, poses, 20);
  for (const float c : sliding.contact) EXPECT_EQ(c, 0);
}

}  // namespace
}  // namespace bodyloom::lifter_motion_test
