// SPDX-License-Identifier: Apache-2.0
/// Which picture refiner a request names.
#pragma once

#include <memory>
#include <string>

#include "bodyloom/pipelines/person/picture_refiner.h"

namespace bodyloom {

/// Pictures stay as they are drawn.
inline constexpr const char* kNoRefiner = "none";

/// Null for "none"; else of the weights in the file `name` (data_tools/learned/refiner_weights_io.h). Throws
/// std::runtime_error naming a file that cannot be used.
std::unique_ptr<PictureRefiner> OpenRefiner(const std::string& name);

}  // namespace bodyloom
