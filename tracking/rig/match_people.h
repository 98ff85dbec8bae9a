// SPDX-License-Identifier: Apache-2.0
/// Tells who is who in several views, from motion alone.
///
/// Every pair of a person of one view and a person of another that moves alike (align_motions.h) is a hypothesis about
/// both cameras and clocks; under it every other pair has an agreement, too: the distance of the points about their
/// centre and that of the centres. The hypothesis is taken under which the people agree best in sum when each is
/// matched with at most one, greedily; a pair counts by its overlap and by how much nearer it is than poses that have
/// nothing to do with each other (d₀ of align_motions.h), so that whoever hardly moves is little evidence. Two people
/// who dance the same steps are told by where they stand.
#pragma once

#include <vector>

#include "tracking/rig/align_motions.h"

namespace bodyloom {

/// Agreement of two motions with cameras and clocks as given.
struct MotionAgreement {
  double distance_m = 0;  ///< root mean square of the points about their centres
  double apart_m = 0;     ///< median distance of the centres
  double overlap_s = 0;   ///< time that both show
};
MotionAgreement AgreementOf(const ViewMotion& a, const ViewMotion& b, const CameraPose& b_from_a, double offset_s);

/// People of a view matched with those of another.
struct MatchedViews {
  std::vector<int> person_of;  ///< of each person of the first view: the one in the other view, −1: none
  /// Evidence of each of these pairs for camera and clock: the score of its own alignment, 0 if that is not found, for
  /// somebody who hardly moves agrees with everything; under one hypothesis the time that both show.
  std::vector<double> evidence;
  MotionAlignment alignment;  ///< of the pair that tells it best; not found: no pair moves alike
  double score = 0;  ///< of all matched people: Σ overlap (d₀ − distance²) (1 − (apart / kMaxApart_m)²), m² s
};
MatchedViews MatchPeople(const std::vector<ViewMotion>& first, const std::vector<ViewMotion>& other);
/// The same under one hypothesis, as for cameras and clocks that are known: b_from_a and offset_s are used.
MatchedViews MatchPeople(const std::vector<ViewMotion>& first, const std::vector<ViewMotion>& other,
                         const MotionAlignment& alignment);

/// Centres of one person by two monocular tracks lie so far apart at most: their depths are wrong by a tenth.
inline constexpr double kMaxApart_m = 1.2;

}  // namespace bodyloom
