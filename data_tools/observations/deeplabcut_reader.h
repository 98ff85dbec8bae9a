// SPDX-License-Identifier: Apache-2.0
/// Reads DeepLabCut's CSV of analysed videos: header rows `scorer`, `individuals` (of several animals or people),
/// `bodyparts` and `coords`, then one row per frame: its number, and for each body part x and y in pixels and a
/// `likelihood`, which is the confidence (1 where there is none, as in labelled frames).
///
/// Empty cells and NaN are missing landmarks. Body parts are a person's by their names (LandmarkNameFrom(): "nose",
/// "leftShoulder", "right_knee", "ankle_l"); others have a name of their own and constrain nothing. Individuals are
/// identities; parts of the individual `single`, which belong to no one, are left out beside others. In labelled frames
/// the number is that in the image's name.
/// Source: DeepLabCut/DeepLabCut, user guides of single-animal and multi-animal projects,
/// deeplabcut/pose_estimation_tensorflow/predict_videos.py.
#pragma once

#include <string>
#include <string_view>

#include "data_tools/observations/people.h"

namespace bodyloom {

/// Returns true if a text begins as DeepLabCut's CSV does.
bool IsDeepLabCutCsv(std::string_view text);
/// Throws std::runtime_error naming `where`, the line, what was found and what was expected.
PeopleSequence DeepLabCutFromCsv(std::string_view text, const std::string& where, double fps);

}  // namespace bodyloom
