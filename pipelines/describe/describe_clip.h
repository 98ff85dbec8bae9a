// SPDX-License-Identifier: Apache-2.0
/// Writes a track's surface motion as UV maps of normals and velocities (data_tools/descriptors/describe_track.h).
#pragma once

#include <cstddef>
#include <string>

#include "data_tools/descriptors/describe_track.h"
#include "geometry/base/callbacks.h"
#include "geometry/uv_maps/descriptor_options.h"

namespace bodyloom {

struct DescribeClipRequest {
  std::string track;    ///< .npz
  std::string body;     ///< the track's body; empty: the built-in one
  std::string cameras;  ///< camera file with the pose for SurfaceFrame::kWorld; empty: a level camera, y up
  std::string view;     ///< the camera's name in it
  std::string out;      ///< the maps, .npy (and .json beside it)
  std::string preview;  ///< a sheet of a few frames, .png; empty: none
  std::string json;     ///< ToJson(DescribeClipReport); empty: none
  /// camera_pose and preview_frames are set by DescribeClip.
  DescribeTrackOptions options;
};

struct DescribeClipReport {
  DescribeTrackSummary summary;
  DescribeTrackOptions options;  ///< as used
  std::string out;               ///< the maps
  double total_seconds = 0;
  size_t peak_memory_bytes = 0;
};

/// Describes every frame of the track and writes the maps, their header, and the other requested files. Throws
/// RequestError for contradictory options, std::runtime_error naming a file that cannot be used or a track of another
/// body, and Cancelled; no files are left then.
DescribeClipReport DescribeClip(const DescribeClipRequest& request, const PipelineCallbacks& callbacks = {});

/// Counts, times and memory: several lines of text ending in a newline.
std::string ToText(const DescribeClipReport& report);
/// The same as one JSON object.
std::string ToJson(const DescribeClipReport& report);

/// Sets the camera's pose for SurfaceFrame::kWorld: that of `view` in the camera file; without one, that of the world
/// in the file `track` (geometry/scene/world_frame.h), or a level camera if neither gives one. Other frames need no
/// pose. Throws RequestError for a camera file given with other frames, std::runtime_error for one that cannot be used.
void SetAxesPose(const std::string& cameras, const std::string& view, const std::string& track, SurfaceMotion* motion);

}  // namespace bodyloom
