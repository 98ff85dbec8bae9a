// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/part_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/part_label_evaluation.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/body/posed_body.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/rendered_labels.h"
#include "tracking/lifter/given_landmarks.h"

namespace bodyloom::part_labels_test {
namespace {

using ::testing::HasSubstr;

/// One frame of 40×30 with a person of two parts, 12×20 px, at (10, 5).
std::vector<uint8_t> SmallPerson() {
  std::vector<uint8_t> labels(40 * 30, 0);
  for (int y = 5; y < 25; ++y) {
    for (int x = 10; x < 22; ++x) labels[y * 40 + x] = y < 15 ? 2 : 9;
  }
  return labels;
}

NpzArrays Archive(const std::vector<uint8_t>& labels, std::vector<int64_t> shape) {
  return {{"labels", NdArray::FromUInt8(labels.data(), std::move(shape))}};
}

TEST(PartLabels, CutsToThePerson) {
  const PartLabelSequence labels = PartLabelsFromNpz(Archive(SmallPerson(), {1, 30, 40}), "l.npz");
  ASSERT_EQ(labels.num_frames(), 1);
  EXPECT_EQ(labels.image_width, 40);
  EXPECT_EQ(labels.image_height, 30);
  const LabelImage image = labels.frames[0].Unpacked();
  EXPECT_EQ(image.x_begin, 10);
  EXPECT_EQ(image.y_begin, 5);
  EXPECT_EQ(image.width, 12);
  EXPECT_EQ(image.height, 20);
  EXPECT_EQ(image.At(10, 5), 2);
  EXPECT_EQ(image.At(21, 24), 9);
  EXPECT_EQ(image.At(9, 5), 0);
}

TEST(PartLabels, AMaskComesBackAsOne) {
  PartLabelSequence mask;
  mask.image_width = 40;
  mask.image_height = 30;
  mask.timestamps = {0, 0.5, 0.75};
  LabelImage last{30, 20, 10, 10, std::vector<uint8_t>(100, 1)};
  mask.frames = {LabelImage{10, 5, 12, 20, std::vector<uint8_t>(240, 7)}, {}, last};
  const TemporaryFolder folder;
  WriteMask(folder.File("mask.npz"), mask);
  const PartLabelSequence read = ReadPartLabels(folder.File("mask.npz"));
  EXPECT_EQ(read.timestamps, mask.timestamps);
  EXPECT_EQ(read.part_of_chart[5], 1) << "every chart belongs to the person";
  for (int t = 0; t < 3; ++t) {
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 40; ++x) {
        ASSERT_EQ(read.PartAt(t, x, y), mask.frames[t].At(x, y) != 0 ? 1 : 0) << t << ": " << x << ", " << y;
      }
    }
  }
  last.x_begin = 31;
  mask.frames[2] = last;
  EXPECT_THROW(WriteMask(folder.File("other.npz"), mask), std::invalid_argument);
  mask.timestamps.pop_back();
  EXPECT_THROW(WriteMask(folder.File("other.npz"), mask), std::invalid_argument);
}

TEST(PartLabels, AMaskAsImagesIsRead) {
  NpzArrays archive = Archive(SmallPerson(), {1, 30, 40});
  archive["label_kind"] = NdArray::FromString("person");
  const PartLabelSequence read = PartLabelsFromNpz(archive, "l.npz");
  EXPECT_EQ(read.PartAt(0, 10, 5), 1);
  EXPECT_EQ(read.PartAt(0, 9, 5), 0);
}

// Two minutes of a 1080p video, as pictures 7 GB.
TEST(PartLabels, AMaskOfALongClipIsSmall) {
  PartLabelSequence mask;
  mask.image_width = 1920, mask.image_height = 1080;
  LabelImage person{700, 100, 400, 900, std::vector<uint8_t>(400 * 900, 0)};
  for (int y = 0; y < 900; ++y) {
    for (int x = 150 - y / 8; x < 250 + y / 8; ++x) person.labels[y * 400 + x] = 1;
  }
  constexpr int kWritten = 3600;
  for (int t = 0; t < kWritten; ++t) {
    person.x_begin = 700 + t / 40;
    mask.frames.emplace_back(t == 81 ? LabelImage() : person);
    mask.timestamps.push_back(t / 30.0);
  }
  const TemporaryFolder folder;
  WriteMask(folder.File("mask.npz"), mask);
  EXPECT_LT(std::filesystem::file_size(folder.File("mask.npz")), 8U << 20);
  const PartLabelSequence read = ReadPartLabels(folder.File("mask.npz"));
  ASSERT_EQ(read.num_frames(), kWritten);
  EXPECT_EQ(read.frames[80].Unpacked().x_begin, 702 + 150 - 899 / 8);
  EXPECT_EQ(read.PartAt(80, 702 + 150, 100), 1);
  EXPECT_EQ(read.PartAt(80, 702 + 149, 100), 0);
  EXPECT_TRUE(read.frames[81].empty());
}

