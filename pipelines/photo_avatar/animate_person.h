// SPDX-License-Identifier: Apache-2.0
/// Animates a person made from photos by any track; implements `bodyloom animate person`.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "pipelines/photo_avatar/make_photo_person.h"

namespace bodyloom {

/// A person given by photos or by a folder in which it was saved.
struct AnimatePersonRequest {
  PhotoPersonRequest photos;  ///< fit.body is the body of photos and track
  std::string person;         ///< a folder (person_folder.h) instead of photos; empty: photos
  std::string garment_from;   ///< photo or folder of a person whose clothes are worn; empty: own clothes
  std::string keep;           ///< folder to save the person in; empty: none
  std::string track;          ///< the motion, .npz; empty: the person is only made and saved
  /// Keeps the person's height from the photos in the driver's scene; false: the driver's height in the image.
  bool own_stature = false;
  std::string view_yaw;     ///< how far the view is turned (pipelines/animate/animation_limits.h)
  std::string freeze;       ///< frames shown repeatedly (pipelines/animate/animation_limits.h); empty: none
  std::string background;   ///< an image, a video or a folder behind the person; empty: a plain backdrop
  std::string relight;      ///< other light, a file (pipelines/animate/relight_frames.h); empty: the first photo's
  int size = 0;             ///< pixels of the image's longer side; 0: as the track's
  std::string out;          ///< the video to write, .mp4; empty: none
  std::string pictures;     ///< a folder for PNGs with transparency, 000000.png …; empty: none
  std::string moved_track;  ///< the motion with this person's body: a track for its body.npz, .npz; empty: none
  std::string json;         ///< a report; empty: none
  int threads = 0;          ///< 0: all cores
};

struct AnimatePersonSummary {
  PhotoPersonReport person;  ///< empty for a saved person
  int frames = 0, frames_without_fit = 0;
  int width = 0, height = 0;  ///< of the images
  double draw_ms = 0;         ///< posing and drawing a frame: mean of frames drawn together, median over these
  double first_frame_s = 0;   ///< time until the first frame was drawn
  StageSeconds seconds;
  double total_seconds = 0;
  std::vector<std::string> written;
};

/// Makes or reads the person and renders the motion. Throws RequestError for a contradictory request, NoPersonFound
/// naming a photo that shows nobody, std::runtime_error for files that cannot be used, Cancelled.
AnimatePersonSummary AnimatePerson(const AnimatePersonRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
