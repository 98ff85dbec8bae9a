// SPDX-License-Identifier: Apache-2.0
#include "tracking/rig/track_people_in_views.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/rig.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/clip/fits_progress.h"

namespace bodyloom {
namespace {

bool IsMatched(const std::vector<int>& person_in_view) {
  return std::any_of(person_in_view.begin() + 1, person_in_view.end(), [](int person) { return person >= 0; });
}

size_t NumPeople(const std::vector<ObservedScene>& scenes) {
  size_t count = 0;
  for (const ObservedScene& scene : scenes) count += scene.people.size();
  return count;
}

/// People of several views, as each view alone shows them.
class PeopleInViews {
 public:
  PeopleInViews(const std::vector<ObservedScene>& scenes, const TrackSequenceInput& common, FitsProgress* fits)
      : common_(common), fits_(fits), keypoints_(scenes.size()), alone_(scenes.size()) {
    std::vector<ObservedView> all;
    for (size_t v = 0; v < scenes.size(); ++v) {
      cameras_.push_back(scenes[v].camera);
      for (const KeypointSequence* person : scenes[v].people) {
        keypoints_[v].push_back(*person);
        all.push_back(scenes[v].camera);
        all.back().keypoints = person;
      }
    }
    std::vector<TrackSequenceResult> fits_alone = FitViewsAlone(all, common, fits->NextFits(all.size()));
    auto next = fits_alone.begin();
    for (size_t v = 0; v < scenes.size(); ++v) {
      for (size_t i = 0; i < scenes[v].people.size(); ++i) alone_[v].push_back(std::move(*next++));
    }
  }

  /// People of a view matched with those of the first.
  [[nodiscard]] MatchedViews MatchWithFirst(size_t v) const {
    const std::vector<ViewMotion> first = MotionsOf(0), other = MotionsOf(v);
    if (!cameras_[v].camera_from_rig || !cameras_[v].offset_s) return MatchPeople(first, other);
    MotionAlignment known;
    known.b_from_a = Compose(*cameras_[v].camera_from_rig, Inverse(*cameras_[0].camera_from_rig));
    known.offset_s = *cameras_[v].offset_s;
    return MatchPeople(first, other, known);
  }

  /// Fits a person in all views that show them; `index` are these views.
  TrackViewsResult FitTogether(const std::vector<int>& person_in_view, const KnownGround* ground,
                               std::vector<int>* index) {
    std::vector<ObservedView> views;
    std::vector<TrackSequenceResult> starts;
    index->clear();
    for (size_t v = 0; v < cameras_.size(); ++v) {
      const int person = person_in_view[v];
      if (person < 0) continue;
      views.push_back(cameras_[v]);
      views.back().keypoints = &keypoints_[v][person];
      starts.push_back(alone_[v][person]);
      index->push_back(static_cast<int>(v));
    }
    TrackSequenceInput shared = common_;
    if (shared.ground == nullptr) shared.ground = ground;
    return FitViewsTogether(views, std::move(starts), shared, fits_->NextFit());
  }

  TrackSequenceResult FitInFirst(size_t person, const KnownGround* ground) {
    ObservedView first = cameras_[0];
    first.keypoints = &keypoints_[0][person];
    TrackSequenceInput input = InputOfView(first, common_);
    input.ground = common_.ground != nullptr ? common_.ground : ground;
    TrackSequenceOptions options = fits_->NextFit();
    options.camera_knowledge = first.knowledge;
    return FitClip(input, options);
  }

  /// The first view's camera is known from now on.
  void KnowFirst(const Camera& camera) {
    cameras_[0].knowledge = CameraKnowledge::kKnown;
    cameras_[0].camera = camera;
    cameras_[0].camera_from_rig = CameraPose();
  }
  /// So is a further one, and its clock: all times become those of the first one's clock.
  void Know(int v, const ViewSummary& found, double middle_s) {
    ObservedView& view = cameras_[v];
    view.knowledge = CameraKnowledge::kKnown;
    view.camera = found.camera;
    view.camera_from_rig = found.camera_from_scene;
    view.offset_s = 0;
    RigCamera clock;
    clock.offset_s = found.offset_s;
    clock.rate = found.rate;
    clock.middle_s = middle_s;
    const auto retime = [&](std::vector<double>* times) {
      for (double& time : *times) time = clock.FirstTimeAt(time);
    };
    for (KeypointSequence& person : keypoints_[v]) retime(&person.timestamps);
    for (TrackSequenceResult& person : alone_[v]) retime(&person.track.motion.timestamps);
  }

 private:
  [[nodiscard]] std::vector<ViewMotion> MotionsOf(size_t v) const {
    std::vector<ViewMotion> motions;
    for (const TrackSequenceResult& person : alone_[v]) motions.push_back(MotionOf(person));
    return motions;
  }

