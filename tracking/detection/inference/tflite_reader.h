// SPDX-License-Identifier: Apache-2.0
/// Reads convolutional networks from TensorFlow Lite files (.tflite), with the operators of MediaPipe's networks of the
/// body, the hands and the face.
///
/// The file is a FlatBuffer (flatbuffer.h) of schema version 3 with the letters TFL3 at byte 4. Tables, fields by
/// number:
///   Model          1 operator codes, 2 subgraphs (one), 4 buffers
///   OperatorCode   0 old code (int8), 1 custom name, 3 code (int32): the operator is the larger of the two
///   SubGraph       0 tensors, 1 inputs, 2 outputs (places among the tensors), 3 operators, in the order they run
///   Tensor         0 shape, 1 type (0 float32, 1 float16, 2 int32), 2 buffer, 3 name, 5 variable, 6 sparsity,
///                  7 shape with −1 where it is dynamic
///   Operator       0 place among the codes, 1 inputs (−1 = left out), 2 outputs, 4 options
///   Buffer         0 bytes; none for what is computed
///
/// Operators, inputs, and options by field. All activations are float32, N×H×W×C with N = 1; "activation" is 0 none or
/// 3 relu6; padding is 0 SAME or 1 VALID; strides are 1 to 3:
///   ADD                two of one shape; 0 activation
///   CONCATENATION      0 axis, 1 activation
///   CONV_2D            input, kernel [out][h][w][in], bias [out] (may be left out); 0 padding, 1 stride_w, 2 stride_h,
///                      3 activation, 4 dilation_w, 5 dilation_h (1)
///   DEPTHWISE_CONV_2D  kernel [1][h][w][channels]; 0 padding, 1 stride_w, 2 stride_h, 3 multiplier (1),
///                      4 activation, 5 dilation_w, 6 dilation_h (1)
///   DEPTH_TO_SPACE     0 block b; out(y·b+r, x·b+s, c) = in(y, x, (r·b+s)·C/b² + c)
///   FULLY_CONNECTED    rows x in, weights [out][in], bias [out] (may be left out); 0 activation, 1 weights format (0)
///   LOGISTIC           1 / (1 + exp(−x))
///   MAX_POOL_2D        0 padding (that of SAME must come to none), 1 stride_w, 2 stride_h, 3 filter_w, 4 filter_h,
///                      5 activation
///   MEAN               int32 constant: axes, from 0; 0 keep_dims
///   PAD                zeros; int32 constant [4][before, after]; the batch has none
///   PRELU              float constant [1][1][channels]: x < 0 becomes slope · x
///   RESHAPE            int32 constant, one number may be −1; in the order of memory
///   RESIZE_BILINEAR    int32 constant (height, width); 2 align_corners (false), 3 half_pixel_centers (true)
///   STRIDED_SLICE      int32 constants begin, end, step (1) of each axis; 0 to 4 masks (0)
///   DEQUANTIZE         float16 constant → float32; folded here, so that it is no operator of the model
///   DENSIFY            sparse constant → dense; folded too
/// A sparse constant (Tensor 6) has 0 traversal order 0 1 2 3, 1 no block map, 2 four dimensions (0 format: 0 dense,
/// 1 compressed; 1 size; 2, 3 row starts and 4, 5 column numbers as a kind – 1 int32, 2 uint16, 3 uint8 – and a table
/// with the vector as field 0): three dense ones, whose places are the rows, and a compressed one.
/// SAME padding: tflite_shapes.h.
///
/// Source: tensorflow/lite/schema/schema.fbs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tracking/detection/inference/graph.h"

namespace bodyloom {

/// Reads a file with all checks of its format, and of the shapes that operators give their outputs. Bounds: a file of
/// at most 256 MB, 10,000 tensors, buffers and operators, 2²⁴ numbers a tensor, 2²⁸ in all that is computed, and
/// constants of at most 16 times the file's bytes once unpacked (sparse ones and shared buffers could claim any
/// number). Throws std::runtime_error "path: place: what was found, expected what" for anything else: another operator,
/// type, option, a custom operator, dynamic shapes, values that are not finite, places and sizes that leave the file.
OperatorGraph ReadTfliteGraph(const std::string& path);
OperatorGraph ParseTfliteGraph(std::string_view bytes, const std::string& name);

/// Reads a network that takes one image of size × size colours and gives outputs of these numbers of values. Throws
/// std::runtime_error naming the file for another one.
OperatorGraph ReadImageNetwork(const std::string& path, int size, const std::vector<size_t>& outputs);

}  // namespace bodyloom
