// SPDX-License-Identifier: Apache-2.0
/// Summary of TrackSequence(): the plan with reasons, the errors of the fit, and the times.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/scene/track.h"
#include "tracking/problem/camera_knowledge.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// One line of the plan: a step or part of the problem, whether it runs, and why.
struct PlanEntry {
  std::string what;
  bool runs = false;
  std::string why;
};

/// Final errors of one term, over all frames.
struct TermSummary {
  std::string term;                  ///< "2D joints", "dense keypoints", "rendered UV", "silhouette", "part labels"
  int observations = 0;              ///< with a weight
  int unmatched = 0;                 ///< that could not be used: hidden, another chart, another part, behind the camera
  double median_px = 0, p95_px = 0;  ///< of |residual|, in pixels
};

/// Final state of Ceres, which by default is the last engine of a track.
struct CeresSummary {
  bool ran = false;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;  ///< initial: after chain
  double gradient_max_norm = 0;             ///< the largest component of the gradient at the end
  double seconds = 0;
};

/// Cost of a term at the solution, ½ Σ ρ of its residuals.
struct TermCost {
  std::string term;  ///< as FrameTerm::name(), or "smoothness", "shape prior", …
  double cost = 0;
};

/// The second of the clip with the worst fit.
struct WorstStretch {
  int begin = 0, end = 0;         ///< frames
  double begin_s = 0, end_s = 0;  ///< times of the first and the last of them
  double cost_ratio = 0;          ///< its cost a frame over that of the whole clip
  std::string term;               ///< the term whose cost there exceeds its mean over the clip by the largest amount
  double term_share = 0;          ///< of the cost there
  /// "3.2 to 4.2 s, at 2.4 times the mean cost: lifter pulls (38 % of it)"
  [[nodiscard]] std::string BriefReport() const;
};

/// A foot that stands still over the frames [begin, end).
struct StandingFoot {
  int foot = 0, begin = 0, end = 0;  ///< foot 0: left
  double seconds = 0;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  ///< on the floor under its ankle, mean of its frames; camera axes
};

/// Estimates of the vertical and the ground.
struct GroundSummary {
  bool has_up = false;
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< world up in the camera frame, mean over the clip
  double up_spread_deg = 0;                        ///< median angle of the frames' own up to it
  bool has_plane = false;
  std::string why;             ///< the evidence, or the reason why there is no ground
  double camera_height_m = 0;  ///< of the camera above the ground
  double height_spread_m = 0;  ///< robust σ of standing feet's heights before the ground held them
  bool given = false;          ///< true if it is TrackSequenceInput::ground
  /// Standard deviations of the vertical and of the camera's height (geometry/scene/world_frame.h); NaN where unknown.
  double up_sigma_deg = std::numeric_limits<double>::quiet_NaN();
  double height_sigma_m = std::numeric_limits<double>::quiet_NaN();
  int contact_frames = 0;  ///< frames in which at least one foot was held
  /// Median speed across the view of ankles that the lifter predicts to stand, m/s, before the ground held them. A
  /// camera that moves although it was given as static makes it large. NaN: none was seen.
  double standing_speed_mps = std::numeric_limits<double>::quiet_NaN();
  std::vector<StandingFoot> stances;  ///< all of the longest shot, on the plane or not, at their solved positions
};

/// The stature that the person's jumps tell (room/flights.h).
struct FlightSummary {
  int flights = 0;       ///< that tell it
  std::string why;       ///< the reason why there are none
  double assumed_m = 0;  ///< stature of the track
  double stature_m = 0, sigma_m = 0;
  /// "4 jumps say that the person is 1.66 m +- 0.08 m tall; 1.75 m was assumed"; empty without flights.
  [[nodiscard]] std::string BriefReport() const;
};

/// Scale of a moving camera's path.
struct CameraPathSummary {
  bool moves = false;      ///< a path was given
  double scale_m = 1;      ///< metres per unit of the path's translations; 0: not known, only its rotations were used
  bool estimated = false;  ///< from the person (camera_scale.h)
  double sigma_m = 0;      ///< standard deviation of an estimated scale
  std::string why;         ///< the evidence of an estimate, or the reason why there is none
};