  TrackSequenceInput common_;
  FitsProgress* fits_;
  std::vector<ObservedView> cameras_;
  std::vector<std::vector<KeypointSequence>> keypoints_;
  std::vector<std::vector<TrackSequenceResult>> alone_;
};

/// The leader's views are known from here on. False, with the reasons, if the fit of these failed.
bool KnowCameras(const TrackViewsResult& led, const std::vector<int>& index, PeopleInViews* people,
                 TrackPeopleInViewsResult* result) {
  const TrackSequenceSummary& joint = led.joint.summary;
  for (size_t i = 1; i < index.size(); ++i) {
    result->left_out[index[i]] = joint.IsUsable() ? led.summary.alignment[i].why : joint.message;
  }
  if (!joint.IsUsable()) return false;
  const std::vector<double>& times = led.joint.track.motion.timestamps;
  people->KnowFirst(led.joint.track.camera);
  size_t next = 0;
  for (size_t i = 1; i < index.size(); ++i) {
    if (led.summary.used[i] == 0) continue;
    const ViewSummary& camera = joint.views[next++];
    people->Know(index[i], camera, 0.5 * (times.front() + times.back()));
    result->cameras[index[i] - 1] = camera;
    result->left_out[index[i]].clear();
  }
  return true;
}

/// Fits a person with the cameras as they are known, and notes the views that were used.
TrackSequenceResult FitPersonInViews(size_t p, const KnownGround* ground, PeopleInViews* people,
                                     std::vector<int>* person_in_view) {
  if (IsMatched(*person_in_view)) {
    std::vector<int> index;
    TrackViewsResult fitted = people->FitTogether(*person_in_view, ground, &index);
    if (fitted.joint.summary.IsUsable()) {
      for (size_t i = 1; i < index.size(); ++i) {
        if (fitted.summary.used[i] == 0) (*person_in_view)[index[i]] = -1;
      }
      return std::move(fitted.joint);
    }
    std::fill(person_in_view->begin() + 1, person_in_view->end(), -1);
  }
  return people->FitInFirst(p, ground);
}

/// Vertical and ground of all fits. Sizes are the views' business: they tell distances.
SharedScene SceneOfPeople(const std::vector<TrackSequenceResult>& people, const Camera& camera,
                          const std::optional<FocalPrior>& prior) {
  std::vector<TrackSequenceSummary> summaries;
  for (const TrackSequenceResult& person : people) summaries.push_back(person.summary);
  CommonGroundOptions ground;
  ground.size_sigma = 0;
  return JoinScenes(summaries, prior.value_or(FocalPrior::ForImage(camera.width, camera.height)), ground);
}

}  // namespace

TrackPeopleInViewsResult TrackPeopleInViews(const std::vector<ObservedScene>& scenes, const TrackSequenceInput& common,
                                            const TrackSequenceOptions& options) {
  BODYLOOM_CHECK(scenes.size() >= 2, "track people in views: ", scenes.size(), " views, expected two or more");
  BODYLOOM_CHECK(!scenes[0].people.empty(), "track people in views: the first view has no people");
  const size_t V = scenes.size(), P = scenes[0].people.size();
  TrackPeopleInViewsResult result;
  result.people.resize(P);
  result.person_in_view.assign(P, std::vector<int>(V, -1));
  result.left_out.resize(V);
  result.cameras.resize(V - 1);
  FitsProgress fits(options, NumPeople(scenes) + (P > 1 ? 2 : 1) * P);
  PeopleInViews people(scenes, common, &fits);
  if (fits.stopped()) return result;

  std::vector<MatchedViews> matched;
  for (size_t v = 1; v < V; ++v) {
    matched.push_back(people.MatchWithFirst(v));
    const std::string& why = matched.back().alignment.why;
    result.left_out[v] = why.empty() ? "it shows nobody whom the first view shows" : why;
    for (size_t p = 0; p < P; ++p) result.person_in_view[p][v] = matched.back().person_of[p];
  }
  for (size_t p = 0; p < P; ++p) result.person_in_view[p][0] = static_cast<int>(p);
  double best = 0;
  for (size_t p = 0; p < P; ++p) {
    double evidence = 0;
    for (const MatchedViews& view : matched) evidence += view.evidence[p];
    if (evidence <= best) continue;
    best = evidence;
    result.leader = static_cast<int>(p);
  }
  double focal_log_sigma = 0;
  if (result.leader >= 0) {
    std::vector<int> index;
    TrackViewsResult led = people.FitTogether(result.person_in_view[result.leader], nullptr, &index);
    const bool known = KnowCameras(led, index, &people, &result);
    focal_log_sigma = led.joint.summary.focal_log_sigma;
    result.people[result.leader] = std::move(led.joint);
    if (!known) result.leader = -1;
  }
  if (fits.stopped()) return result;
  if (result.leader < 0) {
    for (TrackSequenceResult& person : result.people) person.summary.message = result.left_out[1];
    return result;
  }
  for (std::vector<int>& in_view : result.person_in_view) {
    for (size_t v = 1; v < V; ++v) {
      if (!result.left_out[v].empty()) in_view[v] = -1;
    }
  }
  for (size_t p = 0; p < P && !fits.stopped(); ++p) {
    if (static_cast<int>(p) == result.leader) continue;
    result.people[p] = FitPersonInViews(p, nullptr, &people, &result.person_in_view[p]);
  }
  result.scene = SceneOfPeople(result.people, result.people[result.leader].track.camera, scenes[0].camera.focal_prior);
  result.scene.focal_px = result.people[result.leader].track.camera.fx;
  result.scene.focal_log_sigma = focal_log_sigma;
  for (size_t p = 0; P > 1 && result.scene.has_up && common.ground == nullptr && p < P && !fits.stopped(); ++p) {
    TrackSequenceResult again = FitPersonInViews(p, &result.scene.ground, &people, &result.person_in_view[p]);
    if (again.summary.IsUsable() && !fits.stopped()) result.people[p] = std::move(again);
  }
  ShareWorld(result.scene, &result.people);
  return result;
}

}  // namespace bodyloom
