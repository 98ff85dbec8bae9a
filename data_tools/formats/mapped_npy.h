// SPDX-License-Identifier: Apache-2.0
/// Memory-maps the values of a .npy file: pages are read on access and released when memory is short, so an array may
/// be larger than memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data_tools/formats/ndarray.h"

namespace bodyloom {

class MappedNpy {
 public:
  /// The file may be unlinked afterwards; it must not be truncated. Throws std::runtime_error "path: why" for a file
  /// that cannot be opened, is not a .npy, or whose values are not `dtype` in C order, little endian and on multiples
  /// of their size (numpy pads headers so that they are).
  MappedNpy(const std::string& path, DType dtype);

  [[nodiscard]] const std::vector<int64_t>& shape() const { return shape_; }
  /// All values; valid during the lifetime of this object.
  template <class T>
  [[nodiscard]] std::span<const T> Values() const {
    return {reinterpret_cast<const T*>(values_.data()), values_.size() / sizeof(T)};
  }

 private:
  std::vector<int64_t> shape_;
  std::shared_ptr<void> map_;
  std::span<const char> values_;
};

}  // namespace bodyloom
