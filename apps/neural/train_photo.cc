// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "apps/neural/neural_verbs.h"
#include "apps/neural/training_options.h"
#include "apps/progress.h"
#include "pipelines/neural/photo/people_data.h"
#include "pipelines/neural/photo/train_photo_renderer.h"

namespace bodyloom {
namespace {

struct TrainPhotoArguments {
  TrainPhotoRendererRequest request;
  std::string profile = "cpu", variant = "full";
};

void RunTrainPhoto(const TrainPhotoArguments& parsed) {
  TrainPhotoRendererRequest request = parsed.request;
  TrainPhotoOptions& options = request.options;
  options.config.profile = PhotoProfileNamed(parsed.profile);
  options.config.variant = PhotoVariantNamed(parsed.variant);
  const TrainPhotoSummary summary = TrainPhotoRenderer(request, CommandCallbacks());
  PrintLosses(summary, options.perceptual_weight > 0 ? "perceptual loss" : nullptr, "VGG-19");
  PrintStep(summary, options.TotalSteps());
  const PersonScores& s = summary.scores;
  if (s.frames > 0) {
    std::printf(
        "validation of %d pairs (%s given): L1 %.4f, PSNR %.2f dB, SSIM %.4f, LPIPS%s %.4f, silhouette IoU %.3f\n",
        s.frames, kGivenOfPeople, s.image_l1, s.psnr_db, s.ssim,
        s.lpips_random_features ? " (random-feature substitute)" : "", s.lpips, s.silhouette_iou);
    std::fflush(stdout);
  }
  PrintEnd(summary, request.out);
}

}  // namespace

void AddTrainPhoto(CLI::App& train, Action* action) {
  CLI::App* verb = train.add_subcommand("photo", "Trains a renderer that needs one photo of a person");
  auto parsed = std::make_shared<TrainPhotoArguments>();
  TrainPhotoRendererRequest& request = parsed->request;
  TrainPhotoOptions& options = request.options;
  AddPeopleOptions(verb, &request.data, &request.out, &request.body);
  AddProfileOption(verb, &parsed->profile);
  verb->add_option("--baseline", parsed->variant,
                   "One of the paper's simpler variants: colours completed beforehand; the seen colours warped, "
                   "without and with the target's pose; no loss on the texture")
      ->check(CLI::IsMember({"full", "ip", "warp", "warpcond", "no-int"}))
      ->capture_default_str();
  verb->add_option("--weights", request.weights,
                   "Folder with trained weights: vgg19, sphereface, alexnet, lpips_alex (.safetensors, .pth)");
  AddStepOptions(verb, &options.steps, &options.batch, &options.learning_rate, "Pairs in a batch");
  verb->add_option("--inpaint-steps", options.inpaint_steps,
                   "Of ip's first stage, which comes before (0: as many as --steps)")
      ->capture_default_str();
  verb->add_option("--gan-weight", options.gan_weight, "Of the discriminator's judgement; 0: none")
      ->capture_default_str();
  verb->add_option("--gan-from", options.gan_from,
                   "Share of --steps after which the discriminator joins (0: from the start, as in the paper)")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->add_option("--validation-pairs", options.validation_pairs, "A person that is kept for validation")
      ->capture_default_str();
  AddTrainingOptions(verb, &options, "Of weights and pairs");
  verb->footer(
      "Example:\n"
      "  bodyloom synth-people --out people\n"
      "  bodyloom train photo --data people --out run --steps 4000\n"
      "  bodyloom animate photo --run run --image me.jpg --image-track me.npz --track dance.npz --out me.mp4");
  verb->callback([parsed, action] { *action = [parsed] { RunTrainPhoto(*parsed); }; });
}

}  // namespace bodyloom
