// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/neural/neural_verbs.h"
#include "apps/neural/training_options.h"
#include "apps/progress.h"
#include "apps/shown_motion_options.h"
#include "geometry/base/check.h"
#include "pipelines/animate/motion_errors.h"
#include "pipelines/neural/motion/train_motion_renderer.h"

namespace bodyloom {
namespace {

struct TrainMotionArguments {
  TrainMotionRendererRequest request;
  std::string shape_loss = "ce", profile = "cpu", descriptor = ToText(MotionDescriptor::kSurface);
  std::vector<std::string> without, train, validate;
};

void RunTrainMotion(const TrainMotionArguments& parsed) {
  TrainMotionRendererRequest request = parsed.request;
  MotionConfig& config = request.options.config;
  config.profile = MotionProfileNamed(parsed.profile);
  config.descriptor = MotionDescriptorNamed(parsed.descriptor);
  for (const std::string& part : parsed.without) {
    if (part == "shape") config.shape = false;
    if (part == "normal") config.normals = false;
    if (part == "motion") config.motion = false;
    if (part == "surface") config.surface = false;
    if (part == "texture") config.texture = false;
  }
  request.options.shape_by_cross_entropy = parsed.shape_loss == "ce";
  request.frames.train = ParseFrameRanges(parsed.train, "--train");
  request.frames.validate = ParseFrameRanges(parsed.validate, "--validate");
  const TrainMotionSummary summary = TrainMotionRenderer(request, CommandCallbacks());
  PrintLosses(summary, request.options.perceptual_weight > 0 ? "perceptual loss" : nullptr, "VGG-16");
  PrintStep(summary, request.options.steps);
  if (summary.scores.frames > 0) std::cout << "validation: " << ScoresText(summary.scores) << "\n";
  PrintEnd(summary, request.out);
}

}  // namespace

void AddTrainMotion(CLI::App& train, Action* action) {
  CLI::App* verb = train.add_subcommand("motion", "Trains a renderer of one person's motion-dependent appearance");
  auto parsed = std::make_shared<TrainMotionArguments>();
  TrainMotionRendererRequest& request = parsed->request;
  TrainMotionOptions& options = request.options;
  AddMotionDataOptions(verb, &request.data);
  AddRunFolderOption(verb, &request.out);
  AddSurfaceMotionOptions(verb, &request.data.motion, &request.cameras, &request.view);
  AddProfileOption(verb, &parsed->profile);
  verb->add_option("--descriptor", parsed->descriptor,
                   "What the networks are told of the motion: normals and velocities of the body's surface, or, to "
                   "compare with, dense UV coordinates and keypoints of ten frames as 2D systems take them")
      ->check(CLI::IsMember(MotionDescriptorNames()))
      ->capture_default_str();
  verb->add_option("--without", parsed->without,
                   "Leave out a part, as the paper's ablations do; surface, texture: the decoders see neither UV "
                   "coordinates nor a "
                   "learned texture, as in the paper")
      ->check(CLI::IsMember({"shape", "normal", "motion", "surface", "texture"}));
  verb->add_option("--train", parsed->train, "Frames to train on, FIRST-LAST (default: the first four fifths)");
  verb->add_option("--validate", parsed->validate, "Frames to validate on (default: the last fifth)");
  verb->add_option("--validate-data", request.validate_data,
                   "Validate on another dataset of the same person, in another motion");
  verb->add_option("--share", request.frames.share, "Of the training frames that is used, in stretches of 32")
      ->check(CLI::Range(0.001, 1.0))
      ->capture_default_str();
  AddStepOptions(verb, &options.steps, &options.batch, &options.learning_rate, "Frames in a batch");
  verb->add_option("--rollout-length", options.rollout_length,
                   "Frames of a truncated roll-out of the recurrence, before it restarts")
      ->capture_default_str();
  verb->add_option("--rollouts", options.rollouts,
                   "Truncated roll-outs that every place of the batch steps through in turn, a frame each")
      ->capture_default_str();
  verb->add_flag("--whole-window", request.whole_window,
                 "The networks look at the whole window, not only at where the body is and as far as clothes reach");
  verb->add_option("--average", options.average,
                   "Keep the average of the weights over the last part of the run, this share of the steps old in the "
                   "mean (0: the last step's)")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  verb->add_option("--shape-loss", parsed->shape_loss, "Of the classes: cross entropy or absolute differences")
      ->check(CLI::IsMember({"ce", "l1"}))
      ->capture_default_str();
  verb->add_option("--patience", options.patience, "Stop after so many validations without a better one (0: never)")
      ->capture_default_str();
  verb->add_option("--weights", request.weights,
                   "Folder with trained networks (.pth or .safetensors): vgg16 for the perceptual loss, alexnet and "
                   "lpips_alex for validation's LPIPS");
  AddTrainingOptions(verb, &options, "Of weights and order of frames");
  verb->footer(
      "Example:\n"
      "  bodyloom synth-person --motion dance.pkl --out dancer --frames 600\n"
      "  bodyloom train motion --data dancer --out run --steps 4000\n"
      "  bodyloom animate motion --run run --track other.npz --out other.mp4");
  verb->callback([parsed, action] { *action = [parsed] { RunTrainMotion(*parsed); }; });
}

}  // namespace bodyloom
