// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/refiner/refiner_module.h"

#include <cmath>
#include <string>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

namespace nn = torch::nn;
using torch::Tensor;

/// 2×2 pixels together.
Tensor Together(const Tensor& x) {
  const int64_t b = x.size(0), c = x.size(1), h = x.size(2), w = x.size(3);
  return x.reshape({b, c, h / 2, 2, w / 2, 2}).permute({0, 3, 5, 1, 2, 4}).reshape({b, 4 * c, h / 2, w / 2});
}

/// The other way.
Tensor Apart(const Tensor& x) {
  const int64_t b = x.size(0), c = x.size(1) / 4, h = x.size(2), w = x.size(3);
  return x.reshape({b, 2, 2, c, h, w}).permute({0, 3, 4, 1, 5, 2}).reshape({b, c, 2 * h, 2 * w});
}

Tensor Enlarged(const Tensor& x) {
  return nn::functional::interpolate(x, nn::functional::InterpolateFuncOptions()
                                            .size(std::vector<int64_t>{2 * x.size(2), 2 * x.size(3)})
                                            .mode(torch::kBilinear)
                                            .align_corners(false));
}

/// Whether there is one of `inside` up to `reach` pixels away along x and y, as numbers.
Tensor Near(const Tensor& inside, int64_t reach) {
  const int64_t window = 2 * reach + 1;
  return torch::max_pool2d(inside.to(torch::kFloat), {window, window}, {1, 1}, {reach, reach});
}

}  // namespace

RefinerModuleImpl::RefinerModuleImpl() {
  const torch::NoGradGuard no_grad;
  for (const RefinerShape& shape : kRefinerShapes) {
    nn::Conv2d convolution(
        nn::Conv2dOptions(shape.in, shape.out, 3).stride(shape.stride).padding(shape.stride == 1 ? 1 : 0));
    convolution->weight.normal_(0, std::sqrt(2.0 / (9 * shape.in)));
    convolution->bias.zero_();
    if (!shape.relu6) convolution->weight.zero_();
    convolutions.push_back(register_module(shape.name, convolution));
  }
}

Tensor RefinerModuleImpl::forward(const Tensor& planes) {
  BODYLOOM_CHECK(planes.dim() == 4 && planes.size(1) == PersonPlane::kCount && planes.size(2) > 0 &&
                     planes.size(3) > 0 && planes.size(2) % kRefinerMultiple == 0 &&
                     planes.size(3) % kRefinerMultiple == 0,
                 "refiner: planes of shape ", planes.sizes(), ", expected B x ", PersonPlane::kCount,
                 " x H x W, sides multiples of ", kRefinerMultiple);
  size_t next = 0;
  const auto convolve = [&](Tensor x) {
    const RefinerShape& shape = kRefinerShapes[next];
    if (shape.stride == 2) x = torch::constant_pad_nd(x, {0, 1, 0, 1});
    x = convolutions[next++](x);
    return shape.relu6 ? torch::clamp(x, 0, 6) : x;
  };
  const Tensor full = convolve(convolve(Together(planes)));
  const Tensor half = convolve(convolve(full));
  const Tensor quarter = convolve(convolve(half));
  Tensor x = convolve(convolve(quarter));
  for (const Tensor& skip : {quarter, half, full}) x = convolve(convolve(torch::cat({Enlarged(x), skip}, 1)));
  const Tensor change = Apart(convolve(x));
  const Tensor alpha = planes.narrow(1, PersonPlane::kAlpha, 1), of_alpha = change.narrow(1, PersonPlane::kAlpha, 1);
  // At 0, where training begins, both sides must let gradients through.
  const Tensor kept = of_alpha * torch::where(of_alpha > 0, Near(alpha > 0, OutlineReach::kOutwards),
                                              Near(alpha < 0.5, OutlineReach::kInwards));
  return torch::cat({change.narrow(1, 0, PersonPlane::kAlpha), kept}, 1);
}

Tensor ChangedPerson(const Tensor& planes, const Tensor& change) {
  return torch::clamp(planes.narrow(1, 0, 4) + torch::tanh(change), 0, 1);
}

RefinerWeights ExportRefiner(const RefinerModule& module) {
  RefinerWeights weights;
  for (const nn::Conv2d& convolution : module->convolutions) {
    const Tensor kernel =
        convolution->weight.detach().to(torch::kCPU, torch::kFloat).permute({0, 2, 3, 1}).contiguous();
    const Tensor bias = convolution->bias.detach().to(torch::kCPU, torch::kFloat).contiguous();
    weights.convolutions.push_back(
        {Eigen::Map<const RowMatrixXf>(kernel.data_ptr<float>(), kernel.size(0), kernel.numel() / kernel.size(0)),
         Eigen::Map<const Eigen::VectorXf>(bias.data_ptr<float>(), bias.numel())});
  }
  return weights;
}

void ImportRefiner(const RefinerWeights& weights, RefinerModule* module) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid(&why), "refiner: ", why);
  const torch::NoGradGuard no_grad;
  for (size_t i = 0; i < kRefinerShapes.size(); ++i) {
    const RefinerWeights::Convolution& from = weights.convolutions[i];
    nn::Conv2d& to = (*module)->convolutions[i];
    to->weight.copy_(
        torch::from_blob(const_cast<float*>(from.kernel.data()), {from.kernel.rows(), 3, 3, kRefinerShapes[i].in})
            .permute({0, 3, 1, 2}));
    to->bias.copy_(torch::from_blob(const_cast<float*>(from.bias.data()), {from.bias.size()}));
  }
}

}  // namespace bodyloom
