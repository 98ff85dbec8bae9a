// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/frame_detector.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "tracking/detection/keypoint_model.h"

namespace bodyloom {
namespace {

constexpr double kSmallestBox = 2;  ///< pixels a side

DetectedPerson ToPerson(const DetectedPose& pose) {
  DetectedPerson person;
  for (const PoseLandmark& landmark : pose.landmarks) {
    person.points.push_back(
        {float(landmark.pixel.x()), float(landmark.pixel.y()), float(LandmarkConfidence(landmark))});
  }
  return person;
}

class BlazePoseFrames : public FrameDetector {
 public:
  explicit BlazePoseFrames(const FrameDetectorOptions& options) : detector_(options.models, options.blazepose) {
    if (options.hands_and_faces.value_or(HandsAndFaceChoice::kOff) == HandsAndFaceChoice::kOff) return;
    HandsAndFaceOptions parts;
    parts.num_threads = options.blazepose.num_threads;
    if (options.hands_and_faces == HandsAndFaceChoice::kOn) parts.min_side_px = 0;
    try {
      hands_and_faces_.emplace(options.models, parts);
    } catch (const std::runtime_error& error) {
      if (options.hands_and_faces == HandsAndFaceChoice::kOn) throw;
      why_not_ = error.what();
    }
  }

  [[nodiscard]] const KeypointConvention& convention() const override { return MediaPipe33(); }

  std::vector<std::vector<FramePerson>> Detect(std::span<const Image> frames,
                                               std::span<const FrameParts> parts) override {
    std::vector<std::vector<FramePerson>> result;
    std::vector<char> with_mask;
    for (const FrameParts& frame : parts) with_mask.push_back(frame.mask ? 1 : 0);
    std::vector<std::vector<DetectedPose>> detected = detector_.Detect(frames, with_mask);
    for (std::vector<DetectedPose>& poses : detected) {
      std::vector<FramePerson>& people = result.emplace_back();
      for (DetectedPose& pose : poses) people.push_back({ToPerson(pose), std::move(pose.mask)});
    }
    // Frames that are to be looked at, one run of them after the other.
    for (size_t f = 0, end = 0; hands_and_faces_ && f < frames.size(); f = end) {
      const auto is_due = [&](size_t frame) { return parts.empty() || parts[frame].hands_and_faces; };
      for (end = f + 1; end < frames.size() && is_due(end) == is_due(f);) ++end;
      if (!is_due(f)) continue;
      auto found = hands_and_faces_->Detect(frames.subspan(f, end - f), std::span(detected).subspan(f, end - f));
      for (size_t k = 0; k < found.size(); ++k) {
        for (size_t i = 0; i < found[k].size(); ++i) result[f + k][i].person.hands_and_face = std::move(found[k][i]);
      }
    }
    return result;
  }

  [[nodiscard]] PeopleDetectorSummary summary() const override {
    PeopleDetectorSummary summary = detector_.summary();
    if (hands_and_faces_) summary.hands_and_faces = hands_and_faces_->summary();
    summary.hands_and_faces.why_not = why_not_;
    return summary;
  }

 private:
  PeopleDetector detector_;
  std::optional<HandsAndFaceDetector> hands_and_faces_;
  std::string why_not_;
};

/// At most so many, the first ones.
template <typename T>
void KeepFirst(int maximum, std::vector<T>* people) {
  if (maximum > 0 && int(people->size()) > maximum) people->erase(people->begin() + maximum, people->end());
}

class YoloPoseFrames : public FrameDetector {
 public:
  YoloPoseFrames(KeypointModel model, const PeopleDetectorOptions& options)
      : model_(std::move(model)), options_(options) {}

  [[nodiscard]] const KeypointConvention& convention() const override { return model_.convention(); }

  std::vector<std::vector<FramePerson>> Detect(std::span<const Image> frames,
                                               std::span<const FrameParts> /*parts*/) override {
    const Stopwatch watch;
    std::vector<std::vector<FramePerson>> result(frames.size());
    ParallelFor(int(frames.size()), options_.num_threads, [&](int i) {
      std::vector<YoloPerson> found = model_.FindPeople(frames[size_t(i)]);
      KeepFirst(options_.max_people, &found);
      for (YoloPerson& person : found) result[size_t(i)].push_back({{.points = std::move(person.points)}, {}});
    });
    summary_.frames += int(frames.size());
    summary_.regions += int(frames.size());
    summary_.landmark_seconds += watch.seconds();
    return result;
  }

  [[nodiscard]] PeopleDetectorSummary summary() const override { return summary_; }

 private:
  KeypointModel model_;
  PeopleDetectorOptions options_;
  PeopleDetectorSummary summary_;
};

class RtmPoseFrames : public FrameDetector {
 public:
  RtmPoseFrames(KeypointModel model, std::optional<KeypointModel> boxes, const FrameDetectorOptions& options)
      : model_(std::move(model)), boxes_(std::move(boxes)), options_(options.blazepose) {
    if (boxes_) return;
    try {
      blazepose_.emplace(options.models, options.blazepose);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(Concatenate(error.what(), "; or --box-model finds the people for ", model_.path()));
    }
  }

  [[nodiscard]] const KeypointConvention& convention() const override { return model_.convention(); }

