// SPDX-License-Identifier: Apache-2.0
#include "data_tools/avatar/gaussian_ply.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

static_assert(std::endian::native == std::endian::little, "floats are written as they lie in memory");

constexpr double kSh0 = 0.28209479177387814;
constexpr std::array<const char*, 17> kPlyProperties = {"x",       "y",      "z",      "nx",      "ny",      "nz",
                                                        "f_dc_0",  "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                                                        "scale_2", "rot_0",  "rot_1",  "rot_2",   "rot_3"};
using PlyRow = std::array<float, kPlyProperties.size()>;

bool PlyRowOf(const FloatColumns& table, int row, PlyRow* values) {
  for (int c = 0; c < CameraGaussians::kNumColumns; ++c) {
    if (!std::isfinite(table(row, c))) return false;
  }
  Eigen::Matrix3d factor;
  for (int k = 0; k < 9; ++k) factor(k / 3, k % 3) = table(row, CameraGaussians::kFactor + k);
  // Smallest first; largest first with the middle one kept in place is a mirror, undone below.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(factor * factor.transpose());
  Eigen::Matrix3d axes;
  for (int k = 0; k < 3; ++k) {
    axes.col(k) = solver.eigenvectors().col(2 - k);
    (*values)[10 + k] = static_cast<float>(0.5 * std::log(std::max(1e-14, solver.eigenvalues()[2 - k])));
  }
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  const Eigen::Quaterniond turn(axes);
  const double opacity = std::clamp<double>(table(row, CameraGaussians::kOpacity), 1e-6, 1 - 1e-6);
  for (int k = 0; k < 3; ++k) {
    (*values)[k] = table(row, CameraGaussians::kX + k);
    (*values)[3 + k] = 0;
    (*values)[6 + k] = static_cast<float>((table(row, CameraGaussians::kRed + k) - 0.5) / kSh0);
  }
  (*values)[9] = static_cast<float>(std::log(opacity / (1 - opacity)));
  const std::array<double, 4> rotation = {turn.w(), turn.x(), turn.y(), turn.z()};
  std::copy(rotation.begin(), rotation.end(), values->begin() + 13);
  return true;
}

}  // namespace

std::string GaussianPlyBytes(const CameraGaussians& gaussians) {
  std::string rows;
  int count = 0;
  for (int i = 0; i < gaussians.size(); ++i) {
    PlyRow row;
    if (!PlyRowOf(gaussians.columns, i, &row)) continue;
    rows.append(reinterpret_cast<const char*>(row.data()), sizeof row);
    ++count;
  }
  std::string header = Concatenate("ply\nformat binary_little_endian 1.0\nelement vertex ", count, "\n");
  for (const char* property : kPlyProperties) header += Concatenate("property float ", property, "\n");
  return header + "end_header\n" + rows;
}

void WriteGaussianPly(const std::string& path, const CameraGaussians& gaussians) {
  WriteFileAtomically(path, GaussianPlyBytes(gaussians));
}

}  // namespace bodyloom
