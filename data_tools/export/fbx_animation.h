// SPDX-License-Identifier: Apache-2.0
/// Animation of an FBX document: one stack with one layer, curves with linear keys.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "data_tools/export/fbx_document.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

/// Angles (x, y, z) in degrees with R = Rz·Ry·Rx, FBX's default order, one row per rotation. Each row is, of the
/// representations of its rotation, the one nearest to the row before it (the first: to 0), so that curves do not jump;
/// at y = ±90° x is continued.
MatrixX3d ContinuousEulerXyz_deg(std::span<const Eigen::Matrix3d> rotations);

/// Times of keys, increasing; shared by curves.
class FbxKeys {
 public:
  explicit FbxKeys(std::span<const double> seconds);
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] const FbxNode& node() const { return node_; }

 private:
  FbxNode node_;
  int count_ = 0;
};

class FbxAnimation {
 public:
  /// The document is borrowed.
  FbxAnimation(FbxDocument* document, const std::string& name, double duration_s);

  /// Animates "Lcl Translation", "Lcl Rotation" or "Lcl Scaling" of an object: a row per key. Nothing is written if all
  /// rows are equal to `resting`, the property's own value.
  void AddVector(int64_t object, const std::string& property, const FbxKeys& keys, const MatrixX3d& values,
                 const Eigen::Vector3d& resting);
  /// Animates a property of one number.
  void AddNumber(int64_t object, const std::string& property, const FbxKeys& keys, std::span<const float> values);

 private:
  void AddCurve(int64_t curve_node, const std::string& channel, const FbxKeys& keys, std::span<const float> values);

  FbxDocument& document_;
  int64_t layer_ = 0;
};

}  // namespace bodyloom
