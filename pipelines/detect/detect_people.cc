// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/detect/detect_people.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "bodyloom/data_tools/detection/landmark_confidence.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/prefetcher.h"

namespace bodyloom {
namespace {

/// Groups of frames that are decoded ahead of the detection: a few, as a frame of a large video takes 25 MB.
constexpr size_t kGroupsAhead = 2;

/// Frames that are detected together, and when they are shown; none at the end of the clip.
struct FrameGroup {
  std::vector<Image> frames;
  std::vector<double> times;
};

/// The next frames, as many as are detected together.
FrameGroup NextGroup(FrameSource* source) {
  FrameGroup group;
  while (int(group.frames.size()) < PeopleDetector::kFramesAtOnce) {
    Image frame;
    double time = 0;
    if (!source->Read(&frame, &time)) break;
    group.frames.push_back(std::move(frame));
    group.times.push_back(time);
  }
  return group;
}

DetectedPerson ToPerson(const DetectedPose& pose) {
  DetectedPerson person;
  for (const PoseLandmark& landmark : pose.landmarks) {
    person.points.push_back(
        {float(landmark.pixel.x()), float(landmark.pixel.y()), float(LandmarkConfidence(landmark))});
  }
  return person;
}

}  // namespace

DetectedClip DetectPeople(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks) {
  FrameSource source(request.video, request.span);
  PeopleDetector detector(request.models, request.detector);
  DetectedClip clip;
  clip.people.convention = MediaPipe33();
  clip.people.image_width = source.info().width;
  clip.people.image_height = source.info().height;
  const int num_frames = source.num_frames();
  // Decoding is endless as far as the prefetcher knows: an empty group is the end.
  Prefetcher<FrameGroup> groups(
      std::numeric_limits<int64_t>::max(), [&](int64_t) { return NextGroup(&source); }, kGroupsAhead);
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
    throw RequestError(Concatenate(request.video, ": no frame from second ", request.span.from_s, " on"));
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
