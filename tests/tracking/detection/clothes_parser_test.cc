// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/clothes_parser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "pipelines/photo_avatar/make_photo_person.h"
#include "render/view/overlay.h"
#include "render/view/view_camera.h"
#include "tests/support/random_image_unet.h"
#include "tests/support/short_track.h"

namespace bodyloom::clothes_parser_test {
namespace {

/// The built-in body in a picture of coloured stripes; its mask is the body's own silhouette.
class ParsedPerson {
 public:
  ParsedPerson() : body_(BodyOrBuiltin("")), track_(ShortTrack(1)) {
    rest_ = body_->data().v_template;
    vertices_ = TrackVertices(*body_, track_, 0);
    camera_ = track_.CameraAt(0);
    image_ = Image(camera_.width, camera_.height);
    for (int y = 0; y < image_.height; ++y) {
      for (int x = 0; x < image_.width; ++x) {
        uint8_t* bgr = image_.pixel(x, y);
        bgr[0] = static_cast<uint8_t>(x / 7 * 40), bgr[1] = static_cast<uint8_t>(y / 9 * 50), bgr[2] = 90;
      }
    }
    VisibilityBuffer buffer;
    buffer.Render(vertices_, body_->data().faces, camera_, {});
    for (int y = 0; y < image_.height; ++y) {
      for (int x = 0; x < image_.width; ++x) mask_.push_back(buffer.FaceAt(x, y) >= 0 ? 1 : 0);
    }
  }
  [[nodiscard]] PersonPhoto photo() const { return {&image_, mask_, body_.get(), &rest_, &vertices_, camera_}; }
  [[nodiscard]] double size() const { return PixelsPerMetre(camera_, vertices_.col(2).mean()); }
  [[nodiscard]] const std::vector<uint8_t>& mask() const { return mask_; }
  [[nodiscard]] const BodyModel& body() const { return *body_; }
  [[nodiscard]] FittedPhoto fitted() const {
    FittedPhoto photo;
    photo.image = image_, photo.track = track_;
    photo.mask = {0, 0, image_.width, image_.height, mask_};
    return photo;
  }

