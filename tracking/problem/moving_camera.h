// SPDX-License-Identifier: Apache-2.0
/// A camera that moves, as one change of variables: a frame's state is in the scene, its terms are in the camera frame.
///
/// With R, t the frame's camera_from_scene and J0(β) the pelvis at rest, the body that the camera sees has
///   R_root' = R R_root,   trans' = R (J0 + trans) + t − J0,
/// and everything else as it is. Right increments of the root are the same in both, so of all columns those of the
/// translation and of the shape alone change: d trans' = R d trans + (R − I) (∂J0/∂β) dβ = R d trans + K dβ. A frame's
/// terms are summed in the camera frame and taken to the scene once, however many they are:
///   g ← Tᵀ g,   H ← Tᵀ H T,   T the identity but for R and K in the three rows of the translation.
/// So no term knows that the camera moves, accelerations and velocities between frames are those of the scene, and a
/// clip of a camera that stands still pays nothing. Not for weak perspective, which has no place in a scene.
#pragma once

#include <Eigen/Core>

#include "geometry/scene/camera.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

/// The state in the frame of the camera, or back from it (scene_from_camera = Inverse(camera_from_scene)).
FrameState StateInCamera(const FrameLayout& layout, const CameraPose& camera_from_scene, const Eigen::VectorXd& betas,
                         FrameState state);

/// The state of frame t as its camera has it: the frame's own state where the camera stands still.
FrameState StateInCamera(const SequenceProblem& problem, size_t t);

/// The sums of a frame's terms, which are by the camera frame's columns, by the scene's.
void TakeToScene(const FrameLayout& layout, const CameraPose& camera_from_scene, FrameSystem* system);

/// Rows of derivatives by the camera frame's columns, likewise: J T.
void TakeRowsToScene(const FrameLayout& layout, const CameraPose& camera_from_scene, Eigen::Ref<RowMatrixXd> J);

}  // namespace bodyloom
