// SPDX-License-Identifier: Apache-2.0
/// The held-out-camera protocol on AIST++: a fit to one of nine cameras is scored in the other eight and against the 3D
/// joints.
#pragma once

#include <string>

#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/held_out_views.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Reads a clip of AIST++: keypoints2d/<sequence>.pkl of all views, keypoints3d_optim, motions/<sequence>.pkl if it
/// exists (SMPL poses; betas are zero, translation = smpl_trans / smpl_scaling), and the cameras of its setting.
/// Metres; 60 frames per second. Throws std::runtime_error naming the file that cannot be used.
MultiViewClip ReadAistClip(const std::string& annotations_folder, const std::string& cameras_folder,
                           const std::string& sequence);

/// Protocol "aist-held-out": EvaluateHeldOutViews on that clip. `view` is the camera the track was fitted to ("c01").
/// With the body that the track was made with, also the per-vertex projection error of paper A, Table 4, against the
/// recording's own SMPL motion on that body (as published on a body of SMPL's 6,890 vertices, fitted to the 3D joints
/// on any other), and the errors of OpenSim's coordinates (data_tools/evaluation/joint_angle_errors.h).
Evaluation EvaluateAist(const Track& track, const MultiViewClip& clip, const std::string& view,
                        const BodyModel* body = nullptr);
Evaluation EvaluateAist(const Track& track, const std::string& annotations_folder, const std::string& cameras_folder,
                        const std::string& sequence, const std::string& view, const BodyModel* body = nullptr);

// The published SMPL motion of a recording as a track on a body; that of AIST++ is estimated from all nine cameras.

/// Shape of the body to which the recording's rotations are applied.
enum class PseudoTruthShape {
  /// As published: β = 0, the recording's translations, its cameras scaled to the body's size. Correct only on SMPL's
  /// own template, as the joints of others differ.
  kAsPublished,
  /// One β for the clip and a translation for each frame that minimise the distance of the body's COCO landmarks
  /// L(θ_t, β) to the clip's K_t:  min_{β, τ} 1/T Σ_t Σ_j ‖L_j(θ_t, β) + τ_t − K_tj‖² / σ² + ‖β‖²,  σ = 2 cm. Linear in
  /// β and τ.
  kFitted,
};

struct PseudoTruth {
  Track track;                      ///< camera frame and camera of the view; up = kCamera; joints and coco17 are empty
  double landmark_error_m = 0;      ///< mean distance of its COCO landmarks to the clip's, metres of the recording
  double landmark_error_p95_m = 0;  ///< 95th percentile of frames' means
};

/// Uses the frames that have both motion and landmarks. kAsPublished uses clip.motion_scale. Throws
/// std::invalid_argument when the clip has no motion, its landmarks are not finite in any frame, or the body has fewer
/// joints than the motion or lacks COCO's landmarks.
PseudoTruth MakePseudoTruth(const MultiViewClip& clip, const RigView& view, const BodyModel& body,
                            PseudoTruthShape shape);

}  // namespace bodyloom
