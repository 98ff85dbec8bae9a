// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/skin_gaussians.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/gaussian_avatar/pose_gaussians.h"
#include "render/raster/visibility_buffer.h"
#include "render/splat/project_gaussians.h"
#include "render/splat/splat_image.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::skin_gaussians_test {
namespace {

TEST(SkinGaussians, CoverThePosedBodyAndNothingElse) {
  const BodyModel& model = ToyBody();
  const Eigen::VectorXd betas = Eigen::VectorXd::Constant(2, 0.4);
  const UvTexelTable texels = BuildUvTexelTable(model, {.width = 160, .height = 160});
  const GaussianBody body = SkinGaussians(model, betas, texels);
  EXPECT_EQ(body.size(), texels.num_inside);
  EXPECT_TRUE(body.IsValid(model.num_joints(), model.num_faces(), nullptr));

  const BodyPose pose = RandomPose(model, 3, 0.5, 3);
  const Camera camera = MakePinhole(200, 200, 260);
  AvatarFrame frame;
  AvatarFrames(model, betas).Make(pose, {}, 1, &frame);
  CameraGaussians posed;
  PoseGaussians(body, model.data().faces, frame, {}, &posed);
  ScreenGaussians screen;
  ProjectGaussians(posed, camera, {}, &screen);
  SplatImage image;
  image.Draw(screen, {0, 0, 200, 200});
  VisibilityBuffer buffer;
  buffer.Render(PoseVertices(model, betas, pose), model.data().faces, camera);
  int inside = 0, covered = 0, spilt = 0;
  const auto near_body = [&](int x, int y) {  // within two pixels, which is what a texel is wide here
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        if (buffer.FaceAt(x + dx, y + dy) >= 0) return true;
      }
    }
    return false;
  };
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const float alpha = image.plane(SplatImage::kAlpha)[image.window().IndexOf(x, y)];
      if (buffer.FaceAt(x, y) >= 0) {
        ++inside;
        covered += static_cast<int>(alpha > 0.9F);
        if (alpha > 0.9F) {  // evenly lit grey
          ASSERT_NEAR(image.plane(SplatImage::kRed)[image.window().IndexOf(x, y)], 0.4 * alpha, 1e-3);
        }
      } else {
        spilt += static_cast<int>(alpha > 0.5F && !near_body(x, y));
      }
    }
  }
  EXPECT_GT(inside, 2000);
  EXPECT_GT(covered, 0.93 * inside);
  EXPECT_EQ(spilt, 0);
}

TEST(SkinGaussians, AreFlatAlongTheNormal) {
  const BodyModel& model = ToyBody();
  const GaussianBody body = SkinGaussians(model, {}, BuildUvTexelTable(model, {.width = 64, .height = 64}));
  for (int i = 0; i < body.size(); ++i) {
    const auto at = [&](int c) { return double(body.parameters(i, c)); };
    const Eigen::Quaterniond turn(at(GaussianBody::kQuaternion), at(GaussianBody::kQuaternion + 1),
                                  at(GaussianBody::kQuaternion + 2), at(GaussianBody::kQuaternion + 3));
    const Eigen::Vector3d normal(at(GaussianBody::kNormal), at(GaussianBody::kNormal + 1),
                                 at(GaussianBody::kNormal + 2));
    EXPECT_GT((turn * Eigen::Vector3d::UnitZ()).dot(normal), 1 - 1e-6);
    EXPECT_NEAR(std::exp(at(GaussianBody::kLogScale + 2) - at(GaussianBody::kLogScale)), 0.37, 1e-5);
  }
}

TEST(SkinGaussians, RefusesWhatDoesNotFit) {
  const BodyModel& model = ToyBody();
  const UvTexelTable texels = BuildUvTexelTable(model, {.width = 64, .height = 64});
  EXPECT_THROW(SkinGaussians(model, {}, texels, {.flatness = 0}), std::invalid_argument);
  UvTexelTable other = texels;
  other.face[10] = model.num_faces();
  other.in_gutter[10] = 0;
  EXPECT_THROW(SkinGaussians(model, {}, other), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::skin_gaussians_test
