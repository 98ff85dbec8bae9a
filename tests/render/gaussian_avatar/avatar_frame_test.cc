// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/avatar_frame.h"

#include <gtest/gtest.h>

#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::avatar_frame_test {
namespace {

/// Plain skinning of the shaped vertices with the frame's bones, plus its correctives.
MatrixX3d Skinned(const BodyModel& model, const Eigen::VectorXd& betas, const AvatarFrame& frame) {
  const MatrixX3d shaped = ShapeVertices(model, betas);
  MatrixX3d vertices = MatrixX3d::Zero(model.num_vertices(), 3);
  for (int v = 0; v < model.num_vertices(); ++v) {
    for (int k = model.influence_begin()[v]; k < model.influence_begin()[v + 1]; ++k) {
      const float* bone = frame.bones.data() + 12 * model.influence_joint()[k];
      for (int r = 0; r < 3; ++r) {
        double moved = bone[4 * r + 3];
        for (int c = 0; c < 3; ++c) moved += bone[4 * r + c] * shaped(v, c);
        vertices(v, r) += model.influence_weight()[k] * moved;
      }
    }
    if (frame.correctives.empty()) continue;
    for (int r = 0; r < 3; ++r) vertices(v, r) += frame.correctives[4 * v + r];
  }
  return vertices;
}

TEST(AvatarFrame, BonesAndCorrectivesMakeThePosedBody) {
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = Eigen::VectorXd::LinSpaced(6, -1, 1.5);
  const BodyPose pose = RandomPose(model, 4, 1.5, 3);
  const AvatarFrames frames(model, betas);
  AvatarFrame frame;
  frames.Make(pose, {}, 1, &frame);
  const MatrixX3d expected = PoseVertices(model, betas, pose);
  EXPECT_LT((Skinned(model, betas, frame) - expected).cwiseAbs().maxCoeff(), 2e-6);
  double largest = 0;
  for (const float c : frame.correctives) largest = std::max(largest, std::abs(double(c)));
  EXPECT_GT(largest, 0.005);

  CameraPose camera;
  camera.camera_from_world_rotation = RotationFromAxisAngle(Eigen::Vector3d(0.2, 1.1, -0.4));
  camera.camera_from_world_translation = Eigen::Vector3d(0.3, -0.2, 1);
  frames.Make(pose, camera, 2, &frame);
  MatrixX3d seen = expected * camera.camera_from_world_rotation.transpose();
  seen.rowwise() += camera.camera_from_world_translation.transpose();
  EXPECT_LT((Skinned(model, betas, frame) - seen).cwiseAbs().maxCoeff(), 2e-6);
}

TEST(AvatarFrame, SameBytesForAnyThreadsAndNoMemoryOfTheLastFrame) {
  const BodyModel& model = ToyBody();
  const AvatarFrames frames(model, Eigen::VectorXd());
  AvatarFrame one, five;
  frames.Make(RandomPose(model, 9, 1, 2), {}, 5, &five);
  frames.Make(RandomPose(model, 2, 1, 3), {}, 5, &five);
  frames.Make(RandomPose(model, 2, 1, 3), {}, 1, &one);
  EXPECT_EQ(one.bones, five.bones);
  EXPECT_EQ(one.correctives, five.correctives);
}

TEST(AvatarFrame, OfABodyWithoutCorrectives) {
  BodyModelData data = ToyBody().data();
  data.posedirs = {};
  const BodyModel model(data);
  AvatarFrame frame;
  AvatarFrames(model, Eigen::VectorXd()).Make(RandomPose(model, 2, 1, 3), {}, 1, &frame);
  EXPECT_TRUE(frame.correctives.empty());
  EXPECT_LT((Skinned(model, {}, frame) - PoseVertices(model, {}, RandomPose(model, 2, 1, 3))).cwiseAbs().maxCoeff(),
            2e-6);
}

TEST(AvatarFrame, RefusesAPoseOfOtherJoints) {
  const BodyModel& model = ToyBody();
  BodyPose pose = RandomPose(model, 2, 1, 3);
  pose.rotations.pop_back();
  AvatarFrame frame;
  EXPECT_THROW(AvatarFrames(model, Eigen::VectorXd()).Make(pose, {}, 1, &frame), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::avatar_frame_test
