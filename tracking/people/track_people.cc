// SPDX-License-Identifier: Apache-2.0
#include "tracking/people/track_people.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/clip/fits_progress.h"
#include "tracking/clip/uncertainty.h"
#include "tracking/hands/fit_hands.h"
#include "tracking/problem/stature.h"
#include "tracking/room/shared_scene.h"

namespace bodyloom {
namespace {

/// A person's observations, copied so that the weight of hidden ones can be reduced.
struct OwnObservations {
  std::optional<KeypointSequence> keypoints;
  std::optional<DenseSequence> dense;
  std::optional<PartLabelSequence> part_labels;

  explicit OwnObservations(const TrackSequenceInput& input) {
    if (input.keypoints != nullptr) keypoints = *input.keypoints;
    if (input.dense != nullptr) dense = *input.dense;
    if (input.part_labels != nullptr) part_labels = *input.part_labels;
  }
  [[nodiscard]] bool has_masks() const { return part_labels.has_value(); }
  [[nodiscard]] PersonInScene InScene(const BodyModel* body, const TrackSequenceResult& result) {
    return {.body = body,
            .track = result.summary.IsUsable() ? &result.track : nullptr,
            .keypoints = keypoints ? &*keypoints : nullptr,
            .dense = dense ? &*dense : nullptr,
            .part_labels = part_labels ? &*part_labels : nullptr};
  }
  void CopyTo(TrackSequenceInput* input) const {
    if (keypoints) input->keypoints = &*keypoints;
    if (dense) input->dense = &*dense;
    if (part_labels) input->part_labels = &*part_labels;
  }
};

/// Masks cost most of a fit and say hardly anything of the focal length and the ground: the last fit alone has them.
/// Whoever has no keypoints keeps them.
void LeaveOutMasks(TrackSequenceInput* person) {
  if (person->keypoints != nullptr) person->part_labels = nullptr;
}

TrackSequenceResult FitPerson(const TrackSequenceInput& input, CameraKnowledge knowledge, FitsProgress* fits) {
  TrackSequenceOptions options = fits->NextFit();
  options.camera_knowledge = knowledge;
  return FitClip(input, options);
}

void CheckOneCamera(const std::vector<TrackSequenceInput>& people) {
  BODYLOOM_CHECK(!people.empty(), "track: nobody to track");
  for (const TrackSequenceInput& person : people) {
    BODYLOOM_CHECK((person.camera_from_scene == nullptr) == (people[0].camera_from_scene == nullptr) &&
                       person.camera_scale_m == people[0].camera_scale_m,
                   "track: the camera moves for some people and stands still for others, expected one camera");
    BODYLOOM_CHECK(person.camera.width == people[0].camera.width && person.camera.height == people[0].camera.height,
                   "track: people of images of ", people[0].camera.width, "x", people[0].camera.height, " and ",
                   person.camera.width, "x", person.camera.height, ", expected one camera");
  }
}

/// Common scale of the path from the scales of the separate fits: their mean, weighted by 1/σ². 0 if no fit found one;
/// then all use the path's rotations only.
double SharedCameraScale(const std::vector<TrackSequenceResult>& people) {
  double sum = 0, weights = 0;
  for (const TrackSequenceResult& person : people) {
    const CameraPathSummary& path = person.summary.camera_path;
    if (!person.summary.IsUsable() || !(path.scale_m > 0 && path.sigma_m > 0)) continue;
    sum += path.scale_m / (path.sigma_m * path.sigma_m);
    weights += 1 / (path.sigma_m * path.sigma_m);
  }
  return weights > 0 ? sum / weights : 0;
}

SharedScene Join(const std::vector<TrackSequenceResult>& people, const FocalPrior& prior,
                 const TrackSequenceOptions& options) {
  std::vector<TrackSequenceSummary> summaries;
  summaries.reserve(people.size());
  for (const TrackSequenceResult& person : people) summaries.push_back(person.summary);
  CommonGroundOptions ground;
  // Weak perspective has no distances, and a shape that is kept has one size.
  if (options.camera_knowledge == CameraKnowledge::kWeak || !options.estimate_shape) ground.size_sigma = 0;
  // A larger person farther away looks the same from one place alone.
  if (std::any_of(summaries.begin(), summaries.end(),
                  [](const TrackSequenceSummary& summary) { return summary.camera_path.moves; })) {
    ground.size_sigma = 0;
  }
  return JoinScenes(summaries, prior, ground);
}

/// Fits everybody again with the one scale of the camera's path, if there is one.
void TakeOneCameraScale(std::vector<TrackSequenceInput>* people, FitsProgress* fits, CameraKnowledge knowledge,
                        TrackPeopleResult* result) {
  const double scale_m = SharedCameraScale(result->people);
  for (size_t i = 0; scale_m > 0 && i < people->size() && !fits->stopped(); ++i) {
    (*people)[i].camera_scale_m = scale_m;
    if (!result->people[i].summary.IsUsable()) continue;
    TrackSequenceResult again = FitPerson((*people)[i], knowledge, fits);
    if (!again.summary.IsUsable() || fits->stopped()) continue;
    result->people[i] = std::move(again);
    result->summary.fitted_again[i] = 1;
  }
}

auto NumStanding(const std::vector<TrackSequenceResult>& people) {
  return std::count_if(people.begin(), people.end(), [](const TrackSequenceResult& person) {
    return person.summary.IsUsable() && !person.summary.ground.stances.empty();
  });
}

}  // namespace

TrackPeopleResult TrackPeople(std::vector<TrackSequenceInput> people, const TrackSequenceOptions& options) {
  CheckOneCamera(people);
  const size_t n = people.size();
  const bool alone = n == 1 || options.camera_knowledge == CameraKnowledge::kWeak;
  const bool unknown_focal = options.camera_knowledge == CameraKnowledge::kUnknownFocal;
  const bool shares_path_scale = n > 1 && people[0].camera_from_scene != nullptr && people[0].camera_scale_m == 0;
  FitsProgress fits(options, (alone ? n : unknown_focal ? 3 * n : 2 * n) + (shares_path_scale ? n : 0));
  // Hands and heads come last, after the fits that the scene asks for.
  std::vector<const HandsAndFaceSequence*> hands_and_faces(n);
  for (size_t i = 0; i < n; ++i) hands_and_faces[i] = std::exchange(people[i].hands_and_face, nullptr);
  const auto fit_hands = [&](TrackPeopleResult* fitted) {
    for (size_t i = 0; i < n && !fits.stopped(); ++i) {
      people[i].hands_and_face = hands_and_faces[i];
      FitHandsAndHead(people[i], ThreadsFor(options.num_threads), &fitted->people[i]);
    }
  };
  std::vector<OwnObservations> own;
  if (!alone) {
    for (const TrackSequenceInput& person : people) own.emplace_back(person);
    for (TrackSequenceInput& person : people) LeaveOutMasks(&person);
  }
  TrackPeopleResult result;
  result.summary.hidden.resize(n);
  result.summary.fitted_again.resize(n, 0);
  int width = 0, height = 0;
  for (const TrackSequenceInput& person : people) {
    result.people.push_back(FitPerson(person, options.camera_knowledge, &fits));
    const auto& [track, summary] = result.people.back();
    if (summary.IsUsable()) width = track.camera.width, height = track.camera.height;
  }
  if (shares_path_scale) TakeOneCameraScale(&people, &fits, options.camera_knowledge, &result);
  SharedScene& scene = result.summary.scene;
  const FocalPrior focal_prior = people[0].focal_prior.value_or(FocalPrior::ForImage(width, height));
  scene = Join(result.people, focal_prior, options);
  if (alone || fits.stopped()) {
    fit_hands(&result);
    return result;
  }

  std::vector<PersonInScene> in_scene;
  for (size_t i = 0; i < n; ++i) in_scene.push_back(own[i].InScene(people[i].body, result.people[i]));
  const int threads = ThreadsFor(options.num_threads);
  result.summary.hidden = DownweightOccluded(in_scene, threads);

  const bool shares_focal = unknown_focal && scene.focal_px > 0;
  const auto fit_again = [&](size_t i, bool with_masks) {
    own[i].CopyTo(&people[i]);
    if (!with_masks) LeaveOutMasks(&people[i]);
    if (shares_focal) people[i].camera = MakePinhole(width, height, scene.focal_px);
    TrackSequenceResult again =
        FitPerson(people[i], shares_focal ? CameraKnowledge::kKnown : options.camera_knowledge, &fits);
    if (!again.summary.IsUsable() || fits.stopped()) return;
    result.people[i] = std::move(again);
    result.summary.fitted_again[i] = 1;
  };
  if (shares_focal && NumStanding(result.people) >= 2) {
    // The positions of feet depend on the focal length, so they are compared after everybody has the same one.
    for (size_t i = 0; i < n && !fits.stopped(); ++i) {
      if (result.people[i].summary.IsUsable()) fit_again(i, false);
    }
    const double log_sigma = scene.focal_log_sigma;
    scene = Join(result.people, focal_prior, options);
    scene.focal_log_sigma = log_sigma;
  }
  for (size_t i = 0; i < n && !fits.stopped(); ++i) {
    TrackSequenceInput& person = people[i];
    if (!result.people[i].summary.IsUsable()) continue;
    const bool shares_ground = scene.has_up && person.ground == nullptr;
    if (!shares_focal && !shares_ground && !result.summary.hidden[i].any() && !own[i].has_masks()) continue;
    if (shares_ground) {
      person.ground = &scene.ground;
      if (scene.size[i] != 1) person.stature_m = scene.size[i] * AssumedStature(person);
    }
    fit_again(i, true);
  }
  for (size_t i = 0; i < n; ++i) {
    if (shares_focal && result.summary.fitted_again[i] != 0) {
      result.people[i].summary.focal_log_sigma = scene.focal_log_sigma;
      AddFocalSpread(scene.focal_log_sigma, &result.people[i].track);
    }
  }
  fit_hands(&result);
  ShareWorld(scene, &result.people);
  return result;
}

}  // namespace bodyloom
