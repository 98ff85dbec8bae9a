// SPDX-License-Identifier: Apache-2.0
/// Promises of assets/body/RECIPE.md, section 9: the built-in body's finger joints, weights and correctives.
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "data_tools/body_making/finger_joints.h"

#include "data_tools/body/body_io.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/body_making/make_builtin_body.h"
#include "data_tools/motion/text_scanner.h"
#include "geometry/body/hand_skeleton.h"
#include "geometry/body/skinning.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/body_making/recipe_support.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"

namespace bodyloom::finger_joints_test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

const BodyModel& Hands() { return BuiltinBodyWithHands(); }

HandSkeleton Left() { return *FindHand(Hands(), HandSide::kLeft); }

Vector3d JointOf(const std::string& name, const Eigen::VectorXd& betas = {}) {
  return Hands().RestJoints(betas).row(Hands().FindJoint(name)).transpose();
}

BodyPose Resting() {
  return {std::vector<Eigen::Matrix3d>(static_cast<size_t>(Hands().num_joints()), Eigen::Matrix3d::Identity()),
          Vector3d::Zero()};
}

/// Turns the left joint of that name about one of its axes.
void Turn(const std::string& name, int axis, double degrees, BodyPose* pose) {
  const HandSkeleton hand = Left();
  for (int i = 0; i < kHandJoints; ++i) {
    if (HandJointNames(HandSide::kLeft)[i] != name) continue;
    Eigen::Matrix3d& R = pose->rotations[hand.joint[i]];
    R = R * RotationFromAxisAngle(kDegree * degrees * hand.axes[i].col(axis));
  }
}

const BodyModel& WithoutFingerCorrectives() {
  static const BodyModel body = [] {
    BodyModelData data = Hands().data();
    data.posedirs = {};
    return BodyModel(std::move(data));
  }();
  return body;
}

Eigen::VectorXd RandomValues(int n, double spread, std::mt19937* random) {
  std::normal_distribution<double> normal(0, spread);
  Eigen::VectorXd values(n);
  for (int i = 0; i < n; ++i) values[i] = normal(*random);
  return values;
}

TEST(FingerJoints, SmplhTree) {
  ASSERT_EQ(Hands().num_joints(), 52);
  EXPECT_EQ(Hands().name(), "bodyloom_hands");
  const std::vector<std::string> expected = {"l_index1",  "l_index2", "l_index3", "l_middle1", "l_middle2",
                                             "l_middle3", "l_pinky1", "l_pinky2", "l_pinky3",  "l_ring1",
                                             "l_ring2",   "l_ring3",  "l_thumb1", "l_thumb2",  "l_thumb3"};
  for (int j = 0; j < 22; ++j) {
    EXPECT_EQ(Hands().data().joint_names[j], SmplJointNames()[j]);
    EXPECT_EQ(Hands().parents()[j], SmplParents()[j]);
    EXPECT_LT((Hands().joint_template().row(j) - BuiltinBody().joint_template().row(j)).norm(), 1e-15);
  }
  for (int i = 0; i < 15; ++i) {
    EXPECT_EQ(Hands().data().joint_names[22 + i], expected[i]);
    EXPECT_EQ(Hands().data().joint_names[37 + i], "r" + expected[i].substr(1));
    EXPECT_EQ(Hands().parents()[22 + i], i % 3 == 0 ? 20 : 21 + i);
    EXPECT_EQ(Hands().parents()[37 + i], i % 3 == 0 ? 21 : 36 + i);
    const Eigen::RowVector3d mirrored = Hands().joint_template().row(37 + i).cwiseProduct(Eigen::RowVector3d(-1, 1, 1));
    EXPECT_LT((Hands().joint_template().row(22 + i) - mirrored).norm(), 1e-12) << expected[i];
  }
}

