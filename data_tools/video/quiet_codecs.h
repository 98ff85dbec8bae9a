// SPDX-License-Identifier: Apache-2.0
/// Keeps OpenCV and ffmpeg from writing to the terminal: this library reports faults by exceptions.
#pragma once

namespace bodyloom {

/// Takes effect once a process; what the user has set by OPENCV_LOG_LEVEL or OPENCV_FFMPEG_LOGLEVEL stays.
void QuietCodecs();

}  // namespace bodyloom
