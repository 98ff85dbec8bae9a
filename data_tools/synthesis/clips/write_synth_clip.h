// SPDX-License-Identifier: Apache-2.0
/// Writes a synthetic clip as a folder that the project's other commands (and other tools) read.
///
/// | file             | what                                                                                   |
/// |------------------|----------------------------------------------------------------------------------------|
/// | truth.npz        | the true track (data_tools/motion/track_io.h)                                                 |
/// | observations.npz | 2D landmarks and dense keypoints with their faults (observations/observations_npz.h)   |
/// | keypoints.json   | the 2D landmarks as OpenPose BODY_25: a list with one {"version", "people"} a frame    |
/// | cameras.json     | intrinsics and pose of the camera (observations/load_cameras.h, form 3)                |
/// | camera_path.json | where a camera that moves was, in metres (observations/load_camera_path.h)              |
/// | initialiser.npz  | the perturbed motion as a track, when the clip has one                                 |
/// | video.mp4        | the person in clothes on a plain floor, when requested                                 |
/// | clip.json        | seed, fault options, and what they did                                                 |
#pragma once

#include <functional>
#include <string>

#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

struct WriteSynthClipOptions {
  bool video = false;
  /// Called with the finished fraction of the video; may be empty. Return false to stop: no video appears then.
  std::function<bool(double)> progress = {};
};

/// Makes the folder when it is missing; each file appears whole or not at all. `options` are those the clip was made
/// with, for clip.json. Throws std::runtime_error naming the path.
void WriteSynthClip(const std::string& folder, const BodyModel& body, const SynthClip& clip,
                    const SynthClipOptions& options, const WriteSynthClipOptions& write = {});

}  // namespace bodyloom
