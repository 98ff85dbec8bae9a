// SPDX-License-Identifier: Apache-2.0
/// Arrays of floats that begin at a cache line, as the SIMD loops want them.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>

namespace bodyloom {

struct AlignedDelete {
  void operator()(float* p) const { ::operator delete[](p, std::align_val_t(64)); }
};
using AlignedFloats = std::unique_ptr<float[], AlignedDelete>;

/// n zeros.
inline AlignedFloats ZeroFloats(size_t n) {
  AlignedFloats result(static_cast<float*>(::operator new[](n * sizeof(float), std::align_val_t(64))));
  std::memset(result.get(), 0, n * sizeof(float));
  return result;
}

}  // namespace bodyloom
