// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/fit_photo.h"

#include <utility>
#include <vector>

#include "bodyloom/data_tools/observations/nothing_to_track.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/pipelines/track/detected_people.h"
#include "bodyloom/pipelines/track/scene_inputs.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {

FittedPhoto FitPhoto(const TrackRequest& fit, const std::string& path, const PipelineCallbacks& callbacks,
                     StageClock* clock, std::shared_ptr<const BodyModel>* body) {
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
  photo.mask = MaskOfPerson(clip, who).frames.at(0).Unpacked();
  *body = scene.body;
  return photo;
}

}  // namespace bodyloom
