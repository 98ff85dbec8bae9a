// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/load_detections.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/detection_readers.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "data_tools/observations/observations_npz.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/pickle_writer.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"
#include "tests/support/stick_person.h"

namespace bodyloom::load_detections_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class LoadDetectionsTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& bytes) {
    WriteFileAtomically(folder_.File(name), bytes);
    return folder_.File(name);
  }
  std::string ErrorOf(const std::string& name, const std::string& bytes, const LoadDetectionsOptions& options = {}) {
    const std::string path = Write(name, bytes);
    return FileErrorOf(path, [&] { LoadDetections(path, options); });
  }
  TemporaryFolder folder_;
};

std::string CocoEntry(const std::string& image_id, double x, const std::string& more = "") {
  return R"({"image_id":)" + image_id + R"(,"category_id":1,"keypoints":[)" +
         StickNumbers(Coco17().names, x, 500, 400) + R"(],"score":2.5)" + more + "}";
}

TEST_F(LoadDetectionsTest, CocoResults) {
  const std::string path = Write("c.json", "[" + CocoEntry("3", 300) + "," + CocoEntry("5", 320) + "," +
                                               CocoEntry("4", 310) + "," + CocoEntry("4", 1500) + "]");
  const KeypointSequence sequence = LoadDetections(path);
  ASSERT_EQ(sequence.num_frames(), 3);
  EXPECT_EQ(sequence.convention, "coco17");
  EXPECT_NEAR(sequence.at(1, 0).x, 310, 1e-3);
  EXPECT_NEAR(sequence.timestamps[0], 0.1, 1e-12);
}

TEST_F(LoadDetectionsTest, FilesAsDisksHaveThem) {
  const std::string list = "[" + CocoEntry("3", 300) + "," + CocoEntry("4", 310) + "," + CocoEntry("5", 320) + "]";
  const auto expect_three = [&](const KeypointSequence& sequence) {
    ASSERT_EQ(sequence.num_frames(), 3);
    EXPECT_NEAR(sequence.at(1, 0).x, 310, 1e-3);
    EXPECT_NEAR(sequence.timestamps[0], 0.1, 1e-12);
  };
  expect_three(LoadDetections(Write("bom.json", "\xEF\xBB\xBF" + list)));
  const std::string lines = CocoEntry("3", 300) + "\n" + CocoEntry("4", 310) + "\n" + CocoEntry("5", 320) + "\n";
  std::vector<std::string> warnings;
  expect_three(LoadDetections(Write("lines.jsonl", lines), {}, &warnings));
  EXPECT_TRUE(warnings.empty());
  expect_three(LoadDetections(Write("cut.jsonl", lines + CocoEntry("6", 330).substr(0, 50)), {}, &warnings));
  EXPECT_THAT(warnings, ::testing::ElementsAre(HasSubstr("cut.jsonl: the last of 4 JSON values is cut off")));

  std::string with_nan = list;
  const size_t first = with_nan.find("\"keypoints\":[") + 13;
  with_nan.replace(first, with_nan.find(',', first) - first, "NaN");
  const KeypointSequence sequence = LoadDetections(Write("nan.json", with_nan));
  expect_three(sequence);
  EXPECT_EQ(sequence.at(0, 0).confidence, 0);
  EXPECT_GT(sequence.at(0, 1).confidence, 0);
}

TEST_F(LoadDetectionsTest, NanAndNullAreMissingLandmarksOfEveryJson) {
  std::string mmpose = R"({"keypoints":[[NaN,20])", scores = "0.5", blaze = "[[null,NaN,0,1]";
  for (int k = 1; k < 17; ++k) mmpose += ",[" + std::to_string(10 * k) + ",20]", scores += ",0.5";
  for (int k = 1; k < 33; ++k) blaze += ",[" + std::to_string(10 * k) + ",20,0,1]";
  for (const std::string& text : {"[" + mmpose + R"(],"keypoint_scores":[)" + scores + "]}]", "[" + blaze + "]]"}) {
    const KeypointSequence sequence = LoadDetections(Write("n.json", text));
    EXPECT_EQ(sequence.at(0, 0).confidence, 0);
    EXPECT_EQ(sequence.at(0, 3).x, 30);
    EXPECT_GT(sequence.at(0, 3).confidence, 0);
  }
}

