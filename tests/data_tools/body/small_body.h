// SPDX-License-Identifier: Apache-2.0
/// A synthetic body of any size as plain arrays, and as the official pickle and .npz files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "data_tools/formats/npz.h"

namespace bodyloom {

/// Dense arrays in the official layout.
struct BodyArrays {
  int V = 0, J = 0, B = 0;
  std::vector<double> v_template;     // V×3
  std::vector<int32_t> f;             // F×3
  std::vector<double> weights;        // V×J, two influences a vertex
  std::vector<int64_t> parents;       // J, the root 2³²−1
  std::vector<double> J_regressor;    // J×V, eight entries a row
  std::vector<double> shapedirs;      // V×3×B
  std::vector<double> posedirs;       // V×3×9(J−1), or empty
  std::vector<double> hands_mean[2];  // 45 each, or empty
};

/// A tube of V vertices (rings of ten, so that faces join neighbouring rows) on SMPL's tree, extended by chains for
/// more joints. Values are pseudo-random and identical on every platform.
BodyArrays MakeBodyArrays(int V, int J, int B, bool with_posedirs);

/// Pickle in the form of SMPL's official files: protocol 2 of Python 2, str keys, chumpy shapedirs (a Select over a Ch)
/// and posedirs (Ch), scipy csc J_regressor, uint32 faces and tree.
std::string OfficialPickle(const BodyArrays& body);

/// Archive in the form of smplx' .npz files.
NpzArrays OfficialNpz(const BodyArrays& body);

}  // namespace bodyloom
