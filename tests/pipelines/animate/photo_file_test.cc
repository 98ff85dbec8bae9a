// SPDX-License-Identifier: Apache-2.0
// Photographs of every kind as `animate photo` and `animate guided` read them, and the segmentation of the tracked
// person in them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_writer.h"
#include "pipelines/animate/person_segmentation.h"
#include "pipelines/animate/read_photos.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/odd_images.h"

namespace bodyloom::photo_file_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Every pixel another colour, in blocks of eight that are one.
uint8_t BlockColour(int x, int y, int c) { return static_cast<uint8_t>(37 * x + 91 * y + 60 * c + 40); }

Image Blocks() {
  Image image(24, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 24; ++x) {
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = BlockColour(x / 8, y / 8, 2 - c);
    }
  }
  return image;
}

class PhotoFiles : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(PhotoFiles, OrdinaryOnesComeWithoutANote) {
  WriteImage(folder_.File("a.png"), Blocks());
  WriteImage(folder_.File("a.jpg"), Blocks());
  for (const char* name : {"a.png", "a.jpg"}) {
    const PhotoFile photo = ReadPhoto(folder_.File(name));
    EXPECT_THAT(photo.notes, IsEmpty());
    EXPECT_THAT(photo.alpha, IsEmpty());
    EXPECT_EQ(photo.image.width, 24);
  }
  // Opaque throughout: an alpha channel without information.
  WriteTransparentPng(folder_.File("a.png"), Blocks(), std::vector<uint8_t>(24 * 16, 255));
  EXPECT_THAT(ReadPhoto(folder_.File("a.png")).notes, IsEmpty());
  EXPECT_EQ(ReadPhoto(folder_.File("a.png")).image, Blocks());
}

TEST_F(PhotoFiles, OtherKindsAreReadAndNamed) {
  WriteGreyPng(folder_.File("grey.png"), Blocks());
  EXPECT_THAT(ReadPhoto(folder_.File("grey.png")).notes, ElementsAre(HasSubstr("grey-scale")));
  WriteBytes(folder_.File("grey.jpg"), FlatJpeg(3, 2, 1, BlockColour));
  const PhotoFile grey = ReadPhoto(folder_.File("grey.jpg"));
  EXPECT_THAT(grey.notes, ElementsAre(HasSubstr("grey-scale")));
  EXPECT_EQ(grey.image.at(20, 12).green, BlockColour(2, 1, 0));

  WriteDeepPng(folder_.File("deep.png"), Blocks());
  const PhotoFile deep = ReadPhoto(folder_.File("deep.png"));
  EXPECT_THAT(deep.notes, ElementsAre(HasSubstr("16 bits a channel")));
  EXPECT_EQ(deep.image, Blocks());

  // No black ink: the others are the colours' complements, stored inverted, so as the colours.
  WriteBytes(folder_.File("cmyk.jpg"),
             FlatJpeg(3, 2, 4, [](int x, int y, int c) { return c < 3 ? BlockColour(x, y, c) : uint8_t{255}; }));
  const PhotoFile cmyk = ReadPhoto(folder_.File("cmyk.jpg"));
  EXPECT_THAT(cmyk.notes, ElementsAre(HasSubstr("CMYK")));
  ASSERT_EQ(cmyk.image.width, 24);
  for (size_t i = 0; i < cmyk.image.bgr.size(); ++i) ASSERT_NEAR(cmyk.image.bgr[i], Blocks().bgr[i], 2) << i;

  std::vector<uint8_t> alpha(24 * 16, 255);
  alpha[0] = 0, alpha[1] = 51;
  WriteTransparentPng(folder_.File("alpha.png"), Blocks(), alpha);
  const PhotoFile cut_out = ReadPhoto(folder_.File("alpha.png"));
  EXPECT_THAT(cut_out.notes, ElementsAre(HasSubstr("transparent")));
  EXPECT_EQ(cut_out.alpha, alpha);
  EXPECT_EQ(cut_out.image.at(0, 0), (Colour{255, 255, 255}));
  EXPECT_NEAR(cut_out.image.at(1, 0).red, 0.2 * Blocks().at(1, 0).red + 0.8 * 255, 1);
  EXPECT_EQ(cut_out.image.at(2, 0), Blocks().at(2, 0));
}

