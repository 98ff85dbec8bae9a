// SPDX-License-Identifier: Apache-2.0
// Completion of source maps where photos show nothing: labels, colours, distance of clothes from the body.
#include "neural/guided/source_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "render/garment/clothes_offset_map.h"
#include "tests/neural/guided/guided_toy.h"

namespace bodyloom::source_maps_test {
namespace {

constexpr int kTexels = kToyTexels * kToyTexels;
const std::vector<uint8_t> kTexelParts = ToyTexelParts();
const std::vector<PhotoFrame> kViews = ToyViews();

TexelNeighbours ToyNeighbours() { return {kToyTexels, kTexelParts, ToyTexelPlaces()}; }

TEST(CompleteEmptyTexels, TheBackIsTheFrontAndItsHeadHasHair) {
  const PhotoFrame photo = ToyPhotoFrame(1, {}, true);
  const TexelNeighbours neighbours = ToyNeighbours();
  const SourceMaps source =
      MapsOfSource(std::span(&photo, 1), {kTexelParts, {}, &neighbours}, MapCompletion::kNearest, false, {});
  EXPECT_EQ(source.texels_seen, 128);
  EXPECT_TRUE(source.virtual_images.empty());
  for (int t = 0; t < kTexels; ++t) {
    const int r = t / kToyTexels, c = t % kToyTexels;
    EXPECT_EQ(source.maps.from[t], c < 8 ? 1 : 2) << t;
    if (c < 8) continue;
    if (r < 8) {
      EXPECT_EQ(source.maps.labels[t], 4) << "hair at " << r << " " << c;
      continue;
    }
    EXPECT_EQ(source.maps.labels[t], source.maps.labels[r * kToyTexels + 15 - c]) << r << " " << c;
    if (r == 13 || r == 14) continue;  // where shirt and skin meet, the photo's own colours mix
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(source.maps.appearance[k * kTexels + t], ToyColour(1, r, 15 - c, k), 0.03) << r << " " << c;
    }
  }
}

TEST(CompleteEmptyTexels, WithoutHairTheBackOfTheHeadIsSkinOfTheFacesColour) {
  PhotoFrame photo = ToyPhotoFrame(1, {}, true);
  for (int i = 0; i < 1024; ++i) {
    if (photo.labels[i] == 4) photo.labels[i] = 3;
    if (photo.labels[i] == 5) photo.labels[i] = 1;  // no skin either
    if (photo.labels[i] != 3) continue;
    for (int k = 0; k < 3; ++k) photo.image[k * 1024 + i] = 0.25F * static_cast<float>(k + 1);
  }
  const TexelNeighbours neighbours = ToyNeighbours();
  const CoherentMaps maps =
      MapsOfSource(std::span(&photo, 1), {kTexelParts, {}, &neighbours}, MapCompletion::kNearest, false, {}).maps;
  for (int t = 0; t < kTexels / 2; ++t) {
    if (t % kToyTexels < 8) continue;
    EXPECT_EQ(maps.labels[t], 5) << t;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(maps.appearance[k * kTexels + t], 0.25 * (k + 1), 0.02) << t;
  }
}

/// As body parts stand in for a parsing: all of the head is face, and there is skin elsewhere (the toy's lowest rows,
/// blue as no head is).
PhotoFrame LabelledByParts(const ToyPose& pose) {
  PhotoFrame photo = ToyPhotoFrame(1, pose, true);
  for (int i = 0; i < 1024; ++i) {
    if (photo.labels[i] == 4) photo.labels[i] = 3;
    if (photo.labels[i] != 5) continue;
    for (int k = 0; k < 3; ++k) photo.image[k * 1024 + i] = k == 2 ? 1.0F : 0.0F;
  }
  return photo;
}

TEST(MapsOfSource, ABackOfTheHeadThatIsSeenStaysWhateverItIsCalled) {
  const TexelNeighbours neighbours = ToyNeighbours();
  const PhotoFrame photos[] = {LabelledByParts({}), LabelledByParts({2, 1, true})};
  const auto repeat = [](const PhotoFrame& frame, const PseudoImage& pseudo) {
    RenderedPerson rendered{frame.size, pseudo.image, std::vector<float>(pseudo.known.size()), pseudo.labels};
    std::copy(pseudo.known.begin(), pseudo.known.end(), rendered.alpha.begin());
    return rendered;
  };
  for (const MapCompletion completion : {MapCompletion::kNone, MapCompletion::kNearest, MapCompletion::kVirtualViews}) {
    const SourceMaps source = MapsOfSource(photos, {kTexelParts, kViews, &neighbours}, completion, false, repeat);
    EXPECT_EQ(source.texels_seen, 256) << ToText(completion);
    for (int t = 0; t < kTexels / 2; ++t) {
      if (t % kToyTexels < 8) continue;
      EXPECT_EQ(source.maps.from[t], 2) << ToText(completion) << " at " << t;
      EXPECT_EQ(source.maps.labels[t], 4) << "a parsing without hair calls it face at " << t;
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(source.maps.appearance[k * kTexels + t], ToyColour(1, t / kToyTexels, t % kToyTexels, k), 0.03);
      }
    }
  }
  // If the parsing has hair, its face labels at the side of the head are skin before the ears.
  PhotoFrame behind = ToyPhotoFrame(1, {0, 0, true}, true);
  for (int y = 10; y < 14; ++y) {
    for (int x = 12; x < 20; ++x) behind.labels[y * kToySide + x] = 3;
  }
  const CoherentMaps maps =
      MapsOfSource(std::span(&behind, 1), {kTexelParts, {}, &neighbours}, MapCompletion::kNone, false, {}).maps;
  for (int r = 0; r < 8; ++r) {
    EXPECT_EQ(maps.from[r * kToyTexels + 10], 1);
    EXPECT_EQ(maps.labels[r * kToyTexels + 10], r < 4 ? 4 : 3) << r;
  }
}

