// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/npz.h"

#include <array>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/element_type.h"
#include "data_tools/formats/npy_header.h"
#include "data_tools/formats/object_npy.h"
#include "data_tools/formats/printable.h"
#include "data_tools/formats/zip.h"

namespace bodyloom {
namespace {

NdArray ParseNpy(std::string_view bytes, const std::string& where) {
  NpyHeader header = ParseNpyHeader(bytes, bytes.size(), where);
  if (!header.type) {
    if (std::optional<NdArray> scalar = ScalarOfObjectNpy(bytes)) return *std::move(scalar);
    NdArray other;
    other.dtype = DType::kOther;
    other.item_size = 0;
    other.bytes = header.descr;
    other.shape = {0};
    return other;
  }
  return ArrayFromBytes(*header.type, std::move(header.shape), header.fortran_order, bytes.substr(header.data_begin));
}

void RequireReadable(const NdArray& array, const std::string& where) {
  if (array.dtype != DType::kOther) return;
  throw std::runtime_error(where + ": elements of type '" + PrintableText(array.bytes) +
                           "', expected numbers or text (pickled objects, structures, complex numbers and dates are "
                           "never read)");
}

}  // namespace

NpzArrays ReadNpzBytes(const std::string& bytes, const std::string& where, size_t max_bytes) {
  NpzArrays arrays;
  for (ZipMember& member : ReadZip(bytes, where, max_bytes)) {
    std::string name = member.name;
    if (name.size() < 4 || name.substr(name.size() - 4) != ".npy") continue;
    name.resize(name.size() - 4);
    arrays[name] = ParseNpy(member.bytes, where + ": '" + PrintableText(name) + "'");
    std::string().swap(member.bytes);  // frees the packed copy before the next member is parsed
  }
  return arrays;
}

NpzArrays ReadNpz(const std::string& path, size_t max_bytes) {
  return ReadNpzBytes(ReadFileBytes(path, max_bytes), path, max_bytes);
}

NdArray ReadNpyBytes(const std::string& bytes, const std::string& where) {
  NdArray array = ParseNpy(bytes, where);
  RequireReadable(array, where);
  return array;
}

NdArray ReadNpy(const std::string& path) { return ReadNpyBytes(ReadFileBytes(path), path); }

std::string NpzBytes(const NpzArrays& arrays) {
  ZipBuilder zip;
  for (const auto& [name, array] : arrays) {
    const std::string header = NpyHeaderText(array);
    zip.Add(name + ".npy", std::array<std::string_view, 2>{header, array.bytes});
  }
  return std::move(zip).Finish();
}

void WriteNpz(const std::string& path, const NpzArrays& arrays) { WriteFileAtomically(path, NpzBytes(arrays)); }

std::string NpyBytes(const NdArray& array) { return NpyHeaderText(array) + array.bytes; }

void WriteNpy(const std::string& path, const NdArray& array) { WriteFileAtomically(path, NpyBytes(array)); }

const NdArray& RequireArray(const NpzArrays& arrays, const std::string& name, const std::string& where) {
  const auto it = arrays.find(name);
  if (it != arrays.end()) {
    RequireReadable(it->second, where + ": '" + name + "'");
    return it->second;
  }
  std::vector<std::string> names;
  for (const auto& [key, array] : arrays) names.push_back(key);
  throw std::runtime_error(where + ": no array '" + name + "'; it holds " + PrintableList(names));
}

}  // namespace bodyloom
