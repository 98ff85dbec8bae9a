// SPDX-License-Identifier: Apache-2.0
/// Shots of a clip: runs of frames between cuts.
#pragma once

#include <vector>

namespace bodyloom {

/// The shot of each frame, counted from 0: a cut begins the next one.
std::vector<int> ShotOfFrames(const std::vector<char>& cut_before);

}  // namespace bodyloom
