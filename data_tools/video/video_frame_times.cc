// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/video_frame_times.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "data_tools/video/frame_decoder.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_packets.h"

namespace bodyloom {
namespace {

/// Returns true if each packet of the stream is a displayed frame; false for fields, and for VP8, which has hidden
/// frames.
bool HasAFrameAPacket(const AVCodecParameters& codec) {
  const bool progressive = codec.field_order == AV_FIELD_UNKNOWN || codec.field_order == AV_FIELD_PROGRESSIVE;
  return progressive && codec.codec_id != AV_CODEC_ID_VP8;
}

/// The timestamps of the frames in presentation order; nullopt if the packets do not determine them.
std::optional<std::vector<int64_t>> PacketTimestamps(VideoPackets* packets) {
  if (!HasAFrameAPacket(*packets->stream().codecpar)) return std::nullopt;
  const LibavPtr<AVPacket> packet = NewLibavPacket();
  std::vector<int64_t> shown;
  int64_t last_decoded = AV_NOPTS_VALUE, first_shown = AV_NOPTS_VALUE;
  while (packets->Next(packet.get())) {
    if (packet->pts == AV_NOPTS_VALUE || packet->dts == AV_NOPTS_VALUE) return std::nullopt;
    if (last_decoded != AV_NOPTS_VALUE && packet->dts <= last_decoded) return std::nullopt;
    if (last_decoded == AV_NOPTS_VALUE) {
      if ((packet->flags & AV_PKT_FLAG_KEY) == 0) return std::nullopt;
      first_shown = packet->pts;
    }
    last_decoded = packet->dts;
    // Shown before the first key frame: it refers to missing frames.
    if (packet->pts < first_shown) return std::nullopt;
    if ((packet->flags & AV_PKT_FLAG_DISCARD) == 0) shown.push_back(packet->pts);
  }
  std::sort(shown.begin(), shown.end());
  if (shown.empty() || std::adjacent_find(shown.begin(), shown.end()) != shown.end()) return std::nullopt;
  return shown;
}

}  // namespace

std::vector<double> VideoFrameTimes(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error) || IsImageName(path)) return {};
  std::vector<double> times;
  VideoPackets packets(path);
  if (const auto timestamps = PacketTimestamps(&packets)) {
    FrameClock clock = ClockOf(packets);
    for (const int64_t timestamp : *timestamps) times.push_back(clock.Next(timestamp));
    return times;
  }
  FrameDecoder decoder(path);
  while (decoder.Next()) times.push_back(decoder.time());
  if (times.empty()) throw std::runtime_error(path + ": the video holds no frame that can be decoded");
  return times;
}

}  // namespace bodyloom
