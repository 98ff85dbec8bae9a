// SPDX-License-Identifier: Apache-2.0
/// Detects everybody in a video, in memory: one thread decodes frames while others detect people.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data_tools/observations/people.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/callbacks.h"
#include "geometry/scene/background_tracks.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"
#include "render/image/image.h"
#include "tracking/detection/background_tracker.h"
#include "tracking/detection/frame_detector.h"
#include "tracking/detection/line_segments.h"

namespace bodyloom {

// Source of the frames of a video's span in order, with their times in seconds.

struct FrameSpan {
  double fps = 0;                ///< for a folder of images or a video without a rate; 0: 30
  double from_s = 0, to_s = -1;  ///< seconds of the video from its first frame, both included; to_s < 0: to the end
  int turn_deg = 0;              ///< frames are turned clockwise by 0, 90, 180 or 270 degrees
  double captured_fps = 0;       ///< rate at which slow motion was filmed, which times then follow; 0: as it is played
};

class FrameSource {
 public:
  /// Throws RequestError for a span that holds no frame, std::runtime_error naming a video that cannot be read.
  FrameSource(const std::string& video, const FrameSpan& span);

  [[nodiscard]] const VideoInfo& info() const { return reader_.info(); }
  /// Approximate number of frames; 0 if the video's length is unknown.
  [[nodiscard]] int num_frames() const;
  /// Frame rate: that of the capture, else the video's, else the span's, else 30.
  [[nodiscard]] double fps() const { return played_fps_ * playback_.slowdown; }
  [[nodiscard]] const VideoPlayback& playback() const { return playback_; }
  /// Reads the next frame; returns false at the end. May be called by any one thread at a time.
  bool Read(Image* frame, double* time_s);
  /// Warning about the video; must not be called while another thread reads.
  [[nodiscard]] std::string warning() const { return reader_.warning(); }
  /// Changes made to the frames (VideoReader::note()); the same.
  [[nodiscard]] std::string note() const { return reader_.note(); }

 private:
  VideoReader reader_;
  bool has_clock_;  ///< false for a folder of images
  bool at_end_ = false;
  VideoPlayback playback_;
  double to_s_;        ///< on the video's clock
  double played_fps_;  ///< PlayedFps()
  int first_ = 0;
};

struct DetectPeopleRequest {
  std::string video;  ///< the video, or a folder of images
  FrameSpan span;
  FrameDetectorOptions detector;
  /// Detection rate while everybody moves slowly, frames per second; other frames are interpolated (FillBetween()),
  /// without masks. 0: all frames.
  double detect_rate = 0;
  /// Masks, hands and faces are due in so many frames a second of those that are detected; 0: in all. Other frames have
  /// masks only if `all_masks` says so, or where they are kept as samples.
  double part_rate = 0;
  bool all_masks = false;
  bool keep_samples = false;       ///< DetectedClip::samples
  bool follow_background = false;  ///< DetectedClip::background
};

struct DetectedClip {
  VideoInfo video;                               ///< of the turned frames
  PeopleSequence people;                         ///< the detector's convention; identities −1
  std::vector<std::vector<PackedLabels>> masks;  ///< [frame][person as in people.frames]; empty unless asked for
  std::vector<char> parts_are_due;               ///< [frame], 1 or 0: DetectPeopleRequest::part_rate
  PeopleDetectorSummary detector;
  FrameSamples samples;  ///< of the video, for the lines of the room; empty unless asked for
  /// Of the frames in which people were detected, for the camera's motion; empty unless asked for.
  BackgroundTracks background;
};

/// The rectangle of landmarks that are seen, moved by `map`, with 15 % of its longer side around it: head, hands and
/// feet reach beyond.
CoveredRegion CoveredByPoints(std::span<const Keypoint> points, const Matrix2x3d& map);

/// Throws RequestError when the detector's ONNX files contradict each other or are missing.
void RequirePoseModels(const FrameDetectorOptions& detector);

/// Detects people in all frames. If BlazePose finds nobody in any of them, it searches once more in its finest squares
/// (PeopleDetectorOptions::tile_levels 8), which shows people of 1/28 of the longer side. Throws std::runtime_error
/// naming a file that cannot be used, RequestError for an empty span, Cancelled.
DetectedClip DetectPeople(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks = {});

/// Mask of one of the clip's people (PersonOf()); empty in frames without that person. Throws std::invalid_argument
/// when the clip has no masks.
PartLabelSequence MaskOfPerson(const DetectedClip& clip, const PersonTrack& person);

}  // namespace bodyloom
