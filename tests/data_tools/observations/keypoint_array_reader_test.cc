// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "data_tools/observations/detection_readers.h"

#include "data_tools/formats/npz.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "data_tools/observations/load_detections.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/support/stick_person.h"

namespace bodyloom::keypoint_array_reader_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kArrayFrames = 3;

/// Pixel of a landmark of Human3.6M's order, too.
std::pair<double, double> PixelOf(const std::string& name, double x) {
  if (name == "spine") return {x, 440};
  if (name == "head_front") return {x, 350};
  return StickLandmark(name, x, 500, 400);
}

/// N × T × K × D landmarks of a convention: x at 300 + 10 t + 100 n, then confidences 0.75; the nose of frame 1 is NaN.
NdArray Landmarks(const KeypointConvention& convention, int per_point, int views = 0, size_t extra = 0) {
  std::vector<double> values;
  for (int n = 0; n < std::max(1, views); ++n) {
    for (int t = 0; t < kArrayFrames; ++t) {
      for (size_t k = 0; k < convention.names.size() + extra; ++k) {
        const std::string& name = convention.names[std::min(k, convention.names.size() - 1)];
        const auto [x, y] = PixelOf(name, 300 + 10 * t + 100 * n);
        const bool hidden = t == 1 && name == "nose";
        values.push_back(hidden ? NAN : x);
        values.push_back(hidden ? NAN : y);
        if (per_point == 3) values.push_back(hidden ? NAN : 0.75);
      }
    }
  }
  std::vector<int64_t> shape = {kArrayFrames, int64_t(convention.names.size() + extra), per_point};
  if (views > 0) shape.insert(shape.begin(), views);
  return NdArray::FromDoubles(values.data(), shape);
}

KeypointSequence Load(const NdArray& array, const LoadDetectionsOptions& options = {}) {
  return DetectionsFromBytes(NpyBytes(array), "k.npy", options);
}
std::string ErrorOf(const NdArray& array, const LoadDetectionsOptions& options = {}) {
  return FileErrorOf("k.npy", [&] { Load(array, options); });
}

void ExpectStick(const KeypointSequence& sequence, double x, float confidence) {
  ASSERT_EQ(sequence.num_frames(), kArrayFrames);
  for (int k = 0; k < sequence.num_points(); ++k) {
    const std::string& name = sequence.names[size_t(k)];
    const auto [px, py] = PixelOf(name, x + 20);
    EXPECT_NEAR(sequence.at(2, k).x, px, 1e-3) << name;
    EXPECT_NEAR(sequence.at(2, k).y, py, 1e-3) << name;
    EXPECT_EQ(sequence.at(2, k).confidence, confidence);
    if (name == "nose") {
      EXPECT_EQ(sequence.at(1, k).confidence, 0);
    }
  }
}

TEST(KeypointArray, CocosFamilyByItsNumber) {
  for (const KeypointConvention* convention : {&Coco17(), &CocoWholeBody23(), &Halpe26()}) {
    const KeypointSequence sequence = Load(Landmarks(*convention, 3));
    EXPECT_EQ(sequence.convention, convention->name);
    ExpectStick(sequence, 300, 0.75F);
    ExpectStick(Load(Landmarks(*convention, 2)), 300, 1);
  }
  ExpectStick(Load(Landmarks(CocoWholeBody23(), 3, 0, 110)), 300, 0.75F);
  EXPECT_NEAR(Load(Landmarks(Coco17(), 3), {.fps = 10}).timestamps[2], 0.2, 1e-12);
}

TEST(KeypointArray, SeveralCamerasOrPeople) {
  ExpectStick(Load(Landmarks(Coco17(), 3, 2), {.view = "1"}), 400, 0.75F);
  ExpectStick(Load(Landmarks(Coco17(), 3, 1)), 300, 0.75F);
  EXPECT_THAT(ErrorOf(Landmarks(Coco17(), 3, 2)), HasSubstr("no view chosen; the file has 2 cameras"));
  ExpectStick(Load(Landmarks(Coco17(), 3), {.view = "cam01"}), 300, 0.75F);
}

