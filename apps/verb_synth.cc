// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "apps/exit_code.h"
#include "apps/synth_run.h"
#include "apps/verbs.h"

namespace bodyloom {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  bodyloom synth --motion demo --out clip --realistic --video\n"
    "  bodyloom synth --motion dance.bvh --out clip --fps 30 --dense 300 --uv-noise 0.02 --init-error 14.8\n"
    "then\n"
    "  bodyloom track --detections clip/observations.npz --cameras clip/camera.json --out track.npz\n"
    "  bodyloom evaluate --track track.npz --truth clip/truth.npz\n\n";

void Synth(const SynthCommand& command) {
  const SynthClip clip = RunSynth(command);
  if (command.quiet) {
    return;
  }
  const SynthFaultCounts& counts = clip.counts;
  std::cout << clip.truth.num_frames() << " frames of " << clip.truth.camera.width << "x" << clip.truth.camera.height
            << ", " << counts.frames_dropped << " without observations\n"
            << "2D joints        " << counts.keypoints << ", " << counts.keypoints_hidden << " hidden by the body\n"
            << "dense keypoints  " << counts.dense << ", " << counts.dense_outliers << " outliers, "
            << counts.dense_missing << " lost with missing parts\n";
  if (clip.initialiser.num_frames() > 0) {
    std::cout << "initialiser      wrong by " << clip.initialiser_error_px << " px at 512\n";
  }
  const SynthFiles files = SynthFilesIn(command);
  for (const std::string& path : {files.observations, files.truth, files.camera, files.initialiser, files.video}) {
    if (!path.empty()) {
      std::cout << "wrote            " << path << "\n";
    }
  }
}

}  // namespace

void AddSynthVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("synth", "Makes a clip with known truth: motion in, observations out");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto command = std::make_shared<SynthCommand>();
  AddSynthOptions(*verb, command.get());
  verb->callback([command, action] { *action = [command] { Synth(*command); }; });
}

}  // namespace bodyloom
