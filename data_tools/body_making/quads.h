// SPDX-License-Identifier: Apache-2.0
/// Quad connectivity shared by the control cage and its subdivisions.
#pragma once

#include <array>
#include <vector>

namespace bodyloom {

using Quad = std::array<int, 4>;  ///< vertex indices, counter-clockwise seen from outside
using Edge = std::array<int, 2>;  ///< vertex indices in the direction in which the edge was first met

}  // namespace bodyloom
