// SPDX-License-Identifier: Apache-2.0
/// ONNX operators that move numbers without changing them, and those that count: shapes, ranges, constants.
#pragma once

#include <vector>

#include "tracking/detection/inference/onnx_arithmetic.h"

namespace bodyloom {

OnnxTensor OnnxConcat(const OnnxArguments& arguments);
std::vector<OnnxTensor> OnnxSplit(const OnnxArguments& arguments);
OnnxTensor OnnxSlice(const OnnxArguments& arguments);
OnnxTensor OnnxTranspose(const OnnxArguments& arguments);
OnnxTensor OnnxGather(const OnnxArguments& arguments);
/// Values written to whole places of the first axes.
OnnxTensor OnnxScatterNd(const OnnxArguments& arguments);
/// Reshape, Flatten, Squeeze, Unsqueeze.
OnnxTensor OnnxReshape(const OnnxArguments& arguments);
/// Expand, and Tile.
OnnxTensor OnnxExpand(const OnnxArguments& arguments);
OnnxTensor OnnxTile(const OnnxArguments& arguments);
/// Cast: floats of all sizes are float32 here, whole numbers and truth int64.
OnnxTensor OnnxCast(const OnnxArguments& arguments);
/// Shape, Constant, ConstantOfShape, Range.
OnnxTensor OnnxShapeOf(const OnnxArguments& arguments);
OnnxTensor OnnxConstant(const OnnxArguments& arguments);
OnnxTensor OnnxConstantOfShape(const OnnxArguments& arguments);
OnnxTensor OnnxRange(const OnnxArguments& arguments);

}  // namespace bodyloom
