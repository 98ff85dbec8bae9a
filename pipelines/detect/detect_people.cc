// SPDX-License-Identifier: Apache-2.0
#include "pipelines/detect/detect_people.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "data_tools/observations/load_cameras.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"
#include "geometry/base/prefetcher.h"
#include "geometry/base/rate_gate.h"
#include "pipelines/files.h"
#include "pipelines/video/track_video.h"
#include "tracking/detection/people_between.h"

namespace bodyloom {
namespace {

/// Frames that are decoded ahead of the detection: a few, as one of a large video takes 25 MB.
constexpr size_t kFramesAhead = 4;

/// Below this many frames a second, frames are detected one by one: the second of two is looked at where the person was
/// before the first, and people move farther between such frames (7.3 px instead of 6.9 in the clip of tests/pipelines/
/// detect/original_smoothing_test.cc, 5 frames a second).
constexpr double kSlowFps = 15;

/// Whoever goes at most this share of their height between two detected frames moves slowly: a smooth motion leaves the
/// straight line between them by at most an eighth of that, 0.4 %, where the detector errs by 1.5 %.
constexpr double kSlowStep = 0.03;

struct TimedFrame {
  Image image;  ///< empty at the end of the clip
  double time_s = 0;
};

TimedFrame NextFrame(FrameSource* source) {
  TimedFrame frame;
  if (!source->Read(&frame.image, &frame.time_s)) frame.image = {};
  return frame;
}

/// Detects the frames of a clip that are due, a few side by side.
class ClipDetector {
 public:
  ClipDetector(const DetectPeopleRequest& request, double fps, DetectedClip* clip)
      : detector_(MakeFrameDetector(request.detector)),
        rate_(request.detect_rate),
        maximum_((rate_ > 0 ? std::min(rate_, fps) : fps) < kSlowFps ? 1 : FrameDetector::kFramesAtOnce),
        with_masks_(request.detector.blazepose.masks),
        all_masks_(request.all_masks),
        part_gate_(request.part_rate),
        clip_(clip) {
    clip->people.convention = detector_->convention();
    if (request.follow_background) background_.emplace();
  }

  /// needs_mask: in any case, if there are masks.
  void Add(TimedFrame frame, bool needs_mask) {
    clip_->people.frames.emplace_back();
    clip_->people.timestamps.push_back(frame.time_s);
    if (with_masks_) clip_->masks.emplace_back();
    const bool is_due = rate_ <= 0 || !is_slow_ || frame.time_s > due_s_ - 1e-6;
    detected_.push_back(is_due ? 1 : 0);
    if (!is_due) {
      skipped_ = std::move(frame.image);
      clip_->parts_are_due.push_back(0);
      return;
    }
    skipped_ = {};
    due_s_ = rate_ > 0 ? frame.time_s + 1 / rate_ : frame.time_s;
    clip_->parts_are_due.push_back(part_gate_.Passes(frame.time_s) ? 1 : 0);
    Take(std::move(frame.image), needs_mask);
    if (int(waiting_.size()) == maximum_) Detect();
  }

  /// After the last frame, which is detected in any case.
  void Finish() {
    if (!skipped_.empty()) {
      detected_.back() = 1;
      clip_->parts_are_due.back() = 1;
      Take(std::move(skipped_), false);
    }
    if (!waiting_.empty()) Detect();
    if (rate_ > 0) FillBetween(detected_, &clip_->people);
    for (size_t t = 0; t < clip_->masks.size(); ++t) clip_->masks[t].resize(clip_->people.frames[t].size());
    clip_->detector = detector_->summary();
    if (background_) clip_->background = background_->Finish();
  }

 private:
  void Take(Image image, bool needs_mask) {
    waiting_.push_back(std::move(image));
    const bool is_due = clip_->parts_are_due.back() != 0;
    waiting_parts_.push_back({.mask = needs_mask || all_masks_ || is_due, .hands_and_faces = is_due});
    places_.push_back(detected_.size() - 1);
  }

  void Detect() {
    std::vector<std::vector<FramePerson>> found = detector_->Detect(waiting_, waiting_parts_);
    for (size_t i = 0; i < found.size(); ++i) {
      const size_t place = places_[i];
      std::vector<CoveredRegion> covered;
      for (FramePerson& person : found[i]) {
        if (background_) {
          covered.push_back(CoveredByPoints(person.person.points, NamedCamera().video_px_from_camera_px));
          covered.back().mask = person.mask;
        }
        clip_->people.frames[place].push_back(std::move(person.person));
        if (with_masks_) clip_->masks[place].emplace_back(person.mask);
      }
      if (background_) background_->Push(waiting_[i], clip_->people.timestamps[place], covered);
      if (rate_ > 0) SeeHowFast(place);
    }
    waiting_.clear();
    waiting_parts_.clear();
    places_.clear();
  }

  void SeeHowFast(size_t place) {
    const PeopleSequence& people = clip_->people;
    if (last_) {
      const double seconds = people.timestamps[place] - people.timestamps[*last_];
      is_slow_ = LargestStep(people.frames[*last_], people.frames[place]) / (seconds * rate_) <= kSlowStep;
    }
    last_ = place;
  }

