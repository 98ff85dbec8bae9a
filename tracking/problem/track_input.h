// SPDX-License-Identifier: Apache-2.0
/// Input of TrackSequence().
#pragma once

#include <optional>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/lifter_weights.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/pose_prior.h"
#include "geometry/scene/track.h"
#include "tracking/problem/camera_knowledge.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

struct HandsAndFaceSequence;
struct LiftedFrame;
struct PictureVertical;

/// Another camera that shows the same person (problem/view_terms.h), with what is known of it. What is not known is
/// estimated with the track, from the values here.
struct ViewInput {
  const KeypointSequence* keypoints = nullptr;                 ///< required; with timestamps of the view's own clock
  CameraKnowledge knowledge = CameraKnowledge::kUnknownFocal;  ///< not kWeak
  /// kKnown: all of it; else width and height (0: taken from the observations), and the focal length to start from (0:
  /// that of the prior).
  Camera camera = {.fx = 0, .fy = 0};
  std::optional<FocalPrior> focal_prior;  ///< without it FocalPrior::ForImage()
  /// Of a focal length that is not known: σ of the logarithm of its ratio to that of the first view, both as shares of
  /// the image's longer side, for cameras of one kind; it takes the prior's place. 0: nothing is known of the ratio.
  double focal_ratio_log_sigma = 0;
  /// From the first view's camera frame; from the scene if that camera moves; to this view's own scene if this moves.
  CameraPose camera_from_scene;
  bool pose_known = false;
  /// Of a view that moves: poses of each of its frames in a scene of its own, metres; null: it stands still.
  const std::vector<CameraPose>* camera_from_own = nullptr;
  /// The view's clock shows t + offset_s + rate (t − middle) when the first view's shows t; middle: of the first view's
  /// clip.
  double offset_s = 0, rate = 0;
  double offset_sigma_s = 0.1;  ///< of the offset, where it is not known
  bool clock_known = false;
  const PictureVertical* picture_vertical = nullptr;  ///< as of TrackSequenceInput, in this camera's axes
};

/// A pose of every frame to start from, which does not enter the cost.
struct TrackStart {
  std::vector<FrameState> states;  ///< T, in the camera frame of each frame
  Eigen::VectorXd betas;           ///< as many as the body has, or fewer
  double focal_px = 0;             ///< of a focal length that is not known; 0: that of the prior
};

/// Observations, models and knowledge given to the tracker. Pointers are borrowed and may be null unless noted.
struct TrackSequenceInput {
  const BodyModel* body = nullptr;              ///< required
  const KeypointSequence* keypoints = nullptr;  ///< 2D joints; this or `dense` is required
  const DenseSequence* dense = nullptr;         ///< dense surface keypoints
  /// Part labels or a mask of each frame. They refine a start but cannot give one: without 2D joints and dense
  /// keypoints an initialiser is required, and weak perspective is not available.
  const PartLabelSequence* part_labels = nullptr;
  /// Hands and face in the frames of the 2D joints. After the solve, hands bend the fingers of a body that has them and
  /// turn its wrists (hands/fit_hands.h), and the face turns its head (hands/turn_head.h); the rest of the track does
  /// not depend on them. Not used by the live tracker.
  const HandsAndFaceSequence* hands_and_face = nullptr;
  const std::vector<ViewInput>* views = nullptr;  ///< other cameras; not with weak perspective nor the live tracker
  const TrackStart* start = nullptr;              ///< from several views, as a rule (rig/track_views.h)
  const Motion* initialiser = nullptr;            ///< camera-frame poses of another system; NaN: none (L_d of paper A)
  const PosePrior* prior = nullptr;               ///< learned pose prior; without it only joint limits apply
  const LifterWeights* lifter = nullptr;  ///< gives the start from 2D joints, and L_d; without it: joint hypotheses
  /// 3D landmarks of every frame, of another lifter or a benchmark, in place of the predictions of `lifter`
  /// (lifter/lift_keypoints.h).
  const std::vector<LiftedFrame>* lifted = nullptr;
  /// The vertical and the ground; without it they are estimated from the clip. It applies to every shot; the live
  /// tracker does not use it.
  const KnownGround* ground = nullptr;
  /// The vertical that straight lines of the picture tell (room/picture_vertical.h), in the scene; with no weak
  /// perspective. It is joined with the lifter's; not used with `ground`, nor by the live tracker. The
  /// focal length that it tells is not used here: join it with `focal_prior` (JoinFocalPrior()).
  const PictureVertical* picture_vertical = nullptr;
  /// The person's stature, metres, which a single camera does not determine: distances are proportional to it. 0: the
  /// mean body's, else 0.4 to 1.6 times that. The live tracker does not use it.
  double stature_m = 0;
  /// T poses of a moving camera (geometry/scene/camera_path.h); null: a static camera. With them the track is in the
  /// scene. Not with weak perspective nor for the live tracker. An initialiser, 3D landmarks and observations remain in
  /// the camera frame of their frame; `ground` is in the scene.
  const std::vector<CameraPose>* camera_from_scene = nullptr;
  /// Metres per unit of these translations; 0: not known, estimated from the person (camera_scale.h).
  double camera_scale_m = 1;
  /// Points of the background in the scene, in the units of these translations; null: none. Their floor tells the scale
  /// where it is sought (camera_motion/points_floor.h).
  const std::vector<Eigen::Vector3d>* background_points = nullptr;
  Camera camera;  ///< kKnown: all of it; otherwise only width and height (0: taken from the observations)
  /// Prior on a focal length that is estimated; without it FocalPrior::ForImage().
  std::optional<FocalPrior> focal_prior;
};

}  // namespace bodyloom
