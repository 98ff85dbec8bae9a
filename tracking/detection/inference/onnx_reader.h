// SPDX-License-Identifier: Apache-2.0
/// Reads networks from ONNX files (.onnx) as graphs (graph.h).
///
/// The file is one message of Protocol Buffers (protobuf.h). Messages, fields by number:
///   Model      7 graph, 8 operator sets (1 domain, 2 version); the others describe the producer
///   Graph      1 nodes, in any order; 5 constants; 11 inputs, 12 outputs
///   Node       1 inputs and 2 outputs by name (an empty input is left out), 3 name, 4 operator, 5 attributes, 7 domain
///   Attribute  1 name, 2 float, 3 whole number, 4 text, 5 tensor, 7 floats, 8 whole numbers; 6, 10, 11 are graphs
///   Tensor     1 shape, 2 type, 8 name, 9 the numbers as they lie, or 4 float32, 5 int32, 7 int64, 10 double one by
///              one; 14 is 1 when they are in another file
///   Value      1 name, 2 type (1 tensor: 1 type of its numbers, 2 shape: 1 axes: 1 length, or 2 a name: dynamic)
/// Types: 1 float32, 10 float16, 6 int32, 7 int64, 9 bool. Float16 becomes float32, the others int64.
///
/// Source: github.com/onnx/onnx, onnx.proto3.
#pragma once

#include <string>
#include <string_view>

#include "tracking/detection/inference/graph.h"

namespace bodyloom {

/// Reads a file with all checks of its format. Bounds: a file of at most 1 GB, 20,000 nodes, 100 attributes a node, 8
/// axes a tensor, constants of at most 16 times the file's bytes. Throws std::runtime_error "path: place: what was
/// found, expected what" for anything else: another type, weights in another file, graphs within the graph, other than
/// one input, operators of another domain than the standard's, nodes that take each other's results in a circle. The
/// graph's nodes follow those whose results they take, otherwise as in the file: exports in half precision list casts
/// last.
OperatorGraph ReadOnnxGraph(const std::string& path);
OperatorGraph ParseOnnxGraph(std::string_view bytes, const std::string& name);

}  // namespace bodyloom
