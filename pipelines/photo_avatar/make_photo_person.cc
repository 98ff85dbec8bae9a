// SPDX-License-Identifier: Apache-2.0
#include "pipelines/photo_avatar/make_photo_person.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "data_tools/datasets/photo_segmentation.h"
#include "data_tools/learned/parser_weights_io.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/observations.h"
#include "pipelines/files.h"
#include "pipelines/track/detected_people.h"
#include "pipelines/track/picture_lines.h"
#include "pipelines/track/scene_inputs.h"
#include "render/photo_avatar/photo_person_builder.h"
#include "render/photo_avatar/texel_labels.h"
#include "render/texture/planar_image.h"
#include "render/view/overlay.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/detection/clothes_parser.h"

namespace bodyloom {

FittedPhoto FitPhoto(const PhotoFitSettings& fit, const std::string& path, const PipelineCallbacks& callbacks,
                     StageClock* clock, std::shared_ptr<const BodyModel>* body) {
  PhotoFitSettings request = fit;
  request.video = path;
  request.find_camera_motion = false;  // one picture
  CheckTrackSettings(request);
  FittedPhoto photo;
  photo.name = path;
  clock->Begin("read");
  photo.image = ReadImage(path);
  SceneInputs scene = LoadSceneInputs(request);
  UseFocal(request, &scene.camera.camera);
  clock->Begin("detect");
  const DetectedClip clip = DetectForTracking(request, callbacks);
  const std::vector<PersonTrack> everybody = LinkPeople(clip.people);
  if (everybody.empty()) throw NoPersonFound(path + ": nobody was found in the photo");
  photo.people = static_cast<int>(everybody.size());
  const PersonTrack who = PersonOf(clip.people, request.person, path);
  DetectedObservations seen = ObservationsOf(clip, who, WholeClip(clip), request, scene);
  if (!seen.mask || seen.mask->frames.empty()) {
    throw RequestError("a person from a photo needs the mask of BlazePose: not with --pose-model or --no-mask");
  }
  clock->Begin("fit");
  TrackSequenceInput input = scene.ForTracker();
  input.keypoints = &seen.keypoints;
  input.part_labels = &*seen.mask;
  const PictureVertical lines = VerticalOfClip(request, clip, scene);
  UsePictureVertical(lines, scene.camera_knowledge, &input);
  TrackSequenceOptions options = request.solve;
  options.camera_knowledge = scene.camera_knowledge;
  options.straight_knees_weight = StraightKneesWeight(request, seen.keypoints.convention);
  TrackSequenceResult result = FitClip(input, options);
  if (!result.summary.IsUsable() || !result.track.motion.HasPose(0)) {
    throw NoPersonFound(path + ": the person could not be fitted: " + result.summary.message);
  }
  photo.track = std::move(result.track);
  photo.mask = MaskOfPerson(clip, who).frames.at(0).Unpacked();
  *body = scene.body;
  return photo;
}

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

namespace {

/// Half the photo, half the labels' colours.
Image Tinted(const Image& image, const std::vector<uint8_t>& labels) {
  Image tinted = LabelsImage(labels, image.width, image.height);
  for (size_t i = 0; i < tinted.bgr.size(); ++i) {
    tinted.bgr[i] = labels[i / 3] == 0 ? image.bgr[i] : static_cast<uint8_t>((tinted.bgr[i] + image.bgr[i]) / 2);
  }
  return tinted;
}

}  // namespace

std::vector<uint8_t> LabelsOfPhoto(const FittedPhoto& photo, const BodyModel& body, ClothesParser* parser,
                                   int num_threads) {
  const std::vector<uint8_t> mask = PhotoMask(photo);
  const Camera camera = photo.track.CameraAt(0);
  if (parser != nullptr) return parser->Labels(photo.image, mask, body, photo.track, camera, num_threads);
  const std::vector<uint8_t> parts = PartsInImage(body, TrackVertices(body, photo.track, 0), camera, num_threads);
  const std::vector<int> nearest = NearestMarked(parts, camera.width, camera.height);
  std::vector<uint8_t> labels(mask.size(), 0);
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0 && nearest[i] >= 0) labels[i] = static_cast<uint8_t>(LabelOfPart(parts[nearest[i]]));
  }
  return labels;
}

Image NumbersImage(std::span<const uint8_t> labels, int width, int height) {
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
  summary.width = photo.image.width, summary.height = photo.image.height;
  summary.labels = LabelsOfPhoto(photo, *body, parser ? &*parser : nullptr, ThreadsFor(request.fit.solve.num_threads));
  clock.Begin("write");
  const std::vector<uint8_t>& labels = summary.labels;
  for (const uint8_t label : labels) ++summary.pixels[label];
  if (!request.out.empty()) {
    WriteImage(request.out, NumbersImage(labels, photo.image.width, photo.image.height));
    summary.written.push_back(request.out);
  }
  if (!request.picture.empty()) {
    WriteImage(request.picture, Tinted(photo.image, labels));
    summary.written.push_back(request.picture);
  }
  clock.End();
  summary.seconds = clock.seconds();
  return summary;
}

}  // namespace bodyloom
