// SPDX-License-Identifier: Apache-2.0
/// Claims on MakeHuman's finger joints in assets/body/RECIPE.md, section 9, and docs/lab/built_in_body.md, measured on
/// its base mesh and targets (CC0) where the folder beside the checkout has them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/text_scanner.h"
#include "geometry/body/hand_skeleton.h"
#include "tests/support/paths.h"

namespace bodyloom::finger_joints_makehuman_test {
namespace {

using Eigen::Vector3d;

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
}  // namespace bodyloom::finger_joints_makehuman_test
