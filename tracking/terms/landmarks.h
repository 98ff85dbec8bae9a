// SPDX-License-Identifier: Apache-2.0
/// 2D joints, L_f of paper A: the reprojection error of the body's landmarks.
///   ½ Σ_k ρ(‖(π(x_k) − y_k)/σ_k‖²)        ρ: Geman–McClure with c = `kernel` (robust.h)
/// x_k: the landmark in the camera frame, metres; π(x_k), y_k, σ_k: pixels. A landmark that cannot be projected costs
/// c²/2 and is counted. σ_k increases with the person's height in the image and decreases with confidence
/// (KeypointSigmaPx()). The kernel is wide in the first stage (c = 8) and narrow in the others (4), since errors of a
/// start exceed those of a detector.
/// Derivatives: ∂π/∂x of the camera, ∂x/∂θ of body_points.h. Runs when the input has 2D joints.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

class ClipTerm;
struct ClipTermInput;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

/// A 2D joint: the compiled landmark, its detected position and the σ of that.
struct LandmarkObservation {
  const CompiledPoint* point = nullptr;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1;
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();  ///< of the detected position, for the clocks of other views
};

class LandmarkTerm : public CopyableTerm<LandmarkTerm> {
 public:
  std::vector<LandmarkObservation> seen;
  double kernel = 8;  ///< c, in σ

  [[nodiscard]] std::string name() const override { return "2D joints"; }
  [[nodiscard]] int num_rows() const override { return static_cast<int>(2 * seen.size()); }
  void Add(FrameAccumulator* sums) const override;
  void BeginStage(const StageSettings& settings) override { kernel = settings.landmark_kernel; }
};

/// Landmarks that both the body and the detections have.
struct ObservedLandmarks {
  std::vector<std::string> names;
  std::vector<int> keypoint_column;  ///< in the KeypointSequence
  std::vector<CompiledPoint> points;
};

/// Empty when `keypoints` is null. Throws std::invalid_argument when the body has none of the detections' landmarks.
ObservedLandmarks FindObservedLandmarks(const BodyModel& model, const KeypointSequence* keypoints, int num_betas);

/// σ of a 2D joint in pixels, for a person `height_px` tall in the image: (0.022 + 0.033 (1 − confidence)^1.5) of it.
/// It is larger than the detectors' white noise because their errors are correlated over a third of a second.
double KeypointSigmaPx(double confidence, double height_px);
/// Factor of σ where several views show the person. A single view's σ is large because its errors move what that view
/// does not see, the depth of limbs; with a second view the depth is seen. Found on AIST++ (docs/lab/two_views.md).
inline constexpr double kSeveralViewsSigma = 0.5;

/// The usable 2D joints of frame t, with σ times `sigma_factor`.
std::vector<LandmarkObservation> ObserveLandmarks(const ObservedLandmarks& landmarks, const KeypointSequence& keypoints,
                                                  int t, double height_px, double sigma_factor = 1);

/// Detections below this confidence are ignored by the solver.
inline constexpr double kMinConfidence = 0.1;

/// Appends |π(x) − y|, pixels, of frame t's landmarks with a confidence above 0.3.
void AppendLandmarkErrors(const ObservedLandmarks& landmarks, const KeypointSequence& keypoints, int t,
                          const Camera& camera, const Kinematics& kinematics, std::vector<double>* errors_px);

std::vector<PlanEntry> PlanLandmarks(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeLandmarkTerms(const ClipTermInput& clip);

}  // namespace bodyloom
