// SPDX-License-Identifier: Apache-2.0
// Blocks, U-Net, discriminators and UV sampler: shapes, sizes, formulas, derivatives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/torch.h>
#include <algorithm>
#include <vector>

#include <cmath>
#include <limits>

#include "neural/networks/blocks.h"
#include "neural/networks/patch_discriminator.h"
#include "neural/networks/unet.h"
#include "neural/networks/uv_sampler.h"
#include "tests/support/gradient_check.h"

namespace bodyloom::networks_test {
namespace {

using ::testing::HasSubstr;
using torch::Tensor;

using Shape = std::vector<int64_t>;

int64_t NumParameters(const torch::nn::Module& module) {
  int64_t count = 0;
  for (const Tensor& p : module.parameters()) count += p.numel();
  return count;
}

template <class Function>
std::string InvalidArgument(Function&& function) {
  try {
    function();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

/// One channel's instance norm and rectifier, spelled out.
Tensor SlowNormAndActivation(Tensor x, NormOrder order) {
  x = x.clone();
  const auto rectify = [](double v) { return v > 0 ? v : 0.2 * v; };
  for (int64_t b = 0; b < x.size(0); ++b) {
    for (int64_t c = 0; c < x.size(1); ++c) {
      Tensor plane = x[b][c];  // a view
      auto p = plane.accessor<double, 2>();
      double sum = 0, squares = 0;
      const double n = static_cast<double>(plane.numel());
      for (int pass = 0; pass < 2; ++pass) {
        if ((pass == 0) == (order == NormOrder::kActivationFirst)) {
          for (int64_t i = 0; i < p.size(0); ++i) {
            for (int64_t j = 0; j < p.size(1); ++j) p[i][j] = rectify(p[i][j]);
          }
        } else {
          for (int64_t i = 0; i < p.size(0); ++i) {
            for (int64_t j = 0; j < p.size(1); ++j) sum += p[i][j], squares += p[i][j] * p[i][j];
          }
          const double mean = sum / n, deviation = std::sqrt(squares / n - mean * mean + 1e-5);
          for (int64_t i = 0; i < p.size(0); ++i) {
            for (int64_t j = 0; j < p.size(1); ++j) p[i][j] = (p[i][j] - mean) / deviation;
          }
        }
      }
    }
  }
  return x;
}

TEST(Blocks, ConvBlockIsThreeConvolutionsWithNormAndRectifier) {
  torch::manual_seed(1);
  for (const NormOrder order : {NormOrder::kNormFirst, NormOrder::kActivationFirst}) {
    ConvBlock block(3, 5, order);
    block->to(torch::kDouble);
    const torch::NoGradGuard no_grad;
    const Tensor x = torch::randn({2, 3, 6, 8}, torch::kDouble);
    Tensor y = SlowNormAndActivation(torch::conv2d(x, block->conv1->weight, block->conv1->bias, 1, 1), order);
    y = SlowNormAndActivation(torch::conv2d(y, block->conv2->weight, block->conv2->bias, 1, 1), order);
    y = SlowNormAndActivation(torch::conv2d(y, block->down->weight, block->down->bias, 2, 1), order);
    const Tensor fast = block(x);
    EXPECT_EQ(fast.sizes(), Shape({2, 5, 3, 4}));
    EXPECT_LT((fast - y).abs().max().item<double>(), 1e-10);
    EXPECT_EQ(block->conv1->bias.defined(), order == NormOrder::kActivationFirst);
  }
}

TEST(Blocks, DeconvBlockEndsWithARectifierAndNoNorm) {
  torch::manual_seed(2);
  for (const NormOrder order : {NormOrder::kNormFirst, NormOrder::kActivationFirst}) {
    DeconvBlock block(3, 4, 5, order);
    block->to(torch::kDouble);
    const torch::NoGradGuard no_grad;
    block->up->bias.normal_();
    const Tensor x = torch::randn({2, 3, 4, 3}, torch::kDouble);
    Tensor y = SlowNormAndActivation(torch::conv2d(x, block->conv1->weight, block->conv1->bias, 1, 1), order);
    y = SlowNormAndActivation(torch::conv2d(y, block->conv2->weight, block->conv2->bias, 1, 1), order);
    y = SlowNormAndActivation(torch::conv2d(y, block->conv3->weight, block->conv3->bias, 1, 1), order);
    y = torch::conv_transpose2d(y, block->up->weight, block->up->bias, 2, 1);
    y = torch::where(y > 0, y, 0.2 * y);
    const Tensor fast = block(x);
    EXPECT_EQ(fast.sizes(), Shape({2, 5, 8, 6}));
    EXPECT_LT((fast - y).abs().max().item<double>(), 1e-10);
  }
}

// The rectifiers work in place; the backward pass must not notice.
TEST(Blocks, GradientsOfInputAndWeights) {
  torch::manual_seed(3);
  for (const NormOrder order : {NormOrder::kNormFirst, NormOrder::kActivationFirst}) {
    ConvBlock down(2, 3, order);
    DeconvBlock up(3, 2, 2, order);
    down->to(torch::kDouble);
    up->to(torch::kDouble);
    const Tensor weights = torch::randn({1, 2, 8, 4}, torch::kDouble);
    const auto check = CheckGradients(
        [&](const std::vector<Tensor>& in) {
          down->conv2->weight = in[1];
          return (up(down(in[0])) * weights).sum();
        },
        {torch::randn({1, 2, 8, 4}, torch::kDouble), down->conv2->weight.detach()});
    EXPECT_LT(check.max_error, 1e-5);
    EXPECT_EQ(check.num_compared, 64 + 81);
    EXPECT_GT(check.num_nonzero, 60);
  }
}

TEST(Blocks, WeightsStartWithUnitGain) {
  torch::manual_seed(4);
  ConvBlock block(64, 64);
  EXPECT_NEAR(block->conv2->weight.std().item<double>(), std::sqrt(2 / 1.04 / 576), 0.001);
  EXPECT_NEAR(block->down->weight.std().item<double>(), std::sqrt(2 / 1.04 / 1024), 0.001);
  EXPECT_NEAR(DeconvBlock(64, 64, 64)->up->weight.std().item<double>(), std::sqrt(2 / 1.04 / 256), 0.001);
}

// Sizes of the paper profile: E and D_s.
TEST(TransposedConv, EqualsTheLayerWithItsGradients) {
  torch::manual_seed(4);
  for (const auto& [kernel, output_padding, bias] :
       {std::tuple(4, 0, true), std::tuple(4, 0, false), std::tuple(3, 1, true)}) {
    torch::nn::ConvTranspose2d layer(
        torch::nn::ConvTranspose2dOptions(3, 5, kernel).stride(2).padding(1).output_padding(output_padding).bias(bias));
    layer->to(torch::kDouble);
    for (const auto& [height, width] : {std::pair(1, 1), std::pair(6, 5), std::pair(2, 9)}) {
      Tensor x = torch::randn({2, 3, height, width}, torch::kDouble).requires_grad_();
      const Tensor wanted = layer->forward(x), made = TransposedConv(x, layer->weight, layer->bias, 1, output_padding);
      ASSERT_EQ(made.sizes(), wanted.sizes());
      EXPECT_LT((made - wanted).abs().max().item<double>(), 1e-13);
      const Tensor weights = torch::randn_like(wanted);
      std::vector<Tensor> inputs = {x, layer->weight};
      if (bias) inputs.push_back(layer->bias);
      const auto expected = torch::autograd::grad({(wanted * weights).sum()}, inputs);
      const auto found = torch::autograd::grad({(made * weights).sum()}, inputs);
      for (size_t i = 0; i < inputs.size(); ++i) {
        EXPECT_LT((found[i] - expected[i]).abs().max().item<double>(), 1e-12) << "input " << i;
      }
    }
  }
}

TEST(TransposedConv, RefusesWhatDoesNotDouble) {
  const Tensor x = torch::randn({1, 2, 4, 4}), five = torch::randn({2, 3, 5, 5}), four = torch::randn({2, 3, 4, 4});
  EXPECT_THROW(TransposedConv(x, five, {}, 1, 0), std::invalid_argument);
  EXPECT_THROW(TransposedConv(x, four, {}, 0, 0), std::invalid_argument);
  EXPECT_THROW(TransposedConv(x, four, {}, 1, 1), std::invalid_argument);
}

TEST(UNet, SizesOfThePaperProfile) {
  EXPECT_EQ(NumParameters(*UNet(UNetOptions{33, {16}, {64, 128, 256}})), 5775184);
  EXPECT_EQ(NumParameters(*UNet(UNetOptions{23, {7}, {64, 128, 256, 512, 512}})), 45807495);
}

TEST(UNet, EveryHeadHasTheInputsSize) {
  UNet net(UNetOptions{4, {7, 3, 1}, {4, 6, 8}});
  const auto out = net(torch::randn({2, 4, 16, 8}));
  ASSERT_EQ(out.size(), 3U);
  EXPECT_EQ(out[0].sizes(), Shape({2, 7, 16, 8}));
  EXPECT_EQ(out[1].sizes(), Shape({2, 3, 16, 8}));
  EXPECT_EQ(out[2].sizes(), Shape({2, 1, 16, 8}));
}

TEST(UNet, SkipsCarryTheEncodersMaps) {
  torch::manual_seed(5);
  UNet net(UNetOptions{2, {1}, {3, 4}});
  const torch::NoGradGuard no_grad;
  const Tensor x = torch::randn({1, 2, 16, 16});
  const Tensor fine = net->encoder[0](x), coarse = net->encoder[1](fine);
  const Tensor up = net->decoder[1](coarse);
  const Tensor by_hand = net->heads[0](net->decoder[0](torch::cat({up, fine}, 1)));
  EXPECT_TRUE(torch::equal(net(x)[0], by_hand));
  EXPECT_FALSE(torch::equal(net->heads[0](net->decoder[0](torch::cat({up, 0 * fine}, 1))), by_hand));
}

TEST(UNet, EveryParameterLearns) {
  torch::manual_seed(6);
  UNet net(UNetOptions{2, {2, 1}, {4, 4, 4}, /*decoder_min=*/6});
  EXPECT_EQ(net->decoder[0]->conv1->weight.size(0), 6);
  const auto out = net(torch::randn({1, 2, 32, 32}));
  (out[0].square().sum() + out[1].sum()).backward();
  for (const auto& p : net->named_parameters()) {
    ASSERT_TRUE(p.value().grad().defined()) << p.key();
    EXPECT_GT(p.value().grad().abs().max().item<double>(), 0) << p.key();
  }
}

TEST(UNet, RefusesSizesThatItCannotHalve) {
  UNet net(UNetOptions{2, {1}, {4, 4, 4}});
  EXPECT_THAT(InvalidArgument([&] { net(torch::zeros({1, 2, 16, 20})); }), HasSubstr("multiples of 8"));
  EXPECT_THAT(InvalidArgument([&] { net(torch::zeros({1, 2, 8, 8})); }), HasSubstr("at least two pixels"));
  EXPECT_THAT(InvalidArgument([&] { net(torch::zeros({1, 3, 16, 16})); }), HasSubstr("[1, 3, 16, 16]"));
  EXPECT_THAT(InvalidArgument([&] { UNet(UNetOptions{2, {}, {4}}); }), HasSubstr("0 heads"));
  EXPECT_NO_THROW(net(torch::zeros({1, 2, 16, 8})));
}

/// Receptive field of one output pixel along a side, input pixels.
int ReceptiveField(int n_layers) {
  torch::manual_seed(7);
  PatchDiscriminator d(PatchDiscriminatorOptions{1, 2, n_layers});
  int size = 1;  // by the convolutions alone: IN looks at everything
  for (auto layer = d->layers.rbegin(); layer != d->layers.rend(); ++layer) {
    const int stride = static_cast<int>((*layer)->options.stride()->at(0));
    size = (size - 1) * stride + static_cast<int>((*layer)->options.kernel_size()->at(0));
  }
  return size;
}

TEST(PatchDiscriminator, SeesPatchesOfTheNamedSize) {
  EXPECT_EQ(ReceptiveField(1), 34 - 18);
  EXPECT_EQ(ReceptiveField(2), 34);
  EXPECT_EQ(ReceptiveField(3), 70);
  EXPECT_EQ(ReceptiveField(4), 142);
}

TEST(PatchDiscriminator, SizesAndShapes) {
  PatchDiscriminator d(PatchDiscriminatorOptions{10, 4});
  EXPECT_EQ(d(torch::randn({2, 10, 64, 48})).sizes(), Shape({2, 1, 6, 4}));
  // 16·(64·10 + 64·128 + 128·256 + 256·512 + 512) weights, and biases where no norm follows
  EXPECT_EQ(NumParameters(*PatchDiscriminator(PatchDiscriminatorOptions{10, 64})), 2771009);
  EXPECT_THAT(InvalidArgument([&] { d(torch::zeros({1, 10, 31, 64})); }), HasSubstr("at least 32"));
  EXPECT_NO_THROW(d(torch::randn({1, 10, 32, 32})));
}

TEST(PatchDiscriminator, SeveralScales) {
  torch::manual_seed(8);
  // Three scales of 19 channels are published as 8.3 million numbers.
  EXPECT_NEAR(NumParameters(*MultiScaleDiscriminator(PatchDiscriminatorOptions{19, 64, 3, 2}, 3)), 8.3e6, 0.05e6);
  MultiScaleDiscriminator d(PatchDiscriminatorOptions{3, 4, 3, 2}, 3);
  const Tensor x = torch::randn({1, 3, 128, 128});
  const auto logits = d(x);
  ASSERT_EQ(logits.size(), 3U);
  EXPECT_EQ(logits[0].sizes(), Shape({1, 1, 19, 19}));
  EXPECT_EQ(logits[1].sizes(), Shape({1, 1, 11, 11}));
  EXPECT_EQ(logits[2].sizes(), Shape({1, 1, 7, 7}));
  // A constant image stays constant at the border of the coarser scales: padded pixels do not count.
  EXPECT_TRUE(torch::equal(d->scales[1](torch::ones({1, 3, 64, 64})), d(torch::ones({1, 3, 128, 128}))[1]));
}

/// Π with loops.
Tensor SlowSampleUv(const Tensor& features, const Tensor& uv, const Tensor& mask) {
  const auto f = features.accessor<double, 4>();
  const auto c = uv.accessor<double, 4>();
  const auto m = mask.accessor<double, 4>();
  Tensor result = torch::zeros({features.size(0), features.size(1), uv.size(2), uv.size(3)}, torch::kDouble);
  auto out = result.accessor<double, 4>();
  const int H = static_cast<int>(features.size(2)), W = static_cast<int>(features.size(3));
  for (int b = 0; b < f.size(0); ++b) {
    for (int y = 0; y < c.size(2); ++y) {
      for (int x = 0; x < c.size(3); ++x) {
        if (m[b][0][y][x] == 0) continue;
        const double column = std::clamp(c[b][0][y][x] * W - 0.5, 0.0, W - 1.0);
        const double row = std::clamp((1 - c[b][1][y][x]) * H - 0.5, 0.0, H - 1.0);
        const int c0 = static_cast<int>(column), r0 = static_cast<int>(row);
        const int c1 = std::min(c0 + 1, W - 1), r1 = std::min(r0 + 1, H - 1);
        const double s = column - c0, t = row - r0;
        for (int k = 0; k < f.size(1); ++k) {
          out[b][k][y][x] = m[b][0][y][x] * ((1 - t) * ((1 - s) * f[b][k][r0][c0] + s * f[b][k][r0][c1]) +
                                             t * ((1 - s) * f[b][k][r1][c0] + s * f[b][k][r1][c1]));
        }
      }
    }
  }
  return result;
}

TEST(UvSampler, EqualsLoops) {
  torch::manual_seed(9);
  const Tensor features = torch::randn({2, 3, 5, 7}, torch::kDouble);
  const Tensor uv = torch::rand({2, 2, 9, 11}, torch::kDouble) * 1.2 - 0.1;  // also beyond the border
  const Tensor mask = (torch::rand({2, 1, 9, 11}, torch::kDouble) > 0.3).to(torch::kDouble);
  const Tensor sampled = SampleUv(features, uv, mask);
  EXPECT_LT((sampled - SlowSampleUv(features, uv, mask)).abs().max().item<double>(), 1e-13);
  EXPECT_GT((mask == 0).sum().item<int>(), 10);
  EXPECT_EQ((sampled * (1 - mask)).abs().max().item<double>(), 0);
}

TEST(UvSampler, TexelCentresReturnTheTexels) {
  const Tensor features = torch::arange(12, torch::kDouble).view({1, 1, 3, 4});
  Tensor uv = torch::zeros({1, 2, 3, 4}, torch::kDouble);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) {
      uv[0][0][r][c] = (c + 0.5) / 4;
      uv[0][1][r][c] = 1 - (r + 0.5) / 3;
    }
  }
  const Tensor sampled = SampleUv(features, uv, torch::ones({1, 1, 3, 4}, torch::kDouble));
  EXPECT_LT((sampled - features).abs().max().item<double>(), 1e-12);
}

TEST(UvSampler, GradientsOfFeaturesUvAndMask) {
  torch::manual_seed(10);
  const Tensor uv = torch::rand({1, 2, 4, 5}, torch::kDouble) * 0.7 + 0.15;
  const Tensor weights = torch::randn({1, 2, 4, 5}, torch::kDouble);
  const Tensor mask = torch::rand({1, 1, 4, 5}, torch::kDouble) + 0.1;
  const auto check =
      CheckGradients([&](const std::vector<Tensor>& in) { return (SampleUv(in[0], in[1], in[2]) * weights).sum(); },
                     {torch::randn({1, 2, 6, 5}, torch::kDouble), uv, mask});
  EXPECT_LT(check.max_error, 1e-5);
  EXPECT_EQ(check.num_compared, 60 + 40 + 20);
  EXPECT_GT(check.num_nonzero, 80);
}

TEST(UvSampler, WhatLiesOffTheBodyDoesNotMatter) {
  torch::manual_seed(11);
  Tensor features = torch::randn({1, 2, 4, 4}).requires_grad_(true);
  Tensor uv = torch::rand({1, 2, 1, 2});
  uv.index_put_({0, torch::indexing::Slice(), 0, 1}, std::numeric_limits<float>::quiet_NaN());
  uv.requires_grad_(true);
  const Tensor mask = torch::tensor({1.0F, 0.0F}).view({1, 1, 1, 2});
  const Tensor sampled = SampleUv(features, uv, mask);
  EXPECT_EQ(sampled[0][0][0][1].item<float>(), 0);
  sampled.sum().backward();
  EXPECT_TRUE(torch::isfinite(features.grad()).all().item<bool>());
  EXPECT_TRUE(torch::isfinite(uv.grad()).all().item<bool>());
  EXPECT_EQ(uv.grad()[0][0][0][1].item<float>(), 0);
  EXPECT_THAT(InvalidArgument([&] { SampleUv(features, uv, torch::ones({1, 1, 2, 2})); }), HasSubstr("[1, 1, 2, 2]"));
}

/// One plane and its mask.
struct Plane {
  int height = 0, width = 0;
  std::vector<double> x, mask;
};

double Enlarged(const Plane& small, int y, int x) {
  const double v = std::max(0.0, (y + 0.5) / 2 - 0.5), u = std::max(0.0, (x + 0.5) / 2 - 0.5);
  const int i = static_cast<int>(v), j = static_cast<int>(u);
  const int i1 = std::min(i + 1, small.height - 1), j1 = std::min(j + 1, small.width - 1);
  const double s = v - i, t = u - j;
  const auto at = [&](int row, int column) { return small.x[row * small.width + column]; };
  return (1 - s) * ((1 - t) * at(i, j) + t * at(i, j1)) + s * ((1 - t) * at(i1, j) + t * at(i1, j1));
}

/// The definition, pixel by pixel.
std::vector<double> SlowPullPush(const Plane& plane, int levels) {
  const auto pixels = static_cast<size_t>(plane.height) * plane.width;
  std::vector<double> result(pixels, 0);
  for (size_t i = 0; i < pixels; ++i) result[i] = plane.mask[i] > 0 ? plane.x[i] : 0;
  if (levels == 0 || plane.height % 2 != 0 || plane.width % 2 != 0) return result;
  Plane coarse{plane.height / 2, plane.width / 2, {}, {}};
  for (int i = 0; i < coarse.height; ++i) {
    for (int j = 0; j < coarse.width; ++j) {
      double sum = 0;
      int count = 0;
      for (const int at : {2 * i * plane.width + 2 * j, 2 * i * plane.width + 2 * j + 1,
                           (2 * i + 1) * plane.width + 2 * j, (2 * i + 1) * plane.width + 2 * j + 1}) {
        if (plane.mask[at] == 0) continue;
        sum += plane.x[at];
        ++count;
      }
      coarse.x.push_back(count > 0 ? sum / count : 0);
      coarse.mask.push_back(count > 0 ? 1 : 0);
    }
  }
  coarse.x = SlowPullPush(coarse, levels - 1);
  for (size_t i = 0; i < pixels; ++i) {
    if (plane.mask[i] == 0) {
      result[i] = Enlarged(coarse, static_cast<int>(i) / plane.width, static_cast<int>(i) % plane.width);
    }
  }
  return result;
}

TEST(PullPush, AgreesWithItsDefinition) {
  torch::manual_seed(4);
  for (const double share : {0.02, 0.3, 0.9}) {
    const Tensor x = torch::randn({2, 3, 24, 16}, torch::kDouble);
    const Tensor mask = (torch::rand({2, 1, 24, 16}) < share).to(torch::kDouble);
    for (const int levels : {0, 1, 3, 9}) {  // 24 halves three times
      const Tensor filled = PullPush(x, mask, levels).contiguous();
      for (int64_t b = 0; b < 2; ++b) {
        for (int64_t c = 0; c < 3; ++c) {
          const auto values = [](const Tensor& plane) {
            const Tensor whole = plane.contiguous();
            return std::vector<double>(whole.data_ptr<double>(), whole.data_ptr<double>() + whole.numel());
          };
          const std::vector<double> expected = SlowPullPush({24, 16, values(x[b][c]), values(mask[b][0])}, levels);
          const std::vector<double> found = values(filled[b][c]);
          for (size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(found[i], expected[i], 1e-12) << share << " " << i;
        }
      }
    }
  }
}

TEST(PullPush, OneColourFillsWhatItReachesAndNothingStaysNothing) {
  Tensor mask = torch::zeros({1, 1, 32, 32});
  mask.slice(2, 10, 12).slice(3, 4, 30).fill_(1);
  const Tensor filled = PullPush(torch::full({1, 1, 32, 32}, 0.7), mask, 5);
  EXPECT_LT((filled - 0.7).abs().max().item<float>(), 1e-6);
  EXPECT_EQ(PullPush(torch::ones({1, 2, 32, 32}), torch::zeros({1, 1, 32, 32}), 5).abs().max().item<float>(), 0);
  // Masked pixels have no influence.
  Tensor odd = torch::full({1, 1, 32, 32}, 1e6);
  odd.slice(2, 10, 12).slice(3, 4, 30).fill_(0.7);
  EXPECT_TRUE(torch::equal(PullPush(odd, mask, 5), filled));
  EXPECT_THROW(PullPush(odd, torch::ones({1, 1, 32, 16}), 5), std::invalid_argument);
  EXPECT_THROW(PullPush(odd, torch::ones({1, 2, 32, 32}), 5), std::invalid_argument);
}

TEST(PullPush, DerivativesAgreeWithDifferences) {
  torch::manual_seed(5);
  const Tensor mask = (torch::rand({1, 1, 8, 8}) < 0.3).to(torch::kDouble);
  const Tensor weights = torch::randn({1, 2, 8, 8}, torch::kDouble);
  const GradientCheck check =
      CheckGradients([&](const std::vector<Tensor>& x) { return (PullPush(x[0], mask, 3) * weights).sum(); },
                     {torch::randn({1, 2, 8, 8}, torch::kDouble)});
  EXPECT_LT(check.max_error, 1e-7);
  EXPECT_GT(check.num_nonzero, 10);
}

}  // namespace

}  // namespace bodyloom::networks_test
