// SPDX-License-Identifier: Apache-2.0
/// Everyone a detector saw in a clip, and the choice of one of them.
///
/// Detectors list people in any order, frame by frame. LinkPeople joins detections into tracks: each detection goes to
/// the track whose last landmarks lie nearest (mean distance over landmarks seen in both, relative to the person's
/// size), nearest pairs first; a detection that is far from every track starts a new one. A track survives gaps, its
/// gate widening with their length, and is given up after 30 frames plus ten for each frame it was seen. Detections
/// that carry identities from the detector are joined by identity.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

struct DetectedPerson {
  std::vector<Keypoint> points;  ///< one a landmark of the convention
  int identity = -1;             ///< from the detector's own tracker; −1 when it has none
};

struct PeopleSequence {
  KeypointConvention convention;
  std::vector<std::vector<DetectedPerson>> frames;  ///< T
  std::vector<double> timestamps;                   ///< T seconds, strictly increasing
  int image_width = 0, image_height = 0;
};

/// One person through the clip.
struct PersonTrack {
  std::vector<std::pair<int, int>> detections;  ///< (frame, index in that frame), frames increasing
  double weight = 0;                            ///< Σ over frames of box diagonal (px) × mean confidence
};

/// All tracks, heaviest first: index 0 is the person who is largest, best seen and longest in the picture.
std::vector<PersonTrack> LinkPeople(const PeopleSequence& people);

/// Person number `person` in LinkPeople's order. Throws std::runtime_error beginning with `where` when nobody was seen
/// at all or there are not that many people.
PersonTrack PersonOf(const PeopleSequence& people, int person, const std::string& where);

/// The landmarks of one of them; frames without that person are missing. Confidences are clamped to [0, 1]; non-finite
/// points become missing.
KeypointSequence KeypointsOf(const PeopleSequence& people, const PersonTrack& person);

/// KeypointsOf(PersonOf()). Throws as PersonOf.
KeypointSequence SelectPerson(const PeopleSequence& people, int person, const std::string& where);

}  // namespace bodyloom
