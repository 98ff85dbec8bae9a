// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/freemocap_reader.h"

#include <gmock/gmock.h>

#include <cmath>

#include "data_tools/formats/npz.h"
#include "data_tools/observations/load_detections.h"
#include "tests/data_tools/formats/expect_file_error.h"

namespace bodyloom::freemocap_reader_test {
namespace {

using ::testing::HasSubstr;

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
}  // namespace bodyloom::freemocap_reader_test
