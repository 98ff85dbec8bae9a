// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "apps/progress.h"
#include "apps/synth_options.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/synthesis/synthesize_clip.h"

namespace bodyloom {
namespace {

constexpr const char* kSynthFooter =
    "Examples:\n"
    "  bodyloom synth --motion demo --out clip --realistic --video\n"
    "  bodyloom synth --motion dance.bvh --out clip --fps 30 --dense 300 --uv-noise 0.02 --init-error 14.8\n"
    "then\n"
    "  bodyloom track --detections clip/observations.npz --cameras clip/camera.json --out track.npz\n"
    "  bodyloom evaluate --track track.npz --truth clip/truth.npz\n\n";

void Synth(const SynthesizeClipRequest& request, bool quiet) {
  const SynthesizeClipReport report = SynthesizeClip(request, CommandCallbacks(quiet));
  if (!quiet) {
    std::cout << ToText(report);
  }
}

}  // namespace

void AddSynthVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("synth", "Makes a clip with known truth: motion in, observations out");
  verb->footer(std::string(kSynthFooter) + kExitCodeHelp);
  auto request = std::make_shared<SynthesizeClipRequest>();
  auto quiet = std::make_shared<bool>(false);
  AddSynthOptions(*verb, request.get(), quiet.get());
  verb->callback([request, quiet, action] { *action = [request, quiet] { Synth(*request, *quiet); }; });
}

}  // namespace bodyloom
