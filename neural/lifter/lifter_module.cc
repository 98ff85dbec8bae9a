// SPDX-License-Identifier: Apache-2.0
#include "neural/lifter/lifter_module.h"

#include <cstring>
#include <string>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace nn = torch::nn;

nn::Conv1d Convolution(int from, int to, int kernel, int dilation) {
  return nn::Conv1d(
      nn::Conv1dOptions(from, to, kernel).dilation(dilation).padding(kernel == 1 ? 0 : dilation).bias(true));
}

/// Layer norm over the channels of each frame: B×C×T.
torch::Tensor PerFrame(nn::LayerNorm& norm, const torch::Tensor& x) { return norm(x.transpose(1, 2)).transpose(1, 2); }

/// out×in×k → out × (k·in), columns ordered by tap.
RowMatrixXf TapsByColumn(const torch::Tensor& weight) {
  const torch::Tensor taps = weight.detach().permute({0, 2, 1}).contiguous().to(torch::kFloat);
  return Eigen::Map<const RowMatrixXf>(taps.data_ptr<float>(), taps.size(0), taps.size(1) * taps.size(2));
}

Eigen::VectorXf Vector(const torch::Tensor& tensor) {
  const torch::Tensor values = tensor.detach().contiguous().to(torch::kFloat);
  return Eigen::Map<const Eigen::VectorXf>(values.data_ptr<float>(), values.numel());
}

void SetConvolution(const RowMatrixXf& matrix, const Eigen::VectorXf& bias, nn::Conv1d* convolution) {
  torch::Tensor weight = (*convolution)->weight;
  BODYLOOM_CHECK(matrix.rows() == weight.size(0) && matrix.cols() == weight.size(1) * weight.size(2) &&
                     bias.size() == weight.size(0),
                 "lifter: weights of ", matrix.rows(), "x", matrix.cols(), " for a convolution of ", weight.size(0),
                 "x", weight.size(1) * weight.size(2));
  const torch::NoGradGuard no_grad;
  weight.copy_(torch::from_blob(const_cast<float*>(matrix.data()), {weight.size(0), weight.size(2), weight.size(1)})
                   .permute({0, 2, 1}));
  (*convolution)->bias.copy_(torch::from_blob(const_cast<float*>(bias.data()), {bias.size()}));
}

void SetNorm(const Eigen::VectorXf& scale, const Eigen::VectorXf& shift, nn::LayerNorm* norm) {
  BODYLOOM_CHECK(scale.size() == (*norm)->weight.numel() && shift.size() == scale.size(), "lifter: a norm of ",
                 scale.size(), " channels for one of ", (*norm)->weight.numel());
  const torch::NoGradGuard no_grad;
  (*norm)->weight.copy_(torch::from_blob(const_cast<float*>(scale.data()), {scale.size()}));
  (*norm)->bias.copy_(torch::from_blob(const_cast<float*>(shift.data()), {shift.size()}));
}

/// Breaks the symmetry between hypotheses: their initial depths differ, and every initial σ is 0.1.
void SpreadHypotheses(nn::Conv1d* output) {
  const torch::NoGradGuard no_grad;
  (*output)->weight.mul_(0.1);
  torch::Tensor bias = (*output)->bias;
  bias.zero_();
  const auto set_sigma = [&](int offset) {
    bias[offset + 3] = -2.3;
    bias[offset + 4] = -2.3;
  };
  for (int i = 0; i < static_cast<int>(LifterOutput::kTorso.size()); ++i) set_sigma(LifterOutput::TorsoOffset(i));
  for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
    for (int m = 0; m < LifterOutput::kHypotheses; ++m) {
      for (int i = 0; i < static_cast<int>(LifterOutput::LimbPoints(limb).size()); ++i) {
        const int offset = LifterOutput::PointOffset(limb, m, i);
        set_sigma(offset);
        bias[offset + 2] = 0.25 * (m - 1);
      }
    }
  }
}

}  // namespace

LifterModuleImpl::LifterModuleImpl(int num_inputs, int width, const std::vector<int>& block_dilations)
    : dilations(block_dilations) {
  BODYLOOM_CHECK(num_inputs > 0 && width > 0, "lifter: ", num_inputs, " inputs and ", width, " channels");
  input = register_module("input", Convolution(num_inputs, width, 3, 1));
  for (size_t b = 0; b < dilations.size(); ++b) {
    const std::string name = "block" + std::to_string(b);
    norms.push_back(register_module(name + "_norm", nn::LayerNorm(nn::LayerNormOptions({width}))));
    dilated.push_back(register_module(name + "_dilated", Convolution(width, width, 3, dilations[b])));
    mix.push_back(register_module(name + "_mix", Convolution(width, width, 1, 1)));
  }
  norm = register_module("norm", nn::LayerNorm(nn::LayerNormOptions({width})));
  output = register_module("output", Convolution(width, LifterOutput::kSize, 1, 1));
  SpreadHypotheses(&output);
}

torch::Tensor LifterModuleImpl::forward(const torch::Tensor& x) {
  torch::Tensor h = input(x);
  for (size_t b = 0; b < dilations.size(); ++b) {
    h = h + mix[b](torch::silu(dilated[b](PerFrame(norms[b], h))));
  }
  return output(PerFrame(norm, h));
}

LifterWeights ExportLifter(const LifterModule& module) {
  LifterWeights weights;
  weights.input = TapsByColumn(module->input->weight);
  weights.input_bias = Vector(module->input->bias);
  for (size_t b = 0; b < module->dilations.size(); ++b) {
    weights.blocks.push_back({module->dilations[b], Vector(module->norms[b]->weight), Vector(module->norms[b]->bias),
                              TapsByColumn(module->dilated[b]->weight), Vector(module->dilated[b]->bias),
                              TapsByColumn(module->mix[b]->weight), Vector(module->mix[b]->bias)});
  }
  weights.norm_scale = Vector(module->norm->weight);
  weights.norm_shift = Vector(module->norm->bias);
  weights.output = TapsByColumn(module->output->weight);
  weights.output_bias = Vector(module->output->bias);
  return weights;
}

void ImportLifter(const LifterWeights& weights, LifterModule* module) {
  LifterModuleImpl& to = **module;
  BODYLOOM_CHECK(weights.blocks.size() == to.dilations.size(), "lifter: weights of ", weights.blocks.size(),
                 " blocks for a network of ", to.dilations.size());
  SetConvolution(weights.input, weights.input_bias, &to.input);
  for (size_t b = 0; b < to.dilations.size(); ++b) {
    const LifterWeights::Block& block = weights.blocks[b];
    BODYLOOM_CHECK(block.dilation == to.dilations[b], "lifter: block ", b, " has dilation ", block.dilation,
                   ", the network ", to.dilations[b]);
    SetNorm(block.norm_scale, block.norm_shift, &to.norms[b]);
    SetConvolution(block.dilated, block.dilated_bias, &to.dilated[b]);
    SetConvolution(block.mix, block.mix_bias, &to.mix[b]);
  }
  SetNorm(weights.norm_scale, weights.norm_shift, &to.norm);
  SetConvolution(weights.output, weights.output_bias, &to.output);
}

}  // namespace bodyloom
