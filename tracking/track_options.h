// SPDX-License-Identifier: Apache-2.0
/// Options of TrackSequence().
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bodyloom/tracking/camera_knowledge.h"
#include "bodyloom/tracking/solve_options.h"
#include "bodyloom/tracking/terms/ground_contact/ground_options.h"
#include "bodyloom/tracking/terms/part_labels/part_label_options.h"
#include "bodyloom/tracking/terms/rendered_uv/rendered_uv_options.h"
#include "bodyloom/tracking/terms/user/user_term.h"

namespace bodyloom {

/// Progress of the solve, for a progress bar. Return false from the callback to stop early with what there is.
struct TrackProgress {
  std::string stage;    ///< "initialise", "fit", "refine", …
  double fraction = 0;  ///< of the whole run, estimated, in [0, 1]
  double cost = 0;      ///< of the current stage
};

/// Of the joints' hypotheses without a start (tracking/initialise/joint_hypotheses.h).
struct JointHypothesesOptions {
  double confidence = 0.2;      ///< joints below are not used as positions
  bool hidden_pairs = false;    ///< a shoulder or hip that is not seen is where the other one is: a view from the side
  double frame_rate = 15;       ///< the trellis runs on about this many frames a second
  double angular_speed = 4.0;   ///< rad/s, σ of the torso's turning
  double limb_speed = 2.2;      ///< m/s, σ of a limb's joints relative to the torso
  double density_weight = 0.6;  ///< of the learned limb density
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
  /// on cameras c02, c04, c06 and c09 of the clips of docs/benchmarks.md, whose other cameras are reported there:
  /// weights 0.03 to 0.4 differ by 2 mm.
  double lifter_weight = 0.12, lifter_min_sigma_m = 0.08;
  double prior_weight = 0.2;    ///< of the pose prior's energy, per frame
  double start_pull = 1.0;      ///< pull towards the hypotheses in the first stage (rotation σ 0.2 rad)
  double upright_weight = 1.0;  ///< of the trunk not leaning out of the image plane, per frame
  /// Of knees being straight, 1/rad (terms/straight_knees.h); 0: off. For detectors whose hips lie low on the body, as
  /// BlazePose's do.
  double straight_knees_weight = 0;
  /// λ_t of paper A, of velocities beside accelerations, 1/(m/s)² (residuals/velocity_cost.h); 0: off. It damps motion.
  double velocity_weight = 0;
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
  /// The relative change of the cost at which every stage ends; 0: each stage's own (track_stages.h).
  double function_tolerance = 0;
  std::vector<UserTerm> user_terms;  ///< terms/user/user_term.h; both engines run them
  std::function<bool(const TrackProgress&)> progress;
  /// False with the reason when a field is out of range.
  bool IsValid(std::string* why) const;
};

}  // namespace bodyloom
