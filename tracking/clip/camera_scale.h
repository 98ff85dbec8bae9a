// SPDX-License-Identifier: Apache-2.0
/// Estimates the metric scale of a moving camera's path from the tracked person: a standing foot does not move.
///
/// Structure from motion gives a path up to scale. The person's stature is known, so the ankles x_f in the camera frame
/// are metric, and in the scene they are y_f(s) = R_fᵀ (x_f − s t_f) = q_f + s c_f, linear in the scale s, with c_f the
/// camera's centre at scale 1. Over the frames of a run in which the lifter predicts that a foot stands, y_f is
/// constant at the true scale:
///   min_s Σ_runs Σ_f ρ(‖W_f (q_f − q̄ + s (c_f − c̄))‖²)      ρ: Geman–McClure, c = 3
/// q̄, c̄: means of the run; W_f: a single camera measures a foot across its view (σ 3 cm) better than along it
/// (σ 12 cm). Each run's own least squares is a start; the start of minimum cost is refined by reweighting. A run
/// counts as one measurement, because the errors of its frames are correlated, and the points of a foot count as one.
///
/// For a camera that follows somebody who walks, standing feet move backwards in the image, and the lifter predicts
/// swinging ones. So in a second estimate one of the points of the two feet stands at any time, whichever it is (while
/// a foot rolls, its ankle moves on, its heel and then its toes stand):
///   min_s Σ_f ρ(min over points of ‖W_f (q_g − q_f + s (c_g − c_f))‖²/2)     g: the first frame 0.2 s after f or later
/// from the s of single points and frames as starts; the last reweightings have c = 1, because neither foot stands
/// during a change of feet, and all such steps bias s in one direction. The result is accepted when it saves a fifth of
/// the cost at s = 0 and its σ is small enough; frames within 0.3 s count as one measurement. Of two results that with
/// the smaller σ/s is returned, the first one where its σ/s is below 0.05.
///
/// Feet roll, and those of recorded motions slide: their mean velocity along the camera's way has σ 5 cm/s (three
/// motions, cameras that go along and round: 0.5 to 8 cm/s, bodyloom_bench_moving_camera). It biases s of a camera that
/// keeps its direction:
///   σ_log = 0.05 ‖mean c'‖ / (s mean ‖c'‖²)     c': the camera's velocity at scale 1; part of the result's σ
///
/// If neither feet nor floor (ScaleByFloor()) tell the scale, the person is taken to stay in one place
/// (ScaleByPlace()).
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "geometry/scene/camera.h"
#include "tracking/camera_motion/points_floor.h"
#include "tracking/initialise/ground_plane.h"

namespace bodyloom {

struct CameraScale {
  bool found = false;
  std::string why;     ///< the evidence used, or the reason why none was found
  double scale_m = 0;  ///< metres a unit of the path
  double sigma_m = 0;  ///< its standard deviation
};

struct CameraScaleOptions {
  double min_contact = 0.35;
  double across_m = 0.03, along_m = 0.12;  ///< σ of an ankle's position across the view and along it
  double min_run_s = 0.1;                  ///< shorter runs do not count
  double max_relative_sigma = 0.35;        ///< a scale with a larger σ, without that of rolling feet, is rejected
  double sure_relative_sigma = 0.05;       ///< of runs of standing feet: the scale is theirs
  double step_s = 0.2;                     ///< between the frames over which one of the feet stands
  double correlation_s = 0.3;              ///< errors of frames nearer than that are correlated
  double min_gain = 0.2;                   ///< share of the cost at s = 0 that a scale from either foot must save
};

/// `points`: ankles, and other points of the feet of the same frames (toes, heels), in the camera frame of their frame;
/// `unit_path`: camera_from_scene at scale 1; `cut_before`: frames at which runs end. All have the same number of
/// frames (checked). σ is without that of the body's size.
CameraScale EstimateCameraScale(std::span<const std::vector<std::array<FootPlace, 2>>> points,
                                std::span<const double> timestamps, const std::vector<char>& cut_before,
                                std::span<const CameraPose> unit_path, const CameraScaleOptions& options = {});

/// The scale for which the person moves least: places p_f in the camera frame, y_f(s) = R_fᵀ p_f + s c_f,
///   min_s Σ_f ‖v_f(s)‖²     v_f: velocity of y over half a second
/// σ² = (mean ‖v_f‖² + (0.25 m/s)²) / (n mean ‖c'‖²), n: seconds of the clip, because velocities of people last for a
/// second. A camera that goes along with somebody who walks has s near 0 and a large σ; above σ/s = 0.35 none is found.
/// Not told from somebody who stays: who walks steadily against the camera's way, and is out of its view soon.
/// `places_m`: one a frame, of the pelvis; the other numbers as above (checked).
CameraScale ScaleByPlace(std::span<const Eigen::Vector3d> places_m, std::span<const double> timestamps,
                         const std::vector<char>& cut_before, std::span<const CameraPose> unit_path);

/// The scale from the person's feet on a floor among the points of the background.
///
/// The camera is u_f units above the floor and, by the lowest point of the feet, m_f = a − up · R_fᵀ x_f metres, a: the
/// point's height on a foot that rests. So s_f = m_f / u_f in every frame in which a foot is down, whether it stands,
/// rolls or slides and whatever the camera does; s is their mode (Geman–McClure, c = 1, σ of a frame 4 %).
///
/// `points` as for EstimateCameraScale(); `heights_m`: of each of them on a foot that rests. Found when four tenths of
/// the frames with a foot, over 0.4 s at least, agree within 10 %. σ holds the floor's and that of the frames, not that
/// of the body's size. Throws std::invalid_argument for numbers that differ.
CameraScale ScaleByFloor(std::span<const std::vector<std::array<FootPlace, 2>>> points,
                         std::span<const double> heights_m, std::span<const double> timestamps,
                         std::span<const CameraPose> unit_path, const PointsFloor& floor);

/// One scale from that of the feet and that of the floor, either of which may not be found: the mean of log s by 1/σ².
/// Its σ also holds that of the body's size, 4 %, an error of both.
CameraScale JoinScales(const CameraScale& feet, const CameraScale& floor);

}  // namespace bodyloom
