// SPDX-License-Identifier: Apache-2.0
/// The vertical and the ground of a clip, as terms of its problem: upright normals and standing feet
/// (initialise/ground_plane.h, terms/upright.h, ground_contact.h). Every shot has its own. Where standing feet show no
/// plane, the level is that on which the body rests with any part, and further levels are looked for in every shot
/// (initialise/support_levels.h).
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tracking/initialise/ground_plane.h"
#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/initialise/support_levels.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/room/picture_vertical.h"

namespace bodyloom {

/// The vertical of a clip's frames by the lifter, in the scene. `lifted` and `frames` are of the same frames.
UpEstimate UpInScene(std::span<const LiftedFrame> lifted, std::span<const FrameData> frames);

/// Without lifted frames, or if switched off, it has no effect.
class ClipGround : public ClipTerm {
 public:
  explicit ClipGround(const ClipTermInput& clip);

  void Observe(SequenceProblem* problem) override;
  /// Estimates the vertical of each shot.
  void BeginFit(SequenceProblem* problem) override;

  /// Estimates the ground from the states of `coarse`, which holds `frames` of the clip. Returns true if one was found:
  /// then in `coarse` and `problem` (the whole clip) standing feet are held, and the trunk's lean is relative to its
  /// normal.
  bool LearnFrom(const std::vector<int>& frames, SequenceProblem* coarse, SequenceProblem* problem) override;

  /// Summarises the longest shot, with the solution in `problem` (the whole clip).
  void Summarise(const SequenceProblem& problem, TrackSequenceSummary* summary) const override;

 private:
  struct Shot {
    int begin = 0, end = 0;
    UpEstimate up_of_first;  ///< the lifter's, in the first view
    UpEstimate up;           ///< the lifter's of all views, or as given
    double up_sigma_rad = GroundPlaneOptions().up_rad;
    JoinedVertical joined;  ///< with the lines of the picture
    GroundPlane ground;
    std::vector<SupportLevel> levels;                  ///< the main one first; none without a ground
    std::vector<std::unique_ptr<FrameGround>> floors;  ///< by level; frames point to theirs
    std::vector<StandingFoot> stances;                 ///< without their places
  };
  /// The lifter's vertical in all views, or the known one, joined with the lines.
  void FindVertical(const SequenceProblem& problem, Shot* shot) const;
  /// The lifter's vertical in view v over the time of a shot, and that camera's axis in the middle of it: in the
  /// camera's frame, or in the view's own scene where it moves.
  [[nodiscard]] std::optional<UpOfView> UpInOwnScene(size_t v, const SequenceProblem& problem, const Shot& shot) const;
  /// Joins the lifter's vertical with the picture's lines, for the focal length of `problem`, and with those of further
  /// views as they stand to the first.
  void JoinLines(const SequenceProblem& problem, Shot* shot) const;
  /// The plane that feet stand on in a shot whose vertical is found.
  [[nodiscard]] GroundPlane PlaneUnder(const std::vector<std::array<FootPlace, 2>>& feet,
                                       const std::vector<double>& timestamps, const JoinedVertical& vertical) const;
  /// Sets the stances' positions on the floor from the solved states.
  void PlaceOnFloor(const SequenceProblem& problem, const Eigen::Vector3d& up,
                    std::vector<StandingFoot>* stances) const;
  void SetUpright(const Shot& shot, const Eigen::Vector3d& up, SequenceProblem* problem) const;
  /// Lets the frames of a shot point to the floors of its levels. `levels` are by the frames `index` of `coarse`, which
  /// are `frames` of the clip.
  void StandOnFloors(const SupportLevels& levels, const std::vector<int>& index, const std::vector<int>& frames,
                     Shot* shot, SequenceProblem* coarse, SequenceProblem* problem) const;
  void Hold(const Stance& stance, const GroundPlane& ground, FrameData* frame) const;

  const GroundOptions options_;
  const KeypointSequence* keypoints_;
  const KnownGround* known_;
  const PictureVertical* lines_;                            ///< null: none
  std::vector<const PictureVertical*> view_lines_;          ///< likewise, of each further view
  std::vector<const std::vector<CameraPose>*> view_paths_;  ///< of each further view; null: it stands still
  double focal_log_sigma_ = 0;                              ///< of the focal length that the fit begins with; 0: known
  const std::vector<LiftedFrame>& lifted_;
  const LiftedLandmarks& landmarks_;
  const std::vector<ViewObservations>& views_;
  std::vector<double> timestamps_;  ///< of the clip
  std::vector<Shot> shots_;
  std::string why_not_;
  int contact_frames_ = 0;
  double standing_speed_mps_ = std::numeric_limits<double>::quiet_NaN();
};

std::unique_ptr<ClipTerm> MakeClipGround(const ClipTermInput& clip);

}  // namespace bodyloom
