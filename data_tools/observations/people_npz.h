// SPDX-License-Identifier: Apache-2.0
/// 2D landmarks of all people in the project's own file of observations (.npz): one row per person and frame.
///
/// | key                | shape  | type | meaning                                                          |
/// |--------------------|--------|------|------------------------------------------------------------------|
/// | timestamps         | T      | f8   | seconds, strictly increasing                                     |
/// | image_size         | 2      | i4   | width, height in pixels; 0, 0 when not known                     |
/// | people_frame       | N      | i4   | frame of each row, not decreasing                                |
/// | people_identity    | N      | i4   | who it is, where the detector followed people; −1: not known     |
/// | people_keypoints   | N×K×3  | f4   | x_px, y_px, confidence in [0,1] (0: missing)                     |
/// | keypoint_names     | K      | text | landmark names                                                   |
/// | keypoint_convention| scalar | text | "mediapipe33", …                                                 |
///
/// Hands and faces (geometry/scene/hands_and_face.h), where somebody has any; a row each, in the order of the people:
///
/// | key                 | shape  | type | meaning                                                         |
/// |---------------------|--------|------|-----------------------------------------------------------------|
/// | hand_person         | H      | i4   | row of people_frame whose hand it is                            |
/// | hand_side           | H      | i4   | 0 left, 1 right                                                 |
/// | hand_keypoints      | H×21×3 | f4   | x_px, y_px, confidence in [0,1] (0: missing)                    |
/// | hand_sigma_px       | H×21   | f4   | standard deviation along an axis; 0: not known                  |
/// | hand_metres         | H×21×3 | f4   | HandObservation::metres; NaN: not known                         |
/// | face_person         | F      | i4   | row of people_frame                                             |
/// | face_keypoints      | F×68×3 | f4   | x_px, y_px, confidence in [0,1] (0: missing)                    |
/// | face_sigma_px       | F      | f4   | standard deviation along an axis; 0: not known                  |
/// | face_depth_px       | F×68   | f4   | FaceObservation::depth_px; NaN: not known                       |
#pragma once

#include <string>

#include "data_tools/formats/npz.h"
#include "data_tools/observations/people.h"

namespace bodyloom {

/// Throws std::invalid_argument when frames, timestamps and landmarks are inconsistent; std::runtime_error naming the
/// path when it cannot be written.
void WritePeople(const std::string& path, const PeopleSequence& people);

bool HasPeople(const NpzArrays& arrays);
/// Throws std::runtime_error naming `where`, the key, what it holds and what was expected.
PeopleSequence PeopleFromNpz(const NpzArrays& arrays, const std::string& where);

}  // namespace bodyloom