  std::vector<std::vector<FramePerson>> Detect(std::span<const Image> frames,
                                               std::span<const FrameParts> /*parts*/) override {
    const std::vector<std::vector<PersonBox>> boxes = Boxes(frames);
    const Stopwatch watch;
    std::vector<std::vector<FramePerson>> result(frames.size());
    std::vector<std::pair<size_t, size_t>> all;  // frame, person
    for (size_t f = 0; f < frames.size(); ++f) {
      result[f].resize(boxes[f].size());
      for (size_t person = 0; person < boxes[f].size(); ++person) all.emplace_back(f, person);
    }
    ParallelFor(int(all.size()), options_.num_threads, [&](int i) {
      const auto [f, person] = all[size_t(i)];
      result[f][person].person.points = model_.PoseIn(frames[f], boxes[f][person]);
    });
    summary_.frames += int(frames.size());
    summary_.regions += int(all.size());
    summary_.landmark_seconds += watch.seconds();
    return result;
  }

  [[nodiscard]] PeopleDetectorSummary summary() const override {
    PeopleDetectorSummary summary = summary_;
    if (blazepose_) summary.searches = blazepose_->summary().searches;
    return summary;
  }

 private:
  std::vector<std::vector<PersonBox>> Boxes(std::span<const Image> frames) {
    const Stopwatch watch;
    std::vector<std::vector<PersonBox>> boxes(frames.size());
    if (boxes_) {
      ParallelFor(int(frames.size()), options_.num_threads, [&](int i) {
        for (const YoloPerson& person : boxes_->FindPeople(frames[size_t(i)])) boxes[size_t(i)].push_back(person.box);
      });
      summary_.searches += int(frames.size());
    } else {
      const std::vector<std::vector<DetectedPose>> poses = blazepose_->Detect(frames);
      for (size_t f = 0; f < frames.size(); ++f) {
        for (const DetectedPose& pose : poses[f]) {
          const ImageRectangle r = VisibleRectangle(ToPerson(pose));
          boxes[f].push_back({r.x0, r.y0, r.x1, r.y1, pose.presence});
        }
      }
    }
    for (std::vector<PersonBox>& people : boxes) {
      std::erase_if(people, [](const PersonBox& b) { return !(std::min(b.x1 - b.x0, b.y1 - b.y0) >= kSmallestBox); });
      KeepFirst(options_.max_people, &people);
    }
    summary_.search_seconds += watch.seconds();
    return boxes;
  }

  KeypointModel model_;
  std::optional<KeypointModel> boxes_;
  PeopleDetectorOptions options_;
  std::optional<PeopleDetector> blazepose_;
  PeopleDetectorSummary summary_;
};

}  // namespace

std::unique_ptr<FrameDetector> MakeFrameDetector(const FrameDetectorOptions& options) {
  BODYLOOM_CHECK(options.blazepose.IsValid(), "people detector: an option is outside its range");
  if (options.pose_model.empty()) {
    BODYLOOM_CHECK(options.box_model.empty(), options.box_model, ": finds people for RTMPose, which is not given");
    return std::make_unique<BlazePoseFrames>(options);
  }
  BODYLOOM_CHECK(options.hands_and_faces != HandsAndFaceChoice::kOn, options.pose_model,
                 ": hands and faces are found by way of BlazePose's landmarks");
  BODYLOOM_CHECK(!options.blazepose.masks, options.pose_model, ": a network of landmarks gives no masks");
  KeypointModel model(options.pose_model);
  if (model.family() == KeypointFamily::kYoloBoxes) {
    throw std::runtime_error(options.pose_model +
                             ": finds boxes alone, expected a network of 17, 23, 26, 133 or 136 landmarks");
  }
  if (model.family() == KeypointFamily::kYoloPose) {
    if (!options.box_model.empty()) {
      throw std::runtime_error(options.box_model + ": not needed, as " + options.pose_model + " finds people itself");
    }
    return std::make_unique<YoloPoseFrames>(std::move(model), options.blazepose);
  }
  std::optional<KeypointModel> boxes;
  if (!options.box_model.empty()) {
    boxes.emplace(options.box_model);
    if (boxes->family() == KeypointFamily::kRtmPose) {
      throw std::runtime_error(options.box_model +
                               ": is shown one person at a time, expected a network that finds them");
    }
  }
  return std::make_unique<RtmPoseFrames>(std::move(model), std::move(boxes), options);
}

std::string FrameDetectorName(const FrameDetectorOptions& options) {
  if (options.pose_model.empty()) return ToText(options.blazepose.network);
  return std::filesystem::path(options.pose_model).filename().string();
}

double LandmarkConfidence(const PoseLandmark& landmark) {
  return landmark.pixel.allFinite() ? std::clamp(landmark.visibility, 0.0, 1.0) : 0;
}

namespace {

constexpr float kVisible = 0.5F;

}  // namespace

ImageRectangle VisibleRectangle(const DetectedPerson& person) {
  const auto is_visible = [](const Keypoint& p) { return p.confidence >= kVisible; };
  const bool some = std::any_of(person.points.begin(), person.points.end(), is_visible);
  constexpr double kMaximum = std::numeric_limits<double>::max();
  ImageRectangle box = {kMaximum, kMaximum, -kMaximum, -kMaximum};
  for (const Keypoint& p : person.points) {
    if (some ? !is_visible(p) : !(p.confidence > 0)) continue;
    box.x0 = std::min(box.x0, double{p.x}), box.x1 = std::max(box.x1, double{p.x});
    box.y0 = std::min(box.y0, double{p.y}), box.y1 = std::max(box.y1, double{p.y});
  }
  return box;
}

}  // namespace bodyloom
