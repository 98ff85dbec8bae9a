// SPDX-License-Identifier: Apache-2.0
/// The frame rate of the motion-dependent renderer's clips. The network sees velocities of so many past frames and its
/// own last picture, so a run is of one rate.
#pragma once

#include <string>

#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Whether the track has `fps` frames a second between its gaps, to 1 %, or is too short to say.
bool IsAtRate(const Track& track, double fps);

/// "60 frames a second", as far as it matters.
std::string RateText(const Track& track);

/// Throws std::runtime_error unless IsAtRate, naming the data, both rates, and what helps: pictures cannot be
/// resampled.
void RequireRate(const Track& track, double fps, const std::string& data, const std::string& what_helps);

}  // namespace bodyloom
