// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/hand_components.h"

#include <Eigen/QR>
#include <stdexcept>
#include <vector>

#include "data_tools/body/body_smpl.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/zip.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int64_t kHandPoseValues = 45;

std::optional<std::array<HandComponents, 2>> ComponentsIn(const NamedArrays& arrays) {
  if (arrays.Find("hands_componentsl") == nullptr || arrays.Find("hands_componentsr") == nullptr) return std::nullopt;
  std::array<HandComponents, 2> hands;
  for (size_t side = 0; side < 2; ++side) {
    const std::string components = side == 0 ? "hands_componentsl" : "hands_componentsr";
    const std::string mean = side == 0 ? "hands_meanl" : "hands_meanr";
    hands[side].components = arrays.Require(components, {-1, kHandPoseValues}).ToMatrix();
    const Eigen::Index rows = hands[side].components.rows();
    if (rows < 1 || rows > kHandPoseValues) {
      arrays.Fail(Concatenate(components, ": ", rows, " rows, expected 1 to ", kHandPoseValues));
    }
    const std::vector<double> values = arrays.Require(mean, {kHandPoseValues}).ToDoubles();
    hands[side].mean = Eigen::Map<const Eigen::VectorXd>(values.data(), kHandPoseValues);
    if (!hands[side].components.allFinite()) arrays.Fail(components + ": NaN or infinite values");
    if (!hands[side].mean.allFinite()) arrays.Fail(mean + ": NaN or infinite values");
  }
  return hands;
}

}  // namespace

Eigen::VectorXd HandComponents::Pose(const Eigen::VectorXd& coefficients, bool flat_hand_mean) const {
  BODYLOOM_CHECK(coefficients.size() <= components.rows(), "hand pose: ", coefficients.size(),
                 " coefficients, expected at most ", components.rows());
  Eigen::VectorXd pose = components.topRows(coefficients.size()).transpose() * coefficients;
  if (!flat_hand_mean) pose += mean;
  return pose;
}

Eigen::VectorXd HandComponents::Coefficients(const Eigen::VectorXd& pose, int count, bool flat_hand_mean) const {
  BODYLOOM_CHECK(pose.size() == kHandPoseValues, "hand pose: ", pose.size(), " values, expected ", kHandPoseValues);
  BODYLOOM_CHECK(count >= 1 && count <= components.rows(), "hand pose: ", count, " coefficients, expected 1 to ",
                 components.rows());
  const Eigen::MatrixXd basis = components.topRows(count).transpose();
  return basis.colPivHouseholderQr().solve(flat_hand_mean ? pose : Eigen::VectorXd(pose - mean));
}

std::optional<std::array<HandComponents, 2>> LoadHandComponents(const std::string& path) {
  const std::string bytes = ReadFileBytes(path);
  if (bytes.empty()) throw std::runtime_error(path + ": an empty file, expected a body model (.npz or .pkl)");
  if (LooksLikeZip(bytes)) {
    const NpzArrays arrays = ReadNpzBytes(bytes, path);
    return ComponentsIn(NamedArrays(arrays, path));
  }
  const PicklePtr pickle = ReadPickle(bytes, path);
  return ComponentsIn(NamedArrays(*pickle, path));
}

}  // namespace bodyloom
