// SPDX-License-Identifier: Apache-2.0
/// The held-out-camera protocol on AIST++: fit one of nine cameras, score in the other eight and against the 3D joints.
#pragma once

#include <string>

#include "bodyloom/data_tools/evaluation/evaluation.h"
#include "bodyloom/data_tools/evaluation/held_out_views.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Reads a clip of AIST++: keypoints2d/<sequence>.pkl of all views, keypoints3d_optim, motions/<sequence>.pkl when it
/// is there (SMPL poses; betas are zero, translation = smpl_trans / smpl_scaling), and the cameras of its setting.
/// Metres; 60 frames a second. Throws std::runtime_error naming the file that cannot be used.
MultiViewClip ReadAistClip(const std::string& annotations_folder, const std::string& cameras_folder,
                           const std::string& sequence);

/// Protocol "aist-held-out": EvaluateHeldOutViews on that clip. `view` is the camera the track was fitted to ("c01").
/// With the body that the track was made with, also the per-vertex projection error of paper A, Table 4, against the
/// recording's own SMPL motion on that body (pseudo_truth.h: as published on a body of SMPL's 6,890 vertices, fitted to
/// the 3D joints on any other).
Evaluation EvaluateAist(const Track& track, const MultiViewClip& clip, const std::string& view,
                        const BodyModel* body = nullptr);
Evaluation EvaluateAist(const Track& track, const std::string& annotations_folder, const std::string& cameras_folder,
                        const std::string& sequence, const std::string& view, const BodyModel* body = nullptr);

}  // namespace bodyloom
