// SPDX-License-Identifier: Apache-2.0
/// A bare body of two colours, photographed by the renderer itself: the person made from the photos must equal that
/// body.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <vector>

#include "render/photo_avatar/photo_person_builder.h"

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track_edits.h"
#include "render/photo_avatar/draw_person.h"
#include "render/photo_avatar/photo_person.h"
#include "render/view/overlay.h"
#include "tests/support/short_track.h"

namespace bodyloom::photo_person_builder_test {
namespace {

using ::testing::HasSubstr;

constexpr int kSide = 320;
constexpr int kBlue = 60, kGreen = 120, kRed = 200;

/// At rest before the camera, turned about the vertical.
Track BodyInImage(double yaw) {
  Track track = FramesInOrder(ShortTrack(), std::array{0});
  track.joints.clear(), track.coco17.clear();
  track.camera = Camera();
  track.camera.width = track.camera.height = kSide;
  track.camera.fx = track.camera.fy = 1.2 * kSide;
  track.camera.cx = track.camera.cy = 0.5 * kSide;
  track.motion.betas.setZero();
  track.motion.poses.setZero();
  const Eigen::AngleAxisd root(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()));
  track.motion.poses.row(0).head<3>() = root.angle() * root.axis().transpose();
  track.motion.trans.row(0) = Eigen::RowVector3d(0, 0, 3.2);
  return track;
}

/// The bare body in one colour.
FittedPhoto Photo(double yaw) {
  PhotoPerson plain;
  plain.body = plain.bare = BodyOrBuiltin("");
  plain.texture = Image(8, 8);
  for (size_t i = 0; i < 64; ++i) {
    plain.texture.bgr[3 * i] = kBlue, plain.texture.bgr[3 * i + 1] = kGreen, plain.texture.bgr[3 * i + 2] = kRed;
  }
  FittedPhoto photo;
  photo.name = "photo.png";
  photo.image = Image(kSide, kSide);
  photo.track = BodyInImage(yaw);
  std::vector<uint8_t> coverage(size_t{kSide} * kSide, 0);
  PersonPainter(plain, 1).Draw(TrackVertices(*plain.body, photo.track, 0), photo.track.camera, &photo.image, &coverage);
  photo.mask.width = photo.mask.height = kSide;
  for (const uint8_t covered : coverage) photo.mask.labels.push_back(covered >= 128 ? 1 : 0);
  return photo;
}

PhotoPerson PersonOf(std::initializer_list<FittedPhoto> photos) {
  PhotoPersonBuilder builder(BodyOrBuiltin(""), 128);
  for (const FittedPhoto& photo : photos) builder.Add(photo);
  return builder.Finish();
}

TEST(PhotoPersonBuilder, ABareBodyWearsNothing) {
  const PhotoPerson person = PersonOf({Photo(0)});
  EXPECT_LT(std::abs(person.report.clothes_median_m), 0.006) << "a pixel is 8 mm";
  EXPECT_LT(person.report.clothes_max_m, 0.03);
  EXPECT_EQ(person.body->num_vertices(), person.bare->num_vertices());
  ASSERT_EQ(person.report.photos.size(), 1U);
  EXPECT_EQ(person.report.photos[0].image, "photo.png");
  EXPECT_GT(person.report.photos[0].rim_measured, 100);
}

TEST(PhotoPersonBuilder, OneColourStaysOneColour) {
  const PhotoPerson person = PersonOf({Photo(0)});
  const size_t texels = person.texture.bgr.size() / 3;
  int coloured = 0, far = 0;
  for (size_t p = 0; p < texels; ++p) {
    const uint8_t* source = &person.sources.bgr[3 * p];
    if (source[0] + source[1] + source[2] == 0) continue;  // nothing of the atlas
    ++coloured;
    const uint8_t* colour = &person.texture.bgr[3 * p];
    const int off = std::max({std::abs(colour[0] - kBlue), std::abs(colour[1] - kGreen), std::abs(colour[2] - kRed)});
    far += off > 8 ? 1 : 0;
  }
  EXPECT_GT(coloured, 4000);
  EXPECT_LT(far, coloured / 50) << "of " << coloured;
}

TEST(PhotoPersonBuilder, ASecondPhotoFromBehindShowsTheRest) {
  const PhotoPerson one = PersonOf({Photo(0)}), two = PersonOf({Photo(0), Photo(M_PI)});
  EXPECT_GT(one.report.seen, 0.15);
  EXPECT_GT(two.report.seen, one.report.seen + 0.1);
  EXPECT_EQ(two.tracks.size(), 2U);
  EXPECT_NEAR(two.report.seen + two.report.mirrored + two.report.behind + two.report.hair + two.report.limb_neighbour +
                  two.report.smooth_fill,
              1, 1e-9);
}

TEST(PhotoPersonBuilder, TimesItsStages) {
  StageClock clock;
  PhotoPersonBuilder builder(BodyOrBuiltin(""), 64, &clock);
  builder.Add(Photo(0));
  builder.Finish();
  clock.End();
  ASSERT_EQ(clock.seconds().size(), 3U);
  EXPECT_EQ(clock.seconds()[0].first, "clothes");
  EXPECT_EQ(clock.seconds()[1].first, "texture");
  EXPECT_EQ(clock.seconds()[2].first, "complete");
}

TEST(PhotoPersonBuilder, RefusesWhatShowsTooLittle) {
  PhotoPersonBuilder builder(BodyOrBuiltin(""), 64);
  FittedPhoto hidden = Photo(0);
  std::fill(hidden.mask.labels.begin(), hidden.mask.labels.end(), uint8_t{0});
  try {
    builder.Add(hidden);
    FAIL() << "a mask of nobody";
  } catch (const NoPersonFound& error) {
    EXPECT_THAT(error.what(), HasSubstr("photo.png: shows too little of the person"));
  }
  builder.Add(Photo(0));
  const PhotoPerson person = builder.Finish();
  EXPECT_EQ(person.tracks.size(), 1U) << "the photo after it is the first";
  EXPECT_GT(person.report.seen, 0.1);
  EXPECT_THROW(PhotoPersonBuilder(BodyOrBuiltin(""), 64).Finish(), std::invalid_argument);
}

constexpr int kWidth = 40, kHeight = 30;
constexpr int kTorso = 2, kForearm = 19, kHead = 23;
constexpr Colour kSkinColour{200, 160, 140}, kShirt{30, 40, 160};

/// A trunk from column 0 to 29, a face in the first rows; the fitted forearm is columns 30 to 34.
struct Scene {
  Scene() : image(kWidth, kHeight, kShirt) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool arm = x >= 30 && x < 35, face = y < 6;
        parts.push_back(face ? kHead : (arm ? kForearm : (x < 30 ? kTorso : 0)));
        labels.push_back(
            static_cast<uint8_t>(face ? PersonLabel::kFace : (arm ? PersonLabel::kSkin : PersonLabel::kTop)));
        if (face || arm) Paint(x, y, kSkinColour);
      }
    }
    mask.assign(parts.size(), 1);
  }
  void Paint(int x, int y, const Colour& colour) {
    uint8_t* p = image.pixel(x, y);
    p[0] = colour.blue, p[1] = colour.green, p[2] = colour.red;
  }
  [[nodiscard]] std::vector<uint8_t> Kept(int reach_px) const {
    return WithoutLimbLeaks(image, mask, labels, parts, reach_px);
  }
  static size_t At(int x, int y) { return static_cast<size_t>(y) * kWidth + x; }
  Image image;
  std::vector<uint8_t> mask, labels, parts;
};

