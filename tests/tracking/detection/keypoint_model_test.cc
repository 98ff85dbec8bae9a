// SPDX-License-Identifier: Apache-2.0
/// Detectors from ONNX files, from file to landmarks in the image; the networks are scripted (small_onnx.h).
#include "tracking/detection/keypoint_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/support/scratch_folder.h"
#include "tests/tracking/detection/inference/small_onnx.h"
#include "tracking/detection/frame_detector.h"

namespace bodyloom::keypoint_model_test {
namespace {

using ::testing::HasSubstr;

class OnnxDetectors : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const OnnxWriter& writer) const {
    std::ofstream(folder_ / name, std::ios::binary) << writer.Bytes();
    return folder_ / name;
  }
  /// 640 × 640 with 80 anchors.
  std::string Yolo(const std::vector<ScriptedPerson>& people) const {
    return Write("yolo-pose.onnx", ScriptedYoloPose({1, 3, 640, 640}, people, 17, 80));
  }
  std::string RtmPose(size_t landmarks, float score = 0.5F) const {
    std::vector<size_t> columns, rows;
    for (size_t k = 0; k < landmarks; ++k) columns.push_back(10 * k), rows.push_back(20 + 11 * k);
    return Write("rtmpose.onnx", ScriptedRtmPose(192, 256, 2, columns, rows, score));
  }
  std::string RefusalOf(const std::string& path) const {
    return FileErrorOf(path + ": ", [&] { KeypointModel model(path); });
  }
  static FrameDetectorOptions With(const std::string& pose_model, const std::string& box_model = "") {
    FrameDetectorOptions options;
    options.pose_model = pose_model;
    options.box_model = box_model;
    return options;
  }

  const ScratchFolder folder_;
};

/// 1280 × 720 with that much red.
Image TestImage(uint8_t red = 0) { return {1280, 720, Colour{red, 0, 0}}; }

TEST_F(OnnxDetectors, YoloPoseFindsEverybody) {
  // The letterbox halves the picture and begins 140 rows below.
  const KeypointModel model(Yolo({ScriptedStanding(100, 300, 200, 0.5F, 0.25F), ScriptedStanding(400, 350, 300, 0.9F, 1)}));
  EXPECT_EQ(model.family(), KeypointFamily::kYoloPose);
  EXPECT_EQ(model.convention().name, "coco17");
  const std::vector<YoloPerson> people = model.FindPeople(TestImage());
  ASSERT_EQ(people.size(), 2U);
  EXPECT_FLOAT_EQ(float(people[0].box.score), 0.9F);
  EXPECT_NEAR(people[0].box.y0, 2 * (200 - 140), 1e-3);
  EXPECT_NEAR(people[0].box.y1, 2 * (500 - 140), 1e-3);
  EXPECT_NEAR(people[1].points[0].x, 200, 1e-3);
  EXPECT_NEAR(people[1].points[0].y, 2 * (300 - 0.44 * 200 - 140), 1e-3);
  EXPECT_FLOAT_EQ(people[1].points[16].confidence, 0.25F);
}

TEST_F(OnnxDetectors, RtmPoseLooksIntoABox) {
  const KeypointModel model(RtmPose(17));
  EXPECT_EQ(model.family(), KeypointFamily::kRtmPose);
  const std::vector<Keypoint> points =
      model.PoseIn(TestImage(), {200, 100, 300, 500, 1});  // 375 × 500 from (62.5, 50) on
  ASSERT_EQ(points.size(), 17U);
  for (size_t k = 0; k < points.size(); ++k) {
    EXPECT_NEAR(points[k].x, 62.5 + 5.0 * double(k) * 375 / 192, 1e-3);
    EXPECT_NEAR(points[k].y, 50 + (10 + 5.5 * double(k)) * 500 / 256, 1e-3);
    EXPECT_EQ(points[k].confidence, 0.5F);
  }
  EXPECT_THROW(model.FindPeople(TestImage()), std::invalid_argument);
}

