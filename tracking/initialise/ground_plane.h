// SPDX-License-Identifier: Apache-2.0
/// Estimates the vertical and the ground plane from one shot of one camera. For a moving camera everything is in the
/// scene (geometry/scene/camera_path.h), and each foot has the camera position from which it was seen.
///
/// The lifter predicts the vertical in every frame; over a shot these directions are one measurement. A foot stands
/// while the lifter predicts contact and the ankle does not move across the view. If there is a ground, the ankles of
/// stances lie in one plane perpendicular to the vertical: it is fitted robustly, with the lifter's vertical as prior
/// and the unknown depth of each stance as an error along its ray. For somebody who jumps all the time, hangs, climbs
/// stairs or is seen from the knees up no ground is found, which is reported.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "geometry/scene/observations.h"
#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/lifter/lifter_reading.h"
#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

struct UpEstimate {
  bool found = false;
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< camera axes, unit
  double spread_deg = 0;                           ///< median angle of the frames' own up to it
};

/// Robust mean (10°) of the frames' up directions, weighted by 1/σ². Not found when no frame is `seen` or the spread
/// exceeds 20°: then the camera turns, or the lifter is uncertain.
UpEstimate EstimateUp(std::span<const LiftedFrame> frames);
/// The same in the scene of a camera that moves, by its pose in each of the frames.
UpEstimate EstimateUp(std::span<const LiftedFrame> frames, std::span<const CameraPose> camera_from_scene);

/// The lifter's up over a shot in one of several views, and that camera's optical axis; in the scene, unit.
struct UpOfView {
  Eigen::Vector3d up, axis;
};
/// The vertical of several views, and its σ per direction across it. Errors of a view have a part along its optical
/// axis, where a single image shows least, that views of one person have in common, and a part of their own:
///   up_v = u + a P axis_v + e_v,   a ~ N(0, kUpAlongRad²),   e_v ~ N(0, kUpAcrossRad² I),   P: across the vertical
/// Least squares about the mean of the views; one view or more.
struct JoinedUps {
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);
  double sigma_rad = 0;
};
JoinedUps JoinUps(std::span<const UpOfView> views);
inline constexpr double kUpAlongRad = 0.08, kUpAcrossRad = 0.04;

inline constexpr double kAnkleHeight = 0.08;  ///< metres above the floor, of the ankle of a foot that stands flat

/// One foot in one frame.
struct FootPlace {
  Eigen::Vector3d ankle_m = Eigen::Vector3d::Zero();   ///< camera frame, or the scene of a camera that moves
  double contact = 0;                                  ///< probability that the foot stands
  bool seen = false;                                   ///< its ankle was detected
  Eigen::Vector3d camera_m = Eigen::Vector3d::Zero();  ///< position of the camera
};

/// A foot that does not move over the frames [begin, end).
struct Stance {
  int foot = 0, begin = 0, end = 0;  ///< foot 0: left
  double seconds = 0;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  ///< of the ankle: mean over its frames; on the ground: held there
  Eigen::Vector3d camera_m = Eigen::Vector3d::Zero();  ///< of the camera: mean over its frames
  /// Viewing direction, unit.
  [[nodiscard]] Eigen::Vector3d Ray() const { return (place_m - camera_m).normalized(); }
};

struct GroundPlaneOptions {
  double min_contact = 0.35;
  double max_speed = 0.4;      ///< m/s, of a standing ankle across the view
  double max_drift_m = 0.06;   ///< of a standing ankle from its mean place so far, across the view
  double min_stance_s = 0.1;   ///< shorter ones do not count
  double min_total_s = 0.4;    ///< of stances on the ground
  double min_share = 0.75;     ///< of the stances' time that must be on the ground
  double height_m = 0.03;      ///< σ of a standing ankle's height: heels rise
  double depth_m = 0.12;       ///< σ of a stance's depth
  double up_rad = 0.06;        ///< σ of the lifter's up over a shot
  double max_spread_m = 0.08;  ///< robust σ of the stances' heights
  double off_ground_m = 0.15;  ///< a stance farther from the plane is not on it
  /// Of a person whom this number of views shows: from two on, the depth is seen.
  static GroundPlaneOptions OfViews(size_t num_views) {
    GroundPlaneOptions options;
    if (num_views < 2) return options;
    options.depth_m = 0.04;
    return options;
  }
};

struct GroundPlane {
  bool found = false;
  std::string why;                                     ///< the evidence, or the reason why none was found
  Eigen::Vector3d normal = Eigen::Vector3d(0, -1, 0);  ///< up, camera axes, unit
  double offset_m = 0;                                 ///< normal · ankle of standing feet
  double spread_m = 0;                                 ///< robust σ of the stances' heights, weighted by time
  /// Standard deviations by the fit's normal equations: of the normal's angle to the true one (root mean square), and
  /// of the offset at the true normal. NaN of a plane that is given.
  double up_sigma_rad = std::numeric_limits<double>::quiet_NaN();
  double offset_sigma_m = std::numeric_limits<double>::quiet_NaN();
  double share = 0;             ///< of the stances' time on the plane
  std::vector<Stance> stances;  ///< on the plane; their places are moved towards it as the σ above weigh them
};

/// Finds the stances of both feet, on any support. `feet` and `timestamps` as below.
std::vector<Stance> FindStances(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                                const GroundPlaneOptions& options);

/// Median speed across the view of ankles that are seen and predicted to stand in two consecutive frames, m/s; NaN with
/// fewer than ten such pairs.
double StandingSpeed(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                     const GroundPlaneOptions& options);

/// Fits the ground plane to the stances. `feet` and `timestamps` (seconds, increasing) have the same number of frames.
/// Throws std::invalid_argument otherwise.
GroundPlane EstimateGroundPlane(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                                const Eigen::Vector3d& up, const GroundPlaneOptions& options);

/// The same for a known plane: ankles of standing feet lie in {x : normal · x = offset_m}. Found when feet stand on it
/// for min_total_s; the stances' positions are moved onto it.
GroundPlane StandOnPlane(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                         const Eigen::Vector3d& normal, double offset_m, const GroundPlaneOptions& options);

/// The feet in each frame of `problem`: ankle positions by the problem's states (for weak perspective at the distance
/// of FrameLayout::BodyPlace), the lifter's contacts, and the camera's position. `frames` are the indices of the
/// problem's frames in the clip, of which `lifted` and `keypoints` hold all frames. A foot is seen if the detector's
/// confidence in its ankle suffices. `left_point`: in place of the ankles, the lifter's points left_point and
/// left_point + 1, which the body must have.
std::vector<std::array<FootPlace, 2>> ObservedFeet(const SequenceProblem& problem, const std::vector<int>& frames,
                                                   const std::vector<LiftedFrame>& lifted,
                                                   const LiftedLandmarks& landmarks, const KeypointSequence& keypoints,
                                                   int left_point = kLifterLeftAnkle);

}  // namespace bodyloom
