// SPDX-License-Identifier: Apache-2.0
#include "tracking/rig/track_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/time_bracket.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/clip/fits_progress.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/rig/match_people.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;

/// Options of a fit alone, which only gives a start.
TrackSequenceOptions Alone(TrackSequenceOptions options, const ObservedView& view) {
  options.camera_knowledge = view.knowledge;
  options.solver = SequenceSolver::kChain;
  options.estimate_uncertainty = false;
  options.ground.contact_weight = options.ground.surface_weight = options.ground.balance_weight = 0;
  options.max_fine_iterations = 1;
  options.user_terms.clear();
  return options;
}

/// A view's camera and clock by those of its neighbour in the tree.
struct PlacedView {
  CameraPose from_first;
  double offset_s = 0, offset_sigma_s = 0;
};

/// The tree of best agreement from the first view: each view's neighbour, nearer to the first, and the alignment that
/// takes the neighbour's frame and clock to its own. Views that agree with none keep neighbour −1. Returns where the
/// tree places each view that is used. Views whose pose and clock are known need only agree with the first, which a
/// person who stands still does, too.
std::vector<PlacedView> FindTree(const std::vector<ObservedView>& views, const std::vector<ViewMotion>& motions,
                                 TrackViewsSummary* summary) {
  const int V = static_cast<int>(motions.size());
  summary->alignment.assign(V, MotionAlignment());
  summary->neighbour.assign(V, -1);
  summary->used.assign(V, 0);
  summary->used[0] = 1;
  std::vector<PlacedView> placed(V);
  for (int v = 1; v < V; ++v) {
    if (!views[v].camera_from_rig || !views[v].offset_s || motions[v].points.empty()) continue;
    const PlacedView known = {Compose(*views[v].camera_from_rig, Inverse(*views[0].camera_from_rig)),
                              *views[v].offset_s};
    const MotionAgreement agreement = AgreementOf(motions[0], motions[v], known.from_first, known.offset_s);
    if (agreement.overlap_s == 0 || agreement.distance_m > kMaxMotionDistance_m) continue;
    placed[v] = known;
    summary->used[v] = 1;
    summary->neighbour[v] = 0;
    MotionAlignment& alignment = summary->alignment[v];
    alignment.found = true;
    alignment.b_from_a = known.from_first;
    alignment.offset_s = known.offset_s;
    alignment.distance_m = agreement.distance_m;
  }
  std::vector<std::vector<std::optional<MotionAlignment>>> pairs(V, std::vector<std::optional<MotionAlignment>>(V));
  for (int added = 0; added + 1 < V; ++added) {
    int from = -1, to = -1;
    for (int a = 0; a < V; ++a) {
      if (summary->used[a] == 0) continue;
      for (int b = 0; b < V; ++b) {
        if (summary->used[b] != 0 || motions[b].points.empty()) continue;
        if (!pairs[a][b]) pairs[a][b] = AlignMotions(motions[a], motions[b]);
        if (!pairs[a][b]->found) continue;
        if (from < 0 || pairs[a][b]->distance_m < pairs[from][to]->distance_m) {
          from = a;
          to = b;
        }
      }
    }
    if (from < 0) break;
    const MotionAlignment& alignment = *pairs[from][to];
    summary->used[to] = 1;
    summary->neighbour[to] = from;
    summary->alignment[to] = alignment;
    placed[to] = {Compose(alignment.b_from_a, placed[from].from_first), placed[from].offset_s + alignment.offset_s,
                  std::hypot(placed[from].offset_sigma_s, alignment.offset_sigma_s)};
  }
  for (int v = 1; v < V; ++v) {
    if (summary->used[v] == 0 && pairs[0][v]) summary->alignment[v] = *pairs[0][v];
  }
  return placed;
}

FrameState StateAt(const BodyModel& body, const Track& track, double time, bool* known) {
  const std::optional<TimeBracket> at = FindTimeBracket(track.motion.timestamps, time, 0.1);
  *known = at && track.HasResult(at->before) && track.HasResult(at->after);
  if (!*known) return {};
  const auto state = [&](int t) {
    const BodyPose pose =
        PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
    return FrameState{pose.rotations, pose.trans};
  };
  return InterpolateStates(state(at->before), state(at->after), at->s);
}

