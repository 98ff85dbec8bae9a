// SPDX-License-Identifier: Apache-2.0
/// Reads the tensors of PyTorch's .pth / .pt files without PyTorch and without executing code.
///
/// Two formats: the zip archive of torch.save since 1.6 (NAME/data.pkl, the storages in NAME/data/KEY) and the legacy
/// stream before it (five pickles: magic number, protocol 1001, system, the object, the storages' keys; then each
/// storage as 8 bytes of element count and its raw bytes). The object may be a tensor or dictionaries of them; names
/// are joined by "." ("state_dict" → "conv.weight" gives "state_dict.conv.weight"), a single tensor is "tensor". Views
/// become C-order copies; several tensors may share a storage. Entries of other kinds (numbers, lists, text) are named
/// in `ignored`. Any class beside tensors, their storages, Parameter and OrderedDict is refused by name.
///
/// Everything is checked: a view must lie in its storage, element counts must match the bytes, and all tensors together
/// take at most max_bytes and 64 MiB + 16 times the file (an expanded view takes no bytes in it).
/// Not read: TorchScript archives, tar files of torch before 0.2, big-endian files, complex and quantised tensors.
/// Source: torch/serialization.py, torch/_utils.py (v1.13); the globals of 2017's files: torchvision's VGG weights.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "data_tools/formats/weights_file.h"

namespace bodyloom {

/// Returns true if the bytes start like one of the two formats.
bool LooksLikeTorch(std::string_view bytes);

/// Throws std::runtime_error "path: place: what was found, expected what".
WeightsFile ReadTorchWeights(const std::string& path, size_t max_bytes = size_t{1} << 32);
WeightsFile TorchWeightsFromBytes(const std::string& bytes, const std::string& where,
                                  size_t max_bytes = size_t{1} << 32);

}  // namespace bodyloom
