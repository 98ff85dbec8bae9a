// SPDX-License-Identifier: Apache-2.0
/// The architecture card of a network, as text that a test can hold. Internal: includes LibTorch.
///
///   encoder0.conv1.weight   64 x 33 x 3 x 3   19008
///   …
///   input 1 x 33 x 128 x 128
///   parameters      5775184
///   multiply-adds   5881462784
/// Multiply–adds are those of convolutions and products of matrices (linear layers), counted while `run` runs:
/// convolution |output| · (channels in / groups) · kernel area, transposed convolution |input| · (channels out /
/// groups) · kernel area (those that fall outside the output are counted too), n×k by k×m product n·k·m. Norms,
/// activations and sampling are not counted. An empty batch (of convolutions) counts as one picture: what a network
/// would cost is known without its being computed.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bodyloom {

/// Multiply–adds of what `run` does on this thread.
int64_t CountMultiplyAdds(const std::function<void()>& run);

/// The card; `inputs` are named in it, `run` is a forward pass with such inputs.
std::string ArchitectureCard(const torch::nn::Module& module, const std::vector<std::vector<int64_t>>& inputs,
                             const std::function<void()>& run);

/// For a module of one input: runs it on an empty batch of that shape, without gradients.
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
