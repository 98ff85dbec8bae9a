// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/refiner/train_person_refiner.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bodyloom/data_tools/learned/refiner_weights_io.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/neural/people/pictures_by_person.h"
#include "bodyloom/pipelines/neural/photo/people_data.h"
#include "bodyloom/pipelines/neural/refiner/refiner_pictures.h"
#include "bodyloom/pipelines/neural/training_session.h"
#include "bodyloom/pipelines/neural/weights_folder.h"

namespace bodyloom {
namespace {

nlohmann::ordered_json Describe(const TrainPersonRefinerRequest& request, const TrainRefinerOptions& o, size_t pictures,
                                size_t test_pictures) {
  return {{"program", "bodyloom train refiner"},
          {"version", BODYLOOM_VERSION},
          {"data", request.data},
          {"pictures", pictures},
          {"test_pictures", test_pictures},
          {"size", request.size},
          {"texture_size", request.texture_size},
          {"body_error_px", request.body_error_px},
          {"seed", o.seed},
          {"steps", o.steps},
          {"batch", o.batch},
          {"crop", o.crop},
          {"learning_rate", o.learning_rate},
          {"weight_decay", o.weight_decay},
          {"moves_outline", o.moves_outline},
          {"alpha_weight", o.alpha_weight},
          {"perceptual_weight", o.perceptual_weight},
          {"average_share", o.average_share},
          {"light_strength", o.light_strength},
          {"vgg16", o.vgg16.source},
          {"device", o.device}};
}

}  // namespace

TrainPersonRefinerSummary TrainPersonRefiner(const TrainPersonRefinerRequest& request,
                                             const PipelineCallbacks& callbacks) {
  TrainRefinerOptions options = request.options;
  std::string why;
  if (!options.IsValid(&why)) throw RequestError(why);
  RequireReadable(request.data, "data");
  OpenTrainingRun(request.out, &options);
  options.vgg16 = ReadWeightsFolder(request.weights).vgg16;

  RefinerPicturesRequest people = {{request.data, request.body, false, request.size, request.body_error_px,
                                    options.seed, ThreadsFor(options.num_threads)},
                                   request.texture_size};
  callbacks.Begin("people");
  const std::vector<PackedPicture> train = RefinerPicturesOf(people, "drawn", callbacks);
  std::vector<PackedPicture> test;
  if (HasTestPeople(request.data)) {
    people.test = true;
    callbacks.Begin("people for validation");
    test = RefinerPicturesOf(people, "drawn", callbacks);
  }
  if (train.empty()) throw std::runtime_error(request.data + ": no person to train on could be drawn");
  const nlohmann::ordered_json config = Describe(request, options, train.size(), test.size());
  options.config_json = config.dump(2) + "\n";
  WriteRunConfig(options);
  callbacks.Say(Concatenate("training on ", train.size(), " pictures; validating on ", test.size()));

  const TrainingProgress to_caller(options.steps, callbacks);
  options.progress = [&](const TrainRefinerProgress& progress) {
    return to_caller.Update(progress.step, {{"loss", progress.loss}, {"image", progress.image}},
                            progress.refined_psnr_db > 0 ? &progress.refined_psnr_db : nullptr);
  };
  TrainRefinerResult result = TrainRefiner(train, test, options);
  RequireFinite(result.summary, request.out);
  result.weights.pixels_per_metre = MedianPersonSize(train);
  result.weights.recipe = config.dump();
  const std::string weights = (std::filesystem::path(request.out) / "refiner.npz").string();
  WriteRefinerWeights(weights, result.weights);
  TrainPersonRefinerSummary summary;
  static_cast<TrainRefinerSummary&>(summary) = result.summary;
  summary.weights = weights;
  summary.num_parameters = result.weights.network.num_parameters();
  summary.pictures = train.size(), summary.test_pictures = test.size();
  return summary;
}

}  // namespace bodyloom
