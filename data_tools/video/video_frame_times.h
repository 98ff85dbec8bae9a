// SPDX-License-Identifier: Apache-2.0
/// Presentation times of a video's frames, without decoding them where possible.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// Returns VideoReader::frame_time() of every frame of a file: seconds after the first frame, increasing. They come
/// from the timestamps of the file's packets alone (a minute of video takes milliseconds); where these are
/// insufficient, the frames are decoded (streams without timestamps, interlaced ones, hidden frames of VP8,
/// concatenated recordings, beginnings that cannot be decoded). Undecodable frames of a damaged file are included.
/// Empty for images, which have no timestamps. Throws as VideoReader.
std::vector<double> VideoFrameTimes(const std::string& path);

}  // namespace bodyloom
