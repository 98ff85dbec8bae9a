// SPDX-License-Identifier: Apache-2.0
/// Fits one body to a clip: what was seen in one camera → a pose in every frame, one shape, and the camera.
/// How it works: docs/tracking.md.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/geometry/lifter_weights.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/geometry/pose_prior.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/tracking/initialise/joint_hypotheses.h"

namespace bodyloom {

struct LiftedFrame;

/// What is known about the camera's intrinsics.
enum class CameraKnowledge {
  kKnown,         ///< TrackSequenceInput::camera is used as it is
  kUnknownFocal,  ///< pinhole, square pixels, centred principal point, focal length estimated with the clip
  kWeak,          ///< weak perspective: scale and image offset per frame (the camera of paper A)
};

/// Everything the tracker may look at. Pointers are borrowed and may be null unless noted.
struct TrackSequenceInput {
  const BodyModel* body = nullptr;              ///< required
  const KeypointSequence* keypoints = nullptr;  ///< 2D joints; this or `dense` is required
  const DenseSequence* dense = nullptr;         ///< dense surface keypoints
  /// Part labels or a mask of each frame. They refine a start and do not find one: without 2D joints and dense
  /// keypoints an initialiser is required, and weak perspective is not available.
  const PartLabelSequence* part_labels = nullptr;
  const Motion* initialiser = nullptr;    ///< camera-frame poses of another system, same frames (L_d of paper A)
  const PosePrior* prior = nullptr;       ///< learned pose prior; without it only joint limits apply
  const LifterWeights* lifter = nullptr;  ///< starts from 2D joints and stays as L_d; without it: joint hypotheses
  /// 3D landmarks of every frame that take the place of what `lifter` would say of the 2D joints (initialise/
  /// lift_keypoints.h): another lifter's, or a benchmark's.
  const std::vector<LiftedFrame>* lifted = nullptr;
  Camera camera;  ///< kKnown: all of it; otherwise only width and height (0: taken from the observations)
};

/// Progress of the solve, for a progress bar. Return false from the callback to stop early with what there is.
struct TrackProgress {
  std::string stage;    ///< "initialise", "fit", "refine", …
  double fraction = 0;  ///< of the whole run, estimated, in [0, 1]
  double cost = 0;      ///< of the current stage
};

/// L_r of paper A: where a dense keypoint's pixel sees the chart that the detector named, its residual is taken in UV
/// (residuals/rendered_uv.h) instead of in the image.
struct RenderedUvOptions {
  double weight = 1;  ///< λ_r; 0: off
  /// Run only when the keypoints' noise is known to lie on the surface (DenseSequence::uv_sigma). Where it lies in the
  /// pixels instead, reprojection is the better residual (docs/benchmarks.md).
  bool only_with_uv_noise = true;
  int max_points = 1000;    ///< keypoints of a frame that are taken in UV, spread evenly over the parts
  int rounds = 1;           ///< solves on the coarse frames; whitening is refreshed before each
  int max_iterations = 8;   ///< of each round
  double min_cosine = 0.5;  ///< between the ray and the surface normal; more grazing pixels are left to reprojection
  /// What an unmatched pixel costs: true: its reprojection error, so that it still pulls; false: the kernel's
  /// saturation.
  bool unmatched_reproject = true;
};

/// Part labels and silhouettes (residuals/part_label_term.h).
struct PartLabelOptions {
  double silhouette_weight = 1;          ///< of the outline of all parts together; 0: off
  double part_weight = 1;                ///< of each part's outline and pixels; 0: off
  double sigma_share = 0.01;             ///< σ of an outline as a share of the person's height in the image
  double start_kernel = 16, kernel = 4;  ///< c of the robust kernel in σ, in the first and in the last round
  int rounds = 5;          ///< solves on the coarse frames; what corresponds to what is found anew before each
  int max_iterations = 8;  ///< of each round