TEST(FingerJoints, BonesHaveMeasuredProportions) {
  // Buryanov and Kotiuk 2010: middle phalanx and last one with soft tissue, by the first.
  const std::vector<std::tuple<std::string, double, double>> rows = {{"index", 22.38 / 39.78, 19.66 / 39.78},
                                                                     {"middle", 26.33 / 44.63, 21.35 / 44.63},
                                                                     {"pinky", 18.11 / 32.74, 19.69 / 32.74},
                                                                     {"ring", 25.65 / 41.37, 21.25 / 41.37},
                                                                     {"thumb", 31.57 / 46.22, 27.34 / 46.22}};
  for (const auto& [finger, second, third] : rows) {
    const std::string name = "l_" + finger;
    const int tip = Hands().FindLandmark("left_" + finger + "_tip");
    ASSERT_GE(tip, 0);
    const Vector3d end = Hands().data().v_template.row(Hands().data().landmarks[tip].vertices[0]);
    const double one = (JointOf(name + "2") - JointOf(name + "1")).norm();
    EXPECT_NEAR((JointOf(name + "3") - JointOf(name + "2")).norm() / one, second, 0.06) << finger;
    EXPECT_NEAR((end - JointOf(name + "3")).norm() / one, third, 0.06) << finger;
  }
  // From wrist to the tip of the middle finger: 0.108 of the stature (Drillis and Contini 1966), ours 0.113.
  const Vector3d middle =
      Hands().data().v_template.row(Hands().data().landmarks[Hands().FindLandmark("left_middle_tip")].vertices[0]);
  EXPECT_NEAR((middle - JointOf("l_wrist")).norm() / 1.712, 0.113, 0.002);
}

TEST(FingerJoints, MoveWithTheShape) {
  for (int component = 0; component < 3; ++component) {
    for (const double value : {-2.0, 2.0}) {
      const Eigen::VectorXd betas = OneBeta(component, value);
      const MatrixX3d vertices = ShapeVertices(Hands(), betas);
      for (const std::string& name : HandJointNames(HandSide::kLeft)) {
        // Every joint stays in the middle of the skin around it: its distance to it changes by less than a third.
        const auto depth = [&](const Eigen::VectorXd& b, const MatrixX3d& v) {
          return (v.rowwise() - JointOf(name, b).transpose()).rowwise().norm().minCoeff();
        };
        const double mean = depth({}, Hands().data().v_template);
        EXPECT_NEAR(depth(betas, vertices) / mean, 1, 0.33) << name << " component " << component << " at " << value;
        EXPECT_GT(mean, 0.004) << name;
      }
    }
  }
}

TEST(FingerJoints, RestingFingersGiveTheBodyWithoutFingers) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 4; ++trial) {
    const Eigen::VectorXd angles = RandomValues(66, 0.4, &random), betas = RandomValues(10, 1, &random);
    const Vector3d trans(0.3, -0.1, 4);
    const MatrixX3d with = PoseVertices(Hands(), betas, PoseFromAxisAngle(Hands(), angles, trans));
    const MatrixX3d without = PoseVertices(BuiltinBody(), betas, PoseFromAxisAngle(BuiltinBody(), angles, trans));
    EXPECT_LT((with - without).cwiseAbs().maxCoeff(), 1e-12);
    const Skinner skinner(Hands());
    std::vector<double> fast(static_cast<size_t>(3 * Hands().num_vertices()));
    const BodyPose pose = PoseFromAxisAngle(Hands(), angles, trans);
    skinner.Skin(skinner.Shape(betas), {&pose, 1}, fast);
    EXPECT_LT((Eigen::Map<const MatrixX3d>(fast.data(), Hands().num_vertices(), 3) - without).cwiseAbs().maxCoeff(),
              1e-6);
  }
}

TEST(FingerJoints, SameSurface) {
  EXPECT_EQ(Hands().data().v_template, BuiltinBody().data().v_template);
  EXPECT_EQ(Hands().data().shapedirs, BuiltinBody().data().shapedirs);
  EXPECT_EQ(Hands().data().faces, BuiltinBody().data().faces);
  EXPECT_EQ(Hands().data().ft, BuiltinBody().data().ft);
  EXPECT_EQ(Hands().data().vt, BuiltinBody().data().vt);
  EXPECT_EQ(Hands().data().face_part, BuiltinBody().data().face_part);
}

