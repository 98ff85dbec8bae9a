// SPDX-License-Identifier: Apache-2.0
/// When each frame of a video is shown, without looking at the pictures.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// The frame_time() of every frame that a VideoReader returns for a whole file: seconds after the first frame, rising.
/// From the timestamps of the file's packets alone (a minute of video takes milliseconds); where these do not tell, the
/// frames are decoded (streams without timestamps, interlaced ones, hidden frames of VP8, recordings put one behind the
/// other, beginnings that cannot be decoded). Frames that a damaged file holds and that turn out not to be decodable
/// are counted here. Empty for images, which have no clock. Throws as VideoReader.
std::vector<double> VideoFrameTimes(const std::string& path);

}  // namespace bodyloom
