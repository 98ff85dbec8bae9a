// SPDX-License-Identifier: Apache-2.0
/// The built-in body as a file, built from its cage (data_tools/body_making/make_builtin_body.h).
#pragma once

#include <string>

#include "bodyloom/data_tools/body_making/make_builtin_body.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

struct BuildBuiltinBodyRequest {
  std::string cage, parts;  ///< another cage, with weights, shapes and charts on it; both or neither
  std::string out;          ///< the compact body, .npz
};

struct BuildBuiltinBodyReport {
  MakeBuiltinBodySummary summary;
  std::string description;  ///< DescribeBody of what was written
  std::string out;
};

/// Throws std::runtime_error naming a file that cannot be used, RequestError for a file both read and written,
/// Cancelled.
BuildBuiltinBodyReport BuildBuiltinBody(const BuildBuiltinBodyRequest& request,
                                        const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
