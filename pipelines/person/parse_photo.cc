// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/parse_photo.h"

#include <memory>
#include <optional>

#include "bodyloom/data_tools/datasets/label_of_part.h"
#include "bodyloom/data_tools/datasets/nearest_pixel.h"
#include "bodyloom/data_tools/learned/parser_weights_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/people/planar_picture.h"
#include "bodyloom/pipelines/person/fit_photo.h"
#include "bodyloom/pipelines/person/parts_in_picture.h"
#include "bodyloom/render/overlay.h"

namespace bodyloom {
namespace {

/// Half the photo, half the labels' colours.
Image Tinted(const Image& picture, const std::vector<uint8_t>& labels) {
  Image tinted = LabelsPicture(labels, picture.width, picture.height);
  for (size_t i = 0; i < tinted.bgr.size(); ++i) {
    tinted.bgr[i] = labels[i / 3] == 0 ? picture.bgr[i] : static_cast<uint8_t>((tinted.bgr[i] + picture.bgr[i]) / 2);
  }
  return tinted;
}

}  // namespace

std::vector<uint8_t> LabelsOfPhoto(const FittedPhoto& photo, const BodyModel& body, ClothesParser* parser,
                                   int num_threads) {
  const std::vector<uint8_t> mask = MaskInPicture(photo);
  const Camera camera = photo.track.CameraAt(0);
  if (parser != nullptr) return parser->Labels(photo.picture, mask, body, photo.track, camera, num_threads);
  const std::vector<uint8_t> parts = PartsInPicture(body, TrackVertices(body, photo.track, 0), camera, num_threads);
  const std::vector<int> nearest = NearestMarked(parts, camera.width, camera.height);
  std::vector<uint8_t> labels(mask.size(), 0);
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0 && nearest[i] >= 0) labels[i] = static_cast<uint8_t>(LabelOfPart(parts[nearest[i]]));
  }
  return labels;
}

Image NumbersPicture(std::span<const uint8_t> labels, int width, int height) {
  Image numbers(width, height);
  for (size_t i = 0; i < numbers.bgr.size(); ++i) numbers.bgr[i] = labels[i / 3];
  return numbers;
}

PhotoParseSummary ParsePhoto(const PhotoParseRequest& request, const PipelineCallbacks& callbacks) {
  RequireWritable(request.out);
  RequireWritable(request.picture);
  RequireDistinct({request.image, request.weights}, {request.out, request.picture});
  std::optional<ClothesParser> parser;
  if (request.weights == kBuiltinParser) {
    parser.emplace(BuiltinParser());
  } else if (request.weights != kNearestOfBody) {
    parser.emplace(ReadParserWeights(request.weights));
  }
  StageClock clock;
  std::shared_ptr<const BodyModel> body;
  const FittedPhoto photo = FitPhoto(request.fit, request.image, callbacks, &clock, &body);
  clock.Begin("parse");
  PhotoParseSummary summary;
  summary.width = photo.picture.width, summary.height = photo.picture.height;
  summary.labels = LabelsOfPhoto(photo, *body, parser ? &*parser : nullptr, ThreadsFor(request.fit.solve.num_threads));
  clock.Begin("write");
  const std::vector<uint8_t>& labels = summary.labels;
  for (const uint8_t label : labels) ++summary.pixels[label];
  if (!request.out.empty()) {
    WriteImage(request.out, NumbersPicture(labels, photo.picture.width, photo.picture.height));
    summary.written.push_back(request.out);
  }
  if (!request.picture.empty()) {
    WriteImage(request.picture, Tinted(photo.picture, labels));
    summary.written.push_back(request.picture);
  }
  clock.End();
  summary.seconds = clock.seconds();
  return summary;
}

}  // namespace bodyloom
