// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/sphereface.h"

#include <array>

#include "geometry/base/check.h"

namespace bodyloom {

using torch::Tensor;
namespace nn = torch::nn;

SphereFaceImpl::SphereFaceImpl() {
  constexpr std::array<int, 4> kResidualUnits = {1, 2, 4, 1};
  int channels = 3;
  for (size_t s = 0; s < kResidualUnits.size(); ++s) {
    const int to = 64 << s;
    stages_.emplace_back();
    for (int i = 0; i <= 2 * kResidualUnits[s]; ++i) {
      const std::string number = std::to_string(s + 1) + "_" + std::to_string(i + 1);
      Unit unit;
      unit.conv = register_module("conv" + number,
                                  nn::Conv2d(nn::Conv2dOptions(channels, to, 3).stride(i == 0 ? 2 : 1).padding(1)));
      unit.relu = register_module("relu" + number, nn::PReLU(nn::PReLUOptions().num_parameters(to)));
      stages_.back().push_back(unit);
      channels = to;
    }
  }
  fc5_ = register_module("fc5", nn::Linear(channels * (kFaceHeight / 16) * (kFaceWidth / 16), 512));
  for (Tensor& p : parameters()) p.requires_grad_(false);
}

LoadWeightsReport SphereFaceImpl::Load(const NamedWeights& weights, const std::string& source) {
  return LoadWeights(weights, source, this);
}

Tensor SphereFaceImpl::forward(const Tensor& face) {
  BODYLOOM_CHECK(face.dim() == 4 && face.size(1) == 3 && face.size(2) == kFaceHeight && face.size(3) == kFaceWidth,
                 "SphereFace: faces of shape ", face.sizes(), ", expected B x 3 x 112 x 96");
  Tensor x = (face.flip(1) * 255 - 127.5) / 128;
  for (std::vector<Unit>& stage : stages_) {
    x = stage[0](x);
    for (size_t i = 1; i < stage.size(); i += 2) x = x + stage[i + 1](stage[i](x));
  }
  return fc5_(x.flatten(1));
}

}  // namespace bodyloom
