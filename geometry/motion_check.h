// SPDX-License-Identifier: Apache-2.0
/// Whether a motion that somebody gives is one.
#pragma once

#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Throws std::invalid_argument, naming the caller, unless there is a frame, poses, trans and timestamps have T rows each, poses 3J columns,
/// and all is finite.
void CheckMotion(const Motion& motion, const char* caller);

}  // namespace bodyloom