TEST(FingerJoints, OldPosesTurnTheFingersAsAWhole) {
  std::mt19937 random(6);
  const Eigen::VectorXd old = RandomValues(72, 0.4, &random);
  const BodyPose pose = PoseFromAxisAngle(Hands(), old, Vector3d::Zero());
  for (int j = 0; j < 22; ++j) {
    EXPECT_LT((pose.rotations[j] - RotationFromAxisAngle(old.segment<3>(3 * j))).norm(), 1e-12);
  }
  for (int side = 0; side < 2; ++side) {
    const Eigen::Matrix3d hand = RotationFromAxisAngle(old.segment<3>(66 + 3 * side));
    for (int i = 0; i < 15; ++i) {
      const Eigen::Matrix3d expected = i % 3 == 0 && i < 12 ? hand : Eigen::Matrix3d::Identity();
      EXPECT_LT((pose.rotations[22 + 15 * side + i] - expected).norm(), 1e-12) << side << " " << i;
    }
  }
}

TEST(FingerJoints, WeightsAreLocal) {
  const SparseRows& weights = Hands().data().weights;
  for (int v = 0; v < Hands().num_vertices(); ++v) {
    int count = 0;
    for (SparseRows::InnerIterator it(weights, v); it; ++it) count += it.value() > 0;
    EXPECT_LE(count, 4) << v;
  }
  // The tip of a finger belongs to its last joint, and a bone's middle to its own.
  for (const std::string& finger : FingerNames()) {
    const Landmark& tip = Hands().data().landmarks[Hands().FindLandmark("left_" + finger + "_tip")];
    EXPECT_NEAR(weights.coeff(tip.vertices[0], Hands().FindJoint("l_" + finger + "3")), 1, 1e-6) << finger;
  }
  // A vertex that no finger moves on the back of the wrist.
  std::vector<double> below = WeightsBelow(Hands(), {"l_wrist"}), old = WeightsBelow(BuiltinBody(), {"l_wrist"});
  for (size_t v = 0; v < below.size(); ++v) EXPECT_NEAR(below[v], old[v], 1e-12);
}

TEST(FingerJoints, MirroredPoseGivesMirroredBody) {
  const std::vector<int> mirror = MirrorByPosition(Hands().data().v_template);
  std::mt19937 random(7);
  const Eigen::VectorXd pose = RandomValues(156, 0.5, &random);
  Eigen::VectorXd mirrored(156);
  for (int j = 0; j < 52; ++j) {
    mirrored.segment<3>(3 * MirrorJoint(Hands(), j)) = pose.segment<3>(3 * j).cwiseProduct(Vector3d(1, -1, -1));
  }
  const MatrixX3d a = PoseVertices(Hands(), {}, PoseFromAxisAngle(Hands(), pose, Vector3d::Zero()));
  const MatrixX3d b = PoseVertices(Hands(), {}, PoseFromAxisAngle(Hands(), mirrored, Vector3d::Zero()));
  for (int v = 0; v < Hands().num_vertices(); ++v) {
    ASSERT_LT((b.row(mirror[v]) - a.row(v).cwiseProduct(Eigen::RowVector3d(-1, 1, 1))).norm(), 1e-8) << v;
  }
}

double Volume_ml(const BodyModel& body, const BodyPose& pose) {
  return 1e6 * MeshVolume(PoseVertices(body, {}, pose), body.data().faces);
}

TEST(FingerJoints, KnucklesKeepTheirVolumeAt90Degrees) {
  const double rest = Volume_ml(Hands(), Resting());
  double blended = 0, corrected = 0;
  for (const std::string& finger : FingerNames()) {
    for (const char* joint : {"1", "2", "3"}) {
      if (finger == "thumb" && joint[0] == '1') continue;
      BodyPose pose = Resting();
      Turn("l_" + finger + joint, 0, 90, &pose);
      const double lbs = Volume_ml(WithoutFingerCorrectives(), pose) - rest, mended = Volume_ml(Hands(), pose) - rest;
      RecordProperty(finger + joint, std::to_string(lbs) + " " + std::to_string(mended));
      blended += std::abs(lbs);
      corrected += std::abs(mended);
      EXPECT_LT(std::abs(mended), 0.75 * std::abs(lbs) + 0.05) << finger << joint;
    }
  }
  RecordProperty("mean_lbs_ml", std::to_string(blended / 14));
  RecordProperty("mean_corrected_ml", std::to_string(corrected / 14));
  EXPECT_LT(corrected, 0.4 * blended);
}

