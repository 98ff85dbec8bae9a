// SPDX-License-Identifier: Apache-2.0
// Derivatives of posing against automatic ones of the twin, which are checked against differences; then the full
// backward pass from an image to all trained parameters.
#include "render/gaussian_avatar/pose_gradient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "render/splat/project_gaussians.h"
#include "render/splat/splat_gradient.h"
#include "tests/render/gaussian_avatar/person_scene.h"
#include "tests/render/splat/same_bytes.h"

namespace bodyloom::pose_gradient_test {
namespace {

using Body = GaussianBody;
using Posed = CameraGaussians;
using Jet = ceres::Jet<double, 1>;

FloatColumns PosedWeights(int rows, uint32_t seed = 3) {
  FloatColumns weights(Posed::kNumColumns, rows);
  std::mt19937 generator(seed);
  for (int c = 0; c < weights.columns(); ++c) {
    const float scale = c >= Posed::kFactor && c < Posed::kOpacity ? 20.0F : 1.0F;
    for (float& w : weights.values(c)) w = scale * static_cast<float>(generator() / 2147483648.0 - 1);
  }
  return weights;
}

AvatarGradient Gradient(const PersonScene& scene, const FloatColumns& weights, int threads = 1) {
  PoseGaussiansOptions options = scene.options;
  options.num_threads = threads;
  PoseGradient pose_gradient;
  AvatarGradient gradient;
  pose_gradient.Compute(scene.body, scene.faces, scene.frame, options, weights, &gradient);
  return gradient;
}

template <class T>
T Loss(const PersonScene& scene, const TwinPerson<T>& person, const FloatColumns& weights, int i) {
  const auto row = ColumnsOf(scene.TwinRow(person, i));
  T sum(0);
  for (int c = 0; c < Posed::kNumColumns; ++c) sum += T(double(weights(i, c))) * row[c];
  return sum;
}

template <class T>
T Loss(const PersonScene& scene, const TwinPerson<T>& person, const FloatColumns& weights) {
  T sum(0);
  for (int i = 0; i < scene.body.size(); ++i) sum += Loss(scene, person, weights, i);
  return sum;
}

/// Compares `ours` with the automatic derivative, and that with a central difference, by the number that `pick` names.
struct Comparison {
  const PersonScene& scene;
  std::function<Jet(const TwinPerson<Jet>&)> automatic_loss;
  std::function<double(const TwinPerson<double>&)> loss;
  TwinPerson<Jet> jets = scene.Twin<Jet>();
  TwinPerson<double> numbers = scene.Twin<double>();
  int compared = 0;

  template <class Pick>
  void Expect(double ours, const Pick& pick, double scale, double tolerance, const std::string& what) {
    pick(jets).v[0] = 1;
    const double automatic = automatic_loss(jets).v[0];
    pick(jets).v[0] = 0;
    const double step = 1e-6, at = pick(numbers);
    pick(numbers) = at + step;
    const double above = loss(numbers);
    pick(numbers) = at - step;
    const double below = loss(numbers);
    pick(numbers) = at;
    scale = std::max(scale, std::abs(automatic));
    EXPECT_NEAR(automatic, (above - below) / (2 * step), 1e-6 * scale + 1e-8) << what;
    EXPECT_NEAR(ours, automatic, tolerance * scale) << what;
    compared += static_cast<int>(std::abs(automatic) > 1e-3 * scale);
  }
};

TEST(PoseGradient, OfEveryParameterIsThatOfTheTwin) {
  const PersonScene scene(37);
  const FloatColumns weights = PosedWeights(scene.body.size());
  const AvatarGradient gradient = Gradient(scene, weights);
  int compared = 0;
  for (int i = 0; i < scene.body.size(); ++i) {
    Comparison comparison{scene, [&](const auto& p) { return Loss(scene, p, weights, i); },
                          [&](const auto& p) { return Loss(scene, p, weights, i); }};
    for (int c = 0; c < Body::kNumParameters; ++c) {
      comparison.Expect(
          gradient.parameters(i, c), [&](auto& p) -> auto& { return p.rows[i][c]; }, 0.1, 1e-5,
          "row " + std::to_string(i) + ", parameter " + std::to_string(c));
    }
    compared += comparison.compared;
  }
  EXPECT_GT(compared, 37 * 20);
}

TEST(PoseGradient, OfLightAndBonesIsThatOfTheTwin) {
  const PersonScene scene(37);
  const FloatColumns weights = PosedWeights(scene.body.size());
  const AvatarGradient gradient = Gradient(scene, weights);
  Comparison comparison{scene, [&](const auto& p) { return Loss(scene, p, weights); },
                        [&](const auto& p) { return Loss(scene, p, weights); }};
  for (int k = 0; k < Body::kLightValues; ++k) {
    comparison.Expect(
        gradient.light[k], [&](auto& p) -> auto& { return p.light[k]; }, 1, 1e-5, "light " + std::to_string(k));
  }
  for (int j = 0; j < scene.frame.num_joints(); ++j) {
    for (int k = 0; k < 12; ++k) {
      comparison.Expect(
          gradient.bones[12 * j + k], [&](auto& p) -> auto& { return p.bones[j][k]; }, 1, 1e-5,
          "joint " + std::to_string(j) + ", " + std::to_string(k));
    }
  }
  EXPECT_GT(comparison.compared, 27 + 24 * 12 - 20);
}

TEST(PoseGradient, SameBytesEverywhere) {
  const PersonScene scene(3001);
  const FloatColumns weights = PosedWeights(scene.body.size());
  ExpectSameBytesEverywhere(
      [&](int threads, FloatColumns* out) { *out = Gradient(scene, weights, threads).parameters; });
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* out) {
    const AvatarGradient gradient = Gradient(scene, weights, threads);
    std::vector<float> all(gradient.light.begin(), gradient.light.end());
    all.insert(all.end(), gradient.bones.begin(), gradient.bones.end());
    *out = FloatColumns(1, static_cast<int>(all.size()));
    std::copy(all.begin(), all.end(), out->column(0));
  });
}

