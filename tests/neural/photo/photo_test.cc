// SPDX-License-Identifier: Apache-2.0
// Parts of the one-photo renderer: networks, textures, windows, pairs, losses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include "neural/metrics/person_scores.h"
#include "neural/networks/architecture_card.h"
#include "neural/photo/photo_batch.h"
#include "neural/photo/photo_model.h"
#include "tests/neural/photo/toy_photos.h"
#include "tests/support/gradient_check.h"

namespace bodyloom::photo_test {
namespace {

using ::testing::HasSubstr;
using torch::Tensor;

int64_t Parameters(const torch::nn::Module& module) {
  int64_t count = 0;
  for (const Tensor& parameter : module.parameters()) count += parameter.numel();
  return count;
}

TEST(ResidualGenerator, HasTheParametersAndTheCostOfThePublishedOne) {
  ResidualGenerator generator(ResidualGeneratorOptions{16, 3, 64, 6});
  EXPECT_EQ(Parameters(*generator), 31475267);
  const std::string card = ArchitectureCard(generator, {1, 16, 64, 64});
  EXPECT_THAT(card, HasSubstr("block5b.weight"));
  // 64²: 7·7·16·64 at 64², three times 9·c·2c at half the size, twelve times 9·512·512 at 8², the way back (a
  // transposed convolution counts its input's pixels), 7·7·64·3 at 64².
  const int64_t expected = 50176LL * 4096 + 73728LL * 1024 + 294912LL * 256 + 1179648LL * 64 + 12 * 2359296LL * 64 +
                           1179648LL * 64 + 294912LL * 256 + 73728LL * 1024 + 9408LL * 4096;
  EXPECT_THAT(card, HasSubstr("multiply-adds   " + std::to_string(expected)));
  EXPECT_THROW(generator(torch::zeros({1, 16, 60, 64})), std::invalid_argument);
  EXPECT_THROW(generator(torch::zeros({1, 15, 64, 64})), std::invalid_argument);
}

TEST(FeatureUNet, HasTheParametersThatItsWidthsMake) {
  // Two 3×3 convolutions a level; the decoder's first sees the enlarged map beside the encoder's; the last convolution
  // sees the input too.
  const auto expected = [](int in, int out, const std::vector<int64_t>& w) {
    int64_t count = 9 * (w[0] + in) * out + out, from = in;
    for (const int64_t width : w) {
      count += 9 * (from * width + width * width);
      from = width;
    }
    for (size_t l = 0; l + 1 < w.size(); ++l) count += 9 * ((w[l + 1] + w[l]) * w[l] + w[l] * w[l]);
    return count;
  };
  for (const char* name : {"paper", "cpu", "tiny"}) {
    const PhotoProfile& p = PhotoProfileNamed(name);
    const FeatureUNet net(FeatureUNetOptions{4, p.features, p.feature_widths});
    const std::vector<int64_t> widths(p.feature_widths.begin(), p.feature_widths.end());
    EXPECT_EQ(Parameters(*net), expected(4, 16, widths)) << name;
  }
  FeatureUNet net(FeatureUNetOptions{4, 16, {8, 16, 32, 64, 128}});
  EXPECT_EQ(net(torch::zeros({2, 4, 64, 32})).sizes(), (std::vector<int64_t>{2, 16, 64, 32}));
  EXPECT_THROW(net(torch::zeros({1, 4, 40, 32})), std::invalid_argument);
  EXPECT_THROW(net(torch::zeros({1, 4, 16, 16})), std::invalid_argument);
}

TEST(FeatureUNet, KnowsHowBrightItsInputIs) {
  // Instance normalisation alone would give the same for an input and its half.
  torch::manual_seed(3);
  FeatureUNet net(FeatureUNetOptions{3, 3, {4, 8}});
  const torch::NoGradGuard no_grad;
  const Tensor dark = torch::rand({1, 3, 8, 8}) * 0.2, bright = dark * 4;
  EXPECT_GT((net(dark) - net(bright)).abs().mean().item<float>(), 0.05);
}

TEST(PhotoModel, ProfilesHaveTheirSizes) {
  const auto sizes = [](const char* profile) {
    PhotoModel model(PhotoConfig{PhotoProfileNamed(profile), PhotoVariant::kFull});
    return std::vector<double>{1e-6 * Parameters(*model->feature_net), 1e-6 * Parameters(*model->render_net)};
  };
  // 64 … 1024 and 64: 31.4 million each; a quarter of the width has a sixteenth of them.
  EXPECT_NEAR(sizes("paper")[0], 31.4, 0.1);
  EXPECT_NEAR(sizes("paper")[1], 31.5, 0.1);
  EXPECT_NEAR(sizes("cpu")[0], 1.97, 0.03);
  EXPECT_NEAR(sizes("cpu")[1], 1.984 + 0.075, 0.002) << "with kernels of 16 for 9 taps on the way up";
  EXPECT_NEAR(sizes("tiny")[0], 0.49, 0.01);
  EXPECT_THROW(PhotoProfileNamed("gpu"), std::invalid_argument);
  EXPECT_THROW(PhotoVariantNamed("best"), std::invalid_argument);
  for (const char* variant : {"full", "no-int", "ip", "warp", "warpcond"}) {
    EXPECT_STREQ(ToText(PhotoVariantNamed(variant)), variant);
  }
}

TEST(PhotoModel, RefusesConfigurationsThatCannotWork) {
  const auto invalid = [](auto change) {
    PhotoConfig config = ToyPhotoConfig();
    change(&config.profile);
    std::string why;
    EXPECT_FALSE(config.IsValid(&why));
    EXPECT_THROW(PhotoModel{config}, std::invalid_argument);
    return why;
  };
  EXPECT_THAT(invalid([](PhotoProfile* p) { p->image_size = 60; }), HasSubstr("image_size is 60"));
  EXPECT_THAT(invalid([](PhotoProfile* p) { p->texture_size = 15; }), HasSubstr("texture_size is 15"));
  EXPECT_THAT(invalid([](PhotoProfile* p) { p->features = 2; }), HasSubstr("features is 2"));
  EXPECT_THAT(invalid([](PhotoProfile* p) { p->feature_widths = {4}; }), HasSubstr("feature_widths"));
  EXPECT_THAT(invalid([](PhotoProfile* p) { p->discriminator_layers = 5; }), HasSubstr("at least"));
}

struct ToyTensors {
  TextureTensors texture;
  PoseTensors pose;
};

ToyTensors ToyInput(int person, int source, int target) {
  PhotoFrame from, to;
  FillToyPhoto(person, source, &from);
  FillToyPhoto(person, target, &to);
  const PartialTexture texture = PartialTextureOf(from);
  const PhotoWindow whole = {0, 0, kToySize, kToySize};
  return {ToTensors(std::span(&texture, 1)), PoseOf(std::span(&to, 1), std::span(&whole, 1))};
}

TEST(PhotoModel, VariantsSeeWhatTheyAreNamedFor) {
  const torch::NoGradGuard no_grad;
  for (const PhotoVariant variant : {PhotoVariant::kFull, PhotoVariant::kNoInt, PhotoVariant::kInpaint,
                                     PhotoVariant::kWarp, PhotoVariant::kWarpCond}) {
    SCOPED_TRACE(ToText(variant));
    PhotoModel model(ToyPhotoConfig(variant));
    // The back, from a picture of the front: nothing of it is to be seen.
    const ToyTensors toy = ToyInput(0, 0, 1);
    const Tensor features = model->Complete(toy.texture);
    const Tensor projected = model->Project(features, toy.pose);
    EXPECT_EQ(projected.size(1), model->config.RenderChannels());
    EXPECT_EQ((projected * (1 - toy.pose.body)).abs().max().item<float>(), 0) << "something off the body";
    const bool warps = variant == PhotoVariant::kWarp || variant == PhotoVariant::kWarpCond;
    EXPECT_EQ(model->feature_net.is_empty(), warps);
    // Beside the seam the look-up blends with the other half.
    const Tensor back = projected.slice(1, 0, 3).slice(3, kCardLeft + 3, kCardLeft + kCardWidth);
    EXPECT_EQ(back.abs().max().item<float>() == 0, warps);
    if (variant == PhotoVariant::kWarpCond) {
      EXPECT_TRUE(torch::equal(projected.slice(1, 3, 5), toy.pose.uv));
      EXPECT_TRUE(torch::equal(projected.slice(1, 5, 6), toy.pose.parts));
    }
    const PhotoResult result = model->Render(projected, toy.pose.body);
    EXPECT_EQ(result.image.sizes(), (std::vector<int64_t>{1, 3, kToySize, kToySize}));
    EXPECT_TRUE((result.image >= 0).all().item<bool>());
    EXPECT_TRUE((result.image <= result.alpha).all().item<bool>());
    EXPECT_TRUE(torch::allclose(result.alpha, torch::sigmoid(result.alpha_logit)));
  }
}

TEST(PhotoModel, BeginsWithTheColoursThatItIsShown) {
  torch::manual_seed(1);
  PhotoModel model(ToyPhotoConfig());
  const torch::NoGradGuard no_grad;
  const ToyTensors toy = ToyInput(1, 0, 0);
  const Tensor features = model->Complete(toy.texture);
  const Tensor error = (features.slice(1, 0, 3) - toy.texture.colour) * toy.texture.visible;
  EXPECT_LT(error.abs().max().item<float>(), 0.5);
  EXPECT_LT(error.abs().mean().item<float>(), 0.1);
  EXPECT_LT(features.slice(1, 3).abs().mean().item<float>(), 0.3);
  // So does the picture, where the body is seen.
  const Tensor projected = model->Project(features, toy.pose);
  const PhotoResult result = model->Render(projected, toy.pose.body);
  const Tensor shown = 0.5 * (torch::tanh(projected.slice(1, 0, 3)) + 1);
  EXPECT_LT(((result.image / result.alpha - shown) * toy.pose.body).abs().mean().item<float>(), 0.1);
}

TEST(PhotoModel, DerivativesAgreeWithDifferences) {
  torch::manual_seed(2);
  for (PhotoConfig config :
       {ToyPhotoConfig(), ToyPhotoConfig(PhotoVariant::kWarpCond), ToyGuessConfig(PhotoVariant::kFull)}) {
    config.profile.image_size = 16;
    config.profile.texture_size = 8;
    config.profile.feature_widths = {3, 4, 4};
    config.profile.render_width = 2;
    config.profile.discriminator_scales = 1;
    config.profile.texture_size = 8;
    PhotoModel model(config);
    model->to(torch::kDouble);
    PoseTensors pose;
    pose.uv = torch::rand({1, 2, 16, 16}, torch::kDouble) * 0.8 + 0.1;
    pose.body = (torch::rand({1, 1, 16, 16}) > 0.3).to(torch::kDouble);
    pose.parts = pose.body * 0.5;
    const Tensor weights = torch::randn({1, 4, 16, 16}, torch::kDouble);
    const Tensor visible = (torch::rand({1, 1, 8, 8}) > 0.4).to(torch::kDouble);
    std::vector<Tensor> inputs = {torch::rand({1, 3, 8, 8}, torch::kDouble) * 2 - 1};
    Tensor parameter = model->render_net->first->weight;
    inputs.push_back(parameter.detach().slice(0, 0, 1).clone());
    const auto function = [&](const std::vector<Tensor>& x) {
      // The first filter of RenderNet is an input too.
      model->render_net->first->weight = torch::cat({x[1], parameter.detach().slice(0, 1, parameter.size(0))}, 0);
      const Tensor guess = config.GuessesUnseen() ? 0.5 * x[0] * (1 - visible) : Tensor();
      const PhotoResult result = model->forward({x[0] * visible, visible, guess}, pose);
      return (torch::cat({result.image, result.alpha_logit}, 1) * weights).sum();
    };
    const GradientCheck check = CheckGradients(function, inputs);
    EXPECT_LT(check.max_error, 1e-5) << ToText(config);
    EXPECT_GT(check.num_nonzero, check.num_compared / 3);
  }
}

TEST(PartialTexture, HasTheColoursOfTheImage) {
  PhotoFrame frame;
  FillToyPhoto(1, 3, &frame);  // a back
  const PartialTexture texture = PartialTextureOf(frame);
  constexpr int U = kToyTexture;
  for (int r = 0; r < U; ++r) {
    for (int c = 0; c < U; ++c) {
      const int k = r * U + c;
      ASSERT_EQ(texture.visible[k], c >= U / 2) << r << ' ' << c;
      const float u = (static_cast<float>(c) + 0.5F) / U, v = 1 - (static_cast<float>(r) + 0.5F) / U;
      for (int channel = 0; channel < 3; ++channel) {
        const float expected = c >= U / 2 ? ToyColour(1, u, v, channel) : 0.0F;
        // The card's colours are smooth: bilinear means of neighbours 1/48 apart are off by their curvature.
        ASSERT_NEAR(texture.colour[channel * U * U + k], expected, 2e-3) << r << ' ' << c;
      }
    }
  }
  const PhotoSource source = ToyPhotos(1, 1);
  EXPECT_NEAR(VisibleShare(texture, source.texel_parts), 0.5, 1e-9);
}

TEST(PartialTexture, LeavesOutTheBackground) {
  PhotoFrame frame;
  FillToyPhoto(0, 0, &frame);
  constexpr int S = kToySize, A = S * S, T = kToyTexture * kToyTexture;
  // One texel between a red pixel of the person and a black one of the background, nearer to the first.
  const int texel = 5 * kToyTexture + 3, pixel = 30 * S + 20;
  frame.texel_pixels[texel] = 20.25F;
  frame.texel_pixels[T + texel] = 30;
  for (int c = 0; c < 3; ++c) frame.image[c * A + pixel] = c == 0 ? 0.9F : 0.1F;
  frame.labels[pixel + 1] = 0;
  frame.image[pixel + 1] = 0;
  PartialTexture texture = PartialTextureOf(frame);
  EXPECT_EQ(texture.visible[texel], 1);
  EXPECT_FLOAT_EQ(texture.colour[texel], 0.9F);
  frame.texel_pixels[texel] = 20.75F;  // nearer to the background
  EXPECT_EQ(PartialTextureOf(frame).visible[texel], 0);
  frame.texel_pixels[texel] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(PartialTextureOf(frame).visible[texel], 0);
  frame.texel_pixels[texel] = 1e30F;
  EXPECT_EQ(PartialTextureOf(frame).visible[texel], 0);
  // Without labels what is black is background.
  frame.labels.clear();
  for (int c = 0; c < 3; ++c) frame.image[c * A + pixel + 1] = 0;
  frame.texel_pixels[texel] = 20.75F;
  EXPECT_EQ(PartialTextureOf(frame).visible[texel], 0);
  frame.texel_pixels[texel] = 20.25F;
  EXPECT_EQ(PartialTextureOf(frame).visible[texel], 1);
  frame.image.clear();
  EXPECT_THROW(PartialTextureOf(frame), std::invalid_argument);
}

TEST(PartialTexture, GarmentsComeFromTheOtherAndAllElseStaysBitForBit) {
  const PhotoSource source = ToyPhotos(2, 2);
  PhotoFrame frame;
  source.fill(0, 0, &frame);
  const PartialTexture own = PartialTextureOf(frame);
  source.fill(1, 0, &frame);
  PartialTexture other = PartialTextureOf(frame);
  const int hidden = 8 * kToyTexture + 2;  // a texel of the garment that the other picture does not show
  ASSERT_EQ(source.texel_parts[hidden], 2);
  other.visible[hidden] = 0;
  for (int c = 0; c < 3; ++c) other.colour[c * kToyTexture * kToyTexture + hidden] = 0;
  const std::vector<int> torso = {1, 2};
  const PartialTexture dressed = WithParts(own, other, source.texel_parts, torso);
  constexpr size_t T = kToyTexture * kToyTexture;
  int taken = 0, kept = 0;
  for (size_t k = 0; k < T; ++k) {
    const bool garment = source.texel_parts[k] == 2;
    const PartialTexture& from = garment ? other : own;
    (garment ? taken : kept) += from.visible[k];
    ASSERT_EQ(dressed.visible[k], from.visible[k]);
    ASSERT_EQ(dressed.labels[k], from.labels[k]);
    ASSERT_EQ(dressed.cosine[k], from.cosine[k]);
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(std::bit_cast<uint32_t>(dressed.colour[c * T + k]), std::bit_cast<uint32_t>(from.colour[c * T + k]));
    }
  }
  EXPECT_GT(taken, 20);
  EXPECT_GT(kept, 20);
  EXPECT_EQ(dressed.visible[hidden], 0);
  // The input of FeatureNet is unchanged as well.
  const TextureTensors before = ToTensors(std::span(&own, 1)), after = ToTensors(std::span(&dressed, 1));
  const Tensor legs = torch::tensor(std::vector<int64_t>(source.texel_parts.begin(), source.texel_parts.end()))
                          .view({1, 1, kToyTexture, kToyTexture}) == 9;
  EXPECT_TRUE(torch::equal(before.colour.masked_select(legs), after.colour.masked_select(legs)));
  EXPECT_FALSE(torch::equal(before.colour, after.colour));
}

TEST(PartialTexture, TwoImagesShowMoreThanOne) {
  const PhotoSource source = ToyPhotos(1, 2);
  std::vector<PartialTexture> textures(2);
  PhotoFrame frame;
  for (int t = 0; t < 2; ++t) {
    source.fill(0, t, &frame);
    textures[t] = PartialTextureOf(frame);
  }
  // Three texels that both see: the first picture better, as well, at a grazing angle.
  for (const int k : {0, 1, 2}) {
    textures[1].visible[k] = textures[1].labels[k] = 1;
    textures[1].cosine[k] = 0.5F;
    textures[1].colour[k] = 0.123F;
  }
  textures[0].cosine[0] = 0.6F, textures[0].cosine[1] = 0.5F, textures[0].cosine[2] = 0.2F;
  const PartialTexture both = UnionOf(textures);
  EXPECT_NEAR(VisibleShare(both, source.texel_parts), 1, 1e-9);
  EXPECT_EQ(both.colour[0], textures[0].colour[0]);
  EXPECT_EQ(both.colour[1], textures[0].colour[1]);
  EXPECT_EQ(both.colour[2], 0.123F);
  EXPECT_EQ(both.cosine[2], 0.5F);
  EXPECT_EQ(both.colour[kToyTexture - 1], textures[1].colour[kToyTexture - 1]);
  textures[1].size = 8;
  EXPECT_THROW(UnionOf(textures), std::invalid_argument);
}

TEST(PhotoWindow, IsAroundTheBodyAndInsideTheFrame) {
  PhotoFrame frame;
  FillToyPhoto(0, 0, &frame);
  const PhotoWindow near = WindowAround(frame, 2, 16);
  EXPECT_EQ(near.width, 32);
  EXPECT_EQ(near.height, 64);
  EXPECT_LE(near.x, kCardLeft - 2);
  EXPECT_GE(near.x + near.width, kCardLeft + kCardWidth + 2);
  EXPECT_EQ(WindowAround(frame, 5, 16).width, 64);    // 24 + 10 pixels
  EXPECT_EQ(WindowAround(frame, 2, 40).width, 64);    // as large as requested
  EXPECT_EQ(WindowAround(frame, 99, 16).height, 64);  // never beyond the frame
  frame.parts.assign(frame.parts.size(), 0);
  const PhotoWindow nobody = WindowAround(frame, 2, 16);
  EXPECT_EQ(nobody.x, 16);
  EXPECT_EQ(nobody.width, 32);
  frame.parts[63] = 1;  // a corner
  const PhotoWindow corner = WindowAround(frame, 2, 16);
  EXPECT_EQ(corner.x, 32);
  EXPECT_EQ(corner.y, 0);
  const std::vector<PhotoWindow> equal = EqualWindows(std::vector<PhotoWindow>{near, corner}, kToySize);
  EXPECT_EQ(equal[0].x, near.x);
  EXPECT_EQ(equal[1].width, 32);
  EXPECT_EQ(equal[1].height, 64);
  EXPECT_EQ(equal[1].x, 32);
  EXPECT_EQ(equal[1].y, 0);
}

TEST(PhotoWindow, ReachIsThatOfTheClothes) {
  PhotoSource source = ToyPhotos(3, 4);
  const std::vector<int> persons = {0, 2};
  EXPECT_EQ(PhotoReach(source, persons, 8), 2);
  source.fill = [](int person, int frame, PhotoFrame* photo) {
    FillToyPhoto(person, frame, photo);
    photo->labels.clear();
  };
  EXPECT_EQ(PhotoReach(source, persons, 8), 0);
}

TEST(PhotoPairs, AreDrawnFromTheirNumbersAlone) {
  PhotoSource people;
  people.num_frames = {4, 1, 6, 5};
  const std::vector<int>& num_frames = people.num_frames;
  const std::vector<int> persons = {0, 2, 3};
  std::set<int> drawn;
  std::vector<int> frames(6, 0);
  for (int step = 0; step < 600; ++step) {
    const PhotoPair pair = DrawPhotoPair(people, persons, 7, step, 1);
    const PhotoPair again = DrawPhotoPair(people, persons, 7, step, 1);
    ASSERT_EQ(pair.source, again.source);
    ASSERT_EQ(pair.target, again.target);
    ASSERT_NE(pair.source, pair.target);
    ASSERT_LT(std::max(pair.source, pair.target), num_frames[pair.person]);
    drawn.insert(pair.person);
    if (pair.person == 2) ++frames[pair.target];
  }
  EXPECT_EQ(drawn, (std::set<int>{0, 2, 3}));
  for (const int count : frames) EXPECT_GT(count, 10);
  int differ = 0;
  for (int step = 0; step < 50; ++step) {
    const PhotoPair a = DrawPhotoPair(people, persons, 7, step, 0);
    const PhotoPair b = DrawPhotoPair(people, persons, 8, step, 0);
    differ += a.person != b.person || a.source != b.source || a.target != b.target;
  }
  EXPECT_GT(differ, 30);
  const std::vector<int> only = {1};
  EXPECT_EQ(DrawPhotoPair(people, only, 7, 0, 0).target, 0);
  const std::vector<int> nobody;
  EXPECT_THROW(DrawPhotoPair(people, nobody, 7, 0, 0), std::invalid_argument);
  EXPECT_EQ(ValidationPairs(people, persons, 3).size(), 9U);
  // Two poses in two views: a target shows the other pose.
  people.num_frames = {4};
  people.places = {{{0, 0}, {1, 0}, {0, 1}, {1, 1}}};
  const std::vector<int> first = {0};
  for (int step = 0; step < 100; ++step) {
    const PhotoPair pair = DrawPhotoPair(people, first, 7, step, 0);
    EXPECT_NE(pair.source % 2, pair.target % 2);
  }
  for (const PhotoPair& pair : ValidationPairs(people, first, 20)) EXPECT_NE(pair.source % 2, pair.target % 2);
}

TEST(PhotoLosses, TextureLossCountsWhatEitherImageShows) {
  const Tensor features = torch::zeros({1, 5, 2, 2});
  TextureTensors source = {torch::full({1, 3, 2, 2}, 0.5), torch::zeros({1, 1, 2, 2}), {}};
  TextureTensors target = {torch::full({1, 3, 2, 2}, -0.2), torch::zeros({1, 1, 2, 2}), {}};
  EXPECT_EQ(TextureLoss(features, source, target).item<float>(), 0);
  source.visible[0][0][0][1] = 1;
  EXPECT_FLOAT_EQ(TextureLoss(features, source, target).item<float>(), 0.5F);
  target.visible.fill_(1);
  EXPECT_FLOAT_EQ(TextureLoss(features, source, target).item<float>(), 0.7F);
}

TEST(SphereFace, HasItsTwentyConvolutionsAndLoadsThemByName) {
  SphereFace network;
  int convolutions = 0;
  for (const auto& item : network->named_parameters()) {
    convolutions += item.key().rfind("conv", 0) == 0 && item.value().dim() == 4;
    EXPECT_FALSE(item.value().requires_grad());
  }
  EXPECT_EQ(convolutions, 20);
  EXPECT_EQ(network(torch::rand({2, 3, 112, 96})).sizes(), (std::vector<int64_t>{2, 512}));
  NamedWeights weights = ExportWeights(*network);
  EXPECT_EQ(weights.count("conv3_9.weight") + weights.count("relu4_3.weight") + weights.count("fc5.bias"), 3U);
  weights["fc6.weight"] = {{1}, {0}};  // the classifier is not needed
  EXPECT_EQ(network->Load(weights, "faces.pth").unused.size(), 1U);
  weights["conv1_2.weight"].shape = {64, 64, 3};
  try {
    network->Load(weights, "faces.pth");
    FAIL() << "took a wrong shape";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("faces.pth: tensor conv1_2.weight"));
  }
}

