// SPDX-License-Identifier: Apache-2.0
/// A sphere and an open sheet, whose normals and shading are known in closed form.
#include "render/lighting/lit_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "render/view/overlay.h"
#include "tests/support/meshes.h"

namespace bodyloom::lit_surface_test {
namespace {

using Eigen::Vector3d;

constexpr int kSide = 96;

/// Without UV coordinates.
BodyModel BodyOf(const MatrixX3d& vertices, const MatrixX3i& faces) {
  return BodyModel(BodyOfMesh({vertices, faces}, {}, {}));
}

MatrixX3d Ahead(MatrixX3d vertices) {
  vertices.col(2).array() += 4;
  return vertices;
}

ShLighting SomeLight() {
  return AmbientLight(Vector3d::Constant(0.6)) + DirectionalLight({0.6, -0.5, -0.7}, {0.5, 0.4, 0.3});
}

TEST(LitSurface, ShadesAsTheClosedFormOfASphere) {
  const TestMesh mesh = UnitSphere(5);
  const BodyModel body = BodyOf(mesh.vertices, mesh.faces);
  const Camera camera = MakePinhole(kSide, kSide, 1.4 * kSide);
  LitSurface surface(body, false, 1);
  surface.Look(Ahead(mesh.vertices), camera);
  const ShLighting light = SomeLight();
  Image image(kSide, kSide, Colour{100, 140, 180});
  const std::vector<uint8_t> coverage(size_t{kSide} * kSide, 255);
  surface.Light(light, {}, coverage, &image);
  int compared = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Eigen::Vector2d ray = camera.Unproject({x + 0.5, y + 0.5});
      // |t·(ray, 1) − (0, 0, 4)| = 1
      const double a = ray.squaredNorm() + 1, root = 16 - a * 15;
      if (root < 0.3) {
        if (root < -0.5) {
          EXPECT_EQ(image.pixel(x, y)[0], 180) << "not the sphere: stays";
        }
        continue;
      }
      const double t = (4 - std::sqrt(root)) / a;
      const Vector3d shading = Shading(light, t * Vector3d(ray.x(), ray.y(), 1) - Vector3d(0, 0, 4));
      const double even[3] = {180, 140, 100};
      for (int c = 0; c < 3; ++c) {
        const double expected =
            255 * EncodePixel(DecodePixel(even[c] / 255, PixelEncoding::kSrgb) * shading[2 - c], PixelEncoding::kSrgb);
        EXPECT_NEAR(image.pixel(x, y)[c], expected, 1.5) << x << " " << y;
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 1500);
}

TEST(LitSurface, LightTakenAwayIsGivenBack) {
  const BodyModel& body = BuiltinBody();
  Eigen::VectorXd pose = Eigen::VectorXd::Zero(3 * body.num_joints());
  pose[0] = M_PI;
  const MatrixX3d vertices = PoseVertices(body, {}, PoseFromAxisAngle(body, pose, {0, 0, 3}));
  const Camera camera = MakePinhole(kSide, kSide, 1.3 * kSide);
  LitSurface surface(body, false, 2);
  surface.Look(vertices, camera);
  const Image photo(kSide, kSide, Colour{120, 90, 60});
  Image image = photo;
  const ShadingLimits limits{.minimum = 0.35, .maximum = 2};
  surface.Unlight(SomeLight(), limits, &image);
  int changed = 0;
  for (size_t i = 0; i < photo.bgr.size(); ++i) changed += std::abs(photo.bgr[i] - image.bgr[i]) > 5 ? 1 : 0;
  EXPECT_GT(changed, 1000);
  // Only what the body covers: a drawing of whole pixels.
  std::vector<uint8_t> coverage(size_t{kSide} * kSide, 0);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) coverage[size_t(y) * kSide + x] = surface.NormalAt(x, y) != nullptr ? 255 : 0;
  }
  surface.Light(SomeLight(), limits, coverage, &image);
  for (size_t i = 0; i < photo.bgr.size(); ++i) ASSERT_NEAR(photo.bgr[i], image.bgr[i], 1) << i;
}

