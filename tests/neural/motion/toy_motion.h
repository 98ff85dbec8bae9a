// SPDX-License-Identifier: Apache-2.0
/// A clip and networks small enough to train in a second.
#pragma once

#include <cmath>
#include <string>

#include "neural/motion/motion_config.h"
#include "neural/motion/motion_frame.h"
#include "neural/motion/train_motion.h"
#include "tests/support/test_files.h"

namespace bodyloom {

inline MotionConfig Toy() {
  MotionConfig config;
  config.profile = {"toy", 32, 16, 4, 16, 4, {4, 8}, {4, 8}, 4, 16};
  config.motion_channels = 6;
  config.num_labels = 3;
  return config;
}

/// The person is a square of [6 + t % 4, 22 + t % 4) × [8, 24) in a window of width × height; its shade and label
/// depend on the first channel of the motion map.
inline void ToyFrameIn(int width, int height, int t, bool with_truth, MotionFrame* frame) {
  const int area = width * height;
  *frame = {};
  frame->width = width, frame->height = height;
  frame->before_x = t > 0 && t % 4 == 0 ? -2 : 0;
  const float level = 0.5F + 0.4F * std::sin(0.7F * static_cast<float>(t));
  frame->motion.assign(6 * 16 * 16, level);
  frame->uv.assign(2 * area, 0);
  frame->body.assign(area, 0);
  if (with_truth) {
    frame->image.assign(3 * area, 0);
    frame->normals.assign(3 * area, 0);
    frame->labels.assign(area, 0);
  }
  for (int y = 8; y < 24; ++y) {
    for (int x = 6 + t % 4; x < 22 + t % 4; ++x) {
      const int i = y * width + x;
      frame->uv[i] = static_cast<float>(x) / 32;
      frame->uv[area + i] = static_cast<float>(y) / 32;
      frame->body[i] = 1;
      if (!with_truth) continue;
      frame->labels[i] = y < 16 ? 1 : 2;
      for (int c = 0; c < 3; ++c) frame->image[c * area + i] = level * (c == 0 ? 1.0F : 0.5F);
      frame->normals[2 * area + i] = -1;
    }
  }
}

/// The same in the smallest window.
inline void ToyFrame(int t, bool with_truth, MotionFrame* frame) { ToyFrameIn(32, 32, t, with_truth, frame); }

/// The frame with the descriptor in the image plane: the shade is given beside the person, not on it.
inline void DenseToyFrame(int t, bool with_truth, MotionFrame* frame) {
  ToyFrame(t, with_truth, frame);
  const float level = frame->motion[0];
  frame->motion.clear();
  frame->dense.assign(2 * 32 * 32, 0);
  for (int i = 0; i < 32 * 32; ++i) frame->dense[32 * 32 + i] = frame->body[i] == 0 ? level : 0;
}

inline MotionConfig DenseToy() {
  MotionConfig config = Toy();
  config.descriptor = MotionDescriptor::kDense2d;
  config.motion_channels = 2;
  return config;
}

inline TrainMotionOptions ToyOptions(const std::string& name) {
  TrainMotionOptions options;
  options.config = Toy();
  options.train = {{0, 24}};
  options.validation = {{24, 32}};
  options.batch = 2;
  options.rollout_length = 6;
  options.rollouts = 3;
  options.steps = 8;
  options.num_threads = 1;
  options.report_every = options.checkpoint_every = options.validate_every = 4;
  options.run_dir = EmptyFolder(name);
  return options;
}

}  // namespace bodyloom
