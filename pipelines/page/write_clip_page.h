// SPDX-License-Identifier: Apache-2.0
/// The page of a clip (clip_page.h) from tracks and the video they were made from.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data_tools/observations/load_cameras.h"
#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// Somebody to be shown. Pointers are borrowed; those marked so may be null.
struct PersonOnPage {
  int number = 0;  ///< the person is called "person_0", and so are the files that the page gives away
  const BodyModel* body = nullptr;
  const Track* track = nullptr;
  const TrackSequenceSummary* summary = nullptr;  ///< may be null: no residuals, no plan
  std::string track_file;                         ///< given away by the page; empty: not
};

struct ClipPageRequest {
  std::string out;                   ///< .html
  std::vector<PersonOnPage> people;  ///< tracks of one camera and one clock
  std::string video;                 ///< beside the bodies; empty: none
  int video_offset = 0;              ///< video frame of the tracks' time zero
  Matrix2x3d video_px_from_camera_px = NamedCamera().video_px_from_camera_px;
  std::string title;
  std::string summary;  ///< lines that the page shows
  int correctives = 8;  ///< shapes for pose correctives in the scene, 0 to 64
};

/// The longer side of the page's video at most, pixels: a minute of it then takes some 10 MB.
inline constexpr int kPageVideoPx = 640;

/// Bodies wear what the video shows of them: colours of this many pictures at most, spread over the clip, in a texture
/// of kPageTextureTexels a side.
inline constexpr int kPageTexturePictures = 60;
inline constexpr int kPageTextureTexels = 512;

/// Writes the page, whole or not at all. Frames of two tracks are the same moment when their timestamps are equal. What
/// a .bvh cannot say (lost frames, uneven time) has none among its files. Progress is told as "report". Throws
/// std::invalid_argument when nobody is given or a track does not fit its body, std::runtime_error for files that
/// cannot be read or written, and Cancelled.
void WriteClipPage(const ClipPageRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
