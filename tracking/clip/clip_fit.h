// SPDX-License-Identifier: Apache-2.0
/// The fit of a clip, one run of FitClip(): the clip's problem with all that its terms point to, and the steps
/// that solve it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geometry/base/stopwatch.h"
#include "tracking/clip/track_stages.h"
#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/terms/landmarks.h"

namespace bodyloom {

/// Steps in the order in which they are to be called. Input and options must pass CheckInput() and, with the summary,
/// outlive the run.
class ClipFit {
 public:
  ClipFit(const TrackSequenceInput& given, const TrackSequenceOptions& options, TrackSequenceSummary* summary);
  ClipFit(const ClipFit&) = delete;
  ClipFit& operator=(const ClipFit&) = delete;

  /// A starting pose for every frame. False, with the reason in the summary, when no frame shows enough to start from.
  bool FindStart();
  /// The terms of every frame.
  void Observe();
  /// The stages on the coarse frames, and what each of them gives of the clip.
  void FitCoarseFrames();
  void FitAllFrames();
  /// Ceres on the whole, where options ask for it after chain's stages.
  void FinishWithCeres();
  /// Track, summary and uncertainty.
  void Finish(TrackSequenceResult* result);

  [[nodiscard]] SequenceProblem* problem() { return &problem_; }

 private:
  void CleanObservations();
  void SetUpProblem();
  /// States and frames from the camera frames into the scene of a camera that moves.
  void FollowCamera();
  void FitNearStart(SequenceProblem* coarse);
  /// How lively the clip is and where its ground is, after a first answer; fits again when that changes something.
  void LearnFromFirstAnswer(SequenceProblem* coarse);
  /// Finds the length of the camera's path, where it is not known, with the coarse answer so far, and gives it to all
  /// frames; what each camera sees of the person stays as it is.
  void FitCameraScale(SequenceProblem* coarse);
  void ScaleCameraPath(double scale_m, SequenceProblem* coarse);
  /// A focal length that is not known becomes what the coarse answer and the prior say of it together, and stays;
  /// people move along their rays with it. Only of 2D joints that the lifter has seen: nothing else is known to err as
  /// much.
  void SettleFocalLength(SequenceProblem* coarse);
  void FitRounds(SequenceProblem* coarse);
  /// Uncertainty of every frame's joints: that of the coarse frame nearest in time.
  void FillJointSigma(Track* track);
  [[nodiscard]] bool has_points() const { return input_.keypoints != nullptr || input_.dense != nullptr; }
  [[nodiscard]] bool seeks_camera_scale() const {
    return input_.camera_from_scene != nullptr && input_.camera_scale_m == 0;
  }
  [[nodiscard]] size_t num_frames() const { return problem_.timestamps.size(); }

  const TrackSequenceOptions& options_;
  TrackSequenceSummary& summary_;
  int threads_;
  TrackSequenceInput input_;  ///< what was given, with the observations below in place of what cannot be meant
  KeypointSequence keypoints_, joints_from_dense_;
  DenseSequence dense_;
  const KeypointSequence* joints_ = nullptr;  ///< to start from and to find cuts by; null: none
  int num_impossible_ = 0;
  StageClock clock_;
  ObservedLandmarks landmarks_;
  double stature_m_ = 0;                 ///< AssumedStature()
  std::vector<CameraPose> camera_path_;  ///< T, scaled, of a camera that moves; or empty
  SequenceProblem problem_;
  LiftedStart lifted_;
  LiftedLandmarks lifted_landmarks_;
  std::optional<FocalFit> settled_focal_;
  std::vector<std::unique_ptr<ClipTerm>> terms_;
  std::vector<int> coarse_frames_;
  Stages stages_{};
  std::optional<StageRunner> runner_;
};

/// Fits the body to a clip with what the input names and nothing else: without a prior and a lifter there are joint
/// limits and joint hypotheses (TrackSequence() fills in the built-in ones). Throws std::invalid_argument when the
/// input contradicts itself; a clip in which nothing can be estimated gives status kFailure with a message.
TrackSequenceResult FitClip(const TrackSequenceInput& input, const TrackSequenceOptions& options);

// The motion level of a clip, and the smoothness that suits it.
//
// One σ of acceleration for everybody is too stiff for a break dance and too loose for somebody who stands: the first
// loses the motion, the second follows the detector's noise. So it is with one σ for all joints: arms swing while the
// spine hardly moves. A first solve shows which is which.

inline constexpr double kSigmaOfRms = 4;                        ///< σ of what moves with an rms of 1
inline constexpr double kLeastSigma = 17, kMostSigma = 40;      ///< m/s², of the whole clip
inline constexpr double kLeastOfJoint = 10, kMostOfJoint = 60;  ///< m/s², of a joint

/// Root mean square over the frames of a shot of lever × angular acceleration (JointLevers, residuals/
/// acceleration_cost.h) of each body joint, m/s²; 0 for joints that are not estimated and without three consecutive
/// frames. Differences of neighbouring frames: of a solve at about TrackSequenceOptions::coarse_rate.
std::vector<double> TipAccelerationRms(const SequenceProblem& problem, int shot = 0);

/// Smoothness of each shot. Each joint's σ of acceleration is kSigmaOfRms × its rms, in [kLeastOfJoint, kMostOfJoint],
/// and both common ones are those of `before`, scaled by the same factor: that of the tips becomes kSigmaOfRms × the
/// root mean square over the estimated joints, in [kLeastSigma, kMostSigma]. A shot in which nothing accelerates keeps
/// `before`.
std::vector<Smoothness> FitSmoothness(const SequenceProblem& problem, const Smoothness& before);

}  // namespace bodyloom