TEST(CompleteEmptyTexels, WhatIsUnseenOfTheBackOfTheHeadIsHairThatIsSeen) {
  const TexelNeighbours neighbours = ToyNeighbours();
  PhotoFrame behind = LabelledByParts({0, 0, true});
  // Of the back of the head its left half.
  for (int y = 0; y < 14; ++y) {
    for (int x = 16; x < kToySide; ++x) behind.labels[y * kToySide + x] = 0;
  }
  const PhotoFrame photos[] = {LabelledByParts({}), behind};
  const CoherentMaps maps =
      MapsOfSource(photos, {kTexelParts, {}, &neighbours}, MapCompletion::kNearest, false, {}).maps;
  int guessed = 0;
  for (int t = 0; t < kTexels / 2; ++t) {
    if (t % kToyTexels < 8) continue;
    guessed += maps.from[t] == 3 ? 1 : 0;
    EXPECT_EQ(maps.labels[t], 4) << t;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(maps.appearance[k * kTexels + t], ToyColour(1, t / kToyTexels, t % kToyTexels, k), 0.06) << t;
    }
  }
  EXPECT_EQ(guessed, 32);
}

TEST(CompleteEmptyTexels, WithoutHairTheBackOfTheHeadNeverHasTheHandsColour) {
  const TexelNeighbours neighbours = ToyNeighbours();
  const PhotoFrame photo = LabelledByParts({});
  const CoherentMaps maps =
      MapsOfSource(std::span(&photo, 1), {kTexelParts, {}, &neighbours}, MapCompletion::kNearest, false, {}).maps;
  for (int t = 0; t < kTexels / 2; ++t) {
    const int r = t / kToyTexels, c = t % kToyTexels;
    if (c < 8) continue;
    EXPECT_EQ(maps.labels[t], 5) << t;
    if (r == 2 || r == 3) continue;  // where face and what lies above it mix
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(maps.appearance[k * kTexels + t], ToyColour(1, r, 15 - c, k), 0.06) << r << " " << c;
    }
  }
}