TEST(PartLabels, MasksThatCannotBeAreErrors) {
  PartLabelSequence mask;
  mask.image_width = 40, mask.image_height = 30;
  mask.frames = {LabelImage{10, 5, 3, 2, {0, 1, 1, 1, 0, 0}}, {}};
  const NpzArrays good = MaskRuns(mask);
  EXPECT_EQ(good.at("mask_runs").ToInts(), (std::vector<int64_t>{1, 3, 2}));
  const auto error = [&](const std::string& name, std::vector<int32_t> values, std::vector<int64_t> shape) {
    NpzArrays arrays = good;
    arrays[name] = NdArray::FromInts32(values.data(), std::move(shape));
    return FileErrorOf("m.npz", [&] { PartLabelsFromNpz(arrays, "m.npz"); });
  };
  EXPECT_THAT(error("mask_runs", {1, 3, 1}, {3}), HasSubstr("frame 0: runs of 5 pixels for a box of 6"));
  EXPECT_THAT(error("mask_runs", {1, 3, 3}, {3}), HasSubstr("frame 0: runs that are not the box's 6 pixels"));
  EXPECT_THAT(error("mask_runs", {1, -3, 8}, {3}), HasSubstr("frame 0"));
  EXPECT_THAT(error("mask_runs", {1, 3, 2, 7}, {4}), HasSubstr("mask_runs has 4 runs, mask_count says 3"));
  EXPECT_THAT(error("mask_count", {4, 0}, {2}), HasSubstr("frame 0: more runs"));
  EXPECT_THAT(error("mask_count", {2, 1}, {2}), HasSubstr("frame 0"));
  EXPECT_THAT(error("mask_count", {-1, 0}, {2}), HasSubstr("frame 0"));
  EXPECT_THAT(error("mask_box", {38, 5, 3, 2, 0, 0, 0, 0}, {2, 4}), HasSubstr("frame 0: mask_box leaves the image"));
  EXPECT_THAT(error("mask_box", {2147483647, 5, 3, 2, 0, 0, 0, 0}, {2, 4}), HasSubstr("leaves the image"));
  EXPECT_THAT(error("mask_box", {0, 0, 0, 0, 0, 0, 0, 0}, {2, 4}), HasSubstr("frame 0: runs without a box"));
  EXPECT_THAT(error("mask_box", {0, 0, 3, 2}, {1, 4}), HasSubstr("mask_box: shape 1x4, expected 2 x 4"));
  EXPECT_THAT(error("image_size", {40, 0}, {2}), HasSubstr("image_size 40 x 0"));
  // A few bytes that ask for a gigabyte.
  NpzArrays bomb = good;
  const std::vector<int32_t> size = {30000, 30000}, boxes = {0, 0, 30000, 30000, 0, 0, 0, 0}, runs = {900000000, 0, 0};
  bomb["image_size"] = NdArray::FromInts32(size.data(), {2});
  bomb["mask_box"] = NdArray::FromInts32(boxes.data(), {2, 4});
  bomb["mask_runs"] = NdArray::FromInts32(runs.data(), {3});
  EXPECT_THAT(FileErrorOf("m.npz", [&] { PartLabelsFromNpz(bomb, "m.npz"); }), HasSubstr("too many for 3 runs"));
}

TEST(PartLabels, TheKindOfLabelsIsOneOfTwo) {
  NpzArrays archive = Archive(SmallPerson(), {1, 30, 40});
  archive["label_kind"] = NdArray::FromString("densepose");
  EXPECT_EQ(PartLabelsFromNpz(archive, "l.npz").PartAt(0, 10, 5), 2);
  archive["label_kind"] = NdArray::FromString("cat");
  EXPECT_THAT(FileErrorOf("l.npz", [&] { PartLabelsFromNpz(archive, "l.npz"); }), HasSubstr("label_kind: 'cat'"));
  archive["label_kind"] = NdArray::FromDouble(3);
  EXPECT_THAT(FileErrorOf("l.npz", [&] { PartLabelsFromNpz(archive, "l.npz"); }), HasSubstr("label_kind"));
}