TEST_F(LoadDetectionsTest, AFolderWithOneFileOfAWholeClip) {
  const std::string folder = folder_.File("clip \xC3\xBC (1)");
  std::filesystem::create_directory(folder);
  WriteFileAtomically(folder + "/keypoints [a].json", "[" + CocoEntry("3", 300) + "," + CocoEntry("4", 310) + "]");
  for (const std::string& path : {folder, folder + "/keypoints [a].json"}) {
    const KeypointSequence sequence = LoadDetections(path);
    ASSERT_EQ(sequence.num_frames(), 2);
    EXPECT_NEAR(sequence.at(1, 0).x, 310, 1e-3);
  }
}

TEST_F(LoadDetectionsTest, TheVaryingNumberOfImageNamesIsTheFrame) {
  const KeypointSequence sequence = LoadDetections(Write(
      "names.json", "[" + CocoEntry("\"a_60fps_9_1080p.jpg\"", 300) + "," + CocoEntry("\"a_60fps_11_1080p.jpg\"", 320) +
                        "," + CocoEntry("\"a_60fps_10_1080p.jpg\"", 310) + "]"));
  ASSERT_EQ(sequence.num_frames(), 3);
  EXPECT_NEAR(sequence.at(2, 0).x, 320, 1e-3);
  EXPECT_NEAR(sequence.timestamps[0], 0.3, 1e-12);
}

TEST_F(LoadDetectionsTest, AlphaPoseNamesIdentitiesAndConfidences) {
  std::string text =
      "[" + CocoEntry("\"0.jpg\"", 300, ",\"idx\":4") + "," + CocoEntry("\"1.jpg\"", 310, ",\"idx\":4") + "]";
  text.replace(text.find("0.9"), 3, "5.9");
  const KeypointSequence sequence = LoadDetections(Write("alpha.json", text));
  EXPECT_EQ(sequence.num_frames(), 2);
  EXPECT_EQ(sequence.at(0, 0).confidence, 1);
}

TEST_F(LoadDetectionsTest, CocoAnnotations) {
  const std::string flags = "1,2,0, 5,6,1, 7,8,2" + [] {
    std::string rest;
    for (int k = 3; k < 17; ++k) rest += ",50,60,2";
    return rest;
  }();
  const std::string text =
      R"({"images":[{"id":77,"file_name":"f_0001.png","width":640,"height":480},{"id":12,"file_name":"f_0002.png","width":640,"height":480}],)"
      R"("annotations":[{"image_id":12,"keypoints":[)" +
      flags + R"(]}]})";
  const KeypointSequence sequence = LoadDetections(Write("ann.json", text));
  ASSERT_EQ(sequence.num_frames(), 2) << "an image without anyone is a frame";
  EXPECT_EQ(sequence.image_width, 640);
  EXPECT_EQ(sequence.at(0, 2).confidence, 0);
  EXPECT_EQ(sequence.at(1, 0).confidence, 0);
  EXPECT_EQ(sequence.at(1, 1).confidence, 0.5F);
  EXPECT_EQ(sequence.at(1, 2).confidence, 1);
}

std::string BlazePoseFrame(double scale, const std::string& visibility) {
  std::string text;
  for (size_t k = 0; k < 33; ++k) {
    text += (k > 0 ? "," : "") + std::string(R"({"x":)") + std::to_string((100 + 10.0 * k) * scale) + R"(,"y":)" +
            std::to_string((50 + 20.0 * k) * scale) + R"(,"z":0.1,"visibility":)" + visibility + "}";
  }
  return "[" + text + "]";
}

