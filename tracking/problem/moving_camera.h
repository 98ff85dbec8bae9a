// SPDX-License-Identifier: Apache-2.0
/// Moving cameras by a change of variables: a frame's state is in the scene, its terms are in the camera frame.
///
/// With R, t the frame's camera_from_scene and J0(β) the pelvis at rest, the body in the camera frame has
///   R_root' = R R_root,   trans' = R (J0 + trans) + t − J0,
/// and is otherwise the same. Right increments of the root are the same in both frames, so only the columns of the
/// translation and of the shape change: d trans' = R d trans + (R − I) (∂J0/∂β) dβ = R d trans + K dβ. A frame's terms
/// are summed in the camera frame, and the sums are transformed to the scene once:
///   g ← Tᵀ g,   H ← Tᵀ H T,   T the identity except for R and K in the three rows of the translation.
/// So terms do not depend on the camera's motion, accelerations and velocities between frames are those of the scene,
/// and static cameras have no overhead. Not for weak perspective, which has no position in a scene.
#pragma once

#include <Eigen/Core>

#include "geometry/scene/camera.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

/// Transforms the state to the frame of the camera, or back with the inverse pose (Inverse(camera_from_scene)).
FrameState StateInCamera(const FrameLayout& layout, const CameraPose& camera_from_scene, const Eigen::VectorXd& betas,
                         FrameState state);

/// The state of frame t in the frame of its camera: the frame's own state if the camera is static.
FrameState StateInCamera(const SequenceProblem& problem, size_t t);

/// Transforms the sums of a frame's terms from the camera frame's columns to the scene's.
void TakeToScene(const FrameLayout& layout, const CameraPose& camera_from_scene, FrameSystem* system);

/// Transforms rows of derivatives likewise: J T.
void TakeRowsToScene(const FrameLayout& layout, const CameraPose& camera_from_scene, Eigen::Ref<RowMatrixXd> J);

}  // namespace bodyloom
