// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/photo_maps.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/photo_segmentation.h"
#include "render/uv_maps/posed_track.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"
#include "tests/support/write_iuv.h"

namespace bodyloom::photo_maps_test {
namespace {

constexpr int kSize = 96, kTexture = 64;

PhotoMapsOptions Small() {
  PhotoMapsOptions options;
  options.size = kSize;
  options.texture_size = kTexture;
  return options;
}

TEST(PhotoMaps, TexelsLieOnTheTemplate) {
  const BodyModel& body = BuiltinBody();
  UvTexelOptions options;
  options.width = options.height = kTexture;
  const UvTexelTable texels = BuildUvTexelTable(body, options);
  const std::vector<float> places = PlacesOfTexels(body, texels);
  const size_t area = size_t(kTexture) * kTexture;
  ASSERT_EQ(places.size(), 3 * area);
  std::vector<bool> shows(area, false);
  for (size_t i = 0; i < texels.size(); ++i) {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      place += double(texels.barycentric[i][corner]) *
               body.data().v_template.row(body.data().faces(texels.face[i], corner)).transpose();
    }
    const size_t at = texels.pixel[i];
    shows[at] = true;
    for (size_t a = 0; a < 3; ++a) EXPECT_NEAR(places[a * area + at], place[a], 1e-6);
  }
  for (size_t at = 0; at < area; ++at) {
    if (shows[at]) continue;
    EXPECT_EQ(places[at], 0);
  }
}

TEST(PhotoMaps, TexelsAppearAtPixelsThatShowThem) {
  const Track track = ShortTrack();
  const PhotoMaps maps(BuiltinBody(), track, Small());
  EXPECT_EQ(maps.window().width, kSize);
  EXPECT_EQ(maps.window().height, kSize);
  const std::vector<uint8_t> texel_parts = PartsOfTexels(BuiltinBody(), *maps.texels());
  const PhotoMap map = maps.At(4);
  const size_t area = size_t(kSize) * kSize, texels = size_t(kTexture) * kTexture;
  int seen = 0, compared = 0;
  std::vector<double> errors;
  for (size_t i = 0; i < texels; ++i) {
    EXPECT_EQ(map.texel_cosine[i] == 0, map.texel_pixels[i] == 0 && map.texel_pixels[texels + i] == 0);
    if (map.texel_cosine[i] == 0) continue;
    ++seen;
    ASSERT_GT(texel_parts[i], 0);
    const int x = static_cast<int>(std::lround(map.texel_pixels[i]));
    const int y = static_cast<int>(std::lround(map.texel_pixels[texels + i]));
    ASSERT_TRUE(x >= 0 && y >= 0 && x < kSize && y < kSize);
    const size_t at = size_t(y) * kSize + x;
    ASSERT_NE(map.parts[at], 0);
    if (map.parts[at] != texel_parts[i]) continue;  // a chart's boundary within half a pixel
    ++compared;
    const size_t row = i / kTexture, column = i % kTexture;
    const double u = (double(column) + 0.5) / kTexture, v = 1 - (double(row) + 0.5) / kTexture;
    errors.push_back(std::hypot(map.uv[at] - u, map.uv[area + at] - v) * kTexture);
  }
  EXPECT_GT(seen, 300);
  EXPECT_GT(compared, seen * 3 / 4);
  // Half a pixel of 96 is a texel or so of 64.
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_LT(errors[errors.size() / 2], 1.5);
}

TEST(PhotoMaps, OneViewSeesAboutHalfOfTheBodyAndTwoSeeMost) {
  const Track track = ShortTrack();
  PhotoMapsOptions options = Small();
  options.size = 256;
  const PhotoMap front = PhotoMaps(BuiltinBody(), track, options).At(0);
  options.yaw_deg.assign(track.num_frames(), 180);
  const PhotoMaps behind(BuiltinBody(), track, options);
  const PhotoMap back = behind.At(0);
  int of_body = 0, of_front = 0, of_either = 0, of_both = 0;
  const std::vector<uint8_t> parts = PartsOfTexels(BuiltinBody(), *behind.texels());
  for (size_t i = 0; i < parts.size(); ++i) {
    of_body += parts[i] != 0;
    const bool seen_in_front = front.texel_cosine[i] > 0, seen_behind = back.texel_cosine[i] > 0;
    of_front += seen_in_front;
    of_either += seen_in_front || seen_behind;
    of_both += seen_in_front && seen_behind;
  }
  EXPECT_GT(of_front, 0.2 * of_body);
  EXPECT_LT(of_front, 0.5 * of_body);
  EXPECT_GT(of_either, 1.6 * of_front);
  EXPECT_LT(of_both, 0.1 * of_front);
}

TEST(PhotoMaps, CosinesAreThoseOfTheFaces) {
  const Track track = ShortTrack();
  const PhotoMaps maps(BuiltinBody(), track, Small());
  const PhotoMap map = maps.At(4);
  const MatrixX3d vertices = PosedTrack(BuiltinBody(), track).Vertices(4);
  const MatrixX3i& faces = BuiltinBody().data().faces;
  int compared = 0, slant = 0;
  for (size_t i = 0; i < maps.texels()->size(); ++i) {
    const float cosine = map.texel_cosine[maps.texels()->pixel[i]];
    if (cosine == 0) continue;
    Eigen::Vector3d corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = vertices.row(faces(maps.texels()->face[i], k)).transpose();
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    // From anywhere on the face: a metre or more away rays hardly differ.
    EXPECT_NEAR(cosine, -normal.dot(corners[0].normalized()), 0.03);
    ++compared;
    slant += cosine < 0.5 ? 1 : 0;
  }
  EXPECT_GT(compared, 300);
  EXPECT_GT(slant, 30);
}

TEST(PhotoMaps, EstimatesOfTheBodysOwnPixelsShowWhatTheBodyShows) {
  const Track track = ShortTrack();
  const ScratchFolder scratch;
  PhotoMapsOptions options = Small();
  const PhotoMap body = PhotoMaps(BuiltinBody(), track, options).At(4);
  options.estimated =
      std::make_shared<const EstimatedPixels>(BuiltinBody(), WriteIuv(track, scratch / "iuv"), track.num_frames());
  const PhotoMap estimated = PhotoMaps(BuiltinBody(), track, options).At(4);
  const size_t area = size_t(kSize) * kSize, texels = size_t(kTexture) * kTexture;
  int pixels = 0, alike = 0;
  for (size_t i = 0; i < area; ++i) {
    if (body.parts[i] == 0 && estimated.parts[i] == 0) continue;
    ++pixels;
    alike += body.parts[i] == estimated.parts[i] &&
             std::hypot(body.uv[i] - estimated.uv[i], body.uv[area + i] - estimated.uv[area + i]) < 0.03;
  }
  EXPECT_GT(pixels, 500);
  EXPECT_GT(alike, 0.85 * pixels) << "but for which pixel is the nearest";
  int of_body = 0, of_both = 0, of_estimates = 0;
  std::vector<double> errors;
  for (size_t i = 0; i < texels; ++i) {
    const bool seen = body.texel_cosine[i] > 0, found = estimated.texel_cosine[i] > 0;
    of_body += seen ? 1 : 0;
    of_estimates += found ? 1 : 0;
    if (!seen || !found) continue;
    ++of_both;
    errors.push_back(std::hypot(body.texel_pixels[i] - estimated.texel_pixels[i],
                                body.texel_pixels[texels + i] - estimated.texel_pixels[texels + i]));
  }
  EXPECT_GT(of_both, 0.75 * of_body);
  EXPECT_LT(of_estimates, 1.6 * of_body);
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.7);
  // A photo is one picture of a folder, or a picture.
  const EstimatedPixels fifth(BuiltinBody(), scratch / "iuv", 1, 4),
      alone(BuiltinBody(), scratch / "iuv/000004.png", 1, 4);
  const PersonWindow window = PhotoMaps(BuiltinBody(), track, options).window();
  PersonWindow of_photo = window;
  of_photo.corner = {window.corner[4]};
  for (const EstimatedPixels* one : {&fifth, &alone}) {
    std::vector<float> uv(2 * area), mask(area);
    std::vector<uint8_t> parts(area, 1);
    one->BodyMaps(of_photo, 0, uv, mask, parts);
    EXPECT_EQ(uv, estimated.uv);
    EXPECT_EQ(parts, estimated.parts);
  }
  options.yaw_deg.assign(track.num_frames(), 30);
  EXPECT_THROW(PhotoMaps(BuiltinBody(), track, options), std::invalid_argument);
}

