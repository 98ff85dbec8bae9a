// SPDX-License-Identifier: Apache-2.0
/// Derivatives by LibTorch's backward pass against central differences in double precision.
#pragma once

#include <torch/torch.h>

#include <cmath>
#include <functional>
#include <vector>

namespace bodyloom {

struct GradientCheck {
  int64_t num_compared = 0;
  int64_t num_nonzero = 0;  ///< derivatives above 1e-5 of the largest, which make the comparison meaningful
  double max_error = 0;     ///< largest |backward − difference| / (largest |difference| of the same input)
};

/// `function` maps tensors to a scalar. `inputs` are double tensors; each of their elements is moved by ±epsilon.
/// Errors are relative, so that means over many pixels are judged as strictly as sums.
inline GradientCheck CheckGradients(const std::function<torch::Tensor(const std::vector<torch::Tensor>&)>& function,
                                    std::vector<torch::Tensor> inputs, double epsilon = 1e-6) {
  GradientCheck check;
  for (torch::Tensor& input : inputs) {
    TORCH_CHECK(input.scalar_type() == torch::kDouble, "gradients are checked in double precision");
    input = input.detach().clone().contiguous().requires_grad_(true);
  }
  function(inputs).backward();
  for (torch::Tensor& input : inputs) {
    const torch::Tensor gradient = input.grad().defined() ? input.grad().contiguous() : torch::zeros_like(input);
    const torch::NoGradGuard no_grad;
    torch::Tensor differences = torch::zeros_like(gradient);
    double* x = input.data_ptr<double>();
    for (int64_t i = 0; i < input.numel(); ++i) {
      const double at = x[i];
      x[i] = at + epsilon;
      const double above = function(inputs).item<double>();
      x[i] = at - epsilon;
      const double below = function(inputs).item<double>();
      x[i] = at;
      differences.data_ptr<double>()[i] = (above - below) / (2 * epsilon);
    }
    const double scale = differences.abs().max().item<double>();
    const double error = (gradient - differences).abs().max().item<double>();
    check.max_error = std::max(check.max_error, scale > 0 ? error / scale : error);
    if (std::isnan(error)) check.max_error = INFINITY;
    check.num_compared += input.numel();
    check.num_nonzero += (differences.abs() > 1e-5 * scale).sum().item<int64_t>();
  }
  return check;
}

}  // namespace bodyloom
