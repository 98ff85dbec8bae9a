// SPDX-License-Identifier: Apache-2.0
// Every network of the two one-photo renderers by itself: its structure, its derivatives, and overfitting of one batch.
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include "neural/cards/network_cards.h"
#include "neural/guided/guided_batches.h"
#include "neural/guided/guided_model.h"
#include "neural/guided/guided_tensors.h"
#include "neural/losses/image_losses.h"
#include "neural/networks/architecture_card.h"
#include "neural/photo/photo_batch.h"
#include "neural/photo/photo_model.h"
#include "neural/training/optimizers.h"
#include "tests/neural/guided/guided_toy.h"
#include "tests/neural/photo/toy_photos.h"
#include "tests/support/gradient_check.h"
#include "tests/support/paths.h"
#include "tests/support/test_files.h"

namespace bodyloom::one_photo_networks_test {
namespace {

using torch::Tensor;

/// The numbers of a card's lines that begin with `name`, by section.
std::vector<int64_t> NumbersOf(const std::string& card, const std::string& name) {
  std::vector<int64_t> numbers;
  std::istringstream lines(card);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(name, 0) == 0) numbers.push_back(std::stoll(line.substr(name.size())));
  }
  return numbers;
}

/// Made once: those of the published sizes have 280 million numbers.
const std::string& CardOf(const std::string& system, const std::string& profile) {
  static std::map<std::string, std::string> cards;
  std::string& card = cards[system + "_" + profile];
  if (card.empty()) {
    card = system == "photo" ? PhotoCard({PhotoProfileNamed(profile)}) : GuidedCard({GuidedProfileNamed(profile)});
  }
  return card;
}

/// Whole architectures, as `bodyloom neural card` prints them: a change of a shape anywhere is a change of these files.
TEST(Cards, AreWhatTheirFilesSay) {
  for (const char* profile : {"paper", "cpu", "tiny"}) {
    const std::string folder = SourceDir() + "/tests/neural/cards/";
    for (const std::string system : {"photo", "guided"}) {
      EXPECT_EQ(CardOf(system, profile), FileBytes(folder + system + "_" + profile + ".txt")) << system;
    }
  }
}

/// Multiply–adds of a convolution whose output has `side` pixels a side.
int64_t Work(int64_t in, int64_t out, int64_t kernel, int64_t side) { return in * out * kernel * kernel * side * side; }

TEST(Cards, AgreeWithSumsWorkedOutLayerByLayer) {
  for (const char* name : {"paper", "cpu", "tiny"}) {
    SCOPED_TRACE(name);
    const PhotoProfile& p = PhotoProfileNamed(name);
    const std::vector<int>& w = p.feature_widths;
    const auto levels = static_cast<int>(w.size()) - 1;
    int64_t feature = Work(w[0] + 4, p.features, 3, p.texture_size);
    for (int l = 0; l <= levels; ++l) {
      const int64_t side = p.texture_size >> l;
      feature += Work(l == 0 ? 4 : w[l - 1], w[l], 3, side) + Work(w[l], w[l], 3, side);
      if (l < levels) feature += Work(w[l + 1] + w[l], w[l], 3, side) + Work(w[l], w[l], 3, side);
    }
    const int64_t n = p.render_width, S = p.image_size;
    int64_t render = Work(p.features, n, 7, S) + Work(n + (p.render_passes_input ? p.features + 4 : 0), 4, 7, S) +
                     2 * p.render_blocks * Work(8 * n, 8 * n, 3, S / 8);
    for (int l = 0; l < 3; ++l) {
      render += Work(n << l, n << (l + 1), 3, S >> (l + 1));  // down
      render += Work(n << (l + 1), n << l, p.render_up_kernel,
                     S >> (l + 1));  // up: every pixel of the smaller side meets every tap
    }
    int64_t judges = 0;
    for (int scale = 0; scale < p.discriminator_scales; ++scale) {
      int64_t side = S >> scale, from = p.features + 3, to = p.discriminator_width;
      for (int l = 0; l < p.discriminator_layers + 2; ++l) {
        const bool halves = l < p.discriminator_layers;
        side = halves ? side / 2 + 1 : side + 1;  // kernel 4, padding 2
        const int64_t out = l == p.discriminator_layers + 1 ? 1 : to;
        judges += Work(from, out, 4, side);
        from = to;
        to = std::min<int64_t>(2 * to, 8 * p.discriminator_width);
      }
    }
    EXPECT_EQ(NumbersOf(CardOf("photo", name), "multiply-adds "), (std::vector<int64_t>{feature, render, judges}));
  }
  // The pose-guided renderer's, as other tests and docs/guided_renderer.md have them: SilNet, GarNet, RenderNet.
  const std::map<std::string, std::pair<int64_t, int64_t>> known = {{"cpu", {3757081, 3926065152}},
                                                                    {"tiny", {828553, 584646656}}};
  for (const auto& [name, sizes] : known) {
    const std::string& card = CardOf("guided", name);
    const std::vector<int64_t> parameters = NumbersOf(card, "parameters "), work = NumbersOf(card, "multiply-adds ");
    ASSERT_EQ(parameters.size(), 4U);
    EXPECT_EQ(parameters[0] + parameters[1] + parameters[2], sizes.first) << name;
    EXPECT_EQ(work[0] + work[1] + work[2], sizes.second) << name;
  }
  const std::string& paper = CardOf("guided", "paper");
  const std::vector<int64_t> parameters = NumbersOf(paper, "parameters "), work = NumbersOf(paper, "multiply-adds ");
  EXPECT_NEAR(1e-6 * static_cast<double>(parameters[0] + parameters[1] + parameters[2]), 210.4, 0.05);
  EXPECT_NEAR(1e-9 * static_cast<double>(work[0] + work[1] + work[2]), 146.9, 0.05);
}