  std::unique_ptr<FrameDetector> detector_;
  double rate_;
  int maximum_;
  bool with_masks_, all_masks_;
  RateGate part_gate_;
  DetectedClip* clip_;
  std::optional<BackgroundTracker> background_;
  std::vector<char> detected_;
  std::vector<Image> waiting_;
  std::vector<FrameParts> waiting_parts_;
  std::vector<size_t> places_;  ///< of those waiting
  Image skipped_;               ///< the latest frame, when it was not due
  double due_s_ = 0;
  bool is_slow_ = false;
  std::optional<size_t> last_;  ///< the latest frame that was detected
};

}  // namespace

CoveredRegion CoveredByPoints(std::span<const Keypoint> points, const Matrix2x3d& map) {
  constexpr double kAroundPoints = 0.15;
  constexpr float kSurePoint = 0.1F;
  Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const Keypoint& point : points) {
    if (!(point.confidence > kSurePoint)) continue;
    const Eigen::Array2d at = (map * Eigen::Vector3d(point.x, point.y, 1)).array();
    low = low.min(at);
    high = high.max(at);
  }
  CoveredRegion region;
  if (!(low <= high).all()) {
    region.x1 = region.y1 = -1;
    return region;
  }
  const double margin = kAroundPoints * (high - low).maxCoeff();
  region.x0 = low.x() - margin, region.y0 = low.y() - margin;
  region.x1 = high.x() + margin, region.y1 = high.y() + margin;
  return region;
}

void RequirePoseModels(const FrameDetectorOptions& detector) {
  if (!detector.box_model.empty() && detector.pose_model.empty()) {
    throw RequestError("--box-model finds people for RTMPose: give --pose-model");
  }
  if (!detector.pose_model.empty() && detector.hands_and_faces == HandsAndFaceChoice::kOn) {
    throw RequestError("--hands on finds them by way of BlazePose's landmarks: leave it out with --pose-model");
  }
  RequireReadable(detector.pose_model, "pose model");
  RequireReadable(detector.box_model, "box model");
}

namespace {

DetectedClip DetectOnce(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks) {
  if (!(request.detect_rate >= 0)) {
    throw RequestError(Concatenate("frames to detect a second: ", request.detect_rate, ", expected a positive number"));
  }
  FrameSource source(request.video, request.span);
  DetectedClip clip;
  clip.video = source.info();
  clip.people.image_width = source.info().width;
  clip.people.image_height = source.info().height;
  const int num_frames = source.num_frames();
  ClipDetector detector(request, source.fps(), &clip);
  // The prefetcher has no notion of an end, so an empty image marks it.
  Prefetcher<TimedFrame> frames(
      std::numeric_limits<int64_t>::max(), [&](int64_t) { return NextFrame(&source); }, kFramesAhead);
  for (TimedFrame frame = frames.Take(); !frame.image.empty(); frame = frames.Take()) {
    const bool is_sample = request.keep_samples && clip.samples.Add(frame.image);
    detector.Add(std::move(frame), is_sample);
    callbacks.Update("detect", num_frames > 0 ? std::min(1.0, clip.people.frames.size() / double(num_frames)) : 0);
  }
  if (clip.people.frames.empty()) {
    throw RequestError(Concatenate(request.video, ": no frame from second ", request.span.from_s, " on"));
  }
  detector.Finish();
  // The video's end has been taken, so the other thread reads no more of it.
  for (const std::string& text : {source.note(), source.warning()}) {
    if (!text.empty()) callbacks.Message(text);
  }
  return clip;
}

bool ShowsNobody(const PeopleSequence& people) {
  return std::all_of(people.frames.begin(), people.frames.end(), [](const auto& frame) { return frame.empty(); });
}

}  // namespace

DetectedClip DetectPeople(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks) {
  constexpr int kFinestTiles = 8;
  DetectedClip clip = DetectOnce(request, callbacks);
  const bool can_search_finer =
      request.detector.pose_model.empty() && request.detector.blazepose.tile_levels < kFinestTiles;
  if (!ShowsNobody(clip.people) || !can_search_finer) return clip;
  callbacks.Message(request.video + ": nobody was found, looking for smaller people");
  DetectPeopleRequest finer = request;
  finer.detector.blazepose.tile_levels = kFinestTiles;
  return DetectOnce(finer, callbacks);
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

namespace {

constexpr double kSameTime = 1e-6;  ///< seconds

void CheckSpan(const FrameSpan& span) {
  if (!(span.from_s >= 0) || (span.to_s >= 0 && span.to_s < span.from_s)) {
    throw RequestError(Concatenate("the clip from second ", span.from_s, " to ", span.to_s,
                                   " holds no frame; expected 0 <= from <= to"));
  }
}

}  // namespace

FrameSource::FrameSource(const std::string& video, const FrameSpan& span)
    : reader_(video, span.turn_deg),
      has_clock_(!std::isnan(reader_.frame_time())),
      playback_(PlaybackOf(reader_.info(), span.turn_deg, span.captured_fps, span.fps)),
      to_s_(span.to_s),
      played_fps_(PlayedFps(reader_.info(), span.fps)) {
  CheckSpan(span);
  if (span.from_s > 0) {
    has_clock_ ? reader_.SkipTo(span.from_s) : reader_.Skip(int(std::ceil(span.from_s * played_fps_ - kSameTime)));
  }
  first_ = reader_.next_frame();
}

int FrameSource::num_frames() const {
  if (info().num_frames <= 0) return 0;
  const double end = to_s_ < 0 ? info().num_frames : std::min<double>(info().num_frames, to_s_ * played_fps_ + 1);
  return std::max(1, int(end) - first_);
}

bool FrameSource::Read(Image* frame, double* time_s) {
  at_end_ = at_end_ || !reader_.Read(frame);
  if (at_end_) return false;
  *time_s = has_clock_ ? reader_.frame_time() / playback_.slowdown : (reader_.next_frame() - 1) / fps();
  at_end_ = to_s_ >= 0 && *time_s * playback_.slowdown > to_s_ + kSameTime;
  return !at_end_;
}

}  // namespace bodyloom