TEST(PartLabels, WholeNumbersOfAnyTypeAreLabels) {
  const std::vector<uint8_t> person = SmallPerson();
  const std::vector<int32_t> wide(person.begin(), person.end());
  std::vector<int64_t> wider(person.begin(), person.end());
  NdArray int64 = NdArray::FromUInt8(nullptr, {0});
  int64.dtype = DType::kI64, int64.item_size = 8, int64.shape = {1, 30, 40};
  int64.bytes.assign(reinterpret_cast<const char*>(wider.data()), wider.size() * 8);
  for (const NdArray& labels : {NdArray::FromInts32(wide.data(), {1, 30, 40}), int64}) {
    const PartLabelSequence read = PartLabelsFromNpz({{"labels", labels}}, "l.npz");
    EXPECT_EQ(read.PartAt(0, 10, 5), 2);
    EXPECT_EQ(read.PartAt(0, 21, 24), 9);
    EXPECT_EQ(read.PartAt(0, 9, 5), 0);
  }
  const auto error = [](int32_t label) {
    const std::vector<int32_t> labels(1200, label);
    return FileErrorOf("l.npz", [&] {
      PartLabelsFromNpz({{"labels", NdArray::FromInts32(labels.data(), {1, 30, 40})}}, "l.npz");
    });
  };
  EXPECT_THAT(error(256), HasSubstr("element 0 is 256, expected 0 to 255"));
  EXPECT_THAT(error(-1), HasSubstr("element 0 is -1"));
  EXPECT_THAT(error(25), HasSubstr("pixel (0, 0) is 25, expected 0 to 24"));
}

TEST(PartLabels, OneLabelAloneIsAMask) {
  std::vector<uint8_t> bytes = SmallPerson();
  for (const int white : {1, 255}) {
    for (uint8_t& label : bytes) label = label != 0 ? uint8_t(white) : 0;
    NpzArrays archive = Archive(bytes, {1, 30, 40});
    const PartLabelSequence read = PartLabelsFromNpz(archive, "l.npz");
    EXPECT_EQ(read.PartAt(0, 10, 5), 1);
    EXPECT_EQ(read.part_of_chart[9], 1) << "every chart belongs to the person";
    EXPECT_EQ(read.frames[0].Unpacked().height, 20);
    archive["label_kind"] = NdArray::FromString("person");
    EXPECT_EQ(PartLabelsFromNpz(archive, "l.npz").part_of_chart[9], 1);
    archive["label_kind"] = NdArray::FromString("densepose");
    if (white == 1) {
      EXPECT_EQ(PartLabelsFromNpz(archive, "l.npz").part_of_chart[9], 9) << "said to be parts";
    } else {
      EXPECT_THAT(FileErrorOf("l.npz", [&] { PartLabelsFromNpz(archive, "l.npz"); }), HasSubstr("is 255"));
    }
  }
  for (uint8_t& label : bytes) label = label != 0 ? 1 : 0;
  NpzArrays booleans = Archive(bytes, {1, 30, 40});
  booleans["labels"].dtype = DType::kBool;
  EXPECT_EQ(PartLabelsFromNpz(booleans, "l.npz").part_of_chart[9], 1);
  bytes[5 * 40 + 10] = 2;
  EXPECT_EQ(PartLabelsFromNpz(Archive(bytes, {1, 30, 40}), "l.npz").part_of_chart[9], 9) << "two labels are parts";
}

TEST(PartLabels, ABareArrayIsTheLabels) {
  const TemporaryFolder folder;
  const std::vector<uint8_t> person = SmallPerson();
  WriteNpy(folder.File("l.npy"), NdArray::FromUInt8(person.data(), {1, 30, 40}));
  EXPECT_EQ(ReadPartLabels(folder.File("l.npy")).PartAt(0, 21, 24), 9);
  WriteNpy(folder.File("s.npy"), NdArray::FromUInt8(person.data(), {30, 40}));
  EXPECT_THAT(FileErrorOf("s.npy", [&] { ReadPartLabels(folder.File("s.npy")); }), HasSubstr("shape 30x40"));
}

