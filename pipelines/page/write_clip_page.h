// SPDX-License-Identifier: Apache-2.0
/// Writes the page of a clip (clip_page.h) from tracks and the video they were estimated from.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data_tools/observations/load_cameras.h"
#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/rig.h"
#include "geometry/scene/track.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// A person on the page. Pointers are borrowed; those marked so may be null.
struct PersonOnPage {
  int number = 0;  ///< number in the names "person_0" of the person and its files
  const BodyModel* body = nullptr;
  const Track* track = nullptr;
  const TrackSequenceSummary* summary = nullptr;  ///< may be null: no residuals, no plan
  std::string track_file;                         ///< offered for download; empty: not
};

/// A further camera of the scene.
struct ViewOnPage {
  RigCamera camera;  ///< name, intrinsics, pose relative to the tracks' camera, and clock
  std::string video;
  Matrix2x3d video_px_from_camera_px = NamedCamera().video_px_from_camera_px;
  VideoPlayback playback;  ///< of that video
};

struct ClipPageRequest {
  std::string out;                   ///< .html
  std::vector<PersonOnPage> people;  ///< tracks of one camera and one clock
  std::string video;                 ///< shown beside the bodies; empty: none
  int video_offset = 0;              ///< video frame of the tracks' time zero
  Matrix2x3d video_px_from_camera_px = NamedCamera().video_px_from_camera_px;
  std::string view_name;          ///< of the tracks' camera, where there are further ones
  std::vector<ViewOnPage> views;  ///< further ones
  std::string title;
  std::string summary;  ///< lines that the page shows
  int correctives = 8;  ///< shapes for pose correctives in the scene, 0 to 64
};

/// Maximum longer side of the page's video, pixels: one minute takes about 10 MB.
inline constexpr int kPageVideoPx = 640;

/// Bodies are textured from the video: from at most this many of its frames, spread over the clip, in a texture of
/// kPageTextureTexels a side.
inline constexpr int kPageTextureImages = 60;
inline constexpr int kPageTextureTexels = 512;

/// Writes the page, whole or not at all. Frames of two tracks are simultaneous if their timestamps are equal. A track
/// that .bvh cannot represent (lost frames, uneven times) has no such file. The stage is "report". Throws
/// std::invalid_argument without people or when a track does not fit its body, std::runtime_error for files that cannot
/// be read or written, and Cancelled.
void WriteClipPage(const ClipPageRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