/// Another camera as it was estimated (ViewInput). Standard deviations are 0 where the value was given and NaN where
/// they are not known.
struct ViewSummary {
  Camera camera;  ///< intrinsics
  CameraPose camera_from_scene;
  double offset_s = 0, rate = 0;
  double rotation_sigma_rad = 0, translation_sigma_m = 0;  ///< one axis
  double focal_log_sigma = 0, offset_sigma_s = 0, rate_sigma = 0;
  /// Offset less offset_s with which the motions agree as well, since the motion repeats itself; NaN: none.
  double repeat_s = std::numeric_limits<double>::quiet_NaN();
  int frames = 0;  ///< of the first view's clip that it shows, too
  double reprojection_median_px = 0;
};

/// A part of the body that is fitted after the rest: a hand's fingers, wrist and forearm's twist, or the head.
struct PartFitSummary {
  bool ran = false;
  std::string why;       ///< the evidence, or the reason why it did not run
  int frames_seen = 0;   ///< in which its points were found
  int iterations = 0;    ///< of Ceres
  double median_px = 0;  ///< of its points' distances from where they were found
  double size = 1;       ///< of the hand seen, relative to the body's
};

/// Longest time from one sight of a person to the next that smoothness can bridge, seconds. In holes of 1.5 s
/// root_sigma grows to 0.5 m for a slow dancer and 1 m for a fast one, and limbs are as wrong as those of another pose
/// (docs/lab/joint_sigma.md).
inline constexpr double kLongestHole_s = 1.5;

struct TrackSequenceSummary {
  SolveStatus status = SolveStatus::kFailure;
  std::string message;
  std::string solver;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;
  std::vector<std::pair<std::string, double>> seconds;         ///< by stage, in order of running
  double seconds_evaluation = 0, seconds_linear_solver = 0;    ///< inside the solves
  std::vector<PlanEntry> plan;                                 ///< what ran and what was skipped
  std::map<std::string, int> frames_by_status;                 ///< "tracked", "weak", "interpolated", "lost"
  double reprojection_median_px = 0, reprojection_p95_px = 0;  ///< of the used 2D joints (confidence > 0.3)
  std::vector<double> frame_px;                                ///< T: median of the same in a frame; NaN: none used
  double dense_median_px = 0;                                  ///< of the dense keypoints, 0 without
  std::vector<TermSummary> terms;                              ///< of every image term that ran
  CeresSummary ceres;
  std::vector<TermCost> costs;                ///< of every term, the largest first; their sum is final_cost
  std::optional<WorstStretch> worst_stretch;  ///< of clips of two seconds and more
  double focal_px = 0;                        ///< used or estimated
  /// The estimate before it was joined with the prior (camera_knowledge.h); none if it was not.
  std::optional<FocalFit> focal_fit;
  /// Standard deviation of log focal_px when it was estimated with uncertainty; 0 when it was known, NaN when the
  /// standard deviation is not known.
  double focal_log_sigma = 0;
  double stature_m = 0;  ///< as given in the input; 0: the mean body's
  int num_observations = 0, num_parameters = 0;
  GroundSummary ground;
  FlightSummary flights;
  CameraPathSummary camera_path;
  std::vector<PartFitSummary> hands;   ///< left and right; empty: no hands and faces were given
  std::optional<PartFitSummary> head;  ///< none: the same
  std::vector<ViewSummary> views;      ///< of TrackSequenceInput::views
  int num_swaps_repaired = 0;          ///< left–right pairs found exchanged in the detections
  int lost_in_holes = 0;               ///< of the lost frames those between two sights of one shot
  [[nodiscard]] bool IsUsable() const { return status != SolveStatus::kFailure; }
  /// "120 tracked, 97 lost (90 in holes of more than 1.5 s)"; empty without frames.
  [[nodiscard]] std::string FramesReport() const;
  /// A few lines for a terminal.
  [[nodiscard]] std::string BriefReport() const;
};

struct TrackSequenceResult {
  Track track;
  TrackSequenceSummary summary;
};

/// Final errors of a term of image residuals; `px` holds |residual| of each observation with a weight, pixels. The
/// errors are 0 without observations.
TermSummary SummarizeTerm(const std::string& term, const std::vector<double>& px, int unmatched = 0);

}  // namespace bodyloom
