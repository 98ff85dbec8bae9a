// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "apps/neural/neural_verbs.h"
#include "apps/neural/training_options.h"
#include "apps/progress.h"
#include "pipelines/neural/guided/train_guided_renderer.h"
#include "pipelines/neural/photo/people_data.h"

namespace bodyloom {
namespace {

struct TrainGuidedArguments {
  TrainGuidedRendererRequest request;
  std::string profile = "cpu", label_loss = "ce";
  std::vector<std::string> without;
  int image_size = 0;
};

GuidedConfig ConfigOf(const TrainGuidedArguments& parsed) {
  GuidedConfig config;
  config.profile = GuidedProfileNamed(parsed.profile);
  if (parsed.image_size > 0) {
    config.profile.image_size = config.profile.texture_size = parsed.image_size;
    std::string why;
    if (!config.IsValid(&why)) throw RequestError("--image-size: " + why);
  }
  for (const std::string& part : parsed.without) LeaveOut(part, &config);
  return config;
}

void RunTrainGuided(const TrainGuidedArguments& parsed) {
  TrainGuidedRendererRequest request = parsed.request;
  request.options.config = ConfigOf(parsed);
  request.options.labels_by_cross_entropy = parsed.label_loss == "ce";
  const TrainGuidedSummary summary = TrainGuidedRenderer(request, CommandCallbacks());
  PrintLosses(summary, "perceptual and contextual loss", "VGG-16");
  if (!summary.loss_weights.empty()) {
    std::printf("weights of the losses: VGG %.3g, contextual %.3g, adversarial %.3g, KL %.3g\n",
                summary.loss_weights[0], summary.loss_weights[1], summary.loss_weights[2], summary.loss_weights[3]);
  }
  PrintStep(summary, request.options.steps);
  const PersonScores& s = summary.scores;
  if (s.frames > 0) {
    std::printf(
        "validation of %d images (%s given): L1 %.4f, PSNR %.2f dB, silhouette IoU %.3f, labels IoU %.3f, LPIPS%s "
        "%.4f\n",
        s.frames, kGivenOfPeople, s.image_l1, s.psnr_db, s.silhouette_iou, s.label_iou,
        s.lpips_random_features ? " (random features)" : "", s.lpips);
  }
  PrintEnd(summary, request.out);
}

}  // namespace

void AddTrainGuided(CLI::App& train, Action* action) {
  CLI::App* verb = train.add_subcommand("guided", "Trains a renderer that animates anybody from one photo");
  auto parsed = std::make_shared<TrainGuidedArguments>();
  TrainGuidedRendererRequest& request = parsed->request;
  TrainGuidedOptions& options = request.options;
  AddPeopleOptions(verb, &request.data, &request.out, &request.body);
  AddProfileOption(verb, &parsed->profile);
  verb->add_option("--image-size", parsed->image_size, "Pixels and texels a side (default: the profile's)")
      ->check(CLI::Range(32, 4096));
  verb->add_option("--without", parsed->without, "Leave out a part, as the paper's ablations do")
      ->check(CLI::IsMember(GuidedParts()));
  AddStepOptions(verb, &options.steps, &options.batch, &options.learning_rate, "Pairs of images in a batch");
  verb->add_option("--balance-steps", options.balance_steps, "Steps by L1 alone, in which the losses are measured")
      ->capture_default_str();
  verb->add_option("--gan-share", options.gan_share, "Of the adversarial loss, beside its balanced weight")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  verb->add_option("--kl-share", options.kl_share, "Of the divergence of the source's code, beside its balanced weight")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  verb->add_option("--label-loss", parsed->label_loss, "Of the garment labels: cross entropy or absolute differences")
      ->check(CLI::IsMember({"ce", "l1"}))
      ->capture_default_str();
  verb->add_option("--weights", request.weights,
                   "Folder with trained weights (.safetensors, .pth): vgg16 for the losses, alexnet and lpips_alex for "
                   "validation's LPIPS");
  AddTrainingOptions(verb, &options, "Of weights and order of images");
  verb->footer(
      "Example:\n"
      "  bodyloom synth-people --motions motions --out people\n"
      "  bodyloom train guided --data people --out run\n"
      "  bodyloom animate guided --run run --image photo.jpg --image-track photo.npz --track dance.npz --out "
      "dance.mp4");
  verb->callback([parsed, action] { *action = [parsed] { RunTrainGuided(*parsed); }; });
}

}  // namespace bodyloom
