// SPDX-License-Identifier: Apache-2.0
#include "pipelines/synthesis/motion_source.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "data_tools/motion/load_motion.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kDemoFps = 30;

}  // namespace

Motion LoadMotionSource(const MotionSource& source, const BodyModel& body, const PipelineCallbacks& callbacks) {
  BODYLOOM_CHECK(source.speed > 0 && (source.speed == 1 || source.fps > 0), "speed ", source.speed, " at ", source.fps,
                 " frames a second, expected positive numbers");
  Motion motion;
  if (source.name == "demo") {
    const double fps = (source.fps > 0 ? source.fps : kDemoFps) / source.speed;
    motion = DemoMotion(body, static_cast<int>(kDemoMotionSeconds * fps), fps);
  } else {
    LoadMotionOptions options;
    options.resample_fps = source.fps / source.speed;
    std::vector<std::string> warnings;
    motion = LoadMotion(source.name, options, nullptr, &warnings);
    for (const std::string& warning : warnings) callbacks.Message(warning);
    if (motion.betas.size() > body.num_betas()) {  // AMASS has 16; components are in order of their variance
      callbacks.Message(Concatenate(source.name, ": of ", motion.betas.size(), " shape components the first ",
                                    body.num_betas(), " are taken, as the body has"));
      motion.betas.conservativeResize(body.num_betas());
    }
  }
  const auto at_speed = [&](int frames) { return static_cast<int>(std::lround(frames / source.speed)); };
  const int first = at_speed(source.first_frame), available = motion.num_frames() - first;
  if (available <= 0) {
    throw std::runtime_error(Concatenate(source.name, ": ", std::lround(motion.num_frames() * source.speed),
                                         " frames, --first asks for frame ", source.first_frame));
  }
  const int count = source.num_frames > 0 ? std::min(at_speed(source.num_frames - 1) + 1, available) : available;
  motion = TakeFrames(motion, first, count);
  // The clip begins at zero, as its video does.
  const double begin = motion.timestamps.front();
  for (double& time : motion.timestamps) time = (time - begin) / source.speed;
  return motion;
}

}  // namespace bodyloom
