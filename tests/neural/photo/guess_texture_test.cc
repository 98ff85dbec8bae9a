// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/partial_texture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "geometry/base/hash_random.h"
#include "neural/photo/photo_model.h"
#include "neural/photo/photo_renderer.h"
#include "neural/photo/photo_tensors.h"
#include "neural/training/checkpoint.h"
#include "tests/neural/photo/toy_photo_training.h"

namespace bodyloom::guess_texture_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr uint8_t kTorsoBack = 1, kTorsoFront = 2, kFootLeft = 5, kUpperArmLeft = 15, kUpperArmRight = 16, kHead = 23;

/// One texel of a hand-made atlas.
struct Texel {
  uint8_t part;
  std::array<float, 3> place;
  std::array<float, 3> colour;
  bool visible;
  uint8_t label = 1;
};

/// A square atlas of them; the rest of it is empty.
struct Atlas {
  explicit Atlas(const std::vector<Texel>& texels) {
    while (static_cast<size_t>(size) * size < texels.size()) ++size;
    const size_t area = static_cast<size_t>(size) * size;
    parts.assign(area, 0);
    places.assign(3 * area, 0);
    texture.size = size;
    texture.visible.assign(area, 0);
    texture.colour.assign(3 * area, 0);
    texture.labels.assign(area, 0);
    texture.cosine.assign(area, 0);
    for (size_t k = 0; k < texels.size(); ++k) {
      parts[k] = texels[k].part;
      texture.visible[k] = texels[k].visible ? 1 : 0;
      texture.labels[k] = texels[k].visible ? texels[k].label : 0;
      texture.cosine[k] = texels[k].visible ? 1.0F : 0.0F;
      for (size_t c = 0; c < 3; ++c) {
        places[c * area + k] = texels[k].place[c];
        if (texels[k].visible) texture.colour[c * area + k] = texels[k].colour[c];
      }
    }
  }
  [[nodiscard]] std::array<float, 3> Colour(size_t k) const {
    const size_t area = parts.size();
    return {texture.colour[k], texture.colour[area + k], texture.colour[2 * area + k]};
  }

  int size = 1;
  std::vector<uint8_t> parts;
  std::vector<float> places;
  PartialTexture texture;
};

constexpr std::array<float, 3> kRed = {1, 0, 0}, kGreen = {0, 1, 0}, kBlue = {0, 0, 1}, kWhite = {1, 1, 1},
                               kBlack = {0, 0, 0};

TEST(GuessTexture, LooksOnTheOtherSideAtTheSameHeight) {
  // A person of 1.8 m from −0.8 to 0.8: shirt red above and green below, one blue sleeve, a white face, black hair.
  Atlas atlas({{kTorsoFront, {0.1F, 1.3F, 0.1F}, kRed, true},
               {kTorsoFront, {0.1F, 1.0F, 0.1F}, kGreen, true},
               {kUpperArmLeft, {0.5F, 1.4F, 0}, kBlue, true},
               {kHead, {0.02F, 1.7F, 0.12F}, kWhite, true},
               {kHead, {0.02F, 1.7F, -0.02F}, kBlack, true},
               {kTorsoBack, {0.1F, 1.3F, -0.1F}, kBlack, false},
               {kTorsoBack, {-0.1F, 1.0F, -0.1F}, kBlack, false},
               {kUpperArmRight, {-0.5F, 1.4F, 0}, kBlack, false},
               {kHead, {-0.02F, 1.7F, -0.04F}, kBlack, false},
               {kUpperArmRight, {-0.8F, 1.4F, 0}, kBlack, false},
               {kUpperArmLeft, {0.8F, 1.4F, 0}, kBlack, false},
               {kFootLeft, {0.1F, 0, 0}, kBlack, false}});
  const PartialTexture before = atlas.texture;
  GuessTexture({atlas.size, atlas.parts, atlas.places}, &atlas.texture);
  EXPECT_EQ(atlas.Colour(5), kRed) << "the back, beside red";
  EXPECT_EQ(atlas.Colour(6), kGreen) << "the back's other side, beside green";
  EXPECT_EQ(atlas.Colour(7), kBlue) << "the other sleeve";
  EXPECT_EQ(atlas.Colour(8), kBlack) << "the back of the head: hair, no face";
  EXPECT_EQ(atlas.Colour(9), kBlue) << "farther down the arm, no other limb";
  const std::array<float, 3> foot = atlas.Colour(11);
  EXPECT_THAT(foot, ::testing::Each(::testing::FloatNear(0.4F, 1e-6))) << "nothing of a foot: the mean of all five";
  for (size_t k = 0; k < atlas.parts.size(); ++k) {
    EXPECT_EQ(atlas.texture.guessed[k], atlas.parts[k] != 0 && before.visible[k] == 0) << k;
  }
  EXPECT_EQ(atlas.texture.visible, before.visible);
  for (size_t i = 0; i < before.colour.size(); ++i) {
    if (atlas.texture.guessed[i % atlas.parts.size()] != 0) continue;
    EXPECT_EQ(atlas.texture.colour[i], before.colour[i]) << i;
  }
}

