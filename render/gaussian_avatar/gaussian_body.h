// SPDX-License-Identifier: Apache-2.0
/// Data of a person modelled by Gaussians bound to a parametric body. Formulas of posing:
/// render/gaussian_avatar/pose_gaussians.h.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "render/splat/float_columns.h"

namespace bodyloom {

/// A point on the body's surface.
struct SkinAnchor {
  int32_t face = 0;
  std::array<float, 3> barycentric = {1, 0, 0};
  float corrective_factor = 0;  ///< φ: weight of the surface's pose corrective; 1 on the skin, 0 far from it
};

/// Kind of surface that a Gaussian represents.
enum class GaussianKind : uint8_t {
  kSkin,   ///< the body's surface
  kLoose,  ///< hair and anything else off the skin
  kCloth,  ///< a simulated garment (geometry/cloth/cloth_nodes.h)
};

/// Rest space is that of the body's shape in T-pose, metres, y up.
struct GaussianBody {
  static constexpr int kInfluences = 6;
  static constexpr int kLightValues = 27;

  /// One row per Gaussian, one column per learnable parameter. Derivatives use the same columns.
  enum Parameter : int {
    kPosition = 0,                                ///< x, y, z in rest space
    kQuaternion = kPosition + 3,                  ///< w, x, y, z of any length; identity if shorter than 1e-6
    kLogScale = kQuaternion + 4,                  ///< ln of the standard deviations along the rotated axes, metres
    kOpacityLogit = kLogScale + 3,                ///< o = 1/(1 + e^−logit)
    kAlbedo = kOpacityLogit + 1,                  ///< red, green, blue, linear
    kNormal = kAlbedo + 3,                        ///< in rest space, of any length; none if shorter than 1e-6
    kWeightLogit = kNormal + 3,                   ///< skinning weights are their softmax
    kNumParameters = kWeightLogit + kInfluences,  ///< 23
  };
  FloatColumns parameters;
  /// count × kInfluences, row-major: indices of AvatarFrame's bones, joints first; duplicates are allowed.
  std::vector<int32_t> joints;
  std::vector<SkinAnchor> anchors;
  std::vector<GaussianKind> kinds;
  /// Coefficients including lobes (render/lighting/sh_lighting.h): rows red, green, blue; shading = Σ_h light[9 c + h]
  /// Y_h(n).
  std::array<float, kLightValues> light{};

  [[nodiscard]] int size() const { return parameters.rows(); }
  /// Resizes to `count` Gaussians; values are not kept.
  void Resize(int count);
  /// True if tables have the same number of rows, joints are in 0..num_joints−1 and anchor faces in 0..num_faces−1.
  [[nodiscard]] bool IsValid(int num_joints, int num_faces, std::string* why) const;
};

/// Limits of the standard deviations.
struct ScaleLimits {
  float min_log = -7.5F, max_log = -3.5F;  ///< 0.55 mm to 3 cm
  float max_axis_ratio = 4;                ///< at least 1: maximum ratio of the longest axis to the second
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Clamps log scales to the limits: each to its range, then the longest axis to max_axis_ratio times the second. A thin
/// third axis (a disc) is not limited. Call it after a training step: posing does not clamp, so its derivatives are
/// exact. Returns the number of changed Gaussians; NaN stays. Throws std::invalid_argument for limits that are not
/// valid.
int LimitScales(const ScaleLimits& limits, GaussianBody* body);

struct FlatGaussian {
  Eigen::Vector3d place, normal;  ///< rest space; unit normal
  double sigma_m = 0.01;          ///< along the surface; at least 10 µm
  float flatness = 1;             ///< σ across the surface relative to that along it
  float opacity_logit = 0, albedo = 0;
};

/// Sets position, quaternion, scales, opacity, albedo and normal of a row.
void SetFlatGaussian(const FlatGaussian& gaussian, int row, GaussianBody* body);

/// Anchors at vertices of a body. Keeps a reference to the body.
class VertexAnchors {
 public:
  explicit VertexAnchors(const BodyModel& model);
  /// The anchor on the first face that has the vertex.
  [[nodiscard]] SkinAnchor At(int vertex, float corrective_factor) const;

 private:
  const BodyModel& model_;
  std::vector<int> face_of_;
};

}  // namespace bodyloom
