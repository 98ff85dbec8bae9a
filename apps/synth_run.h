// SPDX-License-Identifier: Apache-2.0
/// What `bodyloom synth` does: a clip with known truth, as files.
#pragma once

#include <string>

#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"

namespace CLI {
class App;
}

namespace bodyloom {

struct SynthCommand {
  std::string motion;                   ///< any motion file; "demo": the motion that is made by code
  std::string body;                     ///< empty: the built-in body
  std::string out;                      ///< folder
  int first_frame = 0, num_frames = 0;  ///< of the motion, after resampling; 0: all
  double fps = 0;                       ///< resampled to; 0: as the file has it (demo: 30)
  bool realistic = false;               ///< UseRealisticFaults
  bool video = false;                   ///< also render the clip as a video
  bool quiet = false;
  SynthClipOptions clip;
};

void AddSynthOptions(CLI::App& app, SynthCommand* command);

/// The faults of a dense detector and of a 2D detector together, as sizes that real ones have: UV noise 0.02, 8 bits,
/// 5 % outliers, each part missing 5 % of the time.
void UseRealisticFaults(SynthClipOptions* options);

/// Paths of what RunSynth writes into its folder.
struct SynthFiles {
  std::string observations;  ///< observations.npz: 2D joints and dense keypoints
  std::string truth;         ///< truth.npz: the true track
  std::string camera;        ///< camera.json
  std::string initialiser;   ///< initialiser.npz, or empty when none was asked for
  std::string video;         ///< clip.mp4, or empty
};
SynthFiles SynthFilesIn(const SynthCommand& command);

/// Makes the clip and writes its files. Throws std::runtime_error naming the file, Interrupted.
SynthClip RunSynth(const SynthCommand& command);

}  // namespace bodyloom