TEST(CompleteEmptyTexels, AMapThatHoldsNothingStaysEmpty) {
  CoherentMaps maps = EmptyMaps(kToyTexels, kTexelParts);
  EXPECT_EQ(CompleteEmptyTexels(ToyNeighbours(), 1, &maps), 0);
  EXPECT_TRUE(std::all_of(maps.from.begin(), maps.from.end(), [](uint8_t from) { return from == 0; }));
  EXPECT_THROW(CompleteEmptyTexels(ToyNeighbours(), 0, &maps), std::invalid_argument);
  EXPECT_THROW(CompleteEmptyTexels({2, std::vector<uint8_t>(4, 2), std::vector<float>(12, 0.5F)}, 1, &maps),
               std::invalid_argument);
}

TEST(MapsOfSource, SaysWhatIsMissing) {
  const PhotoFrame photo = ToyPhotoFrame(1, {}, true);
  const std::span<const PhotoFrame> one(&photo, 1);
  EXPECT_THROW(MapsOfSource({}, {kTexelParts}, MapCompletion::kNone, false, {}), std::invalid_argument);
  EXPECT_THROW(MapsOfSource(one, {kTexelParts, kViews}, MapCompletion::kNearest, false, {}), std::invalid_argument);
  EXPECT_THROW(MapsOfSource(one, {kTexelParts}, MapCompletion::kVirtualViews, false, {}), std::invalid_argument);
  EXPECT_THROW(MapsOfSource(one, {kTexelParts}, MapCompletion::kNone, true, {}), std::invalid_argument);
  const SourceMaps none = MapsOfSource(one, {kTexelParts}, MapCompletion::kNone, false, {});
  EXPECT_EQ(none.texels_seen, 128);
  EXPECT_TRUE(none.maps.clothes_offset.empty());
}

TEST(MapsOfSource, ThePhotoThatSeesATexelMostFromTheFrontFillsIt) {
  PhotoFrame photos[] = {ToyPhotoFrame(1, {}, true), ToyPhotoFrame(2, {1, 1, false}, true)};
  for (int t = 0; t < kTexels; ++t) {
    if (photos[0].texel_cosine[t] == 0) continue;
    photos[0].texel_cosine[t] = 0.5F;
    photos[1].texel_cosine[t] = t % 3 == 0 ? 0.5F : t % 3 == 1 ? 0.4F : 0.6F;
  }
  // Texels without a person in the photo are not filled, however well they are seen.
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < kToySide; ++x) photos[1].labels[y * kToySide + x] = 0;
  }
  const SourceMaps source = MapsOfSource(photos, {kTexelParts}, MapCompletion::kNone, false, {});
  EXPECT_EQ(source.texels_seen, 128);
  int of_second = 0;
  for (int t = 0; t < kTexels; ++t) {
    const int r = t / kToyTexels, c = t % kToyTexels;
    if (c >= 8) continue;
    const bool second = t % 3 == 2 && r > 0;
    of_second += second ? 1 : 0;
    ASSERT_EQ(source.maps.from[t], second ? 2 : 1) << r << " " << c;
    if (r == 2 || r == 3 || r == 13 || r == 14) continue;  // where two labels' colours mix
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(source.maps.appearance[k * kTexels + t], ToyColour(second ? 2 : 1, r, c, k), 0.03) << r << " " << c;
    }
  }
  EXPECT_GT(of_second, 30);
}

TEST(MapsOfSource, WithoutGarmentsAPersonIsAPerson) {
  const PhotoFrame photo = ToyPhotoFrame(1, {}, true);
  const TexelNeighbours neighbours = ToyNeighbours();
  const CoherentMaps whole =
      MapsOfSource(std::span(&photo, 1), {kTexelParts, {}, &neighbours}, MapCompletion::kNearest, true, {}).maps;
  const CoherentMaps maps =
      MapsOfSource(std::span(&photo, 1), {kTexelParts, {}, &neighbours, {}, false}, MapCompletion::kNearest, true, {})
          .maps;
  for (int t = 0; t < kTexels; ++t) {
    EXPECT_EQ(maps.labels[t], 1) << t;
    if (whole.from[t] == 1) {
      for (int k = 0; k < 3; ++k) EXPECT_EQ(maps.appearance[k * kTexels + t], whole.appearance[k * kTexels + t]);
    }
  }
  EXPECT_EQ(maps.clothes_offset, whole.clothes_offset) << "how far clothes stand off is the silhouette's";
}

