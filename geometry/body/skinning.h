// SPDX-License-Identifier: Apache-2.0
/// Poses a body in many frames at once; formulas in geometry/body/body_model.h, one frame at a time in
/// geometry/body/posed_body.h.
///
///   const Skinner skinner(model, {.num_threads = 2});
///   const ShapedBody body = skinner.Shape(betas);
///   std::vector<double> vertices(3 * poses.size() * skinner.num_vertices());
///   skinner.Skin(body, poses, vertices);
///
/// The kinematic tree is evaluated in double, the vertices in float relative to the root joint (SIMD across frames, the
/// instruction set chosen at run time), so the error does not grow with the distance from the origin: below 1e-6 m for
/// a body of human size. Shape is blended once per ShapedBody. The correctives of all frames are evaluated in one pass
/// over their coefficients, because reading those (17 MB for SMPL) costs more than using them once.
///
/// Determinism: a frame's vertices are bitwise the same for any number of threads and any other requested frames and
/// vertices. Instruction sets differ in the last bits (fused multiply-add or not).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

struct SkinnerOptions {
  int num_threads = 1;              ///< 1 to 1024
  std::vector<int> vertices;        ///< only these, in this order; empty: all
  bool skip_resting_joints = true;  ///< leave out correctives of joints at rest throughout 32 frames (exact)
  [[nodiscard]] bool IsValid(const BodyModel& model, std::string* why) const;
};

/// A shape, ready to be posed by the Skinner that made it.
struct ShapedBody {
  MatrixX3d rest_joints;        ///< J×3 metres
  std::vector<float> vertices;  ///< chosen × 3: shaped, unposed, relative to the root joint
};

/// Statistics of a call: work done and work skipped.
struct SkinningSummary {
  int frames = 0, vertices = 0;
  int64_t corrective_blocks = 0;          ///< (vertex, joint, frame) blocks evaluated
  int64_t corrective_blocks_skipped = 0;  ///< because the joint was at rest
  std::string simd_target;                ///< instruction set used
};

/// Immutable and safe to share between threads. The model must outlive it.
class Skinner {
 public:
  /// Throws std::invalid_argument when the options are not valid for the body.
  explicit Skinner(const BodyModel& model, SkinnerOptions options = {});
  explicit Skinner(BodyModel&&, SkinnerOptions = {}) = delete;

  [[nodiscard]] int num_vertices() const { return static_cast<int>(options_.vertices.size()); }

  /// betas may be shorter than the body's (the rest is zero); longer throws.
  [[nodiscard]] ShapedBody Shape(const Eigen::VectorXd& betas) const;

  /// Vertices in the frame of the poses, metres: T × num_vertices() × 3, frame-major. Throws std::invalid_argument when
  /// a pose, the shape or the output has the wrong size. A frame whose rotations or translation are not finite gives
  /// NaN vertices and does not affect the others.
  SkinningSummary Skin(const ShapedBody& body, std::span<const BodyPose> poses, std::span<double> vertices) const;

  /// The same minus the root joint's position, in float; the positions (T×3) go to `roots`.
  SkinningSummary SkinFromRoot(const ShapedBody& body, std::span<const BodyPose> poses, std::span<float> vertices,
                               MatrixX3d* roots) const;

 private:
  SkinningSummary Run(const ShapedBody& body, std::span<const BodyPose> poses, float* float_output,
                      double* double_output, size_t output_size, MatrixX3d* roots) const;

  const BodyModel& model_;
  SkinnerOptions options_;
  std::vector<float> influence_weight_;
  std::vector<int64_t> blocks_of_joint_;  ///< corrective blocks of the chosen vertices by joint
};

// Joints that move each vertex, by its skinning weights.

/// Joint with the largest skinning weight of each vertex (V entries); the first of equal ones.
std::vector<int> StrongestJoints(const BodyModel& body);

/// For each vertex (V entries), the sum of the weights of the named joints and all their descendants, in [0, 1]. Names
/// that the body lacks are ignored.
std::vector<double> WeightsBelow(const BodyModel& body, const std::vector<std::string>& joints);

}  // namespace bodyloom
