// SPDX-License-Identifier: Apache-2.0
/// Several people in one view, fitted as one scene: one camera with one focal length, one vertical, one ground, and
/// nearer people in front of others.
///
/// Everybody is fitted alone first. What these fits say of the scene is joined (shared_scene.h), what a nearer body
/// hides of another is found (occlusion.h), and those for whom that changes something are fitted again with it. Where
/// the focal length was not known and feet of two people stand, twice: with the joined focal length, which moves
/// everybody's feet, and with the ground and the sizes that these show. Of a camera that moves the scale of the path is
/// one for all, and sizes are not compared.
#pragma once

#include <string>
#include <vector>

#include "tracking/people/occlusion.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/room/shared_scene.h"

namespace bodyloom {

struct TrackPeopleSummary {
  SharedScene scene;
  std::vector<HiddenCounts> hidden;  ///< of each person, by others
  std::vector<char> fitted_again;    ///< of each person: 1 when the scene changed something for them
};

struct TrackPeopleResult {
  std::vector<TrackSequenceResult> people;  ///< in the order of the input; some may have status kFailure
  TrackPeopleSummary summary;
};

/// Inputs are as for TrackSequence(), of one camera and one clip; people may be there for parts of it (frames belong
/// together when their timestamps are equal). With weak perspective, which has no place in a common space, everybody
/// stays alone. Progress runs over all fits; when its callback returns false, what is there by then is returned.
/// Throws std::invalid_argument as TrackSequence(), when there is nobody, and when the image sizes differ.
TrackPeopleResult TrackPeople(std::vector<TrackSequenceInput> people, const TrackSequenceOptions& options);

}  // namespace bodyloom
