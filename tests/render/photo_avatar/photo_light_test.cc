// SPDX-License-Identifier: Apache-2.0
/// A body in known light, photographed by the renderer itself.
#include "render/photo_avatar/photo_person_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/body/posed_body.h"
#include "render/photo_avatar/photo_person.h"
#include "render/view/overlay.h"

namespace bodyloom::photo_light_test {
namespace {

using Eigen::Vector3d;

constexpr int kSide = 240;

/// Bright above, dark below.
struct LitPhoto {
  explicit LitPhoto(const ShLighting& light) : surface(BuiltinBody(), false, 2), image(kSide, kSide) {
    const BodyModel& body = BuiltinBody();
    Eigen::VectorXd pose = Eigen::VectorXd::Zero(3 * body.num_joints());
    pose[0] = M_PI;
    surface.Look(PoseVertices(body, {}, PoseFromAxisAngle(body, pose, {0, 0, 3})),
                 MakePinhole(kSide, kSide, 1.3 * kSide));
    std::vector<uint8_t> coverage;
    double sum = 0;
    int pixels = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const float* n = surface.NormalAt(x, y);
        coverage.push_back(n == nullptr ? 0 : 255);
        const bool below = y > kSide / 2;
        labels.push_back(static_cast<uint8_t>(n == nullptr ? PersonLabel::kBackground
                                                           : (below ? PersonLabel::kBottom : PersonLabel::kTop)));
        if (n == nullptr) continue;
        for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = below ? 60 : 150;
        sum += Shading(light, Vector3d(n[0], n[1], n[2]))[0];
        ++pixels;
      }
    }
    mean = sum / pixels;
    even = image;
    surface.Light(light, {}, coverage, &image);
  }
  LitSurface surface;
  Image image, even;
  std::vector<uint8_t> labels;
  double mean = 0;  ///< of the light's shading over the person
};

ShLighting FromTheLeft() {
  return AmbientLight(Vector3d::Constant(0.5)) + DirectionalLight({-0.8, -0.3, -0.5}, Vector3d::Constant(0.6));
}

TEST(LightOfPhoto, IsTheLightThatWasThere) {
  const LitPhoto photo(FromTheLeft());
  const PhotoLight found = LightOfPhoto(photo.image, photo.labels, photo.surface);
  ASSERT_TRUE(found.fit.IsUsable());
  double worst = 0, minimum = 10, maximum = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float* n = photo.surface.NormalAt(x, y);
      if (n == nullptr) continue;
      const Vector3d normal(n[0], n[1], n[2]);
      const double truth = Shading(FromTheLeft(), normal)[0] / photo.mean;
      worst = std::max(worst, std::abs(found.coefficients.dot(ShBasis(normal)) - truth));
      minimum = std::min(minimum, truth), maximum = std::max(maximum, truth);
    }
  }
  EXPECT_GT(maximum - minimum, 0.6) << "or there is nothing to find";
  EXPECT_LT(worst, (maximum - minimum) / 4) << "what the ridge holds at even light";
}

TEST(LightOfPhoto, TakenAwayLeavesEvenLight) {
  LitPhoto photo(FromTheLeft());
  const auto error = [&] {
    double sum = 0;
    int pixels = 0;
    for (size_t i = 0; i < photo.labels.size(); ++i) {
      if (photo.labels[i] == 0) continue;
      // The light's brightness cannot be told: colours relative to the mean one of their label.
      const double expected =
          255 * EncodePixel(photo.mean * DecodePixel(photo.even.bgr[3 * i] / 255.0, PixelEncoding::kSrgb),
                            PixelEncoding::kSrgb);
      sum += std::abs(photo.image.bgr[3 * i] - expected);
      ++pixels;
    }
    return sum / pixels;
  };
  const double before = error();
  const PhotoLight found = LightOfPhoto(photo.image, photo.labels, photo.surface);
  photo.surface.Unlight(GreyLight(found.coefficients), kPhotoShading, &photo.image);
  EXPECT_LT(error(), before / 4) << before;
}

TEST(LightOfPhoto, DarkTrousersAreNoShade) {
  const LitPhoto photo(AmbientLight(Vector3d::Constant(1)));
  const PhotoLight found = LightOfPhoto(photo.image, photo.labels, photo.surface);
  for (int y = 0; y < kSide; y += 3) {
    for (int x = 0; x < kSide; x += 3) {
      const float* n = photo.surface.NormalAt(x, y);
      if (n == nullptr) continue;
      EXPECT_NEAR(found.coefficients.dot(ShBasis({n[0], n[1], n[2]})), 1, 0.02);
    }
  }
}

TEST(LightOfPhoto, IsEvenWhereItCannotBeFound) {
  LitPhoto photo(FromTheLeft());
  std::vector<uint8_t> nobody(photo.labels.size(), 0);
  const PhotoLight none = LightOfPhoto(photo.image, nobody, photo.surface);
  EXPECT_FALSE(none.fit.IsUsable());
  EXPECT_EQ(none.coefficients, EvenLight());
  const PhotoLight dark = LightOfPhoto(Image(kSide, kSide), photo.labels, photo.surface);
  EXPECT_FALSE(dark.fit.IsUsable());
  EXPECT_EQ(dark.coefficients, EvenLight());
  nobody.pop_back();
  EXPECT_THROW(LightOfPhoto(photo.image, nobody, photo.surface), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::photo_light_test
