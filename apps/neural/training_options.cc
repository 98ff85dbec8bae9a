// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/training_options.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <stdexcept>

#include "apps/usage_error.h"
#include "pipelines/clip_span.h"
#include "pipelines/report_text.h"

namespace bodyloom {

void AddRunFolderOption(CLI::App* verb, std::string* out) {
  verb->add_option("--out", *out, "Folder of the run: config.json, checkpoint.bin, metrics.csv, previews")->required();
}

void AddPeopleOptions(CLI::App* verb, std::string* data, std::string* out, std::string* body) {
  verb->add_option("--data", *data, "A multi-person dataset (bodyloom synth-people), or a single-person dataset")
      ->required();
  AddRunFolderOption(verb, out);
  verb->add_option("--body", *body, BodyHelp("The people's body"));
}

void AddStepOptions(CLI::App* verb, int* steps, int* batch, double* learning_rate, const char* batch_help) {
  verb->add_option("--steps", *steps, "Batches to train on")->capture_default_str();
  verb->add_option("--batch", *batch, batch_help)->capture_default_str();
  verb->add_option("--learning-rate", *learning_rate, "At its highest")->capture_default_str();
}

void AddProfileOption(CLI::App* verb, std::string* profile) {
  verb->add_option("--profile", *profile, "Sizes of the networks")
      ->check(CLI::IsMember({"paper", "cpu", "tiny"}))
      ->capture_default_str();
}

void AddTrainingOptions(CLI::App* verb, TrainingRun* run, const char* seed_help) {
  verb->add_option("--validate-every", run->validate_every, "Steps")->capture_default_str();
  verb->add_option("--seed", run->seed, seed_help)->capture_default_str();
  verb->add_option("--threads", run->num_threads, "0: all cores")->capture_default_str();
  verb->add_option("--device", run->device, "Where the networks run")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
  verb->add_flag("--resume", run->resume, "Go on with the run in --out");
}

std::vector<FrameRange> ParseFrameRanges(const std::vector<std::string>& texts, const char* option) {
  std::vector<FrameRange> ranges;
  for (const std::string& text : texts) {
    const auto [first, last] = ReadClipSpan(text, option);
    ranges.push_back({first, last + 1});
  }
  return ranges;
}

void AddMotionDataOptions(CLI::App* verb, MotionDataRequest* request) {
  verb->add_option("--data", request->data,
                   "A single-person dataset (bodyloom synth-person), or a video or folder of images")
      ->required();
  verb->add_option("--track", request->track, "The clip's track (default: the single-person dataset's own)");
  verb->add_option("--body", request->body, BodyHelp("The track's body"));
  verb->add_option("--iuv", request->iuv,
                   "What pixels show of the body by estimates from the images, as in the paper's comparisons: a folder "
                   "of DensePose's IUV images, or \"own\", the single-person dataset's (default: the tracked body)");
  verb->add_option("--mask", request->mask,
                   "For a video: the person's mask (bodyloom detect --mask, bodyloom run --masks), for silhouette, "
                   "classes and normals of the tracked body within it");
  verb->add_option("--part-labels", request->part_labels,
                   "For a video: DensePose's parts (.npz), for classes and, without --mask, the silhouette");
}

void PrintLosses(const RendererTraining& training, const char* perceptual, const char* network) {
  for (const std::string& loss : training.losses_off) std::cout << "loss switched off: " << loss << "\n";
  if (perceptual == nullptr || !training.perceptual_random_features) return;
  std::cout << perceptual << " by a random-feature substitute (no " << network << " weights given)\n";
}

void PrintStep(const TrainingOutcome& outcome, int steps) {
  std::cout << "step " << outcome.steps << " of " << steps << " in " << ClockText(outcome.seconds) << "\n";
}

void PrintEnd(const RendererTraining& training, const std::string& out) {
  std::cout << "wrote " << training.checkpoint << "\n" << std::flush;
  if (training.status == TrainingStatus::kNoProgress) std::cout << training.message << "\n";
  RequireNotStopped(training, out);
}

void RequireNotStopped(const TrainingOutcome& outcome, const std::string& out) {
  if (outcome.status == TrainingStatus::kStopped) {
    throw std::runtime_error(out + ": " + outcome.message + "; go on with --resume");
  }
}

}  // namespace bodyloom