TEST_F(LoadDetectionsTest, BlazePoseForms) {
  const KeypointSequence pixels = LoadDetections(Write("a.json", "[[],null," + BlazePoseFrame(1, "0.7") + ",{}]"));
  ASSERT_EQ(pixels.num_frames(), 4);
  EXPECT_EQ(pixels.convention, "mediapipe33");
  EXPECT_NEAR(pixels.at(2, 3).x, 130, 1e-4);
  EXPECT_NEAR(pixels.at(2, 3).confidence, 0.7, 1e-6);
  EXPECT_EQ(pixels.at(1, 3).confidence, 0);

  const KeypointSequence logits = LoadDetections(Write("b.json", "[" + BlazePoseFrame(1, "3.0") + "]"));
  EXPECT_NEAR(logits.at(0, 0).confidence, 1 / (1 + std::exp(-3.0)), 1e-6);

  LoadDetectionsOptions options;
  options.image_width = 1000;
  options.image_height = 2000;
  const std::string path = Write("c.json", R"({"frames":[{"pose_landmarks":)" + BlazePoseFrame(1e-3, "1") + "}]}");
  const KeypointSequence fractions = LoadDetections(path, options);
  EXPECT_NEAR(fractions.at(0, 0).x, 99.5, 1e-3);
  EXPECT_NEAR(fractions.at(0, 0).y, 99.5, 1e-3);
  EXPECT_THAT(FileErrorOf(path, [&] { LoadDetections(path); }), HasSubstr("give its width and height"));

  const KeypointSequence named = LoadDetections(
      Write("d.json", R"([[{"score":0.5,"keypoints":[)" + BlazePoseFrame(1, "0.7").substr(1) + R"(}],[]])"));
  EXPECT_EQ(named.num_frames(), 2);
  const KeypointSequence table =
      LoadDetections(Write("e.json", R"([{"nose":{"x":10,"y":20},"left_foot_index":{"x":30,"y":40,"score":0.25}}])"));
  EXPECT_EQ(table.names[31], "left_big_toe");
  EXPECT_EQ(table.at(0, 31).confidence, 0.25F);
  EXPECT_EQ(table.at(0, 1).confidence, 0) << "left_eye_inner is not there";
  EXPECT_EQ(LoadDetections(Write("f.json", R"([{"NOSE":{"x":10,"y":20},"LEFT_EYE":{"x":30,"y":40}}])")).convention,
            "coco17");
}

TEST_F(LoadDetectionsTest, NormalisedOpenPose) {
  std::string numbers;
  for (int k = 0; k < 25; ++k) numbers += (k > 0 ? "," : "") + std::string(k % 2 == 0 ? "-0.5,0.5,1" : "0.5,-0.5,1");
  LoadDetectionsOptions options;
  options.image_width = 100;
  options.image_height = 200;
  const KeypointSequence sequence =
      LoadDetections(Write("n.json", R"({"people":[{"pose_keypoints_2d":[)" + numbers + "]}]}"), options);
  EXPECT_NEAR(sequence.at(0, 0).x, 24.5, 1e-4);
  EXPECT_NEAR(sequence.at(0, 0).y, 149.5, 1e-4);
}

TEST_F(LoadDetectionsTest, FolderOfViews) {
  for (const char* view : {"cam01_json", "cam02_json"}) {
    std::filesystem::create_directory(folder_.File(view));
    Write(std::string(view) + "/x_0_keypoints.json",
          R"({"people":[{"pose_keypoints_2d":[)" + StickNumbers(Body25().names, view[4] == '1' ? 300 : 400, 500, 400) +
              "]}]}");
  }
  LoadDetectionsOptions options;
  options.view = "cam02";
  EXPECT_NEAR(LoadDetections(folder_.File(""), options).at(0, 0).x, 400, 1e-3);
  options.view = "cam03";
  EXPECT_THAT(FileErrorOf(folder_.File(""), [&] { LoadDetections(folder_.File(""), options); }),
              HasSubstr("no view 'cam03'; the folder has cam01_json, cam02_json"));
}

