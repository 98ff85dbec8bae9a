// SPDX-License-Identifier: Apache-2.0
/// Values of constants as TensorFlow Lite stores them: float32, float16 or int32, dense or sparse (tflite_model.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bodyloom/data_tools/detection/flatbuffer.h"

namespace bodyloom {

enum class TfliteType : int8_t { kFloat32 = 0, kFloat16 = 1, kInt32 = 2 };

/// A constant where it lies in the file.
struct TfliteStored {
  TfliteType type = TfliteType::kFloat32;
  std::string_view bytes;
  std::optional<FlatTable> sparsity;  ///< of a sparse one
};

/// Bytes of constants that may still be unpacked.
class TfliteBudget {
 public:
  explicit TfliteBudget(size_t bytes) : bytes_(bytes) {}
  /// Throws std::runtime_error "place: …" when this many bytes are too many.
  void Take(size_t bytes, const std::string& place);

 private:
  size_t bytes_;
};

/// The values of a constant of this shape in C order, 64-byte aligned, as vector kernels like them.
/// Throws std::runtime_error "place: what was found, expected what": another number of bytes than the shape needs,
/// values that are not finite, a sparse layout other than rows of the last axis (tflite_model.h) or one that does not
/// fit.
std::shared_ptr<const float[]> TfliteFloats(const TfliteStored& stored, const std::vector<int>& shape,
                                            const std::string& place, TfliteBudget* budget);

/// The same for int32; these are never sparse.
std::vector<int32_t> TfliteInts(const TfliteStored& stored, const std::vector<int>& shape, const std::string& place,
                                TfliteBudget* budget);

}  // namespace bodyloom
