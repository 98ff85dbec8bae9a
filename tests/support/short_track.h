// SPDX-License-Identifier: Apache-2.0
/// A track of the built-in body without detections or noise.
#pragma once

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"

namespace bodyloom {

/// Two seconds of the demo's walk, by default at 6 frames per second, in images of 320×240, with a static camera.
inline Track ShortTrack(int fps = 6, SynthCameraMotion camera = SynthCameraMotion::kStill) {
  SynthClipOptions options;
  options.camera_path.motion = camera;
  options.camera.width = 320;
  options.camera.height = 240;
  options.dense_per_frame = 0;
  options.keypoints = false;
  options.num_threads = 1;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 2 * fps, fps), options).truth;
}

}  // namespace bodyloom