TEST(PhotoLosses, FaceLossSeesFacesOnly) {
  torch::manual_seed(4);
  SphereFace network;
  const Tensor truth = torch::rand({2, 3, 40, 40});
  Tensor image = truth.clone().requires_grad_(true);
  const std::vector<PhotoWindow> faces = {{10, 5, 20, 24}, {0, 0, 15, 30}};  // the second is too small
  EXPECT_EQ(FaceLoss(network, image, truth, faces).item<float>(), 0);
  Tensor elsewhere = truth.clone();
  elsewhere[1].zero_();
  elsewhere[0].slice(2, 31, 40).zero_();
  EXPECT_EQ(FaceLoss(network, elsewhere, truth, faces).item<float>(), 0);
  Tensor other = (truth * 0.5).requires_grad_(true);
  const Tensor loss = FaceLoss(network, other, truth, faces);
  EXPECT_GT(loss.item<float>(), 0);
  loss.backward();
  EXPECT_GT(other.grad()[0].slice(1, 5, 29).slice(2, 10, 30).abs().sum().item<float>(), 0);
  EXPECT_EQ(other.grad()[1].abs().sum().item<float>(), 0);
  EXPECT_EQ(FaceLoss(network, other, truth, {{}, {}}).item<float>(), 0);
}

TEST(PhotoScores, AreWhatTheyShouldBeBesideTheTruth) {
  const auto lpips = std::make_shared<const Lpips>();
  PhotoFrame truth;
  FillToyPhoto(0, 0, &truth);
  RenderedPerson rendered;
  rendered.size = kToySize;
  rendered.image = truth.image;
  rendered.alpha.assign(truth.labels.begin(), truth.labels.end());
  PersonScorer perfect({lpips, nullptr, [](const Image&, const Image&) { return 0.75; }});
  perfect.Add(rendered, truth);
  EXPECT_EQ(perfect.Scores().image_l1, 0);
  EXPECT_EQ(perfect.Scores().silhouette_iou, 1);
  EXPECT_EQ(perfect.Scores().ssim, 0.75);
  EXPECT_EQ(perfect.Scores().lpips, 0);
  EXPECT_TRUE(perfect.Scores().lpips_random_features);
  EXPECT_TRUE(std::isnan(perfect.Scores().label_iou)) << "no labels are drawn";
  PersonScorer off({lpips});
  for (const float by : {0.1F, 0.3F}) {
    for (size_t i = 0; i < rendered.image.size(); ++i) rendered.image[i] = truth.image[i] + by;
    rendered.alpha.assign(rendered.alpha.size(), 1);
    off.Add(rendered, truth);
  }
  const PersonScores scores = off.Scores();
  EXPECT_EQ(scores.frames, 2);
  EXPECT_NEAR(scores.image_l1, 0.2, 1e-6);
  EXPECT_NEAR(scores.psnr_db, -10 * std::log10((0.01 + 0.09) / 2), 1e-4);
  EXPECT_NEAR(scores.silhouette_iou, 28.0 * 44 / (64 * 64), 1e-6);
  EXPECT_TRUE(std::isnan(scores.ssim));
  EXPECT_GT(scores.lpips, 0);
  rendered.size = 32;
  EXPECT_THROW(off.Add(rendered, truth), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::photo_test
