// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "geometry/body/skinning.h"

#include "geometry/body/skinning_simd.h"
#include "tests/geometry/random_body.h"
#include "tests/support/toy_body.h"

namespace bodyloom::skinning_test {
namespace {

using ::testing::HasSubstr;

/// The promise of geometry/body/skinning.h for a body of human size.
constexpr double kLargestErrorMetres = 1e-6;

std::vector<BodyPose> Poses(const BodyModel& model, int num_frames, double max_angle = 2.5) {
  std::vector<BodyPose> poses;
  poses.reserve(static_cast<size_t>(num_frames));
  for (int t = 0; t < num_frames; ++t) poses.push_back(RandomPose(model, 50 + t, max_angle));
  return poses;
}

struct Skinned {
  std::vector<float> vertices;
  MatrixX3d roots;
  SkinningSummary summary;
};

Skinned SkinAll(const BodyModel& model, const Eigen::VectorXd& betas, const std::vector<BodyPose>& poses,
                SkinnerOptions options = {}) {
  const Skinner skinner(model, std::move(options));
  Skinned result;
  result.vertices.assign(3 * poses.size() * skinner.num_vertices(), std::numeric_limits<float>::quiet_NaN());
  result.summary = skinner.SkinFromRoot(skinner.Shape(betas), poses, result.vertices, &result.roots);
  return result;
}

bool SameBytes(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Largest distance to PoseVertices after moving both to the root joint, in every frame.
double LargestError(const BodyModel& model, const Eigen::VectorXd& betas, const std::vector<BodyPose>& poses,
                    const Skinned& skinned) {
  const int V = model.num_vertices();
  double largest = 0;
  for (size_t t = 0; t < poses.size(); ++t) {
    BodyPose pose = poses[t];
    pose.trans.setZero();
    const MatrixX3d exact =
        PoseVertices(model, betas, pose).rowwise() - Eigen::RowVector3d(model.RestJoints(betas).row(0));
    const Eigen::Map<const MatrixX3f> fast(skinned.vertices.data() + 3 * t * V, V, 3);
    const double error = (fast.cast<double>() - exact).rowwise().norm().maxCoeff();
    if (!(error <= largest)) largest = error;
  }
  return largest;
}

/// All tests of numbers run once per instruction set that this machine has.
class SkinningTarget : public ::testing::TestWithParam<int64_t> {
 protected:
  void SetUp() override { skinning_internal::ForceSimdTarget(GetParam()); }
  void TearDown() override { skinning_internal::ForceSimdTarget(0); }
};

TEST_P(SkinningTarget, IsTheOneAskedFor) {
  EXPECT_EQ(skinning_internal::ChosenSimdTarget(), skinning_internal::SimdTargetName(GetParam()));
  EXPECT_EQ(SkinAll(ToyBody(), Eigen::VectorXd(), Poses(ToyBody(), 1)).summary.simd_target,
            skinning_internal::SimdTargetName(GetParam()));
}

TEST_P(SkinningTarget, AgreesWithDoubleForEveryBatchSize) {
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = RandomBetas(6, 1);
  for (int T : {1, 2, 3, 4, 5, 7, 8, 9, 12, 13, 16, 17, 20, 28, 29, 31, 32, 33, 40, 64, 65}) {
    const std::vector<BodyPose> poses = Poses(model, T, 3.1);
    EXPECT_LT(LargestError(model, betas, poses, SkinAll(model, betas, poses)), kLargestErrorMetres) << T;
  }
}

TEST_P(SkinningTarget, AgreesWithDoubleOnDenseCorrectives) {
  RandomBodyOptions options;
  options.num_vertices = 1001;
  options.correctives_per_vertex = 1000;
  const BodyModel model = RandomBody(options);
  const Eigen::VectorXd betas = RandomBetas(10, 1);
  const std::vector<BodyPose> poses = Poses(model, 40);
  EXPECT_LT(LargestError(model, betas, poses, SkinAll(model, betas, poses)), kLargestErrorMetres);
}

TEST_P(SkinningTarget, AFrameDoesNotDependOnItsBatch) {
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = RandomBetas(6, 2);
  const std::vector<BodyPose> poses = Poses(model, 300);  // more than one pass
  const Skinned together = SkinAll(model, betas, poses);
  const size_t stride = 3 * size_t(model.num_vertices());
  for (int t : {0, 1, 31, 32, 200, 255, 256, 299}) {
    const Skinned alone = SkinAll(model, betas, {poses[t]});
    EXPECT_EQ(std::memcmp(alone.vertices.data(), together.vertices.data() + t * stride, stride * sizeof(float)), 0)
        << t;
    EXPECT_EQ(alone.roots.row(0), together.roots.row(t));
  }
}

std::string TargetLabel(const ::testing::TestParamInfo<int64_t>& info) {
  return skinning_internal::SimdTargetName(info.param);
}
INSTANTIATE_TEST_SUITE_P(Simd, SkinningTarget, ::testing::ValuesIn(skinning_internal::SimdTargets()), TargetLabel);

TEST(Skinning, InstructionSetsDifferOnlyInTheLastBits) {
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = RandomBetas(6, 3);
  const std::vector<BodyPose> poses = Poses(model, 33);
  const Skinned best = SkinAll(model, betas, poses);
  const std::vector<int64_t> targets = skinning_internal::SimdTargets();
  if (targets.size() < 2) GTEST_SKIP() << "this machine has one instruction set";
  for (int64_t target : targets) {
    skinning_internal::ForceSimdTarget(target);
    const Skinned other = SkinAll(model, betas, poses);
    skinning_internal::ForceSimdTarget(0);
    double largest = 0;
    for (size_t i = 0; i < best.vertices.size(); ++i) {
      largest = std::max<double>(largest, std::abs(best.vertices[i] - other.vertices[i]));
    }
    EXPECT_LT(largest, 1e-6) << other.summary.simd_target;
    EXPECT_EQ(best.roots, other.roots);
  }
}

TEST(Skinning, SameBytesForAnyNumberOfThreads) {
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = RandomBetas(6, 4);
  const std::vector<BodyPose> poses = Poses(model, 270);
  const Skinned one = SkinAll(model, betas, poses);
  for (int threads : {2, 3, 8}) {
    SkinnerOptions options;
    options.num_threads = threads;
    const Skinned many = SkinAll(model, betas, poses, options);
    EXPECT_TRUE(SameBytes(one.vertices, many.vertices)) << threads;
    EXPECT_EQ(one.roots, many.roots);
    EXPECT_EQ(one.summary.corrective_blocks, many.summary.corrective_blocks);
  }
}

TEST(Skinning, AChosenFewEqualTheWhole) {
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = RandomBetas(6, 5);
  const std::vector<BodyPose> poses = Poses(model, 35);
  const Skinned all = SkinAll(model, betas, poses);
  SkinnerOptions options;
  options.vertices = {803, 5, 5, 0, 400};
  const Skinned some = SkinAll(model, betas, poses, options);
  ASSERT_EQ(some.vertices.size(), 3u * 35 * 5);
  for (int t = 0; t < 35; ++t) {
    for (int i = 0; i < 5; ++i) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(some.vertices[3 * (5 * t + i) + c], all.vertices[3 * (804 * t + options.vertices[i]) + c]);
      }
    }
  }
}

TEST(Skinning, FamilySizes) {
  const std::pair<int, int> sizes[] = {{6890, 24}, {6890, 52}, {10475, 55}};
  for (const auto& [V, J] : sizes) {
    RandomBodyOptions options;
    options.num_vertices = V;
    options.num_joints = J;
    options.correctives_per_vertex = 1000;
    const BodyModel model = RandomBody(options);
    const Eigen::VectorXd betas = RandomBetas(10, 6);
    const std::vector<BodyPose> poses = Poses(model, 3);
    EXPECT_LT(LargestError(model, betas, poses, SkinAll(model, betas, poses)), kLargestErrorMetres) << V << " " << J;
  }
}

TEST(Skinning, WorldOutputFarFromTheOrigin) {
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = RandomBetas(6, 7);
  std::vector<BodyPose> poses = Poses(model, 10);
  for (BodyPose& pose : poses) pose.trans += Eigen::Vector3d(5e4, -3e3, 1e4);
  const Skinner skinner(model);
  std::vector<double> world(3 * 10 * 804);
  const SkinningSummary summary = skinner.Skin(skinner.Shape(betas), poses, world);
  EXPECT_EQ(summary.frames, 10);
  EXPECT_EQ(summary.vertices, 804);
  const Skinned from_root = SkinAll(model, betas, poses);
  for (int t = 0; t < 10; ++t) {
    const Eigen::Map<const MatrixX3d> fast(world.data() + 3 * 804 * t, 804, 3);
    EXPECT_LT((fast - PoseVertices(model, betas, poses[t])).rowwise().norm().maxCoeff(), kLargestErrorMetres);
    const Eigen::Map<const MatrixX3f> relative(from_root.vertices.data() + 3 * 804 * t, 804, 3);
    EXPECT_EQ(fast, MatrixX3d(relative.cast<double>().rowwise() + from_root.roots.row(t)));
  }
}

TEST(Skinning, RestingJointsAreSkippedExactly) {
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = RandomBetas(6, 8);
  std::vector<BodyPose> poses = Poses(model, 64);
  for (size_t t = 0; t < poses.size(); ++t) {
    // Legs rest throughout, the left elbow in the first 32 frames only; the right arm moves, but not in every frame.
    for (int j : {1, 2, 4, 5}) poses[t].rotations[j].setIdentity();
    if (t < 32) poses[t].rotations[18].setIdentity();
    if (t % 32 == 0) poses[t].rotations[19].setIdentity();
    if (t % 32 != 31) poses[t].rotations[17].setIdentity();
  }
  SkinnerOptions all;
  all.skip_resting_joints = false;
  const Skinned with = SkinAll(model, betas, poses), without = SkinAll(model, betas, poses, all);
  EXPECT_TRUE(SameBytes(with.vertices, without.vertices));
  EXPECT_EQ(without.summary.corrective_blocks_skipped, 0);
  EXPECT_EQ(without.summary.corrective_blocks, with.summary.corrective_blocks + with.summary.corrective_blocks_skipped);
  int64_t expected = 0;
  for (int joint : model.data().posedirs.joint) expected += joint == 18 ? 32 : joint < 16 ? 64 : 0;
  EXPECT_EQ(with.summary.corrective_blocks_skipped, expected);
  EXPECT_GT(expected, 0);
  EXPECT_LT(LargestError(model, betas, poses, with), kLargestErrorMetres);
}

TEST(Skinning, AFrameThatIsLostSpoilsNoOther) {
  const BodyModel& model = ToyBody();
  std::vector<BodyPose> poses = Poses(model, 6);
  const Skinned clean = SkinAll(model, Eigen::VectorXd(), poses);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  poses[2].rotations[0].setConstant(nan);
  poses[4].trans.setConstant(nan);
  const Skinned dirty = SkinAll(model, Eigen::VectorXd(), poses);
  for (int t = 0; t < 6; ++t) {
    const Eigen::Map<const MatrixX3f> a(clean.vertices.data() + 3 * 804 * t, 804, 3);
    const Eigen::Map<const MatrixX3f> b(dirty.vertices.data() + 3 * 804 * t, 804, 3);
    if (t == 2 || t == 4) {
      EXPECT_TRUE(b.array().isNaN().all()) << t;
    } else {
      EXPECT_EQ(a, b) << t;
    }
  }
}

TEST(Skinning, SmallBodies) {
  RandomBodyOptions options;
  options.num_vertices = 130;
  options.correctives_per_vertex = 0;
  const BodyModel plain = RandomBody(options);
  const std::vector<BodyPose> poses = Poses(plain, 5);
  const Skinned skinned = SkinAll(plain, RandomBetas(10, 1), poses);
  EXPECT_LT(LargestError(plain, RandomBetas(10, 1), poses, skinned), kLargestErrorMetres);
  EXPECT_EQ(skinned.summary.corrective_blocks + skinned.summary.corrective_blocks_skipped, 0);

  options.num_joints = 1;
  options.num_vertices = 3;
  const BodyModel rigid = RandomBody(options);
  const std::vector<BodyPose> rigid_poses = Poses(rigid, 2);
  EXPECT_LT(LargestError(rigid, Eigen::VectorXd(), rigid_poses, SkinAll(rigid, Eigen::VectorXd(), rigid_poses)),
            kLargestErrorMetres);
  EXPECT_TRUE(SkinAll(plain, Eigen::VectorXd(), {}).vertices.empty());
}

TEST(Skinning, FewerBetasMeanZeros) {
  const BodyModel& model = ToyBody();
  Eigen::VectorXd betas = RandomBetas(6, 9);
  betas.tail(4).setZero();
  const std::vector<BodyPose> poses = Poses(model, 2);
  EXPECT_TRUE(SameBytes(SkinAll(model, betas, poses).vertices, SkinAll(model, betas.head(2), poses).vertices));
}

std::string MessageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Skinning, BrokenContractsAreNamed) {
  const BodyModel& model = ToyBody();
  SkinnerOptions options;
  options.num_threads = 0;
  EXPECT_THAT(MessageOf([&] { Skinner(model, options); }), HasSubstr("num_threads is 0"));
  options.num_threads = 1;
  options.vertices = {3, 804};
  EXPECT_THAT(MessageOf([&] { Skinner(model, options); }), HasSubstr("vertex 804 is outside 0..803"));

  const Skinner skinner(model);
  const ShapedBody body = skinner.Shape(Eigen::VectorXd());
  std::vector<BodyPose> poses = Poses(model, 2);
  std::vector<double> out(3 * 804 * 2);
  EXPECT_THAT(MessageOf([&] { (void)skinner.Shape(RandomBetas(7, 1)); }), HasSubstr("betas has 7 values"));
  EXPECT_THAT(MessageOf([&] { skinner.Skin(body, poses, std::span(out).first(100)); }),
              HasSubstr("room for 100 values, expected frames x vertices x 3 = 2 x 804 x 3"));
  EXPECT_THAT(MessageOf([&] { skinner.Skin(ShapedBody(), poses, out); }), HasSubstr("a shape of 0 joints"));
  poses[1].rotations.pop_back();
  EXPECT_THAT(MessageOf([&] { skinner.Skin(body, poses, out); }), HasSubstr("the pose of frame 1 has 23 rotations"));
}