TEST_F(LoadDetectionsTest, OwnNpzRoundTrip) {
  KeypointSequence keypoints;
  keypoints.convention = "coco17";
  keypoints.names = CocoNames();
  keypoints.image_width = 640;
  keypoints.image_height = 480;
  keypoints.timestamps = {0.5, 1.0};
  keypoints.points.resize(34);
  for (int k = 0; k < 17; ++k) keypoints.at(1, k) = {10.5F * k, 3.0F * k, 0.5F};
  DenseSequence dense;
  dense.timestamps = keypoints.timestamps;
  dense.image_width = 640;
  dense.image_height = 480;
  dense.uv_sigma = 0.02;
  dense.pixel_sigma_px = 0.75;
  dense.frames.resize(2);
  dense.frames[1] = {{7, {0.25F, 0.5F, 0.25F}, {1.5F, 2.5F}, 3}, {9, {1, 0, 0}, {4, 5}, 0.5F}};
  const std::string path = folder_.File("o.npz");
  WriteObservations(path, &keypoints, &dense);
  const KeypointSequence read = LoadDetections(path);
  EXPECT_EQ(read.names, keypoints.names);
  EXPECT_EQ(read.timestamps, keypoints.timestamps);
  EXPECT_EQ(read.at(1, 4).x, 42);
  EXPECT_EQ(read.at(0, 4).confidence, 0);
  const DenseSequence read_dense = ReadDenseObservations(path);
  ASSERT_EQ(read_dense.frames[1].size(), 2U);
  EXPECT_EQ(read_dense.frames[0].size(), 0U);
  EXPECT_EQ(read_dense.frames[1][0].face, 7);
  EXPECT_EQ(read_dense.frames[1][0].pixel, Eigen::Vector2f(1.5F, 2.5F));
  EXPECT_EQ(read_dense.frames[1][1].sigma_px, 0.5F);
  EXPECT_EQ(read_dense.uv_sigma, 0.02);
  EXPECT_EQ(read_dense.pixel_sigma_px, 0.75);

  // Files from before the two noises were stored.
  NpzArrays arrays = ReadNpz(path);
  NpzArrays older = arrays;
  ASSERT_EQ(older.erase("dense_uv_sigma") + older.erase("dense_pixel_sigma_px"), 2U);
  EXPECT_EQ(DenseFromNpz(older, "x.npz").uv_sigma, 0);
  EXPECT_EQ(DenseFromNpz(older, "x.npz").pixel_sigma_px, 0);
  EXPECT_EQ(DenseFromNpz(older, "x.npz").frames[1].size(), 2U);

  // Files that lie.
  const auto error = [&](const std::string& key, const NdArray& value) {
    NpzArrays changed = arrays;
    changed[key] = value;
    return FileErrorOf("x.npz", [&] {
      KeypointsFromNpz(changed, "x.npz");
      DenseFromNpz(changed, "x.npz");
    });
  };
  const double backwards[2] = {1, 0.5};
  EXPECT_THAT(error("timestamps", NdArray::FromDoubles(backwards, {2})), HasSubstr("increasing"));
  const int32_t frames[2] = {0, 2};
  EXPECT_THAT(error("dense_frame", NdArray::FromInts32(frames, {2})), HasSubstr("dense_frame: entry 1 is 2"));
  const float weights[6] = {1, 0, 0, 0.5F, 0.1F, 0};
  EXPECT_THAT(error("dense_barycentric", NdArray::FromFloats(weights, {2, 3})), HasSubstr("sum to 1"));
  const float sigmas[2] = {1, std::numeric_limits<float>::quiet_NaN()};
  EXPECT_THAT(error("dense_sigma_px", NdArray::FromFloats(sigmas, {2})), HasSubstr("positive"));
  for (const char* key : {"dense_uv_sigma", "dense_pixel_sigma_px"}) {
    EXPECT_THAT(error(key, NdArray::FromDouble(-0.01)), HasSubstr(std::string(key) + ": -0.01"));
    EXPECT_THAT(error(key, NdArray::FromDouble(std::numeric_limits<double>::quiet_NaN())), HasSubstr("or 0 when"));
    EXPECT_THAT(error(key, NdArray::FromDouble(std::numeric_limits<double>::infinity())), HasSubstr("or 0 when"));
    EXPECT_THAT(error(key, NdArray::FromFloats(sigmas, {2})), HasSubstr("expected numbers, scalar"));
    EXPECT_THAT(error(key, NdArray::FromString("0.02")), HasSubstr("of no numbers"));
  }
  EXPECT_THAT(error("keypoints", NdArray::FromFloats(weights, {2, 3})), HasSubstr("expected numbers, 2x17x3"));
  EXPECT_THAT(error("keypoint_names", NdArray::FromFloats(weights, {6})), HasSubstr("list of text"));
  const int32_t size[2] = {-1, 5};
  EXPECT_THAT(error("image_size", NdArray::FromInts32(size, {2})), HasSubstr("image_size"));
}

