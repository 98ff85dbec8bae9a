// SPDX-License-Identifier: Apache-2.0
#include "apps/motion_input.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "bodyloom/data_tools/motion/load_motion.h"
#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/data_tools/synthesis/clips/demo_motion.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kDemoFps = 30;

}  // namespace

const char* const kMotionInputHelp =
    "AMASS .npz, AIST++ .pkl, BVH, Acclaim .amc, DeepMimic JSON or AMP .npy; or the word demo";

Motion LoadMotionInput(const MotionInput& input, const BodyModel& body) {
  BODYLOOM_CHECK(input.speed > 0 && (input.speed == 1 || input.fps > 0), "speed ", input.speed, " at ", input.fps,
                 " frames a second, expected positive numbers");
  Motion motion;
  if (input.motion == "demo") {
    const double fps = (input.fps > 0 ? input.fps : kDemoFps) / input.speed;
    motion = DemoMotion(body, static_cast<int>(kDemoMotionSeconds * fps), fps);
  } else {
    LoadMotionOptions options;
    options.resample_fps = input.fps / input.speed;
    motion = LoadMotion(input.motion, options);
  }
  const auto at_speed = [&](int frames) { return static_cast<int>(std::lround(frames / input.speed)); };
  const int first = at_speed(input.first_frame), available = motion.num_frames() - first;
  if (available <= 0) {
    throw std::runtime_error(Concatenate(input.motion, ": ", std::lround(motion.num_frames() * input.speed),
                                         " frames, --first asks for frame ", input.first_frame));
  }
  const int count = input.num_frames > 0 ? std::min(at_speed(input.num_frames - 1) + 1, available) : available;
  motion = TakeFrames(motion, first, count);
  // The clip begins at zero, as its video does.
  const double begin = motion.timestamps.front();
  for (double& time : motion.timestamps) time = (time - begin) / input.speed;
  return motion;
}

}  // namespace bodyloom
