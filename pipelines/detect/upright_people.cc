// SPDX-License-Identifier: Apache-2.0
#include "pipelines/detect/upright_people.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "data_tools/observations/keypoint_conventions.h"
#include "data_tools/video/frame_image.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kMaxFramesLookedAt = 12;
/// Frames are taken from so many at most, as the video is decoded up to the last of them.
constexpr int kMaxFramesDecoded = 600;
constexpr double kClearlyBetter = 1.5;

std::vector<Image> SpreadFrames(const DetectPeopleRequest& request) {
  FrameSpan span = request.span;
  span.turn_deg = 0;
  FrameSource source(request.video, span);
  const int num_frames = source.num_frames() > 0 ? std::min(source.num_frames(), kMaxFramesDecoded) : kMaxFramesDecoded;
  const int step = std::max(1, num_frames / kMaxFramesLookedAt);
  std::vector<Image> frames;
  Image image;
  double time_s = 0;
  for (int t = 0; t < num_frames && int(frames.size()) < kMaxFramesLookedAt && source.Read(&image, &time_s); ++t) {
    if (t % step == 0) frames.push_back(image);
  }
  return frames;
}

}  // namespace

Trunk TrunkOf(const DetectedPerson& person, const KeypointConvention& convention) {
  const auto landmark = [&](const char* name) {
    const auto at = std::find(convention.names.begin(), convention.names.end(), name);
    BODYLOOM_CHECK(at != convention.names.end(), "landmarks of ", convention.name, " without ", name);
    return person.points[size_t(at - convention.names.begin())];
  };
  const std::array<Keypoint, 4> trunk = {landmark("left_shoulder"), landmark("right_shoulder"), landmark("left_hip"),
                                         landmark("right_hip")};
  const double right = trunk[0].x + trunk[1].x - trunk[2].x - trunk[3].x;
  const double up = trunk[2].y + trunk[3].y - trunk[0].y - trunk[1].y;
  Trunk found;
  found.is_upright = up > std::abs(right);
  for (const Keypoint& point : trunk) found.confidence += 0.25 * point.confidence;
  return found;
}

std::string AdviceOnTurn(const PeopleSequence& people) {
  int trunks = 0, upright = 0;
  for (const std::vector<DetectedPerson>& frame : people.frames) {
    for (const DetectedPerson& person : frame) {
      const Trunk trunk = TrunkOf(person, people.convention);
      if (trunk.confidence < 0.5) continue;
      ++trunks;
      upright += trunk.is_upright ? 1 : 0;
    }
  }
  if (trunks == 0 || 4 * upright > trunks) return "";
  return "most people lie on their side or are upside down; if it was the camera that lay or hung, give --rotate auto";
}

void SayAdviceOnTurn(const std::string& video, const PeopleSequence& people, const PipelineCallbacks& callbacks) {
  const std::string advice = AdviceOnTurn(people);
  if (!advice.empty()) callbacks.Message(video + ": " + advice);
}

int FindTurn(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks) {
  callbacks.Begin("finding the way up");
  const std::vector<Image> frames = SpreadFrames(request);
  FrameDetectorOptions options = request.detector;
  options.blazepose.masks = false;
  options.hands_and_faces = HandsAndFaceChoice::kOff;
  options.blazepose.search_interval = 1;  // the frames are too far apart to follow anybody
  constexpr std::array<int, 4> kTurns = {0, 90, 180, 270};
  std::array<double, 4> upright = {};
  for (size_t i = 0; i < kTurns.size(); ++i) {
    const std::unique_ptr<FrameDetector> detector = MakeFrameDetector(options);
    for (size_t t = 0; t < frames.size(); ++t) {
      callbacks.Update("way up", (double(i) + double(t) / double(frames.size())) / kTurns.size());
      const Image turned = Oriented(frames[t], ClockwiseTurn(kTurns[i]));
      const std::vector<std::vector<FramePerson>> found = detector->Detect(std::span(&turned, 1));
      for (const FramePerson& person : found.front()) {
        const Trunk trunk = TrunkOf(person.person, detector->convention());
        if (trunk.is_upright) upright[i] += trunk.confidence;
      }
    }
  }
  const size_t best = size_t(std::max_element(upright.begin(), upright.end()) - upright.begin());
  const bool is_clear = upright[best] > kClearlyBetter * upright[0];
  const int turn_deg = is_clear ? kTurns[best] : 0;
  callbacks.Message(Concatenate(
      request.video,
      turn_deg == 0 ? ": people are upright in it as it is" : ": people are upright when it is turned clockwise by ",
      turn_deg == 0 ? "" : std::to_string(turn_deg) + " degrees"));
  return turn_deg;
}

}  // namespace bodyloom