TEST(LitSurface, TheOutlineIsShadedAsWhatIsBesideIt) {
  const TestMesh mesh = UnitSphere(5);
  const BodyModel body = BodyOf(mesh.vertices, mesh.faces);
  const Camera camera = MakePinhole(kSide, kSide, 1.4 * kSide);
  LitSurface surface(body, false, 1);
  surface.Look(Ahead(mesh.vertices), camera);
  Image image(kSide, kSide);
  std::vector<uint8_t> coverage(size_t{kSide} * kSide, 0);
  for (int y = 1; y + 1 < kSide; ++y) {
    for (int x = 1; x + 1 < kSide; ++x) {
      const bool inside = surface.NormalAt(x, y) != nullptr;
      const bool beside = surface.NormalAt(x - 1, y) != nullptr || surface.NormalAt(x + 1, y) != nullptr;
      coverage[size_t(y) * kSide + x] = inside ? 255 : (beside ? 128 : 0);
      for (int c = 0; c < 3; ++c) {
        image.pixel(x, y)[c] = static_cast<uint8_t>(200 * coverage[size_t(y) * kSide + x] / 255);
      }
    }
  }
  surface.Light(AmbientLight(Vector3d::Constant(0.25)), {}, coverage, &image);
  const double dark = 255 * EncodePixel(0.25 * DecodePixel(200 / 255.0, PixelEncoding::kSrgb), PixelEncoding::kSrgb);
  int rim = 0;
  for (size_t i = 0; i < coverage.size(); ++i) {
    if (coverage[i] == 0) {
      EXPECT_EQ(image.bgr[3 * i], 0);
      continue;
    }
    EXPECT_NEAR(image.bgr[3 * i], dark * coverage[i] / 255, 1.5);
    rim += coverage[i] == 128 ? 1 : 0;
  }
  EXPECT_GT(rim, 50);
}

TEST(LitSurface, AFaceThatLooksAwayIsLitOnItsBack) {
  MatrixX3d vertices(3, 3);
  vertices << -1, -1, 0, 1, -1, 0, 0, 1, 0;
  MatrixX3i towards(1, 3), away(1, 3);
  towards << 0, 2, 1;
  away << 0, 1, 2;
  const Camera camera = MakePinhole(kSide, kSide, kSide);
  for (const MatrixX3i& faces : {towards, away}) {
    const BodyModel body = BodyOf(vertices, faces);
    LitSurface surface(body, true, 1);
    surface.Look(Ahead(vertices), camera);
    const float* normal = surface.NormalAt(kSide / 2, kSide / 2);
    ASSERT_NE(normal, nullptr);
    EXPECT_NEAR(normal[2], -1, 1e-6) << "towards the viewer";
  }
}

TEST(LitSurface, ShadingIsCutOff) {
  const TestMesh mesh = UnitSphere(5);
  const BodyModel body = BodyOf(mesh.vertices, mesh.faces);
  LitSurface surface(body, false, 1);
  surface.Look(Ahead(mesh.vertices), MakePinhole(kSide, kSide, 1.4 * kSide));
  Image image(kSide, kSide, Colour{100, 100, 100});
  const std::vector<uint8_t> coverage(size_t{kSide} * kSide, 255);
  surface.Light(AmbientLight(Vector3d::Constant(1e-6)), {.minimum = 0.5, .maximum = 1}, coverage, &image);
  const double half = 255 * EncodePixel(0.5 * DecodePixel(100 / 255.0, PixelEncoding::kSrgb), PixelEncoding::kSrgb);
  EXPECT_NEAR(image.pixel(kSide / 2, kSide / 2)[0], half, 1);
}

TEST(LitSurface, IsTheSameForAnyThreadsAndRefusesOtherSizes) {
  const TestMesh mesh = UnitSphere(5);
  const BodyModel body = BodyOf(mesh.vertices, mesh.faces);
  std::vector<Image> images;
  const std::vector<uint8_t> coverage(size_t{kSide} * kSide, 255);
  for (const int threads : {1, 2, 5}) {
    LitSurface surface(body, true, threads);
    surface.Look(Ahead(mesh.vertices), MakePinhole(kSide, kSide, kSide));
    images.emplace_back(kSide, kSide, Colour{90, 120, 150});
    surface.Light(SomeLight(), {}, coverage, &images.back());
    EXPECT_EQ(images.back().bgr, images.front().bgr) << threads;
    Image small(kSide, kSide - 1);
    EXPECT_THROW(surface.Light(SomeLight(), {}, coverage, &small), std::invalid_argument);
    EXPECT_THROW(surface.Unlight(SomeLight(), {}, &small), std::invalid_argument);
    EXPECT_THROW(surface.Light(SomeLight(), {}, std::vector<uint8_t>(3), &images.back()), std::invalid_argument);
    EXPECT_THROW(surface.Unlight(SomeLight(), {.minimum = 0}, &images.back()), std::invalid_argument);
    EXPECT_THROW(surface.Unlight(SomeLight(), {.minimum = 2, .maximum = 1}, &images.back()), std::invalid_argument);
  }
}

}  // namespace
}  // namespace bodyloom::lit_surface_test
