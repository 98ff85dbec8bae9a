// SPDX-License-Identifier: Apache-2.0
/// Finds the points of the body that touch the ground in each frame of a clip (surface_contact.h).
///
/// Heights are those of the states when a round starts. A point touches the ground in a frame in which it is within
/// kTouchingM of it (points that are not of the soles: 2 cm) and moves by less than kTouchingSpeed. A stretch of frames
/// in which the whole body is higher is a flight if its centre of mass accelerates downwards by more than kMinFall in
/// the middle, and then at most RiseInFlight() high. In other frames the person hovers, and the lowest points touch,
/// unless they are more than kMaxHoverM above the ground: then somebody stands on something else. Points within kNearM
/// of the ground stay above it.
///
/// Rounds after the first begin by moving the level of a shot's ground to the median of the touching points, since the
/// first estimate is that of ankles, which stand at a height of their own. A ground that is given stays where it is.
#pragma once

#include <memory>
#include <vector>

#include "tracking/problem/clip_term.h"
#include "tracking/terms/surface_contact/contact_points.h"

namespace bodyloom {

struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

inline constexpr double kTouchingM = 0.06, kTouchingSpeed = 0.3, kMaxHoverM = 0.3, kNearM = 0.12;
inline constexpr double kMinFall = 2.5;  ///< m/s²; a quarter of g, because the track and the parabola are smooth

/// True if contacts with the ground are looked for.
bool SeeksContacts(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::vector<PlanEntry> PlanSurfaceContact(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeClipContacts(const ClipTermInput& clip);

class ClipContacts : public ClipTerm {
 public:
  explicit ClipContacts(const ClipTermInput& clip);

  void Observe(SequenceProblem* problem) override;
  [[nodiscard]] Rounds rounds() const override { return {2, 8, "fit contacts"}; }
  void StartRound(int round, const std::vector<int>& frames, SequenceProblem* problem) override;

 private:
  double weight_;
  bool level_is_given_;
  int num_threads_;
  std::vector<ContactPoint> points_;
  CompiledPoint centre_of_mass_;
};

}  // namespace bodyloom
