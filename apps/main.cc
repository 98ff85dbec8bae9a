// SPDX-License-Identifier: Apache-2.0
// The command `bodyloom`: parses, runs the chosen verb, and is the only place that catches.
#include <CLI/CLI.hpp>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <exception>
#include <iostream>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"

namespace bodyloom {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  bodyloom run clip.mp4 --out results               everybody in a video, and nothing but the video needed\n"
    "  bodyloom demo --out demo                          everything at once, on a clip made on the spot\n"
    "  bodyloom track --detections keypoints.json --video clip.mp4 --out track.npz --overlay overlay.mp4\n"
    "  bodyloom export --track track.npz --what bvh --out motion.bvh\n"
    "  bodyloom track --help                             the options of one verb, with examples\n\n";

int Run(int argc, char** argv) {
  CLI::App app("Follows people through a single-camera video with a parametric body.", "bodyloom");
  app.require_subcommand(1);
  app.footer(std::string(kExamples) + kExitCodeHelp);
  Action action;
  AddRunVerb(app, &action);
  AddLiveVerb(app, &action);
  AddBatchVerb(app, &action);
  AddDetectVerb(app, &action, {argv + 1, argv + argc});
  AddTrackVerb(app, &action);
  AddSynthVerb(app, &action);
  AddSynthPersonVerb(app, &action);
  AddSynthPeopleVerb(app, &action);
  AddEvaluateVerb(app, &action);
  AddMetricsVerb(app, &action, {argv + 1, argv + argc});
  AddExportVerb(app, &action);
  AddRenderVerb(app, &action);
  AddDescribeVerb(app, &action);
  AddTextureVerb(app, &action);
  AddParseVerb(app, &action);
  AddBodyVerb(app, &action, {argv + 1, argv + argc});
  AddDemoVerb(app, &action);
  AddPriorVerb(app, &action);
  AddMotionsVerb(app, &action);
  AddTrainVerb(app, &action);
  AddAnimateVerb(app, &action, {argv + 1, argv + argc});
  AddNeuralVerb(app, &action);
  AddVersionVerb(app, &action);
  try {
    app.parse(argc, argv);
    action();
    std::cout.flush();
    if (!std::cout) {
      throw std::runtime_error("standard output: writing failed");
    }
    return kExitOk;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help
      return app.exit(error);
    }
    std::cerr << "bodyloom: " << UsageError(app, error) << "\nRun with --help for the options.\n";
    return kExitUsage;
  } catch (const CommandEnded& ended) {
    std::cerr << "bodyloom: " << ended.what() << "\n";
    return ended.code();
  } catch (const RequestError& error) {
    std::cerr << "bodyloom: " << error.what() << "\nRun with --help for the options.\n";
    return kExitUsage;
  } catch (const std::exception& error) {
    if (IsInterrupted()) {  // whatever failed did so because of the signal (an encoder that died with us, say)
      std::cerr << "bodyloom: interrupted, unfinished files were removed\n";
      return kExitInterrupted;
    }
    std::cerr << "bodyloom: " << error.what() << "\n";
    return kExitFailed;
  }
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // Freed memory stays in the arena that it came from, of which there may be eight for each core: with two a long video
  // takes less of it in the same time (docs/lab/run_speed.md).
  mallopt(M_ARENA_MAX, 2);
#endif
  bodyloom::InstallSignalHandlers();
  return bodyloom::Run(argc, argv);
}