TEST(FingerJoints, KnucklesKeepTheirThickness) {
  // The skin on the back of a joint stays at its distance from the joint or rises a little; blending alone lets it sink
  // by up to 29 % at a right angle.
  for (const std::string name : {"l_index2", "l_middle2", "l_pinky2", "l_ring2", "l_index3", "l_thumb3"}) {
    const int joint = Hands().FindJoint(name);
    const MatrixX3d& rest = Hands().data().v_template;
    const Eigen::RowVector3d at = Hands().joint_template().row(joint);
    BodyPose pose = Resting();
    Turn(name, 0, 90, &pose);
    const Eigen::RowVector3d now = PoseSkeleton(Hands(), Hands().joint_template(), pose).joints.row(joint);
    const MatrixX3d mended = PoseVertices(Hands(), {}, pose),
                    blended = PoseVertices(WithoutFingerCorrectives(), {}, pose);
    double lowest_blended = 1;
    for (int v = 0; v < Hands().num_vertices(); ++v) {
      const Eigen::RowVector3d off = rest.row(v) - at;
      if (off.norm() > 0.013 || off.y() < 0.5 * off.norm()) continue;  // the back, palms being down
      lowest_blended = std::min(lowest_blended, (blended.row(v) - now).norm() / off.norm());
      EXPECT_GT((mended.row(v) - now).norm() / off.norm(), 0.98) << name << " vertex " << v;
      EXPECT_LT((mended.row(v) - now).norm() / off.norm(), 1.13) << name << " vertex " << v;
    }
    EXPECT_LT(lowest_blended, 0.94) << name;
  }
}

TEST(FingerJoints, FlexionBendsToThePalm) {
  for (const std::string finger : {"index", "middle", "pinky", "ring"}) {
    BodyPose pose = Resting();
    for (const char* joint : {"1", "2", "3"}) Turn("l_" + finger + joint, 0, 60, &pose);
    const MatrixX3d points = PoseLandmarks(Hands(), {}, pose, {"left_" + finger + "_tip", "left_" + finger + "_mcp"});
    EXPECT_LT(points(0, 1), points(1, 1) - 0.02) << finger << ": below the knuckle, palms being down";
    pose = Resting();
    Turn("l_" + finger + "1", 1, 20, &pose);
    const MatrixX3d rest = PoseLandmarks(Hands(), {}, Resting(), {"left_" + finger + "_tip"});
    const MatrixX3d radial = PoseLandmarks(Hands(), {}, pose, {"left_" + finger + "_tip"});
    EXPECT_GT(radial(0, 2), rest(0, 2) + 0.01) << finger << ": to the thumb, which is in front";
  }
  // The thumb: flexed its tip comes nearer to the little finger's knuckle.
  BodyPose pose = Resting();
  for (const char* joint : {"l_thumb2", "l_thumb3"}) Turn(joint, 0, 50, &pose);
  const auto distance = [](const BodyPose& p) {
    const MatrixX3d x = PoseLandmarks(Hands(), {}, p, {"left_thumb_tip", "left_pinky_mcp"});
    return (x.row(0) - x.row(1)).norm();
  };
  EXPECT_LT(distance(pose), distance(Resting()) - 0.02);
}

TEST(FingerJoints, MirroredPosesHaveTheSameAngles) {
  const HandSkeleton left = Left(), right = *FindHand(Hands(), HandSide::kRight);
  for (int i = 0; i < kHandJoints; ++i) {
    const Vector3d w(0.3, -0.2, 0.4), mirrored = w.cwiseProduct(Vector3d(1, -1, -1));  // of S R S
    EXPECT_LT((left.axes[i].transpose() * w - right.axes[i].transpose() * mirrored).norm(), 1e-9) << i;
    EXPECT_LT((left.axes[i].transpose() * left.axes[i] - Eigen::Matrix3d::Identity()).norm(), 1e-9) << i;
    EXPECT_NEAR(left.rest_flexion[i], right.rest_flexion[i], 1e-9) << i;
    EXPECT_LT(std::abs(left.rest_flexion[i]), 9 * kDegree) << "nearly straight";
  }
}

