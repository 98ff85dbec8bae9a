// SPDX-License-Identifier: Apache-2.0
/// Builds a body from named arrays, as in the official files of the SMPL family (V vertices, J joints, B shape
/// components):
///   v_template V×3, f F×3, weights V×J, kintree_table 2×J (row 0: parents, the root −1 or 2³²−1), J_regressor J×V;
///   optional: shapedirs V×3×B, posedirs V×3×9(J−1), hands_meanl/r 45 (SMPL-H/X), vt U×2 and ft F×3 (SMPL-X);
///   the built-in body's dense form adds part F, iu_uv F×3×2, and landmark_names/indptr/indices/weights (CSR).
/// SMPL-X's expression components (the last 10 of 20 or 100 of 400 in shapedirs) are left out, since they are not
/// shape. Source: smplx body_models.py (keys); assets' RECIPE (built-in).
#pragma once

#include <map>
#include <string>

#include "data_tools/body/body_io.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/pickle.h"

namespace bodyloom {

/// Borrowed arrays by name.
class NamedArrays {
 public:
  NamedArrays(const NpzArrays& arrays, std::string where);
  /// Takes the arrays among a dictionary's values. Throws std::runtime_error when `pickle` is not a dictionary.
  NamedArrays(const PickleValue& pickle, std::string where);

  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] const NdArray* Find(const std::string& name) const;
  /// Returns the array of numbers `name` of this shape (−1: any size); throws std::runtime_error without one.
  [[nodiscard]] const NdArray& Require(const std::string& name, const std::vector<int64_t>& shape) const;
  [[noreturn]] void Fail(const std::string& message) const;

 private:
  std::map<std::string, const NdArray*> arrays_;
  std::string where_;
};

/// The result is not yet checked by BodyModel. Throws std::runtime_error naming file, array, what it is and what was
/// expected.
BodyModelData BodyFromArrays(const NamedArrays& arrays, const LoadBodyOptions& options);

}  // namespace bodyloom
