// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/parser/train_clothes_parser.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "data_tools/learned/parser_weights_io.h"
#include "geometry/base/parallel.h"
#include "pipelines/files.h"
#include "pipelines/neural/parser/training_images.h"
#include "pipelines/neural/training_session.h"

namespace bodyloom {

TrainClothesParserSummary TrainClothesParser(const TrainClothesParserRequest& request,
                                             const PipelineCallbacks& callbacks) {
  TrainParserOptions options = request.options;
  std::string why;
  if (!IsValidImageTraining(options, &why)) throw RequestError(why);
  RequireReadable(request.data, "data");
  OpenTrainingRun(request.out, &options);

  ImagesOfPeopleRequest people = {request.data,
                                  request.body,
                                  false,
                                  request.size,
                                  request.body_error_px,
                                  options.seed,
                                  ThreadsFor(options.num_threads)};
  const TrainingImages images = MakeTrainingImages(request.data, callbacks, [&](bool test) {
    people.test = test;
    return ParserImagesOf(people, "read", callbacks);
  });
  const nlohmann::ordered_json recipe = RecipeOf("bodyloom train parser", people, images, options);
  options.config_json = recipe.dump(2) + "\n";
  WriteRunConfig(options);

  FollowTraining(options.steps, callbacks, &options);
  TrainParserResult result = TrainParser(images.train, images.test, options);
  RequireFinite(result.summary, request.out);
  result.weights.pixels_per_metre = MedianPersonSize(images.train);
  result.weights.recipe = recipe.dump();
  const std::string weights = (std::filesystem::path(request.out) / "parser.npz").string();
  WriteParserWeights(weights, result.weights);
  TrainClothesParserSummary summary;
  static_cast<TrainParserSummary&>(summary) = result.summary;
  summary.weights = weights;
  summary.num_parameters = result.weights.network.num_parameters();
  summary.images = images.train.size(), summary.test_images = images.test.size();
  return summary;
}

}  // namespace bodyloom
