// SPDX-License-Identifier: Apache-2.0
/// Bytes of a .npy that holds one Python object, as numpy.save writes it.
#pragma once

#include <string>

#include "tests/data_tools/formats/pickle_writer.h"

namespace bodyloom {

/// `values` are the opcodes of the object (of all of them, when `shape` has more than one).
inline std::string ObjectNpyBytes(const std::string& values, const std::string& shape = "()") {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const std::string array = Global("numpy.core.multiarray", "_reconstruct") +
                            Tuple({Global("numpy", "ndarray"), Tuple({Int(0)}), Str2("b")}) + "R" +
                            Tuple({Int(1), Tuple({}), Dtype2("O8", '|'), "\x89", "](" + values + "e"}) + "b";
  std::string header = "{'descr': '|O', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize(118, ' ');
  return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + Pickle(2, array);
}

}  // namespace bodyloom
