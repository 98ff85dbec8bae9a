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
      : reader_(request.video), from_s_(request.from_s), to_s_(request.to_s) {
    const double said = reader_.info().fps;
    fps_ = said > 0 ? said : request.fps > 0 ? request.fps : kUsualFps;
    const int first = int(std::ceil(from_s_ * fps_ - 1e-6));
    if (reader_.Skip(first) < first) {
      throw RequestError(Concatenate(request.video, ": ends before second ", from_s_, ", where the clip should begin"));
    }
  }

  [[nodiscard]] const VideoInfo& info() const { return reader_.info(); }
  /// 0 when the video does not say how long it is.
  [[nodiscard]] int num_frames() const {
    if (info().num_frames <= 0) return 0;
    const double end = to_s_ < 0 ? std::numeric_limits<double>::infinity() : std::floor(to_s_ * fps_ + 1e-6) + 1;
    return int(std::max(0.0, std::min<double>(info().num_frames, end) - std::ceil(from_s_ * fps_ - 1e-6)));
  }

  FrameGroup Next() {
    FrameGroup group;
    while (int(group.frames.size()) < PeopleDetector::kFramesAtOnce) {
      const double time = reader_.next_frame() / fps_;
      Image frame;
      if ((to_s_ >= 0 && time > to_s_ + 1e-6 / fps_) || !reader_.Read(&frame)) break;
      group.frames.push_back(std::move(frame));
      group.times.push_back(time);
    }
    return group;
  }

 private:
  VideoReader reader_;
  double from_s_, to_s_, fps_ = kUsualFps;
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
  clip.detector = detector.summary();
  clip.decode_wait_seconds = groups.waited_s();
  return clip;
}

PartLabelSequence MaskOfPerson(const DetectedClip& clip, int person) {
  const std::vector<PersonTrack> tracks = LinkPeople(clip.people);
  BODYLOOM_CHECK(clip.masks.size() == clip.people.frames.size(), "the clip was detected without masks");
  BODYLOOM_CHECK(person >= 0 && person < int(tracks.size()), "person ", person, " of ", tracks.size());
  PartLabelSequence mask;
  mask.frames.resize(clip.masks.size());
  mask.timestamps = clip.people.timestamps;
  mask.image_width = clip.people.image_width;
  mask.image_height = clip.people.image_height;
  for (const auto& [frame, index] : tracks[size_t(person)].detections) {
    mask.frames[size_t(frame)] = clip.masks[size_t(frame)][size_t(index)];
  }
  mask.AsMask();
  return mask;
}

}  // namespace bodyloom
