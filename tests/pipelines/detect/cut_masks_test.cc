// SPDX-License-Identifier: Apache-2.0
#include "pipelines/detect/cut_masks.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "data_tools/video/image_file.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/tracking/detection/masked_clip.h"

namespace bodyloom::cut_masks_test {
namespace {

/// The pictures in a folder, and coarse masks of the person in them.
struct Scene {
  TemporaryFolder folder;
  DetectPeopleRequest request;
  DetectedClip detected;

  explicit Scene(const MaskedClip& clip) {
    request.video = folder.File("pictures");
    std::filesystem::create_directories(request.video);
    detected.people.image_width = MaskedClip::kWidth, detected.people.image_height = MaskedClip::kHeight;
    for (size_t t = 0; t < clip.images.size(); ++t) {
      WriteImage(folder.File("pictures/" + std::to_string(1000 + t) + ".png"), clip.images[t]);
      detected.people.frames.emplace_back(1);
      detected.people.timestamps.push_back(double(t) / 30);
      detected.masks.push_back({LabelImage{0, 0, MaskedClip::kWidth, MaskedClip::kHeight, clip.CoarseMask(int(t))}});
    }
  }
  [[nodiscard]] std::vector<uint8_t> MaskAt(size_t t) const {
    std::vector<uint8_t> mask;
    for (int y = 0; y < MaskedClip::kHeight; ++y) {
      for (int x = 0; x < MaskedClip::kWidth; ++x) mask.push_back(detected.masks[t][0].At(x, y));
    }
    return mask;
  }
};

TEST(CutMasks, AreThePersonsOwn) {
  const MaskedClip clip(24);
  Scene scene(clip);
  ASSERT_TRUE(CutMasks(scene.request, 2, &scene.detected));
  for (size_t t = 0; t < clip.masks.size(); ++t) EXPECT_GT(OverlapOf(scene.MaskAt(t), clip.masks[t]), 0.97) << t;
}

TEST(CutMasks, DoNotDependOnThreads) {
  const MaskedClip clip(16);
  Scene one(clip), five(clip);
  ASSERT_TRUE(CutMasks(one.request, 1, &one.detected) && CutMasks(five.request, 5, &five.detected));
  for (size_t t = 0; t < clip.masks.size(); ++t) EXPECT_EQ(one.MaskAt(t), five.MaskAt(t)) << t;
}

TEST(CutMasks, StayWhereNothingCanBeGained) {
  for (const MaskedClip& clip : {MaskedClip(24, 3), MaskedClip(9)}) {
    Scene scene(clip);
    EXPECT_FALSE(CutMasks(scene.request, 1, &scene.detected));
    EXPECT_EQ(scene.MaskAt(4), clip.CoarseMask(4));
  }
  Scene without(MaskedClip(24));
  without.detected.masks.clear();
  EXPECT_FALSE(CutMasks(without.request, 1, &without.detected));
}

TEST(CutMasks, FramesThatWereNotDetectedAreNotTakenForTheBackground) {
  const MaskedClip clip(24);
  Scene scene(clip);
  for (size_t t = 0; t < 24; ++t) {
    if (t % 2 != 0) scene.detected.masks[t][0] = {};
  }
  ASSERT_TRUE(CutMasks(scene.request, 1, &scene.detected));
  for (size_t t = 0; t < 24; ++t) {
    if (t % 2 == 0) {
      EXPECT_GT(OverlapOf(scene.MaskAt(t), clip.masks[t]), 0.95) << t;
    } else {
      EXPECT_TRUE(scene.detected.masks[t][0].empty()) << t;
    }
  }
}

TEST(CutMasks, CanBeStopped) {
  Scene scene(MaskedClip(16));
  PipelineCallbacks callbacks;
  callbacks.progress = [](const std::string&, double) { return false; };
  EXPECT_THROW(CutMasks(scene.request, 1, &scene.detected, callbacks), Cancelled);
}

}  // namespace
}  // namespace bodyloom::cut_masks_test