TEST(PoseGradient, ARowThatNothingReachesGivesNothing) {
  PersonScene scene(40);
  FloatColumns weights = PosedWeights(40);
  for (const int row : {5, 39}) {
    for (int c = 0; c < Posed::kNumColumns; ++c) weights(row, c) = 0;
  }
  const AvatarGradient before = Gradient(scene, weights);
  for (int c = 0; c < Body::kNumParameters; ++c) {
    scene.body.parameters(5, c) = std::numeric_limits<float>::quiet_NaN();
    scene.body.parameters(39, c) = INFINITY;
    scene.body.parameters.column(c)[40] = std::numeric_limits<float>::quiet_NaN();  // a spare row
  }
  const AvatarGradient after = Gradient(scene, weights);
  EXPECT_TRUE(SameBytes(before.parameters, after.parameters));
  EXPECT_EQ(before.light, after.light);
  EXPECT_EQ(before.bones, after.bones);
  for (int c = 0; c < Body::kNumParameters; ++c) EXPECT_EQ(after.parameters(5, c), 0);
}

TEST(PoseGradient, TheWholeWayFromTheImageToTheBones) {
  // Posing, projection, picture and back, along random directions of everything that can be learned.
  PersonScene scene(60, 5);
  const Camera camera = MakePinhole(72, 72, 80);
  const PixelBox window{0, 0, 72, 72};
  CameraGaussians posed;
  ScreenGaussians screen;
  SplatImage image;
  scene.Pose(&posed);
  ProjectGaussians(posed, camera, {}, &screen);
  image.Draw(screen, window, {.stop_transmittance = 0});

  const auto draw = [&](const auto& person) {
    using T = std::decay_t<decltype(person.light[0])>;
    std::vector<TwinSplat<T>> splats;
    splats.reserve(static_cast<size_t>(scene.body.size()));
    for (int i = 0; i < scene.body.size(); ++i) {
      splats.push_back(TwinProject(scene.TwinRow(person, i), camera, double(0.2F)));
    }
    return TwinDraw(splats, window, 0, 5e-3);
  };
  FloatColumns weights(4, static_cast<int>(window.area()));
  std::mt19937 generator(4);
  const auto uniform = [&] { return generator() / 2147483648.0 - 1; };
  const auto twin = draw(scene.Twin<double>());
  int used = 0;
  for (int i = 0; i < weights.rows(); ++i) {
    if (twin.marginal[i]) continue;
    used += static_cast<int>(twin.planes[3][i] > 0.05);
    for (int p = 0; p < 4; ++p) weights(i, p) = static_cast<float>(uniform());
  }
  EXPECT_GT(used, 200);
  const auto loss = [&](const auto& person) {
    const auto seen = draw(person);
    std::decay_t<decltype(person.light[0])> sum(0);
    for (int p = 0; p < 4; ++p) {
      for (int i = 0; i < weights.rows(); ++i) sum += double(weights(i, p)) * seen.planes[p][i];
    }
    return sum;
  };

  SplatGradient splat_gradient;
  FloatColumns by_screen, by_posed;
  splat_gradient.Compute(image, screen, weights, 1, &by_screen);
  ProjectGaussiansBackward(posed, screen, by_screen, camera, {}, &by_posed);
  const AvatarGradient gradient = Gradient(scene, by_posed);

  for (int direction = 0; direction < 12; ++direction) {
    TwinPerson<Jet> jets = scene.Twin<Jet>();
    TwinPerson<double> above = scene.Twin<double>(), below = above;
    double ours = 0;
    const double step = 1e-6;
    const auto move = [&](auto pick, double derivative, double by) {
      pick(jets).v[0] = by;
      pick(above) += step * by, pick(below) -= step * by;
      ours += derivative * by;
    };
    for (int i = 0; i < scene.body.size(); ++i) {
      for (int c = 0; c < Body::kNumParameters; ++c) {
        if (direction % 4 == 1 && c >= 3) continue;  // places alone
        move(
            [&](auto& p) -> auto& { return p.rows[i][c]; }, gradient.parameters(i, c),
            (c < 3 ? 0.02 : 0.3) * uniform());
      }
    }
    if (direction % 2 == 0) {
      for (int k = 0; k < Body::kLightValues; ++k) {
        move(
            [&](auto& p) -> auto& { return p.light[k]; }, gradient.light[k], uniform());
      }
      for (int j = 0; j < scene.frame.num_joints(); ++j) {
        for (int k = 0; k < 12; ++k) {
          move(
              [&](auto& p) -> auto& { return p.bones[j][k]; }, gradient.bones[12 * j + k], 0.02 * uniform());
        }
      }
    }
    const double automatic = loss(jets).v[0];
    EXPECT_NEAR(automatic, (loss(above) - loss(below)) / (2 * step), 1e-5 * (1 + std::abs(automatic))) << direction;
    EXPECT_NEAR(ours, automatic, 2e-4 * (1 + std::abs(automatic))) << direction;
    EXPECT_GT(std::abs(automatic), 0.01);
  }
}

TEST(PoseGradient, RefusesWhatDoesNotFit) {
  const PersonScene scene(20);
  EXPECT_THROW(Gradient(scene, FloatColumns(Posed::kNumColumns, 19)), std::invalid_argument);
  EXPECT_THROW(Gradient(scene, FloatColumns(15, 20)), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::pose_gradient_test