TEST_F(PhotoFiles, WhatIsCutOffAnywhereIsRefused) {
  Image noise(24, 16);
  uint32_t state = 1;
  for (uint8_t& value : noise.bgr) value = static_cast<uint8_t>((state = state * 1664525 + 1013904223) >> 24);
  for (const char* name : {"a.png", "a.jpg"}) {
    const std::string path = folder_.File(name);
    WriteImage(path, noise);
    const std::string whole = ReadFileBytes(path, 1 << 20);
    for (size_t size = 0; size + 1 < whole.size(); size += size < 64 ? 1 : 29) {
      if (name[2] == 'p' && size + 12 > whole.size()) break;  // all but the end of a PNG's last mark
      WriteBytes(path, whole.substr(0, size));
      FileErrorOf(path, [&] { (void)ReadPhoto(path); });
    }
    WriteBytes(path, whole.substr(0, whole.size() / 2));
    EXPECT_THAT(FileErrorOf(path, [&] { (void)ReadPhoto(path); }), HasSubstr("ends before its image does"));
    WriteBytes(path, whole + std::string(100, '\0'));  // as phones append what moves
    EXPECT_EQ(ReadPhoto(path).image.width, 24);
  }
  WriteBytes(folder_.File("text.jpg"), "not an image at all\n");
  EXPECT_THAT(FileErrorOf("text.jpg", [&] { (void)ReadPhoto(folder_.File("text.jpg")); }),
              HasSubstr("not an image that can be decoded"));
}

TEST_F(PhotoFiles, AVideoIsDecodedOnceForAllItsFrames) {
  const std::string video = folder_.File("a.mp4"), still = folder_.File("a.png");
  {
    VideoWriter writer(video, 64, 48, 25);
    for (int t = 0; t < 9; ++t) writer.Write(Image(64, 48, {static_cast<uint8_t>(20 + 25 * t), 90, 60}));
    writer.Finish();
  }
  WriteImage(still, Blocks());
  const ImageRequest requests[] = {{video, 7}, {still, 3}, {video, 2}, {video, 7}, {video, 0}};
  const std::vector<PhotoFile> images = ReadImages(requests);
  ASSERT_EQ(images.size(), 5U);
  for (const auto& [i, t] : std::vector<std::pair<int, int>>{{0, 7}, {2, 2}, {3, 7}, {4, 0}}) {
    EXPECT_NEAR(images[i].image.at(30, 20).red, 20 + 25 * t, 6) << i;
  }
  EXPECT_EQ(images[1].image, Blocks());
  const ImageRequest beyond[] = {{video, 3}, {video, 9}};
  EXPECT_THAT(FileErrorOf(video, [&] { (void)ReadImages(beyond); }), HasSubstr("9 frames, requested frame 9"));
  const ImageRequest none[] = {{folder_.File("nothing"), 0}};
  FileErrorOf("nothing", [&] { (void)ReadImages(none); });
}

/// A speckled picture with a person, whose body is an upright oval with a coat two pixels wider, and a neighbour like
/// it `shift` pixels to the right, hidden by the person where they overlap.
struct TwoPeople {
  static constexpr int kSide = 96;
  Image image{kSide, kSide};
  std::vector<uint8_t> parts = std::vector<uint8_t>(kSide * kSide, 0), person = parts, neighbour = parts;
  explicit TwoPeople(int shift) {
    const auto inside = [](int x, int y, double centre, double grown) {
      return std::hypot((x - centre) / (13 + grown), (y - 48) / (36 + grown)) < 1;
    };
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const size_t i = size_t(y) * kSide + x;
        parts[i] = inside(x, y, 36, 0) ? (y < 24 ? 23 : 2) : 0;
        person[i] = inside(x, y, 36, 2);
        neighbour[i] = person[i] == 0 && inside(x, y, 36 + shift, 2);
        const int speckle = (x * 7 + y * 13 + x * y) % 23;
        const int bgr[3] = {person[i] != 0      ? 60
                            : neighbour[i] != 0 ? 170
                                                : 120,
                            person[i] != 0      ? 50
                            : neighbour[i] != 0 ? 60
                                                : 140,
                            person[i] != 0      ? 150
                            : neighbour[i] != 0 ? 40
                                                : 120};
        for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<uint8_t>(bgr[c] + speckle);
      }
    }
  }
};

