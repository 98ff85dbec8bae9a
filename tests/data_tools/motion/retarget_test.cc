// SPDX-License-Identifier: Apache-2.0
/// Transfers a known SMPL motion to a different skeleton (axes, units, names, rest pose and twist), writes it as BVH,
/// reads it back and retargets it, which must reproduce the original.
#include "data_tools/motion/retarget.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>

#include "data_tools/motion/load_motion.h"
#include "data_tools/motion/motion_readers.h"
#include "data_tools/motion/smpl_rest.h"
#include "geometry/body/body_model.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/support/paths.h"

namespace bodyloom::retarget_test {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = M_PI / 180;
constexpr int kFrames = 40;

/// World rotations of SMPL's joints.
std::array<Eigen::Matrix3d, 24> WorldOf(const Eigen::VectorXd& pose) {
  std::array<Eigen::Matrix3d, 24> world;
  for (int j = 0; j < 24; ++j) {
    const Eigen::Matrix3d local = RotationFromAxisAngle(pose.segment<3>(3 * j));
    world[j] = j == 0 ? local : Eigen::Matrix3d(world[SmplParents()[j]] * local);
  }
  return world;
}

/// Random poses whose elbows and knees are hinges; hands do not twist against the forearm.
RowMatrixXd TruePoses() {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> flexion(10 * kDegree, 100 * kDegree);
  RowMatrixXd poses = RowMatrixXd::Zero(kFrames, 72);
  for (int t = 0; t < kFrames; ++t) {
    for (int j = 0; j < 22; ++j) {
      const double scale = j == 0 ? 1.0 : j == 1 || j == 2 || j == 16 || j == 17 ? 0.6 : 0.15;
      for (int c = 0; c < 3; ++c) poses(t, 3 * j + c) = scale * normal(rng);
    }
    for (const int knee : {4, 5}) poses.block<1, 3>(t, 3 * knee) = Eigen::RowVector3d(flexion(rng), 0, 0);
    poses.block<1, 3>(t, 54) = Eigen::RowVector3d(0, -flexion(rng), 0);
    poses.block<1, 3>(t, 57) = Eigen::RowVector3d(0, flexion(rng), 0);
    for (const int wrist : {20, 21}) poses.block<1, 3>(t, 3 * wrist) = Eigen::RowVector3d(0, 0, 0.3 * normal(rng));
  }
  return poses;
}

struct ForeignSkeleton {
  Eigen::VectorXd rest_pose = Eigen::VectorXd::Zero(72);  ///< SMPL pose in which all of its joint frames are level
  Eigen::Matrix3d file_from_body = Eigen::Matrix3d::Identity();
  double units_per_metre = 1;
};

/// SMPL joint number and the foreign name, parents first.
const std::vector<std::pair<int, std::string>> kNames = {
    {0, "Hips"},          {1, "LeftUpLeg"},    {4, "LeftLeg"},   {7, "LeftFoot"},       {10, "LeftToeBase"},
    {2, "RightUpLeg"},    {5, "RightLeg"},     {8, "RightFoot"}, {11, "RightToeBase"},  {3, "LowerBack"},
    {6, "Spine"},         {9, "Spine1"},       {12, "Neck"},     {15, "Head"},          {13, "LeftShoulder"},
    {16, "LeftArm"},      {18, "LeftForeArm"}, {20, "LeftHand"}, {14, "RightShoulder"}, {17, "RightArm"},
    {19, "RightForeArm"}, {21, "RightHand"}};

SkeletonMotion SeenThrough(const ForeignSkeleton& foreign, const RowMatrixXd& poses, const MatrixX3d& pelvis) {
  const MatrixX3d rest = PoseSmplJoints(foreign.rest_pose, Eigen::Vector3d::Zero());
  const std::array<Eigen::Matrix3d, 24> rest_world = WorldOf(foreign.rest_pose);
  SkeletonMotion motion;
  const auto index_of = [&](int smpl) {
    for (size_t i = 0; i < kNames.size(); ++i) {
      if (kNames[i].first == smpl) return static_cast<int>(i);
    }
    return -1;
  };
  const int J = static_cast<int>(kNames.size());
  motion.offsets = MatrixX3d::Zero(J, 3);
  for (int i = 0; i < J; ++i) {
    const int j = kNames[i].first, p = SmplParents()[j];
    motion.names.push_back(kNames[i].second);
    motion.parents.push_back(p < 0 ? -1 : index_of(p));
    if (p >= 0) {
      motion.offsets.row(i) =
          (foreign.file_from_body * (rest.row(j) - rest.row(p)).transpose() * foreign.units_per_metre).transpose();
    }
  }
  const auto T = static_cast<int>(poses.rows());
  motion.root_positions = pelvis * foreign.file_from_body.transpose() * foreign.units_per_metre;
  motion.timestamps = RegularTimestamps(T, 0.02);
  for (int t = 0; t < T; ++t) {
    const std::array<Eigen::Matrix3d, 24> world = WorldOf(poses.row(t).transpose());
    std::vector<Eigen::Matrix3d> foreign_world(J);
    for (int i = 0; i < J; ++i) {
      const int j = kNames[i].first;
      foreign_world[i] =
          foreign.file_from_body * world[j] * rest_world[j].transpose() * foreign.file_from_body.transpose();
      const int p = motion.parents[i];
      motion.rotations.push_back(p < 0 ? foreign_world[i]
                                       : Eigen::Matrix3d(foreign_world[p].transpose() * foreign_world[i]));
    }
  }
  return motion;
}

/// BVH text with a channel order of its own for every joint.
std::string AsBvh(const SkeletonMotion& motion) {
  static const int orders[3][3] = {{2, 0, 1}, {0, 1, 2}, {1, 2, 0}};
  const char axes[] = "XYZ";
  std::vector<int> order;
  std::string text = "HIERARCHY\n";
  const std::function<void(int)> append = [&](int i) {
    char line[200];
    const Eigen::RowVector3d o = motion.offsets.row(i);
    std::snprintf(line, sizeof(line), "%s %s\n{\nOFFSET %.9f %.9f %.9f\nCHANNELS %d%s", i == 0 ? "ROOT" : "JOINT",
                  motion.names[i].c_str(), o[0], o[1], o[2], i == 0 ? 6 : 3,
                  i == 0 ? " Zposition Xposition Yposition" : "");
    text += line;
    for (const int axis : orders[i % 3]) text += std::string(" ") + axes[axis] + "rotation";
    text += "\n";
    order.push_back(i);
    bool is_leaf = true;
    for (int c = i + 1; c < motion.num_joints(); ++c) {
      if (motion.parents[c] == i) append(c), is_leaf = false;
    }
    text += is_leaf ? "End Site\n{\nOFFSET 0 0 0\n}\n}\n" : "}\n";
  };
  append(0);
  text += "MOTION\nFrames: " + std::to_string(motion.num_frames()) + "\nFrame Time: 0.02\n";
  for (int t = 0; t < motion.num_frames(); ++t) {
    char number[32];
    for (const int axis : {2, 0, 1}) {
      std::snprintf(number, sizeof(number), "%.9f ", motion.root_positions(t, axis));
      text += number;
    }
    for (const int i : order) {
      const int* o = orders[i % 3];
      const Eigen::Vector3d angles =
          motion.rotations[size_t(t) * motion.num_joints() + i].eulerAngles(o[0], o[1], o[2]) / kDegree;
      for (const double angle : angles) {
        std::snprintf(number, sizeof(number), "%.9f ", angle);
        text += number;
      }
    }
    text += "\n";
  }
  return text;
}

MatrixX3d TruePelvis() {
  MatrixX3d pelvis(kFrames, 3);
  for (int t = 0; t < kFrames; ++t) pelvis.row(t) << 0.01 * t, 1 + 0.1 * std::sin(0.3 * t), -0.02 * t;
  return pelvis;
}

double WorstJointErrorDeg(const RowMatrixXd& a, const RowMatrixXd& b) {
  double worst = 0;
  for (int t = 0; t < a.rows(); ++t) {
    for (int j = 0; j < 22; ++j) {
      worst = std::max(worst, RotationAngleBetween(RotationFromAxisAngle(a.block<1, 3>(t, 3 * j).transpose()),
                                                   RotationFromAxisAngle(b.block<1, 3>(t, 3 * j).transpose())));
    }
  }
  return worst / kDegree;
}

TEST(Retarget, SameRestPoseOtherAxesAndUnits) {
  ForeignSkeleton foreign;
  foreign.file_from_body << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x forward, y left, z up
  foreign.units_per_metre = 39.37;
  const RowMatrixXd truth = TruePoses();
  const MatrixX3d pelvis = TruePelvis();
  const SkeletonMotion seen = SeenThrough(foreign, truth, pelvis);
  RetargetSummary summary;
  const Motion motion = RetargetToSmpl(BvhFromText(AsBvh(seen), "a.bvh"), "a.bvh", &summary);
  EXPECT_LT(WorstJointErrorDeg(motion.poses, truth), 0.05);
  EXPECT_LT((motion.trans - pelvis).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_NEAR(summary.metres_per_unit, 1 / 39.37, 1e-6);
  EXPECT_EQ(motion.up, Motion::Up::kY);
  EXPECT_NEAR(motion.timestamps[10], 0.2, 1e-9);
}

TEST(Retarget, ArmsDownSplayedLegsAndTwistedArms) {
  ForeignSkeleton foreign;
  foreign.units_per_metre = 17;
  const auto set = [&](int joint, const Eigen::Matrix3d& rotation) {
    foreign.rest_pose.segment<3>(3 * joint) = AxisAngleFromRotation(rotation);
  };
  for (int side = 0; side < 2; ++side) {
    const double s = side == 0 ? 1 : -1;
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), x = Eigen::Vector3d::UnitX();
    set(16 + side, RotationFromAxisAngle(-80 * kDegree * s * z) * RotationFromAxisAngle(40 * kDegree * x));
    set(20 + side, RotationFromAxisAngle(-40 * kDegree * x));  // the palm does not follow the arm's twist
    set(1 + side, RotationFromAxisAngle(15 * kDegree * s * z));
  }
  const RowMatrixXd truth = TruePoses();
  const MatrixX3d pelvis = TruePelvis();
  const SkeletonMotion seen = SeenThrough(foreign, truth, pelvis);
  RetargetSummary summary;
  const Motion motion = RetargetToSmpl(seen, "b.bvh", &summary);
  // The shortest turn of a splayed leg differs from the true one by the leg's small slant.
  EXPECT_LT(WorstJointErrorDeg(motion.poses, truth), 1.5);
  EXPECT_LT((motion.trans - pelvis).cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_NEAR(std::abs(summary.shoulder_twist_deg[0]), 40, 1);
  EXPECT_NEAR(std::abs(summary.shoulder_twist_deg[1]), 40, 1);
  // Limb directions agree exactly whatever the rest pose.
  for (int t = 0; t < kFrames; ++t) {
    const MatrixX3d a = PoseSmplJoints(motion.poses.row(t).transpose(), Eigen::Vector3d::Zero());
    const MatrixX3d b = PoseSmplJoints(truth.row(t).transpose(), Eigen::Vector3d::Zero());
    for (const auto& [from, to] : {std::pair(16, 18), {18, 20}, {1, 4}, {4, 7}, {17, 19}, {19, 21}, {2, 5}, {5, 8}}) {
      EXPECT_GT((a.row(to) - a.row(from)).normalized().dot((b.row(to) - b.row(from)).normalized()),
                std::cos(0.1 * kDegree));
    }
  }
}

TEST(Retarget, ForearmTakesHalfOfTheHandsTwist) {
  RowMatrixXd truth = TruePoses();
  for (int t = 0; t < kFrames; ++t) truth.block<1, 3>(t, 60) = Eigen::RowVector3d(0.4, 0, 0);
  const Motion motion = RetargetToSmpl(SeenThrough({}, truth, TruePelvis()), "c.bvh");
  for (int t = 0; t < kFrames; ++t) {
    EXPECT_NEAR(motion.poses(t, 60), 0.4 - 0.5 * std::sin(0.4), 1e-2);
    const std::array<Eigen::Matrix3d, 24> a = WorldOf(motion.poses.row(t).transpose()),
                                          b = WorldOf(truth.row(t).transpose());
    EXPECT_LT(RotationAngleBetween(a[20], b[20]), 1e-3) << "the hand itself does not turn";
  }
}

TEST(Retarget, SkeletonsOfOtherVocabularies) {
  SkeletonMotion seen = SeenThrough({}, TruePoses(), TruePelvis());
  const SkeletonMap map = MapSkeleton(seen, "m");
  EXPECT_EQ(seen.names[map.collar[0]], "LeftShoulder");
  EXPECT_EQ(seen.names[map.shoulder[1]], "RightArm");
  EXPECT_EQ(seen.names[map.palm[0]], "LeftHand");
  EXPECT_EQ(map.spine.size(), 3U);
  const std::vector<std::pair<std::string, std::string>> swaps[] = {{{"LeftShoulder", "LeftCollar"},
                                                                     {"LeftArm", "LeftShoulder"},
                                                                     {"LeftForeArm", "LeftElbow"},
                                                                     {"LeftHand", "LeftWrist"},
                                                                     {"LeftUpLeg", "LeftHip"},
                                                                     {"LeftLeg", "LeftKnee"},
                                                                     {"LeftFoot", "LeftAnkle"},
                                                                     {"LeftToeBase", "LeftToe"}},
                                                                    {{"LeftForeArm", "mixamorig:LeftForeArm"},
                                                                     {"LeftLeg", "Bip01 L Calf"},
                                                                     {"LeftFoot", "foot.L"},
                                                                     {"LeftHand", "l_hand"}}};
  for (const auto& swap : swaps) {
    SkeletonMotion other = seen;
    for (const auto& [from, to] : swap) other.names[seen.FindJoint(from)] = to;
    const SkeletonMap found = MapSkeleton(other, "m");
    EXPECT_EQ(found.knee, map.knee);
    EXPECT_EQ(found.ankle, map.ankle);
    EXPECT_EQ(found.elbow, map.elbow);
    EXPECT_EQ(found.shoulder, map.shoulder);
    EXPECT_EQ(found.collar, map.collar);
    EXPECT_EQ(found.wrist, map.wrist);
  }
}

TEST(Retarget, WhatIsNoPersonIsAnError) {
  const SkeletonMotion seen = SeenThrough({}, TruePoses(), TruePelvis());
  const auto error = [&](const auto& change) {
    SkeletonMotion other = seen;
    change(&other);
    return FileErrorOf("x.bvh", [&] { RetargetToSmpl(other, "x.bvh"); });
  };
  EXPECT_THAT(error([](SkeletonMotion* m) { m->names[m->FindJoint("RightLeg")] = "Tentacle"; }),
              HasSubstr("no right knee"));
  EXPECT_THAT(error([](SkeletonMotion* m) {
                m->names[m->FindJoint("Head")] = "Lamp";
                m->names[m->FindJoint("Neck")] = "Pole";
              }),
              HasSubstr("no head"));
  EXPECT_THAT(error([](SkeletonMotion* m) { m->offsets.setZero(); }), HasSubstr("leg length"));
  EXPECT_THAT(error([](SkeletonMotion* m) {
                std::swap(m->names[m->FindJoint("Hips")], m->names[m->FindJoint("LeftForeArm")]);
              }),
              HasSubstr("is the root"));
  EXPECT_THAT(
      error([](SkeletonMotion* m) { std::swap(m->names[m->FindJoint("Head")], m->names[m->FindJoint("LeftHand")]); }),
      HasSubstr("not chains"));
}

class RealMotion : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << "no recordings in " << folder_;
  }
  const std::string folder_ = SharedDir() + "/data/motion";
};

