// SPDX-License-Identifier: Apache-2.0
/// Physical plausibility of a track in its own world, without a truth: hovering, ground penetration, sliding contacts,
/// balance, lean.
///
/// h(t): height of the lowest vertex over the stated ground, or over the level that supports the person in the frame
/// (Track::level_m). Within a second of a change of level, a foot whose lowest vertex is within 4 cm of the other level
/// stands on it, as whoever steps onto a box has one foot there before the other leaves the ground; and what is above
/// the lower level is beside the box, not in it; balance and lean count the frame's own level alone. A frame is in
/// contact if h ≤ 4 cm. Between two contacts at t₀ and t₁ a body without support can be at most
///   h(t) ≤ 4 cm + ½ g (t − t₀) (t₁ − t),   g = 9.81 m/s²
/// above the ground, or above the line between the levels that it leaves and reaches, because its centre of mass falls
/// freely; a stretch that the clip's ends cut short is taken to end there. Frames above that bound hover without a
/// flight. Frames without a result are left out, and a stretch ends where one is missing.
///   hover_percent                frames not in contact
///   other_level_percent          frames on another level than the ground; left out without any
///   hover_unexplained_percent    frames above the bound
///   lowest_point_mm              median of h
///   ground_penetration_p95_mm    95th percentile of max(0, −h)
///   ground_penetration_percent   frames with h below −2 cm
///   contact_slide_mps            median over pairs of consecutive frames of the median horizontal speed of vertices
///                                within 2 cm of the ground in both
///   balance_measured_percent     frames whose balance is measured: slow ones on the ground (geometry/body/balance.h)
///   balance_outside_percent      of these, those whose zero-moment point is more than 5 cm outside the widened hull of
///                                the vertices up to 4 cm high
///   balance_p95_mm               95th percentile of its distance outside, of the same frames
///   lean_median_deg              median angle between the vertical and the line from pelvis to neck over frames in
///                                which the person stands on both feet: both are in contact, nothing above the legs is,
///                                and both knees are higher than 25 cm. 3° for the built-in body upright
#pragma once

#include <string>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Shares are in [0, 1]; NaN: no frame, or no contact.
struct RoomPhysics {
  int frames = 0;
  double hover_share = 0, unexplained_hover_share = 0;
  double other_level_share = 0;
  double lowest_point_m = 0;
  double penetration_p95_m = 0, penetration_share = 0;
  double contact_slide_mps = 0;
  double balance_measured_share = 0, balance_outside_share = 0, balance_p95_m = 0;
  double lean_median_deg = 0;
  /// "on the ground or in flight in 97 % of the frames, within 12 mm below it in 95 %, on other levels in 40 %,
  /// contacts slide 0.01 m/s, off balance in 3 % of the slow frames, leans 4 deg on both feet", without what was not
  /// measured, without other levels where there are none, and without balance when fewer than 10 % of the frames are
  /// slow; empty without frames.
  [[nodiscard]] std::string BriefReport() const;
};

/// The track, on `body`, in `track.world`. The same for any number of threads. Throws std::invalid_argument when the
/// track states no world or does not fit the body.
RoomPhysics MeasureRoomPhysics(const Track& track, const BodyModel& body, int num_threads = 1);

/// The same where a ground was found or given; of no frame where the ground was assumed under the lowest joint.
RoomPhysics RoomPhysicsOnGround(const Track& track, const BodyModel& body, int num_threads = 1);

/// Adds the values above.
void AddRoomPhysics(const RoomPhysics& physics, Evaluation* evaluation);

}  // namespace bodyloom
