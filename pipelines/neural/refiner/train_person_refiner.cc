// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/refiner/train_person_refiner.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "bodyloom/data_tools/learned/refiner_weights_io.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/neural/people/pictures_by_person.h"
#include "bodyloom/pipelines/neural/people/pictures_to_learn_from.h"
#include "bodyloom/pipelines/neural/refiner/refiner_pictures.h"
#include "bodyloom/pipelines/neural/training_session.h"
#include "bodyloom/pipelines/neural/weights_folder.h"

namespace bodyloom {
namespace {

nlohmann::ordered_json RefinerRecipe(const RefinerPicturesRequest& people, const PicturesToLearnFrom& pictures,
                                     const TrainRefinerOptions& o) {
  nlohmann::ordered_json recipe = RecipeOf("bodyloom train refiner", people, pictures, o);
  recipe["texture_size"] = people.texture_size;
  recipe["moves_outline"] = o.moves_outline;
  recipe["alpha_weight"] = o.alpha_weight;
  recipe["perceptual_weight"] = o.perceptual_weight;
  recipe["vgg16"] = o.vgg16.source;
  return recipe;
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
  const PicturesToLearnFrom pictures = MakePicturesToLearnFrom(request.data, callbacks, [&](bool test) {
    people.test = test;
    return RefinerPicturesOf(people, "drawn", callbacks);
  });
  const nlohmann::ordered_json recipe = RefinerRecipe(people, pictures, options);
  options.config_json = recipe.dump(2) + "\n";
  WriteRunConfig(options);

  const TrainingProgress to_caller(options.steps, callbacks);
  options.progress = [&](const TrainRefinerProgress& progress) {
    return to_caller.Update(progress.step, {{"loss", progress.loss}, {"image", progress.image}},
                            progress.refined_psnr_db > 0 ? &progress.refined_psnr_db : nullptr);
  };
  TrainRefinerResult result = TrainRefiner(pictures.train, pictures.test, options);
  RequireFinite(result.summary, request.out);
  result.weights.pixels_per_metre = MedianPersonSize(pictures.train);
  result.weights.recipe = recipe.dump();
  const std::string weights = (std::filesystem::path(request.out) / "refiner.npz").string();
  WriteRefinerWeights(weights, result.weights);
  TrainPersonRefinerSummary summary;
  static_cast<TrainRefinerSummary&>(summary) = result.summary;
  summary.weights = weights;
  summary.num_parameters = result.weights.network.num_parameters();
  summary.pictures = pictures.train.size(), summary.test_pictures = pictures.test.size();
  return summary;
}

}  // namespace bodyloom