TEST(FingerJoints, LandmarksOfBothHands) {
  EXPECT_EQ(Hands().data().landmarks.size(), BuiltinBody().data().landmarks.size() + 40);
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
    for (const std::string& name : HandLandmarkNames(side)) EXPECT_GE(Hands().FindLandmark(name), 0) << name;
  }
  const MatrixX3d points =
      PoseLandmarks(Hands(), {}, Resting(), {"left_index_pip", "right_thumb_cmc", "left_middle_tip"});
  EXPECT_LT((points.row(0).transpose() - JointOf("l_index2")).norm(), 1e-12);
  EXPECT_LT((points.row(1).transpose() - JointOf("r_thumb1")).norm(), 1e-12);
  EXPECT_NEAR(points(2, 0), Hands().data().v_template.col(0).maxCoeff(), 0.002);
}

TEST(FingerJoints, CompactFileHoldsThem) {
  const TemporaryFolder folder;
  SaveBodyCompact(folder.File("hands.npz"), Hands().data());
  const BodyModel read = LoadBody(folder.File("hands.npz"));
  EXPECT_EQ(read.data().joint_names, Hands().data().joint_names);
  std::mt19937 random(8);
  const Eigen::VectorXd angles = RandomValues(156, 0.4, &random), betas = RandomValues(10, 1, &random);
  const MatrixX3d a = PoseVertices(Hands(), betas, PoseFromAxisAngle(Hands(), angles, Vector3d::Zero()));
  const MatrixX3d b = PoseVertices(read, betas, PoseFromAxisAngle(read, angles, Vector3d::Zero()));
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(FingerJoints, ByNameWhereAFileIsExpected) {
  EXPECT_EQ(BodyOrBuiltin("hands").get(), &BuiltinBodyWithHands());
  EXPECT_EQ(BodyOrBuiltin("").get(), &BuiltinBody());
  EXPECT_THROW(BodyOrBuiltin("./hands"), std::runtime_error);
}

TEST(FingerJoints, IsMadeQuicklyAndAlwaysTheSame) {
  const BuiltinBodySources sources = EmbeddedBuiltinBodySources();
  const auto begin = std::chrono::steady_clock::now();
  const BodyModelData a = MakeBuiltinBodyWithHands(sources);
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
  RecordProperty("ms", std::to_string(elapsed.count()));
  EXPECT_LT(elapsed.count(), 2000);
  const BodyModelData b = MakeBuiltinBodyWithHands(sources);
  EXPECT_EQ(a.posedirs.block, b.posedirs.block);
  EXPECT_EQ(a.weights.nonZeros(), b.weights.nonZeros());
}

constexpr double kMetresPerUnit = 0.1, kStature = 1.72 / 1.664;

class MakeHumanFingers : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder_ + "/base.obj")) GTEST_SKIP() << "no " << folder_;
    std::istringstream obj(ReadTextFile(folder_ + "/base.obj"));
    std::string line, word, group;
    while (std::getline(obj, line)) {
      std::istringstream words(line);
      words >> word;
      if (word == "v") {
        Vector3d v;
        words >> v[0] >> v[1] >> v[2];
        vertices_.push_back(v);
      } else if (word == "g") {
        words >> group;
      } else if (word == "f" && group.starts_with("joint-l-")) {
        while (words >> word) cubes_[group].insert(std::stoi(word) - 1);
      }
    }
    const std::vector<Vector3d> base = vertices_;
    for (const std::string sex : {"female", "male"}) {
      Add("universal-" + sex + "-young-averagemuscle-averageweight", 0.5);
      for (const std::string ancestry : {"african", "asian", "caucasian"})
        Add(ancestry + "-" + sex + "-young", 1 / 6.0);
    }
    ASSERT_GT((vertices_[0] - base[0]).norm(), 0);
  }

  void Add(const std::string& target, double share) {
    std::istringstream text(ReadTextFile(folder_ + "/targets/macrodetails/" + target + ".target.gz"));
    std::string line;
    while (std::getline(text, line)) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream words(line);
      size_t v = 0;
      Vector3d offset;
      words >> v >> offset[0] >> offset[1] >> offset[2];
      vertices_.at(v) += share * offset;
    }
  }

  /// The middle of a joint's cube, metres: "hand", or "finger-F-K" with F from 1 (thumb) to 5 and K from 1 to 4 (tip).
  Vector3d Cube(const std::string& name) const {
    Vector3d sum = Vector3d::Zero();
    const std::set<int>& cube = cubes_.at("joint-l-" + name);
    for (const int v : cube) sum += vertices_[size_t(v)];
    return kStature * kMetresPerUnit * sum / double(cube.size());
  }

  const std::string folder_ = SharedDir() + "/data/makehuman";
  std::vector<Vector3d> vertices_;
  std::map<std::string, std::set<int>> cubes_;
};

