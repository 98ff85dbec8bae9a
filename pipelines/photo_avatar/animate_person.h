// SPDX-License-Identifier: Apache-2.0
/// Moves a person made from photos by any track: what `bodyloom animate person` does.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "pipelines/photo_avatar/make_photo_person.h"

namespace bodyloom {

/// Photos, or a folder in which a person was kept.
struct AnimatePersonRequest {
  PhotoPersonRequest photos;  ///< its fit.body is the body of photos and track alike
  std::string person;         ///< a folder (person_folder.h) in place of photos; empty: photos
  std::string garment_from;   ///< a photo, or a folder in which somebody was kept: whose clothes are worn; empty: own
  std::string keep;           ///< the folder to keep the person in; empty: none
  std::string track;          ///< the motion, .npz; empty: none, the person is only made and kept
  /// As tall in the driver's scene as the photos say, not as tall in the picture as the driver.
  bool own_stature = false;
  std::string view_yaw;     ///< how far the view is turned (pipelines/animate/animation_limits.h)
  std::string freeze;       ///< where time stands still (pipelines/animate/animation_limits.h); empty: nowhere
  std::string background;   ///< an image, a video or a folder behind the person; empty: a plain backdrop
  std::string relight;      ///< other light, a file (pipelines/animate/relight_frames.h); empty: the first photo's
  int size = 0;             ///< pixels of the picture's longer side; 0: as the track's
  std::string out;          ///< the video to write, .mp4; empty: none
  std::string pictures;     ///< a folder for PNGs with transparency, 000000.png …; empty: none
  std::string moved_track;  ///< the motion by this person: a track for its body.npz, .npz; empty: none
  std::string json;         ///< a report; empty: none
  int threads = 0;          ///< 0: all cores
};

struct AnimatePersonSummary {
  PhotoPersonReport person;  ///< empty for a person who was kept
  int frames = 0, frames_without_fit = 0;
  int width = 0, height = 0;  ///< of the pictures
  double draw_ms = 0;        ///< of posing and drawing a frame: of those drawn at once the mean, of them all the median
  double first_frame_s = 0;  ///< from the beginning until the first frame was drawn
  StageSeconds seconds;
  double total_seconds = 0;
  std::vector<std::string> written;
};

/// Throws RequestError for a request that contradicts itself, NothingToTrack naming a photo that shows nobody,
/// std::runtime_error for files that cannot be used, Cancelled.
AnimatePersonSummary AnimatePerson(const AnimatePersonRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
