// SPDX-License-Identifier: Apache-2.0
/// What `bodyloom track` does, from files to files.
#pragma once

#include "apps/summary.h"
#include "apps/track_options.h"

namespace bodyloom {

/// Checks options, inputs and outputs, tracks, and writes what was asked for, with progress on stderr. With
/// command.plan nothing is computed or written and the report holds the plan alone.
/// Throws RequestError, Interrupted (nothing is written after it), and std::runtime_error also when nothing could be
/// tracked; then the JSON summary says why.
TrackReport RunTrack(const TrackCommand& command);

}  // namespace bodyloom