 private:
  std::shared_ptr<const BodyModel> body_;
  Track track_;
  MatrixX3d rest_, vertices_;
  Camera camera_;
  Image image_;
  std::vector<uint8_t> mask_;
};

ParserWeights ParserOfSize(double pixels_per_metre) {
  ParserWeights weights = RandomParser(1);
  weights.pixels_per_metre = pixels_per_metre;
  return weights;
}

TEST(ClothesParser, LayersHoldThePhotoAndTheBody) {
  const ParsedPerson person;
  const PersonPhoto photo = person.photo();
  const PersonLayers layers = ParserLayers(photo, 1);
  EXPECT_EQ(layers.planes, ParserLayers(photo, 3).planes);
  ASSERT_EQ(layers.planes.size(), kParserPlanes.in * layers.pixels());
  size_t covered = 0, body = 0;
  ForEachPixel(layers, photo.image->width, photo.image->height, [&](int x, int y, size_t i) {
    const bool inside = photo.mask[static_cast<size_t>(y) * photo.image->width + x] != 0;
    ASSERT_EQ(layers.Plane(PersonPlane::kAlpha)[i], inside ? 1 : 0);
    ASSERT_FLOAT_EQ(layers.Plane(0)[i], inside ? static_cast<float>(photo.image->pixel(x, y)[2]) / 255 : 0);
    covered += inside ? 1 : 0;
    body += layers.Plane(PersonPlane::kNormal + 2)[i] < 0 ? 1 : 0;
    ASSERT_TRUE(inside || layers.Plane(PersonPlane::kPlace + 1)[i] == 0);
  });
  EXPECT_GT(covered, 1000U);
  EXPECT_GT(body, covered * 9 / 10) << "normals towards the viewer";
  EXPECT_EQ(covered, static_cast<size_t>(std::count(person.mask().begin(), person.mask().end(), 1)));
}

TEST(ClothesParser, LabelsAreTheLargestAnswersAndColoursHaveTheLastWord) {
  const ParsedPerson person;
  const PersonPhoto photo = person.photo();
  const ParserWeights weights = ParserOfSize(person.size());
  const std::vector<uint8_t> labels = ClothesParser(weights).Labels(photo, 1);
  const PersonLayers layers = ParserLayers(photo, 1);
  const std::vector<float> answers =
      ImageUnetRunner(weights.network, kParserPlanes).Run(layers.width, layers.height, layers.planes);
  std::set<int> met;
  std::vector<uint8_t> expected(labels.size(), 0);
  ForEachPixel(layers, photo.image->width, photo.image->height, [&](int x, int y, size_t i) {
    const size_t at = static_cast<size_t>(y) * photo.image->width + x;
    if (photo.mask[at] == 0) return;
    int best = 0;
    for (int c = 1; c < kParserClasses; ++c) {
      if (answers[c * layers.pixels() + i] > answers[best * layers.pixels() + i]) best = c;
    }
    expected[at] = static_cast<uint8_t>(1 + best);
    met.insert(1 + best);
  });
  RelabelByColour(*photo.image, expected);
  ASSERT_EQ(labels, expected);
  EXPECT_GE(met.size(), 3U) << "one class everywhere says little";
  for (size_t i = 0; i < labels.size(); ++i) ASSERT_EQ(labels[i] == 0, photo.mask[i] == 0) << i;
}

TEST(ClothesParser, ALargePersonIsParsedAtTheSizeThatTheParserKnows) {
  const ParsedPerson person;
  const PersonPhoto photo = person.photo();
  const std::vector<uint8_t> labels = ClothesParser(ParserOfSize(person.size() / 2)).Labels(photo, 1);
  const std::vector<uint8_t> at_size = ClothesParser(ParserOfSize(person.size())).Labels(photo, 1);
  for (size_t i = 0; i < labels.size(); ++i) ASSERT_EQ(labels[i] == 0, photo.mask[i] == 0) << i;
  EXPECT_NE(labels, at_size);
  EXPECT_EQ(ClothesParser(ParserOfSize(2 * person.size())).Labels(photo, 1), at_size)
      << "a small person is parsed as it is";
}

TEST(ClothesParser, NobodyHasNoClothes) {
  const ParsedPerson person;
  PersonPhoto photo = person.photo();
  const std::vector<uint8_t> nobody(photo.mask.size(), 0);
  photo.mask = nobody;
  EXPECT_EQ(ClothesParser(RandomParser(1)).Labels(photo, 1), nobody);
  photo.mask = photo.mask.first(3);
  EXPECT_THROW(ClothesParser(RandomParser(1)).Labels(photo, 1), std::invalid_argument);
  EXPECT_THROW(ClothesParser{ParserWeights()}, std::invalid_argument);
}

TEST(ParsePhoto, TheNearestPixelOfTheBodyWithoutAParser) {
  const ParsedPerson person;
  FittedPhoto photo = person.fitted();
  const std::vector<uint8_t> labels = LabelsOfPhoto(photo, person.body(), nullptr, 1);
  std::set<int> met(labels.begin(), labels.end());
  for (const PersonLabel label : {PersonLabel::kTop, PersonLabel::kBottom, PersonLabel::kFace, PersonLabel::kShoes}) {
    EXPECT_EQ(met.count(static_cast<int>(label)), 1U) << static_cast<int>(label);
  }
  for (size_t i = 0; i < labels.size(); ++i) ASSERT_EQ(labels[i] == 0, person.mask()[i] == 0) << i;
  ClothesParser parser(ParserOfSize(person.size()));
  EXPECT_EQ(LabelsOfPhoto(photo, person.body(), &parser, 1), parser.Labels(person.photo(), 1));
}

TEST(ParsePhoto, RefusesBeforeItWorks) {
  PhotoParseRequest request;
  request.image = "me.jpg";
  request.out = "me.jpg";
  EXPECT_THROW(ParsePhoto(request), RequestError);
  request.out = testing::TempDir() + "labels.png";
  request.weights = "/nowhere/parser.npz";
  EXPECT_THROW(ParsePhoto(request), std::runtime_error);
}

}  // namespace
}  // namespace bodyloom::clothes_parser_test
