// SPDX-License-Identifier: Apache-2.0
/// Everybody in a video, in memory: frames are decoded by one thread while people are detected by others.
#pragma once

#include <string>
#include <vector>

#include "data_tools/observations/people.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/callbacks.h"
#include "geometry/scene/observations.h"
#include "render/image/image.h"
#include "tracking/detection/frame_detector.h"

namespace bodyloom {

// The frames of a span of a video, one after the other, each with the second at which it is shown.

struct FrameSpan {
  double fps = 0;                ///< of a folder of images, or a video that does not say; 0: 30
  double from_s = 0, to_s = -1;  ///< seconds from the first frame, both included; to_s < 0: to the end
};

class FrameSource {
 public:
  /// Throws RequestError for a span that holds no frame, std::runtime_error naming a video that cannot be read.
  FrameSource(const std::string& video, const FrameSpan& span);

  [[nodiscard]] const VideoInfo& info() const { return reader_.info(); }
  /// About how many frames there are; 0 when the video does not say how long it is.
  [[nodiscard]] int num_frames() const;
  /// Frames a second: the video's, else the span's, else 30.
  [[nodiscard]] double fps() const { return fps_; }
  /// False at the end. Another thread may read than made the source, one at a time.
  bool Read(Image* frame, double* time_s);
  /// What was wrong with the video; not while another thread reads.
  [[nodiscard]] std::string warning() const { return reader_.warning(); }

 private:
  VideoReader reader_;
  bool has_clock_;  ///< a folder of images has none
  bool at_end_ = false;
  double to_s_, fps_;
  int first_ = 0;
};

struct DetectPeopleRequest {
  std::string video;  ///< the video, or a folder of images
  FrameSpan span;
  FrameDetectorOptions detector;
  /// Frames a second that are detected while everybody moves slowly; those between are filled in (FillBetween()),
  /// without masks. 0: all.
  double detect_rate = 0;
};

struct DetectedClip {
  PeopleSequence people;                         ///< the detector's convention; identities −1
  std::vector<std::vector<PackedLabels>> masks;  ///< [frame][person as in people.frames]; empty unless asked for
  PeopleDetectorSummary detector;
};

/// Throws RequestError when the ONNX files of a detector contradict each other or are not there.
void RequirePoseModels(const FrameDetectorOptions& detector);

/// Throws std::runtime_error naming a file that cannot be used, RequestError for a span that holds no frame, Cancelled.
DetectedClip DetectPeople(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks = {});

/// One of the clip's people (PersonOf()) as a mask; frames without that person are empty. Throws std::invalid_argument
/// when the clip has no masks.
PartLabelSequence MaskOfPerson(const DetectedClip& clip, const PersonTrack& person);

}  // namespace bodyloom
