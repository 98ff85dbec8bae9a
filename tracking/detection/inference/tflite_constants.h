// SPDX-License-Identifier: Apache-2.0
/// Values of constants as TensorFlow Lite stores them: float32, float16 or int32, dense or sparse.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tracking/detection/inference/flatbuffer.h"
#include "tracking/detection/inference/graph.h"

namespace bodyloom {

enum class TfliteType : int8_t { kFloat32 = 0, kFloat16 = 1, kInt32 = 2 };

/// A constant as stored in the file.
struct TfliteStored {
  TfliteType type = TfliteType::kFloat32;
  std::string_view bytes;
  std::optional<FlatTable> sparsity;  ///< of a sparse one
};

/// Remaining number of bytes of constants that may be unpacked.
class TfliteBudget {
 public:
  /// For a file of `file_bytes` bytes.
  explicit TfliteBudget(size_t file_bytes) : bytes_(kMaxUnpacked * file_bytes) {}
  /// Subtracts `bytes`. Throws std::runtime_error "place: …" when fewer remain.
  void Take(size_t bytes, const std::string& place);

 private:
  static constexpr size_t kMaxUnpacked = 16;  ///< bytes of constants a byte of the file
  size_t bytes_;
};

/// The values of a constant of this shape in C order. Throws std::runtime_error "place: what was found, expected what":
/// another number of bytes than the shape needs, values that are not finite, a sparse layout other than rows of the
/// last axis or one that does not fit.
GraphTensor TfliteFloats(const TfliteStored& stored, const std::vector<int64_t>& shape, const std::string& place,
                         TfliteBudget* budget);

/// The same for int32; these are never sparse.
GraphTensor TfliteInts(const TfliteStored& stored, const std::vector<int64_t>& shape, const std::string& place,
                       TfliteBudget* budget);

}  // namespace bodyloom