/// An AIST++ keypoints2d pickle of 2 views, 3 frames.
std::string AistPickle(const std::vector<double>& timestamps_us = {0, 16667, 33333}, int num_points = 17) {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  std::vector<float> values;
  for (int v = 0; v < 2; ++v) {
    for (int t = 0; t < 3; ++t) {
      for (int k = 0; k < num_points; ++k) {
        const bool missing = v == 1 && t == 1;
        const float nan = std::numeric_limits<float>::quiet_NaN();
        values.push_back(missing ? nan : 1000.0F * v + 100.0F * t + k);
        values.push_back(missing ? nan : 50.0F + k);
        values.push_back(missing ? nan : k == 3 ? 1.02F : 0.5F);
      }
    }
  }
  return Pickle(2, Dict({{Str2("keypoints2d"), Array2("f4", '<', {2, 3, num_points, 3}, false, RawOf(values))},
                         {Str2("timestamps"), Doubles2(timestamps_us, {static_cast<int>(timestamps_us.size())})}}));
}

TEST_F(LoadDetectionsTest, AistViews) {
  const std::string path = Write("a.pkl", AistPickle());
  LoadDetectionsOptions options;
  options.view = "c02";
  const KeypointSequence sequence = LoadDetections(path, options);
  ASSERT_EQ(sequence.num_frames(), 3);
  EXPECT_EQ(sequence.at(2, 4).x, 1204);
  EXPECT_EQ(sequence.at(1, 4).confidence, 0);
  EXPECT_EQ(sequence.at(0, 3).confidence, 1) << "1.02 is clamped";
  EXPECT_NEAR(sequence.timestamps[2], 0.033333, 1e-12);
  options.view = "c07";
  EXPECT_THAT(FileErrorOf(path, [&] { LoadDetections(path, options); }),
              HasSubstr("no view 'c07'; the file has c01, c02"));
  options.view = "";
  EXPECT_THAT(FileErrorOf(path, [&] { LoadDetections(path, options); }), HasSubstr("no view chosen"));
  options.view = "c01";
  EXPECT_THAT(ErrorOf("b.pkl", AistPickle({0, 1}), options), HasSubstr("timestamps: 2 values, expected 3"));
  EXPECT_THAT(ErrorOf("b.pkl", AistPickle({0, 2, 1}), options), HasSubstr("timestamps[2]"));
  EXPECT_THAT(ErrorOf("b.pkl", AistPickle({0, 1, 2}, 13), options), HasSubstr("shape 2x3x13x3"));
  const std::string bytes = AistPickle();
  for (size_t n = 0; n < bytes.size(); n += 13) ErrorOf("t.pkl", bytes.substr(0, n), options);
}

TEST_F(LoadDetectionsTest, UnknownFilesSayWhatIsRead) {
  const auto lists = AllOf(HasSubstr("OpenPose"), HasSubstr("AIST++"), HasSubstr(".npz"), HasSubstr("COCO"));
  EXPECT_THAT(ErrorOf("empty", ""), lists);
  EXPECT_THAT(ErrorOf("noise", "hello"), lists);
  EXPECT_THAT(ErrorOf("j1", "{}"), AllOf(lists, HasSubstr("it is empty")));
  EXPECT_THAT(ErrorOf("j2", "[]"), lists);
  EXPECT_THAT(ErrorOf("j3", "[1,2,3]"), lists);
  EXPECT_THAT(ErrorOf("j4", R"({"a":{"b":1}})"), lists);
  EXPECT_THAT(ErrorOf("p1", "\x80\x02}."), lists);
  EXPECT_THAT(ErrorOf("deep", std::string(5000, '[')), HasSubstr("nested deeper"));
  FileErrorOf("/nowhere/x", [] { LoadDetections("/nowhere/x"); });
  const std::string folder = folder_.File("sub");
  std::filesystem::create_directory(folder);
  EXPECT_THAT(FileErrorOf(folder, [&] { LoadDetections(folder); }), lists);
}