TEST(PartLabels, FramesLastAreRefused) {
  const auto error = [](NpzArrays archive) {
    return FileErrorOf("l.npz", [&] { PartLabelsFromNpz(archive, "l.npz"); });
  };
  const std::vector<uint8_t> nothing(60 * 80 * 10, 0);
  EXPECT_THAT(error(Archive(nothing, {60, 80, 10})),
              HasSubstr("shape 60x80x10, which looks like height x width x frames; expected frames first "
                        "(np.moveaxis(labels, -1, 0))"));
  const std::vector<double> times(30, 0);
  NpzArrays archive = Archive(nothing, {20, 80, 30});
  archive["timestamps"] = NdArray::FromDoubles(times.data(), {30});
  EXPECT_THAT(error(archive), HasSubstr("expected frames first"));
  EXPECT_EQ(PartLabelsFromNpz(Archive(nothing, {10, 60, 80}), "l.npz").num_frames(), 10);
  EXPECT_EQ(PartLabelsFromNpz(Archive(nothing, {2, 400, 60}), "l.npz").num_frames(), 2) << "a narrow image";
}

TEST(PartLabels, FarBlobsAreNotThePersonAndNearOnesAre) {
  std::vector<uint8_t> bytes = SmallPerson();
  bytes[5 * 40 + 38] = bytes[6 * 40 + 38] = 3;  // 16 px away
  bytes[16 * 40 + 24] = 4;                      // 2 px away: a hand that something hides in part
  ReadPartLabelsOptions options;
  options.mend_strays = false;
  int64_t dropped = 0;
  const PartLabelSequence labels = PartLabelsFromNpz(Archive(bytes, {1, 30, 40}), "l.npz", options, &dropped);
  EXPECT_EQ(dropped, 2);
  EXPECT_EQ(labels.PartAt(0, 38, 5), 0);
  EXPECT_EQ(labels.PartAt(0, 24, 16), 4);
}

TEST(PartLabels, ThinLinesOfFalseLabelsGiveWay) {
  std::vector<uint8_t> bytes = SmallPerson();
  for (int x = 10; x < 22; ++x) bytes[15 * 40 + x] = 7;  // between parts 2 and 9
  bytes[10 * 40 + 16] = 20;                              // a speck inside part 2
  const PartLabelSequence mended = PartLabelsFromNpz(Archive(bytes, {1, 30, 40}), "l.npz");
  for (int y = 5; y < 25; ++y) {
    for (int x = 10; x < 22; ++x) {
      const int label = mended.PartAt(0, x, y);
      EXPECT_EQ(label, y < 15 ? 2 : y > 15 ? 9 : label) << x << ", " << y;
      EXPECT_TRUE(label == 2 || label == 9) << x << ", " << y << ": " << label;
    }
  }
  ReadPartLabelsOptions options;
  options.mend_strays = false;
  EXPECT_EQ(PartLabelsFromNpz(Archive(bytes, {1, 30, 40}), "l.npz", options).PartAt(0, 16, 10), 20);
}

TEST(PartLabels, AnEmptyFrameIsNobody) {
  const PartLabelSequence labels = PartLabelsFromNpz(Archive(std::vector<uint8_t>(2400, 0), {2, 30, 40}), "l.npz");
  ASSERT_EQ(labels.num_frames(), 2);
  EXPECT_TRUE(labels.frames[1].empty());
  EXPECT_NEAR(labels.timestamps[1], 1 / 30.0, 1e-12);
}

TEST(PartLabels, MalformedArchivesAreErrors) {
  const auto error = [](const NpzArrays& arrays) {
    return FileErrorOf("l.npz", [&] { PartLabelsFromNpz(arrays, "l.npz"); });
  };
  EXPECT_THAT(error({}), HasSubstr("labels"));
  EXPECT_THAT(error(Archive(SmallPerson(), {30, 40})), HasSubstr("frames x height x width"));
  EXPECT_THAT(error(Archive({}, {0, 30, 40})), HasSubstr("at least one frame"));
  std::vector<uint8_t> bytes = SmallPerson();
  bytes[7 * 40 + 12] = 25;
  EXPECT_THAT(error(Archive(bytes, {1, 30, 40})), HasSubstr("frame 0, pixel (12, 7) is 25"));
  const std::vector<double> doubles(1200, 1);
  EXPECT_THAT(error({{"labels", NdArray::FromDoubles(doubles.data(), {1, 30, 40})}}), HasSubstr("uint8"));
  NpzArrays late = Archive(SmallPerson(), {1, 30, 40});
  const double times[2] = {0, 1};
  late["timestamps"] = NdArray::FromDoubles(times, {2});
  EXPECT_THAT(error(late), HasSubstr("1 frames but 2 timestamps"));
}