TEST_F(OnnxDetectors, LandmarksByTheirNumber) {
  EXPECT_EQ(KeypointModel(RtmPose(26)).convention().name, "halpe26");
  const KeypointModel whole_body(
      Write("w.onnx", ScriptedRtmPose(192, 256, 2, std::vector<size_t>(133, 3), std::vector<size_t>(133, 4), 1)));
  EXPECT_EQ(whole_body.convention().name, "coco_wholebody23");
  EXPECT_EQ(whole_body.PoseIn(TestImage(), {200, 100, 300, 500, 1}).size(), 23U);
  const KeypointModel fine(
      Write("f.onnx", ScriptedRtmPose(288, 384, 1, std::vector<size_t>(17, 3), std::vector<size_t>(17, 4), 1)));
  EXPECT_EQ(fine.family(), KeypointFamily::kRtmPose);
  const KeypointModel halpe(Write("h.onnx", ScriptedYoloPose({1, 3, 64, 96}, {}, 26, 100)));
  EXPECT_EQ(halpe.convention().name, "halpe26");
  EXPECT_TRUE(halpe.FindPeople(TestImage()).empty());
}

TEST_F(OnnxDetectors, OpenSizes) {
  const KeypointModel model(
      Write("open.onnx", ScriptedYoloPose({-1, 3, -1, -1}, {ScriptedStanding(100, 300, 200, 0.5F, 1)}, 17, 80)));
  const std::vector<YoloPerson> people = model.FindPeople(TestImage());
  ASSERT_EQ(people.size(), 1U);
  EXPECT_NEAR(people[0].points[0].y, 2 * (300 - 0.44 * 200 - 140), 1e-3);  // as in 640 × 640
}

TEST_F(OnnxDetectors, ShapesThatAreNotKnownAreSaid) {
  const auto of = [&](const std::vector<int64_t>& input, const std::vector<std::vector<int64_t>>& shapes) {
    std::vector<ScriptedOutput> outputs;
    for (const std::vector<int64_t>& shape : shapes) {
      const std::vector<float> zeros(size_t(GraphShapeSize(shape)), 0.0F);
      outputs.push_back({shape, zeros, zeros});
    }
    return RefusalOf(Write("other.onnx", ScriptedNetwork(input, outputs)));
  };
  EXPECT_THAT(of({1, 3, 64, 64}, {{1, 300, 57}}),
              HasSubstr("an input of 1x3x64x64 and outputs of 1x300x57; expected 1x3"));
  EXPECT_THAT(of({1, 3, 64, 64}, {{1, 18, 128}, {1, 18, 128}}), HasSubstr("17, 23, 26, 133 or 136 landmarks"));
  EXPECT_THAT(of({1, 3, 64, 64}, {{1, 17, 128}, {1, 17, 64}}), HasSubstr("outputs of 1x17x128, 1x17x64"));
  EXPECT_THAT(of({1, 3, 64, 64}, {{1, 17, 320}, {1, 17, 320}}), HasSubstr("outputs of 1x17x320"));
  EXPECT_THAT(of({1, 3, 64, 64}, {{1, 56, 100}, {1, 1, 1}, {1, 1, 1}}), HasSubstr("outputs of 1x56x100, 1x1x1, 1x1x1"));
  EXPECT_THAT(of({1, 1, 64, 64}, {{1, 56, 100}}), HasSubstr("an input of 1x1x64x64, expected one image, 1x3xHxW"));
  EXPECT_THAT(of({4, 3, 64, 64}, {{1, 56, 100}}), HasSubstr("an input of 4x3x64x64"));
  EXPECT_THAT(of({1, 3, 8192, 64}, {{1, 56, 100}}), HasSubstr("at most 4096 a side"));
}

