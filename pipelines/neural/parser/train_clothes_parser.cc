// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/parser/train_clothes_parser.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bodyloom/data_tools/learned/parser_weights_io.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/neural/parser/parser_pictures.h"
#include "bodyloom/pipelines/neural/people/pictures_by_person.h"
#include "bodyloom/pipelines/neural/photo/people_data.h"
#include "bodyloom/pipelines/neural/training_session.h"

namespace bodyloom {
namespace {

nlohmann::ordered_json Describe(const TrainClothesParserRequest& request, size_t pictures, size_t test_pictures) {
  const TrainParserOptions& o = request.options;
  return {{"program", "bodyloom train parser"},
          {"version", BODYLOOM_VERSION},
          {"data", request.data},
          {"pictures", pictures},
          {"test_pictures", test_pictures},
          {"size", request.size},
          {"body_error_px", request.body_error_px},
          {"seed", o.seed},
          {"steps", o.steps},
          {"batch", o.batch},
          {"crop", o.crop},
          {"learning_rate", o.learning_rate},
          {"weight_decay", o.weight_decay},
          {"average_share", o.average_share},
          {"light_strength", o.light_strength},
          {"device", o.device}};
}

}  // namespace

TrainClothesParserSummary TrainClothesParser(const TrainClothesParserRequest& request,
                                             const PipelineCallbacks& callbacks) {
  TrainParserOptions options = request.options;
  std::string why;
  if (!IsValidPictureTraining(options, &why)) throw RequestError(why);
  RequireReadable(request.data, "data");
  OpenTrainingRun(request.out, &options);

  PicturesOfPeopleRequest people = {request.data,
                                    request.body,
                                    false,
                                    request.size,
                                    request.body_error_px,
                                    options.seed,
                                    ThreadsFor(options.num_threads)};
  callbacks.Begin("people");
  const std::vector<PackedPicture> train = ParserPicturesOf(people, "read", callbacks);
  std::vector<PackedPicture> test;
  if (HasTestPeople(request.data)) {
    people.test = true;
    callbacks.Begin("people for validation");
    test = ParserPicturesOf(people, "read", callbacks);
  }
  if (train.empty()) throw std::runtime_error(request.data + ": no picture to train on");
  const nlohmann::ordered_json config = Describe(request, train.size(), test.size());
  options.config_json = config.dump(2) + "\n";
  WriteRunConfig(options);
  callbacks.Say(Concatenate("training on ", train.size(), " pictures; validating on ", test.size()));

  const TrainingProgress to_caller(options.steps, callbacks);
  options.progress = [&](const TrainParserProgress& progress) {
    return to_caller.Update(progress.step, {{"loss", progress.loss}, {"IoU", progress.mean_iou}}, nullptr);
  };
  TrainParserResult result = TrainParser(train, test, options);
  RequireFinite(result.summary, request.out);
  result.weights.pixels_per_metre = MedianPersonSize(train);
  result.weights.recipe = config.dump();
  const std::string weights = (std::filesystem::path(request.out) / "parser.npz").string();
  WriteParserWeights(weights, result.weights);
  TrainClothesParserSummary summary;
  static_cast<TrainParserSummary&>(summary) = result.summary;
  summary.weights = weights;
  summary.num_parameters = result.weights.network.num_parameters();
  summary.pictures = train.size(), summary.test_pictures = test.size();
  return summary;
}

}  // namespace bodyloom
