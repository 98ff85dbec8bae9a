// SPDX-License-Identifier: Apache-2.0
/// Arrays of indices out of files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bodyloom/data_tools/formats/ndarray.h"

namespace bodyloom {

/// The whole numbers of the array called `name`; std::runtime_error naming `where`, the array and the element when it
/// holds anything else.
std::vector<int64_t> WholeNumbers(const NdArray& array, const std::string& name, const std::string& where);

}  // namespace bodyloom
