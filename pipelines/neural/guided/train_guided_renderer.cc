// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/guided/train_guided_renderer.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "neural/photo/photo_window.h"
#include "pipelines/files.h"
#include "pipelines/neural/guided/virtual_views.h"
#include "pipelines/neural/training_session.h"
#include "pipelines/neural/weights_folder.h"
#include "pipelines/runs/run_config.h"
#include "render/texture/planar_image.h"

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

std::vector<Image> RowOf(const GuidedPreview& p) {
  const int S = p.truth.size;
  return {ImageFromPlanes(p.source.image, S, S),   ImageFromPlanes(p.pseudo.image, S, S),
          ImageFromPlanes(p.rendered.image, S, S), ImageFromPlanes(p.truth.image, S, S),
          LabelsImage(p.pseudo.labels, S, S),      LabelsImage(p.rendered.labels, S, S),
          LabelsImage(p.truth.labels, S, S)};
}

}  // namespace

TrainGuidedSummary TrainGuidedRenderer(const TrainGuidedRendererRequest& request, const PipelineCallbacks& callbacks) {
  TrainGuidedOptions options = request.options;
  RequireReadable(request.data, "data");
  OpenTrainingRun(request.out, &options);
  WeightsFolder weights = ReadWeightsFolder(request.weights);
  options.vgg16 = std::move(weights.vgg16);
  options.score_weights = LikenessWeightsOf(std::move(weights));

  const GuidedProfile& profile = options.config.profile;
  const TrainingPeople people(request.data, request.body, profile.image_size, profile.texture_size);
  if (people.test) {
    options.validation = people.test->source();
    options.validation_views = [&](int person) {
      return VirtualViews(*people.test->body(), people.test->BodyOf(person, 0).motion.betas, profile.image_size,
                          profile.texture_size);
    };
  }
  GuidedRun run;
  run.config = options.config;
  run.reach = options.reach = ReachOf(people.train.source());
  run.notes = Notes(request.data, options);
  options.config_json = GuidedRunJson(run);
  WriteRunConfig(options);
  callbacks.Message(Concatenate(people.train.source().num_frames.size(), " people to train on, ",
                                options.validation.num_frames.size(), " kept for validation; profile ", profile.name,
                                "; clothes reach ", run.reach, " px beyond the body"));

  FollowTraining(options.steps, callbacks, &options);
  options.preview = [&](int step, const std::vector<GuidedPreview>& previews) {
    std::vector<std::vector<Image>> rows;
    for (const GuidedPreview& preview : previews) rows.push_back(RowOf(preview));
    WritePreview(options, step, rows, std::max(128, profile.image_size));
  };
  const TrainGuidedSummary summary = TrainGuided(people.train.source(), options);
  RequireFinite(summary, request.out);
  return summary;
}

}  // namespace bodyloom