TEST(GuessTexture, StaysWithinAGarmentAndHairIsNoFace) {
  constexpr uint8_t kTop = 1, kBottom = 2, kFace = 3, kHair = 4;
  // A belt between a red shirt and green trousers, all within the smallest cells; a white face and black hair.
  Atlas atlas({{kTorsoFront, {0.1F, 1.003F, 0.1F}, kRed, true, kTop},
               {kTorsoFront, {0.1F, 1.002F, 0.1F}, kGreen, true, kBottom},
               {kTorsoFront, {0.101F, 1.001F, 0.1F}, kGreen, true, kBottom},
               {kHead, {0.02F, 1.7F, 0.12F}, kWhite, true, kFace},
               {kHead, {0.02F, 1.7F, -0.01F}, kWhite, true, kFace},
               {kHead, {0.02F, 1.7F, 0.0F}, kWhite, true, kFace},
               {kHead, {0.02F, 1.79F, 0.0F}, kBlack, true, kHair},
               {kTorsoBack, {0.1F, 1.002F, -0.1F}, kBlue, false},
               {kHead, {-0.02F, 1.7F, -0.01F}, kBlue, false},
               {kHead, {-0.02F, 1.7F, 0.12F}, kBlue, false},
               {kFootLeft, {0.1F, 0, 0}, kBlue, false},
               {kFootLeft, {0.8F, 0, -0.14F}, kBlue, false},
               {kHead, {0.0F, 1.75F, -0.12F}, kBlue, false}});
  const PartialTexture before = atlas.texture;
  GuessTexture({atlas.size, atlas.parts, atlas.places}, &atlas.texture);
  EXPECT_EQ(atlas.Colour(7), kGreen) << "two of three are trousers";
  EXPECT_EQ(atlas.Colour(8), kBlack) << "the back of the head is hair, however near the cheek is";
  EXPECT_EQ(atlas.Colour(9), kWhite) << "the face's other half";
  EXPECT_EQ(atlas.Colour(12), kBlack);
  const std::array<float, 3> foot = atlas.Colour(10);
  EXPECT_TRUE(foot == kWhite || foot == kGreen || foot == kRed || foot == kBlack) << "no mixture";
  EXPECT_EQ(atlas.texture.labels, before.labels) << "guesses are not shown";
}

TEST(GuessTexture, ABackOfTheHeadThatIsCalledFaceIsHair) {
  constexpr uint8_t kFace = 3, kSkin = 5;
  // As body parts stand in for a parsing: a white face, black hair behind called face as well, a red hand.
  Atlas atlas({{kHead, {0.02F, 1.7F, 0.12F}, kWhite, true, kFace},
               {kHead, {0.02F, 1.7F, 0.02F}, kWhite, true, kFace},
               {kHead, {0.02F, 1.79F, -0.12F}, kBlack, true, kFace},
               {kUpperArmLeft, {0.8F, 1.4F, 0}, kRed, true, kSkin},
               {kHead, {0.02F, 1.7F, -0.01F}, kBlue, false},
               {kTorsoFront, {0.1F, 0, 0}, kBlue, false}});
  GuessTexture({atlas.size, atlas.parts, atlas.places}, &atlas.texture);
  EXPECT_EQ(atlas.Colour(4), kBlack) << "hair, though a cheek is nearer";
}

