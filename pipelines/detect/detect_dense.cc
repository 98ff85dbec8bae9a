// SPDX-License-Identifier: Apache-2.0
#include "pipelines/detect/detect_dense.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/prefetcher.h"
#include "tracking/detection/frame_detector.h"

namespace bodyloom {
namespace {

constexpr size_t kImagesAhead = 2;

/// A detection without its maps: its box, and the keypoints sampled from it.
struct FoundCharts {
  ChartDetection box;
  std::vector<DenseKeypoint> points;
};

/// Everybody's, frame by frame.
struct FoundClip {
  std::vector<std::vector<FoundCharts>> frames;
  std::vector<double> timestamps;
  int width = 0, height = 0;
};

struct TimedImage {
  Image image;
  double time_s = 0;
};

FoundClip FindCharts(const DetectDenseRequest& request, const ChartDetector& detector, const BodyModel& body,
                     const PipelineCallbacks& callbacks) {
  const ChartLookup charts(body);
  FrameSource source(request.video, request.span);
  FoundClip clip;
  clip.width = source.info().width;
  clip.height = source.info().height;
  const int num_frames = source.num_frames();
  // The prefetcher has no notion of an end, so an empty image marks it.
  Prefetcher<TimedImage> frames(
      std::numeric_limits<int64_t>::max(),
      [&](int64_t) {
        TimedImage frame;
        if (!source.Read(&frame.image, &frame.time_s)) frame.image = Image();
        return frame;
      },
      kImagesAhead);
  for (TimedImage frame = frames.Take(); !frame.image.empty(); frame = frames.Take()) {
    std::vector<FoundCharts>& found = clip.frames.emplace_back();
    for (ChartDetection& detection : detector(frame.image)) {
      std::vector<DenseKeypoint> points = IuvToDense(detection.charts, charts, request.sampling);
      detection.charts = {};
      if (!points.empty()) found.push_back({std::move(detection), std::move(points)});
    }
    clip.timestamps.push_back(frame.time_s);
    callbacks.Update("dense keypoints", num_frames > 0 ? std::min(1.0, clip.frames.size() / double(num_frames)) : 0);
  }
  if (clip.frames.empty()) {
    throw RequestError(Concatenate(request.video, ": no frame from second ", request.span.from_s, " on"));
  }
  // The video's end has been taken, so the other thread reads no more of it.
  if (const std::string warning = source.warning(); !warning.empty()) callbacks.Message(warning);
  return clip;
}

/// The boxes as people of two landmarks, their corners, so that LinkPeople joins them.
PeopleSequence BoxesAsPeople(const FoundClip& clip) {
  PeopleSequence people;
  people.convention = {"box", {"box_top_left", "box_bottom_right"}};
  people.timestamps = clip.timestamps;
  people.image_width = clip.width;
  people.image_height = clip.height;
  for (const auto& frame : clip.frames) {
    std::vector<DetectedPerson>& boxes = people.frames.emplace_back();
    for (const FoundCharts& found : frame) {
      const ChartDetection& box = found.box;
      const auto confidence = float(std::clamp(box.score, 1e-3, 1.0));
      boxes.push_back({{{float(box.x0), float(box.y0), confidence}, {float(box.x1), float(box.y1), confidence}}});
    }
  }
  return people;
}

ChartDetection RectangleOf(const DetectedPerson& person) {
  const ImageRectangle r = VisibleRectangle(person);
  return {r.x0, r.y0, r.x1, r.y1, 1, {}};
}

/// Intersection over union; 0 when either is empty.
double Overlap(const ChartDetection& a, const ChartDetection& b) {
  const auto area = [](const ChartDetection& box) { return (box.x1 - box.x0) * (box.y1 - box.y0); };
  const double width = std::min(a.x1, b.x1) - std::max(a.x0, b.x0);
  const double height = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
  if (!(width > 0 && height > 0)) return 0;
  return width * height / (area(a) + area(b) - width * height);
}

/// Of a frame's detections the one that overlaps `chosen` most and nobody else more; −1 when there is none.
int DetectionOf(size_t chosen, const std::vector<DetectedPerson>& people, const std::vector<FoundCharts>& found) {
  int best = -1;
  double maximum = 0;
  for (size_t d = 0; d < found.size(); ++d) {
    std::vector<double> overlaps;
    overlaps.reserve(people.size());
    for (const DetectedPerson& person : people) overlaps.push_back(Overlap(RectangleOf(person), found[d].box));
    const bool is_theirs = overlaps[chosen] == *std::max_element(overlaps.begin(), overlaps.end());
    if (is_theirs && overlaps[chosen] > maximum) maximum = overlaps[chosen], best = int(d);
  }
  return best;
}

}  // namespace

DetectedDense DetectDense(const DetectDenseRequest& request, const ChartDetector& detector, const BodyModel& body,
                          const PeopleSequence* landmarks, const PipelineCallbacks& callbacks) {
  FoundClip clip = FindCharts(request, detector, body, callbacks);
  BODYLOOM_CHECK(landmarks == nullptr || landmarks->timestamps == clip.timestamps,
                 "DetectDense: ", landmarks == nullptr ? 0 : landmarks->timestamps.size(), " frames of landmarks, ",
                 clip.timestamps.size(), " of the video");
  const PeopleSequence boxes = BoxesAsPeople(clip);
  const PeopleSequence& people = landmarks != nullptr ? *landmarks : boxes;
  const PersonTrack person = PersonOf(people, request.person, request.video);

  DetectedDense result;
  result.people = int(LinkPeople(people).size());
  result.dense.frames.resize(clip.frames.size());
  result.dense.timestamps = clip.timestamps;
  result.dense.image_width = clip.width;
  result.dense.image_height = clip.height;
  result.dense.uv_sigma = kDensePoseUvSigma;
  result.dense.pixel_sigma_px = kPixelWidthSigma;
  for (const auto& [t, index] : person.detections) {
    std::vector<FoundCharts>& found = clip.frames[size_t(t)];
    const int d = landmarks != nullptr ? DetectionOf(size_t(index), landmarks->frames[size_t(t)], found) : index;
    if (d < 0) continue;
    result.dense.frames[size_t(t)] = std::move(found[size_t(d)].points);
    ++result.frames_seen;
  }
  if (result.frames_seen == 0) {
    throw std::runtime_error(Concatenate(request.video, ": the dense detector did not see person ", request.person,
                                         " in any of ", clip.frames.size(), " frames"));
  }
  return result;
}

}  // namespace bodyloom