TEST(Cards, AnEmptyBatchCountsAsOneImage) {
  const torch::NoGradGuard no_grad;
  GuidedConfig config = ToyGuided();
  config.profile.spectral_norm = true;
  RenderNet net(config);
  net->eval();
  const auto count = [&](int64_t batch) {
    return CountMultiplyAdds([&] {
      const RenderCode code = net->EncodeSource(torch::zeros({batch, 11, 32, 32}));
      net(code.mean, torch::zeros({batch, 8, 32, 32}), torch::zeros({batch, 4, 32, 32}),
          torch::zeros({batch, 3, 32, 32}));
    });
  };
  EXPECT_GT(count(1), 0);
  EXPECT_EQ(count(0), count(1));
  EXPECT_GT(count(3), 2 * count(1));
}

/// Small enough that every input may be moved by itself.
GuidedConfig SmallGuided() {
  GuidedConfig config;
  config.profile = {"small", 8, 8, {2, 3}, {2, 3}, {3, 3}, 2, 2, 2, false, false, 2, 16, 16};
  return config;
}

Tensor Doubles(int64_t channels, int64_t side) { return torch::randn({1, channels, side, side}, torch::kDouble); }

void ExpectRightDerivatives(const std::function<Tensor(const std::vector<Tensor>&)>& function,
                            const std::vector<Tensor>& inputs) {
  const GradientCheck check = CheckGradients(function, inputs);
  EXPECT_LT(check.max_error, 1e-5);
  EXPECT_GT(check.num_nonzero, check.num_compared / 2);
}

TEST(Derivatives, OfSilNetAndGarNet) {
  torch::manual_seed(21);
  SilNet sil(SmallGuided());
  GarNet gar(SmallGuided());
  sil->to(torch::kDouble);
  gar->to(torch::kDouble);
  const Tensor weights = Doubles(1, 8), classes = Doubles(7, 8);
  const Tensor sil_head = sil->decoder->head->weight.detach().clone(),
               gar_head = gar->decoder->head->weight.detach().clone();
  ExpectRightDerivatives(
      [&](const std::vector<Tensor>& in) {
        sil->decoder->head->weight = in[2];
        return (weights * sil(sil->EncodeSource(in[0]), in[1], Tensor())).sum();
      },
      {Doubles(5, 8), Doubles(3, 8), sil_head});
  ExpectRightDerivatives(
      [&](const std::vector<Tensor>& in) {
        gar->decoder->head->weight = in[2];
        return (classes * gar(gar->EncodeSource(in[0]), in[1])).sum();
      },
      {Doubles(5, 8), Doubles(5, 8), gar_head});
}

