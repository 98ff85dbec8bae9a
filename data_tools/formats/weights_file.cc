// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/formats/weights_file.h"

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/safetensors.h"
#include "bodyloom/data_tools/formats/torch_weights.h"

namespace bodyloom {

WeightsFile WeightsFromBytes(const std::string& bytes, const std::string& where, const ReadWeightsOptions& options) {
  WeightsFile file = LooksLikeTorch(bytes) ? TorchWeightsFromBytes(bytes, where, options.max_bytes)
                                           : SafetensorsFromBytes(bytes, where);
  if (!options.widen_halves) return file;
  for (auto& [name, tensor] : file.tensors) {
    if (tensor.dtype != DType::kF16 && tensor.dtype != DType::kBF16) continue;
    tensor = NdArray::FromFloats(tensor.ToFloats().data(), tensor.shape);
  }
  return file;
}

WeightsFile ReadWeights(const std::string& path, const ReadWeightsOptions& options) {
  return WeightsFromBytes(ReadFileBytes(path, options.max_bytes), path, options);
}

}  // namespace bodyloom
