// SPDX-License-Identifier: Apache-2.0
/// How many metres a unit of a camera's path is, from the person that it saw: a foot that stands does not move.
///
/// Structure from motion gives a path without a length. The person has one (their stature), so their ankles x_f in the
/// camera frame are metric, and in the scene they are y_f(s) = R_fᵀ (x_f − s t_f) = q_f + s c_f, linear in the scale s,
/// with c_f the camera's centre at scale 1. Over the frames of a run in which the lifter calls a foot standing, y_f
/// keeps its place at the right scale:
///   min_s Σ_runs Σ_f ρ(‖W_f (q_f − q̄ + s (c_f − c̄))‖²)      ρ: Geman–McClure, c = 3
/// q̄, c̄: means of the run; W_f: one camera sees a foot across its view (σ 3 cm) better than along it (σ 12 cm). Each
/// run's own least squares is a start; the one of the least cost is refined by reweighting. A run counts as one
/// measurement, because its frames err together.
///
/// Where that does not tell (beside somebody who walks, standing feet move backwards in the picture, and the lifter
/// takes them for swinging ones), one of two feet is taken to stand at any time, whichever it is:
///   min_s Σ_f ρ(min over feet of ‖W_f (q_g − q_f + s (c_g − c_f))‖²/2)      g: the first frame 0.2 s after f or later
/// from the s of single feet and frames as starts; the last reweightings have c = 1, because while feet change neither
/// stands, and all such steps err to one side. It counts when it saves a fifth of the cost that the feet have at s = 0,
/// and is known well enough; frames within 0.3 s count as one measurement.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "geometry/scene/camera.h"
#include "tracking/initialise/ground_plane.h"

namespace bodyloom {

struct CameraScale {
  bool found = false;
  std::string why;     ///< what it was found from, or why it was not
  double scale_m = 0;  ///< metres a unit of the path
  double sigma_m = 0;  ///< its standard deviation
};

struct CameraScaleOptions {
  double min_contact = 0.35;
  double across_m = 0.03, along_m = 0.12;  ///< σ of an ankle's place across the view and along it
  double min_run_s = 0.1;                  ///< shorter runs do not count
  double max_relative_sigma = 0.35;        ///< a scale that is known less well is not
  double step_s = 0.2;                     ///< between the frames over which one of the feet stands
  double correlation_s = 0.3;              ///< frames that are nearer than that err together
  double least_gain = 0.2;                 ///< of the cost without a length, which a scale from unnamed feet must save
};

/// `feet`: ankles in the camera frame of their frame; `unit_path`: camera_from_scene at scale 1; `cut_before`: frames
/// that continue no run. All have the same number of frames (checked).
CameraScale EstimateCameraScale(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                                const std::vector<char>& cut_before, std::span<const CameraPose> unit_path,
                                const CameraScaleOptions& options = {});

}  // namespace bodyloom