TEST_F(OnnxDetectors, FramesOfYoloPose) {
  ScriptedPerson walker = ScriptedStanding(100, 300, 200, 0.5F, 0.75F);
  walker.right = 51;
  const auto detector = MakeFrameDetector(With(Yolo({walker, ScriptedStanding(400, 350, 300, 0.9F, 1)})));
  EXPECT_EQ(detector->convention().name, "coco17");
  // The letterbox shows the picture's red in 360 of 640 rows, and grey in the others.
  const std::vector<Image> frames = {TestImage(0), TestImage(255)};
  const std::vector<std::vector<FramePerson>> people = detector->Detect(frames);
  ASSERT_EQ(people.size(), 2U);
  ASSERT_EQ(people[0].size(), 2U);
  ASSERT_EQ(people[1].size(), 2U);
  const double moved = people[1][1].person.points[0].x - people[0][1].person.points[0].x;
  EXPECT_NEAR(moved, 2 * 51 * 360 / 640.0, 0.01);
  EXPECT_EQ(people[1][0].person.points[0].x, people[0][0].person.points[0].x);
  EXPECT_TRUE(people[0][0].mask.labels.empty());
  EXPECT_EQ(detector->summary().frames, 2);

  FrameDetectorOptions one = With(folder_ / "yolo-pose.onnx");
  one.blazepose.max_people = 1;
  one.blazepose.num_threads = 1;
  const std::vector<std::vector<FramePerson>> surest = MakeFrameDetector(one)->Detect(frames);
  ASSERT_EQ(surest[1].size(), 1U);
  EXPECT_EQ(surest[1][0].person.points[3].x, people[1][0].person.points[3].x);
}

TEST_F(OnnxDetectors, FramesOfRtmPoseInYolosBoxes) {
  const std::string boxes =
      Write("boxes.onnx", ScriptedNetwork({1, 3, 640, 640}, [] {
              ScriptedOutput output = {{1, 6, 8}, std::vector<float>(48, 0.0F), std::vector<float>(48, 0.0F)};
              const float box[] = {125, 290, 50, 200, 0.5F, 0.1F};  // 100 × 400 at (200, 100)
              for (size_t row = 0; row < 6; ++row) output.fixed[row * 8 + 2] = box[row];
              return std::vector{output};
            }()));
  EXPECT_EQ(KeypointModel(boxes).family(), KeypointFamily::kYoloBoxes);
  const auto detector = MakeFrameDetector(With(RtmPose(17), boxes));
  const std::vector<Image> frames = {TestImage()};
  const std::vector<std::vector<FramePerson>> people = detector->Detect(frames);
  ASSERT_EQ(people[0].size(), 1U);
  const std::vector<Keypoint> expected =
      KeypointModel(folder_ / "rtmpose.onnx").PoseIn(frames[0], {200, 100, 300, 500, 1});
  for (size_t k = 0; k < 17; ++k) {
    EXPECT_NEAR(people[0][0].person.points[k].x, expected[k].x, 1e-3);
    EXPECT_NEAR(people[0][0].person.points[k].y, expected[k].y, 1e-3);
  }
  EXPECT_EQ(detector->summary().regions, 1);
}

TEST_F(OnnxDetectors, FilesThatContradictEachOther) {
  const std::string yolo = Yolo({}), rtmpose = RtmPose(17);
  const std::string boxes = Write("b.onnx", ScriptedYoloPose({1, 3, 64, 64}, {}, 0, 100));
  const auto refusal = [&](const FrameDetectorOptions& options, const std::string& file) {
    return FileErrorOf(file, [&] { MakeFrameDetector(options); });
  };
  EXPECT_THAT(refusal(With(boxes), boxes), HasSubstr("finds boxes alone, expected a network of 17"));
  EXPECT_THAT(refusal(With(yolo, boxes), boxes), HasSubstr("not needed"));
  EXPECT_THAT(refusal(With(rtmpose, rtmpose), rtmpose), HasSubstr("expected a network that finds them"));
  EXPECT_THROW(MakeFrameDetector(With("", boxes)), std::invalid_argument);
  FrameDetectorOptions masks = With(yolo);
  masks.blazepose.masks = true;
  EXPECT_THROW(MakeFrameDetector(masks), std::invalid_argument);
  FrameDetectorOptions nowhere = With(rtmpose);
  nowhere.models = folder_ / "none";
  EXPECT_THAT(refusal(nowhere, nowhere.models),  // whichever of its files is opened first
              HasSubstr("or --box-model finds the people for " + rtmpose));
  EXPECT_EQ(FrameDetectorName(With(yolo)), "yolo-pose.onnx");
  EXPECT_EQ(FrameDetectorName(With("")), "heavy");
}

}  // namespace
}  // namespace bodyloom::keypoint_model_test