TEST(MapsOfSource, AnotherOneLendsWhatIsWornAndNothingElse) {
  const TexelNeighbours neighbours = ToyNeighbours();
  std::vector<uint8_t> lent(kTexels);
  for (int t = kTexels / 2; t < kTexels; ++t) lent[t] = 1;  // the torso
  // Of the lender the head is seen better than the person's own: it says nothing all the same.
  const PhotoFrame photos[] = {ToyPhotoFrame(1, {}, true), ToyPhotoFrame(1, {0, 0, true}, true),
                               ToyPhotoFrame(2, {1, 1, false}, true)};
  const CoherentMaps maps =
      MapsOfSource(photos, {kTexelParts, {}, &neighbours, lent}, MapCompletion::kNone, false, {}).maps;
  for (int t = 0; t < kTexels; ++t) {
    const int r = t / kToyTexels, c = t % kToyTexels;
    const int from = r < 8 ? (c < 8 ? 1 : 2) : (c < 8 ? 3 : 0);
    ASSERT_EQ(maps.from[t], from) << "of the back of the torso nobody shows what is lent: " << r << " " << c;
    if (from == 0 || r == 2 || r == 3 || r == 13 || r == 14) continue;  // where two labels' colours mix
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(maps.appearance[k * kTexels + t], ToyColour(r < 8 ? 1 : 2, r, c, k), 0.03) << r << " " << c;
    }
  }
  const std::span<const PhotoFrame> all(photos);
  EXPECT_THROW(MapsOfSource(all.first(1), {kTexelParts, {}, &neighbours, lent}, MapCompletion::kNone, false, {}),
               std::invalid_argument);
  EXPECT_THROW(
      MapsOfSource(all, {kTexelParts, {}, &neighbours, std::span(lent).first(4)}, MapCompletion::kNone, false, {}),
      std::invalid_argument);
}

/// The toy's clothes `wider` pixels wider on either side than its torso, as tall as it.
PhotoFrame InASkirt(int wider) {
  PhotoFrame frame = ToyPhotoFrame(1, {}, true);
  for (int i = 0; i < 1024; ++i) frame.labels[i] = frame.parts[i] != 0 ? 1 : 0;
  for (int y = 14; y < 26; ++y) {
    for (int x = 10 - wider; x < 22 + wider; ++x) frame.labels[y * kToySide + x] = 1;
  }
  return frame;
}

TEST(ClothesOffsetMap, IsHowFarTheyStandOff) {
  const TexelNeighbours neighbours = ToyNeighbours();
  const double diagonal = std::hypot(12, 12);
  for (const int wider : {0, 1, 4}) {
    const std::vector<float> clothes_offset = ClothesOffsetMap(InASkirt(wider), neighbours);
    ASSERT_EQ(clothes_offset.size(), size_t{kTexels});
    // A texel beside the torso's rim at half its height, on the front and, by its neighbours, on the back.
    for (const int column : {0, 7, 8, 15}) {
      EXPECT_NEAR(clothes_offset[12 * kToyTexels + column], wider / diagonal, 1e-6) << wider << " at " << column;
    }
    EXPECT_NEAR(clothes_offset[4 * kToyTexels], 0, 1e-6) << "the head is bare";
  }
  const PhotoFrame trousers = InASkirt(0);
  for (const float e : ClothesOffsetMap(trousers, neighbours)) EXPECT_EQ(e, 0);
}

TEST(ClothesOffsetMap, IsLookedUpInAnotherPose) {
  const TexelNeighbours neighbours = ToyNeighbours();
  const PhotoFrame photo = InASkirt(3);
  CoherentMaps maps =
      MapsOfSource(std::span(&photo, 1), {kTexelParts, {}, &neighbours}, MapCompletion::kNone, true, {}).maps;
  const PhotoFrame behind = ToyPhotoFrame(1, {2, 1, true}, false);
  const PseudoImage seen = LookUp(maps, behind);
  ASSERT_EQ(seen.clothes_offset.size(), 1024U);
  EXPECT_NEAR(seen.clothes_offset[21 * kToySide + 13], 3 / std::hypot(12, 12), 1e-5)
      << "also where the photo shows nothing";
  EXPECT_EQ(seen.known[21 * kToySide + 13], 0);
  EXPECT_EQ(seen.clothes_offset[0], 0);
}

