// SPDX-License-Identifier: Apache-2.0
// Relights an image from one known light to another: a body in two colours, rendered with exact clamped cosines, its
// light estimated, then relit.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "render/lighting/fit_lighting.h"
#include "render/lighting/sh_lighting.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom::relight_person_test {
namespace {

using Eigen::Vector3d;

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
}  // namespace bodyloom::relight_person_test
