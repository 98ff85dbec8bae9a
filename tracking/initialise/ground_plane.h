// SPDX-License-Identifier: Apache-2.0
/// The ground plane, and which way is up, from one shot of one camera. Where it moves, everything is in the scene
/// (geometry/scene/camera_path.h), and each foot says from where it was seen.
///
/// The lifter predicts where up is in every frame; over a shot these directions are one measurement. A foot stands
/// while the lifter calls it so and its ankle keeps its place across the view. Ankles of stances lie in one plane
/// across up if there is a ground: it is fitted to them with the lifter's up as prior, robustly, allowing for what a
/// single camera does not know: the depth of each stance. Somebody who jumps all the time, hangs, climbs stairs or is
/// seen from the knees up has no ground, which is reported.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "geometry/scene/observations.h"
#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/lifter/lifter_reading.h"
#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

struct UpEstimate {
  bool found = false;
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< camera axes, unit
  double spread_deg = 0;                           ///< median angle of the frames' own up to it
};

/// Mean direction of the frames' ups, weighted by 1/σ² and robustly (10°). Not found when no frame is `seen` or the
/// spread exceeds 20°: then the camera turns, or the lifter does not know.
UpEstimate EstimateUp(std::span<const LiftedFrame> frames);

inline constexpr double kAnkleHeight = 0.08;  ///< metres above the floor, of the ankle of a foot that stands flat

/// One foot in one frame.
struct FootPlace {
  Eigen::Vector3d ankle_m = Eigen::Vector3d::Zero();   ///< camera frame, or the scene of a camera that moves
  double contact = 0;                                  ///< probability that the foot stands
  bool seen = false;                                   ///< its ankle was detected
  Eigen::Vector3d camera_m = Eigen::Vector3d::Zero();  ///< where the camera was
};

/// A foot that stays where it is over the frames [begin, end).
struct Stance {
  int foot = 0, begin = 0, end = 0;  ///< foot 0: left
  double seconds = 0;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  ///< of the ankle: mean over its frames; on the ground: held there
  Eigen::Vector3d camera_m = Eigen::Vector3d::Zero();  ///< of the camera: mean over its frames
  /// The direction in which it was seen, unit.
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
};

struct GroundPlane {
  bool found = false;
  std::string why;                                     ///< what was found, or why nothing
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

/// Where feet stand, on whatever. `feet` and `timestamps` as below.
std::vector<Stance> FindStances(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                                const GroundPlaneOptions& options);

/// Median speed across the view of ankles that are seen and called standing in two frames that follow each other, m/s;
/// NaN when there are fewer than ten such pairs.
double StandingSpeed(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                     const GroundPlaneOptions& options);

/// `feet` and `timestamps` (seconds, increasing) have the same number of frames. Throws std::invalid_argument
/// otherwise.
GroundPlane EstimateGroundPlane(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                                const Eigen::Vector3d& up, const GroundPlaneOptions& options);

/// The same for a plane that is known: {x : normal · x = offset_m} is where ankles of standing feet are. Found when
/// feet stand on it for min_total_s; places are moved onto it.
GroundPlane StandOnPlane(const std::vector<std::array<FootPlace, 2>>& feet, std::span<const double> timestamps,
                         const Eigen::Vector3d& normal, double offset_m, const GroundPlaneOptions& options);

// Where a person's ankles are in the frames of a clip, and what the lifter says of the feet.

/// Of each frame of `problem`, which are `frames` of the clip that `lifted` and `keypoints` hold all frames of: both
/// ankles where the problem's states have them (for weak perspective as far away as FrameLayout::BodyPlace), and where
/// the camera was. A foot is seen where the detector is sure of its ankle.
std::vector<std::array<FootPlace, 2>> SeenFeet(const SequenceProblem& problem, const std::vector<int>& frames,
                                               const std::vector<LiftedFrame>& lifted, const LiftedLandmarks& landmarks,
                                               const KeypointSequence& keypoints);

}  // namespace bodyloom
