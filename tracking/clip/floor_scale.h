// SPDX-License-Identifier: Apache-2.0
/// Metric scale of a moving camera's path from the person's feet on a floor among the points of the background.
///
/// The camera is u_f units above the floor (PointsFloor) and, by the lowest point of the feet, m_f = a − up · R_fᵀ x_f
/// metres, a: the point's height on a foot that rests. So s_f = m_f / u_f in every frame in which a foot is down,
/// whether it stands, rolls or slides and whatever the camera does; s is their mode (Geman–McClure, c = 1, σ of a frame
/// 4 %).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/scene/camera.h"
#include "tracking/camera_motion/points_floor.h"
#include "tracking/clip/camera_scale.h"
#include "tracking/initialise/ground_plane.h"

namespace bodyloom {

/// `points` as for EstimateCameraScale(); `heights_m`: of each of them on a foot that rests. Found when four tenths of
/// the frames with a foot, over 0.4 s at least, agree within 10 %. σ holds the floor's and that of the frames, not that
/// of the body's size. Throws std::invalid_argument for numbers that differ.
CameraScale ScaleByFloor(std::span<const std::vector<std::array<FootPlace, 2>>> points,
                         std::span<const double> heights_m, std::span<const double> timestamps,
                         std::span<const CameraPose> unit_path, const PointsFloor& floor);

}  // namespace bodyloom
