// SPDX-License-Identifier: Apache-2.0
/// Fits several people in one view as one scene, with a common focal length, vertical and ground, and with occlusion
/// between people.
///
/// Everybody is first fitted alone. The scene estimates of these fits are joined (shared_scene.h), observations hidden
/// by nearer bodies lose weight (occlusion.h), and those for whom this changes something are fitted again. If the focal
/// length is not known and feet of two people stand, this is done twice: with the joined focal length, which moves
/// everybody's feet, and then with the ground and the sizes estimated from them. Masks of people who have keypoints are
/// used in the last fit alone. For a moving camera the scale of the path is common to all, and sizes are not compared.
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
  std::vector<char> fitted_again;    ///< of each person: 1 when the scene or masks changed something for them
};

struct TrackPeopleResult {
  std::vector<TrackSequenceResult> people;  ///< in the order of the input; some may have status kFailure
  TrackPeopleSummary summary;
};

/// Inputs are as for TrackSequence(), of one camera and one clip; people may be present for parts of it (frames are
/// simultaneous when their timestamps are equal). With weak perspective, which has no common space, everybody is fitted
/// alone. Progress runs over all fits; when its callback returns false, the fits so far are returned. Throws
/// std::invalid_argument as TrackSequence(), when there is nobody, and when the image sizes differ.
TrackPeopleResult TrackPeople(std::vector<TrackSequenceInput> people, const TrackSequenceOptions& options);

}  // namespace bodyloom
