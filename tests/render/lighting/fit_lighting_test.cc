// SPDX-License-Identifier: Apache-2.0
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>
#include <vector>

#include <cmath>
#include <random>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "render/lighting/fit_lighting.h"
#include "render/lighting/sh_lighting.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom::fit_lighting_test {
namespace {

using Eigen::Vector3d;

struct Pixels {
  MatrixX3d normals;
  std::vector<double> light;
  std::vector<uint8_t> labels;
};

ShVector Truth() {
  return (AmbientLight({0.4, 0, 0}) + DirectionalLight({0.6, -0.7, -0.6}, {0.5, 0, 0})).row(0).transpose();
}

/// Normals that a camera sees; label 1 only looks down, away from the light, as a skirt's lower side would.
Pixels SeenPixels(int count, double noise, double outliers, double albedo0, double albedo1) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Pixels pixels{MatrixX3d(count, 3), {}, {}};
  for (int i = 0; i < count; ++i) {
    const uint8_t label = i % 3 == 0 ? 1 : 0;
    Vector3d n;
    do {
      n = Vector3d{normal(random), normal(random), normal(random)}.normalized();
    } while (n.z() > -0.05 || (label == 1 && n.y() < -0.2));
    const double shade = Truth().dot(ShBasis(n)), albedo = label == 1 ? albedo1 : albedo0;
    double light = albedo * shade + noise * normal(random);
    if (uniform(random) < outliers) light = uniform(random) < 0.7 ? 0.3 * light : 1.5;  // cast shadows, highlights
    pixels.normals.row(i) = n;
    pixels.light.push_back(light);
    pixels.labels.push_back(label);
  }
  return pixels;
}

/// Largest difference of two shadings over what the camera sees.
double ShadingError(const ShVector& a, const ShVector& b, const MatrixX3d& normals) {
  double error = 0;
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    error = std::max(error, std::abs((a - b).dot(ShBasis(normals.row(i).transpose()))));
  }
  return error;
}

double MeanShading(const ShVector& light, const MatrixX3d& normals) {
  double sum = 0;
  for (Eigen::Index i = 0; i < normals.rows(); ++i) sum += light.dot(ShBasis(normals.row(i).transpose()));
  return sum / double(normals.rows());
}

TEST(FitLighting, RecoversTheLightExactlyWithoutNoise) {
  const Pixels pixels = SeenPixels(3000, 0, 0, 1, 1);
  const FitLightingResult result = FitLighting(pixels.normals, pixels.light);
  EXPECT_EQ(result.summary.status, FitLightingStatus::kConverged);
  EXPECT_LT(ShadingError(result.coefficients, Truth(), pixels.normals), 1e-3);
  ASSERT_EQ(result.albedo.size(), 1U);
  EXPECT_DOUBLE_EQ(result.albedo[0], 1);
}

TEST(FitLighting, RecoversTheLightUnderNoiseAndOutliers) {
  const Pixels pixels = SeenPixels(6000, 0.01, 0.2, 1, 1);
  const FitLightingResult result = FitLighting(pixels.normals, pixels.light);
  EXPECT_EQ(result.summary.status, FitLightingStatus::kConverged);
  EXPECT_LT(ShadingError(result.coefficients, Truth(), pixels.normals), 0.01);
  EXPECT_NEAR(result.summary.sigma, 0.01, 0.004);
  EXPECT_NEAR(result.summary.outlier_share, 0.2, 0.03);
  EXPECT_EQ(result.summary.negative_share, 0);
}