TEST_F(LoadDetectionsTest, ZeroPeopleWrongCountsAndWrongImageSize) {
  EXPECT_THAT(ErrorOf("z.json", R"({"people":[]})"), HasSubstr("no person in any of 1 frames"));
  EXPECT_THAT(ErrorOf("z.json", R"({"people":[{}]})"), HasSubstr("no person"));
  EXPECT_THAT(ErrorOf("b.json", "[[[1,2],[3,4]]]"), HasSubstr("2 landmarks, expected 33"));
  EXPECT_THAT(ErrorOf("c.json", R"([{"image_id":1,"keypoints":[1,2,3]}])"), HasSubstr("expected 3·17"));
  EXPECT_THAT(ErrorOf("c.json", R"([{"image_id":"x","keypoints":[]}])"), HasSubstr("keypoints"));
  LoadDetectionsOptions options;
  options.image_width = 100;
  options.image_height = 100;
  EXPECT_THAT(ErrorOf("s.json", "[" + CocoEntry("1", 600) + "]", options), HasSubstr("outside an image of 100x100"));
  options.image_height = 0;
  EXPECT_THROW(LoadDetections("x", options), std::invalid_argument);
  options = {};
  options.min_confidence = 0.95;
  EXPECT_THAT(ErrorOf("s.json", "[" + CocoEntry("1", 600) + "]", options), HasSubstr("nobody was detected"));
  options = {};
  options.person = -1;
  EXPECT_THROW(LoadDetections("x", options), std::invalid_argument);
}

class RealDetections : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data_ + "/aistpp")) GTEST_SKIP() << "no recordings in " << data_;
  }
  const std::string data_ = SharedDir() + "/data";
};

TEST_F(RealDetections, Aist) {
  LoadDetectionsOptions options;
  options.view = "c05";
  options.image_width = 1920;
  options.image_height = 1080;
  for (const char* name : {"gBR_sBM_cAll_d06_mBR2_ch06", "gJS_sBM_cAll_d03_mJS2_ch07"}) {
    const std::string folder = data_ + "/aistpp/";
    const KeypointSequence sequence = LoadDetections(folder + "keypoints2d/" + name + ".pkl", options);
    EXPECT_EQ(sequence.num_frames(), 576);
    EXPECT_NEAR(sequence.timestamps[575], 575 / 60.0, 1e-5);
    const std::vector<MatrixX3d> joints = ReadAistKeypoints3d(folder + "keypoints3d/" + name + ".pkl");
    ASSERT_EQ(joints.size(), 576U);
    EXPECT_NEAR(joints[0].col(1).maxCoeff() - joints[0].col(1).minCoeff(), 1.6, 0.3) << "metres, y up";
  }
}

TEST_F(RealDetections, Pose2SimPersonOfAllPeopleIsTheAssociatedOne) {
  LoadDetectionsOptions options;
  options.fps = 60;
  options.image_width = 1088;
  options.image_height = 1920;
  for (const char* view : {"cam01", "cam02"}) {
    options.view = view;
    const std::string folder = data_ + "/pose2sim/balancing/";
    const KeypointSequence all = LoadDetections(folder + "json_all_people", options);
    const KeypointSequence one = LoadDetections(folder + "json_single", options);
    EXPECT_EQ(all.convention, "body25b");
    ASSERT_EQ(all.num_frames(), one.num_frames());
    int same = 0;
    for (int t = 0; t < all.num_frames(); ++t) {
      // json_single holds the detections that four cameras agreed on, some of them re-associated between people.
      int equal = 0, seen = 0;
      for (int k = 0; k < 17; ++k) {
        if (!(one.at(t, k).confidence > 0) || !(all.at(t, k).confidence > 0)) continue;
        ++seen;
        equal += std::hypot(one.at(t, k).x - all.at(t, k).x, one.at(t, k).y - all.at(t, k).y) < 1;
      }
      same += seen > 5 && equal > seen / 2;
    }
    EXPECT_GT(same, 95) << view;
  }
}

TEST_F(RealDetections, TfjsPose) {
  const KeypointSequence squats = LoadDetections(data_ + "/tfjs_pose/pose_squats.full.json");
  EXPECT_EQ(squats.num_frames(), 65);
  EXPECT_EQ(squats.convention, "mediapipe33");
  EXPECT_NEAR(squats.at(0, 0).x, 360.1, 0.1);
  const KeypointSequence coco = LoadDetections(data_ + "/tfjs_pose/pose_1.json");
  EXPECT_EQ(coco.num_frames(), 120);
  EXPECT_EQ(coco.convention, "coco17");
}

}  // namespace
}  // namespace bodyloom::load_detections_test