/// Poses of the first view's frames: the mean of all views that show the person, in the first view's frame. Frames that
/// no view shows keep the nearest known pose before them.
TrackStart AveragePoses(const BodyModel& body, const std::vector<TrackSequenceResult>& alone,
                        const std::vector<ViewInput>& views, const std::vector<int>& index) {
  TrackStart start;
  FrameLayout layout;
  layout.model = &body;
  const Track& first = alone[0].track;
  const double middle = 0.5 * (first.motion.timestamps.front() + first.motion.timestamps.back());
  start.betas = first.motion.betas;
  for (const int v : index) start.betas += alone[v].track.motion.betas;
  start.betas /= static_cast<double>(1 + index.size());
  std::vector<char> has_pose;
  for (int t = 0; t < first.num_frames(); ++t) {
    const double time = first.motion.timestamps[t];
    std::vector<FrameState> states;
    bool known = false;
    const FrameState own = StateAt(body, first, time, &known);
    if (known) states.push_back(own);
    for (size_t i = 0; i < views.size(); ++i) {
      const double there = time + views[i].offset_s + views[i].rate * (time - middle);
      FrameState state = StateAt(body, alone[index[i]].track, there, &known);
      if (!known) continue;
      states.push_back(StateInCamera(layout, Inverse(views[i].camera_from_scene), start.betas, std::move(state)));
    }
    FrameState mean;
    if (!states.empty()) {
      mean.translation = states[0].translation;
      for (size_t j = 0; j < states[0].rotations.size(); ++j) {
        Matrix3d sum = Matrix3d::Zero();
        for (const FrameState& state : states) sum += state.rotations[j];
        mean.rotations.push_back(NearestRotation(sum));
      }
    }
    has_pose.push_back(states.empty() ? 0 : 1);
    start.states.push_back(std::move(mean));
  }
  const auto nearest = [&](int t) {
    for (int d = 1; d < first.num_frames(); ++d) {
      if (t >= d && has_pose[t - d] != 0) return t - d;
      if (t + d < first.num_frames() && has_pose[t + d] != 0) return t + d;
    }
    return t;
  };
  for (int t = 0; t < first.num_frames(); ++t) {
    if (has_pose[t] == 0) start.states[t] = start.states[nearest(t)];
  }
  return start;
}

/// The paths of the cameras that move, in metres; empty for those that do not, and where the fit alone failed.
std::vector<std::vector<CameraPose>> MetricPaths(const std::vector<ObservedView>& views,
                                                 const std::vector<TrackSequenceResult>& alone) {
  std::vector<std::vector<CameraPose>> paths(views.size());
  for (size_t v = 0; v < views.size(); ++v) {
    if (views[v].camera_from_own == nullptr || !alone[v].summary.IsUsable()) continue;
    paths[v] = ScaledPath(*views[v].camera_from_own, alone[v].summary.camera_path.scale_m);
  }
  return paths;
}

}  // namespace

TrackSequenceInput InputOfView(const ObservedView& view, const TrackSequenceInput& common) {
  TrackSequenceInput input;
  input.body = common.body;
  input.prior = common.prior;
  input.lifter = common.lifter;
  input.stature_m = common.stature_m;
  input.keypoints = view.keypoints;
  input.camera = view.camera;
  input.focal_prior = view.focal_prior;
  input.picture_vertical = view.picture_vertical;
  input.camera_from_scene = view.camera_from_own;
  input.camera_scale_m = view.camera_scale_m;
  return input;
}

TrackSequenceResult FitViewAlone(const ObservedView& view, const TrackSequenceInput& common,
                                 const TrackSequenceOptions& options) {
  return FitClip(InputOfView(view, common), Alone(options, view));
}

std::vector<TrackSequenceResult> FitViewsAlone(const std::vector<ObservedView>& views, const TrackSequenceInput& common,
                                               const std::vector<TrackSequenceOptions>& options) {
  std::vector<TrackSequenceResult> alone(views.size());
  const int threads = views.empty() ? 1 : ThreadsFor(options[0].num_threads);
  ParallelFor(static_cast<int>(views.size()), threads,
              [&](int v) { alone[v] = FitViewAlone(views[v], common, options[v]); });
  return alone;
}

