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
#include "tracking/problem/track_options.h"

namespace bodyloom {

struct LiftedFrame;

/// Everything the tracker may look at. Pointers are borrowed and may be null unless noted.
struct TrackSequenceInput {
  const BodyModel* body = nullptr;              ///< required
  const KeypointSequence* keypoints = nullptr;  ///< 2D joints; this or `dense` is required
  const DenseSequence* dense = nullptr;         ///< dense surface keypoints
  /// Part labels or a mask of each frame. They refine a start and do not find one: without 2D joints and dense
  /// keypoints an initialiser is required, and weak perspective is not available.
  const PartLabelSequence* part_labels = nullptr;
  const Motion* initialiser = nullptr;    ///< camera-frame poses of another system; NaN: none (L_d of paper A)
  const PosePrior* prior = nullptr;       ///< learned pose prior; without it only joint limits apply
  const LifterWeights* lifter = nullptr;  ///< starts from 2D joints and stays as L_d; without it: joint hypotheses
  /// 3D landmarks of every frame that take the place of what `lifter` would predict from the 2D joints (initialise/
  /// lift_keypoints.h): another lifter's, or a benchmark's.
  const std::vector<LiftedFrame>* lifted = nullptr;
  /// The vertical and the ground; without it they are looked for in the clip. It holds for every shot; the live
  /// tracker does not use it.
  const KnownGround* ground = nullptr;
  /// The person's stature, metres, which one camera does not see: distances follow it. 0: the mean body's, else 0.4 to
  /// 1.6 times that. The live tracker does not use it.
  double stature_m = 0;
  /// Where the camera is in every frame when it moves (geometry/scene/camera_path.h), T of them; null: it stands still.
  /// The track is then in the scene. Not with weak perspective, own terms, nor for the live tracker. An initialiser, 3D
  /// landmarks and observations are in the camera frame of their frame as ever; `ground` is in the scene.
  const std::vector<CameraPose>* camera_from_scene = nullptr;
  /// How many metres a unit of these translations is; 0: not known, found from the person (camera_scale.h).
  double camera_scale_m = 1;
  Camera camera;  ///< kKnown: all of it; otherwise only width and height (0: taken from the observations)
  /// What is known of a focal length that is estimated; nothing: FocalPrior::ForImage().
  std::optional<FocalPrior> focal_prior;
};

}  // namespace bodyloom
