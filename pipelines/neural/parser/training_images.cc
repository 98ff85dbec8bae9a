// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/parser/training_images.h"

#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "geometry/body/posed_body.h"
#include "neural/parser/train_parser.h"
#include "pipelines/neural/photo/people_data.h"
#include "render/texture/planar_image.h"
#include "render/view/overlay.h"
#include "render/view/view_camera.h"
#include "tracking/detection/clothes_parser.h"

namespace bodyloom {
namespace {

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

}  // namespace

std::vector<PackedImage> ParserImagesOf(const ImagesOfPeopleRequest& request, const char* stage,
                                        const PipelineCallbacks& callbacks) {
  const PeopleData people(WithEstimatedLabels(request));
  return ImagesByPerson(static_cast<int>(people.source().num_frames.size()), request.threads, stage, callbacks,
                        [&](int person) { return ImagesOfPerson(people, person); });
}

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

double MedianPersonSize(const std::vector<PackedImage>& images) {
  std::vector<double> sizes;
  sizes.reserve(images.size());
  for (const PackedImage& image : images) sizes.push_back(image.pixels_per_metre);
  return Percentile(sizes, 50);
}

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

}  // namespace bodyloom
