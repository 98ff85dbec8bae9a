// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/load_weights.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

std::vector<std::pair<std::string, torch::Tensor>> TensorsOf(const torch::nn::Module& module) {
  std::vector<std::pair<std::string, torch::Tensor>> tensors;
  for (const auto& item : module.named_parameters()) tensors.emplace_back(item.key(), item.value());
  for (const auto& item : module.named_buffers()) tensors.emplace_back(item.key(), item.value());
  return tensors;
}

std::string FirstFew(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < std::min<size_t>(names.size(), 4); ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > 4 ? Concatenate(text, " and ", names.size() - 4, " more") : text;
}

void CheckArray(const NamedArray& array, torch::IntArrayRef expected, const std::string& place) {
  if (torch::IntArrayRef(array.shape) != expected) {
    throw std::runtime_error(Concatenate(place, ": shape ", torch::IntArrayRef(array.shape), ", expected ", expected));
  }
  if (static_cast<int64_t>(array.values.size()) != c10::multiply_integers(expected)) {
    throw std::runtime_error(
        Concatenate(place, ": ", array.values.size(), " values, expected ", c10::multiply_integers(expected)));
  }
  if (!std::all_of(array.values.begin(), array.values.end(), [](float v) { return std::isfinite(v); })) {
    throw std::runtime_error(place + ": a value that is not finite, expected numbers");
  }
}

}  // namespace

LoadWeightsReport LoadWeights(const NamedWeights& weights, const std::string& source, torch::nn::Module* module,
                              const LoadWeightsOptions& options) {
  LoadWeightsReport report;
  std::vector<std::pair<torch::Tensor, const NamedArray*>> copies;
  std::set<std::string> used;
  for (const auto& [own_name, tensor] : TensorsOf(*module)) {
    const std::string name = options.name_in_file ? options.name_in_file(own_name) : own_name;
    const auto found = weights.find(name);
    if (found == weights.end()) {
      report.missing.push_back(name);
      continue;
    }
    CheckArray(found->second, tensor.sizes(), source + ": tensor " + name);
    copies.emplace_back(tensor, &found->second);
    used.insert(name);
  }
  if (!options.allow_missing && !report.missing.empty()) {
    std::vector<std::string> present;
    for (const auto& item : weights) present.push_back(item.first);
    throw std::runtime_error(source + ": no tensor " + FirstFew(report.missing) + "; the file has " +
                             (present.empty() ? "none" : FirstFew(present)));
  }
  const torch::NoGradGuard no_grad;
  for (auto& [tensor, array] : copies) {
    tensor.copy_(torch::from_blob(const_cast<float*>(array->values.data()), array->shape));
  }
  for (const auto& item : weights) {
    if (used.count(item.first) == 0) report.unused.push_back(item.first);
  }
  return report;
}

NamedWeights ExportWeights(const torch::nn::Module& module) {
  NamedWeights weights;
  for (const auto& [name, tensor] : TensorsOf(module)) {
    const torch::Tensor values = tensor.detach().to(torch::kCPU, torch::kFloat).contiguous();
    NamedArray& array = weights[name];
    array.shape = values.sizes().vec();
    array.values.assign(values.data_ptr<float>(), values.data_ptr<float>() + values.numel());
  }
  return weights;
}

}  // namespace bodyloom