TEST_F(RealMotion, EveryClipLoadsAndMovesLikeAPerson) {
  int clips = 0, frames = 0;
  double seconds = 0;
  Eigen::Vector4i violations = Eigen::Vector4i::Zero();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    const std::string path = entry.path().string(), name = entry.path().filename().string();
    const bool is_motion = name.find(".bvh") != std::string::npos || name.find(".amc") != std::string::npos ||
                           name.ends_with(".npy") ||
                           (name.starts_with("humanoid3d_") && name.find("character") == std::string::npos);
    if (!is_motion) continue;
    const Motion motion = LoadMotion(path);
    ++clips;
    frames += motion.num_frames();
    seconds += motion.timestamps.back() - motion.timestamps.front();
    ASSERT_TRUE(motion.poses.allFinite() && motion.trans.allFinite()) << path;
    EXPECT_LT((motion.trans.bottomRows(motion.num_frames() - 1) - motion.trans.topRows(motion.num_frames() - 1))
                  .rowwise()
                  .norm()
                  .maxCoeff(),
              0.5)
        << path << ": metres between frames";
    for (int t = 0; t < motion.num_frames(); ++t) {
      violations += (HingeFlexionDeg(motion.poses.row(t).transpose()).array() < -10).cast<int>().matrix();
    }
  }
  EXPECT_GE(clips, 75);
  EXPECT_GT(seconds / 60, 12);
  RecordProperty("clips", clips);
  RecordProperty("minutes", std::to_string(seconds / 60));
  // Knees and elbows that bend the wrong way by more than 10°: fewer than one frame in a thousand.
  EXPECT_LT(violations.maxCoeff(), frames / 1000) << violations.transpose();
  std::printf(
      "%d clips, %.1f minutes, %d frames; hyper-extended (left knee, right knee, left elbow, right elbow): %d %d %d "
      "%d\n",
      clips, seconds / 60, frames, violations[0], violations[1], violations[2], violations[3]);
}

}  // namespace
}  // namespace bodyloom::retarget_test
