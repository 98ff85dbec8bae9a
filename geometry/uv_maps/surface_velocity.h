// SPDX-License-Identifier: Apache-2.0
/// Velocities of a body's vertices, m/s.
///
/// By differences (DifferenceVertices): v = Σ_k w_k x_k with the weights of a VelocityStencil, on vertices relative to
/// the root in float and the root in double, so precision does not depend on the distance from the origin.
///
/// Analytically (VelocitySkinner): the body model's exact derivative in the direction of the parameters' rates,
///   v̇ = Σ_j w_j ( Ġ_j v_rest + ṫ_j ) + Σ_j w_j G_j ( posedirs · vec Ṙ ),    Ġ_j = Ġ_p R_j + G_p R_j [ω_j]×,
/// two more passes of the skinning loop (geometry/body/skinning_simd.h) instead of a Jacobian of 3V×3J. The rates come
/// from the same stencils on the group: ω_j = Σ_k w_k log(R_j(t)ᵀ R_j(t_k)). It does not amplify noise of the vertices;
/// cost and accuracy compared with differences: docs/lab/descriptors.md.
///
/// Frames. A velocity is that of the coordinates in one frame:
///   camera   d x_camera/dt, the camera's own motion included
///   world    d x_world/dt, x_world = R (x_camera − t) with the camera's pose (geometry/scene/camera.h)
///   body     d/dt [ Rᵀ (x − x_root) ] = Rᵀ ( v − v_root − ω × (x − x_root) ): motion relative to the pelvis
/// So poses are transformed into the frame first (PosesInFrame), and all later steps, normals included, are the same; a
/// body that moves rigidly has body velocities of exactly zero in any scheme.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"
#include "geometry/uv_maps/velocity_stencil.h"

namespace bodyloom {

enum class SurfaceFrame { kCamera, kWorld, kBody };

std::string ToString(SurfaceFrame frame);

/// The poses of a track's frames in `frame`; an empty optional for lost frames and values that are not finite. Weak
/// perspective: (tx, ty) of a frame, metres, are part of its position. `camera_pose` is for kWorld. In the body frame
/// the root stays at its rest position.
std::vector<std::optional<BodyPose>> PosesInFrame(const BodyModel& body, const Track& track, SurfaceFrame frame,
                                                  const CameraPose& camera_pose = {});

/// velocities (V×3) = Σ_k weights[k] · (vertices[k] + roots[k]), m/s: vertices[k] points at V×3 floats relative to the
/// root, roots[k] at that root. Sizes are the caller's responsibility; no weights give zeros.
void DifferenceVertices(const VelocityStencil& stencil, std::span<const float* const> vertices,
                        std::span<const Eigen::Vector3d> roots, std::span<float> velocities);

/// Rates of a pose: rotations vary on the right, R_j ← R_j exp([ω_j]× dt).
struct PoseRates {
  std::vector<Eigen::Vector3d> angular;  ///< J, rad/s
  Eigen::Vector3d trans = Eigen::Vector3d::Zero();
};

/// Rates of poses[at] from poses[k] with weights[k]. All poses have as many joints.
PoseRates RatesOf(const VelocityStencil& stencil, std::span<const BodyPose* const> poses, const BodyPose& at);

/// Immutable and safe to share between threads. The model must outlive it.
class VelocitySkinner {
 public:
  explicit VelocitySkinner(const BodyModel& model);
  explicit VelocitySkinner(BodyModel&&) = delete;

  /// Velocities (T×V×3, m/s) of all vertices of the body that `shape` (of a Skinner of all vertices) describes. Throws
  /// std::invalid_argument when sizes differ.
  void Velocities(const ShapedBody& shape, std::span<const BodyPose> poses, std::span<const PoseRates> rates,
                  std::span<float> velocities, int num_threads) const;

 private:
  const BodyModel& model_;
  std::vector<int> all_vertices_;
  std::vector<float> influence_weight_;
};

}  // namespace bodyloom
