// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/train_lifter.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/exit_code.h"
#include "apps/neural/training_session.h"
#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/learned/lifter_weights_io.h"
#include "bodyloom/data_tools/motion/motion_library.h"
#include "bodyloom/data_tools/synthesis/lifter/lifter_windows.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/lifter/train_lifter.h"
#include "bodyloom/pipelines/clock_text.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::vector<std::string> motions;
  std::string out, split;
  std::string optimizer = "muon";
  double share = 1;
  TrainLifterOptions options;
};

struct MotionSet {
  std::vector<Motion> motions;
  std::vector<char> has_floor;
  double seconds = 0;
};

/// A share of the training motion: whole clips in an order that depends on their names alone, so that a smaller share
/// is part of a larger one.
MotionSet TakeShare(std::vector<LibraryClip> clips, double share) {
  const auto key = [](const LibraryClip& clip) {
    uint64_t hash = 1469598103934665603U;  // FNV-1a
    for (const char c : clip.name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
    return hash;
  };
  std::sort(clips.begin(), clips.end(), [&](const LibraryClip& a, const LibraryClip& b) { return key(a) < key(b); });
  const auto length = [](const LibraryClip& clip) {
    return clip.motion.timestamps.back() - clip.motion.timestamps.front();
  };
  double total = 0;
  for (const LibraryClip& clip : clips) total += length(clip);
  MotionSet set;
  for (LibraryClip& clip : clips) {
    if (!set.motions.empty() && set.seconds >= share * total) break;
    set.seconds += length(clip);
    set.has_floor.push_back(clip.has_floor);
    set.motions.push_back(std::move(clip.motion));
  }
  return set;
}

LifterSource SourceOf(const LifterWindowGenerator& generator) {
  return [&generator](uint64_t seed, LifterExample* example) {
    thread_local LifterWindow window;
    generator.Generate(seed, &window);
    example->features = window.features;
    example->points = window.points;
    example->up = window.up;
    example->contact = window.contact;
  };
}

nlohmann::ordered_json Describe(const Request& request, const MotionSet& train, const MotionSet& test) {
  const TrainLifterOptions& o = request.options;
  return {{"program", "bodyloom train lifter"},
          {"version", BODYLOOM_VERSION},
          {"seed", o.seed},
          {"steps", o.steps},
          {"batch", o.batch},
          {"window_frames", o.num_frames},
          {"channels", o.width},
          {"dilations", o.dilations},
          {"learning_rate", o.learning_rate},
          {"weight_decay", o.weight_decay},
          {"optimizer", request.optimizer},
          {"average", o.average},
          {"nll_weight", o.nll_weight},
          {"velocity_weight", o.velocity_weight},
          {"threads", o.num_threads},
          {"motion_share", request.share},
          {"train_clips", train.motions.size()},
          {"train_minutes", train.seconds / 60},
          {"validation_clips", test.motions.size()},
          {"validation_minutes", test.seconds / 60}};
}

void Run(Request request) {
  MotionLibraryOptions library_options;
  library_options.split_path = request.split;
  std::vector<LibraryClip> train_clips, test_clips;
  for (LibraryClip& clip : LoadMotionLibrary(request.motions, library_options)) {
    (clip.test ? test_clips : train_clips).push_back(std::move(clip));
  }
  if (train_clips.empty()) throw std::runtime_error("no motion for training in the given folders");
  if (test_clips.empty()) throw std::runtime_error("no motion for validation in the given folders: the split has none");
  const MotionSet train = TakeShare(std::move(train_clips), request.share), test = TakeShare(std::move(test_clips), 1);
  const LifterWindowOptions windows;
  const LifterWindowGenerator train_windows(train.motions, train.has_floor, BuiltinBody(), windows);
  const LifterWindowGenerator test_windows(test.motions, test.has_floor, BuiltinBody(),
                                           LifterWindowOptions::AsRecorded());

  TrainLifterOptions& options = request.options;
  options.num_inputs = kLifterInputs;
  options.muon = request.optimizer == "muon";
  options.num_frames = windows.num_frames;
  options.run_dir = request.out;
  fs::create_directories(request.out);
  const fs::path run = request.out;
  if (!options.resume && fs::exists(CheckpointPath(request.out))) {
    throw RequestError(request.out + " holds a run already; go on with it by --resume, or choose another --out");
  }
  const nlohmann::ordered_json config = Describe(request, train, test);
  WriteFileAtomically((run / "config.json").string(), config.dump(2) + "\n");
  std::cout << "training on " << train.motions.size() << " clips, " << train.seconds / 60 << " minutes; validating on "
            << test.motions.size() << " clips, " << test.seconds / 60 << " minutes\n"
            << std::flush;
  TrainingBar bar(options.steps);
  options.progress = [&](const TrainLifterProgress& progress) {
    if (!(progress.validation_distance > 0))
      return bar.Update(progress.step, {{"distance", progress.distance}}, nullptr);
    return bar.Update(progress.step, {{"distance", progress.distance}, {"validation", progress.validation_distance}},
                      nullptr);
  };
  TrainLifterResult result = TrainLifter(SourceOf(train_windows), SourceOf(test_windows), options);
  const TrainLifterSummary& summary = result.summary;
  RequireFinite(summary, request.out);
  result.weights.recipe = config.dump();
  WriteLifterWeights((run / "lifter.npz").string(), result.weights);
  std::cout << "step " << summary.steps << " of " << options.steps << " in " << ClockText(summary.seconds)
            << "; validation: mean distance " << summary.validation_distance
            << " of torso + leg, with the best of each "
            << "limb's hypotheses " << summary.validation_best_distance << "\nwrote " << (run / "lifter.npz").string()
            << " (" << result.weights.num_parameters() << " numbers)\n";
  if (summary.status == TrainingStatus::kStopped) {
    throw std::runtime_error(request.out + ": " + summary.message + "; go on with --resume");
  }
}

}  // namespace

