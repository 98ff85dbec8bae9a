// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/make_photo_person.h"

#include <memory>
#include <optional>
#include <utility>

#include "bodyloom/data_tools/learned/parser_weights_io.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/person/clothes_parser.h"
#include "bodyloom/pipelines/person/fit_photo.h"
#include "bodyloom/pipelines/person/parse_photo.h"
#include "bodyloom/pipelines/person/photo_person_builder.h"

namespace bodyloom {
namespace {

constexpr int kSmallestTexture = 64, kLargestTexture = 8192;

void CheckRequest(const PhotoPersonRequest& request) {
  if (request.images.empty()) throw RequestError("--image is required: a photo of the person");
  if (request.texture_size < kSmallestTexture || request.texture_size > kLargestTexture) {
    throw RequestError(
        Concatenate("--texture-size ", request.texture_size, ": expected ", kSmallestTexture, " to ", kLargestTexture));
  }
}

}  // namespace

PhotoPerson MakePhotoPerson(const PhotoPersonRequest& request, const PipelineCallbacks& callbacks) {
  CheckRequest(request);
  StageClock clock;
  std::optional<PhotoPersonBuilder> builder;
  std::optional<ClothesParser> parser;
  for (size_t i = 0; i < request.images.size(); ++i) {
    callbacks.Update("photos", static_cast<double>(i) / static_cast<double>(request.images.size()));
    std::shared_ptr<const BodyModel> body;
    FittedPhoto photo = FitPhoto(request.fit, request.images[i], callbacks, &clock, &body);
    if (!body->has_uv()) throw std::runtime_error(request.fit.body + ": has no UV coordinates, a texture needs them");
    if (!builder) {
      FitClothesOptions clothes;
      clothes.loose = request.loose_garment;
      clothes.num_threads = ThreadsFor(request.fit.solve.num_threads);
      builder.emplace(body, request.texture_size, &clock, clothes);
    }
    clock.Begin("parse");
    if (!parser) parser.emplace(BuiltinParser());
    photo.labels = LabelsOfPhoto(photo, *body, &*parser, ThreadsFor(request.fit.solve.num_threads));
    builder->Add(photo);
  }
  PhotoPerson person = builder->Finish();
  clock.End();
  person.report.seconds = clock.seconds();
  return person;
}

}  // namespace bodyloom
