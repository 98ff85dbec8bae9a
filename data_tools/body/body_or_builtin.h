// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

/// The body in a file (data_tools/body/body_io.h), or the built-in one for an empty path. Throws std::runtime_error
/// naming the file and what is wrong with it.
std::shared_ptr<const BodyModel> BodyOrBuiltin(const std::string& path);

}  // namespace bodyloom
