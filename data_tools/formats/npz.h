// SPDX-License-Identifier: Apache-2.0
/// .npy and .npz files: numpy's array format and zip archives of it (stored or deflated, zip64).
///
/// The reader checks every claim before allocating memory: header at most 64 KiB, shape product without overflow, size
/// equal to the bytes present, deflate ratio at most 1100:1. An array of one Python object that is a number or text
/// becomes that (nothing is executed: pickle.h). Other object arrays are not read: in an archive they are kept as
/// DType::kOther without contents (SMPL-X files contain some) and refused when requested. Members that are not arrays
/// are skipped. Source: numpy/lib/format.py, APPNOTE.TXT.
#pragma once

#include <map>
#include <string>

#include "data_tools/formats/ndarray.h"

namespace bodyloom {

/// Arrays by name (without ".npy").
using NpzArrays = std::map<std::string, NdArray>;

/// Throws std::runtime_error naming file, entry and expectation.
NpzArrays ReadNpz(const std::string& path, size_t max_bytes = size_t{1} << 32);
NpzArrays ReadNpzBytes(const std::string& bytes, const std::string& where, size_t max_bytes = size_t{1} << 32);
NdArray ReadNpy(const std::string& path);
NdArray ReadNpyBytes(const std::string& bytes, const std::string& where);

/// Deflated, deterministic (entries in name order, fixed dates), written atomically.
std::string NpzBytes(const NpzArrays& arrays);
void WriteNpz(const std::string& path, const NpzArrays& arrays);
std::string NpyBytes(const NdArray& array);
void WriteNpy(const std::string& path, const NdArray& array);

/// Returns the array `name` (numbers or text); throws std::runtime_error naming `where`, the key, and the keys present.
const NdArray& RequireArray(const NpzArrays& arrays, const std::string& name, const std::string& where);

}  // namespace bodyloom
