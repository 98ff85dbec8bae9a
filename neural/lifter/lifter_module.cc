// SPDX-License-Identifier: Apache-2.0
#include "neural/lifter/lifter_module.h"

#include <cstring>
#include <string>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using torch::Tensor;
using Slice = torch::indexing::Slice;

constexpr double kLogSigmaLow = -5, kLogSigmaHigh = 1;
constexpr double kTiny = 1e-6;  ///< under square roots, for a finite derivative at zero

Tensor Indices(std::span<const int> values) {
  return torch::tensor(std::vector<int64_t>(values.begin(), values.end()), torch::kLong);
}

/// Errors of B×T×…×5 predictions against B×T×…×3 truths (broadcast): negative log likelihood without its constant, and
/// distance, B×T×….
struct PointErrors {
  Tensor nll, distance;
};
PointErrors Errors(const Tensor& predicted, const Tensor& truth) {
  const Tensor d = predicted.slice(-1, 0, 3) - truth;
  const Tensor log_sigma = predicted.slice(-1, 3, 5).clamp(kLogSigmaLow, kLogSigmaHigh);
  const Tensor xy2 = d.slice(-1, 0, 2).square().sum(-1), z2 = d.select(-1, 2).square();
  const Tensor log_xy = log_sigma.select(-1, 0), log_z = log_sigma.select(-1, 1);
  const Tensor r = (xy2 * torch::exp(-2 * log_xy) + z2 * torch::exp(-2 * log_z) + kTiny).sqrt();
  return {r + 2 * log_xy + log_z, (xy2 + z2 + kTiny).sqrt()};
}

struct Limb {
  Tensor log_weight;  ///< B×T×M
  Tensor points;      ///< B×T×M×n×5
  Tensor truth;       ///< B×T×1×n×3, or undefined
};
Limb TakeLimb(const Tensor& y, int limb, const Tensor& truth) {
  const int64_t n = static_cast<int64_t>(LifterOutput::LimbPoints(limb).size()), M = LifterOutput::kHypotheses;
  const int logits = LifterOutput::LogitOffset(limb);
  Limb result;
  result.log_weight = torch::log_softmax(y.slice(-1, logits, logits + M), -1);
  const int first = LifterOutput::PointOffset(limb, 0, 0);
  result.points = y.slice(-1, first, first + M * n * LifterOutput::kPerPoint)
                      .reshape({y.size(0), y.size(1), M, n, LifterOutput::kPerPoint});
  if (truth.defined()) {
    result.truth = truth.index_select(2, Indices(LifterOutput::LimbPoints(limb))).unsqueeze(2);
  }
  return result;
}

Tensor TakeTorso(const Tensor& y) {
  const int64_t n = static_cast<int64_t>(LifterOutput::kTorso.size());
  return y.slice(-1, 0, n * LifterOutput::kPerPoint).reshape({y.size(0), y.size(1), n, LifterOutput::kPerPoint});
}

/// B×T×21×3 with torso landmarks in place and limbs from `choose` (B×T×M weights of one limb's hypotheses).
template <typename Choose>
Tensor Assemble(const Tensor& y, const Tensor& truth, const Choose& choose) {
  Tensor points = torch::zeros({y.size(0), y.size(1), LifterOutput::kPoints, 3}, y.options());
  points = points.index_copy(2, Indices(LifterOutput::kTorso), TakeTorso(y).slice(-1, 0, 3));
  for (int l = 0; l < LifterOutput::kLimbs; ++l) {
    const Limb limb = TakeLimb(y, l, truth);
    const Tensor weights = choose(limb);
    points = points.index_copy(2, Indices(LifterOutput::LimbPoints(l)),
                               (weights.unsqueeze(-1).unsqueeze(-1) * limb.points.slice(-1, 0, 3)).sum(2));
  }
  return points;
}

Tensor OneHot(const Tensor& index) { return torch::one_hot(index, LifterOutput::kHypotheses).to(torch::kFloat); }

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

LifterLoss ComputeLifterLoss(const Tensor& output, const LifterTargets& targets, const LifterLossOptions& options) {
  const Tensor y = output.transpose(1, 2);  // B×T×outputs
  LifterLoss loss;
  // Torso: face with half weight, shoulders and hips with full weight.
  const PointErrors torso = Errors(TakeTorso(y), targets.points.index_select(2, Indices(LifterOutput::kTorso)));
  const Tensor torso_weight = torch::tensor({0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 1.F, 1.F, 1.F, 1.F});
  Tensor distance = (torso.distance * torso_weight).sum(-1), nll = (torso.nll * torso_weight).sum(-1);
  double total_weight = 6.5;
  std::vector<Tensor> posterior;
  for (int l = 0; l < LifterOutput::kLimbs; ++l) {
    const Limb limb = TakeLimb(y, l, targets.points);
    const PointErrors errors = Errors(limb.points, limb.truth);
    const Tensor joint = limb.log_weight - errors.nll.sum(-1);  // B×T×M
    posterior.push_back(torch::softmax(joint.detach(), -1));
    nll = nll - 1.5 * torch::logsumexp(joint, -1);
    distance = distance + 1.5 * (posterior.back() * errors.distance.sum(-1)).sum(-1);
    total_weight += 1.5 * static_cast<double>(LifterOutput::LimbPoints(l).size());
  }
  distance = distance.mean() / total_weight;
  nll = nll.mean() / total_weight;
  int next = 0;
  const Tensor points = Assemble(y, {}, [&](const Limb&) { return posterior[next++]; });
  const Tensor slip =
      (points.slice(1, 1) - points.slice(1, 0, -1)) - (targets.points.slice(1, 1) - targets.points.slice(1, 0, -1));
  const Tensor velocity =
      slip.numel() > 0 ? (slip.square().sum(-1) + kTiny).sqrt().mean() : torch::zeros({}, y.options());
  const Tensor up_log_sigma = y.select(-1, LifterOutput::kUp + 3).clamp(kLogSigmaLow, kLogSigmaHigh);
  const Tensor up_error =
      ((y.slice(-1, LifterOutput::kUp, LifterOutput::kUp + 3) - targets.up).square().sum(-1) + kTiny).sqrt();
  const Tensor up = (up_error * torch::exp(-up_log_sigma) + up_log_sigma).mean();
  const Tensor contact = torch::binary_cross_entropy_with_logits(
      y.slice(-1, LifterOutput::kContact, LifterOutput::kContact + 2), targets.contact);
  loss.total = distance + options.nll_weight * nll + options.velocity_weight * velocity + 0.1 * up + 0.05 * contact;
  loss.distance = distance.item<double>();
  loss.nll = nll.item<double>();
  loss.velocity = velocity.item<double>();
  loss.up = up_error.mean().item<double>();
  loss.contact = contact.item<double>();
  return loss;
}

Tensor LikeliestPoints(const Tensor& output) {
  return Assemble(output.transpose(1, 2), {}, [](const Limb& limb) { return OneHot(limb.log_weight.argmax(-1)); });
}

Tensor NearestPoints(const Tensor& output, const Tensor& truth) {
  return Assemble(output.transpose(1, 2), truth,
                  [](const Limb& limb) { return OneHot(Errors(limb.points, limb.truth).distance.sum(-1).argmin(-1)); });
}

}  // namespace bodyloom
