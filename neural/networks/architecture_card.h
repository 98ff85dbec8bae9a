// SPDX-License-Identifier: Apache-2.0
/// Architecture card of a network as text, also for comparison in tests. Internal: includes LibTorch.
///
///   encoder0.conv1.weight   64 x 33 x 3 x 3   19008
///   …
///   input 1 x 33 x 128 x 128
///   parameters      5775184
///   multiply-adds   5881462784
/// Multiply–adds are those of convolutions and matrix products (linear layers), counted while `run` runs: convolution
/// |output| · (channels in / groups) · kernel area, transposed convolution |input| · (channels out / groups) · kernel
/// area (those that fall outside the output are counted too), n×k by k×m product n·k·m. Norms, activations and sampling
/// are not counted. An empty batch (of convolutions) counts as one image, which gives the cost of a network without
/// computing it.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bodyloom {

/// Counts the multiply–adds of `run` on this thread.
int64_t CountMultiplyAdds(const std::function<void()>& run);

/// The card; it lists the shapes `inputs`, and `run` is a forward pass with such inputs.
std::string ArchitectureCard(const torch::nn::Module& module, const std::vector<std::vector<int64_t>>& inputs,
                             const std::function<void()>& run);

/// Card of a module with one input, which is run on an empty batch of that shape, without gradients.
template <class Module>
std::string ArchitectureCard(torch::nn::ModuleHolder<Module>& module, const std::vector<int64_t>& input) {
  return ArchitectureCard(*module, {input}, [&] {
    const torch::NoGradGuard no_grad;
    std::vector<int64_t> nothing = input;
    nothing[0] = 0;
    module->forward(torch::zeros(nothing));
  });
}

}  // namespace bodyloom
