// SPDX-License-Identifier: Apache-2.0
#include "render/lighting/sh_lighting.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace bodyloom::relight_test {
namespace {

using Eigen::Vector3d;

/// Evenly spread over the sphere (Fibonacci).
std::vector<Vector3d> Directions(int count) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), turn = M_PI * (3 - std::sqrt(5)) * i;
    directions.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  return directions;
}

TEST(ShLighting, BasisIsOrthonormal) {
  Eigen::Matrix<double, 9, 9> gram = Eigen::Matrix<double, 9, 9>::Zero();
  const std::vector<Vector3d> directions = Directions(20000);
  for (const Vector3d& n : directions) gram += ShBasis(n) * ShBasis(n).transpose();
  gram *= 4 * M_PI / double(directions.size());
  EXPECT_LT((gram - Eigen::Matrix<double, 9, 9>::Identity()).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(ShLighting, AnEvenEnvironmentShadesEvenly) {
  const ShLighting lighting = EnvironmentLight(Image(64, 32, {255, 128, 0}), PixelEncoding::kLinear);
  for (const Vector3d& n : Directions(50)) {
    const Vector3d shading = Shading(lighting, n);
    EXPECT_NEAR(shading[0], 1, 2e-3);
    EXPECT_NEAR(shading[1], 128 / 255.0, 2e-3);
    EXPECT_NEAR(shading[2], 0, 1e-12);
    EXPECT_LT((Shading(AmbientLight({1, 0.5, 0}), n) - Vector3d(1, 0.5, 0)).norm(), 1e-12);
  }
}

TEST(ShLighting, OneLightIsAClampedCosineUpToTheKnownError) {
  const Vector3d light = Vector3d(0.3, -0.8, -0.5).normalized();
  const ShLighting lighting = DirectionalLight(7 * light, {1, 2, 0});
  double largest = 0, sum = 0;
  const std::vector<Vector3d> directions = Directions(5000);
  for (const Vector3d& n : directions) {
    const double c = n.dot(light), expected = 0.25 + 0.5 * c + 5 / 32.0 * (3 * c * c - 1);
    EXPECT_NEAR(Shading(lighting, n)[0], expected, 1e-12);  // Legendre series of max(0, c) up to order 2
    EXPECT_NEAR(Shading(lighting, n)[1], 2 * expected, 1e-12);
    largest = std::max(largest, std::abs(expected - std::max(0.0, c)));
    sum += Shading(lighting, n)[0];
  }
  EXPECT_NEAR(largest, 0.09375, 1e-3);  // at c = 0
  EXPECT_NEAR(sum / double(directions.size()), 0.25, 1e-4);
}

TEST(ShLighting, TurningLightAndNormalTogetherChangesNothing) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.4).normalized()).toRotationMatrix();
  const Vector3d a(0.2, 1, 0.1), b(-1, 0.3, 2);
  const auto both = [](const Vector3d& p, const Vector3d& q) {
    return ShLighting(DirectionalLight(p, {1, 1, 1}) + DirectionalLight(q, {0.2, 0.4, 0.6}));
  };
  for (const Vector3d& n : Directions(100)) {
    EXPECT_LT((Shading(both(a, b), n) - Shading(both(turn * a, turn * b), turn * n)).norm(), 1e-12);
  }
}

/// A small white spot of an environment is a light in its direction.
TEST(ShLighting, EnvironmentsAreTheRightWayRound) {
  const int width = 256, height = 128;
  const auto lit_at = [&](int x, int y) {
    Image image(width, height);
    for (int dy = -2; dy < 2; ++dy) {
      for (int dx = -2; dx < 2; ++dx) std::fill_n(image.pixel(x + dx, y + dy), 3, uint8_t{255});
    }
    const ShLighting lighting = EnvironmentLight(image, PixelEncoding::kSrgb);
    // The first order points to the light: coefficients of y, z, x.
    return Vector3d(lighting(0, 3), lighting(0, 1), lighting(0, 2)).normalized();
  };
  const double near = std::cos(0.03);
  EXPECT_GT(lit_at(128, 64).dot(Vector3d(0, 0, 1)), near);           // ahead of the camera
  EXPECT_GT(lit_at(192, 64).dot(Vector3d(1, 0, 0)), near);           // to the right
  EXPECT_GT(lit_at(2, 64).dot(Vector3d(0, 0, -1)), std::cos(0.06));  // behind the camera
  EXPECT_GT(lit_at(128, 2).dot(Vector3d(0, -1, 0)), std::cos(0.1));  // from above
  EXPECT_EQ(CameraFromViewer({1, 2, 3}), Vector3d(1, -2, -3));
}