TEST(GuessTexture, AgreesWithASlowTwin) {
  uint64_t state = 5;
  const auto random = [&] { return UniformOf(state = Mix(state)); };
  const uint8_t parts[] = {1, 2, 3, 4, 7, 10, 15, 22, 23, 24};
  std::vector<Texel> texels;
  for (int i = 0; i < 300; ++i) {
    Texel texel{};
    texel.part = parts[static_cast<int>(random() * 10)];
    for (float& x : texel.place) x = static_cast<float>(2 * random() - 1);
    for (float& c : texel.colour) c = static_cast<float>(random());
    texel.visible = random() < 0.1;
    texel.label = random() < 0.5 ? 1 : random() < 0.5 ? 2 : 6;
    texels.push_back(texel);
  }
  Atlas atlas(texels);
  GuessTexture({atlas.size, atlas.parts, atlas.places}, &atlas.texture);
  std::array<double, 3> low = {9, 9, 9}, high = {-9, -9, -9};
  for (const Texel& texel : texels) {
    for (size_t a = 0; a < 3; ++a) {
      low[a] = std::min<double>(low[a], texel.place[a]), high[a] = std::max<double>(high[a], texel.place[a]);
    }
  }
  const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  const std::map<uint8_t, int> limb = {{1, 0},  {2, 0},  {3, 1},  {4, 1},  {7, 2},
                                       {10, 2}, {15, 3}, {22, 4}, {23, 5}, {24, 5}};
  const auto same_cell = [&](const Texel& a, const Texel& b, int level) {
    if (limb.at(a.part) != limb.at(b.part)) return false;
    const double side = extent / std::pow(2.0, level);
    const auto cell = [&](double x) { return std::floor(x / side); };
    const double middle = 0.5 * (low[0] + high[0]);
    return cell(std::abs(a.place[0] - middle)) == cell(std::abs(b.place[0] - middle)) &&
           cell(a.place[1] - low[1]) == cell(b.place[1] - low[1]) &&
           (limb.at(a.part) != 5 || cell(a.place[2] - low[2]) == cell(b.place[2] - low[2]));
  };
  for (size_t k = 0; k < texels.size(); ++k) {
    if (texels[k].visible) continue;
    const auto near = [&](const Texel& other, int level) {
      if (!other.visible) return false;
      if (level < -1) return true;
      return level < 0 ? limb.at(texels[k].part) == limb.at(other.part) : same_cell(texels[k], other, level);
    };
    std::array<int, 7> votes{};
    for (int level = 6; level >= -2 && *std::max_element(votes.begin(), votes.end()) == 0; --level) {
      for (const Texel& other : texels) votes[other.label] += near(other, level) ? 1 : 0;
    }
    const auto label = std::max_element(votes.begin(), votes.end()) - votes.begin();
    std::array<double, 3> sum{};
    int count = 0;
    for (int level = 6; level >= -2 && count == 0; --level) {
      for (const Texel& other : texels) {
        if (other.label != label || !near(other, level)) continue;
        ++count;
        for (size_t c = 0; c < 3; ++c) sum[c] += other.colour[c];
      }
    }
    ASSERT_GT(count, 0) << "thirty seen texels";
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(atlas.Colour(k)[c], sum[c] / count, 1e-6) << k;
  }
}

TEST(GuessTexture, OfNothingIsNothing) {
  Atlas atlas({{kTorsoFront, {0, 1, 0}, kRed, false}, {kTorsoBack, {0, 1, 0}, kRed, false}});
  GuessTexture({atlas.size, atlas.parts, atlas.places}, &atlas.texture);
  EXPECT_THAT(atlas.texture.guessed, ::testing::Each(0));
  EXPECT_THAT(atlas.texture.colour, ::testing::Each(0.0F));
  const std::vector<uint8_t> no_parts(4, 0);
  GuessTexture({2, no_parts, atlas.places}, &atlas.texture);
  EXPECT_THAT(atlas.texture.guessed, ::testing::Each(0));
}

