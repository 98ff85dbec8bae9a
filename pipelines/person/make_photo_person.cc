// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/make_photo_person.h"

#include <memory>
#include <optional>
#include <utility>

#include "bodyloom/data_tools/observations/nothing_to_track.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/person/photo_person_builder.h"
#include "bodyloom/pipelines/track/detected_people.h"
#include "bodyloom/pipelines/track/scene_inputs.h"
#include "bodyloom/tracking/track_sequence.h"

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

/// `body` becomes what was fitted.
FittedPhoto Fit(const TrackRequest& fit, const std::string& path, const PipelineCallbacks& callbacks, StageClock* clock,
                std::shared_ptr<const BodyModel>* body) {
  TrackRequest request = fit;
  request.video = path;
  request.out = "-";  // nothing is written: the check wants to know where to
  CheckTrackRequest(request);
  FittedPhoto photo;
  photo.name = path;
  clock->Begin("read");
  photo.picture = ReadImage(path);
  SceneInputs scene = LoadSceneInputs(request);
  UseFocal(request, &scene.camera.camera);
  clock->Begin("detect");
  const DetectedClip clip = DetectForTracking(request, callbacks);
  const std::vector<PersonTrack> everybody = LinkPeople(clip.people);
  if (everybody.empty()) throw NothingToTrack(path + ": nobody was found in the photo");
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
  TrackSequenceOptions options = request.solve;
  options.camera_knowledge = scene.camera_knowledge;
  options.straight_knees_weight = StraightKneesWeight(request, seen.keypoints.convention);
  TrackSequenceResult result = TrackSequence(input, options);
  if (!result.summary.IsUsable() || !result.track.motion.HasPose(0)) {
    throw NothingToTrack(path + ": the person could not be fitted: " + result.summary.message);
  }
  photo.track = std::move(result.track);
  photo.mask = MaskOfPerson(clip, who).frames.at(0);
  *body = scene.body;
  return photo;
}

}  // namespace

PhotoPerson MakePhotoPerson(const PhotoPersonRequest& request, const PipelineCallbacks& callbacks) {
  CheckRequest(request);
  StageClock clock;
  std::optional<PhotoPersonBuilder> builder;
  for (size_t i = 0; i < request.images.size(); ++i) {
    callbacks.Update("photos", static_cast<double>(i) / static_cast<double>(request.images.size()));
    std::shared_ptr<const BodyModel> body;
    const FittedPhoto photo = Fit(request.fit, request.images[i], callbacks, &clock, &body);
    if (!body->has_uv()) throw std::runtime_error(request.fit.body + ": has no UV coordinates, a texture needs them");
    if (!builder) {
      FitClothesOptions clothes;
      clothes.loose = request.loose_garment;
      clothes.num_threads = ThreadsFor(request.fit.solve.num_threads);
      builder.emplace(body, request.texture_size, &clock, clothes);
    }
    builder->Add(photo);
  }
  PhotoPerson person = builder->Finish();
  clock.End();
  person.report.seconds = clock.seconds();
  return person;
}

}  // namespace bodyloom
