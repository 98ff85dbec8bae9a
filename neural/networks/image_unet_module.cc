// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/image_unet_module.h"

#include <cmath>
#include <string>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace nn = torch::nn;
using torch::Tensor;

/// Space-to-depth by 2×2 pixels.
Tensor Together(const Tensor& x) {
  const int64_t b = x.size(0), c = x.size(1), h = x.size(2), w = x.size(3);
  return x.reshape({b, c, h / 2, 2, w / 2, 2}).permute({0, 3, 5, 1, 2, 4}).reshape({b, 4 * c, h / 2, w / 2});
}

/// Depth-to-space, the inverse of Together().
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

}  // namespace

ImageUnetModuleImpl::ImageUnetModuleImpl(ImageUnetPlanes planes) : planes(planes) {
  const torch::NoGradGuard no_grad;
  for (const ImageUnetLayer& layer : ImageUnetLayers(planes)) {
    nn::Conv2d convolution(
        nn::Conv2dOptions(layer.in, layer.out, 3).stride(layer.stride).padding(layer.stride == 1 ? 1 : 0));
    convolution->weight.normal_(0, std::sqrt(2.0 / (9 * layer.in)));
    convolution->bias.zero_();
    if (!layer.relu6) convolution->weight.zero_();
    convolutions.push_back(register_module(layer.name, convolution));
  }
}

Tensor ImageUnetModuleImpl::forward(const Tensor& image) {
  BODYLOOM_CHECK(image.dim() == 4 && image.size(1) == planes.in && image.size(2) > 0 && image.size(3) > 0 &&
                     image.size(2) % kImageUnetMultiple == 0 && image.size(3) % kImageUnetMultiple == 0,
                 "picture U-Net: planes of shape ", image.sizes(), ", expected B x ", planes.in,
                 " x H x W, sides multiples of ", kImageUnetMultiple);
  const auto layers = ImageUnetLayers(planes);
  size_t next = 0;
  const auto convolve = [&](Tensor x) {
    const ImageUnetLayer& layer = layers[next];
    if (layer.stride == 2) x = torch::constant_pad_nd(x, {0, 1, 0, 1});
    x = convolutions[next++](x);
    return layer.relu6 ? torch::clamp(x, 0, 6) : x;
  };
  const Tensor full = convolve(convolve(Together(image)));
  const Tensor half = convolve(convolve(full));
  const Tensor quarter = convolve(convolve(half));
  Tensor x = convolve(convolve(quarter));
  for (const Tensor& skip : {quarter, half, full}) x = convolve(convolve(torch::cat({Enlarged(x), skip}, 1)));
  return Apart(convolve(x));
}

ImageUnetWeights ExportImageUnet(const ImageUnetModule& module) {
  ImageUnetWeights weights;
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

void ImportImageUnet(const ImageUnetWeights& weights, ImageUnetModule* module) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid((*module)->planes, &why), "picture U-Net: ", why);
  const torch::NoGradGuard no_grad;
  const auto layers = ImageUnetLayers((*module)->planes);
  for (size_t i = 0; i < layers.size(); ++i) {
    const ImageUnetWeights::Convolution& from = weights.convolutions[i];
    nn::Conv2d& to = (*module)->convolutions[i];
    to->weight.copy_(torch::from_blob(const_cast<float*>(from.kernel.data()), {from.kernel.rows(), 3, 3, layers[i].in})
                         .permute({0, 3, 1, 2}));
    to->bias.copy_(torch::from_blob(const_cast<float*>(from.bias.data()), {from.bias.size()}));
  }
}

}  // namespace bodyloom
