// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <gmock/gmock.h>

#include <cmath>

#include "data_tools/formats/zip.h"
#include "data_tools/observations/load_detections.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/object_npy_bytes.h"
#include "tests/data_tools/formats/pickle_writer.h"

namespace bodyloom::videopose3d_reader_test {
namespace {

using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
using ::testing::HasSubstr;

/// T × 17 × 2 with x = start + 100 t + k, y = 500 + k; landmark 3 of frame 1 is missing.
std::string Landmarks(int num_frames, double start) {
  std::vector<double> values;
  for (int t = 0; t < num_frames; ++t) {
    for (int k = 0; k < 17; ++k) {
      const bool hidden = t == 1 && k == 3;
      values.push_back(hidden ? NAN : start + 100 * t + k);
      values.push_back(hidden ? NAN : 500 + k);
    }
  }
  return Doubles2(values, {num_frames, 17, 2});
}
std::string List(const std::vector<std::string>& items) {
  std::string text = "](";
  for (const std::string& item : items) text += item;
  return text + "e";
}
std::string Symmetry(const std::vector<int>& left, const std::vector<int>& right) {
  std::vector<std::string> a, b;
  for (const int k : left) a.push_back(Int(k));
  for (const int k : right) b.push_back(Int(k));
  return List({List(a), List(b)});
}
std::string Archive(const std::string& positions, const Items& metadata) {
  return MakeZip({{"positions_2d.npy", ObjectNpyBytes(positions)}, {"metadata.npy", ObjectNpyBytes(Dict(metadata))}});
}
/// data_2d_h36m_gt.npz in small.
std::string Human36m(const Items& metadata) {
  return Archive(Dict({{Str2("S1"), Dict({{Str2("Walking 1"), List({Landmarks(3, 0), Landmarks(2, 1000)})},
                                          {Str2("Eating"), List({Landmarks(2, 2000)})}})},
                       {Str2("S5"), Dict({{Str2("Walking 1"), List({Landmarks(2, 3000)})}})}}),
                 metadata);
}
KeypointSequence Load(const std::string& bytes, const std::string& view = "", const std::string& convention = "") {
  return DetectionsFromBytes(bytes, "v.npz", {.view = view, .fps = 50, .convention = convention});
}

TEST(VideoPose3d, TheCustomDatasetIsCocoWithItsImageSize) {
  const std::string bytes =
      Archive(Dict({{Unicode("clip.mp4"), Dict({{Unicode("custom"), List({Landmarks(3, 100)})}})}}),
              {{Unicode("layout_name"), Unicode("coco")},
               {Unicode("num_joints"), Int(17)},
               {Unicode("video_metadata"),
                Dict({{Unicode("clip.mp4"), Dict({{Unicode("w"), Int(1920)}, {Unicode("h"), Int(1080)}})}})}});
  const KeypointSequence sequence = Load(bytes);
  ASSERT_EQ(sequence.num_frames(), 3);
  EXPECT_EQ(sequence.convention, "coco17");
  EXPECT_EQ(sequence.image_width, 1920);
  EXPECT_EQ(sequence.image_height, 1080);
  EXPECT_EQ(sequence.at(2, 16).x, 316);
  EXPECT_EQ(sequence.at(2, 16).y, 516);
  EXPECT_EQ(sequence.at(2, 16).confidence, 1);
  EXPECT_EQ(sequence.at(1, 3).confidence, 0);
  EXPECT_NEAR(sequence.timestamps[2], 0.04, 1e-12);
  EXPECT_EQ(Load(bytes, "cam01").num_frames(), 3) << "one view; the name is of the cameras' file";
}

TEST(VideoPose3d, SubjectsActionsAndCamerasOfHuman36m) {
  const std::string bytes = Human36m({{Str2("layout_name"), Str2("h36m")}});
  const KeypointSequence sequence = Load(bytes, "S1/Walking 1/1");
  EXPECT_EQ(sequence.convention, "human36m17");
  EXPECT_EQ(sequence.names[1], "right_hip");
  EXPECT_EQ(sequence.names[11], "left_shoulder");
  EXPECT_EQ(sequence.at(1, 0).x, 1100);
  EXPECT_EQ(Load(bytes, "Eating").at(0, 0).x, 2000) << "a part that only one view has";
  EXPECT_EQ(Load(bytes, "S5").at(0, 0).x, 3000);
  const auto error = [&](const std::string& view) { return FileErrorOf("v.npz", [&] { Load(bytes, view); }); };
  EXPECT_THAT(error(""), HasSubstr("no view chosen; the file has S1/Walking 1/0, S1/Walking 1/1, S1/Eating/0"));
  EXPECT_THAT(error("S1"), HasSubstr("3 views 'S1'"));
  EXPECT_THAT(error("S9"), HasSubstr("no view 'S9'"));
  EXPECT_THAT(error("Eat"), HasSubstr("no view 'Eat'"));
}

TEST(VideoPose3d, TheOrderWithoutALayoutIsThatOfTheSymmetryOrAskedFor) {
  const std::vector<int> coco_left = {1, 3, 5, 7, 9, 11, 13, 15}, coco_right = {2, 4, 6, 8, 10, 12, 14, 16};
  const std::vector<int> h36m_left = {4, 5, 6, 11, 12, 13}, h36m_right = {1, 2, 3, 14, 15, 16};
  const auto convention = [](const Items& metadata, const std::string& wanted = "") {
    return Load(Human36m(metadata), "S5", wanted).convention;
  };
  EXPECT_EQ(convention({{Str2("keypoints_symmetry"), Symmetry(coco_left, coco_right)}}), "coco17");
  EXPECT_EQ(convention({{Str2("keypoints_symmetry"), Symmetry(h36m_left, h36m_right)}}), "human36m17");
  const Items nothing = {{Str2("num_joints"), Int(17)}};
  EXPECT_EQ(convention(nothing, "coco17"), "coco17");
  EXPECT_THAT(FileErrorOf("v.npz", [&] { convention(nothing); }),
              HasSubstr("metadata without 'layout_name', which does not tell the order of the landmarks; give it "
                        "(--convention coco17 or human36m17)"));
  EXPECT_THAT(FileErrorOf("v.npz", [&] { convention({{Str2("layout_name"), Str2("mpii")}}); }), HasSubstr("'mpii'"));
  EXPECT_THAT(FileErrorOf("v.npz", [&] { convention(nothing, "body25"); }), HasSubstr("expected coco17 or human36m17"));
}

TEST(VideoPose3d, MalformedFilesAreErrors) {
  const Items coco = {{Str2("layout_name"), Str2("coco")}};
  const auto error = [&](const std::string& positions) {
    return FileErrorOf("v.npz", [&] { Load(Archive(positions, coco)); });
  };
  const auto camera = [](const std::string& value) {
    return Dict({{Str2("S1"), Dict({{Str2("a"), List({value, value})}})}});
  };
  EXPECT_THAT(error(Dict({})), HasSubstr("expected a table that is not empty"));
  EXPECT_THAT(error(Dict({{Str2("S1"), Int(3)}})), HasSubstr("a subject: expected a table"));
  EXPECT_THAT(error(camera(Doubles2({1, 2}, {1, 1, 2}))), HasSubstr("S1/a/0: shape 1x1x2, expected frames x 17 x 2"));
  EXPECT_THAT(error(camera(Int(3))), HasSubstr("S1/a/0: no array"));
  EXPECT_THAT(error(Dict({{Str2("S1"), Dict({{Str2("a"), Landmarks(2, 0)}})}})),
              HasSubstr("expected a list of cameras"));
  EXPECT_THAT(error(Dict({{Str2("S1"), Dict({{Str2("a"), List({Doubles2({}, {0, 17, 2})})}})}})),
              HasSubstr("0 frames"));
  EXPECT_THAT(error(Global("os", "system")), HasSubstr("v.npz: 'positions_2d'"));
  EXPECT_THAT(FileErrorOf("v.npz",
                          [&] {
                            Load(MakeZip({{"positions_2d.npy", ObjectNpyBytes(camera(Landmarks(2, 0)))}}));
                          }),
              HasSubstr("no array 'metadata'"));
}

}  // namespace
}  // namespace bodyloom::videopose3d_reader_test
