// SPDX-License-Identifier: Apache-2.0
#include "neural/densepose/densepose_output.h"

#include <stdexcept>
#include <vector>

#include "geometry/base/check.h"
#include "neural/densepose/paste_charts.h"

namespace bodyloom {
namespace {

constexpr int64_t kFine = ChartPlanes::kFine;

torch::Tensor OnCpu(const torch::Tensor& tensor) { return tensor.to(torch::kCPU, torch::kFloat).contiguous(); }

torch::Tensor Entry(const c10::Dict<c10::IValue, c10::IValue>& dict, const std::string& key, const std::string& path) {
  const auto found = dict.find(key);
  if (found != dict.end()) return OnCpu(found->value().toTensor());
  std::string keys;
  for (const auto& entry : dict) keys += (keys.empty() ? "" : ", ") + entry.key().toStringRef();
  throw std::runtime_error(
      Concatenate(path, ": the network's answer has no ", key, "; it has ", keys.empty() ? "nothing" : keys));
}

/// `channels` 0: two or more.
void CheckPlanes(const torch::Tensor& planes, const char* name, const DensePoseOutput& output, int64_t channels,
                 const std::string& path) {
  const int64_t n = output.boxes.size(0);
  const bool fits = planes.dim() == 4 && planes.size(0) == n &&
                    (channels > 0 ? planes.size(1) == channels : planes.size(1) >= 2) && planes.size(2) > 0 &&
                    planes.size(3) > 0;
  const bool is_like_coarse = fits && planes.sizes().slice(2) == output.coarse.sizes().slice(2);
  if (!fits || !is_like_coarse) {
    throw std::runtime_error(Concatenate(path, ": the network's ", name, " has shape ", planes.sizes(), ", expected [",
                                         n, ", ", channels > 0 ? std::to_string(channels) : "2 or 15",
                                         ", h, w], all planes of one size"));
  }
}

}  // namespace

std::optional<DensePoseForm> DensePoseFormOf(const c10::Type& returned) {
  if (const auto tuple = returned.cast<c10::TupleType>()) {
    const auto& elements = tuple->elements();
    for (const auto& element : elements) {
      if (element->kind() != c10::TypeKind::TensorType) return std::nullopt;
    }
    if (elements.size() == 5) return DensePoseForm::kTuple;
  }
  if (const auto dict = returned.cast<c10::DictType>()) {
    if (dict->getKeyType()->kind() == c10::TypeKind::StringType &&
        dict->getValueType()->kind() == c10::TypeKind::TensorType) {
      return DensePoseForm::kDict;
    }
  }
  return std::nullopt;
}

DensePoseOutput CheckedDensePoseOutput(const c10::IValue& value, DensePoseForm form, const std::string& path) {
  DensePoseOutput output;
  if (form == DensePoseForm::kTuple) {
    const std::vector<c10::IValue>& values = value.toTupleRef().elements().vec();
    output.boxes = OnCpu(values[0].toTensor());
    output.coarse = OnCpu(values[1].toTensor());
    output.fine = OnCpu(values[2].toTensor());
    output.u = OnCpu(values[3].toTensor());
    output.v = OnCpu(values[4].toTensor());
  } else {
    const auto dict = value.toGenericDict();
    output.boxes = Entry(dict, "pred_boxes", path);
    output.scores = Entry(dict, "scores", path);
    output.coarse = Entry(dict, "pred_densepose_coarse_segm", path);
    output.fine = Entry(dict, "pred_densepose_fine_segm", path);
    output.u = Entry(dict, "pred_densepose_u", path);
    output.v = Entry(dict, "pred_densepose_v", path);
  }
  if (output.boxes.dim() != 2 || output.boxes.size(1) != 4) {
    throw std::runtime_error(
        Concatenate(path, ": the network's boxes have shape ", output.boxes.sizes(), ", expected [n, 4]"));
  }
  const int64_t n = output.boxes.size(0);
  if (form == DensePoseForm::kTuple) output.scores = torch::ones({n});
  if (output.scores.dim() != 1 || output.scores.size(0) != n) {
    throw std::runtime_error(
        Concatenate(path, ": the network's scores have shape ", output.scores.sizes(), ", expected [", n, "]"));
  }
  if (n == 0) return output;  // without people the planes may have any shape
  CheckPlanes(output.coarse, "coarse segmentation", output, 0, path);
  CheckPlanes(output.fine, "fine segmentation", output, kFine, path);
  CheckPlanes(output.u, "u", output, kFine, path);
  CheckPlanes(output.v, "v", output, kFine, path);
  return output;
}

}  // namespace bodyloom
