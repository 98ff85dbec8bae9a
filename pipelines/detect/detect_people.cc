// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/detect/detect_people.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bodyloom/data_tools/detection/landmark_confidence.h"
#include "bodyloom/data_tools/video/video_reader.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/prefetcher.h"

namespace bodyloom {
namespace {

constexpr double kUsualFps = 30;
/// Groups of frames that are decoded ahead of the detection: a few, as a frame of a large video takes 25 MB.
constexpr size_t kGroupsAhead = 2;

/// Frames that are detected together, and when they are shown; none at the end of the clip.
struct FrameGroup {
  std::vector<Image> frames;
  std::vector<double> times;
};

/// The frames of the requested span, group by group.
class FrameSource {
 public:
  explicit FrameSource(const DetectPeopleRequest& request)
      : reader_(request.video), has_clock_(!std::isnan(reader_.frame_time())), to_s_(request.to_s) {
    const double fps = info().fps > 0 ? info().fps : request.fps;
    if (fps > 0) fps_ = fps;
    if (request.from_s > 0) {
      has_clock_ ? reader_.SkipTo(request.from_s) : reader_.Skip(int(std::ceil(request.from_s * fps_ - kSameTime)));
    }
    first_ = reader_.next_frame();
  }

  [[nodiscard]] const VideoInfo& info() const { return reader_.info(); }
  /// About how many frames there are; 0 when the video does not say how long it is.
  [[nodiscard]] int num_frames() const {
    if (info().num_frames <= 0) return 0;
    const double end = to_s_ < 0 ? info().num_frames : std::min<double>(info().num_frames, to_s_ * fps_ + 1);
    return std::max(1, int(end) - first_);
  }

  FrameGroup Next() {
    FrameGroup group;
    while (!at_end_ && int(group.frames.size()) < PeopleDetector::kFramesAtOnce) {
      Image frame;
      at_end_ = !reader_.Read(&frame);
      const double time = has_clock_ ? reader_.frame_time() : (reader_.next_frame() - 1) / fps_;
      at_end_ = at_end_ || (to_s_ >= 0 && time > to_s_ + kSameTime);
      if (at_end_) break;
      group.frames.push_back(std::move(frame));
      group.times.push_back(time);
    }
    return group;
  }

  /// What was wrong with the video; only between calls of Next().
  [[nodiscard]] std::string warning() const { return reader_.warning(); }

 private:
  static constexpr double kSameTime = 1e-6;  ///< seconds
  VideoReader reader_;
  bool has_clock_;  ///< a folder of images has none
  bool at_end_ = false;
  double to_s_, fps_ = kUsualFps;
  int first_ = 0;
};

DetectedPerson ToPerson(const DetectedPose& pose) {
  DetectedPerson person;
  for (const PoseLandmark& landmark : pose.landmarks) {
    person.points.push_back(
        {float(landmark.pixel.x()), float(landmark.pixel.y()), float(LandmarkConfidence(landmark))});
  }
  return person;
}

void CheckRequest(const DetectPeopleRequest& request) {
  if (!(request.from_s >= 0) || (request.to_s >= 0 && request.to_s < request.from_s)) {
    throw RequestError(Concatenate("the clip from second ", request.from_s, " to ", request.to_s,
                                   " holds no frame; expected 0 <= from <= to"));
  }
}

}  // namespace

DetectedClip DetectPeople(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks) {
  CheckRequest(request);
  FrameSource source(request);
  PeopleDetector detector(request.models, request.detector);
  DetectedClip clip;
  clip.people.convention = MediaPipe33();
  clip.people.image_width = source.info().width;
  clip.people.image_height = source.info().height;
  const int num_frames = source.num_frames();
  // Decoding is endless as far as the prefetcher knows: an empty group is the end.
  Prefetcher<FrameGroup> groups(
      std::numeric_limits<int64_t>::max(), [&](int64_t) { return source.Next(); }, kGroupsAhead);
  for (FrameGroup group = groups.Take(); !group.frames.empty(); group = groups.Take()) {
    for (std::vector<DetectedPose>& poses : detector.Detect(group.frames)) {
      std::vector<DetectedPerson>& people = clip.people.frames.emplace_back();
      std::vector<LabelImage> masks;
      for (DetectedPose& pose : poses) {
        people.push_back(ToPerson(pose));
        masks.push_back(std::move(pose.mask));
      }
      if (request.detector.masks) clip.masks.push_back(std::move(masks));
    }
    clip.people.timestamps.insert(clip.people.timestamps.end(), group.times.begin(), group.times.end());
    callbacks.Update("detect", num_frames > 0 ? std::min(1.0, clip.people.frames.size() / double(num_frames)) : 0);
  }
  if (clip.people.frames.empty()) {
    throw RequestError(Concatenate(request.video, ": no frame from second ", request.from_s, " on"));
  }
  // The video's end has been taken, so the other thread reads no more of it.
  if (const std::string warning = source.warning(); !warning.empty()) callbacks.Say(warning);
  clip.detector = detector.summary();
  return clip;
}

PartLabelSequence MaskOfPerson(const DetectedClip& clip, const PersonTrack& person) {
  BODYLOOM_CHECK(clip.masks.size() == clip.people.frames.size(), "the clip was detected without masks");
  PartLabelSequence mask;
  mask.frames.resize(clip.masks.size());
  mask.timestamps = clip.people.timestamps;
  mask.image_width = clip.people.image_width;
  mask.image_height = clip.people.image_height;
  for (const auto& [frame, index] : person.detections) {
    mask.frames[size_t(frame)] = clip.masks[size_t(frame)][size_t(index)];
  }
  mask.AsMask();
  return mask;
}

}  // namespace bodyloom
