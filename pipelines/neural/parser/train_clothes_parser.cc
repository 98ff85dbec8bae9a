// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/parser/train_clothes_parser.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/learned/parser_weights_io.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "geometry/body/posed_body.h"
#include "neural/parser/packed_image.h"
#include "pipelines/files.h"
#include "pipelines/neural/photo/people_data.h"
#include "pipelines/neural/training_session.h"
#include "render/texture/planar_image.h"
#include "render/view/overlay.h"
#include "render/view/view_camera.h"
#include "tracking/detection/clothes_parser.h"

namespace bodyloom {
namespace {

// Makes the training images of the clothes parser from a multi-person dataset, with bodies as inexact as fits to
// users' photos.

// Images made person by person on several threads.

struct ImagesOfPeopleRequest {
  std::string data;          ///< a multi-person dataset
  std::string body;          ///< empty: the built-in body
  bool test = false;         ///< the test people instead of the training people
  int size = 512;            ///< of the windows
  double body_error_px = 4;  ///< maximum error of the bodies, drawn per clip: PeopleDataRequest
  uint64_t seed = 1;         ///< of those errors
  int threads = 1;
};

// Images for training and testing an image U-Net (neural/parser/packed_image.h), and their record.

struct TrainingImages {
  std::vector<PackedImage> train;  ///< at least one
  std::vector<PackedImage> test;   ///< empty if the dataset has no test people
};

std::vector<PackedImage> ImagesOfPerson(const PeopleData& people, int person) {
  const PhotoSource& source = people.source();
  std::vector<PackedImage> images;
  for (int f = 0; f < source.num_frames[person]; ++f) {
    const Track body = people.BodyOf(person, f);
    if (!body.HasResult(0)) continue;
    const PhotoFrame photo = people.PhotoOf(person, f);
    PhotoFrame truth;
    source.fill(person, f, &truth);
    const Image image = ImageFromPlanes(photo.image, photo.size, photo.size);
    const MatrixX3d rest = ShapeVertices(*people.body(), body.motion.betas);
    const MatrixX3d vertices = TrackVertices(*people.body(), body, 0);
    PersonPhoto parsed;
    parsed.image = &image, parsed.mask = photo.labels, parsed.body = people.body().get();
    parsed.rest_vertices = &rest, parsed.vertices_in_camera = &vertices, parsed.camera = body.CameraAt(0);
    const PersonLayers layers = ParserLayers(parsed, 1);
    if (layers.pixels() == 0) continue;
    PackedImage packed = {
        layers.width, layers.height, PixelsPerMetre(parsed.camera, vertices.col(2).mean()), PackPlanes(layers), {}};
    packed.truth.assign(ParserTruth::kCount * packed.pixels(), 0);
    ForEachPixel(layers, photo.size, photo.size, [&](int x, int y, size_t to) {
      const size_t from = static_cast<size_t>(y) * photo.size + x;
      packed.truth[ParserTruth::kLabel * packed.pixels() + to] = truth.labels[from];
      packed.truth[ParserTruth::kBodyLabel * packed.pixels() + to] = photo.labels[from];
    });
    images.push_back(std::move(packed));
  }
  return images;
}

/// Concatenates images_of(person) of all people in order; the result is the same for any number of threads. Throws what
/// it throws, Cancelled; the stage of `callbacks` is `stage`.
std::vector<PackedImage> ImagesByPerson(int num_people, int threads, const char* stage,
                                        const PipelineCallbacks& callbacks,
                                        const std::function<std::vector<PackedImage>(int)>& images_of) {
  std::vector<std::vector<PackedImage>> of_person(num_people);
  std::mutex mutex;
  int done = 0;
  ParallelFor(num_people, threads, [&](int person) {
    of_person[person] = images_of(person);
    const std::lock_guard lock(mutex);
    callbacks.Update(stage, static_cast<double>(++done) / num_people);
  });
  std::vector<PackedImage> images;
  for (std::vector<PackedImage>& of_one : of_person) {
    std::move(of_one.begin(), of_one.end(), std::back_inserter(images));
  }
  return images;
}

/// Request for the people with labels of the nearest part of the body, and with body errors.
PeopleDataRequest WithEstimatedLabels(const ImagesOfPeopleRequest& request) {
  constexpr int kMapSize = 64;  // of maps that nobody reads
  PeopleDataRequest people;
  people.data = request.data, people.body = request.body, people.size = request.size;
  people.texture_size = kMapSize, people.test = request.test;
  people.given.estimated_labels = people.labels_of_body = true;
  people.body_error_px = request.body_error_px;
  people.seed = request.seed;
  return people;
}

/// Training images of the parser: planes of kParserPlanes with the truth of ParserTruth. Masks are found by GrabCut
/// around the inexact bodies. Ordered by person; the result is the same for any number of threads. Frames without a
/// known body are left out. Throws as PeopleData, Cancelled; the stage of `callbacks` is `stage`.
std::vector<PackedImage> ParserImagesOf(const ImagesOfPeopleRequest& request, const char* stage,
                                        const PipelineCallbacks& callbacks) {
  const PeopleData people(WithEstimatedLabels(request));
  return ImagesByPerson(static_cast<int>(people.source().num_frames.size()), request.threads, stage, callbacks,
                        [&](int person) { return ImagesOfPerson(people, person); });
}

/// Median of the people's scales, pixels per metre; at least one image.
double MedianPersonSize(const std::vector<PackedImage>& images) {
  std::vector<double> sizes;
  sizes.reserve(images.size());
  for (const PackedImage& image : images) sizes.push_back(image.pixels_per_metre);
  return Percentile(sizes, 50);
}

/// `images_of(test)` of both parts of the dataset `data`, as two jobs of the caller's. Throws std::runtime_error
/// without a training image, and what images_of() throws.
TrainingImages MakeTrainingImages(const std::string& data, const PipelineCallbacks& callbacks,
                                  const std::function<std::vector<PackedImage>(bool test)>& images_of) {
  TrainingImages images;
  callbacks.Begin("people");
  images.train = images_of(false);
  if (HasTestPeople(data)) {
    callbacks.Begin("people for validation");
    images.test = images_of(true);
  }
  if (images.train.empty()) throw std::runtime_error(data + ": no image to train on");
  callbacks.Message(Concatenate("training on ", images.train.size(), " images; validating on ", images.test.size()));
  return images;
}

/// Recipe of a training by `program`, stored in config.json and in the weights.
nlohmann::ordered_json RecipeOf(const std::string& program, const ImagesOfPeopleRequest& people,
                                const TrainingImages& images, const ImageTraining& training) {
  return {{"program", program},
          {"version", BODYLOOM_VERSION},
          {"data", people.data},
          {"pictures", images.train.size()},
          {"test_pictures", images.test.size()},
          {"size", people.size},
          {"body_error_px", people.body_error_px},
          {"seed", training.seed},
          {"steps", training.steps},
          {"batch", training.batch},
          {"crop", training.crop},
          {"learning_rate", training.learning_rate},
          {"weight_decay", training.weight_decay},
          {"average_share", training.average_share},
          {"light_strength", training.light_strength},
          {"device", training.device}};
}

}  // namespace

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
