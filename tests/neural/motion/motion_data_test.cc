// SPDX-License-Identifier: Apache-2.0
// Training data of the motion-dependent renderer: a dataset's truth, or its substitutes in a user's clip.
#include "pipelines/neural/motion/motion_data.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/people/make_single_person_dataset.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::motion_data_test {
namespace {

constexpr int kFrames = 4, kSide = 160;

class MotionDataOfAClip : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    MakeSinglePersonDatasetOptions options;
    options.size_px = kSide;
    options.garment = GarmentKind::kSuit;  // close to the skin: what the body says is nearly true
    options.num_threads = 1;
    scratch_ = new ScratchFolder;
    MakeSinglePersonDataset(*scratch_ / "person", BuiltinBody(),
                            TakeFrames(DemoMotion(BuiltinBody(), 60, 30), 20, kFrames), options);
    const SinglePersonDataset set(*scratch_ / "person");
    PartLabelSequence mask;
    mask.image_width = mask.image_height = kSide;
    for (int t = 0; t < kFrames; ++t) {
      const Image labels = set.Read(t, {true, false, false, false}).labels;
      LabelImage frame = {0, 0, kSide, kSide, std::vector<uint8_t>(size_t(kSide) * kSide)};
      for (size_t i = 0; i < frame.labels.size(); ++i) frame.labels[i] = labels.bgr[3 * i] != 0 ? 1 : 0;
      mask.frames.emplace_back(frame);
      mask.timestamps.push_back(t / 30.0);
    }
    WriteMask(*scratch_ / "mask.npz", mask);
  }
  static void TearDownTestSuite() { delete scratch_; }

  static MotionFrame FrameOf(const MotionDataRequest& request) {
    MotionData data(request, MotionProfileNamed("tiny"), 16);
    EXPECT_TRUE(data.has_labels());
    EXPECT_TRUE(data.has_normals());
    MotionFrame frame;
    data.Fill(2, true, &frame);
    return frame;
  }
  static inline ScratchFolder* scratch_ = nullptr;
};

TEST_F(MotionDataOfAClip, LabelsAndNormalsOfTheMaskAreNearThoseOfTheTruth) {
  MotionDataRequest request;
  request.data = *scratch_ / "person";
  const MotionFrame truth = FrameOf(request);
  request.data = *scratch_ / "person/images", request.track = *scratch_ / "person/track.npz";
  request.mask = *scratch_ / "mask.npz";
  const MotionFrame own = FrameOf(request);
  ASSERT_EQ(own.width, truth.width);
  EXPECT_EQ(own.image, truth.image) << "the outline decides what is seen";
  const size_t area = size_t(truth.width) * truth.height;
  int person = 0, same = 0, angles = 0;
  double degrees = 0;
  for (size_t i = 0; i < area; ++i) {
    ASSERT_EQ(own.labels[i] != 0, truth.labels[i] != 0);
    if (truth.labels[i] == 0) continue;
    ++person;
    same += own.labels[i] == truth.labels[i] ? 1 : 0;
    double dot = 0, of_truth = 0, of_own = 0;
    for (size_t c = 0; c < 3; ++c) {
      dot += double(own.normals[area * c + i]) * truth.normals[area * c + i];
      of_truth += std::pow(truth.normals[area * c + i], 2), of_own += std::pow(own.normals[area * c + i], 2);
    }
    ASSERT_NEAR(of_own, 1, 1e-3);
    if (of_truth == 0) continue;
    ++angles;
    degrees += std::acos(std::clamp(dot, -1.0, 1.0)) * 180 / M_PI;
  }
  ASSERT_GT(person, 500);
  EXPECT_GT(same, 0.7 * person);
  EXPECT_GT(angles, 0.9 * person);
  EXPECT_LT(degrees / angles, 20);
}

}  // namespace
}  // namespace bodyloom::motion_data_test