TEST(KeypointArray, AnArchiveWithOneArray) {
  const auto load = [](const NpzArrays& arrays) { return DetectionsFromBytes(NpzBytes(arrays), "k.npz"); };
  const NdArray landmarks = Landmarks(Coco17(), 3);
  ExpectStick(load({{"arr_0", landmarks}}), 300, 0.75F);
  ExpectStick(load({{"keypoints", landmarks}, {"boxes", NdArray::FromDouble(1)}}), 300, 0.75F);
  ExpectStick(load({{"kpts", landmarks}, {"video", NdArray::FromString("a.mp4")}}), 300, 0.75F);
  const auto error = [&](const NpzArrays& arrays) { return FileErrorOf("k.npz", [&] { load(arrays); }); };
  EXPECT_THAT(error({{"a", landmarks}, {"b", landmarks}}), HasSubstr("an .npz without 'keypoints'"));
  EXPECT_THAT(error({{"keypoints", landmarks}, {"keypoint_names", NdArray::FromStrings(CocoNames())}}),
              HasSubstr("timestamps"));
  EXPECT_THAT(error({{"a", NdArray::FromDouble(1)}}), HasSubstr("an .npz without 'keypoints'"));
}

/// The same person as 3D points, in units of 1 / scale px.
NdArray Points3d(double scale, double low, double high) {
  NdArray array = Landmarks(Coco17(), 3);
  std::vector<double> values = array.ToDoubles();
  for (size_t i = 0; i < values.size(); i += 3) {
    values[i] *= scale, values[i + 1] *= scale;
    values[i + 2] = low + (high - low) * double(i % 51) / 48;
  }
  return NdArray::FromDoubles(values.data(), array.shape);
}

TEST(KeypointArray, ThreeDimensionalPointsAreNotMistaken) {
  const auto is_refused = AllOf(HasSubstr("3D points or fractions of the image"), HasSubstr("--convention coco17"));
  EXPECT_THAT(ErrorOf(Points3d(1.7 / 368, 0, 1)), is_refused) << "metres, all depths from 0 to 1";
  EXPECT_THAT(ErrorOf(Points3d(1.7 / 368, -0.2, 0.2)), is_refused) << "metres about the hips";
  EXPECT_THAT(ErrorOf(Points3d(1700.0 / 368, -200, 200)), is_refused) << "millimetres";
  EXPECT_THAT(ErrorOf(Points3d(170.0 / 368, 0, 30)), is_refused) << "centimetres";
  EXPECT_THAT(ErrorOf(Points3d(1.0 / 1000, 0.5, 0.9)), is_refused) << "fractions of the image";
  const LoadDetectionsOptions said = {.image_width = 1000, .image_height = 1000, .convention = "coco17"};
  EXPECT_NEAR(Load(Points3d(1.0 / 1000, 0.5, 0.9), said).at(0, 0).x, 299.5, 1e-2) << "fractions, when it is said";
  EXPECT_THAT(ErrorOf(Points3d(1, -0.2, 0.2), said), HasSubstr("a third number of -0.2"));
  EXPECT_EQ(Load(Points3d(1, 0, 6), said).at(0, 16).confidence, 1) << "scores above 1 count as 1";
}

TEST(KeypointArray, Human36msOrderIsNotTakenForCocos) {
  for (const int per_point : {2, 3}) {
    const NdArray array = Landmarks(Human36m17(), per_point);
    EXPECT_THAT(ErrorOf(array), HasSubstr("give the order of the landmarks (--convention human36m17 or coco17)"));
    const KeypointSequence sequence = Load(array, {.convention = "human36m17"});
    EXPECT_EQ(sequence.names[3], "right_ankle");
    ExpectStick(sequence, 300, per_point == 3 ? 0.75F : 1);
  }
}

TEST(KeypointArray, OtherNumbersNeedTheirOrder) {
  EXPECT_THAT(ErrorOf(Landmarks(Body25(), 3)), HasSubstr("25 points, expected 17 (COCO)"));
  ExpectStick(Load(Landmarks(Body25(), 3), {.convention = "body25"}), 300, 0.75F);
  EXPECT_THAT(ErrorOf(Landmarks(Body25(), 3), {.convention = "coco17"}),
              HasSubstr("25 points, expected the 17 of coco17"));
  EXPECT_THAT(ErrorOf(Landmarks(Coco17(), 3), {.convention = "cocoo"}), HasSubstr("expected one of coco17, body25"));
}

