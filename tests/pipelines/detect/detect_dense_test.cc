// SPDX-License-Identifier: Apache-2.0
/// Dense keypoints of a clip by a scripted detector: each person is a rectangle of one grey level and shows one chart.
#include "pipelines/detect/detect_dense.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "data_tools/body/builtin_body.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/video/image_file.h"
#include "pipelines/detect/detect_clip.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom::detect_dense_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

/// Somebody in a frame, and the chart that this person shows.
struct Somebody {
  int part, x, y, width, height;
};

/// Everybody by their grey, 10 times the part.
std::vector<ChartDetection> FindRectangles(const Image& image) {
  std::map<int, Somebody> found;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int grey = image.at(x, y).red;
      if (grey == 0) continue;
      Somebody& s = found.try_emplace(grey, Somebody{grey / 10, x, y, 0, 0}).first->second;
      s.width = std::max(s.width, x + 1 - s.x);
      s.height = std::max(s.height, y + 1 - s.y);
    }
  }
  std::vector<ChartDetection> people;
  for (const auto& [grey, s] : found) {
    ChartDetection& person = people.emplace_back();
    person = {double(s.x), double(s.y), double(s.x + s.width), double(s.y + s.height), 1, {}};
    const size_t area = size_t(s.width) * size_t(s.height);
    person.charts = {s.x,
                     s.y,
                     s.width,
                     s.height,
                     std::vector<uint8_t>(area, uint8_t(s.part)),
                     std::vector<float>(area, 0.5F),
                     std::vector<float>(area, 0.5F)};
  }
  return people;
}

class DetectDenseClip : public ::testing::Test {
 protected:
  void AddFrame(const std::vector<Somebody>& people) {
    Image image(120, 80);
    for (const Somebody& s : people) {
      const auto grey = uint8_t(10 * s.part);
      Paste(Image(s.width, s.height, {grey, grey, grey}), s.x, s.y, &image);
    }
    char name[32];
    std::snprintf(name, sizeof name, "clip/%03d.png", frames_++);
    std::filesystem::create_directories(folder_ / "clip");
    WriteImage(folder_ / name, image);
  }
  [[nodiscard]] DetectDenseRequest Request(int person = 0) const {
    DetectDenseRequest request;
    request.video = folder_ / "clip";
    request.span.fps = 10;
    request.person = person;
    request.sampling.per_frame = 20;
    return request;
  }
  [[nodiscard]] DetectedDense Detect(int person = 0, const PeopleSequence* landmarks = nullptr) const {
    return DetectDense(Request(person), FindRectangles, BuiltinBody(), landmarks);
  }
  [[nodiscard]] DetectClipRequest ClipRequest() const {
    DetectClipRequest request;
    request.detect.video = folder_ / "clip";
    request.detect.span.fps = 10;
    request.dense = folder_ / "dense.npz";
    request.dense_detector = FindRectangles;
    return request;
  }
  /// The chart that each frame's keypoints lie on; 0 without keypoints.
  static std::vector<int> Parts(const DenseSequence& dense) {
    std::vector<int> parts;
    for (const auto& frame : dense.frames) {
      parts.push_back(frame.empty() ? 0 : BuiltinBody().data().face_part[size_t(frame[0].face)]);
    }
    return parts;
  }

  const ScratchFolder folder_;
  int frames_ = 0;
};

TEST_F(DetectDenseClip, APersonIsFollowedByTheBoxes) {
  AddFrame({{2, 10, 10, 30, 60}, {15, 80, 10, 15, 40}});
  AddFrame({{15, 82, 10, 15, 40}, {2, 13, 10, 30, 60}});
  AddFrame({{15, 84, 10, 15, 40}});
  AddFrame({{2, 19, 10, 30, 60}});
  const DetectedDense first = Detect(0), second = Detect(1);
  EXPECT_EQ(first.people, 2);
  EXPECT_EQ(first.frames_seen, 3);
  EXPECT_THAT(Parts(first.dense), ElementsAre(2, 2, 0, 2));
  EXPECT_THAT(Parts(second.dense), ElementsAre(15, 15, 15, 0));
  EXPECT_EQ(first.dense.frames[0].size(), 20U);
  for (const DenseKeypoint& point : first.dense.frames[1]) {
    EXPECT_TRUE(point.pixel.x() >= 13 && point.pixel.x() < 43 && point.pixel.y() >= 10 && point.pixel.y() < 70);
  }
  EXPECT_NEAR(first.dense.timestamps[3], 0.3, 1e-9);
  EXPECT_EQ(first.dense.uv_sigma, kDensePoseUvSigma);
  EXPECT_THAT([&] { (void)Detect(2); }, ThrowsMessage<std::runtime_error>(HasSubstr("person 2 requested")));
}

PeopleSequence LandmarksOf(const std::vector<std::vector<Somebody>>& frames) {
  PeopleSequence people;
  people.convention = MediaPipe33();
  people.image_width = 120;
  people.image_height = 80;
  for (const auto& frame : frames) {
    people.timestamps.push_back(double(people.timestamps.size()) / 10);
    auto& found = people.frames.emplace_back();
    for (const Somebody& s : frame) {
      DetectedPerson person;
      // A third of the landmarks is guessed far away, as those of unseen legs are.
      for (int k = 0; k < 33; ++k) {
        const float along = float(k % 11) / 10;
        const bool seen = k < 22;
        person.points.push_back({float(s.x) + along * float(s.width),
                                 float(s.y) + along * float(s.height) + (seen ? 0 : 500), seen ? 0.9F : 0.1F});
      }
      found.push_back(person);
    }
  }
  return people;
}

