// SPDX-License-Identifier: Apache-2.0
/// Options of TrackSequence().
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tracking/problem/camera_knowledge.h"
#include "tracking/problem/user_term.h"

namespace bodyloom {

// Options and report of a solve of a SequenceProblem, common to both engines.

/// The engines: the same problem, the same rules of acceptance and of stopping.
enum class SequenceSolver {
  kCeres,          ///< Ceres with sparse Cholesky (solve_sequence.h)
  kChain,          ///< several times faster on a chain of frames (chain_solver.h)
  kChainThenCeres  ///< chain to near the minimum, and Ceres from there to its own convergence
};
/// "ceres", "chain" or "chain+ceres".
std::string ToString(SequenceSolver solver);
/// The other way; throws std::invalid_argument for another word.
SequenceSolver SequenceSolverFromString(const std::string& word);

enum class SolveStatus { kFailure, kConverged, kMaxIterations, kStopped };
std::string ToString(SolveStatus status);

/// Approximations that the chain engine may use during the descent; Ceres ignores them.
struct ChainOptions {
  /// Until the cost changes by less than a thousandth, frames with more than twice as many dense keypoints use about
  /// this many, evenly chosen and weighted to represent all; then all of them. Convergence is always that of the whole
  /// problem. 0: all from the beginning.
  int early_dense = 0;
  /// Frames whose residuals have moved by less than this share of their size since they were linearised last are not
  /// evaluated again; their linearisation is reused (ChainProblem::ReuseLinearisation). Before the descent may end as
  /// converged all frames are evaluated at the same point and iterations without reuse follow, so the answer is a
  /// minimum of the cost itself. 0: every frame in every iteration.
  double reuse_linearisation = 0;
  /// Frames of small predicted decrease are frozen, and shape and focal length with them, while the others continue
  /// (tracking/solvers/chain_solver.h): at most this share of a step's predicted decrease at a time. Only a step of all
  /// frames may end the descent as converged. A step of a part of the frames counts as that share of an iteration, at
  /// least a quarter. 0: all frames move in every iteration.
  double frozen_share = 0;
  /// Reuses linearisations even when max_iterations end the descent; the final cost may be that of reused ones.
  bool reuse_to_the_end = false;
};

struct SolveOptions {
  SequenceSolver solver = SequenceSolver::kCeres;
  int max_iterations = 50;
  int num_threads = 1;
  double function_tolerance = 1e-5;   ///< stop when |Δcost| is below this share of the cost
  double gradient_tolerance = 1e-9;   ///< … when no component of the gradient is larger
  double parameter_tolerance = 1e-9;  ///< … when the step is below this share of the unknowns' norm
  bool shape_constant = false, focal_constant = false;
  /// A clip of more frames is solved in overlapping windows of this length, with shape and focal length held; 0: never.
  /// Not if users' terms couple frames.
  int max_frames_at_once = 0;
  /// T flags of frames that keep their states, as shape and focal length do then (SolveChain()); empty: none. Only for
  /// the chain engine.
  std::vector<char> held;
  ChainOptions chain;
  /// Called after each iteration with (iteration, cost); false stops.
  std::function<bool(int, double)> on_iteration;
};

/// The tracker's values of these options; linearisations are reused only with dense keypoints.
inline constexpr int kTrackerEarlyDense = 300;
inline constexpr double kTrackerReuse = 0.01, kTrackerFrozenShare = 0.05;

struct SolveReport {
  SolveStatus status = SolveStatus::kFailure;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0, seconds = 0;
  double seconds_evaluation = 0, seconds_linear_solver = 0;  ///< parts of `seconds`
  int64_t frames_evaluated = 0, frames_skipped = 0;          ///< chain: frames × evaluations
  double gradient_max_norm = 0;                              ///< at the end, Ceres
  std::string message;
};

// Options of the vertical and of the ground.

/// A vertical and a ground that are known before a clip is fitted: from a calibration, or from somebody else in the
/// same view (tracking/people).
struct KnownGround {
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< camera axes, unit
  bool has_plane = false;
  double camera_height_m = 0;  ///< of the camera above the plane
  /// Standard deviations of both (geometry/scene/world_frame.h); NaN: not given.
  double up_sigma_deg = std::numeric_limits<double>::quiet_NaN();
  double height_sigma_m = std::numeric_limits<double>::quiet_NaN();
};

/// Estimation of the vertical and of the ground from the clip (initialise/ground_plane.h). Needs the lifter.
struct GroundOptions {
  /// The trunk's lean is measured against the clip's own vertical; false: against the image plane, as if every camera
  /// were level.
  bool use_up = true;
  double contact_weight = 1;     ///< of standing feet on the estimated ground; 0: no ground is estimated
  double sigma_height_m = 0.03;  ///< of a standing ankle's height
  double sigma_slide_m = 0.03;   ///< of its position on the ground while the foot stands
  double surface_weight = 1;     ///< of the surface not being below the ground, and touching it; 0: off
  double hold_weight = 1;        ///< of points of soles that are held where they rest, beside surface_weight; 0: off
  double balance_weight = 1;     ///< of the centre of mass standing above what touches the ground; 0: off
  /// Neither the vertical nor the ground.
  static GroundOptions Off() {
    GroundOptions options;
    options.use_up = false;
    options.contact_weight = options.surface_weight = options.balance_weight = 0;
    return options;
  }
};

// Options of the silhouette and of the part labels.

/// Part labels and silhouettes (part_label_term.h).
struct PartLabelOptions {
  double silhouette_weight = 1;  ///< weight of the contour of all parts together; 0: off
  double part_weight = 1;        ///< weight of each part's contour and pixels; 0: off
  double sigma_share = 0.01;     ///< σ of a contour as a share of the person's height in the image
  /// The same where a mask (AsMask) reaches beyond the body, as clothes and hair do; less than sigma_share counts as
  /// sigma_share, for masks of bare bodies. Found on synthetic dressed people (docs/lab/pose_detector.md).
  double clothes_sigma_share = 0.03;
  double start_kernel = 16, kernel = 4;  ///< c of the robust kernel in σ, in the first and in the last round
  int rounds = 3;                        ///< solves on the coarse frames; correspondences are updated before each
  int max_iterations = 8;                ///< solver iterations of a round

