// SPDX-License-Identifier: Apache-2.0
/// Keeps ffmpeg's libraries from writing to the terminal: this library reports faults by exceptions.
#pragma once

namespace bodyloom {

/// Takes effect once a process; a level other than the libraries' own that a program has set by av_log_set_level stays.
void QuietCodecs();

}  // namespace bodyloom
