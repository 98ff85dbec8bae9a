// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/tflite_constants.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "data_tools/formats/ndarray.h"
#include "geometry/base/check.h"
#include "tracking/detection/inference/operators.h"

namespace bodyloom {
namespace {

/// Float32 or float16 values as stored.
class StoredFloats {
 public:
  StoredFloats(const TfliteStored& stored, size_t size, const std::string& place)
      : half_(stored.type == TfliteType::kFloat16), halves_(stored.bytes), floats_(stored.bytes), place_(place) {
    const size_t bytes = size * (half_ ? sizeof(uint16_t) : sizeof(float));
    if (stored.bytes.size() != bytes) {
      ThrowFileError(place, Concatenate(stored.bytes.size(), " bytes of values, expected ", bytes));
    }
  }
  [[nodiscard]] float operator[](size_t i) const {
    const float value = half_ ? FloatFromHalf(halves_[i]) : floats_[i];
    if (!std::isfinite(value))
      ThrowFileError(place_, Concatenate("value ", i, " is ", value, ", expected a finite one"));
    return value;
  }

 private:
  bool half_;
  FlatNumbers<uint16_t> halves_;
  FlatNumbers<float> floats_;
  const std::string& place_;
};

/// Row starts or column numbers: a union of three vectors.
class SparseIndices {
 public:
  SparseIndices(const FlatTable& dimension, int field, const std::string& what, const std::string& place) {
    kind_ = dimension.Number<uint8_t>(field, 0);
    const std::optional<FlatTable> table = dimension.Table(field + 1);
    if (kind_ < 1 || kind_ > 3 || !table) {
      ThrowFileError(place,
                     Concatenate(what, " of kind ", int{kind_}, ", expected 1 (int32), 2 (uint16) or 3 (uint8)"));
    }
    if (kind_ == 1) longs_ = table->Numbers<int32_t>(0);
    if (kind_ == 2) shorts_ = table->Numbers<uint16_t>(0);
    if (kind_ == 3) bytes_ = table->Numbers<uint8_t>(0);
  }
  [[nodiscard]] size_t size() const { return kind_ == 1 ? longs_.size() : kind_ == 2 ? shorts_.size() : bytes_.size(); }
  [[nodiscard]] int64_t operator[](size_t i) const {
    return kind_ == 1 ? int64_t{longs_[i]} : kind_ == 2 ? int64_t{shorts_[i]} : int64_t{bytes_[i]};
  }

 private:
  uint8_t kind_;
  FlatNumbers<int32_t> longs_;
  FlatNumbers<uint16_t> shorts_;
  FlatNumbers<uint8_t> bytes_;
};

/// The compressed last dimension of a sparse constant of this shape, once its others are known to be dense.
FlatTable CompressedDimension(const FlatTable& sparsity, const std::vector<int64_t>& shape, const std::string& place) {
  const size_t rank = shape.size();
  const FlatNumbers<int32_t> order = sparsity.Numbers<int32_t>(0);
  bool in_order = order.size() == rank;
  for (size_t i = 0; in_order && i < rank; ++i) in_order = order[i] == static_cast<int32_t>(i);
  if (!in_order) ThrowFileError(place, "a sparse constant whose axes are reordered, expected them in order");
  if (sparsity.Numbers<int32_t>(1).size() != 0)
    ThrowFileError(place, "a sparse constant of blocks, expected single values");
  const std::vector<FlatTable> dimensions = sparsity.Tables(2, rank);
  if (dimensions.size() != rank) ThrowFileError(place, Concatenate(dimensions.size(), " sparse axes, expected ", rank));
  for (size_t i = 0; i < rank; ++i) {
    const int format = dimensions[i].Number<uint8_t>(0, 0), expected = i + 1 == rank ? 1 : 0;
    const int size = dimensions[i].Number<int32_t>(1, 0);
    // Writers omit the size of the compressed axis; its length is that of the shape.
    if (format != expected || (expected == 0 && size != shape[i])) {
      ThrowFileError(place, Concatenate("sparse axis ", i, " of format ", format, " and size ", size, ", expected ",
                                        expected, " and ", shape[i]));
    }
  }
  return dimensions.back();
}

/// Writes the stored values of a sparse constant into zeros.
void Scatter(const TfliteStored& stored, const std::vector<int64_t>& shape, const std::string& place, float* values) {
  const FlatTable dimension = CompressedDimension(*stored.sparsity, shape, place);
  const SparseIndices starts(dimension, 2, "row starts", place), columns(dimension, 4, "column numbers", place);
  const auto num_columns = static_cast<size_t>(shape.back());
  const size_t num_rows = GraphShapeSize(shape) / num_columns, count = columns.size();
  if (starts.size() != num_rows + 1 || starts[0] != 0 || starts[num_rows] != static_cast<int64_t>(count)) {
    ThrowFileError(place, Concatenate(starts.size(), " row starts for ", num_rows,
                                      " rows, expected one more, from 0 to the ", count, " columns"));
  }
  const StoredFloats there(stored, count, place);
  for (size_t row = 0, i = 0; row < num_rows; ++row) {
    const int64_t end = starts[row + 1];
    if (end < static_cast<int64_t>(i) || end > static_cast<int64_t>(count)) {
      ThrowFileError(place, Concatenate("row ", row, " ends at value ", end, ", expected ", i, " to ", count));
    }
    for (int64_t last = -1; i < static_cast<size_t>(end); ++i) {
      const int64_t column = columns[i];
      if (column <= last || column >= static_cast<int64_t>(num_columns)) {
        ThrowFileError(
            place, Concatenate("column ", column, " in row ", row, ", expected ", last + 1, " to ", num_columns - 1));
      }
      values[row * num_columns + static_cast<size_t>(column)] = there[i];
      last = column;
    }
  }
}

}  // namespace

void TfliteBudget::Take(size_t bytes, const std::string& place) {
  if (bytes > bytes_) {
    ThrowFileError(place, "constants of more than 16 times the file's bytes once unpacked, expected at most that");
  }
  bytes_ -= bytes;
}

GraphTensor TfliteFloats(const TfliteStored& stored, const std::vector<int64_t>& shape, const std::string& place,
                         TfliteBudget* budget) {
  if (stored.type == TfliteType::kInt32) ThrowFileError(place, "a constant of int32, expected float32 or float16");
  const size_t size = GraphShapeSize(shape);
  budget->Take(size * sizeof(float), place);
  const std::shared_ptr<float[]> values = AlignedArray(size);
  if (stored.sparsity) {
    std::fill_n(values.get(), size, 0.0F);
    Scatter(stored, shape, place, values.get());
  } else {
    const StoredFloats there(stored, size, place);
    for (size_t i = 0; i < size; ++i) values[static_cast<ptrdiff_t>(i)] = there[i];
  }
  return {shape, SharedNumbers<float>(values, size)};
}

GraphTensor TfliteInts(const TfliteStored& stored, const std::vector<int64_t>& shape, const std::string& place,
                       TfliteBudget* budget) {
  const size_t size = GraphShapeSize(shape);
  if (stored.type != TfliteType::kInt32 || stored.sparsity || stored.bytes.size() != size * sizeof(int32_t)) {
    ThrowFileError(
        place, Concatenate(stored.bytes.size(), " bytes of a constant of another type, expected ", size, " of int32"));
  }
  budget->Take(size * sizeof(int64_t), place);
  const FlatNumbers<int32_t> there(stored.bytes);
  std::vector<int64_t> values(size);
  for (size_t i = 0; i < size; ++i) values[i] = there[i];
  return {shape, std::move(values)};
}

}  // namespace bodyloom
