// SPDX-License-Identifier: Apache-2.0
/// Synthesises a clip with known truth: motion in, observations and truth out
/// (data_tools/synthesis/clips/synth_clip.h).
#pragma once

#include <string>

#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/callbacks.h"
#include "pipelines/synthesis/motion_source.h"

namespace bodyloom {

struct SynthesizeClipRequest {
  MotionSource motion;
  std::string body;        ///< empty: the built-in body
  std::string out;         ///< folder
  bool realistic = false;  ///< UseRealisticFaults
  bool video = false;      ///< also render the clip as a video
  SynthClipOptions clip;
};

/// Paths of the files that SynthesizeClip writes.
struct SynthClipFiles {
  std::string observations;  ///< observations.npz: 2D joints and dense keypoints
  std::string truth;         ///< truth.npz: the true track
  std::string camera;        ///< camera.json: of the first frame, where it moves
  std::string camera_path;   ///< camera_path.json of a camera that moves, or empty
  std::string initialiser;   ///< initialiser.npz, or empty when none was requested
  std::string video;         ///< clip.mp4, or empty
};

struct SynthesizeClipReport {
  SynthClip clip;
  SynthClipFiles files;
};

/// Sets the errors of a dense and a 2D detector to realistic values: UV noise 0.02, 8 bits, 5 % outliers, each part
/// missing 5 % of the time.
void UseRealisticFaults(SynthClipOptions* options);

/// Makes the clip and writes its files. Throws std::runtime_error naming the file that cannot be used, Cancelled.
SynthesizeClipReport SynthesizeClip(const SynthesizeClipRequest& request, const PipelineCallbacks& callbacks = {});

/// Counts of observations and of their errors, and the files: several lines of text.
std::string ToText(const SynthesizeClipReport& report);

}  // namespace bodyloom