/// A chart of 8 × 8 texels, each as large as two pixels, whose middle hides behind another part.
TEST(TexelsOfPixels, AreWhereThePixelsAroundThemShowThem) {
  constexpr int kPixels = 16, kTexels = 8;
  std::vector<float> uv(2 * kPixels * kPixels);
  std::vector<uint8_t> parts(kPixels * kPixels, 5), texel_parts(kTexels * kTexels, 5);
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      uv[y * kPixels + x] = static_cast<float>((x + 0.5) / kPixels);
      uv[kPixels * kPixels + y * kPixels + x] = static_cast<float>(1 - (y + 0.5) / kPixels);
    }
  }
  for (const int at : {6 * kPixels + 6, 6 * kPixels + 7, 7 * kPixels + 6, 7 * kPixels + 7}) parts[at] = 0;
  texel_parts[0] = 4;
  const TexelPlaces places = TexelsOfPixels(uv, parts, kPixels, kPixels, texel_parts, kTexels);
  for (int r = 0; r < kTexels; ++r) {
    for (int c = 0; c < kTexels; ++c) {
      const int at = r * kTexels + c;
      if (at == 0 || (r == 3 && c == 3)) {
        EXPECT_EQ(places.seen[at], 0) << "another part's, or around nothing";
        continue;
      }
      ASSERT_EQ(places.seen[at], 1) << r << ", " << c;
      EXPECT_NEAR(places.pixels[at], 2 * c + 0.5, 1e-4);
      EXPECT_NEAR(places.pixels[kTexels * kTexels + at], 2 * r + 0.5, 1e-4);
    }
  }
  EXPECT_THROW(TexelsOfPixels(uv, parts, kPixels, kPixels, parts, kTexels), std::invalid_argument);
}

