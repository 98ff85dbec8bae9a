// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/train_animate.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "apps/exit_code.h"
#include "apps/neural/guided_people.h"
#include "apps/neural/guided_preview.h"
#include "apps/neural/guided_run.h"
#include "apps/neural/training_options.h"
#include "apps/neural/training_session.h"
#include "apps/neural/weights_folder.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/neural/guided/train_guided.h"
#include "bodyloom/neural/photo/photo_window.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

struct Request {
  std::string data, body, out, profile = "cpu", label_loss = "ce", weights;
  std::vector<std::string> without;
  int image_size = 0;
  TrainGuidedOptions options;
};

std::string Notes(const Request& request) {
  const TrainGuidedOptions& o = request.options;
  const nlohmann::ordered_json json = {{"data", request.data},
                                       {"seed", o.seed},
                                       {"steps", o.steps},
                                       {"batch", o.batch},
                                       {"learning_rate", o.learning_rate},
                                       {"label_loss", request.label_loss},
                                       {"balance_steps", o.balance_steps},
                                       {"shares",
                                        {{"perceptual", o.perceptual_share},
                                         {"contextual", o.contextual_share},
                                         {"gan", o.gan_share},
                                         {"kl", o.kl_share}}},
                                       {"predicted_from", o.predicted_from},
                                       {"vgg16", o.vgg16.source},
                                       {"threads", o.num_threads}};
  return json.dump();
}

int ReachOf(const PhotoSource& people) {
  std::vector<int> everybody(people.num_frames.size());
  std::iota(everybody.begin(), everybody.end(), 0);
  return std::min(PhotoReach(people, everybody), people.size / 4);
}

void Run(Request request) {
  TrainGuidedOptions& options = request.options;
  GuidedConfig& config = options.config;
  config.profile = GuidedProfileNamed(request.profile);
  if (request.image_size > 0) {
    config.profile.image_size = config.profile.texture_size = request.image_size;
    std::string why;
    if (!config.IsValid(&why)) throw RequestError("--image-size: " + why);
  }
  for (const std::string& part : request.without) LeaveOut(part, &config);
  options.labels_by_cross_entropy = request.label_loss == "ce";
  RequireReadable(request.data, "data");
  OpenTrainingRun(request.out, &options);
  options.vgg16 = ReadWeightsFolder(request.weights).vgg16;

  PeopleDataRequest people;
  people.data = request.data;
  people.body = request.body;
  people.size = config.profile.image_size;
  people.texture_size = config.profile.texture_size;
  const GuidedPeople data(people);
  people.test = true;
  std::unique_ptr<GuidedPeople> test;
  if (HasTestPeople(people)) {
    test = std::make_unique<GuidedPeople>(people);
    options.validation = test->source();
    options.validation_views = [&test](int person) { return test->VirtualViewsOf(person); };
  }
  GuidedRun run;
  run.config = config;
  run.reach = options.reach = ReachOf(data.source());
  run.notes = Notes(request);
  options.config_json = GuidedRunJson(run);
  WriteRunConfig(options);
  std::cout << data.source().num_frames.size() << " people to train on, " << options.validation.num_frames.size()
            << " kept for validation; profile " << request.profile << "; clothes reach " << run.reach
            << " px beyond the body\n"
            << std::flush;

  TrainingBar bar(options.steps);
  options.progress = [&](const TrainGuidedProgress& progress) {
    return bar.Update(progress.step, {{"loss", progress.loss}, {"image", progress.image}},
                      progress.scores.frames > 0 ? &progress.scores.psnr_db : nullptr);
  };
  options.preview = [&](int step, const std::vector<GuidedPreview>& previews) {
    if (!previews.empty()) WriteImage(PreviewPath(options, step), GuidedPreviewSheet(previews));
  };
  const TrainGuidedSummary summary = TrainGuided(data.source(), options);
  RequireFinite(summary, request.out);
  if (summary.perceptual_stand_in) SayStandIn("perceptual and contextual loss", "VGG-16");
  if (!summary.loss_weights.empty()) {
    std::printf("weights of the losses: VGG %.3g, contextual %.3g, adversarial %.3g, KL %.3g\n",
                summary.loss_weights[0], summary.loss_weights[1], summary.loss_weights[2], summary.loss_weights[3]);
  }
  SayStep(summary, options.steps);
  const GuidedScores& s = summary.scores;
  if (s.frames > 0) {
    std::printf(
        "validation of %d pictures: L1 %.4f, PSNR %.2f dB, outline IoU %.3f, labels IoU %.3f, LPIPS (stand-in) %.4f\n",
        s.frames, s.image_l1, s.psnr_db, s.silhouette_iou, s.label_iou, s.lpips);
  }
  EndTrainingRun(summary, request.out);
}

}  // namespace

void AddTrainAnimate(CLI::App& train, std::function<void()>* action) {
  CLI::App* verb = train.add_subcommand("animate", "Trains a renderer that animates anybody from one photo");
  auto request = std::make_shared<Request>();
  TrainGuidedOptions& options = request->options;
  verb->add_option("--data", request->data, "A people set (bodyloom synth-people)")->required();
  verb->add_option("--out", request->out, "Folder of the run: config.json, checkpoint.bin, metrics.csv, previews")
      ->required();
  verb->add_option("--body", request->body, "The set's body (default: the built-in body)");
  AddProfileOption(verb, &request->profile);
  verb->add_option("--image-size", request->image_size, "Pixels and texels a side (default: the profile's)")
      ->check(CLI::Range(32, 4096));
  verb->add_option("--without", request->without, "Leave out a part, as the paper's ablations do")
      ->check(CLI::IsMember(GuidedParts()));
  verb->add_option("--steps", options.steps, "Batches to train on")->capture_default_str();
  verb->add_option("--batch", options.batch, "Pairs of pictures in a batch")->capture_default_str();
  verb->add_option("--learning-rate", options.learning_rate, "At its highest")->capture_default_str();
  verb->add_option("--balance-steps", options.balance_steps, "Steps by L1 alone, in which the losses are measured")
      ->capture_default_str();
  verb->add_option("--gan-share", options.gan_share, "Of the adversarial loss, beside its balanced weight")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  verb->add_option("--kl-share", options.kl_share, "Of the divergence of the source's code, beside its balanced weight")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  verb->add_option("--label-loss", request->label_loss, "Of the garment labels: cross entropy or absolute differences")
      ->check(CLI::IsMember({"ce", "l1"}))
      ->capture_default_str();
  verb->add_option("--weights", request->weights, "Folder with trained weights: vgg16 (.safetensors, .pth)");
  AddTrainingOptions(verb, &options, "Of weights and order of pictures");
  verb->footer(
      "Example:\n"
      "  bodyloom synth-people --motions motions --out people\n"
      "  bodyloom train animate --data people --out run\n"
      "  bodyloom animate animate --run run --image photo.jpg --image-track photo.npz --track dance.npz --out "
      "dance.mp4");
  verb->callback([request, action] { *action = [request] { Run(*request); }; });
}

}  // namespace bodyloom
