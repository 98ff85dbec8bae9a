// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/architecture_card.h"

#include <ATen/record_function.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

thread_local int64_t multiply_adds = 0;
thread_local int convolutions_deep = 0;

/// Size of a convolution's output along one axis.
int64_t OutputSize(int64_t in, int64_t kernel, int64_t stride, int64_t padding, int64_t dilation) {
  return (in + 2 * padding - dilation * (kernel - 1) - 1) / stride + 1;
}

/// aten::convolution(input, weight, bias, stride, padding, dilation, transposed, output_padding, groups).
int64_t OfConvolution(c10::ArrayRef<const c10::IValue> inputs) {
  const at::Tensor& input = inputs[0].toTensor();
  const at::Tensor& weight = inputs[1].toTensor();
  const int64_t dims = weight.dim() - 2;
  const bool batched = input.dim() == weight.dim();
  const int64_t per_position = weight.numel() / weight.size(0);  // inputs (outputs, if transposed) per group × taps
  int64_t positions = batched ? std::max<int64_t>(1, input.size(0)) : 1;
  if (inputs[6].toBool()) {
    for (int64_t i = -1 - dims; i < 0; ++i) positions *= input.size(i);
    return positions * per_position;
  }
  const std::vector<int64_t> stride = inputs[3].toIntVector(), padding = inputs[4].toIntVector(),
                             dilation = inputs[5].toIntVector();
  const auto at = [](const std::vector<int64_t>& values, int64_t i) { return values[values.size() == 1 ? 0 : i]; };
  for (int64_t i = 0; i < dims; ++i) {
    positions *= OutputSize(input.size(i - dims), weight.size(2 + i), at(stride, i), at(padding, i), at(dilation, i));
  }
  return positions * weight.size(0) * per_position;
}

bool Is(const at::RecordFunction& function, const char* name) { return std::strcmp(function.name(), name) == 0; }

std::unique_ptr<at::ObserverContext> Enter(const at::RecordFunction& function) {
  const c10::ArrayRef<const c10::IValue> inputs = function.inputs();
  // Matrix products, unless they are part of a convolution.
  const int first = Is(function, "aten::addmm") ? 1 : Is(function, "aten::mm") || Is(function, "aten::bmm") ? 0 : -1;
  if (Is(function, "aten::convolution")) {
    if (convolutions_deep++ == 0) multiply_adds += OfConvolution(inputs);
  } else if (first >= 0 && convolutions_deep == 0) {
    multiply_adds += inputs[first].toTensor().numel() * inputs[first + 1].toTensor().size(-1);
  }
  return nullptr;
}

void Leave(const at::RecordFunction& function, at::ObserverContext*) {
  if (Is(function, "aten::convolution")) --convolutions_deep;
}

/// Observes the operators of this thread during its lifetime.
class Observation {
 public:
  Observation()
      : handle_(at::addThreadLocalCallback(
            at::RecordFunctionCallback(Enter, Leave).needsInputs(true).scopes({at::RecordScope::FUNCTION}))) {}
  ~Observation() { at::removeCallback(handle_); }
  Observation(const Observation&) = delete;
  Observation& operator=(const Observation&) = delete;

 private:
  at::CallbackHandle handle_;
};

std::string ShapeText(torch::IntArrayRef shape) {
  std::string text;
  for (const int64_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text.empty() ? "scalar" : text;
}

std::string Padded(std::string text, size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

}  // namespace

int64_t CountMultiplyAdds(const std::function<void()>& run) {
  multiply_adds = 0;
  convolutions_deep = 0;
  const at::RecordFunctionGuard enabled(true);
  const Observation observation;
  run();
  return multiply_adds;
}

std::string ArchitectureCard(const torch::nn::Module& module, const std::vector<std::vector<int64_t>>& inputs,
                             const std::function<void()>& run) {
  size_t name_width = 0, shape_width = 0;
  int64_t parameters = 0;
  for (const auto& item : module.named_parameters()) {
    name_width = std::max(name_width, item.key().size());
    shape_width = std::max(shape_width, ShapeText(item.value().sizes()).size());
    parameters += item.value().numel();
  }
  std::string card;
  for (const auto& item : module.named_parameters()) {
    card += Padded(item.key(), name_width) + "   " + Padded(ShapeText(item.value().sizes()), shape_width) + "   " +
            std::to_string(item.value().numel()) + "\n";
  }
  for (const auto& input : inputs) card += "input " + ShapeText(input) + "\n";
  return card + "parameters      " + std::to_string(parameters) + "\nmultiply-adds   " +
         std::to_string(CountMultiplyAdds(run)) + "\n";
}

}  // namespace bodyloom
