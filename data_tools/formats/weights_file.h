// SPDX-License-Identifier: Apache-2.0
/// Network weights by name, in formats of several frameworks.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "data_tools/formats/ndarray.h"

namespace bodyloom {

struct WeightsFile {
  std::map<std::string, NdArray> tensors;
  std::vector<std::string> ignored;             ///< entries that are not tensors, by name, sorted
  std::map<std::string, std::string> metadata;  ///< safetensors: __metadata__
};

struct ReadWeightsOptions {
  bool widen_halves = false;           ///< float16 and bfloat16 become float32 (exact)
  size_t max_bytes = size_t{1} << 32;  ///< of the file, and of all tensors together
};

/// Reads the tensors of a .safetensors file, or of a .pth / .pt file in either of PyTorch's formats, recognised by
/// content. Throws as ReadSafetensors and ReadTorchWeights.
WeightsFile ReadWeights(const std::string& path, const ReadWeightsOptions& options = {});
WeightsFile WeightsFromBytes(const std::string& bytes, const std::string& where,
                             const ReadWeightsOptions& options = {});

// safetensors: 8 bytes of header length N (little endian), N bytes of JSON, then the tensors' bytes.
//
// The header maps names to {"dtype", "shape", "data_offsets": [begin, end)} relative to the end of the header, and
// "__metadata__" to text by text. Read and written: BOOL, U8, I8, I16, I32, I64, F16, BF16, F32, F64, in C order and
// little endian. The reader checks every claim before allocating memory: header at most 100 MB and an object, no
// duplicate names, size of a tensor equal to shape times type, and the tensors cover the rest of the file without gap
// or overlap. Source: huggingface/safetensors, README "Format".

/// Throws std::runtime_error "path: place: what was found, expected what".
WeightsFile ReadSafetensors(const std::string& path, size_t max_bytes = size_t{1} << 32);
WeightsFile SafetensorsFromBytes(std::string_view bytes, const std::string& where);

/// Tensors in the order of descending element size, then of names, so that each is aligned; header padded with spaces
/// to a multiple of 8. Equal input gives equal bytes. Throws std::invalid_argument for arrays of another type (uint16,
/// text, …), for the name "__metadata__", and for names or metadata that are not UTF-8.
std::string SafetensorsBytes(const std::map<std::string, NdArray>& tensors,
                             const std::map<std::string, std::string>& metadata = {});
void WriteSafetensors(const std::string& path, const std::map<std::string, NdArray>& tensors,
                      const std::map<std::string, std::string>& metadata = {});

}  // namespace bodyloom
