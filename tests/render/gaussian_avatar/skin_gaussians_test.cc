// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <algorithm>

#include <cmath>

#include "render/gaussian_avatar/skin_gaussians.h"

#include "geometry/math/rotation.h"
#include "render/gaussian_avatar/cloth_bones.h"
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

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Body = GaussianBody;

class ClothGaussiansTest : public ::testing::Test {
 protected:
  static LooseGarment Skirt() {
    LooseGarmentOptions options;
    options.waist_y_m = 0.09, options.length_m = 0.55, options.fullness = 0.5;
    return CutLooseGarment(ToyBody().data().v_template, ToyBody().data().faces, 0.3, options);
  }
  static Vector3d PlaceOf(const Body& body, int i) {
    return {body.parameters(i, Body::kPosition), body.parameters(i, Body::kPosition + 1),
            body.parameters(i, Body::kPosition + 2)};
  }

  const BodyModel& model_ = ToyBody();
  const Eigen::VectorXd betas_ = Eigen::VectorXd::Zero(2);
  const LooseGarment skirt_ = Skirt();
  const ClothNodes nodes_{skirt_, 0.06};
};

// Gaussians on a garment, and the bones that move them.

TEST_F(ClothGaussiansTest, LieOnTheClothEvenly) {
  ClothGaussiansOptions options;
  options.spacing_m = 0.02;
  const Body body = ClothGaussians(model_, betas_, skirt_, nodes_, options);
  EXPECT_TRUE(body.IsValid(model_.num_joints() + nodes_.size(), model_.num_faces(), nullptr));
  EXPECT_FALSE(body.IsValid(model_.num_joints(), model_.num_faces(), nullptr));
  double area = 0;
  for (Eigen::Index f = 0; f < skirt_.cloth.faces.rows(); ++f) {
    const Vector3d a = skirt_.sewn[skirt_.cloth.faces(f, 0)];
    area += 0.5 * (skirt_.sewn[skirt_.cloth.faces(f, 1)] - a).cross(skirt_.sewn[skirt_.cloth.faces(f, 2)] - a).norm();
  }
  EXPECT_NEAR(body.size(), area / 4e-4, 1);
  int upper = 0;
  for (int i = 0; i < body.size(); ++i) {
    const Vector3d place = PlaceOf(body, i);
    // Of the faces that the place lies on (on an edge there are two) one gives the normal.
    int on = 0;
    double best = -1;
    const Vector3d found(body.parameters(i, Body::kNormal), body.parameters(i, Body::kNormal + 1),
                         body.parameters(i, Body::kNormal + 2));
    for (Eigen::Index f = 0; f < skirt_.cloth.faces.rows(); ++f) {
      const Vector3d a = skirt_.sewn[skirt_.cloth.faces(f, 0)], b = skirt_.sewn[skirt_.cloth.faces(f, 1)],
                     c = skirt_.sewn[skirt_.cloth.faces(f, 2)];
      const Vector3d n = (b - a).cross(c - a);
      // Inside a face the three areas about the point add up to its own.
      const double sum = (b - place).cross(c - place).norm() + (c - place).cross(a - place).norm() +
                         (a - place).cross(b - place).norm();
      if (sum - n.norm() > 1e-8) continue;
      ++on;
      best = std::max(best, n.normalized().dot(found));
    }
    ASSERT_GE(on, 1) << i;
    ASSERT_NEAR(best, 1, 1e-6) << i;
    EXPECT_EQ(body.kinds[i], GaussianKind::kCloth);
    EXPECT_EQ(body.anchors[i].corrective_factor, 0);
    upper += place.y() > 0.09 - 0.275 * std::sqrt(0.75) ? 1 : 0;
  }
  // A cone's upper half is the narrower one.
  double upper_area = 0;
  for (Eigen::Index f = 0; f < skirt_.cloth.faces.rows() / 2; ++f) {
    const Vector3d a = skirt_.sewn[skirt_.cloth.faces(f, 0)];
    upper_area +=
        0.5 * (skirt_.sewn[skirt_.cloth.faces(f, 1)] - a).cross(skirt_.sewn[skirt_.cloth.faces(f, 2)] - a).norm();
  }
  EXPECT_NEAR(static_cast<double>(upper) / body.size(), upper_area / area, 0.03);
  options.count = 50;
  EXPECT_EQ(ClothGaussians(model_, betas_, skirt_, nodes_, options).size(), 50);
  options.spacing_m = 0;
  EXPECT_THROW(ClothGaussians(model_, betas_, skirt_, nodes_, options), std::invalid_argument);
}