  /// For clips whose 2D joints were read off the labels themselves: they add nothing to the labels but a start, and the
  /// labels are all there is against the priors. Weights 10 and 30, found on the first half of the real clip of
  /// docs/benchmarks.md (1, 3, 10, 30, 100 tried) and confirmed on its second half. Beside a detector's joints they
  /// are too much: shoulders and hips follow the clothes.
  static PartLabelOptions LabelsAlone() {
    PartLabelOptions options;
    options.silhouette_weight = 10;
    options.part_weight = 30;
    return options;
  }
};

/// Which way is up, and the ground that feet stand on, read off the clip (initialise/ground_plane.h). Needs the lifter.
struct GroundOptions {
  /// The trunk's lean is measured against the clip's own vertical; false: against the image plane, as if every camera
  /// were level.
  bool use_up = true;
  double contact_weight = 1;     ///< of feet that stand, on the ground that was found; 0: no ground is looked for
  double sigma_height_m = 0.03;  ///< of a standing ankle's height
  double sigma_slide_m = 0.03;   ///< of its place on the ground while the foot stands
  /// Neither the vertical nor the ground.
  static GroundOptions Off() {
    GroundOptions options;
    options.use_up = false;
    options.contact_weight = 0;
    return options;
  }
};

struct TrackSequenceOptions {
  CameraKnowledge camera_knowledge = CameraKnowledge::kKnown;
  std::string solver = "chain";     ///< the engine: "chain" (chain_solver.h) or "ceres" (reference): same problem
  int num_threads = 0;              ///< 0: all cores
  int max_iterations = 50;          ///< of each stage
  int max_fine_iterations = 8;      ///< of the last stage, when a coarse one came before
  double initialiser_weight = 0.1;  ///< λ_d of paper A, per frame
  /// λ_d when the lifter is the initialiser (0: it is not asked), and a floor of its own uncertainty in metres. Found
  /// on cameras c02, c04, c06 and c09 of the clips of docs/benchmarks.md, whose other cameras are reported there:
  /// weights 0.03 to 0.4 differ by 2 mm.
  double lifter_weight = 0.12, lifter_min_sigma_m = 0.08;
  double prior_weight = 0.2;        ///< of the pose prior's energy, per frame
  double start_pull = 1.0;          ///< pull towards the hypotheses in the first stage (rotation σ 0.2 rad)
  double upright_weight = 1.0;      ///< of the trunk not leaning out of the image plane, per frame
  double coarse_rate = 15;          ///< frames a second of the coarse stages
  double shape_prior_weight = 0.3;  ///< of the shape prior, a frame
  bool fit_smoothness = true;       ///< σ of accelerations from the clip's own motion (motion_level.h)
  JointHypothesesOptions hypotheses;
  RenderedUvOptions rendered_uv;
  PartLabelOptions part_labels;
  GroundOptions ground;
  bool estimate_shape = true;        ///< false: keep the mean shape
  bool estimate_uncertainty = true;  ///< joint_sigma; NaN when off
  /// False: solve also for joints that no landmark moves, and let `chain` use all dense keypoints from the first
  /// iteration on (nearly the same answer).
  bool skip_unneeded = true;
  std::function<bool(const TrackProgress&)> progress;
  /// False with the reason when a field is out of range.
  bool IsValid(std::string* why) const;
};

/// One line of the plan: a step or part of the problem, whether it runs, and why.
struct PlanEntry {
  std::string what;
  bool runs = false;
  std::string why;
};

/// How well one term fits at the end, over all frames.
struct TermSummary {
  std::string term;                  ///< "2D joints", "dense keypoints", "rendered UV", "silhouette", "part labels"
  int observations = 0;              ///< that had a say
  int unmatched = 0;                 ///< that could not be used: hidden, another chart, another part, behind the camera
  double median_px = 0, p95_px = 0;  ///< of |residual|, in pixels
};

/// What the clip showed of the vertical and the ground.
struct GroundSummary {
  bool has_up = false;
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< world up in the camera frame, mean over the clip
  double up_spread_deg = 0;                        ///< median angle of the frames' own up to it
  bool has_plane = false;
  std::string why;             ///< what was found, or why there is no ground
  double camera_height_m = 0;  ///< of the camera above the ground
  double height_spread_m = 0;  ///< robust σ of standing feet's heights before the ground held them
  int contact_frames = 0;      ///< frames in which at least one foot was held
};

enum class SolveStatus { kFailure, kConverged, kMaxIterations, kStopped };
std::string ToString(SolveStatus status);

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
  double dense_median_px = 0;                                  ///< of the dense keypoints, 0 without
  std::vector<TermSummary> terms;                              ///< of every image term that ran
  double focal_px = 0;                                         ///< used or estimated
  int num_observations = 0, num_parameters = 0;
  GroundSummary ground;
  int num_swaps_repaired = 0;  ///< left–right pairs found exchanged in the detections
  [[nodiscard]] bool IsUsable() const { return status != SolveStatus::kFailure; }
  /// A few lines for a terminal.
  [[nodiscard]] std::string BriefReport() const;
};

struct TrackSequenceResult {
  Track track;
  TrackSequenceSummary summary;
};

/// What TrackSequence would do with this input: no computation.
std::vector<PlanEntry> PlanTrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options);

/// Throws std::invalid_argument when the input contradicts itself (no body, no observations, sizes that differ, image
/// size against camera); a clip in which nothing can be estimated gives status kFailure with a message.
TrackSequenceResult TrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options);

}  // namespace bodyloom