  /// For clips whose 2D joints were derived from the labels: these joints only give a start, and the labels are the
  /// only observations besides the priors. Weights 10 and 30, found on the first half of the real clip of
  /// docs/lab/part_labels.md (1, 3, 10, 30, 100 tried) and confirmed on its second half. With a detector's joints they
  /// are too large: shoulders and hips follow the clothes.
  static PartLabelOptions LabelsAlone() {
    PartLabelOptions options;
    options.silhouette_weight = 10;
    options.rounds = 5;
    options.part_weight = 30;
    return options;
  }
};

// Options of the rendered-UV term.

/// L_r of paper A: where a dense keypoint's pixel shows the chart that the detector predicts, its residual is in UV
/// (rendered_uv_term.h) instead of in the image.
struct RenderedUvOptions {
  double weight = 1;  ///< λ_r; 0: off
  /// Runs only when the keypoints' noise is known to be on the surface (DenseSequence::uv_sigma). For noise of the
  /// pixels, reprojection is the better residual (docs/lab/dense_keypoints.md).
  bool only_with_uv_noise = true;
  int max_points = 1000;    ///< keypoints of a frame with residuals in UV, spread evenly over the parts
  int rounds = 1;           ///< solves on the coarse frames; whitening is refreshed before each
  int max_iterations = 8;   ///< solver iterations of a round
  double min_cosine = 0.5;  ///< between the ray and the surface normal; more grazing pixels are left to reprojection
  /// Cost of an unmatched pixel: true: its reprojection error, which still has a gradient; false: the kernel's
  /// saturation.
  bool unmatched_reproject = true;
};

/// Progress of the solve, for a progress bar. Return false from the callback to stop early with the current result.
struct TrackProgress {
  std::string stage;    ///< "initialise", "fit", "refine", …
  double fraction = 0;  ///< of the whole run, estimated, in [0, 1]
  double cost = 0;      ///< of the current stage
};

/// Options of the joint hypotheses without a start (tracking/initialise/joint_hypotheses.h).
struct JointHypothesesOptions {
  double confidence = 0.2;        ///< joints below are not used as positions
  bool hidden_pairs = false;      ///< in side views, an unseen shoulder or hip is placed at the other one
  double frame_rate = 15;         ///< the trellis runs on about this many frames a second
  double angular_speed = 4.0;     ///< rad/s, σ of the torso's turning
  double limb_speed = 2.2;        ///< m/s, σ of a limb's joints relative to the torso
  double density_weight = 0.6;    ///< of the learned limb density
  double occlusion_weight = 0.5;  ///< of confidence as a depth cue
  double face_weight = 1.0;       ///< of the face's visibility as a heading cue
  double upright_weight = 1.0;    ///< of the trunk being upright in a level camera
};

struct TrackSequenceOptions {
  CameraKnowledge camera_knowledge = CameraKnowledge::kKnown;
  SequenceSolver solver = SequenceSolver::kChainThenCeres;  ///< all engines solve the same problem
  int num_threads = 0;                                      ///< 0: all cores
  int max_iterations = 50;                                  ///< solver iterations of a stage
  int max_fine_iterations = 8;      ///< of chain's stage on all frames, when a coarse one came before
  double initialiser_weight = 0.1;  ///< λ_d of paper A, per frame
  /// λ_d when the lifter is the initialiser (0: it is not used), and a floor of its own uncertainty in metres. Found
  /// on cameras c02, c04, c06 and c09 of the clips of docs/lab/tracking_aist.md, whose other cameras are reported
  /// there: weights 0.03 to 0.4 differ by 2 mm.
  double lifter_weight = 0.12, lifter_min_sigma_m = 0.08;
  double prior_weight = 0.2;    ///< of the pose prior's energy, per frame
  double start_pull = 1.0;      ///< pull towards the hypotheses in the first stage (rotation σ 0.2 rad)
  double upright_weight = 1.0;  ///< of the trunk not leaning out of the image plane, per frame
  /// Weight of straight knees, 1/rad (terms/straight_knees.h); 0: off. For detectors whose hips lie low on the body, as
  /// BlazePose's do.
  double straight_knees_weight = 0;
  /// λ_t of paper A, of velocities beside accelerations, 1/(m/s)² (residuals/acceleration_cost.h); 0: off. It damps
  /// motion.
  double velocity_weight = 0;
  double coarse_rate = 15;          ///< frames a second of the coarse stages
  double shape_prior_weight = 0.3;  ///< of the shape prior, a frame
  bool fit_smoothness = true;       ///< σ of accelerations from the clip's own motion (clip_fit.h)
  JointHypothesesOptions hypotheses;
  RenderedUvOptions rendered_uv;
  PartLabelOptions part_labels;
  GroundOptions ground;
  bool estimate_shape = true;        ///< false: keep the mean shape
  bool estimate_uncertainty = true;  ///< joint_sigma; NaN when off
  /// False: solve also for joints that no landmark moves, and let `chain` use all dense keypoints from the first
  /// iteration on (nearly the same answer).
  bool skip_unneeded = true;
  /// Relative change of the cost at which every stage ends; 0: each stage's own (track_stages.h).
  double function_tolerance = 0;
  std::vector<UserTerm> user_terms;  ///< problem/user_term.h; both engines run them
  std::function<bool(const TrackProgress&)> progress;
  /// False with the reason when a field is out of range.
  bool IsValid(std::string* why) const;
};

}  // namespace bodyloom
