// SPDX-License-Identifier: Apache-2.0
// A clip filmed through a lens that distorts gives the training views of the same clip filmed without distortion.
#include "pipelines/gaussian_avatar/avatar_clip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/video/image_file.h"
#include "pipelines/synthesis/synthesize_person.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::avatar_clip_test {
namespace {

constexpr int kFrames = 3, kSize = 192;

/// The image of the same scene through the camera's lens: each pixel takes the nearest one that an ideal lens shows.
Image ThroughLens(const Image& ideal, const Camera& lens) {
  Image seen(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const Eigen::Vector2d ray = lens.Unproject({x, y});
      const int u = int(std::lround(lens.fx * ray.x() + lens.cx)), v = int(std::lround(lens.fy * ray.y() + lens.cy));
      if (u < 0 || v < 0 || u >= kSize || v >= kSize) continue;
      std::copy_n(ideal.pixel(u, v), 3, seen.pixel(x, y));
    }
  }
  return seen;
}

/// Writes images and mask of the dataset's person as a clip, through a lens of this k1, with the track; returns the
/// request for it.
AvatarClipRequest WriteClip(const SinglePersonDataset& set, double k1, const std::string& folder) {
  std::filesystem::create_directories(folder + "/images");
  Track track = set.track();
  track.camera.distortion[0] = k1;
  PartLabelSequence mask;
  mask.image_width = mask.image_height = kSize;
  for (int t = 0; t < kFrames; ++t) {
    const PersonFrame frame = set.Read(t);
    WriteImage(folder + "/images/" + std::to_string(t) + ".png", ThroughLens(frame.rgb, track.camera));
    const Image labels = ThroughLens(frame.labels, track.camera);
    LabelImage person = {0, 0, kSize, kSize, std::vector<uint8_t>(kSize * kSize)};
    for (int i = 0; i < kSize * kSize; ++i) person.labels[size_t(i)] = labels.bgr[3 * size_t(i)] != 0 ? 1 : 0;
    mask.frames.emplace_back(person);
    mask.timestamps.push_back(t / 30.0);
  }
  AvatarClipRequest request;
  request.data = folder + "/images";
  request.track = folder + "/track.npz";
  request.mask = folder + "/mask.npz";
  WriteTrack(request.track, track);
  WriteMask(request.mask, mask);
  return request;
}

TEST(AvatarClip, ViewsThroughALensAreCorrected) {
  const TemporaryFolder folder;
  SynthesizePersonRequest person;
  person.motions = {"demo"};
  person.out = folder.File("person");
  person.motion.num_frames = kFrames;
  person.set.size_px = kSize, person.set.num_threads = 2;
  SynthesizePerson(person, {});
  const SinglePersonDataset set(folder.File("person"));
  const AvatarClip ideal(WriteClip(set, 0, folder.File("ideal"))), lens(WriteClip(set, -0.6, folder.File("lens")));
  EXPECT_EQ(lens.camera_of_file().distortion[0], -0.6);
  EXPECT_FALSE(lens.track().camera.HasDistortion());
  std::vector<int> frames(kFrames);
  std::iota(frames.begin(), frames.end(), 0);
  const auto expected = ideal.ReadViews(frames, 4, true, {}), views = lens.ReadViews(frames, 4, true, {});
  for (size_t t = 0; t < views.size(); ++t) {
    ASSERT_GT(expected[t].person_pixels, 500);
    EXPECT_NEAR(views[t].person_pixels, expected[t].person_pixels, 0.03 * expected[t].person_pixels);
    int together = 0, either = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const bool a = expected[t].ShowsPerson(x, y), b = views[t].ShowsPerson(x, y);
        together += a && b, either += a || b;
      }
    }
    EXPECT_GT(together, 0.93 * either) << "intersection over union";
    const LabelImage mask = lens.MaskAt(int(t));
    int in_mask = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) in_mask += expected[t].ShowsPerson(x, y) && mask.At(x, y) != 0;
    }
    EXPECT_GT(in_mask, 0.96 * expected[t].person_pixels);
  }
}

}  // namespace
}  // namespace bodyloom::avatar_clip_test
