// SPDX-License-Identifier: Apache-2.0
#include "tracking/rig/track_people_in_views.h"

#include <utility>

#include "geometry/base/check.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom {
namespace {

/// The views that show a person, by index, with the person's observations.
std::vector<ObservedView> ViewsOf(const std::vector<ObservedScene>& scenes, const std::vector<int>& person_in_view,
                                  std::vector<int>* index) {
  std::vector<ObservedView> views;
  index->clear();
  for (size_t v = 0; v < scenes.size(); ++v) {
    if (person_in_view[v] < 0) continue;
    views.push_back(scenes[v].camera);
    views.back().keypoints = scenes[v].people[person_in_view[v]];
    index->push_back(static_cast<int>(v));
  }
  return views;
}

/// Agreement of a person's views with the first one, in sum.
double ScoreOf(const std::vector<MatchedViews>& views, size_t person) {
  double score = 0;
  for (const MatchedViews& view : views) {
    if (view.person_of[person] < 0) continue;
    const double share = view.agreement[person].distance_m / kMaxMotionDistance_m;
    score += view.agreement[person].overlap_s * (1 - share * share);
  }
  return score;
}

}  // namespace

TrackPeopleInViewsResult TrackPeopleInViews(const std::vector<ObservedScene>& scenes, const TrackSequenceInput& common,
                                            const TrackSequenceOptions& options) {
  BODYLOOM_CHECK(scenes.size() >= 2, "track people in views: ", scenes.size(), " views, expected two or more");
  BODYLOOM_CHECK(!scenes[0].people.empty(), "track people in views: the first view has no people");
  const size_t V = scenes.size(), P = scenes[0].people.size();
  TrackPeopleInViewsResult result;
  std::vector<std::vector<TrackSequenceResult>> alone(V);
  std::vector<std::vector<ViewMotion>> motions(V);
  for (size_t v = 0; v < V; ++v) {
    ObservedView view = scenes[v].camera;
    for (const KeypointSequence* person : scenes[v].people) {
      view.keypoints = person;
      alone[v].push_back(FitViewAlone(view, common, options));
      motions[v].push_back(MotionOf(alone[v].back()));
    }
  }
  result.person_in_view.assign(P, std::vector<int>(V, -1));
  for (size_t p = 0; p < P; ++p) result.person_in_view[p][0] = static_cast<int>(p);
  for (size_t v = 1; v < V; ++v) {
    result.views.push_back(MatchPeople(motions[0], motions[v]));
    for (size_t p = 0; p < P; ++p) result.person_in_view[p][v] = result.views.back().person_of[p];
  }
  double best = 0;
  for (size_t p = 0; p < P; ++p) {
    const double score = ScoreOf(result.views, p);
    if (score > best) {
      best = score;
      result.leader = static_cast<int>(p);
    }
  }

  std::vector<int> index;
  const auto fit = [&](const std::vector<ObservedScene>& with, size_t p) {
    const std::vector<ObservedView> views = ViewsOf(with, result.person_in_view[p], &index);
    std::vector<TrackSequenceResult> starts;
    for (const int v : index) starts.push_back(alone[v][result.person_in_view[p][v]]);
    return FitViewsTogether(views, std::move(starts), common, options);
  };
  result.people.resize(P);
  result.used.assign(V, 0);
  result.used[0] = 1;
  std::vector<ObservedScene> found = scenes;
  if (result.leader >= 0) {
    TrackViewsResult led = fit(scenes, result.leader);
    const TrackSequenceSummary& joint = led.joint.summary;
    found[0].camera.knowledge = CameraKnowledge::kKnown;
    found[0].camera.camera = led.joint.track.camera;
    found[0].camera.camera_from_rig = CameraPose();
    size_t next = 0;
    for (size_t i = 1; i < index.size(); ++i) {
      if (led.summary.used[i] == 0) continue;
      const ViewSummary& camera = joint.views[next++];
      ObservedView& view = found[index[i]].camera;
      result.used[index[i]] = 1;
      view.knowledge = CameraKnowledge::kKnown;
      view.camera = camera.camera;
      view.camera_from_rig = camera.camera_from_scene;
      view.offset_s = camera.offset_s;
    }
    result.cameras = joint.views;
    result.people[result.leader] = std::move(led.joint);
    if (!result.people[result.leader].summary.IsUsable()) {
      result.why = result.people[result.leader].summary.message;
      result.leader = -1;
    }
  } else {
    result.why =
        result.views[0].alignment.why.empty() ? "nobody is seen in another view" : result.views[0].alignment.why;
  }
  for (size_t p = 0; p < P; ++p) {
    if (static_cast<int>(p) == result.leader) continue;
    int others = 0;
    for (size_t v = 1; v < V; ++v) {
      if (result.used[v] == 0) result.person_in_view[p][v] = -1;
      others += result.person_in_view[p][v] >= 0 ? 1 : 0;
    }
    if (result.leader >= 0 && others > 0) result.people[p] = fit(found, p).joint;
    if (result.people[p].summary.IsUsable()) continue;
    ObservedView first = found[0].camera;
    first.keypoints = scenes[0].people[p];
    TrackSequenceInput input = InputOfView(first, common);
    input.ground = common.ground;
    TrackSequenceOptions by_itself = options;
    by_itself.camera_knowledge = first.knowledge;
    result.people[p] = FitClip(input, by_itself);
  }
  return result;
}

}  // namespace bodyloom
