// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/formats/whole_numbers.h"

#include <stdexcept>

namespace bodyloom {

std::vector<int64_t> WholeNumbers(const NdArray& array, const std::string& name, const std::string& where) {
  try {
    return array.ToInts();
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(where + ": " + name + ": " + error.what());
  }
}

}  // namespace bodyloom
