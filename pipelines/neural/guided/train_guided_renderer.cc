// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/guided/train_guided_renderer.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "neural/photo/photo_window.h"
#include "pipelines/files.h"
#include "pipelines/neural/guided/guided_people.h"
#include "pipelines/neural/guided/guided_preview.h"
#include "pipelines/neural/guided/guided_scores.h"
#include "pipelines/neural/training_session.h"
#include "pipelines/neural/weights_folder.h"
#include "pipelines/runs/run_config.h"

namespace bodyloom {
namespace {

std::string Notes(const std::string& data, const TrainGuidedOptions& o) {
  const nlohmann::ordered_json json = {{"data", data},
                                       {"seed", o.seed},
                                       {"steps", o.steps},
                                       {"batch", o.batch},
                                       {"learning_rate", o.learning_rate},
                                       {"label_loss", o.labels_by_cross_entropy ? "ce" : "l1"},
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

int ReachOf(const PhotoSource& people) { return std::min(PhotoReach(people, Everybody(people)), people.size / 4); }

}  // namespace

TrainGuidedRendererSummary TrainGuidedRenderer(const TrainGuidedRendererRequest& request,
                                               const PipelineCallbacks& callbacks) {
  TrainGuidedOptions options = request.options;
  RequireReadable(request.data, "data");
  OpenTrainingRun(request.out, &options);
  WeightsFolder weights = ReadWeightsFolder(request.weights);
  options.vgg16 = std::move(weights.vgg16);
  options.score_weights = GuidedScoreWeightsOf(std::move(weights));

  PeopleDataRequest people;
  people.data = request.data;
  people.body = request.body;
  people.size = options.config.profile.image_size;
  people.texture_size = options.config.profile.texture_size;
  const GuidedPeople data(people);
  std::unique_ptr<GuidedPeople> test;
  if (HasTestPeople(request.data)) {
    people.test = true;
    test = std::make_unique<GuidedPeople>(people);
    options.validation = test->source();
    options.validation_views = [&test](int person) { return test->VirtualViewsOf(person); };
  }
  GuidedRun run;
  run.config = options.config;
  run.reach = options.reach = ReachOf(data.source());
  run.notes = Notes(request.data, options);
  options.config_json = GuidedRunJson(run);
  WriteRunConfig(options);
  callbacks.Say(Concatenate(data.source().num_frames.size(), " people to train on, ",
                            options.validation.num_frames.size(), " kept for validation; profile ",
                            options.config.profile.name, "; clothes reach ", run.reach, " px beyond the body"));

  const TrainingProgress to_caller(options.steps, callbacks);
  options.progress = [&](const TrainGuidedProgress& progress) {
    return to_caller.Update(progress.step, {{"loss", progress.loss}, {"image", progress.image}},
                            progress.scores.frames > 0 ? &progress.scores.psnr_db : nullptr);
  };
  options.preview = [&](int step, const std::vector<GuidedPreview>& previews) {
    if (!previews.empty()) WriteImage(PreviewPath(options, step), GuidedPreviewSheet(previews));
  };
  const TrainGuidedSummary summary = TrainGuided(data.source(), options);
  RequireFinite(summary, request.out);
  return {summary, CheckpointPath(request.out)};
}

}  // namespace bodyloom
