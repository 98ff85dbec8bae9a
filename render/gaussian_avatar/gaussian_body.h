// SPDX-License-Identifier: Apache-2.0
/// A person made of Gaussians that hang on a parametric body: the model's data. How it is posed, with formulas:
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

/// A place on the body's surface.
struct SkinAnchor {
  int32_t face = 0;
  std::array<float, 3> barycentric = {1, 0, 0};
  float corrective_factor = 0;  ///< φ: how much of the surface's pose corrective is followed; 1 on the skin, 0 far off
};

/// What a Gaussian is of.
enum class GaussianKind : uint8_t {
  kSkin,   ///< the body's surface
  kLoose,  ///< hair and whatever else stands off
  kCloth,  ///< a garment that is simulated (geometry/cloth/cloth_nodes.h)
};

/// Rest space is that of the body's shape in T-pose, metres, y up.
struct GaussianBody {
  static constexpr int kInfluences = 6;
  static constexpr int kLightValues = 27;

  /// One row a Gaussian, one column a number that can be learned. Derivatives come in the same columns.
  enum Parameter : int {
    kPosition = 0,                                ///< x, y, z in rest space
    kQuaternion = kPosition + 3,                  ///< w, x, y, z of any length; below 1e-6 it counts as no rotation
    kLogScale = kQuaternion + 4,                  ///< ln of the standard deviations along the turned axes, metres
    kOpacityLogit = kLogScale + 3,                ///< o = 1/(1 + e^−logit)
    kAlbedo = kOpacityLogit + 1,                  ///< red, green, blue, linear
    kNormal = kAlbedo + 3,                        ///< in rest space, of any length; below 1e-6 there is none
    kWeightLogit = kNormal + 3,                   ///< skin weights are their softmax
    kNumParameters = kWeightLogit + kInfluences,  ///< 23
  };
  FloatColumns parameters;
  /// count × kInfluences, row-major: bones of AvatarFrame, the joints first; one may be named twice.
  std::vector<int32_t> joints;
  std::vector<SkinAnchor> anchors;
  std::vector<GaussianKind> kinds;
  /// Lobes included (render/lighting/sh_lighting.h): rows red, green, blue; shading = Σ_h light[9 c + h] Y_h(n).
  std::array<float, kLightValues> light{};

  [[nodiscard]] int size() const { return parameters.rows(); }
  /// For `count` Gaussians; what was there is not kept.
  void Resize(int count);
  /// Whether tables have the same number of rows, joints are in 0..num_joints−1, anchors name faces below num_faces.
  [[nodiscard]] bool IsValid(int num_joints, int num_faces, std::string* why) const;
};

/// What standard deviations may be.
struct ScaleLimits {
  float least_log = -7.5F, most_log = -3.5F;  ///< 0.55 mm to 3 cm
  float needle = 4;                           ///< at least 1: the longest axis is at most so many times the second
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Brings log scales within the limits: each cut to its range, then the longest axis to the second's length times
/// `needle`. A thin third axis (a disc) is left. To be called after a step of training: posing knows no limits, so its
/// derivatives are exact. Returns how many Gaussians were changed; NaN stays. Throws std::invalid_argument for limits
/// that are not valid.
int LimitScales(const ScaleLimits& limits, GaussianBody* body);

// A Gaussian that lies flat on a surface.

struct FlatGaussian {
  Eigen::Vector3d place, normal;  ///< rest space; the normal of unit length
  double sigma_m = 0.01;          ///< along the surface; at least 10 µm
  float flatness = 1;             ///< σ across it, of σ along it
  float opacity_logit = 0, albedo = 0;
};

/// Sets place, turn, scales, opacity, albedo and normal of a row.
void SetFlatGaussian(const FlatGaussian& gaussian, int row, GaussianBody* body);

// Vertices of a body as places that Gaussians are anchored at.

/// Keeps a reference to the body.
class VertexAnchors {
 public:
  explicit VertexAnchors(const BodyModel& model);
  /// On the first face that has the vertex.
  [[nodiscard]] SkinAnchor At(int vertex, float corrective_factor) const;

 private:
  const BodyModel& model_;
  std::vector<int> face_of_;
};

}  // namespace bodyloom
