// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body/body_faces_codec.h"

#include <stdexcept>

#include "bodyloom/data_tools/body/body_codec.h"
#include "bodyloom/data_tools/formats/zip.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

NdArray PackFaces(const MatrixX3i& faces, int lag) {
  Integers residuals(faces.size());
  for (Eigen::Index i = 0; i < faces.size(); ++i) {
    residuals[i] = faces.data()[i] - (i >= 3 * lag ? faces.data()[i - 3 * lag] : 0);
  }
  return PackIntegers(residuals);
}

int BestLag(const MatrixX3i& faces) {
  int best = 1;
  size_t best_size = 0;
  for (const int lag : {1, 2, 8}) {
    const size_t size = MakeZip({{"f", PackFaces(faces, lag).bytes}}).size();
    if (best_size == 0 || size < best_size) {
      best = lag;
      best_size = size;
    }
  }
  return best;
}

MatrixX3i UnpackFaces(const NdArray& packed, int lag, int64_t limit, int64_t expected_faces, const std::string& where) {
  Integers values = UnpackIntegers(packed, expected_faces < 0 ? -1 : 3 * expected_faces, where);
  if (values.size() % 3 != 0) throw std::runtime_error(where + ": not a whole number of triangles");
  for (size_t i = 0; i < values.size(); ++i) {
    const int64_t before = i >= 3 * static_cast<size_t>(lag) ? values[i - 3 * static_cast<size_t>(lag)] : 0;
    const int64_t index = values[i] + before;
    if (index < 0 || index >= limit) {
      throw std::runtime_error(
          Concatenate(where, ": face ", i / 3, " names vertex ", index, ", expected 0..", limit - 1));
    }
    values[i] = static_cast<int32_t>(index);
  }
  return Eigen::Map<const MatrixX3i>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3);
}

}  // namespace bodyloom
