// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/person_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/support/short_track.h"

namespace bodyloom::person_texture_test {
namespace {

constexpr Colour kColour = {40, 90, 200};

int TexelsOf(const Image& image, const Colour& colour) {
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) count += image.at(x, y) == colour;
  }
  return count;
}

TEST(PersonTexture, APersonOfOneColourHasItEverywhereWhenFilledAndWhereSeenWhenNot) {
  const Track track = ShortTrack();
  const Image image(track.camera.width, track.camera.height, kColour);
  for (const TextureFill fill : {TextureFill::kNone, TextureFill::kPyramid, TextureFill::kLaplace}) {
    PersonTextureOptions options;
    options.size = 64;
    options.fill = fill;
    PersonTexture texture(BuiltinBody(), track, options);
    for (int t = 0; t < track.num_frames(); ++t) EXPECT_TRUE(texture.Add(t, image));
    const auto images = texture.Merge();
    ASSERT_TRUE(images);
    EXPECT_GT(images->texels_seen, 100);
    EXPECT_LT(images->texels_seen, texture.texels());
    const int coloured = TexelsOf(images->colours, kColour), unseen = TexelsOf(images->confidence, {0, 0, 0});
    EXPECT_GE(coloured, fill == TextureFill::kNone ? images->texels_seen : texture.texels());
    if (fill == TextureFill::kNone) {
      EXPECT_LT(coloured, texture.texels());
    }
    EXPECT_GE(64 * 64 - unseen, images->texels_seen / 2);  // the least confident round to 0
  }
}

TEST(PersonTexture, FramesWithoutAFitOfTheirOwnAreNotTaken) {
  Track track = ShortTrack();
  track.frame_status[1] = FrameStatus::kLost;
  track.frame_status[2] = FrameStatus::kInterpolated;
  track.frame_status[3] = FrameStatus::kWeak;
  track.motion.trans.row(4).setConstant(std::nan(""));
  const Image image(track.camera.width, track.camera.height, kColour);
  PersonTexture texture(BuiltinBody(), track, {.size = 64});
  EXPECT_FALSE(texture.Add(1, image));
  EXPECT_FALSE(texture.Add(2, image));
  EXPECT_FALSE(texture.Add(4, image));
  EXPECT_FALSE(texture.Merge());
  EXPECT_TRUE(texture.Add(3, image));
  EXPECT_TRUE(texture.Merge());
}

TEST(PersonTexture, RefusesImagesOfAnotherSizeAndBodiesWithoutUv) {
  const Track track = ShortTrack();
  PersonTexture texture(BuiltinBody(), track, {.size = 64});
  EXPECT_THROW(texture.Add(0, Image(100, 100)), std::invalid_argument);
  BodyModelData data = BuiltinBody().data();
  data.vt.resize(0, 2);
  data.ft.resize(0, 3);
  const BodyModel bare(data);
  EXPECT_THROW(PersonTexture(bare, track, {.size = 64}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::person_texture_test
