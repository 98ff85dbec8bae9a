// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/photo/train_photo_renderer.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "data_tools/evaluation/ssim.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "neural/photo/photo_window.h"
#include "pipelines/files.h"
#include "pipelines/neural/photo/people_data.h"
#include "pipelines/neural/training_session.h"
#include "pipelines/neural/weights_folder.h"
#include "pipelines/runs/run_config.h"
#include "render/texture/planar_image.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

std::string Notes(const std::string& data, const TrainPhotoOptions& o) {
  const nlohmann::ordered_json json = {{"data", data},
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

void ReadPerceptualWeights(const std::string& folder, TrainPhotoOptions* options, const PipelineCallbacks& callbacks) {
  WeightsFolder weights = ReadWeightsFolder(folder);
  if (!folder.empty()) callbacks.Say("weights: " + ToText(weights));
  options->vgg19 = std::move(weights.vgg19);
  options->sphereface = std::move(weights.sphereface);
  options->alexnet = std::move(weights.alexnet);
  options->lpips_heads = std::move(weights.lpips_heads);
}

void SayWhatIsTrained(const TrainPhotoOptions& options, const PipelineCallbacks& callbacks) {
  callbacks.Say(Concatenate(options.train.size(), " people to train on, ", options.validation.size(),
                            " kept for validation; profile ", options.config.profile.name, ", variant ",
                            ToText(options.config.variant), "; clothes reach ", options.reach, " px beyond the body"));
  const int first = options.FirstJudgedStep(), all = options.TotalSteps();
  if (first >= all) {
    callbacks.Say("no discriminator");
  } else if (first != all - options.steps) {
    callbacks.Say(Concatenate("the discriminator joins after step ", first, " of ", all));
  }
}

}  // namespace

TrainPhotoRendererSummary TrainPhotoRenderer(const TrainPhotoRendererRequest& request,
                                             const PipelineCallbacks& callbacks) {
  TrainPhotoOptions options = request.options;
  RequireReadable(request.data, "data");
  OpenTrainingRun(request.out, &options);
  ReadPerceptualWeights(request.weights, &options, callbacks);

  PeopleDataRequest people;
  people.data = request.data;
  people.body = request.body;
  people.size = options.config.profile.image_size;
  people.texture_size = options.config.profile.texture_size;
  const PeopleData data(people);
  options.train = Everybody(data.source());
  std::unique_ptr<PeopleData> test;
  if (HasTestPeople(request.data)) {
    people.test = true;
    test = std::make_unique<PeopleData>(people);
    options.validation_source = &test->source();
    options.validation = Everybody(test->source());
  }
  PhotoRun run;
  run.config = options.config;
  run.reach = options.reach = PhotoReach(data.source(), options.train);
  run.notes = Notes(request.data, options);
  options.config_json = PhotoRunJson(run);
  WriteRunConfig(options);
  SayWhatIsTrained(options, callbacks);

  const TrainingProgress to_caller(options.TotalSteps(), callbacks);
  options.ssim = [](const Image& truth, const Image& result) { return Ssim(truth, result, SsimPreset::kWang2004); };
  options.progress = [&](const TrainPhotoProgress& progress) {
    return to_caller.Update(progress.step, {{"loss", progress.loss}},
                            progress.scores.pictures > 0 ? &progress.scores.psnr_db : nullptr);
  };
  options.preview = [&](int step, const std::vector<PhotoPreview>& previews) {
    WriteImage(PreviewPath(options, step), PhotoPreviewSheet(previews));
  };
  const TrainPhotoSummary summary = TrainPhoto(data.source(), options);
  RequireFinite(summary, request.out);
  return {summary, CheckpointPath(request.out)};
}

Image PhotoPreviewSheet(const std::vector<PhotoPreview>& previews) {
  std::vector<Image> pictures;
  ContactSheetOptions options;
  options.columns = 5;
  for (const PhotoPreview& p : previews) {
    const int S = p.picture.size, U = p.source.texture_size;
    pictures.push_back(PictureOf(p.source.image, S, S));
    pictures.push_back(PictureOf(p.partial_texture, U, U));
    pictures.push_back(PictureOf(p.completed_texture, U, U));
    pictures.push_back(PictureOf(p.target.image, S, S));
    pictures.push_back(PictureOf(p.picture.image, S, S));
    options.cell_height_px = S;
  }
  return ContactSheet(pictures, options);
}

}  // namespace bodyloom