ViewMotion MotionOf(const TrackSequenceResult& alone) {
  constexpr int kFirst = 5, kCount = 12;  // shoulders to ankles
  ViewMotion motion;
  if (!alone.summary.IsUsable()) return motion;
  const Track& track = alone.track;
  motion.timestamps = track.motion.timestamps;
  for (int t = 0; t < track.num_frames(); ++t) {
    motion.points.emplace_back(track.coco17[t].middleRows(kFirst, kCount));
    if (track.frame_status[t] == FrameStatus::kLost || track.frame_status[t] == FrameStatus::kInterpolated) {
      motion.points.back().setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return motion;
}

TrackViewsResult TrackViews(const std::vector<ObservedView>& views, const TrackSequenceInput& common,
                            const TrackSequenceOptions& options) {
  const Stopwatch watch;
  FitsProgress fits(options, views.size() + 1);
  std::vector<TrackSequenceResult> alone = FitViewsAlone(views, common, fits.NextFits(views.size()));
  const double seconds_alone = watch.seconds();
  TrackViewsResult result = FitViewsTogether(views, std::move(alone), common, fits.NextFit());
  result.summary.seconds_alone = seconds_alone;
  result.summary.seconds += seconds_alone;
  return result;
}

TrackViewsResult FitViewsTogether(const std::vector<ObservedView>& views, std::vector<TrackSequenceResult> alone,
                                  const TrackSequenceInput& common, const TrackSequenceOptions& options) {
  BODYLOOM_CHECK(views.size() >= 2, "track views: ", views.size(), " of them, expected two or more");
  const size_t posed =
      static_cast<size_t>(std::count_if(views.begin(), views.end(), [](const auto& v) { return v.camera_from_rig; }));
  BODYLOOM_CHECK(posed == 0 || posed == views.size(), "track views: ", posed, " of ", views.size(),
                 " cameras have a known pose, expected all or none");
  TrackViewsResult result;
  TrackViewsSummary& summary = result.summary;
  const Stopwatch watch;
  result.alone = std::move(alone);
  std::vector<ViewMotion> motions;
  for (const TrackSequenceResult& view : result.alone) motions.push_back(MotionOf(view));
  TrackSequenceSummary& joint = result.joint.summary;
  if (motions[0].points.empty()) {
    joint.message = "the first view: " + result.alone[0].summary.message;
    return result;
  }
  const std::vector<PlacedView> placed = FindTree(views, motions, &summary);
  const bool any = std::any_of(summary.used.begin() + 1, summary.used.end(), [](char used) { return used != 0; });
  if (!any) {
    joint.message = "no other view shows the motion of the first: " +
                    (summary.alignment[1].why.empty() ? "the person is not seen there" : summary.alignment[1].why);
    return result;
  }

  const std::vector<std::vector<CameraPose>> paths = MetricPaths(views, result.alone);
  std::vector<ViewInput> others;
  std::vector<int> index;
  for (size_t v = 1; v < views.size(); ++v) {
    if (summary.used[v] == 0) continue;
    const ObservedView& view = views[v];
    ViewInput& other = others.emplace_back();
    other.keypoints = view.keypoints;
    other.knowledge = view.knowledge;
    other.camera = view.camera;
    if (view.knowledge != CameraKnowledge::kKnown) other.camera.fx = result.alone[v].track.camera.fx;
    other.focal_prior = view.focal_prior;
    other.focal_ratio_log_sigma = view.focal_ratio_log_sigma;
    other.picture_vertical = view.picture_vertical;
    if (view.camera_from_own != nullptr) other.camera_from_own = &paths[v];
    other.pose_known = view.camera_from_rig.has_value();
    other.camera_from_scene =
        other.pose_known ? Compose(*view.camera_from_rig, Inverse(*views[0].camera_from_rig)) : placed[v].from_first;
    other.clock_known = view.offset_s.has_value();
    other.offset_s = view.offset_s.value_or(placed[v].offset_s);
    other.offset_sigma_s = std::max(0.02, 3 * placed[v].offset_sigma_s);
    index.push_back(static_cast<int>(v));
  }
  TrackSequenceInput input = InputOfView(views[0], common);
  TrackStart start = AveragePoses(*common.body, result.alone, others, index);
  start.focal_px = result.alone[0].track.camera.fx;
  if (views[0].camera_from_own != nullptr) {
    input.camera_from_scene = &paths[0];
    input.camera_scale_m = 1;
    FrameLayout layout;
    layout.model = common.body;
    for (size_t t = 0; t < start.states.size(); ++t) {
      start.states[t] = StateInCamera(layout, paths[0][t], start.betas, std::move(start.states[t]));
    }
  }
  input.ground = common.ground;
  input.views = &others;
  input.start = &start;
  TrackSequenceOptions all = options;
  all.camera_knowledge = views[0].knowledge;
  result.joint = FitClip(input, all);
  size_t next = 0;
  for (ViewSummary& view : result.joint.summary.views) {
    const PlacedView& at = placed[index[next]];
    if (!others[next].clock_known) view.repeat_s = summary.alignment[index[next]].repeat_s;
    if (!others[next++].clock_known && at.offset_sigma_s > kUntoldClock_s) {
      view.offset_sigma_s = std::max(view.offset_sigma_s, at.offset_sigma_s);
    }
  }
  summary.seconds = watch.seconds();
  return result;
}

}  // namespace bodyloom