void AddTrainLifter(CLI::App& train, std::function<void()>* action) {
  CLI::App* verb = train.add_subcommand("lifter", "Trains the network that lifts 2D joints to 3D from recorded motion");
  auto request = std::make_shared<Request>();
  TrainLifterOptions& options = request->options;
  verb->add_option("--motions", request->motions, "Motion files, or folders of them (BVH, ASF/AMC, AMASS, …)")
      ->required();
  verb->add_option("--out", request->out, "Folder of the run: config.json, metrics.csv, checkpoint.bin, lifter.npz")
      ->required();
  verb->add_option("--split", request->split, "Which clips are for training (default: the project's own list)");
  verb->add_option("--share", request->share, "Of the training motion that is used")
      ->check(CLI::Range(0.001, 1.0))
      ->capture_default_str();
  verb->add_option("--steps", options.steps, "Batches to train on")->capture_default_str();
  verb->add_option("--batch", options.batch, "Windows in a batch")->capture_default_str();
  verb->add_option("--channels", options.width, "Width of the network")->capture_default_str();
  verb->add_option("--learning-rate", options.learning_rate, "At its highest")->capture_default_str();
  verb->add_option("--optimizer", request->optimizer, "For the blocks' matrices")
      ->check(CLI::IsMember({"muon", "adamw"}))
      ->capture_default_str();
  verb->add_option("--seed", options.seed, "Of the weights and the windows")->capture_default_str();
  verb->add_option("--threads", options.num_threads, "0: all cores")->capture_default_str();
  verb->add_flag("--resume", options.resume, "Go on with the run in --out");
  verb->footer(
      "Example:\n  bodyloom train lifter --motions motion/ aistpp/motions --out run --steps 12000\n"
      "Then: bodyloom track --lifter run/lifter.npz ...");
  verb->callback([request, action] {
    *action = [request] {
      std::string why;
      TrainLifterOptions checked = request->options;
      checked.num_inputs = kLifterInputs;
      if (!checked.IsValid(&why)) throw RequestError(why);
      Run(*request);
    };
  });
}

}  // namespace bodyloom
