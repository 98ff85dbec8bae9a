// SPDX-License-Identifier: Apache-2.0
/// The terms of the other views of a clip (problem/view_terms.h): 2D joints and the lifter's landmarks, observed at the
/// times at which the first view's frames are shown by the view's clock. While a clock is not known, the observations
/// are made again at the start of each round.
///
/// A detected position is interpolated between the two frames on either side, if they are not more than 0.15 s apart;
/// its velocity is the slope of a line through the detections within 0.06 s, so that the noise of a position and of its
/// velocity are independent; of a view that moves, the part that its camera's motion has in it is taken out. The
/// lifter's landmarks are those of the nearest frame.
#pragma once

#include <memory>
#include <vector>

#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/track_input.h"
#include "tracking/terms/landmarks.h"
#include "tracking/terms/lifted/lifted_pose.h"

namespace bodyloom {

/// Adds the unknowns of the input's views to a problem without frames.
void AddViews(const TrackSequenceInput& input, SequenceProblem* problem);

/// Detected positions at time `t` of the sequence's clock, with velocities, px/s; confidence 0 where not known.
struct SampledKeypoint {
  Keypoint point;
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();
};
std::vector<SampledKeypoint> SampleKeypoints(const KeypointSequence& keypoints, double t);

class ClipViews : public ClipTerm {
 public:
  explicit ClipViews(const ClipTermInput& clip);

  void Observe(SequenceProblem* problem) override;
  [[nodiscard]] Rounds rounds() const override;
  void StartRound(int round, const std::vector<int>& frames, SequenceProblem* problem) override;
  void Summarise(const SequenceProblem& problem, TrackSequenceSummary* summary) const override;

 private:
  struct View {
    const KeypointSequence* keypoints = nullptr;
    ObservedLandmarks landmarks;
    std::vector<LiftedPose> lifted;  ///< of each of its own frames; empty: none
    bool clock_known = false;
    const std::vector<CameraPose>* path = nullptr;  ///< of each of its own frames; null: it stands still
  };
  /// Pose of a view that moves at time t of its clock, in its own scene.
  static CameraPose PoseAt(const View& view, double t);
  /// Fills the terms of view v for frame t of the clip, which is frame i of the problem.
  void ObserveFrame(int v, size_t i, SequenceProblem* problem) const;

  std::vector<View> views_;
  double stature_m_, lifter_weight_, middle_s_ = 0;
  LiftedLandmarks lifted_landmarks_;
};

/// Fills the standard deviations of the summary's views from those of the shared unknowns (PositionSigma::shared;
/// empty: not known), those of poses and focal lengths times kViewSigmaFactor: a detector's landmarks lie elsewhere on
/// the body than the model's in all frames alike, which the cost does not know. Clocks do not suffer from that, but
/// from errors that last for several frames, which the cost takes for independent: times kClockSigmaFactor
/// (docs/lab/two_views.md). Those of focal lengths and clocks are at most those of their priors.
void SetViewSigma(const FrameLayout& layout, const Eigen::VectorXd& shared_sigma, TrackSequenceSummary* summary);
inline constexpr double kViewSigmaFactor = 5, kClockSigmaFactor = 3.5;

/// Removes what holds the body to the ground. The ground is an estimate of the same fit, which the cost takes for known
/// and by which it would know the first camera's focal length.
void LeaveGround(SequenceProblem* problem);

std::vector<PlanEntry> PlanViews(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeClipViews(const ClipTermInput& clip);

}  // namespace bodyloom