TEST(GuessTexture, SaysWhatIsWrong) {
  const Atlas good({{kTorsoFront, {0, 1, 0}, kRed, true}, {kTorsoBack, {0, 1, 0}, kRed, false}});
  Atlas atlas = good;
  EXPECT_THAT([&] { TexelNeighbours(3, atlas.parts, atlas.places); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("4 parts and 12 places of texels, expected 3²")));
  EXPECT_THROW(TexelNeighbours(0, {}, {}), std::invalid_argument);
  atlas.parts[0] = 25;
  EXPECT_THAT([&] { TexelNeighbours(2, atlas.parts, atlas.places); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("part 25")));
  atlas = good;
  atlas.places[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT([&] { TexelNeighbours(2, atlas.parts, atlas.places); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("texel 1 has no place")));
  const TexelNeighbours guess(2, good.parts, good.places);
  atlas = Atlas(std::vector<Texel>(9, {kTorsoFront, {0, 1, 0}, kRed, true}));
  EXPECT_THAT([&] { GuessTexture(guess, &atlas.texture); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("a texture of 3 texels a side, expected 2")));
  atlas = good;
  GuessTexture(guess, &atlas.texture);
  EXPECT_THROW((void)UnionOf(std::vector<PartialTexture>{good.texture, atlas.texture}), std::invalid_argument)
      << "guesses are made last";
}

/// The toy's front and what is guessed of its back.
PartialTexture ToyTextureWithGuess(int person) {
  const PhotoSource source = ToyPhotos(1, 1);
  PhotoFrame frame;
  FillToyPhoto(person, 0, &frame);
  PartialTexture texture = PartialTextureOf(frame);
  GuessTexture({kToyTexture, source.texel_parts, source.texel_places}, &texture);
  return texture;
}

TEST(GuessTexture, IsSeenByFeatureNetAlone) {
  const torch::NoGradGuard no_grad;
  const PartialTexture texture = ToyTextureWithGuess(0);
  PartialTexture bare = texture;
  bare.guessed.clear();
  const TextureTensors guessed = ToTensors(std::span(&texture, 1)), unguessed = ToTensors(std::span(&bare, 1));
  EXPECT_TRUE(torch::equal(guessed.colour, unguessed.colour));
  EXPECT_TRUE(torch::equal(guessed.visible, unguessed.visible));
  EXPECT_FALSE(unguessed.guess.defined());
  EXPECT_EQ((guessed.guess * guessed.visible).abs().max().item<float>(), 0);
  EXPECT_GT((guessed.guess.abs().amax(1, true) * (1 - guessed.visible)).mean().item<float>(), 0.05);

  PhotoModel with(ToyGuessConfig()), without(ToyPhotoConfig());
  EXPECT_THAT([&] { with->Complete(unguessed); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("a texture without guesses")));
  EXPECT_THAT([&] { without->Complete(guessed); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("a texture with guesses")));
  TextureTensors other = guessed;
  other.guess = -guessed.guess;
  EXPECT_FALSE(torch::equal(with->Complete(guessed), with->Complete(other)));
  // A new network copies what it sees: of the back, the guess.
  const torch::Tensor back = (1 - guessed.visible);
  const double off = ((with->Complete(guessed).slice(1, 0, 3) - guessed.guess) * back).abs().mean().item<double>();
  const double blind = (guessed.guess * back).abs().mean().item<double>();
  EXPECT_LT(off, 0.5 * blind);
  for (const PhotoVariant variant : {PhotoVariant::kWarp, PhotoVariant::kWarpCond}) {
    PhotoModel model(ToyGuessConfig(variant));
    EXPECT_FALSE(model->config.GuessesUnseen());
    EXPECT_TRUE(torch::equal(model->Complete(guessed), guessed.colour));
  }
}

TEST(GuessTexture, TrainsResumesAndRenders) {
  const PhotoSource source = ToyPhotos(3, 3);
  TrainPhotoOptions whole = ToyOptions("guess_whole", ToyGuessConfig());
  std::vector<PhotoPreview> previews;
  whole.preview = [&](int, const std::vector<PhotoPreview>& made) { previews = made; };
  ASSERT_EQ(TrainPhoto(source, whole).status, TrainingStatus::kFinished);
  TrainPhotoOptions parts = ToyOptions("guess_parts", ToyGuessConfig());
  parts.progress = [](const TrainingProgress& progress) { return progress.step < 3; };
  EXPECT_EQ(TrainPhoto(source, parts).status, TrainingStatus::kStopped);
  parts.progress = nullptr;
  parts.resume = true;
  ASSERT_EQ(TrainPhoto(source, parts).status, TrainingStatus::kFinished);
  EXPECT_EQ(FileBytes(CheckpointPath(parts.run_dir)), FileBytes(CheckpointPath(whole.run_dir)));

  ASSERT_FALSE(previews.empty());
  const PhotoPreview& preview = previews[0];
  PhotoRenderer renderer(CheckpointPath(whole.run_dir), whole.config, {whole.reach, 1});
  PartialTexture texture = PartialTextureOf(preview.source);
  EXPECT_EQ(preview.partial_texture, texture.colour) << "the preview shows what was seen";
  EXPECT_THROW(renderer.Encode(texture), std::invalid_argument);
  GuessTexture({kToyTexture, source.texel_parts, source.texel_places}, &texture);
  renderer.Encode(texture);
  EXPECT_EQ(renderer.Render(preview.target).image, preview.rendered.image);

  PhotoSource placeless = source;
  placeless.texel_places.clear();
  EXPECT_THROW(TrainPhoto(placeless, ToyOptions("guess_placeless", ToyGuessConfig())), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::guess_texture_test
