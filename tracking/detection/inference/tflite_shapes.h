// SPDX-License-Identifier: Apache-2.0
/// The shapes that TensorFlow Lite's operators give their results.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tracking/detection/inference/tflite_model.h"

namespace bodyloom {

/// Zeros around the rows or the columns of an image.
struct TflitePads {
  int before = 0, after = 0;
};

/// TensorFlow's SAME: total = max((⌈size / stride⌉ − 1)·stride + kernel − size, 0), the smaller half before. Uneven
/// when the total is odd: a 3×3 kernel of stride 2 on an even size has 0 before and 1 after.
TflitePads SamePads(int size, int kernel, int stride);

/// Shape of the operator's result. Its inputs' shapes and the int32 constants must be there. Throws std::runtime_error
/// "place: what was found, expected what" when the inputs do not fit each other.
std::vector<int> TfliteOutputShape(const TfliteModel& model, const TfliteOperator& op, const std::string& place);

/// N×height×width×channels.
bool IsTfliteImage(const std::vector<int>& shape);

/// Product of the sizes.
size_t NumTfliteValues(const std::vector<int>& shape);

/// "1x64x64x3".
std::string TfliteShapeText(const std::vector<int>& shape);

}  // namespace bodyloom
