// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/picture_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bodyloom::picture_lines_test {
namespace {

constexpr int kWidth = 640, kHeight = 480;

/// A wall with bars that all lean by `degrees`, from x0 to x1.
void AddBars(double degrees, int x0, int x1, Image* image) {
  const double slope = std::tan(degrees * M_PI / 180);
  for (int y = 40; y < 440; ++y) {
    for (int x = x0; x < x1; ++x) {
      const double across = x - x0 - slope * (y - 240);
      if (std::fmod(across + 4000, 40) < 14) std::fill_n(image->pixel(x, y), 3, uint8_t{210});
    }
  }
}

/// A room whose uprights lean by 5° in the picture, and a person of upright stripes that lean by −15°.
DetectedClip Clip() {
  DetectedClip clip;
  clip.people.image_width = kWidth;
  clip.people.image_height = kHeight;
  clip.video.width = clip.video.stored_width = kWidth;
  clip.video.height = clip.video.stored_height = kHeight;
  for (int t = 0; t < 4; ++t) {
    Image image(kWidth, kHeight, {80, 80, 80});
    AddBars(5, 20, 220, &image);
    AddBars(-15, 260, 620, &image);
    clip.samples.Add(image);
    clip.people.timestamps.push_back(t / 30.0);
    DetectedPerson person;
    person.points = {{280, 60, 1}, {600, 420, 1}, {10, 10, 0}};  // the last one is not seen
    clip.people.frames.push_back({person});
  }
  return clip;
}

SceneInputs Scene() {
  SceneInputs scene;
  scene.camera.camera = MakePinhole(kWidth, kHeight, 600);
  return scene;
}

double RollDeg(const PictureVertical& lines) { return std::atan2(lines.up.x(), -lines.up.y()) * 180 / M_PI; }

TEST(PictureLines, OfPeopleAreMaskedByTheirLandmarks) {
  DetectedClip clip = Clip();
  const PictureVertical lines = VerticalOfClip({}, clip, Scene());
  ASSERT_TRUE(lines.found) << lines.why;
  EXPECT_NEAR(std::abs(RollDeg(lines)), 5, 1);
  for (auto& people : clip.people.frames) people.clear();
  const PictureVertical without = VerticalOfClip({}, clip, Scene());
  EXPECT_FALSE(without.found && std::abs(std::abs(RollDeg(without)) - 5) < 2) << "the stripes are the more";
}

TEST(PictureLines, OfPeopleAreMaskedByTheirMasks) {
  DetectedClip clip = Clip();
  LabelImage mask{.x_begin = 260, .y_begin = 30, .width = 362, .height = 420, .labels = {}};
  mask.labels.assign(size_t(mask.width) * mask.height, 1);
  for (auto& people : clip.people.frames) {
    people[0].points.clear();
    clip.masks.push_back({PackedLabels(mask)});
  }
  const PictureVertical lines = VerticalOfClip({}, clip, Scene());
  ASSERT_TRUE(lines.found) << lines.why;
  EXPECT_NEAR(std::abs(RollDeg(lines)), 5, 1);
}

TEST(PictureLines, OfACameraThatRollsAreTurnedIntoItsScene) {
  DetectedClip clip = Clip();
  SceneInputs scene = Scene();
  RecordedCameraPath& path = scene.camera_path.emplace();
  clip.samples = FrameSamples();
  for (int t = 0; t < 4; ++t) {
    const double roll = (t - 1) * 3 * M_PI / 180;
    Image image(kWidth, kHeight, {80, 80, 80});
    AddBars(5 - (t - 1) * 3, 20, 220, &image);
    AddBars(-15, 260, 620, &image);
    clip.samples.Add(image);
    path.seconds.push_back(clip.people.timestamps[t]);
    CameraPose& pose = path.poses.emplace_back();
    pose.camera_from_world_rotation << std::cos(roll), -std::sin(roll), 0, std::sin(roll), std::cos(roll), 0, 0, 0, 1;
  }
  PictureVertical lines = VerticalOfClip({}, clip, scene);
  ASSERT_TRUE(lines.found) << lines.why;
  // The scene is the frame of the path's first pose, in whose picture the uprights lean by 8°.
  EXPECT_NEAR(std::abs(RollDeg(lines)), 8, 1);
  for (CameraPose& pose : path.poses) pose.camera_from_world_rotation.transposeInPlace();
  lines = VerticalOfClip({}, clip, scene);
  EXPECT_FALSE(lines.found && lines.share > 0.6) << "turned the wrong way they do not meet: " << lines.why;
}

TEST(PictureLines, SaysWhyThereAreNone) {
  const DetectedClip clip = Clip();
  TrackSettings off;
  off.use_lines = false;
  EXPECT_EQ(VerticalOfClip(off, clip, Scene()).why, "switched off");
  SceneInputs weak = Scene();
  weak.camera_knowledge = CameraKnowledge::kWeak;
  EXPECT_FALSE(VerticalOfClip({}, clip, weak).found);
  SceneInputs moving = Scene();
  moving.camera_path.emplace().poses.emplace_back();
  moving.camera_path->seconds.push_back(100);  // of another clip
  EXPECT_EQ(VerticalOfClip({}, clip, moving).why, "no pictures");
  EXPECT_EQ(VerticalOfClip({}, DetectedClip(), Scene()).why, "no frames were kept");
}

TEST(PictureLines, GiveAnUnknownFocalLengthItsPrior) {
  PictureVertical lines;
  lines.has_focal = true;
  lines.log_focal = std::log(900);
  lines.log_focal_sigma = 0.1;
  TrackSequenceInput input;
  input.camera.width = kWidth;
  input.camera.height = kHeight;
  UsePictureVertical(lines, CameraKnowledge::kKnown, &input);
  EXPECT_FALSE(input.focal_prior.has_value());
  UsePictureVertical(lines, CameraKnowledge::kUnknownFocal, &input);
  EXPECT_EQ(input.picture_vertical, &lines);
  ASSERT_TRUE(input.focal_prior.has_value());
  EXPECT_GT(input.focal_prior->log_mean, std::log(StartFocalPx(kWidth, kHeight)));
  EXPECT_LT(input.focal_prior->log_mean, std::log(900));
  EXPECT_LT(input.focal_prior->log_sigma, 0.1);
}

}  // namespace
}  // namespace bodyloom::picture_lines_test
