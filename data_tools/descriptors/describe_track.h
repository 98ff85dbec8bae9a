// SPDX-License-Identifier: Apache-2.0
/// The motion descriptor of every frame of a track (descriptor_frames.h says what it holds), streamed to a file.
///
/// Each velocity map is baked once and written `past` times (skippable skip: reuse_past). Frames without a fit are
/// listed.
///
/// Files: OUT.npy, float32 or float16, frames × channels × height × width, to be mapped into memory; OUT.json beside it
/// says what it holds (docs/descriptors.md lists the keys). Both are written whole or not at all.
///
/// Memory does not grow with the clip: 32 frames are in flight. Same bytes for any number of threads.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "render/image/image.h"
#include "render/uv_maps/descriptor_frames.h"

namespace bodyloom {

struct DescribeTrackOptions : DescriptorOptions {
  bool half = false;  ///< float16
  int every = 1;      ///< describes frames 0, every, 2·every, …; velocities are of consecutive frames all the same
  bool reuse_past = true;  ///< false: bakes all velocity maps of a frame again; same bytes, for comparison
  int preview_frames = 0;  ///< rows of the preview, 0: none
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct DescribeTrackSummary {
  int frames = 0;  ///< records written
  int channels = 0;
  std::vector<int> frames_without_fit;  ///< of the track
  int frames_without_velocity = 0;      ///< alone in their run
  int runs = 0;                         ///< gap-free runs of frames
  double noise_gain = 0;                ///< median over frames: m/s a metre of noise
  NormalSummary normals;
  int normal_texels_cancelled = 0;  ///< texels whose corners' normals cancelled out, over all frames
  UvTexelTable texels;              ///< with its counts
  int frames_skinned = 0, normal_maps = 0, velocity_maps = 0;  ///< what was computed
  double mean_seen = 0;                                        ///< seen_only: share of the texels, mean over frames
  size_t bytes = 0;                                            ///< of OUT.npy
  std::vector<std::pair<std::string, double>> seconds;         ///< by stage
  Image preview;
};

/// Called now and then with the share done; may throw to stop (nothing is left behind).
using DescribeProgress = std::function<void(double)>;

/// Throws std::runtime_error naming the file that cannot be written, std::invalid_argument when options are not valid,
/// the track is not this body's, its times do not grow (naming the frame), or the body has no UV map.
DescribeTrackSummary DescribeTrack(const BodyModel& body, const Track& track, const std::string& out_npy,
                                   const DescribeTrackOptions& options = {}, const DescribeProgress& progress = {});

/// The header's place: out_npy with .json for its extension.
std::string DescriptorHeaderPath(const std::string& out_npy);

// The header beside a descriptor file: what its numbers are, in JSON. Keys: docs/descriptors.md.

/// `outputs`: the track's frame of each record.
std::string DescriptorHeaderJson(const BodyModel& body, const Track& track, const DescribeTrackOptions& options,
                                 const DescribeTrackSummary& summary, const std::vector<int>& outputs);

}  // namespace bodyloom