TEST(ShLighting, EncodingsGoThereAndBack) {
  for (const PixelEncoding encoding : {PixelEncoding::kSrgb, PixelEncoding::kLinear}) {
    for (double v = 0; v <= 1; v += 0.01) EXPECT_NEAR(EncodePixel(DecodePixel(v, encoding), encoding), v, 1e-6);
  }
  EXPECT_NEAR(DecodePixel(0.5, PixelEncoding::kSrgb), 0.21404, 1e-5);
  EXPECT_EQ(DecodePixel(7, PixelEncoding::kSrgb), 1);
}

struct Lit {
  std::vector<float> normals, alpha, image;
};

/// Texture times shading, normals and colours multiplied by alpha.
Lit LambertImage(const ShLighting& lighting, PixelEncoding encoding) {
  const std::vector<Vector3d> directions = Directions(400);
  const size_t area = directions.size();
  Lit rendered{std::vector<float>(3 * area), std::vector<float>(area), std::vector<float>(3 * area)};
  for (size_t i = 0; i < area; ++i) {
    const float alpha = i % 3 == 0 ? 0.5F : 1.0F;
    rendered.alpha[i] = alpha;
    const Vector3d shading = Shading(lighting, directions[i]);
    for (int c = 0; c < 3; ++c) {
      rendered.normals[area * c + i] = alpha * float(directions[i][c]);
      const double albedo = 0.1 + 0.4 * double((i * 7 + c * 5) % 11) / 11;
      rendered.image[area * c + i] = alpha * float(EncodePixel(albedo * shading[c], encoding));
    }
  }
  return rendered;
}

TEST(Relight, TurnsOneLightIntoAnotherWhateverTheTexture) {
  const ShLighting old_light = AmbientLight({0.5, 0.5, 0.5}) + DirectionalLight({1, 0, -1}, {0.5, 0.5, 0.5});
  const ShLighting new_light = AmbientLight({0.4, 0.3, 0.3}) + DirectionalLight({-1, -1, 0}, {0.6, 0.5, 0.2});
  for (const PixelEncoding encoding : {PixelEncoding::kSrgb, PixelEncoding::kLinear}) {
    Lit rendered = LambertImage(old_light, encoding);
    const Lit truth = LambertImage(new_light, encoding);
    RelightOptions options;
    options.encoding = encoding;
    Relight(old_light, new_light, rendered.normals, rendered.alpha, options, rendered.image);
    for (size_t i = 0; i < rendered.image.size(); ++i) ASSERT_NEAR(rendered.image[i], truth.image[i], 2e-5) << i;
  }
}

TEST(Relight, ClampsAndLeavesAloneWhatHasNoNormal) {
  const ShLighting dark = AmbientLight({0.001, 0.001, 0.001}), bright = AmbientLight({1, 1, 1});
  RelightOptions options;
  options.encoding = PixelEncoding::kLinear;
  // Pixels: usual; short normal; no alpha.
  const std::vector<float> normals = {0, 0, 0, 0, 0, 0, -1, -0.1F, -1}, alpha = {1, 1, 0};
  const std::vector<float> before = {0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F};
  std::vector<float> image = before;
  Relight(dark, bright, normals, alpha, options, image);
  EXPECT_NEAR(image[0], 0.4, 1e-6);  // 1/0.05, cut off at 4
  EXPECT_EQ(image[1], before[1]);
  EXPECT_EQ(image[2], before[2]);
  image = before;
  Relight(bright, ShLighting::Constant(-1), normals, alpha, options, image);
  EXPECT_NEAR(image[0], 0.005, 1e-6);  // negative shading counts as 0.05
  EXPECT_THROW(Relight(dark, bright, {normals.data(), 8}, alpha, options, image), std::invalid_argument);
  options.min_shading = 0;
  EXPECT_THROW(Relight(dark, bright, normals, alpha, options, image), std::invalid_argument);
}

TEST(ShLighting, RefusesWhatIsNoLight) {
  EXPECT_THROW(DirectionalLight({0, 0, 0}, {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(DirectionalLight({NAN, 0, 0}, {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(EnvironmentLight(Image(), PixelEncoding::kSrgb), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::relight_test
