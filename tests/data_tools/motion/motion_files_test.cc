// SPDX-License-Identifier: Apache-2.0
/// Reading of AMASS and AIST++ motions, writing of AMASS and BVH, and operations on motions.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/zip.h"
#include "data_tools/motion/amass.h"
#include "data_tools/motion/bvh_writer.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/motion/motion_readers.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/smpl_rest.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/object_npy_bytes.h"
#include "tests/data_tools/formats/pickle_writer.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"
#include "tests/support/toy_body.h"

namespace bodyloom::motion_files_test {
namespace {

using ::testing::HasSubstr;

Motion RandomMotion(int T, Motion::Up up = Motion::Up::kY) {
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  Motion motion;
  motion.body = "smpl";
  motion.up = up;
  motion.poses = RowMatrixXd::Zero(T, 72);
  motion.trans.resize(T, 3);
  motion.betas = Eigen::Vector3d(0.5, -1, 0.25);
  for (int t = 0; t < T; ++t) {
    for (int c = 0; c < 66; ++c) motion.poses(t, c) = 0.7 * normal(rng);
    for (int c = 0; c < 3; ++c) motion.trans(t, c) = normal(rng);
    motion.timestamps.push_back(0.5 + t / 25.0);
  }
  return motion;
}

double WorstAngle(const RowMatrixXd& a, const RowMatrixXd& b) {
  double worst = 0;
  for (int t = 0; t < a.rows(); ++t) {
    for (int j = 0; 3 * j < a.cols(); ++j) {
      worst = std::max(worst, RotationAngleBetween(RotationFromAxisAngle(a.block<1, 3>(t, 3 * j).transpose()),
                                                   RotationFromAxisAngle(b.block<1, 3>(t, 3 * j).transpose())));
    }
  }
  return worst;
}

NpzArrays AmassArrays(int T, int columns, const std::string& rate_key) {
  NpzArrays arrays;
  std::vector<double> poses(size_t(T) * columns), trans(size_t(T) * 3);
  for (size_t i = 0; i < poses.size(); ++i) poses[i] = 0.001 * static_cast<double>(i);
  for (size_t i = 0; i < trans.size(); ++i) trans[i] = 0.01 * static_cast<double>(i);
  const double betas[4] = {1, 2, 3, 4};
  arrays["poses"] = NdArray::FromDoubles(poses.data(), {T, columns});
  arrays["trans"] = NdArray::FromDoubles(trans.data(), {T, 3});
  arrays["betas"] = NdArray::FromDoubles(betas, {4});
  arrays["gender"] = NdArray::FromString("female");
  arrays[rate_key] = NdArray::FromDouble(50);
  return arrays;
}

TEST(Amass, EveryFamilyAndBothSpellings) {
  for (const int columns : {72, 156, 162, 165}) {
    for (const char* key : {"mocap_framerate", "mocap_frame_rate"}) {
      const Motion motion = AmassFromNpz(AmassArrays(3, columns, key), "a.npz");
      ASSERT_EQ(motion.poses.cols(), 72);
      EXPECT_NEAR(motion.poses(2, 65), 0.001 * (2 * columns + 65), 1e-12);
      EXPECT_NEAR(motion.poses(2, 66), columns == 72 ? 0.001 * (2 * 72 + 66) : 0, 1e-12);
      EXPECT_NEAR(motion.timestamps[2], 0.04, 1e-12);
      EXPECT_EQ(motion.betas.size(), 4);
      EXPECT_EQ(motion.up, Motion::Up::kZ);
    }
  }
}

TEST(Amass, FilesThatWereWrittenAgain) {
  const Motion expected = AmassFromNpz(AmassArrays(3, 72, "mocap_framerate"), "a.npz");
  std::vector<std::string> warnings;
  const auto read = [&](const auto& change) {
    NpzArrays arrays = AmassArrays(3, 72, "fps");
    change(&arrays);
    return AmassFromNpz(arrays, "a.npz", &warnings);
  };
  const Motion by_joint = read([](NpzArrays* a) { (*a)["poses"].shape = {3, 24, 3}; });
  EXPECT_EQ(by_joint.poses, expected.poses);
  EXPECT_EQ(by_joint.timestamps, expected.timestamps) << "the rate is called fps";
  const Motion in_parts = read([](NpzArrays* a) {
    std::vector<double> root, body;
    const std::vector<double> poses = (*a)["poses"].ToDoubles();
    for (size_t t = 0; t < 3; ++t) {
      root.insert(root.end(), &poses[72 * t], &poses[72 * t] + 3);
      body.insert(body.end(), &poses[72 * t] + 3, &poses[72 * t] + 66);
    }
    a->erase("poses");
    (*a)["root_orient"] = NdArray::FromDoubles(root.data(), {3, 3});
    (*a)["pose_body"] = NdArray::FromDoubles(body.data(), {3, 63});
    EXPECT_TRUE(IsAmass(*a));
  });
  EXPECT_EQ(in_parts.poses.leftCols(66), expected.poses.leftCols(66));
  EXPECT_TRUE(in_parts.poses.rightCols(6).isZero());
  const double equal[] = {1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4}, differ[] = {1, 2, 3, 4, 1, 2, 3, 4, 4, 2, 0, 4};
  EXPECT_EQ(read([&](NpzArrays* a) { (*a)["betas"] = NdArray::FromDoubles(equal, {3, 4}); }).betas, expected.betas);
  EXPECT_EQ(read([&](NpzArrays* a) { (*a)["betas"] = NdArray::FromDoubles(equal, {1, 4}); }).betas, expected.betas);
  EXPECT_TRUE(warnings.empty());
  EXPECT_TRUE(read([&](NpzArrays* a) {
                (*a)["betas"] = NdArray::FromDoubles(differ, {3, 4});
              }).betas.isApprox(Eigen::Vector4d(2, 2, 2, 4), 1e-12));
  EXPECT_THAT(warnings,
              ::testing::ElementsAre(HasSubstr("a.npz: betas: a shape for each of 3 frames, of which the mean")));
  EXPECT_THAT(FileErrorOf("a.npz", [&] { read([](NpzArrays* a) {
                                           (*a)["poses"].shape = {3, 36, 2};
                                         }); }),
              HasSubstr("poses: shape 3x36x2"));
  EXPECT_THAT(
      FileErrorOf("a.npz", [&] { read([&](NpzArrays* a) {
                                   (*a)["betas"] = NdArray::FromDoubles(equal, {2, 4});
                                 }); }),
      HasSubstr("betas: shape 2x4"));
}

TEST(Amass, ObjectsThatHoldTheRateOrTheGender) {
  NpzArrays arrays = AmassArrays(3, 72, "x");
  std::vector<ZipMember> members = {{"mocap_framerate.npy", ObjectNpyBytes(pickle_writer::Int(120))},
                                    {"gender.npy", ObjectNpyBytes(pickle_writer::Unicode("female"))}};
  for (const char* name : {"poses", "trans", "betas"}) {
    members.push_back({std::string(name) + ".npy", NpyBytes(arrays.at(name))});
  }
  EXPECT_NEAR(MotionFromBytes(MakeZip(members), "a.npz").timestamps[2], 2 / 120.0, 1e-12);
}

TEST(Amass, MalformedArrays) {
  const auto error = [](const auto& change) {
    NpzArrays arrays = AmassArrays(3, 156, "mocap_framerate");
    change(&arrays);
    return FileErrorOf("a.npz", [&] { AmassFromNpz(arrays, "a.npz"); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error([](NpzArrays* a) { (*a)["poses"] = AmassArrays(3, 63, "x")["poses"]; }), HasSubstr("shape 3x63"));
  EXPECT_THAT(error([](NpzArrays* a) { (*a)["poses"] = AmassArrays(4, 156, "x")["poses"]; }),
              HasSubstr("trans: shape 3x3, expected 4x3"));
  EXPECT_THAT(error([](NpzArrays* a) { (*a)["poses"] = AmassArrays(0, 156, "x")["poses"]; }), HasSubstr("no frames"));
  EXPECT_THAT(error([](NpzArrays* a) { (*a)["poses"] = NdArray::FromString("x"); }), HasSubstr("poses"));
  EXPECT_THAT(error([&](NpzArrays* a) {
                std::vector<double> trans(9, 0);
                trans[5] = nan;
                (*a)["trans"] = NdArray::FromDoubles(trans.data(), {3, 3});
              }),
              HasSubstr("trans: frame 1 is not finite"));
  EXPECT_THAT(error([](NpzArrays* a) { a->erase("mocap_framerate"); }), HasSubstr("neither 'mocap_framerate'"));
  EXPECT_THAT(error([&](NpzArrays* a) { (*a)["mocap_framerate"] = NdArray::FromDouble(-1); }),
              HasSubstr("frames a second"));
  EXPECT_THAT(error([](NpzArrays* a) { (*a)["betas"] = AmassArrays(4, 10, "x")["poses"]; }),
              HasSubstr("one shape for the clip"));
  EXPECT_THAT(error([](NpzArrays* a) { a->erase("trans"); }), HasSubstr("trans"));
  EXPECT_THAT(error([](NpzArrays* a) { (*a)["up_axis"] = NdArray::FromString("w"); }), HasSubstr("up_axis"));
}

TEST(Amass, WrittenAndReadBack) {
  const TemporaryFolder folder;
  const std::string path = folder.File("m.npz");
  const Eigen::Vector3d pelvis(0, -0.2, 0.02);
  for (const Motion::Up up : {Motion::Up::kY, Motion::Up::kZ, Motion::Up::kCamera}) {
    const Motion motion = RandomMotion(7, up);
    WriteAmass(path, motion, pelvis);
    const Motion read = LoadMotion(path);
    EXPECT_EQ(read.up, Motion::Up::kZ);
    EXPECT_EQ(read.timestamps, motion.timestamps);
    EXPECT_TRUE(read.betas.isApprox(motion.betas));
    const Motion expected = ChangeUp(motion, Motion::Up::kZ, pelvis);
    EXPECT_LT(WorstAngle(read.poses, expected.poses), 1e-12);
    EXPECT_TRUE(read.trans.isApprox(expected.trans, 1e-12));
  }
  EXPECT_NEAR(ReadNpz(path).at("mocap_framerate").ToDoubles()[0], 25, 1e-9);
  Motion broken = RandomMotion(3);
  broken.poses(1, 1) = NAN;
  EXPECT_THROW(WriteAmass(path, broken, pelvis), std::invalid_argument);
  EXPECT_THAT(FileErrorOf("/nowhere/m.npz", [&] { WriteAmass("/nowhere/m.npz", RandomMotion(3), pelvis); }),
              HasSubstr("cannot"));
}

TEST(Amass, ShapeOfAnotherBodyIsNotWrittenAsSmpls) {
  const TemporaryFolder folder;
  const std::string path = folder.File("m.npz");
  const Eigen::Vector3d pelvis(0.01, 0.3, -0.02);
  Motion motion = RandomMotion(4, Motion::Up::kZ);
  for (const bool smplx : {false, true}) {
    motion.body = "bodyloom";
    smplx ? WriteAmassSmplx(path, motion, pelvis) : WriteAmass(path, motion, pelvis);
    const NpzArrays arrays = ReadNpz(path);
    EXPECT_EQ(arrays.at("betas").ToDoubles(), std::vector<double>(16, 0.0));
    EXPECT_EQ(arrays.at("source_body").ToStrings().front(), "bodyloom");
    EXPECT_EQ(arrays.at("source_betas").ToMatrix(), motion.betas);
    const Motion read = LoadMotion(path);
    for (int t = 0; t < 4; ++t) {  // the place of the pelvis
      const Eigen::RowVector3d expected = motion.trans.row(t) + pelvis.transpose();
      EXPECT_TRUE((read.trans.row(t) + MeanPelvis(smplx ? "smplx" : "smpl").transpose()).isApprox(expected, 1e-12));
    }
  }
  motion.body = "smplh";
  WriteAmass(path, motion, pelvis);
  EXPECT_EQ(ReadNpz(path).count("source_body"), 0U);
  EXPECT_TRUE(LoadMotion(path).betas.isApprox(motion.betas));
}

TEST(Amass, FingersAreInTheirColumns) {
  const TemporaryFolder folder;
  const std::string path = folder.File("m.npz");
  Motion motion = RandomMotion(3, Motion::Up::kZ);
  const RowMatrixXd hands = 0.4 * RowMatrixXd::Random(3, 90), body = motion.poses.leftCols(66);
  for (const int middle : {0, 9}) {  // SMPL-H, or SMPL-X with jaw and eyes
    motion.poses.resize(3, 66 + middle + 90);
    motion.poses << body, RowMatrixXd::Constant(3, middle, 0.1), hands;
    motion.body = middle == 0 ? "bodyloom_hands" : "smplx";
    WriteAmass(path, motion, Eigen::Vector3d::Zero());
    const RowMatrixXd poses = ReadNpz(path).at("poses").ToMatrix();
    ASSERT_EQ(poses.cols(), 156);
    EXPECT_EQ(poses.rightCols(90), hands);
    EXPECT_LT((poses.leftCols(66) - body).norm(), 1e-12);
    WriteAmassSmplx(path, motion, Eigen::Vector3d::Zero());
    const NpzArrays arrays = ReadNpz(path);
    EXPECT_EQ(arrays.at("poses").ToMatrix().rightCols(90), hands);
    EXPECT_EQ(arrays.at("pose_hand").ToMatrix(), hands);
    EXPECT_EQ(arrays.at("pose_jaw").ToMatrix(), RowMatrixXd::Constant(3, 3, middle == 0 ? 0 : 0.1));
  }
  motion.poses.conservativeResize(3, 90);
  EXPECT_THROW(WriteAmass(path, motion, Eigen::Vector3d::Zero()), std::invalid_argument);
}

std::string AistPickle(const std::vector<double>& poses, const std::vector<int>& shape, double scaling) {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  return Pickle(2, Dict({{Str2("smpl_poses"), Doubles2(poses, shape)},
                         {Str2("smpl_scaling"), Doubles2({scaling}, {1})},
                         {Str2("smpl_trans"), Doubles2({90, 180, 0, 0, 0, 45}, {2, 3})}}));
}

TEST(AistMotion, BothShapesAndErrors) {
  std::vector<double> poses(144);
  for (size_t i = 0; i < poses.size(); ++i) poses[i] = 0.01 * static_cast<double>(i);
  const TemporaryFolder folder;
  for (const std::vector<int>& shape : {std::vector<int>{2, 72}, {2, 24, 3}}) {
    WriteFileAtomically(folder.File("a.pkl"), AistPickle(poses, shape, 90));
    const Motion motion = LoadMotion(folder.File("a.pkl"));
    EXPECT_NEAR(motion.poses(1, 71), 1.43, 1e-12);
    EXPECT_TRUE(motion.trans.row(0).isApprox(Eigen::RowVector3d(1, 2, 0))) << "metres of the body";
    EXPECT_NEAR(motion.timestamps[1], 1 / 60.0, 1e-12);
    EXPECT_EQ(motion.up, Motion::Up::kY);
  }
  const auto error = [](const std::string& bytes) {
    return FileErrorOf("a.pkl", [&] { AistMotionFromPickle(*ReadPickle(bytes, "a.pkl"), "a.pkl"); });
  };
  EXPECT_THAT(error(AistPickle(poses, {4, 36}, 90)), HasSubstr("smpl_poses: shape 4x36"));
  EXPECT_THAT(error(AistPickle(std::vector<double>(72), {1, 72}, 90)),
              HasSubstr("smpl_trans: shape 2x3, expected 1x3"));
  EXPECT_THAT(error(AistPickle(poses, {2, 72}, 0)), HasSubstr("smpl_scaling"));
  EXPECT_THAT(error(AistPickle(poses, {2, 72}, NAN)), HasSubstr("smpl_scaling"));
  poses[5] = INFINITY;
  EXPECT_THAT(error(AistPickle(poses, {2, 72}, 90)), HasSubstr("not finite"));
}

TEST(AistMotion, RealFilesAgreeWithTheirKeypoints) {
  const std::string folder = SharedDir() + "/data/aistpp/motions";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings in " << folder;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const Motion motion = LoadMotion(entry.path().string());
    EXPECT_EQ(motion.num_frames(), 576);
    EXPECT_NEAR(motion.trans.col(1).mean(), 1.8, 0.25) << "metres; the pelvis lies 0.22 m below SMPL's origin";
  }
}

TEST(Bvh, WrittenAndReadBack) {
  const BodyModel& body = ToyBody();
  for (const Motion::Up up : {Motion::Up::kY, Motion::Up::kZ, Motion::Up::kCamera}) {
    Motion motion = RandomMotion(5, up);
    // The edge of the Euler angles: x at ±90°.
    motion.poses.block<1, 3>(2, 6) = Eigen::RowVector3d(M_PI / 2, 0, 0);
    motion.poses.block<1, 3>(3, 6) =
        AxisAngleFromRotation(RotationFromAxisAngle({0, 0, 0.4}) * RotationFromAxisAngle({-M_PI / 2, 0, 0}))
            .transpose();
    const SkeletonMotion read = BvhFromText(BvhText(motion, body), "w.bvh");
    const Motion y_up = ChangeUp(motion, Motion::Up::kY, body.RestJoints(motion.betas).row(0).transpose());
    ASSERT_EQ(read.num_frames(), 5);
    EXPECT_NEAR(read.timestamps[1], 0.04, 1e-9);
    for (int t = 0; t < 5; ++t) {
      const PosedSkeleton expected =
          PoseSkeleton(body, body.RestJoints(motion.betas),
                       PoseFromAxisAngle(body, y_up.poses.row(t).transpose(), y_up.trans.row(t).transpose()));
      const SkeletonFrame frame = PoseSkeletonFrame(read, t);
      for (int j = 0; j < 24; ++j) {
        const int i = read.FindJoint(body.data().joint_names[j]);
        ASSERT_GE(i, 0);
        EXPECT_LT((frame.positions.row(i) / 100 - expected.joints.row(j)).norm(), 1e-6);
        EXPECT_LT(RotationAngleBetween(frame.rotations[i], expected.world_rotations[j]), 1e-6);
      }
    }
    const Motion copied = RetargetToSmpl(read, "w.bvh");
    EXPECT_LT(WorstAngle(copied.poses, y_up.poses), 1e-6) << "SMPL's own names are copied";
  }
}

TEST(Bvh, WhatCannotBeWritten) {
  Motion gap = RandomMotion(5);
  gap.timestamps[4] += 1;
  EXPECT_THROW(BvhText(gap, ToyBody()), std::invalid_argument);
  Motion nan = RandomMotion(5);
  nan.trans(0, 0) = NAN;
  EXPECT_THROW(BvhText(nan, ToyBody()), std::invalid_argument);
  EXPECT_NO_THROW(BvhText(RandomMotion(1), ToyBody()));
  FileErrorOf("/nowhere/a.bvh", [] { WriteBvh("/nowhere/a.bvh", RandomMotion(2), ToyBody()); });
}

TEST(MotionTools, ChangeUpTurnsTheBodyAsAWhole) {
  const BodyModel& body = ToyBody();
  const MatrixX3d rest = body.RestJoints(Eigen::VectorXd());
  for (const Motion::Up from : {Motion::Up::kY, Motion::Up::kZ, Motion::Up::kCamera}) {
    const Motion motion = RandomMotion(3, from), turned = ChangeUp(motion, Motion::Up::kZ, rest.row(0).transpose());
    for (int t = 0; t < 3; ++t) {
      const auto joints = [&](const Motion& m) {
        return PoseSkeleton(body, rest, PoseFromAxisAngle(body, m.poses.row(t).transpose(), m.trans.row(t).transpose()))
            .joints;
      };
      const MatrixX3d a = joints(motion), b = joints(turned);
      const Eigen::VectorXd height = (from == Motion::Up::kCamera ? -1.0 : 1.0) * a.col(from == Motion::Up::kZ ? 2 : 1);
      EXPECT_LT((height - b.col(2)).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_NEAR((a.row(3) - a.row(20)).norm(), (b.row(3) - b.row(20)).norm(), 1e-9);
    }
  }
  EXPECT_THROW(ChangeUp(RandomMotion(1), Motion::Up::kCamera, Eigen::Vector3d::Zero()), std::invalid_argument);
}

TEST(MotionTools, ResamplingKeepsWhatLiesOnTheGrid) {
  const Motion motion = RandomMotion(6);
  const Motion twice = ResampleMotion(motion, 50);
  ASSERT_EQ(twice.num_frames(), 11);
  for (int t = 0; t < 6; ++t) {
    EXPECT_LT(WorstAngle(twice.poses.row(2 * t), motion.poses.row(t)), 1e-9);
    EXPECT_TRUE(twice.trans.row(2 * t).isApprox(motion.trans.row(t), 1e-9));
  }
  EXPECT_TRUE(twice.trans.row(1).isApprox(0.5 * (motion.trans.row(0) + motion.trans.row(1)), 1e-9));
  EXPECT_NEAR(FrameRate(twice), 50, 1e-9);
  EXPECT_THROW(ResampleMotion(motion, 0), std::invalid_argument);
  Motion gap = motion;
  gap.timestamps[5] += 0.5;
  EXPECT_EQ(FrameRate(gap), 0);
}

TEST(MotionTools, TakesEveryFewFrames) {
  const Motion motion = RandomMotion(9);
  const Motion taken = TakeFrames(motion, 2, 3, 2);
  ASSERT_EQ(taken.num_frames(), 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(taken.poses.row(i), motion.poses.row(2 + 2 * i));
    EXPECT_EQ(taken.trans.row(i), motion.trans.row(2 + 2 * i));
    EXPECT_EQ(taken.timestamps[i], motion.timestamps[2 + 2 * i]);
  }
  EXPECT_THROW(TakeFrames(motion, 2, 5, 2), std::invalid_argument);
  EXPECT_THROW(TakeFrames(motion, -1, 2), std::invalid_argument);
}

TEST(MotionTools, JoinedMotionsStandOnOnePlaceAndAreApartInTime) {
  const Motion a = RandomMotion(6);
  Motion b = RandomMotion(11);
  b.trans.rowwise() += Eigen::RowVector3d(5, 2, -7);
  const Motion joined = JoinMotions({a, b}, 1.5);
  ASSERT_EQ(joined.num_frames(), 17);
  EXPECT_EQ(joined.poses.bottomRows(11), b.poses);
  EXPECT_NEAR(joined.timestamps[6] - joined.timestamps[5], 1.5, 1e-12);
  EXPECT_NEAR(joined.timestamps[16] - joined.timestamps[6], b.timestamps[10] - b.timestamps[0], 1e-12);
  // Every motion is moved as a whole: its own steps stay.
  EXPECT_LT((joined.trans.row(9) - joined.trans.row(7) - b.trans.row(3) + b.trans.row(1)).norm(), 1e-12);
  EXPECT_NEAR(joined.trans.bottomRows(11).col(0).mean(), 0, 1e-12);
  EXPECT_NEAR(joined.trans.bottomRows(11).col(2).mean(), 0, 1e-12);
  EXPECT_EQ(joined.trans.topRows(6).col(1), a.trans.col(1));
  const auto high = [](Eigen::VectorXd y) {
    std::sort(y.begin(), y.end());
    return y[static_cast<Eigen::Index>(0.8 * (y.size() - 1))];
  };
  EXPECT_NEAR(high(joined.trans.bottomRows(11).col(1)), high(a.trans.col(1)), 1e-12);
  EXPECT_THROW(JoinMotions({}, 1), std::invalid_argument);
  EXPECT_THROW(JoinMotions({a, RandomMotion(4, Motion::Up::kZ)}, 1), std::invalid_argument);
  EXPECT_THROW(JoinMotions({a, b}, 0), std::invalid_argument);
}

TEST(SmplRest, HingesBendTheNaturalWay) {
  Eigen::VectorXd pose = Eigen::VectorXd::Zero(72);
  pose[12] = 0.5;    // left knee about x
  pose[15] = -0.25;  // right knee, hyper-extended
  pose[55] = -1;     // left elbow about −y
  pose[58] = 1.5;    // right elbow about y
  const Eigen::Vector4d flexion = HingeFlexionDeg(pose) * M_PI / 180;
  EXPECT_NEAR(flexion[0], 0.5, 1e-9);
  EXPECT_NEAR(flexion[1], -0.25, 1e-9);
  EXPECT_NEAR(flexion[2], 1, 1e-9);
  EXPECT_NEAR(flexion[3], 1.5, 1e-9);
  const MatrixX3d joints = PoseSmplJoints(pose, {0, 1, 0});
  EXPECT_GT(joints(20, 2), joints(18, 2)) << "the left hand comes forward";
  EXPECT_LT(joints(7, 2), joints(4, 2)) << "the left foot goes back";
  EXPECT_EQ(joints(0, 1), 1);
}

}  // namespace
}  // namespace bodyloom::motion_files_test
