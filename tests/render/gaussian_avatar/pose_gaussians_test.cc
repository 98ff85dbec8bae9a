// SPDX-License-Identifier: Apache-2.0
// Posed Gaussians against their twin and the posed body, and behaviour for degenerate values.
#include "render/gaussian_avatar/pose_gaussians.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/lighting/sh_lighting.h"
#include "render/splat/project_gaussians.h"
#include "tests/render/gaussian_avatar/person_scene.h"
#include "tests/render/splat/same_bytes.h"

namespace bodyloom::pose_gaussians_test {
namespace {

using Body = GaussianBody;
using Posed = CameraGaussians;

TEST(PoseGaussians, IsItsTwin) {
  for (const uint32_t seed : {1U, 2U}) {
    const PersonScene scene(200, seed);
    CameraGaussians posed;
    scene.Pose(&posed);
    const TwinPerson<double> person = scene.Twin<double>();
    for (int i = 0; i < posed.size(); ++i) {
      const auto expected = ColumnsOf(scene.TwinRow(person, i));
      double largest = 0;
      for (int c = 0; c < 9; ++c) largest = std::max(largest, std::abs(expected[Posed::kFactor + c]));
      for (int c = 0; c < Posed::kNumColumns; ++c) {
        const double tolerance = c >= Posed::kFactor && c < Posed::kOpacity ? 3e-6 * largest : 3e-6;
        EXPECT_NEAR(posed.columns(i, c), expected[c], tolerance) << i << ", " << c;
      }
    }
  }
}

TEST(PoseGaussians, OnTheSkinTheyFollowThePosedBody) {
  // A Gaussian at a vertex, with its weights and the whole corrective, is where the posed vertex is.
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = Eigen::VectorXd::Constant(3, 0.7);
  const BodyPose pose = RandomPose(model, 6, 1.3, 3);
  AvatarFrame frame;
  AvatarFrames(model, betas).Make(pose, {}, 1, &frame);
  const MatrixX3d shaped = ShapeVertices(model, betas), expected = PoseVertices(model, betas, pose);
  GaussianBody body;
  body.Resize(model.num_faces());
  for (int f = 0; f < body.size(); ++f) {
    const int v = model.data().faces(f, 1);
    for (int k = 0; k < 3; ++k) body.parameters(f, Body::kPosition + k) = static_cast<float>(shaped(v, k));
    for (int k = 0; k < Body::kInfluences; ++k) {
      const int at = model.influence_begin()[v] + k;
      const bool has = at < model.influence_begin()[v + 1];
      body.joints[f * Body::kInfluences + k] = has ? model.influence_joint()[at] : 0;
      body.parameters(f, Body::kWeightLogit + k) =
          has ? static_cast<float>(std::log(model.influence_weight()[at])) : -60.0F;
    }
    body.anchors[f] = {f, {0, 1, 0}, 1};
  }
  CameraGaussians posed;
  PoseGaussians(body, model.data().faces, frame, {}, &posed);
  for (int f = 0; f < body.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_NEAR(posed.columns(f, Posed::kX + k), expected(model.data().faces(f, 1), k), 3e-6) << f;
    }
  }
}

TEST(PoseGaussians, TheLightIsThatOfLighting) {
  PersonScene scene(40);
  CameraGaussians posed;
  scene.options.light_from_frame = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (int j = 0; j < scene.frame.num_joints(); ++j) {  // bones at rest, so normals stay
    for (int k = 0; k < 12; ++k) scene.frame.bones[12 * j + k] = k % 5 == 0 ? 1.0F : 0.0F;
  }
  scene.Pose(&posed);
  ShLighting light;
  for (int k = 0; k < Body::kLightValues; ++k) light(k / 9, k % 9) = scene.body.light[k];
  for (int i = 0; i < posed.size(); ++i) {
    Eigen::Vector3d n;
    for (int k = 0; k < 3; ++k) n[k] = scene.body.parameters(i, Body::kNormal + k);
    const Eigen::Vector3d shading = Shading(light, n.normalized());
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(posed.columns(i, Posed::kRed + c), scene.body.parameters(i, Body::kAlbedo + c) * shading[c], 3e-6);
    }
  }
}

TEST(PoseGaussians, SameBytesEverywhere) {
  const PersonScene scene(3001);
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* out) {
    CameraGaussians posed;
    scene.Pose(&posed, threads);
    *out = posed.columns;
  });
}

TEST(PoseGaussians, NoTurnAndNoNormalAreHarmless) {
  PersonScene scene(20);
  for (int k = 0; k < 4; ++k) scene.body.parameters(3, Body::kQuaternion + k) = 0;
  for (int k = 0; k < 3; ++k) scene.body.parameters(5, Body::kNormal + k) = 0;
  CameraGaussians posed;
  scene.Pose(&posed);
  for (int i = 0; i < posed.size(); ++i) {
    for (int c = 0; c < Posed::kNumColumns; ++c) EXPECT_TRUE(std::isfinite(posed.columns(i, c))) << i << ", " << c;
  }
  // No turn is the identity.
  PersonScene same(20);
  const float identity[4] = {1, 0, 0, 0};
  for (int k = 0; k < 4; ++k) same.body.parameters(3, Body::kQuaternion + k) = identity[k];
  CameraGaussians expected;
  same.Pose(&expected);
  for (int c = 0; c < Posed::kNumColumns; ++c) EXPECT_EQ(posed.columns(3, c), expected.columns(3, c)) << c;
}

TEST(PoseGaussians, NumbersThatAreNotFiniteAreNotDrawn) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), INFINITY, -INFINITY}) {
    for (int c = 0; c < Body::kNumParameters; ++c) {
      PersonScene scene(20);
      for (int i = 0; i < 20; ++i) {  // in the middle of the view, well drawn
        for (int k = 0; k < 3; ++k) scene.body.parameters(i, Body::kAlbedo + k) = 0.5F;
      }
      scene.body.parameters(7, c) = bad;
      CameraGaussians posed;
      scene.Pose(&posed);
      ScreenGaussians screen;
      ProjectGaussians(posed, MakePinhole(400, 400, 300), {}, &screen);
      const bool is_scale = c >= Body::kLogScale && c < Body::kLogScale + 3, is_logit = c == Body::kOpacityLogit;
      // Infinite logits and log scales have limits: opacities of 0 and 1, extents of nothing and too much.
      const bool has_limit = std::isinf(bad) && (is_logit || is_scale);
      const bool weight_is_gone = c >= Body::kWeightLogit && bad == -INFINITY;
      if (!has_limit && !weight_is_gone) {
        EXPECT_FALSE(screen.IsDrawn(7)) << c << ", " << bad;
      }
      for (int i = 0; i < 20; ++i) {
        if (i != 7) {
          EXPECT_TRUE(screen.IsDrawn(i)) << c << ", " << i;
        }
      }
    }
  }
}

TEST(PoseGaussians, RefusesWhatDoesNotFit) {
  PersonScene scene(20);
  CameraGaussians posed;
  const auto pose = [&] { scene.Pose(&posed); };
  EXPECT_NO_THROW(pose());
  scene.body.joints[7] = 24;
  EXPECT_THROW(pose(), std::invalid_argument);
  scene.body.joints[7] = 0;
  scene.frame.correctives.resize(40);
  EXPECT_THROW(pose(), std::invalid_argument);
  scene.frame.correctives.clear();
  EXPECT_NO_THROW(pose());
  scene.options.light_from_frame[3] = NAN;
  EXPECT_THROW(pose(), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::pose_gaussians_test
