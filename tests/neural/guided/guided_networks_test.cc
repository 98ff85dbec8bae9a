// SPDX-License-Identifier: Apache-2.0
// The pose-guided renderer's operators and networks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "neural/guided/guided_model.h"
#include "neural/guided/guided_tensors.h"
#include "neural/losses/image_losses.h"
#include "neural/networks/architecture_card.h"
#include "neural/networks/spatial_modulation.h"
#include "tests/neural/guided/guided_toy.h"
#include "tests/support/gradient_check.h"

namespace bodyloom::guided_networks_test {
namespace {

using torch::Tensor;

TEST(SpatialModulation, IsItsFormulaAndItsGradientIsRight) {
  torch::manual_seed(1);
  SpatialModulation modulation(2, std::vector<int>{3, 1}, 4);
  modulation->to(torch::kDouble);
  for (const auto& conv : modulation->second) torch::nn::init::normal_(conv->weight, 0, 0.3);
  const Tensor x = torch::randn({2, 2, 4, 6}, torch::kDouble), a = torch::randn({2, 3, 4, 6}, torch::kDouble),
               b = torch::randn({2, 1, 2, 3}, torch::kDouble);
  {
    const torch::NoGradGuard no_grad;
    Tensor y = (x - x.mean({2, 3}, true)) / (x.var({2, 3}, /*unbiased=*/false, true) + 1e-5).sqrt();
    const Tensor maps[2] = {a, torch::upsample_bilinear2d(b, {4, 6}, false)};
    for (int i = 0; i < 2; ++i) {
      const Tensor painted = modulation->second[i](modulation->first[i](maps[i]).clamp_min(0));
      y = y * (1 + painted.slice(1, 0, 2)) + painted.slice(1, 2, 4);
    }
    EXPECT_LT((modulation->forward(x, {a, b}) - y).abs().max().item<double>(), 1e-12);
  }
  const Tensor weights = torch::randn({2, 2, 4, 6}, torch::kDouble);
  const auto check = CheckGradients(
      [&](const std::vector<Tensor>& in) {
        return (weights * modulation->forward(in[0], {in[1], in[2]})).sum();
      },
      {x, a, b});
  EXPECT_LT(check.max_error, 1e-5);
  EXPECT_GT(check.num_nonzero, check.num_compared / 2);
  EXPECT_THROW(modulation->forward(x, {a}), std::invalid_argument);
}

TEST(SpatialModulation, ANewBlockAlreadyShowsItsMaps) {
  torch::manual_seed(2);
  ModulatedBlock block(4, 3, std::vector<int>{2, 2}, 4, false);
  const torch::NoGradGuard no_grad;
  const Tensor x = torch::randn({1, 4, 8, 8}), map = torch::randn({1, 2, 8, 8});
  EXPECT_EQ(block->forward(x, {map, map}).sizes(), (std::vector<int64_t>{1, 3, 8, 8}));
  EXPECT_GT((block->forward(x, {map, map}) - block->forward(x, {map, -map})).abs().mean().item<float>(), 0.01);
  EXPECT_TRUE(ModulatedBlock(4, 4, std::vector<int>{2}, 4, false)->shortcut.is_empty());
}

TEST(SpatialModulation, BlockGradientsAreRight) {
  torch::manual_seed(3);
  for (const bool spectral : {false, true}) {
    ModulatedBlock block(2, 3, std::vector<int>{2}, 3, spectral);
    block->to(torch::kDouble);
    block->eval();
    const Tensor weights = torch::randn({1, 3, 4, 4}, torch::kDouble);
    const auto check =
        CheckGradients([&](const std::vector<Tensor>& in) { return (weights * block->forward(in[0], {in[1]})).sum(); },
                       {torch::randn({1, 2, 4, 4}, torch::kDouble), torch::randn({1, 2, 4, 4}, torch::kDouble)});
    EXPECT_LT(check.max_error, 1e-5) << spectral;
  }
}

TEST(SpectralNorm, FindsTheLargestSingularValue) {
  torch::manual_seed(4);
  SpectralConv conv(3, 5, 3, true, true);
  conv->to(torch::kDouble);
  for (int i = 0; i < 300; ++i) conv->Iterate();
  const double largest =
      std::get<1>(torch::linalg_svd(conv->conv->weight.detach().flatten(1), false)).max().item<double>();
  EXPECT_NEAR(SpectralScale(conv->conv->weight, conv->u, conv->v).item<double>(), largest, 1e-6 * largest);
  // In evaluation nothing turns, in training it does.
  const Tensor x = torch::randn({1, 3, 4, 4}, torch::kDouble), u = conv->u.clone();
  conv->eval();
  conv(x);
  EXPECT_TRUE(torch::equal(conv->u, u));
  SpectralConv fresh(3, 5, 3, true, true);
  const Tensor before = fresh->u.clone();
  fresh(torch::randn({1, 3, 4, 4}));
  EXPECT_FALSE(torch::equal(fresh->u, before));
  EXPECT_EQ(fresh->named_buffers().size(), 2U);
  EXPECT_TRUE(torch::equal(fresh->named_buffers()["u"], fresh->u));
}

TEST(SpectralNorm, GradientIsRight) {
  torch::manual_seed(5);
  Tensor u = torch::randn({4}, torch::kDouble), v = torch::randn({18}, torch::kDouble);
  u = u / u.norm();
  v = v / v.norm();
  const Tensor image = torch::randn({1, 2, 5, 5}, torch::kDouble), weights = torch::randn({1, 4, 5, 5}, torch::kDouble);
  const auto check = CheckGradients(
      [&](const std::vector<Tensor>& in) {
        return (weights * torch::conv2d(image, in[0] / SpectralScale(in[0], u, v), {}, 1, 1)).sum();
      },
      {torch::randn({4, 2, 3, 3}, torch::kDouble) + 0.3});
  EXPECT_LT(check.max_error, 1e-5);
}

TEST(RenderNet, DrawingACodeHasTheRightGradientAndSpread) {
  torch::manual_seed(6);
  const Tensor noise = torch::randn({1, 2, 3, 3}, torch::kDouble), weights = torch::randn({1, 2, 3, 3}, torch::kDouble);
  const auto check = CheckGradients(
      [&](const std::vector<Tensor>& in) {
        return (weights * Draw({in[0], in[1]}, noise).square()).sum();
      },
      {torch::randn({1, 2, 3, 3}, torch::kDouble), torch::randn({1, 2, 3, 3}, torch::kDouble)});
  EXPECT_LT(check.max_error, 1e-5);
  const RenderCode code = {torch::full({100000}, 2.0), torch::full({100000}, 2 * std::log(3.0))};
  const Tensor drawn = Draw(code, torch::randn({100000}));
  EXPECT_NEAR(drawn.mean().item<double>(), 2, 0.05);
  EXPECT_NEAR(drawn.std().item<double>(), 3, 0.05);
  EXPECT_TRUE(torch::equal(Draw(code, {}), code.mean));
}

TEST(LossBalance, BringsLossesToOneScaleAndKeepsTheirWeights) {
  LossBalance balance(4, 3);
  for (int step = 0; step < 3; ++step) {
    EXPECT_FALSE(balance.IsSet());
    EXPECT_EQ(balance.Weight(0), 0);
    balance.Measure(0.1 * (step + 1), std::array{2.0 * (step + 1), 1e-7, 0.0, 1e6});
  }
  ASSERT_TRUE(balance.IsSet());
  EXPECT_NEAR(balance.Weight(0), 0.05, 1e-12);
  EXPECT_EQ(balance.Weight(1), 1e2);
  EXPECT_EQ(balance.Weight(2), 0);
  EXPECT_EQ(balance.Weight(3), 1e-3);
  balance.Measure(100, std::array{1.0, 1.0, 1.0, 1.0});
  EXPECT_NEAR(balance.Weight(0), 0.05, 1e-12);
  EXPECT_THROW(LossBalance(1, 0), std::invalid_argument);
}

TEST(GuidedConfig, NamesItsPartsAndRefusesOthers) {
  GuidedConfig config;
  config.profile = GuidedProfileNamed("cpu");
  const std::string full = ToText(config);
  std::set<std::string> texts = {full};
  for (const std::string& part : GuidedParts()) {
    GuidedConfig less = config;
    LeaveOut(part, &less);
    texts.insert(ToText(less));
    EXPECT_TRUE(less.IsValid(nullptr));
  }
  EXPECT_EQ(texts.size(), GuidedParts().size());  // all but the completed maps, which no network sees
  EXPECT_THROW(LeaveOut("hat", &config), std::invalid_argument);
  EXPECT_THROW(GuidedProfileNamed("gpu"), std::invalid_argument);
  std::string why;
  config.profile.image_size = 250;
  EXPECT_FALSE(config.IsValid(&why));
  EXPECT_NE(why.find("multiple of 32"), std::string::npos) << why;
}

/// Parameters and multiply-adds of a frame once the source is encoded.
std::pair<int64_t, int64_t> SizesOf(const GuidedConfig& config) {
  const torch::NoGradGuard no_grad;
  GuidedModel model(config);
  int64_t parameters = 0;
  for (const Tensor& parameter : model->parameters()) parameters += parameter.numel();
  const int64_t side = config.profile.image_size, cells = side / config.Multiple();
  const auto zeros = [&](int64_t channels) { return torch::zeros({1, channels, side, side}); };
  const GuidedSource source = model->EncodeSource({zeros(3), zeros(1), zeros(1), zeros(3)});
  const int64_t work = CountMultiplyAdds([&] {
    const GuidedResult result =
        model->forward(source, zeros(3), {zeros(1), zeros(3), zeros(1), zeros(1), zeros(2)}, {0, 0, cells, cells});
    EXPECT_EQ(result.image.sizes(), (std::vector<int64_t>{1, 3, side, side}));
  });
  return {parameters, work};
}

TEST(GuidedModel, ProfilesHaveTheSizesThatTheyAreKnownFor) {
  GuidedConfig config;
  config.profile = GuidedProfileNamed("cpu");
  const auto [cpu_parameters, cpu_work] = SizesOf(config);
  config.profile = GuidedProfileNamed("tiny");
  const auto [tiny_parameters, tiny_work] = SizesOf(config);
  // Worked out apart from this code, layer by layer.
  EXPECT_EQ(cpu_parameters, 3757081);
  EXPECT_EQ(cpu_work, 3926065152);
  EXPECT_EQ(tiny_parameters, 828553);
  EXPECT_EQ(tiny_work, 584646656);
}

TEST(GuidedModel, AblationsLeaveOutWhatTheyName) {
  const auto make = [](const std::vector<std::string>& parts) {
    GuidedConfig config = ToyGuided();
    for (const std::string& part : parts) LeaveOut(part, &config);
    torch::manual_seed(11);
    GuidedModel model(config);
    model->eval();
    return model;
  };
  const Tensor pose = torch::rand({1, 3, 32, 32}), silhouette = (torch::rand({1, 1, 32, 32}) > 0.5).to(torch::kFloat),
               classes = torch::randint(0, 7, {1, 1, 32, 32}).to(torch::kFloat), image = torch::rand({1, 3, 32, 32});
  const GuidedTensors source = {pose, silhouette, classes, image};
  const GuidedPseudo pseudo = {classes * silhouette, image * silhouette, silhouette, {}, {}};
  const CodeBox box = {0, 0, 8, 8};
  const auto draw = [&](GuidedModel& model, const GuidedTensors& from, const GuidedPseudo& known) {
    return model->forward(model->EncodeSource(from), pose, known, box);
  };
  const auto differs = [](const Tensor& a, const Tensor& b) { return !torch::equal(a, b); };
  const torch::NoGradGuard no_grad;
  GuidedTensors other = source;
  for (const auto& parts : std::vector<std::vector<std::string>>{{},
                                                                 {"sil"},
                                                                 {"gar"},
                                                                 {"sil", "gar"},
                                                                 {"source-silhouette"},
                                                                 {"source-labels"},
                                                                 {"latent"},
                                                                 {"kl"},
                                                                 {"pseudo-image"}}) {
    GuidedModel model = make(parts);
    const auto without = [&](const char* part) { return std::find(parts.begin(), parts.end(), part) != parts.end(); };
    const std::string name = parts.empty() ? "full" : parts.front();
    const GuidedResult result = draw(model, source, pseudo);
    EXPECT_EQ(model->sil.is_empty(), without("sil"));
    EXPECT_EQ(model->gar.is_empty(), without("gar"));
    EXPECT_EQ(result.label_logits.defined(), !without("gar"));
    EXPECT_TRUE((result.image <= result.silhouette + 1e-6).all().item<bool>()) << name;
    EXPECT_GE(result.image.min().item<float>(), 0) << name;
    other = source;
    other.silhouette = 1 - silhouette;
    EXPECT_EQ(differs(draw(model, other, pseudo).image, result.image), !without("source-silhouette")) << name;
    other = source;
    other.classes = 6 - classes;
    EXPECT_EQ(differs(draw(model, other, pseudo).image, result.image), !without("source-labels")) << name;
    other = source;
    other.image = 1 - image;
    EXPECT_EQ(differs(draw(model, other, pseudo).image, result.image), !without("latent")) << name;
    EXPECT_EQ(model->render->code_head.is_empty(), without("latent") || without("kl")) << name;
    GuidedPseudo brighter = pseudo;
    brighter.image = pseudo.image * 0.5;
    EXPECT_EQ(differs(draw(model, source, brighter).image, result.image), !without("pseudo-image")) << name;
  }
}

/// The paper removes S^s and M^s "from the entire pipeline" (Section 5.2): what is carried of them into the target's
/// pose says nothing either.
TEST(GuidedModel, WhatIsLeftOutOfTheSourceIsNotInTheTargetEither) {
  torch::manual_seed(15);
  const Tensor pose = torch::rand({1, 3, 32, 32}), silhouette = (torch::rand({1, 1, 32, 32}) > 0.5).to(torch::kFloat),
               classes = torch::randint(0, 7, {1, 1, 32, 32}).to(torch::kFloat), image = torch::rand({1, 3, 32, 32});
  const GuidedPseudo pseudo = {classes * silhouette, image * silhouette, silhouette, classes,
                               torch::rand({1, 2, 32, 32})};
  const CodeBox box = {0, 0, 8, 8};
  const torch::NoGradGuard no_grad;
  for (const bool guesses : {false, true}) {
    for (const std::string part : {"", "source-silhouette", "source-labels"}) {
      GuidedConfig config = guesses ? ToyGuidedWithGuesses() : ToyGuided();
      if (!part.empty()) LeaveOut(part, &config);
      GuidedModel model(config);
      model->eval();
      const GuidedSource source = model->EncodeSource({pose, silhouette, classes, image});
      const auto differs = [&](const GuidedPseudo& other) {
        const GuidedResult a = model->forward(source, pose, pseudo, box), b = model->forward(source, pose, other, box);
        return !torch::equal(a.image, b.image) || !torch::equal(a.silhouette, b.silhouette) ||
               !torch::equal(a.label_logits, b.label_logits);
      };
      const bool labels = part != "source-labels", contour = part != "source-silhouette";
      GuidedPseudo other = pseudo;
      other.classes = (6 - classes) * silhouette;
      EXPECT_EQ(differs(other), labels) << part << " with guesses " << guesses;
      other = pseudo;
      other.contour_classes = 6 - classes;
      EXPECT_EQ(differs(other), labels && guesses) << part;
      other = pseudo;
      other.silhouette = 1 - silhouette;
      EXPECT_EQ(differs(other), contour) << part << " with guesses " << guesses;
      other = pseudo;
      other.clothes_offset = 1 - pseudo.clothes_offset;
      EXPECT_EQ(differs(other), contour && guesses) << part;
    }
  }
}

TEST(GuidedImages, WhereThePersonIsTheLikeliestGarmentCounts) {
  // GarNet thinks of the background at every pixel, and of shoes or of a face next.
  GuidedResult result;
  result.silhouette = torch::ones({1, 1, 32, 32});
  result.silhouette.slice(2, 0, 1).fill_(0.4);
  result.image = torch::ones({1, 3, 32, 32});
  result.label_logits = torch::zeros({1, 7, 32, 32});
  result.label_logits.slice(1, 0, 1).fill_(9);
  result.label_logits.slice(1, 6, 7).fill_(5);
  result.label_logits.slice(1, 3, 4).slice(3, 16).fill_(7);
  result.classes = torch::zeros({1, 1, 32, 32});
  const RenderedPerson rendered = RenderedPersonOf(result, {}, 0, {0, 0, 8, 8}, 4, 32);
  EXPECT_EQ(rendered.labels[0], 0) << "off the person";
  EXPECT_EQ(rendered.labels[5 * 32 + 3], 6);
  EXPECT_EQ(rendered.labels[5 * 32 + 20], 3);
}

/// Output of an untrained SilNet whose other convolutions are zero.
Tensor UntrainedSilhouette(const GuidedConfig& config, const Tensor& pose, const Tensor& seen) {
  torch::manual_seed(14);
  const torch::NoGradGuard no_grad;
  SilNet network(config);
  network->eval();
  for (const auto& block : network->decoder->blocks) {
    for (torch::Tensor& parameter : block->parameters()) parameter.zero_();
  }
  return network(network->EncodeSource(torch::rand({1, 11, 32, 32})), pose, seen)[0][0];
}

TEST(SilNet, AnUntrainedOnePredictsWhatIsLikely) {
  Tensor pose = torch::zeros({1, 3, 32, 32});
  pose.slice(2, 8, 24).slice(3, 10, 20).slice(1, 1, 2).fill_(0.5);
  GuidedConfig bare = ToyGuided();
  bare.profile.start_from_body = true;
  const Tensor body = UntrainedSilhouette(bare, pose, {});
  EXPECT_NEAR(body[16][15].item<double>(), 4, 0.5);
  EXPECT_NEAR(body[16][20].item<double>(), 0, 0.5) << "beside the body";
  EXPECT_NEAR(body[16][21].item<double>(), -2, 0.5) << "a pixel farther";
  EXPECT_NEAR(body[2][2].item<double>(), -2, 0.5);
  // Given a skirt of three pixels as input, it predicts the skirt.
  Tensor seen = torch::zeros({1, 9, 32, 32});
  seen.slice(2, 8, 24).slice(3, 7, 23).slice(1, 8, 9).fill_(1);
  const Tensor skirt = UntrainedSilhouette(ToyGuidedWithGuesses(), pose, seen);
  EXPECT_NEAR(skirt[16][15].item<double>(), 4, 0.7);
  EXPECT_NEAR(skirt[16][22].item<double>(), 4, 0.7);
  EXPECT_NEAR(skirt[16][24].item<double>(), -2, 0.7);
  // Without the source's silhouette a skirt is unknown, so the bare body is used.
  GuidedConfig without = ToyGuidedWithGuesses();
  LeaveOut("source-silhouette", &without);
  const Tensor none = UntrainedSilhouette(without, pose, torch::zeros_like(seen));
  EXPECT_NEAR(none[16][15].item<double>(), 4, 0.7);
  EXPECT_NEAR(none[16][24].item<double>(), -2, 0.7);
}

TEST(GuidedModel, ACroppedTargetSeesTheSameCellsOfTheSource) {
  torch::manual_seed(12);
  GuidedModel model(ToyGuided());
  model->eval();
  const torch::NoGradGuard no_grad;
  const GuidedSource source = model->EncodeSource({torch::rand({1, 3, 32, 32}), torch::ones({1, 1, 32, 32}),
                                                   torch::ones({1, 1, 32, 32}), torch::rand({1, 3, 32, 32})});
  const CodeBox box = {2, 1, 4, 5};
  const Tensor cropped = Cropped(source.sil_code, box);
  EXPECT_EQ(cropped.sizes(), (std::vector<int64_t>{1, 8, 5, 4}));
  EXPECT_TRUE(torch::equal(cropped[0][3][2][1], source.sil_code[0][3][3][3]));
  const GuidedResult result = model->forward(
      source, torch::rand({1, 3, 20, 16}),
      {torch::zeros({1, 1, 20, 16}), torch::zeros({1, 3, 20, 16}), torch::zeros({1, 1, 20, 16}), {}, {}}, box);
  EXPECT_EQ(result.image.sizes(), (std::vector<int64_t>{1, 3, 20, 16}));
}

/// 16² pixels: a red skirt (label 2) known in columns 4–5, green stockings (label 5) known in columns 8–9.
struct Known {
  Tensor image = torch::zeros({1, 3, 16, 16}), known = torch::zeros({1, 1, 16, 16}),
         classes = torch::zeros({1, 1, 16, 16});
  Known() {
    const auto fill = [&](int column, int64_t label, int64_t channel) {
      image.slice(3, column, column + 2).slice(1, channel, channel + 1).fill_(1);
      known.slice(3, column, column + 2).fill_(1);
      classes.slice(3, column, column + 2).fill_(label);
    };
    fill(4, 2, 0), fill(8, 5, 1);
  }
};

TEST(CarryColours, AGarmentTakesItsOwnColourHoweverNearAnother) {
  const Known k;
  Tensor classes = torch::full({1, 1, 16, 16}, 2);
  classes.slice(3, 8, 16).fill_(5);
  const Tensor x = CarryColours(k.image, k.known, k.classes, classes);
  for (int64_t column = 0; column < 16; ++column) {
    EXPECT_TRUE(torch::allclose(x[0][0].select(1, column), torch::full({16}, column < 8 ? 1.0 : 0.0))) << column;
    EXPECT_TRUE(torch::allclose(x[0][1].select(1, column), torch::full({16}, column < 8 ? 0.0 : 1.0))) << column;
  }
  // Column 7 lies beside the stockings: without labels it takes some of their green.
  const Tensor blind = CarryColours(k.image, k.known, k.classes, {});
  EXPECT_GT(blind[0][1][8][7].item<double>(), 0.1);
  EXPECT_TRUE(torch::equal(blind * k.known, k.image)) << "what is known stays";
}

TEST(CarryColours, ALabelThatIsKnownNowhereTakesWhatIsNearest) {
  const Known k;
  const Tensor shoes = CarryColours(k.image, k.known, k.classes, torch::full({1, 1, 16, 16}, 6));
  EXPECT_TRUE(torch::equal(shoes, CarryColours(k.image, k.known, k.classes, {})));
  // Each picture of a batch by itself: the second one knows nothing of the skirt.
  const Tensor two = torch::cat({k.image, k.image}, 0), known = torch::cat({k.known, k.known}, 0);
  const Tensor of = torch::cat({k.classes, torch::full_like(k.classes, 5) * k.known}, 0);
  const Tensor x = CarryColours(two, known, of, torch::full({2, 1, 16, 16}, 2));
  EXPECT_NEAR(x[0][0][8][12].item<double>(), 1, 1e-6);
  EXPECT_LT(x[1][0][8][12].item<double>(), 0.9);
  EXPECT_TRUE(torch::equal(CarryColours(k.image * 0, k.known * 0, k.classes * 0, k.classes), k.image * 0));
}

}  // namespace

}  // namespace bodyloom::guided_networks_test
