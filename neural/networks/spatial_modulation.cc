// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/spatial_modulation.h"

#include <string>

#include "geometry/base/check.h"
#include "neural/networks/blocks.h"

namespace bodyloom {

using torch::Tensor;

SpatialModulationImpl::SpatialModulationImpl(int channels, const std::vector<int>& map_channels, int hidden) {
  BODYLOOM_CHECK(!map_channels.empty() && hidden > 0, "spatial modulation: ", map_channels.size(), " maps and ", hidden,
                 " hidden channels, expected one or more of each");
  for (size_t i = 0; i < map_channels.size(); ++i) {
    const std::string number = std::to_string(i);
    first.push_back(register_module("first" + number, MakeConv(map_channels[i], hidden, 3, 1, 1, /*bias=*/true)));
    second.push_back(register_module("second" + number, MakeConv(hidden, 2 * channels, 3, 1, 1, /*bias=*/true)));
    const torch::NoGradGuard no_grad;
    second.back()->weight.slice(0, 0, channels).zero_();
  }
}

Tensor SpatialModulationImpl::forward(const Tensor& x, const std::vector<Tensor>& maps) {
  BODYLOOM_CHECK(maps.size() == first.size(), "spatial modulation: ", maps.size(), " maps, expected ", first.size());
  Tensor y = InstanceNorm(x);
  for (size_t i = 0; i < maps.size(); ++i) {
    Tensor map = maps[i];
    if (map.sizes().slice(2) != x.sizes().slice(2)) {
      map = torch::upsample_bilinear2d(map, {x.size(2), x.size(3)}, /*align_corners=*/false);
    }
    const std::vector<Tensor> scale_shift = second[i](torch::relu(first[i](map))).chunk(2, 1);
    y = torch::addcmul(y + scale_shift[1], y, scale_shift[0]);
  }
  return y;
}

ModulatedBlockImpl::ModulatedBlockImpl(int from, int to, const std::vector<int>& map_channels, int hidden,
                                       bool spectral_norm) {
  modulation1 = register_module("modulation1", SpatialModulation(from, map_channels, hidden));
  conv1 = register_module("conv1", SpectralConv(from, to, 3, /*bias=*/true, spectral_norm));
  modulation2 = register_module("modulation2", SpatialModulation(to, map_channels, hidden));
  conv2 = register_module("conv2", SpectralConv(to, to, 3, /*bias=*/true, spectral_norm));
  if (from != to) shortcut = register_module("shortcut", SpectralConv(from, to, 1, /*bias=*/false, spectral_norm));
}

Tensor ModulatedBlockImpl::forward(const Tensor& x, const std::vector<Tensor>& maps) {
  const Tensor y = conv1(LeakyRelu(modulation1(x, maps)));
  const Tensor z = conv2(LeakyRelu(modulation2(y, maps)));
  return z + (shortcut.is_empty() ? x : shortcut(x));
}

namespace {

constexpr double kTinyNorm = 1e-12;
constexpr int kFirstIterations = 8;  ///< so that the initial scale is nearly correct

Tensor Normalized(const Tensor& x) { return x / (x.norm() + kTinyNorm); }

}  // namespace

Tensor SpectralScale(const Tensor& weight, const Tensor& u, const Tensor& v) {
  return torch::dot(u, torch::mv(weight.flatten(1), v));
}

SpectralConvImpl::SpectralConvImpl(int from, int to, int kernel, bool bias, bool normalise)
    : conv(register_module("conv", MakeConv(from, to, kernel, 1, kernel / 2, bias))) {
  if (!normalise) return;
  u = register_buffer("u", Normalized(torch::randn({to})));
  v = register_buffer("v", torch::zeros({int64_t{from} * kernel * kernel}));
  for (int i = 0; i < kFirstIterations; ++i) Iterate();
}

void SpectralConvImpl::Iterate() {
  const torch::NoGradGuard no_grad;
  const Tensor matrix = conv->weight.flatten(1);
  // New tensors, not in place: a backward pass may still hold the old ones.
  v.set_data(Normalized(torch::mv(matrix.t(), u)));
  u.set_data(Normalized(torch::mv(matrix, v)));
}

Tensor SpectralConvImpl::forward(const Tensor& x) {
  if (!u.defined()) return conv(x);
  if (is_training()) Iterate();
  const Tensor weight = conv->weight / SpectralScale(conv->weight, u.detach(), v.detach());
  return torch::conv2d(x, weight, conv->bias, 1, conv->weight.size(2) / 2);
}

}  // namespace bodyloom
