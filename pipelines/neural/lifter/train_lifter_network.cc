// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/lifter/train_lifter_network.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/motion/motion_library.h"
#include "data_tools/motion/motion_split.h"
#include "data_tools/synthesis/lifter/lifter_windows.h"
#include "geometry/base/check.h"
#include "pipelines/neural/training_session.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

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

/// The motion to train on, and that to validate on.
std::pair<MotionSet, MotionSet> LoadMotions(const TrainLifterNetworkRequest& request) {
  MotionLibraryOptions library_options;
  library_options.split_path = request.split;
  std::vector<LibraryClip> train, test;
  for (LibraryClip& clip : LoadMotionLibrary(request.motions, library_options)) {
    (clip.test ? test : train).push_back(std::move(clip));
  }
  if (train.empty()) throw std::runtime_error("no motion for training in the given folders");
  if (test.empty()) throw std::runtime_error("no motion for validation in the given folders: the split has none");
  return {TakeShare(std::move(train), request.share), TakeShare(std::move(test), 1)};
}

void RequireSameSizes(const LifterWeights& weights, const TrainLifterOptions& options, const std::string& path) {
  std::vector<int> dilations;
  for (const LifterWeights::Block& block : weights.blocks) dilations.push_back(block.dilation);
  if (weights.num_inputs() == options.num_inputs && weights.width() == options.width &&
      dilations == options.dilations) {
    return;
  }
  throw std::runtime_error(Concatenate(path, ": weights of ", weights.width(), " channels, ", weights.num_inputs(),
                                       " inputs and ", weights.blocks.size(), " blocks, expected ", options.width, ", ",
                                       options.num_inputs, " and ", options.dilations.size(),
                                       " of the same dilations: set --channels to that of the weights"));
}

/// Initial weights of an existing run by its config.json; empty: none, or no such run.
std::string InitFromOfRun(const std::string& run) {
  const fs::path path = fs::path(run) / "config.json";
  if (!fs::exists(path)) return "";
  const nlohmann::json config = nlohmann::json::parse(ReadFileBytes(path.string()), nullptr, false);
  const auto found = config.find("init_from");
  return found != config.end() && found->is_string() ? found->get<std::string>() : "";
}

nlohmann::ordered_json Describe(const TrainLifterOptions& o, const std::string& init_from, double share,
                                const MotionSet& train, const MotionSet& test) {
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
          {"optimizer", o.muon ? "muon" : "adamw"},
          {"average", o.average},
          {"nll_weight", o.nll_weight},
          {"velocity_weight", o.velocity_weight},
          {"threads", o.num_threads},
          {"init_from", init_from},
          {"motion_share", share},
          {"train_clips", train.motions.size()},
          {"train_minutes", train.seconds / 60},
          {"validation_clips", test.motions.size()},
          {"validation_minutes", test.seconds / 60}};
}

}  // namespace

TrainLifterNetworkSummary TrainLifterNetwork(const TrainLifterNetworkRequest& request,
                                             const PipelineCallbacks& callbacks) {
  TrainLifterOptions options = request.options;
  options.num_inputs = kLifterInputs;
  std::string why;
  if (!options.IsValid(&why)) throw RequestError(why);
  if (options.resume && !request.init_from.empty()) {
    throw RequestError("a run that goes on has weights of its own: leave --init-from out");
  }
  const std::string init_from = options.resume ? InitFromOfRun(request.out) : request.init_from;
  LifterWeights begin_with;
  if (!request.init_from.empty()) {
    begin_with = ReadLifterWeights(request.init_from);
    RequireSameSizes(begin_with, options, request.init_from);
    options.begin_with = &begin_with;
  }
  const auto [train, test] = LoadMotions(request);
  const LifterWindowOptions windows;
  const LifterWindowGenerator train_windows(train.motions, train.has_floor, BuiltinBody(), windows);
  const LifterWindowGenerator test_windows(test.motions, test.has_floor, BuiltinBody(),
                                           LifterWindowOptions::AsRecorded());

  options.num_frames = windows.num_frames;
  options.run_dir = request.out;
  fs::create_directories(request.out);
  if (!options.resume) RequireNoRun(request.out);
  const nlohmann::ordered_json config = Describe(options, init_from, request.share, train, test);
  WriteFileAtomically((fs::path(request.out) / "config.json").string(), config.dump(2) + "\n");
  WriteFileAtomically((fs::path(request.out) / "motion_split.txt").string(),
                      request.split.empty() ? BuiltinMotionSplitText() : ReadFileBytes(request.split));
  callbacks.Message(Concatenate("training on ", train.motions.size(), " clips, ", train.seconds / 60,
                                " minutes; validating on ", test.motions.size(), " clips, ", test.seconds / 60,
                                " minutes"));
  FollowTraining(options.steps, callbacks, &options);
  TrainLifterResult result = TrainLifter(SourceOf(train_windows), SourceOf(test_windows), options);
  RequireFinite(result.summary, request.out);
  result.weights.recipe = config.dump();
  const std::string weights = (fs::path(request.out) / "lifter.npz").string();
  WriteLifterWeights(weights, result.weights);
  return {result.summary, weights, result.weights.num_parameters()};
}

}  // namespace bodyloom