TEST(FitLighting, ADarkSkirtIsNotShadow) {
  const double bright = 1.3, dark = 0.3, mean = (2 * bright + dark) / 3;
  const Pixels pixels = SeenPixels(6000, 0.005, 0.1, bright, dark);
  const FitLightingResult result = FitLighting(pixels.normals, pixels.light, pixels.labels);
  EXPECT_EQ(result.summary.status, FitLightingStatus::kConverged);
  ASSERT_EQ(result.albedo.size(), 2U);
  EXPECT_NEAR(result.albedo[0], bright / mean, 0.01);
  EXPECT_NEAR(result.albedo[1], dark / mean, 0.01);
  EXPECT_NEAR((2 * result.albedo[0] + result.albedo[1]) / 3, 1, 1e-9);
  EXPECT_LT(ShadingError(result.coefficients, mean * Truth(), pixels.normals), 0.01);
  // Without labels it is.
  const FitLightingResult blind = FitLighting(pixels.normals, pixels.light);
  EXPECT_GT(ShadingError(blind.coefficients, mean * Truth(), pixels.normals), 0.1);
}

TEST(FitLighting, NotEverySampleIsNeeded) {
  const Pixels pixels = SeenPixels(6000, 0.01, 0.1, 1, 0.5);
  FitLightingOptions options;
  options.max_samples = 1500;
  const FitLightingResult result = FitLighting(pixels.normals, pixels.light, pixels.labels, options);
  EXPECT_EQ(result.summary.samples, 1500);
  EXPECT_NEAR(result.albedo[0] / result.albedo[1], 2, 0.1);
}

/// Learned normals keep near the view: what they leave open must neither fail nor run away.
TEST(FitLighting, NormalsOfANarrowRangeAreEnough) {
  Pixels pixels = SeenPixels(4000, 0, 0, 1, 1);
  for (Eigen::Index i = 0; i < pixels.normals.rows(); ++i) {
    pixels.normals(i, 2) -= 3;
    pixels.normals.row(i).normalize();
    pixels.light[i] = Truth().dot(ShBasis(pixels.normals.row(i).transpose())) + 0.01 * std::sin(double(i * i));
  }
  const FitLightingResult result = FitLighting(pixels.normals, pixels.light);
  EXPECT_LT(result.summary.spread, 1e-5);
  ASSERT_TRUE(result.summary.IsUsable()) << ToString(result.summary.status);
  EXPECT_LT(ShadingError(result.coefficients, Truth(), pixels.normals), 0.01);
  EXPECT_LT(result.coefficients.norm(), 3 * Truth().norm());
}

TEST(FitLighting, NegativeShadingIsReported) {
  Pixels pixels = SeenPixels(2000, 0, 0, 1, 1);
  const ShVector light = DirectionalLight({0, 0, -1}, {1, 0, 0}).row(0).transpose();
  // Seen from the side: light and shade.
  for (Eigen::Index i = 0; i < pixels.normals.rows(); ++i) {
    pixels.normals(i, 2) += 0.4;
    pixels.normals.row(i).normalize();
    pixels.light[i] = light.dot(ShBasis(pixels.normals.row(i).transpose()));
  }
  const FitLightingResult result = FitLighting(pixels.normals, pixels.light);
  EXPECT_TRUE(result.summary.IsUsable());
  EXPECT_GT(result.summary.negative_share, 0);
  EXPECT_LT(result.summary.min_shading, 0);
}

/// Without noise the residuals say nothing of how far the ridge may be from them: it once won, and the light was even.
TEST(FitLighting, WhatIsExactIsFoundWhateverHoldsIt) {
  Pixels pixels = SeenPixels(3000, 0, 0, 1, 1);
  const ShVector light =
      (AmbientLight({0.5, 0, 0}) + DirectionalLight({-0.8, -0.3, -0.5}, {0.6, 0, 0})).row(0).transpose();
  std::vector<uint8_t> labels(3000);
  for (Eigen::Index i = 0; i < pixels.normals.rows(); ++i) {
    labels[i] = pixels.normals(i, 1) > 0 ? 2 : 1;
    pixels.light[i] = (labels[i] == 1 ? 0.3 : 0.045) * light.dot(ShBasis(pixels.normals.row(i).transpose()));
  }
  const double mean = MeanShading(light, pixels.normals);
  const double of_even_light = ShadingError(mean * EvenLight(), light, pixels.normals);
  double before = 0;
  for (const double ridge : {1e-3, 0.01, 0.03, 0.1}) {
    const FitLightingResult result = FitLighting(pixels.normals, pixels.light, labels, {.ridge = ridge});
    ASSERT_TRUE(result.summary.IsUsable()) << ridge;
    const ShVector found = result.coefficients * mean / result.summary.mean_shading;  // brightness is as free as albedo
    const double error = ShadingError(found, light, pixels.normals);
    EXPECT_LT(error, (ridge < 0.05 ? 0.25 : 0.6) * of_even_light) << ridge;
    EXPECT_GE(error, before) << "the more it is held, the less is found";
    before = error;
  }
}

