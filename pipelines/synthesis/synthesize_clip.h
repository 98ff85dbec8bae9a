// SPDX-License-Identifier: Apache-2.0
/// A clip with known truth, as files: motion in, observations and truth out (data_tools/synthesis/clips/synth_clip.h).
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

/// Paths of what SynthesizeClip writes into its folder.
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

/// The faults of a dense detector and of a 2D detector together, as sizes that real ones have: UV noise 0.02, 8 bits,
/// 5 % outliers, each part missing 5 % of the time.
void UseRealisticFaults(SynthClipOptions* options);

/// Makes the clip and writes its files. Throws std::runtime_error naming the file that cannot be used, Cancelled.
SynthesizeClipReport SynthesizeClip(const SynthesizeClipRequest& request, const PipelineCallbacks& callbacks = {});

/// Counts of what was made and of its faults, and the files: some lines for a reader.
std::string ToText(const SynthesizeClipReport& report);

}  // namespace bodyloom
