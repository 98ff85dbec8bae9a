// SPDX-License-Identifier: Apache-2.0
// A rendered clip written as a single-person dataset.
#include "pipelines/animate/background.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "tests/support/test_files.h"

namespace bodyloom::rendered_dataset_test {
namespace {

/// A window of 3 × 2 pixels at (1, 1) of a picture of 6 × 4, and what networks predicted for it.
struct Drawn {
  PersonWindow window;
  MotionImage rendered;
  Drawn() {
    window.width = 3, window.height = 2, window.image_width = 6, window.image_height = 4;
    window.corner = {{1, 1}};
    rendered.width = 3, rendered.height = 2;
    rendered.labels = {1, 2, 3, 0, 5, 6};
    rendered.alpha.assign(6, 1);
    rendered.image.assign(18, 0.5F);
    rendered.normals.assign(18, 0);
    for (int i = 0; i < 6; ++i) {
      const float angle = 0.2F * static_cast<float>(i);
      rendered.normals[i] = 0.8F * std::sin(angle);  // shortened, as uncertain foreground is
      rendered.normals[12 + i] = -0.8F * std::cos(angle);
    }
  }
};

TEST(RenderedDataset, AtTheNetworksSizeClassesStayAndNormalsBecomeUnitVectors) {
  const Drawn drawn;
  const PersonFrame frame = SetFrameOf(drawn.rendered, drawn.window, 0, Image(6, 4, {7, 8, 9}));
  EXPECT_EQ(frame.rgb, Image(6, 4, {7, 8, 9}));
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) {
      const bool inside = x >= 1 && x < 4 && y >= 1 && y < 3;
      const int i = 3 * (y - 1) + x - 1, label = inside ? drawn.rendered.labels[i] : 0;
      EXPECT_EQ(frame.labels.at(x, y), (Colour{uint8_t(label), uint8_t(label), uint8_t(label)})) << x << ", " << y;
      const Colour normal = frame.normals.at(x, y);
      if (label == 0) {
        EXPECT_EQ(normal, (Colour{0, 0, 0})) << x << ", " << y;
        continue;
      }
      EXPECT_NEAR(NormalOfCode(normal.red), std::sin(0.2 * i), 1.01 / 255) << x << ", " << y;
      EXPECT_NEAR(NormalOfCode(normal.green), 0, 1.01 / 255);
      EXPECT_NEAR(NormalOfCode(normal.blue), -std::cos(0.2 * i), 1.01 / 255);
    }
  }
}

TEST(RenderedDataset, EnlargedEveryPixelTakesTheNearestClass) {
  const Drawn drawn;
  const PersonFrame frame = SetFrameOf(drawn.rendered, drawn.window, 0, Image(18, 12));
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 18; ++x) {
      const bool inside = x >= 3 && x < 12 && y >= 3 && y < 9;
      const int label = inside ? drawn.rendered.labels[3 * (y / 3 - 1) + x / 3 - 1] : 0;
      EXPECT_EQ(frame.labels.at(x, y).red, label) << x << ", " << y;
      if (label == 0) continue;
      const Colour normal = frame.normals.at(x, y);
      const double length = std::hypot(NormalOfCode(normal.red), NormalOfCode(normal.green), NormalOfCode(normal.blue));
      EXPECT_NEAR(length, 1, 0.01);
    }
  }
}

TEST(RenderedDataset, IsASinglePersonDatasetOnlyWhenFinished) {
  SynthClipOptions options;
  options.camera.width = 24, options.camera.height = 16;
  options.dense_per_frame = 0;
  options.keypoints = false;
  const Track track = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 2, 25), options).truth;
  Drawn drawn;
  drawn.window.corner = {{1, 1}, {0, 0}};
  const std::string folder = EmptyFolder("rendered_dataset");
  RenderedDataset set(folder, track, 25, true, true, "animate");
  set.Add(0, drawn.rendered, drawn.window, Image(24, 16, {1, 2, 3}));
  EXPECT_THROW(SinglePersonDataset{folder}, std::runtime_error);
  set.Add(1, {}, drawn.window, Image(24, 16));  // no fit
  set.Finish();
  const SinglePersonDataset read(folder);
  EXPECT_EQ(read.info().num_frames, 2);
  EXPECT_NEAR(read.info().fps, 25, 1e-6);
  EXPECT_EQ(read.track().num_frames(), 2);
  EXPECT_EQ(read.Read(0).labels.at(6, 6).red, 1);
  EXPECT_EQ(read.Read(1).labels, Image(24, 16)) << "a frame without a fit is background";

  drawn.rendered.labels.clear();
  drawn.rendered.normals.clear();
  RenderedDataset bare(EmptyFolder("rendered_dataset_bare"), track, 25, false, false, "animate");
  for (const int t : {0, 1}) bare.Add(t, drawn.rendered, drawn.window, Image(24, 16));
  EXPECT_NO_THROW(bare.Finish());
}

}  // namespace
}  // namespace bodyloom::rendered_dataset_test