TEST(LimbLeaks, NothingLeaksWhereTheShirtIsSeen) {
  const Scene scene;
  EXPECT_EQ(scene.Kept(8), scene.mask);
}

TEST(LimbLeaks, SkinBesideTheFittedArmIsTheArms) {
  Scene scene;
  scene.labels[Scene::At(27, 15)] = static_cast<uint8_t>(PersonLabel::kSkin);  // by its label
  scene.Paint(25, 20, {190, 150, 135});  // by its colour, though it is called a shirt
  scene.labels[Scene::At(10, 15)] = static_cast<uint8_t>(PersonLabel::kSkin);  // far away: a hole, or bare
  const std::vector<uint8_t> kept = scene.Kept(8);
  EXPECT_EQ(kept[Scene::At(27, 15)], 0);
  EXPECT_EQ(kept[Scene::At(25, 20)], 0);
  EXPECT_EQ(kept[Scene::At(10, 15)], 1);
  EXPECT_EQ(kept[Scene::At(32, 15)], 1) << "the arm itself";
  EXPECT_EQ(kept[Scene::At(29, 3)], 1) << "the face";
  size_t gone = 0;
  for (const uint8_t k : kept) gone += k == 0 ? 1 : 0;
  EXPECT_EQ(gone, 2U);
  EXPECT_EQ(scene.Kept(4)[Scene::At(25, 20)], 1) << "out of reach";
}