TEST(FitLighting, WhatCannotBeFittedIsAStatus) {
  Pixels pixels = SeenPixels(500, 0.01, 0, 1, 1);
  MatrixX3d same = pixels.normals;
  same.rowwise() = Eigen::RowVector3d(0, 0, -1);
  const FitLightingResult alike = FitLighting(same, pixels.light);
  EXPECT_EQ(alike.summary.status, FitLightingStatus::kNormalsTooAlike);
  EXPECT_FALSE(alike.summary.IsUsable());
  EXPECT_TRUE(alike.coefficients.isZero());

  EXPECT_EQ(FitLighting(MatrixX3d(0, 3), {}).summary.status, FitLightingStatus::kTooFewSamples);
  EXPECT_EQ(FitLighting(pixels.normals, std::vector<double>(500, 0.0)).summary.status, FitLightingStatus::kDark);
  std::vector<double> broken(500, NAN);
  const FitLightingResult none = FitLighting(pixels.normals, broken);
  EXPECT_EQ(none.summary.status, FitLightingStatus::kTooFewSamples);
  EXPECT_EQ(none.summary.left_out, 500);
  EXPECT_THROW(FitLighting(pixels.normals, std::vector<double>(499)), std::invalid_argument);
  EXPECT_THROW(FitLighting(pixels.normals, pixels.light, std::vector<uint8_t>(3)), std::invalid_argument);
}

TEST(FitLighting, DerivativesAreExact) {
  const ShadedAlbedoCost cost(ShBasis(Vector3d(0.3, -0.5, 0.8).normalized()), 0.4, 0.03);
  const ShVector coefficients = Truth();
  const double albedo = 0.7;
  const double* parameters[] = {coefficients.data(), &albedo};
  const ceres::GradientChecker checker(&cost, static_cast<const std::vector<const ceres::Manifold*>*>(nullptr),
                                       ceres::NumericDiffOptions());
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(parameters, 1e-8, &results)) << results.error_log;
}

constexpr int kSize = 160;

struct Light {
  double ambient;
  Vector3d towards;
  double strength;
  [[nodiscard]] double At(const Vector3d& n) const { return ambient + strength * std::max(0.0, n.dot(towards)); }
  [[nodiscard]] ShLighting Lighting() const {
    return AmbientLight(Vector3d::Constant(ambient)) + DirectionalLight(towards, Vector3d::Constant(strength));
  }
};

struct Scene {
  std::vector<float> normals, alpha;
  std::vector<uint8_t> labels;
};

Scene SeeBody() {
  const BodyModel& body = BuiltinBody();
  Eigen::VectorXd pose = Eigen::VectorXd::Zero(3 * body.num_joints());
  pose[0] = M_PI;  // upright in the camera frame, facing it
  const MatrixX3d vertices = PoseVertices(body, {}, PoseFromAxisAngle(body, pose, {0, 0, 3}));
  const Camera camera = MakePinhole(kSize, kSize, 1.3 * kSize);
  VisibilityBuffer buffer;
  buffer.Render(vertices, body.data().faces, camera);
  ResolveRequest request;
  request.normal = true;
  ResolvedPixels pixels;
  ResolvePixels(buffer, body, vertices, camera, request, &pixels);
  const size_t area = size_t(kSize) * kSize;
  Scene scene{std::vector<float>(3 * area), std::vector<float>(area), std::vector<uint8_t>(area)};
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      if (buffer.FaceAt(x, y) < 0) continue;
      const size_t at = size_t(y) * kSize + x, from = pixels.box.IndexOf(x, y);
      for (int c = 0; c < 3; ++c) scene.normals[area * c + at] = pixels.normal[3 * from + c];
      scene.alpha[at] = 1;
      scene.labels[at] = y > kSize / 2 ? 2 : 1;
    }
  }
  return scene;
}