TEST(JointInfluence, StrongestIsTheLargestWeight) {
  const BodyModel& body = ToyBody();
  const std::vector<int> strongest = StrongestJoints(body);
  const Eigen::MatrixXd weights = Eigen::MatrixXd(body.data().weights);
  for (int v = 0; v < body.num_vertices(); ++v) {
    EXPECT_NEAR(weights(v, strongest[v]), weights.row(v).maxCoeff(), 1e-12) << v;
  }
}

TEST(JointInfluence, BelowTheRootIsEverythingAndBelowAWristTheHand) {
  const BodyModel& body = ToyBody();
  for (const double weight : WeightsBelow(body, {"pelvis"})) EXPECT_NEAR(weight, 1, 1e-9);
  for (const double weight : WeightsBelow(body, {"no such joint"})) EXPECT_EQ(weight, 0);
  const std::vector<double> hand = WeightsBelow(body, {"l_wrist"});
  const Eigen::MatrixXd weights = Eigen::MatrixXd(body.data().weights);
  const int wrist = body.FindJoint("l_wrist"), fingers = body.FindJoint("l_hand");
  for (int v = 0; v < body.num_vertices(); ++v) {
    EXPECT_NEAR(hand[v], weights(v, wrist) + weights(v, fingers), 1e-12) << v;
  }
}

}  // namespace

}  // namespace bodyloom::skinning_test