TEST(PersonSegmentation, TheNeighbourIsNotTaken) {
  const std::vector<uint8_t> everywhere(96 * 96, 1);
  for (const int shift : {34, 29, 22, 14}) {  // apart, touching, behind, mostly hidden
    const TwoPeople two(shift);
    const PersonSegmentation segmentation = SegmentPerson(two.image, everywhere, {}, two.parts);
    int mine = 0, found = 0, taken = 0;
    for (size_t i = 0; i < two.parts.size(); ++i) {
      mine += two.person[i];
      found += segmentation.labels[i] != 0 && two.person[i] != 0;
      taken += segmentation.labels[i] != 0 && two.neighbour[i] != 0;
    }
    EXPECT_GT(found, 0.97 * mine) << shift;
    EXPECT_LT(taken, 0.02 * mine) << shift;
    EXPECT_THAT(segmentation.note, HasSubstr("GrabCut"));

    // Labels of everybody in the picture (DensePose's): the same.
    std::vector<uint8_t> labels(two.parts.size());
    for (size_t i = 0; i < labels.size(); ++i) labels[i] = two.person[i] != 0 || two.neighbour[i] != 0 ? 1 : 0;
    const std::vector<uint8_t> all = labels;
    EXPECT_GT(KeepPerson(two.parts, 96, &labels), 0.1) << shift;
    int kept = 0, others = 0, theirs = 0;
    for (size_t i = 0; i < labels.size(); ++i) {
      kept += labels[i] != 0 && two.person[i] != 0;
      others += labels[i] != 0 && two.neighbour[i] != 0;
      theirs += two.neighbour[i];
    }
    EXPECT_EQ(kept, mine) << shift;
    EXPECT_LT(others, shift > 30 ? 1 : 0.35 * theirs) << shift;
  }
  TwoPeople alone(34);
  std::vector<uint8_t> labels = alone.person;
  EXPECT_EQ(KeepPerson(alone.parts, 96, &labels), 0);
  EXPECT_EQ(labels, alone.person);
}

TEST(PersonSegmentation, EndsAtTheImage) {
  const TwoPeople two(60);
  Image window = two.image;
  std::vector<uint8_t> inside(96 * 96, 1);
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      if (x >= 28 && y >= 10) continue;  // the picture begins in the middle of the person
      inside[size_t(y) * 96 + x] = 0;
      for (int c = 0; c < 3; ++c) window.pixel(x, y)[c] = 0;
    }
  }
  const PersonSegmentation segmentation = SegmentPerson(window, inside, {}, two.parts);
  int mine = 0, found = 0, wrong = 0;
  for (size_t i = 0; i < inside.size(); ++i) {
    if (inside[i] == 0) {
      EXPECT_EQ(segmentation.labels[i], 0) << i;
    }
    mine += inside[i] != 0 && two.person[i] != 0;
    found += segmentation.labels[i] != 0 && two.person[i] != 0;
    wrong += segmentation.labels[i] != 0 && two.person[i] == 0;
  }
  EXPECT_GT(found, 0.97 * mine);
  EXPECT_LT(wrong, 0.03 * mine);
  EXPECT_THROW(SegmentPerson(window, inside, {}, std::vector<uint8_t>(96 * 96, 0)), std::invalid_argument);
}

TEST(PersonSegmentation, TransparencyCountsBeforeColours) {
  const std::vector<uint8_t> everywhere(96 * 96, 1);
  TwoPeople two(60);
  // A body too thin to learn its colours from.
  std::vector<uint8_t> thin(96 * 96, 0);
  for (int y = 20; y < 70; ++y) thin[y * 96 + 36] = thin[y * 96 + 37] = 2;
  const PersonSegmentation bare = SegmentPerson(two.image, everywhere, {}, thin);
  EXPECT_THAT(bare.note, HasSubstr("the bare body's"));
  for (size_t i = 0; i < thin.size(); ++i) ASSERT_EQ(bare.labels[i] != 0, thin[i] != 0) << i;
  std::fill(two.image.bgr.begin(), two.image.bgr.end(), 90);
  std::vector<uint8_t> alpha;
  for (const uint8_t person : two.person) alpha.push_back(person != 0 ? 255 : 0);
  const PersonSegmentation cut_out = SegmentPerson(two.image, everywhere, alpha, two.parts);
  EXPECT_THAT(cut_out.note, HasSubstr("transparency"));
  int wrong = 0;
  for (size_t i = 0; i < alpha.size(); ++i) wrong += (cut_out.labels[i] != 0) != (alpha[i] != 0);
  EXPECT_LT(wrong, 20);
}

}  // namespace
}  // namespace bodyloom::photo_file_test