TEST(LimbLeaks, ABareChestIsKeptByItsColour) {
  Scene scene;
  for (int y = 6; y < kHeight; ++y) {
    for (int x = 0; x < 30; ++x) scene.Paint(x, y, {198, 158, 142});
  }
  EXPECT_EQ(scene.Kept(8), scene.mask) << "trunk and arm are of one colour";
}

TEST(LimbLeaks, WithoutAFaceLabelsDecide) {
  Scene scene;
  for (size_t i = 0; i < scene.labels.size(); ++i) {
    if (scene.parts[i] == kHead) scene.labels[i] = static_cast<uint8_t>(PersonLabel::kHair);
  }
  scene.Paint(25, 20, kSkinColour);
  EXPECT_EQ(scene.Kept(8), scene.mask);
  scene.labels[Scene::At(25, 20)] = static_cast<uint8_t>(PersonLabel::kSkin);
  EXPECT_EQ(scene.Kept(8)[Scene::At(25, 20)], 0);
}

TEST(LimbLeaks, RefusesOtherSizes) {
  Scene scene;
  scene.parts.pop_back();
  EXPECT_THROW(scene.Kept(8), std::invalid_argument);
}

using Eigen::Vector3d;

constexpr int kLitSide = 240;

/// Bright above, dark below.
struct LitPhoto {
  explicit LitPhoto(const ShLighting& light) : surface(BuiltinBody(), false, 2), image(kLitSide, kLitSide) {
    const BodyModel& body = BuiltinBody();
    Eigen::VectorXd pose = Eigen::VectorXd::Zero(3 * body.num_joints());
    pose[0] = M_PI;
    surface.Look(PoseVertices(body, {}, PoseFromAxisAngle(body, pose, {0, 0, 3})),
                 MakePinhole(kLitSide, kLitSide, 1.3 * kLitSide));
    std::vector<uint8_t> coverage;
    double sum = 0;
    int pixels = 0;
    for (int y = 0; y < kLitSide; ++y) {
      for (int x = 0; x < kLitSide; ++x) {
        const float* n = surface.NormalAt(x, y);
        coverage.push_back(n == nullptr ? 0 : 255);
        const bool below = y > kLitSide / 2;
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

// A body in known light, photographed by the renderer itself.

TEST(LightOfPhoto, IsTheLightThatWasThere) {
  const LitPhoto photo(FromTheLeft());
  const PhotoLight found = LightOfPhoto(photo.image, photo.labels, photo.surface);
  ASSERT_TRUE(found.fit.IsUsable());
  double worst = 0, minimum = 10, maximum = 0;
  for (int y = 0; y < kLitSide; ++y) {
    for (int x = 0; x < kLitSide; ++x) {
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
  for (int y = 0; y < kLitSide; y += 3) {
    for (int x = 0; x < kLitSide; x += 3) {
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
  const PhotoLight dark = LightOfPhoto(Image(kLitSide, kLitSide), photo.labels, photo.surface);
  EXPECT_FALSE(dark.fit.IsUsable());
  EXPECT_EQ(dark.coefficients, EvenLight());
  nobody.pop_back();
  EXPECT_THROW(LightOfPhoto(photo.image, nobody, photo.surface), std::invalid_argument);
}

}  // namespace

}  // namespace bodyloom::photo_person_builder_test
