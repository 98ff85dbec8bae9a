// SPDX-License-Identifier: Apache-2.0
/// Finds the points of the body that touch the ground in each frame of a clip (surface_contact.h).
///
/// Heights are those of the states when a round starts. A point touches the ground in a frame in which it is within
/// kTouchingM of it (points that are not of the soles: 2 cm) and moves by less than kTouchingSpeed. A stretch of frames
/// in which the whole body is higher is a flight, at most RiseInFlight() high, if its centre of mass accelerates
/// downwards by more than kMinFall within kCentreWindowS of the middle. One shorter than kShortFlight_s, when that time
/// holds steps as well, if it does so by more than kMinShortFall in the stretch itself with the frames next to it; less
/// than kShowsFall_s or five frames tell nothing, and are a flight. In other frames somebody hovers, and the lowest
/// points touch, unless they are more than kMaxHoverM above the ground: then somebody stands on something else. Points
/// within kNearM of the ground stay above it.
///
/// Each round begins by fitting the grounds of a shot, parallel planes, to what touches them:
///   Σ w ρ((u · x − l ∓ d)² / σ²) + ‖(u − u₀) across u₀‖² / σ_u² + d² / kFeetApartM²  → min over u, d, every level l
/// x: a foot's sole, or the lowest point if only others touch; ∓ d: left and right foot, because many people keep one
/// heel raised, which is no slope; σ² = kTouchSigmaM² + (u · ray · depth)², ray from the camera to x, depth the σ of a
/// stance's depth; w: seconds / kTouchErrorLasts_s, because a track's errors last; u₀, σ_u: the vertical as measured
/// without the ground. A frame without touch bounds the ground, which is at most kTouchingM above its lowest point. The
/// fit's covariance gives the variance of the ground's height at any place. A ground that is given stays where it is.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "tracking/problem/clip_term.h"
#include "tracking/problem/contact_points.h"

namespace bodyloom {

struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

inline constexpr double kTouchingM = 0.06, kTouchingSpeed = 0.3, kMaxHoverM = 0.3, kNearM = 0.12;
inline constexpr double kShortFlight_s = 0.4;
inline constexpr double kTouchSigmaM = 0.03;  ///< of the height of what touches: a track's errors, raised heels
inline constexpr double kFeetApartM = 0.03;   ///< σ of d
/// Of the whole error of a touch, by depth and the pose of feet, which lasts as long as a posture. The scatter of
/// heights alone, without what all frames are off together, lasts less (initialise/support_levels.cc).
inline constexpr double kTouchErrorLasts_s = 1.5;
inline constexpr double kMinFall = 2.5;  ///< m/s²; a quarter of g, because the track and the parabola are smooth
/// m/s²: of AIST++'s tracks true hops have 9 to 14, raised heels that look like one 2 to 3 (docs/lab/world.md).
inline constexpr double kMinShortFall = 4.9;
inline constexpr double kShowsFall_s = 0.15;  ///< in which the centre of mass falls by 3 cm

inline constexpr double kHoldSpreadM = 0.06, kMinHold_s = 0.2;

/// By frame: the place at which one point that touches the ground is held, so that contacts do not slide, in the frame
/// of `path`; none: it is free. `path`: the point's place by frame, metres, read only where it touches; `touches` and
/// `begins` (nothing before this frame is the same stretch): not 0 means yes; `timestamps`: seconds. All of one length,
/// checked.
///
/// A stretch is a run of frames in which the point touches the ground and stays within kHoldSpreadM of the mean of the
/// stretch so far. A stretch holds the point at its mean place if it lasts kMinHold_s and the means of its two halves
/// are within half of that spread: whoever slides slowly leaves each stretch at its edge, with halves further apart. A
/// foot that turns on its toe is held at the toe alone, as the heel leaves its place.
std::vector<std::optional<Eigen::Vector3d>> HeldPlaces(const std::vector<Eigen::Vector3d>& path,
                                                       const std::vector<char>& touches,
                                                       const std::vector<char>& begins,
                                                       const std::vector<double>& timestamps);

/// True if contacts with the ground are looked for.
bool SeeksContacts(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::vector<PlanEntry> PlanSurfaceContact(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeClipContacts(const ClipTermInput& clip);

class ClipContacts : public ClipTerm {
 public:
  explicit ClipContacts(const ClipTermInput& clip);

  void Observe(SequenceProblem* problem) override;
  [[nodiscard]] Rounds rounds() const override { return {2, 8, "fit contacts"}; }
  /// Grounds stay where they are while parts of a long clip are solved: all parts share them, and the feet of the other
  /// frames stand on them.
  void BeginRounds(const std::vector<int>& coarse_frames, bool in_windows) override {
    whole_ = in_windows ? coarse_frames.size() : 0;
  }
  void StartRound(int round, const std::vector<int>& frames, SequenceProblem* problem) override;

 private:
  double weight_, hold_weight_;
  bool level_is_given_;
  size_t whole_ = 0;  ///< number of frames of a problem that moves grounds, at least
  int num_threads_;
  std::vector<ContactPoint> points_;
  CompiledPoint centre_of_mass_;
};

}  // namespace bodyloom
