// SPDX-License-Identifier: Apache-2.0
/// Errors of a track in the room: against true joints in a world whose vertical is known.
///
/// X: the track's COCO landmarks in its own world (y up, ground at y = 0), G: the true ones (y up). Landmarks of the
/// face that the truth lacks in more than a tenth of the frames, as an ear that one of two cameras does not see, are
/// left out; then frames in which another landmark of either is not finite. X is first scaled by (sum of the true limb
/// bones' medians) / (sum of the track's): size is not observable with one camera. Y: the yaw, a rotation about y, one
/// for the clip or window.
///   room_g_mpjpe_mm      ‖Y (X − hip X) − (G − hip G)‖, hip: the middle of the hips of each frame. A lean counts,
///                        which a similarity per frame hides
///   room_w_mpjpe_mm      windows of 100 frames, yaw and place fitted on the first two frames
///   room_wa_mpjpe_mm     the same, fitted on the whole window
///   w_mpjpe_100_mm, wa_mpjpe_100_mm   as EMDB defines them: a similarity in place of yaw and place
///   rte_percent          distance of the hips after one rigid motion for the clip / length of the true hips' path
///   tilt_deg             angle between the stated and the true vertical, in the camera frame
///   ankle_height_err_mm, _bias_mm   height of the lower ankle, minus 8 cm, over the stated level of the frame
///                        (Track::level_m), against that of the true lower ankle over the 2nd percentile of its heights
///                        in the frames of that level: mean absolute and median difference
///   knee_err_deg, _bias_deg         flexion between hip, knee and ankle: mean absolute and mean difference
///   trunk_err_deg        angle between the directions from mid-hip to mid-shoulder
///   trunk_lean_bias_deg  mean difference of their angles to the vertical
///   foot_slide_mps       mean horizontal speed of the track's ankles while the true one moves slower than 0.1 m/s
///   bone_ratio (breakdown)          median length / true median length, by bone
/// Sources: Kaufmann et al., "EMDB", ICCV 2023, section 4 (W-MPJPE, WA-MPJPE, RTE).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// A NaN is what could not be measured (no window, no frame in which a foot stands).
struct RoomErrors {
  int frames = 0;  ///< compared
  double g_mpjpe_m, w_mpjpe_m, wa_mpjpe_m;
  double w_mpjpe_100_m, wa_mpjpe_100_m, rte;  ///< rte: a share
  double ankle_height_err_m, ankle_height_bias_m;
  double knee_err_deg, knee_bias_deg;
  double trunk_err_deg, trunk_lean_bias_deg;
  double foot_slide_mps;
  std::vector<std::string> bones;  ///< "left shank", …, "hips"
  std::vector<double> bone_ratio;
};

/// `track`, `truth`: T of 17×3 metres, y up; `timestamps`: T seconds; `levels`: T heights of the track's levels over
/// its ground, or none: all on the ground. Throws std::invalid_argument when sizes disagree.
RoomErrors MeasureRoomErrors(const std::vector<MatrixX3d>& track, const std::vector<MatrixX3d>& truth,
                             const std::vector<double>& timestamps, const std::vector<double>& levels = {});

/// The track's COCO landmarks in its world; a track without one is not scored (empty).
std::vector<MatrixX3d> LandmarksInWorld(const Track& track);

/// Adds the values above. `truth_in_camera`: T of 17×3, in the camera frame of the track; `up_in_camera`: the true
/// vertical there. Adds nothing for a track that states no world.
void AddRoomErrors(const Track& track, const std::vector<MatrixX3d>& truth_in_camera,
                   const Eigen::Vector3d& up_in_camera, const std::vector<double>& timestamps, Evaluation* evaluation);

}  // namespace bodyloom