TEST(Derivatives, OfASilNetThatIsToldOfTheClothes) {
  torch::manual_seed(25);
  GuidedConfig config = SmallGuided();
  config.profile.start_from_body = config.profile.contour_hints = true;
  SilNet sil(config);
  sil->to(torch::kDouble);
  const Tensor weights = Doubles(1, 8), pose = Doubles(3, 8);
  ExpectRightDerivatives(
      [&](const std::vector<Tensor>& in) {
        sil->decoder->head->weight = in[2];
        return (weights * sil(sil->EncodeSource(in[0]), pose, in[1])).sum();
      },
      {Doubles(5, 8), Doubles(3, 8), sil->decoder->head->weight.detach().clone()});
}

TEST(Derivatives, OfThePoseGuidedRenderNet) {
  for (const bool drawn : {true, false}) {
    torch::manual_seed(22);
    GuidedConfig config = SmallGuided();
    config.kl = drawn;
    RenderNet net(config);
    net->to(torch::kDouble);
    const Tensor weights = Doubles(3, 8), noise = Doubles(2, 2);
    ExpectRightDerivatives(
        [&](const std::vector<Tensor>& in) {
          net->full->conv1->conv->weight = in[3];
          const Tensor code = Draw(net->EncodeSource(in[0]), drawn ? noise : Tensor());
          return (weights * net(code, in[1], in[2], in[4])).sum();
        },
        {Doubles(5, 8), Doubles(2, 8), Doubles(4, 8), net->full->conv1->conv->weight.detach().clone(), Doubles(3, 8)});
  }
}

TEST(Derivatives, OfDiscriminatorsAndOfTheTextureLoss) {
  torch::manual_seed(23);
  MultiScaleDiscriminator judge(PatchDiscriminatorOptions{3, 2, 1, 2}, 2);
  judge->to(torch::kDouble);
  const Tensor first = judge->scales[1]->layers[0]->weight.detach().clone();
  ExpectRightDerivatives(
      [&](const std::vector<Tensor>& in) {
        judge->scales[1]->layers[0]->weight = in[1];
        return DiscriminatorLoss(judge(in[0]), judge(0.5 * in[0] + 0.1)) + GeneratorLoss(judge(in[0]));
      },
      {Doubles(3, 16), first});
  const TextureTensors source = {Doubles(3, 6), (torch::rand({1, 1, 6, 6}) > 0.4).to(torch::kDouble), {}},
                       target = {Doubles(3, 6), (torch::rand({1, 1, 6, 6}) > 0.4).to(torch::kDouble), {}};
  ExpectRightDerivatives([&](const std::vector<Tensor>& in) { return TextureLoss(in[0], source, target); },
                         {Doubles(3, 6)});
}

/// Losses of the first and the last of so many steps on one batch.
std::pair<double, double> LearnByHeart(torch::nn::Module& network, const std::function<Tensor()>& loss, int steps,
                                       double rate) {
  network.train();
  const std::unique_ptr<torch::optim::Adam> adam = MakeAdam(network, rate);
  std::pair<double, double> losses;
  for (int step = 0; step < steps; ++step) {
    adam->zero_grad();
    const Tensor value = loss();
    value.backward();
    adam->step();
    (step == 0 ? losses.first : losses.second) = value.item<double>();
  }
  return losses;
}

class GuidedByHeart : public ::testing::Test {
 protected:
  void SetUp() override {
    torch::manual_seed(24);
    model_ = GuidedModel(config_);
    batch_ = MakeGuidedBatch(people_, config_, 1, 0, 2, 2);
  }
  GuidedSource Source() { return CroppedEach(model_->EncodeSource(batch_.source), batch_.boxes); }

  GuidedConfig config_ = ToyGuided();
  PhotoSource people_ = ToyPeople(2, 4);
  GuidedModel model_{nullptr};
  GuidedBatch batch_;
};

TEST_F(GuidedByHeart, SilNet) {
  Tensor predicted;
  const auto [first, last] = LearnByHeart(
      *model_->sil,
      [&] {
        predicted = torch::sigmoid(model_->Silhouette(Source(), batch_.target.pose, batch_.pseudo, batch_.Whole()));
        return L1Loss(predicted, batch_.target.silhouette);
      },
      100, 5e-3);
  EXPECT_GT(first, 0.3);
  EXPECT_LT(last, 0.01);
  EXPECT_GT(((predicted > 0.5) == (batch_.target.silhouette > 0.5)).to(torch::kFloat).mean().item<double>(), 0.99);
}

