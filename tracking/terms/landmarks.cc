// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/landmarks.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

using Eigen::Vector2d;
using Eigen::Vector3d;

void LandmarkTerm::Add(FrameAccumulator* sums) const {
  for (const LandmarkObservation& observation : seen) {
    const Vector3d x = sums->points().Evaluate(sums->kinematics(), *observation.point, sums->derivatives());
    sums->AddPixel(x, observation.pixel, Eigen::Matrix2d::Identity() / observation.sigma_px, kernel, 1,
                   observation.velocity_px_s);
  }
}

ObservedLandmarks FindObservedLandmarks(const BodyModel& model, const KeypointSequence* keypoints, int num_betas) {
  ObservedLandmarks result;
  if (keypoints == nullptr) return result;
  for (int k = 0; k < keypoints->num_points(); ++k) {
    const int index = model.FindLandmark(keypoints->names[k]);
    if (index < 0) continue;
    const Landmark& landmark = model.data().landmarks[index];
    result.names.push_back(landmark.name);
    result.keypoint_column.push_back(k);
    result.points.push_back(CompilePoint(model, landmark.vertices, landmark.weights, num_betas));
  }
  BODYLOOM_CHECK(!result.names.empty(), "track: the body '", model.name(), "' has none of the detections' ",
                 keypoints->num_points(), " landmarks (", keypoints->convention,
                 "); the built-in body and SMPL files have COCO-17, toes and heels");
  return result;
}

double KeypointSigmaPx(double confidence, double height_px) {
  return (0.022 + 0.033 * std::pow(1 - std::clamp(confidence, 0.0, 1.0), 1.5)) * height_px;
}

std::vector<LandmarkObservation> ObserveLandmarks(const ObservedLandmarks& landmarks, const KeypointSequence& keypoints,
                                                  int t, double height_px, double sigma_factor) {
  std::vector<LandmarkObservation> result;
  for (size_t i = 0; i < landmarks.names.size(); ++i) {
    const Keypoint& point = keypoints.at(t, landmarks.keypoint_column[i]);
    if (!(point.confidence >= kMinConfidence) || !std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    result.push_back(
        {&landmarks.points[i], {point.x, point.y}, sigma_factor * KeypointSigmaPx(point.confidence, height_px)});
  }
  return result;
}

void AppendLandmarkErrors(const ObservedLandmarks& landmarks, const KeypointSequence& keypoints, int t,
                          const Camera& camera, const Kinematics& kinematics, std::vector<double>* errors_px) {
  PointEvaluator points;
  Vector2d pixel;
  for (size_t i = 0; i < landmarks.names.size(); ++i) {
    const Keypoint& seen = keypoints.at(t, landmarks.keypoint_column[i]);
    if (!(seen.confidence > 0.3F)) continue;
    if (camera.Project(points.Evaluate(kinematics, landmarks.points[i], false), &pixel)) {
      errors_px->push_back((pixel - Vector2d(seen.x, seen.y)).norm());
    }
  }
}

std::vector<PlanEntry> PlanLandmarks(const TrackSequenceInput& input, const TrackSequenceOptions& /*options*/) {
  if (input.keypoints == nullptr) return {{"2D joints (L_f)", false, "no 2D joints in the input"}};
  const size_t known = FindObservedLandmarks(*input.body, input.keypoints, 0).names.size();
  return {{"2D joints (L_f)", true, std::to_string(known) + " landmarks"}};
}

std::unique_ptr<ClipTerm> MakeLandmarkTerms(const ClipTermInput& clip) {
  if (clip.input.keypoints == nullptr) return nullptr;
  return EachFrame([clip](int t, const FrameState& state, FrameData* frame) {
    const double height_px = UprightHeightPx(clip.layout, state, clip.stature_m);
    const bool several = clip.input.views != nullptr && !clip.input.views->empty();
    frame->Get<LandmarkTerm>().seen =
        ObserveLandmarks(clip.landmarks, *clip.input.keypoints, t, height_px, several ? kSeveralViewsSigma : 1);
  });
}

}  // namespace bodyloom
