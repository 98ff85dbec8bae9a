// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/photo/train_photo_renderer.h"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "neural/photo/photo_window.h"
#include "pipelines/files.h"
#include "pipelines/neural/photo/people_data.h"
#include "pipelines/neural/training_session.h"
#include "pipelines/neural/weights_folder.h"
#include "pipelines/runs/run_config.h"
#include "render/texture/planar_image.h"

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
  if (!folder.empty()) callbacks.Message("weights: " + ToText(weights));
  options->vgg19 = std::move(weights.vgg19);
  options->sphereface = std::move(weights.sphereface);
  options->alexnet = std::move(weights.alexnet);
  options->lpips_heads = std::move(weights.lpips_heads);
}

void SayWhatIsTrained(const TrainPhotoOptions& options, const PipelineCallbacks& callbacks) {
  callbacks.Message(Concatenate(options.train.size(), " people to train on, ", options.validation.size(),
                                " kept for validation; profile ", options.config.profile.name, ", variant ",
                                ToText(options.config.variant), "; clothes reach ", options.reach,
                                " px beyond the body"));
  const int first = options.FirstJudgedStep(), all = options.TotalSteps();
  if (first >= all) {
    callbacks.Message("no discriminator");
  } else if (first != all - options.steps) {
    callbacks.Message(Concatenate("the discriminator joins after step ", first, " of ", all));
  }
}

std::vector<Image> RowOf(const PhotoPreview& p) {
  const int S = p.rendered.size, U = p.source.texture_size;
  return {ImageFromPlanes(p.source.image, S, S), ImageFromPlanes(p.partial_texture, U, U),
          ImageFromPlanes(p.completed_texture, U, U), ImageFromPlanes(p.target.image, S, S),
          ImageFromPlanes(p.rendered.image, S, S)};
}

}  // namespace

TrainPhotoSummary TrainPhotoRenderer(const TrainPhotoRendererRequest& request, const PipelineCallbacks& callbacks) {
  TrainPhotoOptions options = request.options;
  RequireReadable(request.data, "data");
  OpenTrainingRun(request.out, &options);
  ReadPerceptualWeights(request.weights, &options, callbacks);

  const PhotoProfile& profile = options.config.profile;
  const TrainingPeople people(request.data, request.body, profile.image_size, profile.texture_size);
  options.train = Everybody(people.train.source());
  if (people.test) {
    options.validation_source = &people.test->source();
    options.validation = Everybody(people.test->source());
  }
  PhotoRun run;
  run.config = options.config;
  run.reach = options.reach = PhotoReach(people.train.source(), options.train);
  run.notes = Notes(request.data, options);
  options.config_json = PhotoRunJson(run);
  WriteRunConfig(options);
  SayWhatIsTrained(options, callbacks);

  options.ssim = WindowSsim;
  FollowTraining(options.TotalSteps(), callbacks, &options);
  options.preview = [&](int step, const std::vector<PhotoPreview>& previews) {
    std::vector<std::vector<Image>> rows;
    for (const PhotoPreview& preview : previews) rows.push_back(RowOf(preview));
    WritePreview(options, step, rows, profile.image_size);
  };
  const TrainPhotoSummary summary = TrainPhoto(people.train.source(), options);
  RequireFinite(summary, request.out);
  return summary;
}

}  // namespace bodyloom
