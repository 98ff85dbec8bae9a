// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/train_photo.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "apps/neural/people_data.h"
#include "apps/neural/photo_preview.h"
#include "apps/neural/photo_run.h"
#include "apps/neural/training_options.h"
#include "apps/neural/training_session.h"
#include "apps/neural/weights_folder.h"
#include "bodyloom/data_tools/datasets/people_set.h"
#include "bodyloom/data_tools/evaluation/ssim.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/neural/photo/photo_window.h"
#include "bodyloom/neural/photo/train_photo.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::string data, body, out, profile = "cpu", variant = "full", weights;
  TrainPhotoOptions options;
};

std::vector<int> Everybody(const PhotoSource& source) {
  std::vector<int> persons(source.num_frames.size());
  std::iota(persons.begin(), persons.end(), 0);
  return persons;
}

/// The people kept for testing; nullptr when the set has none.
std::unique_ptr<PeopleData> TestPeople(PeopleDataRequest request) {
  if (fs::exists(fs::path(request.data) / "person.json")) return nullptr;
  const PeopleSet set = ReadPeopleSet(request.data);
  for (const SetPerson& person : set.people) {
    if (!person.test) continue;
    request.test = true;
    return std::make_unique<PeopleData>(request);
  }
  return nullptr;
}

std::string Notes(const Request& request) {
  const TrainPhotoOptions& o = request.options;
  const nlohmann::ordered_json json = {{"data", request.data},
                                       {"people", o.train.size()},
                                       {"validation_people", o.validation.size()},
                                       {"seed", o.seed},
                                       {"steps", o.steps},
                                       {"inpaint_steps", o.TotalSteps() - o.steps},
                                       {"batch", o.batch},
                                       {"learning_rate", o.learning_rate},
                                       {"weights",
                                        {{"perceptual", o.perceptual_weight},
                                         {"face", o.face_weight},
                                         {"texture", o.texture_weight},
                                         {"gan", o.gan_weight},
                                         {"alpha", o.alpha_weight}}},
                                       {"gan_from", o.gan_from},
                                       {"vgg19", o.vgg19.source},
                                       {"sphereface", o.sphereface.source},
                                       {"threads", o.num_threads}};
  return json.dump();
}

std::string JudgedFrom(const TrainPhotoOptions& options) {
  const int first = options.FirstJudgedStep(), all = options.TotalSteps();
  if (first >= all) return "no discriminator\n";
  if (first == all - options.steps) return "";
  return "the discriminator joins after step " + std::to_string(first) + " of " + std::to_string(all) + "\n";
}

void Run(Request request) {
  TrainPhotoOptions& options = request.options;
  options.config.profile = PhotoProfileNamed(request.profile);
  options.config.variant = PhotoVariantNamed(request.variant);
  RequireReadable(request.data, "data");
  OpenTrainingRun(request.out, &options);
  WeightsFolder weights = ReadWeightsFolder(request.weights);
  if (!request.weights.empty()) std::cout << "weights: " << ToText(weights) << "\n";
  options.vgg19 = std::move(weights.vgg19);
  options.sphereface = std::move(weights.sphereface);
  options.alexnet = std::move(weights.alexnet);
  options.lpips_heads = std::move(weights.lpips_heads);

  PeopleDataRequest people;
  people.data = request.data;
  people.body = request.body;
  people.size = options.config.profile.image_size;
  people.texture_size = options.config.profile.texture_size;
  const PeopleData data(people);
  const std::unique_ptr<PeopleData> test = TestPeople(people);
  options.train = Everybody(data.source());
  if (test) {
    options.validation_source = &test->source();
    options.validation = Everybody(test->source());
  }
  PhotoRun run;
  run.config = options.config;
  run.reach = options.reach = PhotoReach(data.source(), options.train);
  run.notes = Notes(request);
  options.config_json = PhotoRunJson(run);
  WriteRunConfig(options);
  std::cout << options.train.size() << " people to train on, " << options.validation.size()
            << " kept for validation; profile " << request.profile << ", variant " << request.variant
            << "; clothes reach " << run.reach << " px beyond the body\n"
            << JudgedFrom(options) << std::flush;

  TrainingBar bar(options.TotalSteps());
  options.ssim = [](const Image& truth, const Image& result) { return Ssim(truth, result, SsimPreset::kWang2004); };
  options.progress = [&](const TrainPhotoProgress& progress) {
    return bar.Update(progress.step, {{"loss", progress.loss}},
                      progress.scores.pictures > 0 ? &progress.scores.psnr_db : nullptr);
  };
  options.preview = [&](int step, const std::vector<PhotoPreview>& previews) {
    WriteImage(PreviewPath(options, step), PhotoPreviewSheet(previews));
  };
  const TrainPhotoSummary summary = TrainPhoto(data.source(), options);
  RequireFinite(summary, request.out);
  for (const std::string& loss : summary.losses_off) std::cout << "loss switched off: " << loss << "\n";
  if (options.perceptual_weight > 0 && summary.perceptual_stand_in) SayStandIn("perceptual loss", "VGG-19");
  SayStep(summary, options.TotalSteps());
  const PhotoScores& s = summary.scores;
  if (s.pictures > 0) {
    std::printf("validation of %d pairs: L1 %.4f, PSNR %.2f dB, SSIM %.4f, LPIPS%s %.4f, outline IoU %.3f\n",
                s.pictures, s.image_l1, s.psnr_db, s.ssim, s.lpips_stand_in ? " (stand-in)" : "", s.lpips,
                s.outline_iou);
    std::fflush(stdout);
  }
  EndTrainingRun(summary, request.out);
}

}  // namespace

void AddTrainPhoto(CLI::App& train, std::function<void()>* action) {
  CLI::App* verb = train.add_subcommand("photo", "Trains a renderer that needs one photo of a person");
  auto request = std::make_shared<Request>();
  TrainPhotoOptions& options = request->options;
  verb->add_option("--data", request->data, "A people set (bodyloom synth-people), or a person set")->required();
  verb->add_option("--out", request->out, "Folder of the run: config.json, checkpoint.bin, metrics.csv, previews")
      ->required();
  verb->add_option("--body", request->body, "The people's body (default: the built-in body)");
  AddProfileOption(verb, &request->profile);
  verb->add_option("--baseline", request->variant,
                   "One of the paper's simpler variants: colours completed beforehand; the seen colours warped, "
                   "without and with the target's pose; no loss on the texture")
      ->check(CLI::IsMember({"full", "ip", "warp", "warpcond", "no-int"}))
      ->capture_default_str();
  verb->add_option("--weights", request->weights,
                   "Folder with trained weights: vgg19, sphereface, alexnet, lpips_alex (.safetensors, .pth)");
  verb->add_option("--steps", options.steps, "Batches to train on")->capture_default_str();
  verb->add_option("--inpaint-steps", options.inpaint_steps,
                   "Of ip's first stage, which comes before (0: as many as --steps)")
      ->capture_default_str();
  verb->add_option("--batch", options.batch, "Pairs in a batch")->capture_default_str();
  verb->add_option("--learning-rate", options.learning_rate, "At its highest")->capture_default_str();
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
  verb->callback([request, action] { *action = [request] { Run(*request); }; });
}

}  // namespace bodyloom