class LabelsOfADance : public ::testing::Test {
 protected:
  static const SynthClip& Clip() {
    static const SynthClip clip = [] {
      SynthClipOptions options;
      options.dense_per_frame = 0;
      return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 24, 4), options);
    }();
    return clip;
  }
  static const PartLabelSequence& Labels() {
    static const PartLabelSequence labels = RenderPartLabels(BuiltinBody(), Clip().truth);
    return labels;
  }
};

TEST_F(LabelsOfADance, TheTruthCoversItsOwnLabels) {
  const Evaluation same = EvaluatePartLabels(Clip().truth, Labels(), BuiltinBody());
  EXPECT_EQ(same.Value("silhouette_iou"), 1);
  EXPECT_EQ(same.Value("part_iou"), 1);
  EXPECT_EQ(same.Value("limb_iou"), 1);
  EXPECT_EQ(same.Value("label_accuracy"), 1);
  Track shifted = Clip().truth;
  shifted.motion.trans.col(0).array() += 0.05;
  const Evaluation moved = EvaluatePartLabels(shifted, Labels(), BuiltinBody());
  EXPECT_LT(moved.Value("silhouette_iou"), 0.9);
  EXPECT_LT(moved.Value("part_iou"), moved.Value("silhouette_iou"));
  EXPECT_GT(moved.Value("limb_iou"), moved.Value("part_iou"));
  Track lost = Clip().truth;
  lost.motion.poses.setConstant(std::nan(""));
  const Evaluation nothing = EvaluatePartLabels(lost, Labels(), BuiltinBody());
  EXPECT_EQ(nothing.Value("silhouette_iou"), 0);
  EXPECT_EQ(nothing.frames_without_result, nothing.frames);
}

TEST_F(LabelsOfADance, JointsAreWherePartsMeet) {
  const KeypointSequence read = KeypointsFromPartLabels(Labels());
  const KeypointSequence& truth = Clip().keypoints_truth;
  ASSERT_EQ(read.num_frames(), truth.num_frames());
  for (const std::string joint : {"elbow", "wrist", "hip", "knee", "ankle", "shoulder"}) {
    std::vector<double> errors;
    for (const std::string side : {"left_", "right_"}) {
      const auto column = [&](const KeypointSequence& k) {
        return std::find(k.names.begin(), k.names.end(), side + joint) - k.names.begin();
      };
      for (int t = 0; t < read.num_frames(); ++t) {
        const Keypoint &a = read.at(t, int(column(read))), &b = truth.at(t, int(column(truth)));
        if (!(a.confidence > 0)) continue;
        errors.push_back(std::hypot(a.x - b.x, a.y - b.y) / Labels().frames[t].Unpacked().height);
      }
    }
    ASSERT_GT(errors.size(), 24U) << joint << " is read in too few frames";
    std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.05) << joint << ": median distance as a share of the person's height";
  }
}

TEST_F(LabelsOfADance, MirroredLabelsGiveMirroredJoints) {
  // The charts of left and right exchanged (DensePose's own list of pairs): every left joint becomes a right one.
  constexpr std::array<uint8_t, 25> kMirror = {0,  1,  2,  4,  3,  6,  5,  8,  7,  10, 9,  12, 11,
                                               14, 13, 16, 15, 18, 17, 20, 19, 22, 21, 24, 23};
  PartLabelSequence mirrored = Labels();
  for (int label = 0; label < 25; ++label) mirrored.part_of_label[label] = kMirror[label];
  const KeypointSequence a = KeypointsFromPartLabels(Labels()), b = KeypointsFromPartLabels(mirrored);
  for (int t = 0; t < a.num_frames(); ++t) {
    for (const auto& [left, right] : {std::pair(7, 8), std::pair(9, 10), std::pair(13, 14), std::pair(17, 18)}) {
      EXPECT_EQ(a.at(t, left).x, b.at(t, right).x);
      EXPECT_EQ(a.at(t, left).confidence, b.at(t, right).confidence);
    }
  }
}

TEST(PartKeypoints, NobodyGivesNothing) {
  PartLabelSequence labels;
  labels.image_width = labels.image_height = 10;
  labels.timestamps = {0, 1};
  labels.frames.resize(2);
  labels.frames[1] = LabelImage{2, 2, 3, 3, std::vector<uint8_t>(9, PartLabelSequence::kUnknown)};
  for (const Keypoint& point : KeypointsFromPartLabels(labels).points) EXPECT_EQ(point.confidence, 0);
  EXPECT_THROW(KeypointsFromPartLabels({}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::part_labels_test