TEST_F(DetectDenseClip, LandmarksSayWhoIsMeant) {
  // The largest person of the dense detector is the second of the landmarks; the two overlap.
  const Somebody large = {2, 5, 5, 50, 70}, small = {15, 45, 10, 20, 40};
  const Somebody unknown = {7, 80, 8, 15, 10};  // seen by the dense detector alone
  AddFrame({large, small});
  AddFrame({large, small, unknown});
  AddFrame({large});
  AddFrame({small});
  const PeopleSequence people = LandmarksOf({{small}, {small, large}, {small, large}, {}});
  const DetectedDense detected = Detect(0, &people);
  EXPECT_THAT(Parts(detected.dense), ElementsAre(15, 15, 0, 0));
  EXPECT_THAT(Parts(Detect(1, &people).dense), ElementsAre(0, 2, 2, 0));
  EXPECT_EQ(detected.people, 2);

  PeopleSequence elsewhere = LandmarksOf({{{1, 100, 60, 10, 15}}, {}, {}, {}});
  EXPECT_THAT([&] { (void)Detect(0, &elsewhere); },
              ThrowsMessage<std::runtime_error>(HasSubstr("did not see person 0 in any of 4 frames")));
  elsewhere.frames.pop_back();
  elsewhere.timestamps.pop_back();
  EXPECT_THROW((void)Detect(0, &elsewhere), std::invalid_argument);
}

TEST_F(DetectDenseClip, OfTwoThatBelongToThePersonTheOneThatOverlapsMoreIsTaken) {
  const Somebody person = {2, 20, 10, 40, 60};
  AddFrame({{2, 22, 12, 40, 60}, {9, 95, 10, 10, 60}});
  AddFrame({{9, 10, 5, 30, 20}, {15, 40, 30, 40, 45}});
  // Only visible landmarks tell how tall the person is.
  AddFrame({{2, 22, 12, 38, 28}, {9, 20, 41, 40, 39}, {15, 20, 8, 41, 1}, {15, 20, 79, 41, 1}});
  const PeopleSequence people = LandmarksOf({{person}, {person}, {{2, 20, 10, 40, 30}}});
  EXPECT_THAT(Parts(Detect(0, &people).dense), ElementsAre(2, 15, 2));
}

TEST_F(DetectDenseClip, SpansAreCutOut) {
  for (int t = 0; t < 6; ++t) AddFrame({{2, 10 + t, 10, 30, 60}});
  DetectDenseRequest request = Request();
  request.span.from_s = 0.2;
  request.span.to_s = 0.4;
  const DenseSequence dense = DetectDense(request, FindRectangles, BuiltinBody()).dense;
  EXPECT_THAT(dense.timestamps, ElementsAre(::testing::DoubleNear(0.2, 1e-9), ::testing::DoubleNear(0.3, 1e-9),
                                            ::testing::DoubleNear(0.4, 1e-9)));
  request.span.from_s = 9;
  request.span.to_s = -1;
  EXPECT_THAT([&] { (void)DetectDense(request, FindRectangles, BuiltinBody()); },
              ThrowsMessage<RequestError>(HasSubstr("no frame from second 9")));
}

TEST_F(DetectDenseClip, DetectClipWritesDenseKeypointsWithoutLookingForLandmarks) {
  AddFrame({{2, 10, 10, 30, 60}});
  AddFrame({{2, 12, 10, 30, 60}});
  DetectClipRequest request = ClipRequest();
  request.detect.detector.models = folder_ / "no networks here";
  request.json = folder_ / "report.json";
  const DetectClipReport report = DetectClip(request);
  EXPECT_FALSE(report.landmarks.has_value());
  ASSERT_TRUE(report.dense.has_value());
  EXPECT_EQ(report.dense->frames_seen, 2);
  EXPECT_EQ(report.dense->keypoints, 1000);
  EXPECT_EQ(report.outputs, (std::vector<std::string>{request.dense, request.json}));
  const DenseSequence dense = LoadDense(request.dense, BuiltinBody());
  EXPECT_THAT(Parts(dense), ElementsAre(2, 2));
  EXPECT_EQ(dense.pixel_sigma_px, kPixelWidthSigma);
  const auto json = nlohmann::json::parse(FileBytes(request.json));
  EXPECT_EQ(json["dense"]["frames_seen"], 2);
  EXPECT_EQ(json["frames"], 2);
  EXPECT_FALSE(json.contains("people"));
  EXPECT_EQ(json["processor_seconds"].size(), json["seconds"].size());
  EXPECT_GT(json["processor_seconds"]["dense"], 0);
  EXPECT_THAT(ToText(report), HasSubstr("dense    1000 keypoints a frame in 2 frames, one of 1 people\n"));
}

TEST_F(DetectDenseClip, FailuresLeaveNothingBehind) {
  AddFrame({});
  AddFrame({});
  const DetectClipRequest request = ClipRequest();
  EXPECT_THAT([&] { DetectClip(request); },
              ThrowsMessage<std::runtime_error>(HasSubstr("no person in any of 2 frames")));
  PipelineCallbacks callbacks;
  callbacks.progress = [](const std::string&, double) { return false; };
  EXPECT_THROW(DetectClip(request, callbacks), Cancelled);
  DetectClipRequest failing = request;
  failing.dense_detector = [](const Image&) -> std::vector<ChartDetection> { throw std::runtime_error("model.pt: x"); };
  EXPECT_THAT([&] { DetectClip(failing); }, ThrowsMessage<std::runtime_error>("model.pt: x"));
  DetectClipRequest images = request;
  images.dense = folder_ / "iuv";
  EXPECT_THAT([&] { DetectClip(images); }, ThrowsMessage<RequestError>(HasSubstr("written as .npz")));
  EXPECT_THAT(folder_.Entries(), ElementsAre("clip"));
}

}  // namespace
}  // namespace bodyloom::detect_dense_test
