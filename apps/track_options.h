// SPDX-License-Identifier: Apache-2.0
/// What `bodyloom track` can be asked, and the flags that ask it.
#pragma once

#include <optional>
#include <string>

#include "bodyloom/tracking/track_sequence.h"

namespace CLI {
class App;
}

namespace bodyloom {

struct TrackCommand {
  // What was seen.
  std::string detections;                ///< 2D joints (and dense keypoints, when the file holds both)
  std::string dense;                     ///< dense surface keypoints from a file or folder of their own
  std::optional<double> dense_uv_sigma;  ///< their noise on the surface, chart units; none: what their source says
  std::string part_labels;               ///< DensePose part of every pixel
  std::string view;                      ///< camera of a file that has several
  int person = 0;                        ///< 0: the largest and longest in view
  double fps = 0;                        ///< of detections that do not say; 0: the video's, else 30
  double min_confidence = 0;             ///< detections below count as missing
  std::string convention;                ///< OpenPose model, when it should not be detected

  // The camera.
  std::string cameras;                    ///< calibration file or folder
  std::string camera;                     ///< pinhole, unknown-focal or weak; empty: pinhole when intrinsics are given
  double focal_px = 0;                    ///< intrinsics without a file: centred, undistorted
  int image_width = 0, image_height = 0;  ///< when neither camera, video nor detections say

  // What else is known.
  std::string video;     ///< for the image size, the frame rate and the overlay
  int video_offset = 0;  ///< video frame of the detections' time zero
  std::string body, init, prior, lifter;

  // What is wanted.
  std::string out, overlay, json;
  std::string reference;  ///< a known true track, drawn beside the estimate in the side view
  bool side_view = false, plan = false, quiet = false;

  TrackSequenceOptions solve;
  std::optional<int> live_lag;  ///< frames; track as if the clip came from a camera (tracking/live/live_tracker.h)
};

/// Binds every field to its flag; defaults in --help are those of the struct.
void AddTrackOptions(CLI::App& app, TrackCommand* command);

/// Throws RequestError when options contradict each other or one is missing.
void CheckTrackOptions(const TrackCommand& command);

/// What --camera, --cameras and --focal say together.
CameraKnowledge CameraKnowledgeOf(const TrackCommand& command);

}  // namespace bodyloom
