// SPDX-License-Identifier: Apache-2.0
#include "apps/motion_input.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "data_tools/motion/load_motion.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/synthetic/demo_motion.h"
#include "geometry/check.h"

namespace bodyloom {
namespace {

constexpr double kDemoFps = 30;

}  // namespace

const char* const kMotionInputHelp =
    "AMASS .npz, AIST++ .pkl, BVH, Acclaim .amc, DeepMimic JSON or AMP .npy; or the word demo";

Motion LoadMotionInput(const MotionInput& input, const BodyModel& body) {
  Motion motion;
  if (input.motion == "demo") {
    const double fps = input.fps > 0 ? input.fps : kDemoFps;
    motion = DemoMotion(body, static_cast<int>(kDemoMotionSeconds * fps), fps);
  } else {
    LoadMotionOptions options;
    options.resample_fps = input.fps;
    motion = LoadMotion(input.motion, options);
  }
  const int available = motion.num_frames() - input.first_frame;
  if (available <= 0) {
    throw std::runtime_error(
        Concatenate(input.motion, ": ", motion.num_frames(), " frames, --first asks for frame ", input.first_frame));
  }
  const int count = input.num_frames > 0 ? std::min(input.num_frames, available) : available;
  motion = TakeFrames(motion, input.first_frame, count);
  // The clip begins at zero, as its video does.
  const double begin = motion.timestamps.front();
  for (double& time : motion.timestamps) time -= begin;
  return motion;
}

}  // namespace bodyloom
