// SPDX-License-Identifier: Apache-2.0
/// Converts any readable body to one compact file, optionally with texture coordinates and parts from other files.
#pragma once

#include <string>

#include "data_tools/body/body_io.h"
#include "data_tools/body_making/make_builtin_body.h"
#include "geometry/base/callbacks.h"

namespace bodyloom {

struct ConvertBodyRequest {
  std::string body;   ///< SMPL, SMPL-H or SMPL-X .pkl or .npz
  std::string uv;     ///< texture coordinates from an OBJ with the body's vertices; empty: the body's own
  std::string parts;  ///< body parts from DensePose's UV_Processed.mat; empty: the body's own
  std::string out;    ///< the compact body, .npz
  LoadBodyOptions load;
};

struct ConvertBodyReport {
  std::string description;  ///< DescribeBody of what was written
  std::string out;
};

/// Converts the body; the description includes the number of faces with a part if parts were given. Throws
/// std::runtime_error naming a file that cannot be used, RequestError for a file both read and written, Cancelled.
ConvertBodyReport ConvertBody(const ConvertBodyRequest& request, const PipelineCallbacks& callbacks = {});

// Building of the built-in body from its cage (data_tools/body_making/make_builtin_body.h).

struct BuildBuiltinBodyRequest {
  std::string cage, parts;  ///< another cage, with weights, shapes and charts on it; both or neither
  bool hands = false;       ///< with SMPL-H's finger joints
  std::string out;          ///< the compact body, .npz
};

struct BuildBuiltinBodyReport {
  MakeBuiltinBodySummary summary;
  std::string description;  ///< DescribeBody of what was written
  std::string out;
};

/// Builds and writes the body. Throws std::runtime_error naming a file that cannot be used, RequestError for a file
/// both read and written, Cancelled.
BuildBuiltinBodyReport BuildBuiltinBody(const BuildBuiltinBodyRequest& request,
                                        const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