TEST_F(ClothGaussiansTest, GoWithTheCloth) {
  const Body body = ClothGaussians(model_, betas_, skirt_, nodes_, {.spacing_m = 0.03});
  const BodyPose pose = RandomPose(model_, 3, 0.6, 2);
  const Matrix3d R = RotationFromAxisAngle({0.4, 1.1, -0.7}), turn = RotationFromAxisAngle({0, 0.8, 0.1});
  const Vector3d t(0.1, 0.2, 2), shift(0.5, 0, 1);
  std::vector<Vector3d> cloth;
  for (const Vector3d& v : skirt_.sewn) cloth.push_back(R * v + t);
  const std::vector<float> bones = BonesOfCloth(nodes_, nodes_.Move(cloth));
  const CameraPose camera = {turn, shift};
  AvatarFrame frame;
  const AvatarFrames frames(model_, betas_);
  frames.Make(pose, camera, 1, &frame);
  AppendBones(bones, nodes_.places(), camera, &frame);
  EXPECT_EQ(frame.num_joints(), model_.num_joints() + nodes_.size());
  CameraGaussians posed;
  PoseGaussians(body, model_.data().faces, frame, {}, &posed);
  for (int i = 0; i < body.size(); ++i) {
    const Vector3d expected = turn * (R * PlaceOf(body, i) + t) + shift;
    for (int r = 0; r < 3; ++r) ASSERT_NEAR(posed.columns(i, CameraGaussians::kX + r), expected[r], 2e-6) << i;
  }
  EXPECT_THROW(AppendBones(std::span(bones).first(5), nodes_.places(), camera, &frame), std::invalid_argument);

  // Another run's cloth in the place of this one.
  for (Vector3d& v : cloth) v.y() += 0.25;
  const std::vector<float> moved = BonesOfCloth(nodes_, nodes_.Move(cloth));
  AvatarFrame other = frame, appended;
  ReplaceLastBones(SeenBones(moved, camera), &other);
  frames.Make(pose, camera, 1, &appended);
  AppendBones(moved, nodes_.places(), camera, &appended);
  EXPECT_EQ(other.bones, appended.bones);
  EXPECT_NE(other.bones, frame.bones);
  EXPECT_THROW(SeenBones(std::span(bones).first(5), camera), std::invalid_argument);
  EXPECT_THROW(ReplaceLastBones(std::vector<float>(other.bones.size() + 12), &other), std::invalid_argument);
}

TEST_F(ClothGaussiansTest, GoWithTheRootWhereAPoseIsCorrected) {
  const BodyPose pose = RandomPose(model_, 3, 0.6, 2);
  std::vector<Vector3d> cloth;
  for (const Vector3d& v : skirt_.sewn) cloth.push_back(v + Vector3d(0, 0.1, 2));
  const std::vector<float> bones = BonesOfCloth(nodes_, nodes_.Move(cloth));
  const AvatarFrames frames(model_, betas_);
  AvatarFrame frame, corrected, whole;
  frames.Make(pose, {}, 1, &frame);
  AppendBones(bones, nodes_.places(), {}, &frame);
  // The whole scene turned, once by the camera and once by the root of the pose.
  const CameraPose camera = {RotationFromAxisAngle({0.2, -0.5, 0.3}), Vector3d(0.1, -0.2, 0.4)};
  frames.Make(pose, camera, 1, &whole);
  corrected = whole;
  AppendBones(bones, nodes_.places(), camera, &whole);
  CarryBones(frame, &corrected);
  ASSERT_EQ(corrected.bones.size(), whole.bones.size());
  for (size_t k = 0; k < whole.bones.size(); ++k) EXPECT_NEAR(corrected.bones[k], whole.bones[k], 1e-5) << k;
  EXPECT_EQ(corrected.rest_joints, whole.rest_joints);
  // A person without a garment stays as it is.
  AvatarFrame bare = whole;
  CarryBones(whole, &bare);
  EXPECT_EQ(bare.bones, whole.bones);
}

}  // namespace

}  // namespace bodyloom::skin_gaussians_test
