// SPDX-License-Identifier: Apache-2.0
/// Options of a live tracker, its input (constant, and per frame) and its results.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/lifter_weights.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/pose_prior.h"
#include "geometry/scene/track.h"
#include "tracking/problem/camera_knowledge.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

struct LiveTrackerOptions {
  int lag = 4;               ///< frames: Push() of frame t returns frame t − lag. 0 to 60
  int context = 4;           ///< frames before those that stay in the window; at least 2
  int iterations = 2;        ///< solver iterations a frame
  int start_iterations = 8;  ///< the same for the first lag + 1 frames of a shot
  int max_dense = 600;       ///< dense keypoints of a frame; of more, about this many are chosen to represent all
  double lost_after_s = 1;   ///< without any observation the person is lost
  /// Frames whose 2D joints jump away from the person count as not seen until they come back. After this duration they
  /// are a cut, at the first of them that has not been returned. 0: a cut at once.
  double max_jump_s = 0.15;
  double reuse_linearisation = 0.1;  ///< ChainOptions::reuse_linearisation
  /// Camera knowledge, weights, threads, estimate_shape, skip_unneeded and estimate_uncertainty mean what they mean for
  /// TrackSequence(). Windows are solved by the chain engine, and users' terms are of one frame.
  TrackSequenceOptions solve;
  /// False with the reason when a field is out of range.
  bool IsValid(std::string* why) const;
};

/// Input that is constant over the frames. Pointers are borrowed; those that may be null are marked.
struct LiveTrackerInput {
  const BodyModel* body = nullptr;
  const PosePrior* prior = nullptr;       ///< or null
  const LifterWeights* lifter = nullptr;  ///< or null: starts by joint hypotheses
  Camera camera;                          ///< known: all of it; otherwise only width and height
  std::optional<FocalPrior> focal_prior;  ///< as TrackSequenceInput::focal_prior
  std::vector<std::string> landmarks;     ///< names of the 2D joints of each frame; may be empty when dense
  bool dense = false;                     ///< dense keypoints may come
};

/// Observations of one frame. Missing values and values that are not finite count as not seen.
struct LiveObservations {
  double timestamp = 0;             ///< seconds, larger than the frame's before
  std::vector<Keypoint> keypoints;  ///< one a landmark, or none
  std::vector<DenseKeypoint> dense;
  std::optional<BodyPose> initialiser;  ///< of another system, camera frame: start and L_d of paper A
};

struct LiveFrame {
  int64_t index = 0;  ///< of the Push() that brought it
  double timestamp = 0;
  FrameStatus status = FrameStatus::kLost;
  bool cut_before = false;  ///< does not continue the frame before
  FrameState state;         ///< NaN when lost
  Eigen::VectorXd betas;    ///< as known when the frame is returned
  Camera camera;            ///< of the frame, with the focal length as known then
  /// J standard deviations of the joints' positions about the middle of the hips, metres (uncertainty.h), as known
  /// then; NaN when lost, or without TrackSequenceOptions::estimate_uncertainty.
  Eigen::VectorXd joint_sigma;
  double root_sigma = std::numeric_limits<double>::quiet_NaN();  ///< that of this middle's own position
  /// The lifter's reading of the frame on its vertical and its standing feet (LiftedFrame).
  struct Standing {
    Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);
    double up_sigma = 1;
    Eigen::Vector2d contact = Eigen::Vector2d::Zero();
  };
  std::optional<Standing> standing;  ///< none where the lifter did not run
};

}  // namespace bodyloom
