// SPDX-License-Identifier: Apache-2.0
/// All people that a detector found in a clip, linked into tracks, and the selection of one.
///
/// Detectors list the people of each frame in any order. LinkPeople joins detections into tracks: each detection goes
/// to the track whose last landmarks are nearest (mean distance over landmarks present in both, relative to the
/// person's size), nearest pairs first; a detection that is far from every track starts a new one. A track continues
/// across gaps, its gate widening with their length, and ends after 30 frames without a detection plus ten for each
/// frame with one. Detections with identities from the detector are joined by identity. Tracks of one body that was
/// found twice are one.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

struct DetectedPerson {
  std::vector<Keypoint> points;  ///< one per landmark of the convention
  int identity = -1;             ///< from the detector's own tracker; −1 if it has none
  std::shared_ptr<const HandsAndFace> hands_and_face = nullptr;  ///< null: none
};

/// A landmark from a file's numbers: all zero, which is missing, unless all three are finite.
Keypoint DetectedKeypoint(double x, double y, double confidence);

struct PeopleSequence {
  KeypointConvention convention;
  std::vector<std::vector<DetectedPerson>> frames;  ///< T
  std::vector<double> timestamps;                   ///< T seconds, strictly increasing
  int image_width = 0, image_height = 0;
};

/// Frames with these numbers (in any order) on the grid of MakeFrameGrid(), which throws std::runtime_error beginning
/// with `where`. Without a convention, as nobody was detected, COCO's.
PeopleSequence PeopleOnGrid(std::vector<std::vector<DetectedPerson>> frames, const std::vector<int64_t>& numbers,
                            const KeypointConvention* convention, double fps, const std::string& where);

/// One person through the clip.
struct PersonTrack {
  std::vector<std::pair<int, int>> detections;  ///< (frame, index in that frame), frames increasing
  double weight = 0;                            ///< Σ over frames of box diagonal (px) × mean confidence
  int joined = 0;                               ///< number of other tracks of the same body that are left out
};

/// All tracks by descending weight: index 0 is the person who is largest, most confident and longest in the image.
std::vector<PersonTrack> LinkPeople(const PeopleSequence& people);

/// Returns person number `person` in LinkPeople's order. Throws std::runtime_error beginning with `where` if nobody was
/// detected or there are fewer people.
PersonTrack PersonOf(const PeopleSequence& people, int person, const std::string& where);

/// The landmarks of one person, missing in frames without that person. Confidences are clamped to [0, 1]; non-finite
/// points become missing.
KeypointSequence KeypointsOf(const PeopleSequence& people, const PersonTrack& person);

/// The hands and face of one person, in the same frames; HandsAndFaceSequence::empty() if nobody looked for them.
HandsAndFaceSequence HandsAndFaceOf(const PeopleSequence& people, const PersonTrack& person);

/// KeypointsOf(PersonOf()). Throws as PersonOf.
KeypointSequence SelectPerson(const PeopleSequence& people, int person, const std::string& where);

/// Joins tracks of one body. A detector may find a body twice: once more beside the first, or turned upside down or
/// folded inside it.
///
/// Of two people in one frame only landmarks of a confidence of at least 0.3 count, five of each at least. Let s be the
/// larger diagonal of the boxes around them, pixels. If the boxes share less than 60 % of the smaller one's area, the
/// two are apart. Else the shorter track's person b (fewer frames) is
///   a double of a   if the landmarks that count in both, five at least, are less than 0.08 s apart in the mean, as
///                   they are named or with left and right exchanged
///   inside a        if the smaller diagonal is over 0.75 s, the joints of b lie within 0.04 s of a's nearest limb in
///                   the mean, and those of a within 0.06 s of b's; joints are nose, shoulders, elbows, wrists, hips,
///                   knees and ankles, limbs the lines between neighbouring ones
/// Two tracks are of one body if b is a double in at least half of the frames in which b is seen; or a double or
/// inside, where those are eight frames at least. People who hug, dance as a couple or stand one behind the other stay
/// two: their boxes overlap, their joints do not for long (docs/lab/two_people.md).
/// Joins all tracks of one body. The longer keeps its detections. In frames where it has none it takes those of the
/// shorter, unless the shorter is of one body by what lies inside, whose pose is not the person's; its weight grows by
/// the shorter's mean weight a frame for each. PersonTrack::joined counts the tracks that ended so. Returns the tracks
/// that are left, in their order.
std::vector<PersonTrack> JoinDoubles(const PeopleSequence& people, std::vector<PersonTrack> tracks);

}  // namespace bodyloom