TEST_F(GuidedByHeart, GarNet) {
  const Tensor classes = batch_.target.classes.squeeze(1).to(torch::kLong);
  Tensor predicted;
  const auto [first, last] = LearnByHeart(
      *model_->gar,
      [&] {
        predicted = model_->Labels(Source(), batch_.target.pose, batch_.target.silhouette, batch_.pseudo.classes,
                                   batch_.Whole());
        return SoftLabelCrossEntropy(predicted, OneHot(classes, kPhotoLabels));
      },
      100, 5e-3);
  EXPECT_GT(first, 0.3);
  EXPECT_LT(last, 0.02);
  EXPECT_TRUE(torch::equal(predicted.argmax(1), classes));
}

TEST_F(GuidedByHeart, RenderNet) {
  const auto [first, last] = LearnByHeart(
      *model_->render,
      [&] {
        const GuidedSource source = Source();
        const auto [image, mask] = model_->Render(source.render_code.mean, batch_.target.pose, batch_.target.silhouette,
                                                  batch_.target.classes, batch_.pseudo, batch_.Whole());
        return L1Loss(image, batch_.target.image);
      },
      150, 5e-3);
  EXPECT_GT(first, 0.02) << "a new network repeats what is known, and not all is known";
  EXPECT_LT(last, 0.2 * first);
}

TEST_F(GuidedByHeart, Discriminator) {
  PatchDiscriminator judge = GuidedDiscriminator(config_);
  const Tensor labels = model_->LabelMap(batch_.target.classes), image = batch_.target.image,
               rough = image + 0.3 * torch::randn_like(image);
  const auto [first, last] = LearnByHeart(
      *judge,
      [&] {
        return DiscriminatorLoss({judge(torch::cat({labels, image}, 1))}, {judge(torch::cat({labels, rough}, 1))});
      },
      60, 2e-3);
  EXPECT_GT(first, 0.5);
  EXPECT_LT(last, 0.05);
}

class PhotoByHeart : public ::testing::Test {
 protected:
  void SetUp() override {
    torch::manual_seed(25);
    model_ = PhotoModel(ToyPhotoConfig());
    const PhotoPair pairs[] = {{0, 0, 1}, {1, 2, 0}};
    batch_ = MakePhotoBatch(ToyPhotos(2, 3), pairs, 2, model_->config.SmallestSide());
  }
  PhotoModel model_{nullptr};
  PhotoBatch batch_;
};

TEST_F(PhotoByHeart, FeatureNet) {
  const auto [first, last] = LearnByHeart(
      *model_->feature_net, [&] { return TextureLoss(model_->Complete(batch_.source), batch_.source, batch_.target); },
      300, 5e-3);
  EXPECT_GT(first, 0.1);
  EXPECT_LT(last, 0.15 * first);
}

TEST_F(PhotoByHeart, RenderNet) {
  Tensor projected;
  {
    const torch::NoGradGuard no_grad;
    projected = model_->Project(model_->Complete(batch_.source), batch_.pose);
  }
  Tensor alpha;
  const auto [first, last] = LearnByHeart(
      *model_->render_net,
      [&] {
        const PhotoResult result = model_->Render(projected, batch_.pose.body);
        alpha = result.alpha;
        return L1Loss(result.image, batch_.truth.image) +
               torch::binary_cross_entropy_with_logits(result.alpha_logit, batch_.truth.foreground);
      },
      250, 5e-3);
  // Begins with the colours that it is shown and a silhouette near the body's: what is left is clothes and sharpness.
  EXPECT_GT(first, 0.3);
  EXPECT_LT(last, 0.05);
  EXPECT_GT(((alpha > 0.5) == (batch_.truth.foreground > 0.5)).to(torch::kFloat).mean().item<double>(), 0.99);
}

TEST_F(PhotoByHeart, Discriminators) {
  MultiScaleDiscriminator judge = PhotoDiscriminator(model_->config);
  const Tensor image = batch_.truth.image, rough = image + 0.5 * torch::randn_like(image);
  Tensor projected;
  {
    const torch::NoGradGuard no_grad;
    projected = model_->Project(model_->Complete(batch_.source), batch_.pose);
  }
  const auto [first, last] = LearnByHeart(
      *judge,
      [&] {
        return DiscriminatorLoss(judge(torch::cat({projected, image}, 1)), judge(torch::cat({projected, rough}, 1)));
      },
      200, 5e-3);
  EXPECT_GT(first, 1);  // two scales that toss coins: 2 ln 2
  EXPECT_LT(last, 0.3 * first);
}

}  // namespace
}  // namespace bodyloom::one_photo_networks_test