TEST(KeypointArray, MalformedArraysAreErrors) {
  const double one = 1;
  EXPECT_THAT(ErrorOf(NdArray::FromDoubles(&one, {1, 1})), HasSubstr("an array of 1x1, expected landmarks"));
  EXPECT_THAT(ErrorOf(NdArray::FromStrings({"a"})), HasSubstr("of no numbers"));
  EXPECT_THAT(ErrorOf(NdArray::FromDoubles(&one, {0, 17, 3})), HasSubstr("expected 1 to"));
  const std::vector<double> nothing(kArrayFrames * 17 * 3, NAN);
  EXPECT_THAT(ErrorOf(NdArray::FromDoubles(nothing.data(), {kArrayFrames, 17, 2})), HasSubstr("nobody was detected"));
  ErrorOf(NdArray::FromDoubles(nothing.data(), {kArrayFrames, 17, 3}));
}

/// x = 100 camera + 10 t + k, y = 300 + k; the nose of frame 1 is not seen.
NdArray Landmarks(const std::vector<int64_t>& shape) {
  const bool has_cameras = shape.size() == 4;
  const size_t first = has_cameras ? 1 : 0;
  std::vector<double> values;
  for (int64_t c = 0; c < (has_cameras ? shape[0] : 1); ++c) {
    for (int64_t t = 0; t < shape[first]; ++t) {
      for (int64_t k = 0; k < shape[first + 1]; ++k) {
        const bool hidden = t == 1 && k == 0;
        values.push_back(hidden ? NAN : static_cast<double>(100 * c + 10 * t + k));
        values.push_back(hidden ? NAN : static_cast<double>(300 + k));
        for (int64_t more = 2; more < shape[first + 2]; ++more) values.push_back(0.5);
      }
    }
  }
  return NdArray::FromDoubles(values.data(), shape);
}

KeypointSequence Load(const std::vector<int64_t>& shape, const std::string& view) {
  LoadDetectionsOptions options;
  options.view = view;
  options.fps = 20;
  return DetectionsFromBytes(NpyBytes(Landmarks(shape)), "f.npy", options);
}
std::string ErrorOf(const std::vector<int64_t>& shape, const std::string& view = "0") {
  return FileErrorOf("f.npy", [&] { Load(shape, view); });
}

TEST(FreeMocap, MediaPipesBodyOfTheChosenCamera) {
  for (const int64_t per_point : {2, 3}) {
    const KeypointSequence sequence = Load({2, 3, 553, per_point}, "1");
    ASSERT_EQ(sequence.num_frames(), 3);
    EXPECT_EQ(sequence.convention, "mediapipe33");
    EXPECT_EQ(sequence.num_points(), 33);
    EXPECT_EQ(sequence.at(2, 5).x, 125);
    EXPECT_EQ(sequence.at(2, 5).y, 305);
    EXPECT_EQ(sequence.at(2, 5).confidence, 1);
    EXPECT_EQ(sequence.at(1, 0).confidence, 0);
    EXPECT_NEAR(sequence.timestamps[2], 0.1, 1e-12);
  }
}

TEST(FreeMocap, OneCameraAndRtmPose) {
  EXPECT_EQ(Load({2, 33, 2}, "").at(1, 7).x, 17);
  EXPECT_EQ(Load({1, 2, 133, 2}, "").num_points(), 23);
}

TEST(FreeMocap, SaysWhatTheArrayIs) {
  EXPECT_THAT(ErrorOf({2, 3, 553, 2}, ""), HasSubstr("no view chosen; the file has 2 cameras, 0 to 1"));
  EXPECT_THAT(ErrorOf({2, 3, 553, 2}, "c01"), HasSubstr("no view 'c01'"));
  EXPECT_THAT(ErrorOf({3, 33, 3}), HasSubstr("3D points, which are no detections of one camera"));
  EXPECT_THAT(ErrorOf({2, 3, 19, 2}), HasSubstr("19 points, expected 17 (COCO)"));
  const double one = 1;
  EXPECT_THAT(FileErrorOf("f.npy",
                          [&] {
                            DetectionsFromBytes(NpyBytes(NdArray::FromDoubles(&one, {1, 1})), "f.npy");
                          }),
              HasSubstr("expected landmarks, frames x points x 3 (x, y in pixels, confidence) or FreeMoCap's 2D"));
  EXPECT_THAT(ErrorOf({2, 0, 33, 2}), HasSubstr("frames"));
}

}  // namespace

}  // namespace bodyloom::keypoint_array_reader_test