Vector3d NormalOf(const Scene& scene, size_t i) {
  const size_t area = scene.alpha.size();
  return Vector3d(scene.normals[i], scene.normals[area + i], scene.normals[2 * area + i]).normalized();
}

/// Bright above, dark below, with stripes.
std::vector<float> Render(const Scene& scene, const Light& light) {
  const size_t area = scene.alpha.size();
  std::vector<float> image(3 * area);
  for (size_t i = 0; i < area; ++i) {
    if (scene.alpha[i] == 0) continue;
    const Vector3d albedo = (scene.labels[i] == 1 ? Vector3d(0.6, 0.5, 0.3) : Vector3d(0.1, 0.12, 0.2)) *
                            ((i / kSize) % 16 < 4 ? 0.8 : 1.0);
    const double shading = light.At(NormalOf(scene, i));
    for (int c = 0; c < 3; ++c) image[area * c + i] = float(EncodePixel(albedo[c] * shading, PixelEncoding::kSrgb));
  }
  return image;
}

double Psnr(const std::vector<float>& a, const std::vector<float>& b, const Scene& scene) {
  const size_t area = scene.alpha.size();
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (scene.alpha[i % area] == 0) continue;
    sum += (a[i] - b[i]) * (a[i] - b[i]);
    ++count;
  }
  return -10 * std::log10(sum / count);
}

// Relights an image from one known light to another: a body in two colours, rendered with exact clamped cosines, its
// light estimated, then relit.

TEST(RelightPerson, TheImageInOtherLightIsWhatOtherLightWouldShow) {
  const Scene scene = SeeBody();
  const Light before{0.4, Vector3d(0.7, -0.5, -0.5).normalized(), 0.6};
  const Light after{0.3, Vector3d(-0.8, -0.4, -0.4).normalized(), 0.8};
  std::vector<float> image = Render(scene, before);
  const std::vector<float> truth = Render(scene, after);
  const double unlit_db = Psnr(image, truth, scene);

  std::vector<double> luminance;
  std::vector<uint8_t> labels;
  MatrixX3d normals(Eigen::Index(scene.alpha.size()), 3);
  const size_t area = scene.alpha.size();
  double mean = 0;
  for (size_t i = 0; i < area; ++i) {
    if (scene.alpha[i] == 0) continue;
    normals.row(Eigen::Index(luminance.size())) = NormalOf(scene, i);
    double light = 0;
    for (int c = 0; c < 3; ++c) light += DecodePixel(image[area * c + i], PixelEncoding::kSrgb) / 3;
    luminance.push_back(light);
    labels.push_back(scene.labels[i]);
    mean += before.At(NormalOf(scene, i));
  }
  mean /= double(luminance.size());
  const MatrixX3d seen = normals.topRows(Eigen::Index(luminance.size()));
  const FitLightingResult fit = FitLighting(seen, luminance, labels);
  ASSERT_TRUE(fit.summary.IsUsable()) << ToString(fit.summary.status);
  // The picture does not determine the light's brightness: taken from the truth, as a user sets it by eye.
  const ShLighting old_light = mean / fit.summary.mean_shading * Vector3d::Ones() * fit.coefficients.transpose();
  Relight(old_light, after.Lighting(), scene.normals, scene.alpha, {}, image);
  const double relit_db = Psnr(image, truth, scene);
  RecordProperty("unlit_db", std::to_string(unlit_db));
  RecordProperty("relit_db", std::to_string(relit_db));
  EXPECT_GT(relit_db, 28) << "not relit: " << unlit_db;
  EXPECT_LT(unlit_db, relit_db - 8);
}

}  // namespace

}  // namespace bodyloom::fit_lighting_test
