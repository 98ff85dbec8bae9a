// SPDX-License-Identifier: Apache-2.0
/// Fits a body to a clip, one run of FitClip(): the clip's problem with all that its terms point to, and the steps that
/// solve it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geometry/base/stopwatch.h"
#include "tracking/camera_motion/points_floor.h"
#include "tracking/clip/track_stages.h"
#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/view_observations.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/solvers/solve_sequence.h"
#include "tracking/terms/landmarks.h"

namespace bodyloom {

/// Steps in the order in which they are to be called. Input and options must pass CheckInput() and, with the summary,
/// outlive the run.
class ClipFit {
 public:
  ClipFit(const TrackSequenceInput& given, const TrackSequenceOptions& options, TrackSequenceSummary* summary);
  ClipFit(const ClipFit&) = delete;
  ClipFit& operator=(const ClipFit&) = delete;

  /// Finds a starting pose for every frame. Returns false, with the reason in the summary, when no frame shows enough.
  bool FindStart();
  /// Makes the terms of every frame.
  void Observe();
  /// Solves the stages on the coarse frames, and estimates smoothness, camera scale, focal length and ground from them.
  void FitCoarseFrames();
  void FitAllFrames();
  /// Solves the whole problem with Ceres if the options request it after chain's stages.
  void FinishWithCeres();
  /// Fills track, summary and uncertainty.
  void Finish(TrackSequenceResult* result);

  [[nodiscard]] SequenceProblem* problem() { return &problem_; }

 private:
  void CleanObservations();
  void SetUpProblem();
  void StartFrom(const TrackStart& start);
  /// Transforms states and frames from the camera frames into the scene of a moving camera.
  void FollowCamera();
  /// Solves a stage on the coarse frames: on those of a long clip in windows, after a sample of them has told shape and
  /// focal length.
  void RunCoarse(Stage stage, SequenceProblem* coarse);
  /// Takes over what the sample's solve has found; the other frames move to where they are seen as large as before.
  void TakeSample(const SequenceSample& sample, SequenceProblem* coarse) const;
  /// Multiplies the pelvis' depth in frame i. The size in the image stays when the focal length grows by `factor`.
  void ScaleDepth(double factor, size_t i, SequenceProblem* problem) const;
  void FitNearStart(SequenceProblem* coarse);
  /// Estimates smoothness and ground from a first solution; solves again when that changes something.
  void LearnFromFirstAnswer(SequenceProblem* coarse);
  /// Estimates the scale of the camera's path, if not known, from the current coarse solution, and applies it to all
  /// frames; the person's position in each camera frame stays the same.
  void FitCameraScale(SequenceProblem* coarse);
  /// The floor among the points of the background, whose place does not depend on the path's scale; found once.
  const PointsFloor& FloorOfPoints();
  void ScaleCameraPath(double scale_m, SequenceProblem* coarse);
  /// Fixes an unknown focal length at the estimate that joins the coarse solution and the prior; the person moves along
  /// the viewing rays with it. Only with 2D joints and the lifter, without dense keypoints: the errors of these fits
  /// are known.
  void SettleFocalLength(SequenceProblem* coarse);
  void FitRounds(SequenceProblem* coarse);
  /// The rounds of these terms, those of one entry together, on some of the coarse frames.
  void RunRounds(const std::vector<std::vector<ClipTerm*>>& shared, const std::vector<int>& frames, double from,
                 double to, const std::vector<char>& held, SequenceProblem* part);
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
  TrackSequenceInput input_;  ///< as given, with the cleaned observations below
  KeypointSequence keypoints_, joints_from_dense_;
  DenseSequence dense_;
  const KeypointSequence* joints_ = nullptr;  ///< to start from and to find cuts by; null: none
  int num_impossible_ = 0;
  StageClock clock_;
  ObservedLandmarks landmarks_;
  double stature_m_ = 0;                 ///< AssumedStature()
  std::vector<CameraPose> camera_path_;  ///< T, scaled, of a camera that moves; or empty
  std::optional<PointsFloor> points_floor_;
  SequenceProblem problem_;
  LiftedStart lifted_;
  LiftedLandmarks lifted_landmarks_;
  std::vector<ViewObservations> views_;
  std::optional<FocalFit> settled_focal_;
  std::vector<std::unique_ptr<ClipTerm>> terms_;
  std::vector<int> coarse_frames_;
  Stages stages_{};
  std::optional<StageRunner> runner_;
};

/// Fits the body to a clip with the models that the input names: without a prior and a lifter there are joint limits
/// and joint hypotheses (TrackSequence() fills in the built-in models). Throws std::invalid_argument when the input
/// contradicts itself; a clip in which nothing can be estimated gives status kFailure with a message.
TrackSequenceResult FitClip(const TrackSequenceInput& input, const TrackSequenceOptions& options);

// Smoothness from the motion of the clip.
//
// One σ of acceleration for all clips is too small for a break dance, whose motion it damps, and too large for somebody
// who stands, where the track follows the detector's noise. The same holds for one σ for all joints: arms swing while
// the spine hardly moves. So σ is estimated from a first solution.

inline constexpr double kSigmaOfRms = 4;                     ///< ratio of σ to the rms acceleration
inline constexpr double kMinSigma = 17, kMaxSigma = 40;      ///< m/s², of the whole clip
inline constexpr double kMinOfJoint = 10, kMaxOfJoint = 60;  ///< m/s², of a joint

/// Root mean square over the frames of a shot of lever × angular acceleration (JointLevers, residuals/
/// acceleration_cost.h) of each body joint, m/s²; 0 for joints that are not estimated and without three consecutive
/// frames. Differences of neighbouring frames: of a solve at about TrackSequenceOptions::coarse_rate.
std::vector<double> TipAccelerationRms(const SequenceProblem& problem, int shot = 0);

/// Smoothness of each shot. Each joint's σ of acceleration is kSigmaOfRms × its rms, in [kMinOfJoint, kMaxOfJoint],
/// and both common ones are those of `before`, scaled by the same factor: that of the tips becomes kSigmaOfRms × the
/// root mean square over the estimated joints, in [kMinSigma, kMaxSigma]. A shot in which nothing accelerates keeps
/// `before`.
std::vector<Smoothness> FitSmoothness(const SequenceProblem& problem, const Smoothness& before);

}  // namespace bodyloom
