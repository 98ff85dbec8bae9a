// SPDX-License-Identifier: Apache-2.0
/// Writes the motion descriptor of every frame of a track (contents: descriptor_frames.h) to a file.
///
/// Each velocity map is baked once and written `past` times (skippable skip: reuse_past). Frames without a fit are
/// listed.
///
/// Files: OUT.npy, float32 or float16, frames × channels × height × width, to be memory-mapped; OUT.json beside it
/// describes the contents (keys: docs/descriptors.md). Both are written atomically.
///
/// Memory does not grow with the length of the clip: 32 frames are processed at a time. Same bytes for any number of
/// threads.
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
  int every = 1;      ///< describes frames 0, every, 2·every, …; velocities are still those of consecutive frames
  bool reuse_past = true;  ///< false: bakes all velocity maps of a frame again; same bytes, for comparison
  int preview_frames = 0;  ///< rows of the preview, 0: none
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct DescribeTrackSummary {
  int frames = 0;  ///< records written
  int channels = 0;
  std::vector<int> frames_without_fit;  ///< frames of the track
  int frames_without_velocity = 0;      ///< frames that are alone in their run
  int runs = 0;                         ///< gap-free runs of frames
  double noise_gain = 0;                ///< median over frames: m/s per metre of noise
  NormalSummary normals;
  int normal_texels_cancelled = 0;  ///< texels whose corners' normals cancelled out, over all frames
  UvTexelTable texels;              ///< with its counts
  int frames_skinned = 0, normal_maps = 0, velocity_maps = 0;  ///< numbers computed
  double mean_seen = 0;                                        ///< seen_only: share of visible texels, mean over frames
  size_t bytes = 0;                                            ///< of OUT.npy
  std::vector<std::pair<std::string, double>> seconds;         ///< by stage
  Image preview;
};

/// Called at intervals with the fraction done; may throw to stop (no files are left behind).
using DescribeProgress = std::function<void(double)>;

/// Throws std::runtime_error naming the file that cannot be written, std::invalid_argument when options are not valid,
/// the track does not fit the body, its timestamps do not increase (naming the frame), or the body has no UV map.
DescribeTrackSummary DescribeTrack(const BodyModel& body, const Track& track, const std::string& out_npy,
                                   const DescribeTrackOptions& options = {}, const DescribeProgress& progress = {});

/// Path of the header: out_npy with the extension .json.
std::string DescriptorHeaderPath(const std::string& out_npy);

// The JSON header beside a descriptor file, which describes its contents. Keys: docs/descriptors.md.

/// `outputs`: the track's frame of each record.
std::string DescriptorHeaderJson(const BodyModel& body, const Track& track, const DescribeTrackOptions& options,
                                 const DescribeTrackSummary& summary, const std::vector<int>& outputs);

}  // namespace bodyloom