TEST(PhotoMaps, AFrameWithoutAResultShowsNothing) {
  Track track = ShortTrack();
  track.motion.poses.row(2).setConstant(std::nan(""));
  track.frame_status[2] = FrameStatus::kLost;
  const PhotoMap map = PhotoMaps(BuiltinBody(), track, Small()).At(2);
  EXPECT_THAT(map.parts, ::testing::Each(0));
  EXPECT_THAT(map.texel_cosine, ::testing::Each(0.0F));
  PhotoMapsOptions options = Small();
  options.size = 0;
  EXPECT_THROW(PhotoMaps(BuiltinBody(), track, options), std::invalid_argument);
  options = Small();
  options.texels = std::make_shared<UvTexelTable>();
  EXPECT_THROW(PhotoMaps(BuiltinBody(), track, options), std::invalid_argument);
}

/// A grey disc of radius 27 on black, whose "body" is a disc of radius 24: part 9 on the left, 15 on the right.
struct DiscPhoto {
  Image image{96, 96};
  std::vector<uint8_t> parts = std::vector<uint8_t>(96 * 96, 0), person = parts;
  DiscPhoto() {
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 96; ++x) {
        const double r = std::hypot(x - 47.5, y - 47.5);
        const size_t at = size_t(y) * 96 + x;
        if (r < 24) parts[at] = x < 48 ? 9 : 15;
        person[at] = r < 27 ? 1 : 0;
        for (int c = 0; c < 3; ++c) {
          image.pixel(x, y)[c] = static_cast<uint8_t>((r < 27 ? 180 : 30) + 7 * ((x * 5 + y * 3 + c) % 3));
        }
      }
    }
  }
};

TEST(PhotoSegmentation, FindsTheSilhouetteAroundTheBodyAndTheNearestPart) {
  const DiscPhoto photo;
  const std::vector<uint8_t> labels = LabelsFromBody(photo.image, photo.parts);
  int wrong = 0;
  for (size_t i = 0; i < labels.size(); ++i) {
    wrong += (labels[i] != 0) != (photo.person[i] != 0);
    if (labels[i] == 0) continue;
    // Left of the middle a leg, right an arm in its sleeve.
    const int x = static_cast<int>(i % 96);
    if (std::abs(x - 47.5) > 3) {
      EXPECT_EQ(labels[i], static_cast<uint8_t>(LabelOfPart(x < 48 ? 9 : 15))) << i;
    }
  }
  EXPECT_LT(wrong, 100) << "of " << labels.size();
  EXPECT_EQ(LabelsFromBody(photo.image, photo.parts), labels) << "k-means started elsewhere";
}

TEST(PhotoSegmentation, FallsBackOnTheBodyWhereColoursSayNothing) {
  DiscPhoto photo;
  std::fill(photo.image.bgr.begin(), photo.image.bgr.end(), 90);
  const std::vector<uint8_t> labels = LabelsFromBody(photo.image, photo.parts);
  int kept = 0, body = 0;
  for (size_t i = 0; i < labels.size(); ++i) {
    body += photo.parts[i] != 0;
    kept += photo.parts[i] != 0 && labels[i] != 0;
  }
  EXPECT_GE(kept, 0.7 * body);
  std::fill(photo.parts.begin(), photo.parts.end(), 0);
  EXPECT_THROW(LabelsFromBody(photo.image, photo.parts), std::invalid_argument);
}

TEST(PhotoSegmentation, TheBackgroundIsFilledAndTheRestKept) {
  const DiscPhoto photo;
  const Image filled = FilledBackground(photo.image, photo.person);
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const double r = std::hypot(x - 47.5, y - 47.5);
      if (r > 34) {
        ASSERT_EQ(filled.pixel(x, y)[1], photo.image.pixel(x, y)[1]);
      }
      if (r < 27) {
        ASSERT_LT(filled.pixel(x, y)[1], 60) << x << ", " << y;
      }
    }
  }
  EXPECT_THROW(FilledBackground(photo.image, {}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::photo_maps_test
