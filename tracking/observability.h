// SPDX-License-Identifier: Apache-2.0
/// Which landmarks of the body the detections show, which joints they can tell anything about, and how precise they
/// are.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/tracking/body_points.h"
#include "bodyloom/tracking/frame_cost.h"

namespace bodyloom {

/// Landmarks that both the body and the detections have.
struct ObservedLandmarks {
  std::vector<std::string> names;
  std::vector<int> keypoint_column;  ///< in the KeypointSequence
  std::vector<CompiledPoint> points;
};

/// Empty when `keypoints` is null. Throws std::invalid_argument when the body has none of the detections' landmarks.
ObservedLandmarks FindObservedLandmarks(const BodyModel& model, const KeypointSequence* keypoints, int num_betas);

/// Joints worth estimating. With dense keypoints: all. With 2D joints only: those that move some observed landmark by
/// at least 4 cm a radian in the rest pose; the others (wrists, hands, feet without toe detections) only carry the
/// prior, and holding them at rest changes nothing that was observed by more than that lever. `skip` false: all joints.
std::vector<int> FindActiveJoints(const BodyModel& model, const ObservedLandmarks& landmarks, bool dense, bool skip);

/// σ of a 2D joint in pixels, for a person `height_px` tall in the image: (0.022 + 0.033 (1 − confidence)^1.5) of it.
/// It is larger than the detectors' white noise because their errors are correlated over a third of a second.
double KeypointSigmaPx(double confidence, double height_px);

/// The usable 2D joints of frame t.
std::vector<LandmarkObservation> ObserveLandmarks(const ObservedLandmarks& landmarks, const KeypointSequence& keypoints,
                                                  int t, double height_px);

/// Detections below this confidence are ignored by the solver.
inline constexpr double kMinConfidence = 0.1;

}  // namespace bodyloom