// Claims on MakeHuman's finger joints in assets/body/RECIPE.md, section 9, and docs/lab/built_in_body.md, measured on
// its base mesh and targets (CC0) where the folder beside the checkout has them.

TEST_F(MakeHumanFingers, BonesAsStated) {
  const double stated_mm[5][3] = {
      {31.9, 37.4, 29.0}, {26.7, 23.9, 27.9}, {35.0, 28.5, 27.9}, {30.7, 25.6, 27.6}, {22.0, 16.1, 20.5}};
  for (int f = 0; f < 5; ++f) {
    for (int k = 0; k < 3; ++k) {
      const std::string finger = "finger-" + std::to_string(f + 1) + "-";
      const double bone = (Cube(finger + std::to_string(k + 2)) - Cube(finger + std::to_string(k + 1))).norm();
      EXPECT_NEAR(1000 * bone, stated_mm[f][k], 0.1) << finger << k + 1;
    }
  }
}

TEST_F(MakeHumanFingers, KnucklesLieAtTheTubesFirstRings) {
  const auto frame = [](const Vector3d& wrist, const Vector3d& hand, const Vector3d& across) {
    Eigen::Matrix3d axes;
    axes.col(0) = (hand - wrist).normalized();
    axes.col(2) = (across - across.dot(axes.col(0)) * axes.col(0)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
  };
  const BodyModel &body = BuiltinBodyWithHands(), &without = BuiltinBody();
  const auto ours = [](const BodyModel& of, const char* joint) -> Vector3d {
    return of.joint_template().row(of.FindJoint(joint));
  };
  const Vector3d wrist = ours(body, "l_wrist"), hand = ours(without, "l_hand");
  const Vector3d their_wrist = Cube("hand"), their_hand = 0.5 * (Cube("finger-3-1") + Cube("finger-4-1"));
  const Eigen::Matrix3d to = frame(wrist, hand, ours(body, "l_index1") - ours(body, "l_pinky1")) *
                             frame(their_wrist, their_hand, Cube("finger-2-1") - Cube("finger-5-1")).transpose();
  const double scale = (hand - wrist).norm() / (their_hand - their_wrist).norm();
  int finger = 2;
  for (const char* joint : {"l_index1", "l_middle1", "l_ring1", "l_pinky1"}) {
    const Vector3d cube = wrist + scale * to * (Cube("finger-" + std::to_string(finger++) + "-1") - their_wrist);
    const Vector3d off = cube - ours(body, joint);
    EXPECT_LT(std::abs(off.x()), 0.0045) << joint << " along the hand";
    EXPECT_LT(std::abs(off.z()), 0.004) << joint << " across";
    EXPECT_GT(off.y(), 0.002) << joint << ": in the skin of the back of the hand";
    EXPECT_LT(off.y(), 0.008) << joint;
  }
  const Vector3d thumb = wrist + scale * to * (Cube("finger-1-1") - their_wrist);
  EXPECT_LT((thumb - ours(body, "l_thumb1")).norm(), 0.012);
}

}  // namespace

}  // namespace bodyloom::finger_joints_test