TEST(ClothedBody, AgreesWithASlowTwin) {
  const PhotoFrame pose = ToyPhotoFrame(1, {2, -1, false}, false);
  std::vector<float> clothes_offset(1024);
  for (int i = 0; i < 1024; ++i) {
    if (pose.parts[i] != 0) clothes_offset[i] = static_cast<float>((i * 37) % 11) / 60;
  }
  const std::vector<float> clothed = ClothedBody(pose, clothes_offset);
  const double diagonal = std::hypot(12, 12);
  int between = 0;
  for (int p = 0; p < 1024; ++p) {
    double maximum = -100;
    for (int q = 0; q < 1024; ++q) {
      if (pose.parts[q] == 0) continue;
      const int distance = std::max(std::abs(p % kToySide - q % kToySide), std::abs(p / kToySide - q / kToySide));
      maximum = std::max(maximum, diagonal * clothes_offset[q] - distance);
    }
    const double expected = pose.parts[p] != 0 ? 1 : std::clamp(0.5 + maximum, 0.0, 1.0);
    EXPECT_NEAR(clothed[p], expected, 1e-5) << p;
    between += expected > 0 && expected < 1 ? 1 : 0;
  }
  EXPECT_GT(between, 20);
  EXPECT_THROW(ClothedBody(pose, std::vector<float>(4)), std::invalid_argument);
}

TEST(ClothedBody, ASkirtCanBeSeenFromBehindAndAtAnotherSize) {
  // Three pixels wider in the photo: three pixels wider behind, too.
  const TexelNeighbours neighbours = ToyNeighbours();
  const PhotoFrame photo = InASkirt(3);
  const CoherentMaps maps =
      MapsOfSource(std::span(&photo, 1), {kTexelParts, {}, &neighbours}, MapCompletion::kNone, true, {}).maps;
  const PseudoImage seen = LookUp(maps, ToyPhotoFrame(1, {0, 0, true}, false));
  const auto at = [&](int x, int y) { return seen.clothed[y * kToySide + x]; };
  EXPECT_EQ(at(10, 20), 1) << "the torso's last column";
  EXPECT_NEAR(at(7, 20), 0.5, 1e-4) << "the skirt's last column";
  EXPECT_EQ(at(6, 20), 0);
}

TEST(ClothesOffsetMap, OfWhatIsLentIsTheLenders) {
  const TexelNeighbours neighbours = ToyNeighbours();
  const PhotoFrame photos[] = {InASkirt(1), InASkirt(4)};
  std::vector<uint8_t> lent(kTexels);
  for (int t = kTexels / 2; t < kTexels; ++t) lent[t] = t % kToyTexels < 8 ? 1 : 0;  // the torso's front
  const std::vector<float> clothes_offset =
      MapsOfSource(photos, {kTexelParts, {}, &neighbours, lent}, MapCompletion::kNone, true, {}).maps.clothes_offset;
  const double diagonal = std::hypot(12, 12);
  EXPECT_NEAR(clothes_offset[12 * kToyTexels], 4 / diagonal, 1e-6);
  EXPECT_NEAR(clothes_offset[12 * kToyTexels + 15], 1 / diagonal, 1e-6);
}

TEST(ClothesOffsetMap, NeedsLabels) {
  const TexelNeighbours neighbours = ToyNeighbours();
  EXPECT_THROW(ClothesOffsetMap(ToyPhotoFrame(1, {}, false), neighbours), std::invalid_argument);
  PhotoFrame away = ToyPhotoFrame(1, {100, 0, false}, true);
  for (const float e : ClothesOffsetMap(away, neighbours)) EXPECT_EQ(e, 0);
}

}  // namespace
}  // namespace bodyloom::source_maps_test
