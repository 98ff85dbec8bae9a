// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/surface_contact/clip_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "geometry/body/centre_of_mass.h"
#include "geometry/scene/camera_path.h"
#include "tracking/problem/mass_centre.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/terms/ground_contact/ground_contact.h"
#include "tracking/terms/surface_contact/surface_contact.h"

namespace bodyloom {

using Eigen::Matrix3Xd;
using Eigen::VectorXd;

namespace {

constexpr double kLowestM = 0.02;  ///< points of a hovering body within this of its lowest one touch

/// Heights of all points in all frames above each frame's ground; infinite where it is not known.
struct Heights {
  std::vector<Matrix3Xd> places;
  std::vector<VectorXd> heights;
  std::vector<double> lowest;
};

Heights Measure(const SequenceProblem& problem, const std::vector<ContactPoint>& points, int num_threads) {
  const int T = static_cast<int>(problem.frames.size());
  Heights result;
  result.places.resize(T);
  result.heights.resize(T);
  result.lowest.assign(T, std::numeric_limits<double>::infinity());
  ParallelFor(T, num_threads, [&](int t) {
    thread_local ContactPlaces places;
    const FrameGround* ground = problem.frames[t].ground;
    if (ground == nullptr) return;
    places.Evaluate(problem, t, points, &result.places[t]);
    result.heights[t] = (ground->up.transpose() * result.places[t]).array() - ground->level_m;
    result.lowest[t] = result.heights[t].minCoeff();
  });
  return result;
}

/// Frames of a body that is higher than it can be: not in flight, or higher than a flight between the ends of its
/// stretch allows.
std::vector<char> FindHovering(const SequenceProblem& problem, const CompiledPoint& centre_of_mass,
                               const std::vector<double>& lowest, int num_threads) {
  const size_t T = lowest.size();
  std::vector<char> hovers(T, 0);
  const auto goes_on = [&](size_t t) { return t > 0 && t < T && problem.cut_before[t] == 0; };
  Matrix3Xd centres;
  for (size_t begin = 0; begin < T;) {
    if (!(lowest[begin] > kTouchingM) || problem.frames[begin].ground == nullptr) {
      ++begin;
      continue;
    }
    size_t end = begin + 1;
    while (goes_on(end) && lowest[end] > kTouchingM) ++end;
    if (centres.size() == 0) centres = CentresOfMass(problem, centre_of_mass, num_threads);
    const CentreMotion motion = MotionAround(problem, centres, static_cast<int>((begin + end - 1) / 2));
    const bool falls = motion.found && motion.acceleration.dot(problem.frames[begin].ground->up) < -kMinFall;
    const std::vector<double>& at = problem.timestamps;
    const double from = at[goes_on(begin) ? begin - 1 : begin], to = at[goes_on(end) ? end : end - 1];
    for (size_t t = begin; t < end; ++t) {
      const bool flies = falls && lowest[t] <= kTouchingM + RiseInFlight(at[t] - from, to - at[t]);
      hovers[t] = !flies && lowest[t] <= kMaxHoverM ? 1 : 0;
    }
    begin = end;
  }
  return hovers;
}

/// The points that touch the ground in frame t.
std::vector<char> FindTouching(const SequenceProblem& problem, const std::vector<ContactPoint>& points,
                               const Heights& all, const std::vector<char>& hovers, size_t t) {
  std::vector<char> touches(static_cast<size_t>(all.heights[t].size()), 0);
  if (touches.empty()) return touches;
  const bool has_before = t > 0 && problem.cut_before[t] == 0;
  const bool has_after = t + 1 < problem.frames.size() && problem.cut_before[t + 1] == 0;
  const size_t before = has_before ? t - 1 : t, after = has_after ? t + 1 : t;
  const double seconds = problem.timestamps[after] - problem.timestamps[before];
  for (size_t k = 0; k < touches.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    const double height = all.heights[t][c];
    if (hovers[t] != 0) {
      touches[k] = height <= all.lowest[t] + kLowestM ? 1 : 0;
    } else if (height <= (points[k].sole ? kTouchingM : kLowestM) && seconds > 0) {
      touches[k] = (all.places[after].col(c) - all.places[before].col(c)).norm() <= kTouchingSpeed * seconds ? 1 : 0;
    }
  }
  return touches;
}

/// Mean height of the soles that touch in a frame above where they stand flat, or of the lowest point if only others
/// do; NaN if nothing touches.
double TouchingHeight(const std::vector<ContactPoint>& points, const std::vector<char>& touches,
                      const VectorXd& heights, double lowest) {
  double sum = 0;
  int soles = 0, others = 0;
  for (size_t k = 0; k < touches.size(); ++k) {
    if (touches[k] == 0) continue;
    ++(points[k].sole ? soles : others);
    if (points[k].sole) sum += heights[static_cast<Eigen::Index>(k)] - points[k].rest_m;
  }
  return soles > 0 ? sum / soles : others > 0 ? lowest : std::numeric_limits<double>::quiet_NaN();
}

/// Moves the level of each shot's ground, and standing ankles with it, to the median height of what touches it.
void LevelGrounds(const std::vector<ContactPoint>& points, const std::vector<std::vector<char>>& touches,
                  SequenceProblem* problem, Heights* all) {
  std::map<FrameGround*, std::vector<double>> touching;
  for (size_t t = 0; t < touches.size(); ++t) {
    const double height = TouchingHeight(points, touches[t], all->heights[t], all->lowest[t]);
    if (std::isfinite(height)) touching[problem->frames[t].ground].push_back(height);
  }
  std::map<const FrameGround*, double> higher;
  for (auto& [ground, heights] : touching) {
    higher[ground] = Percentile(heights, 50);
    ground->level_m += higher[ground];
  }
  for (size_t t = 0; t < touches.size(); ++t) {
    FrameData& frame = problem->frames[t];
    const auto found = higher.find(frame.ground);
    if (frame.ground == nullptr || found == higher.end()) continue;
    all->heights[t].array() -= found->second;
    Eigen::Vector3d up = frame.ground->up;
    if (frame.camera_from_scene != nullptr) up = frame.camera_from_scene->camera_from_world_rotation * up;
    for (GroundContact& foot : frame.Get<GroundContactTerm>().feet) foot.target_m += found->second * up;
  }
}

}  // namespace

ClipContacts::ClipContacts(const ClipTermInput& clip)
    : weight_(clip.options.ground.surface_weight),
      level_is_given_(clip.input.ground != nullptr && clip.input.ground->has_plane),
      num_threads_(clip.num_threads),
      points_(FindContactPoints(*clip.layout.model)),
      centre_of_mass_(CompileCentreOfMass(*clip.layout.model, clip.layout.num_betas)) {}

void ClipContacts::Observe(SequenceProblem* problem) {
  for (FrameData& frame : problem->frames) frame.Get<SurfaceContactTerm>();
}

void ClipContacts::StartRound(int round, const std::vector<int>& /*frames*/, SequenceProblem* problem) {
  Heights all = Measure(*problem, points_, num_threads_);
  const std::vector<char> hovers = FindHovering(*problem, centre_of_mass_, all.lowest, num_threads_);
  std::vector<std::vector<char>> touches(problem->frames.size());
  for (size_t t = 0; t < problem->frames.size(); ++t) touches[t] = FindTouching(*problem, points_, all, hovers, t);
  if (round > 0 && !level_is_given_) LevelGrounds(points_, touches, problem, &all);
  for (size_t t = 0; t < problem->frames.size(); ++t) {
    FrameData& frame = problem->frames[t];
    auto& term = frame.Get<SurfaceContactTerm>();
    term.contacts.clear();
    if (frame.ground == nullptr) continue;
    term.weight = weight_;
    term.up = frame.ground->up;
    term.level_m = frame.ground->level_m;
    if (const CameraPose* camera = frame.camera_from_scene; camera != nullptr) {
      term.up = camera->camera_from_world_rotation * frame.ground->up;
      term.level_m += term.up.dot(camera->camera_from_world_translation);
    }
    for (size_t k = 0; k < points_.size(); ++k) {
      const bool near = all.heights[t][static_cast<Eigen::Index>(k)] <= kNearM;
      if (near || touches[t][k] != 0)
        term.contacts.push_back({points_[k].vertex, touches[t][k] != 0, points_[k].rest_m});
    }
  }
}

std::vector<PlanEntry> PlanSurfaceContact(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  std::string why_not = WhyNoGround(input, options);
  if (why_not.empty() && !(options.ground.surface_weight > 0)) why_not = "switched off";
  return {{"surface on the ground", why_not.empty(),
           why_not.empty() ? "where a ground is found: nothing is below it, and what touches it lies on it" : why_not}};
}

bool SeeksContacts(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  return PlanSurfaceContact(input, options).front().runs;
}

std::unique_ptr<ClipTerm> MakeClipContacts(const ClipTermInput& clip) {
  if (!SeeksContacts(clip.input, clip.options)) return nullptr;
  return std::make_unique<ClipContacts>(clip);
}

}  // namespace bodyloom
