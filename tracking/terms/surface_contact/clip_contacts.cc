// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/surface_contact/clip_contacts.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "geometry/body/centre_of_mass.h"
#include "geometry/scene/camera_path.h"
#include "tracking/initialise/ground_plane.h"
#include "tracking/problem/mass_centre.h"
#include "tracking/problem/robust.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/terms/ground_contact/ground_contact.h"
#include "tracking/terms/landmarks.h"
#include "tracking/terms/surface_contact/surface_contact.h"

namespace bodyloom {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kMinUpSigma = 1e-4;
constexpr int kMinFallFrames = 5;  ///< of a short flight; a parabola leaves two of them
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

/// True if the centre of mass falls while the body is off the ground in frames [begin, end), or if a stretch is too
/// short to tell. `seconds`: from the frame before them to the frame after.
bool FliesIn(const SequenceProblem& problem, const Matrix3Xd& centres, size_t begin, size_t end, bool has_before,
             bool has_after, double seconds) {
  const int first = static_cast<int>(has_before ? begin - 1 : begin),
            last = static_cast<int>(has_after ? end : end - 1);
  const int middle = static_cast<int>((begin + end - 1) / 2);
  const bool is_short = seconds <= kShortFlight_s;
  if (is_short && (seconds < kShowsFall_s || last - first + 1 < kMinFallFrames)) return true;
  const CentreMotion motion =
      is_short ? MotionOver(problem, centres, first, last, middle) : MotionAround(problem, centres, middle);
  const double fall = is_short ? kMinShortFall : kMinFall;
  return motion.found && motion.acceleration.dot(problem.frames[begin].ground->up) < -fall;
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
    const std::vector<double>& at = problem.timestamps;
    const double from = at[goes_on(begin) ? begin - 1 : begin], to = at[goes_on(end) ? end : end - 1];
    const bool falls = FliesIn(problem, centres, begin, end, goes_on(begin), goes_on(end), to - from);
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

/// A place of the ground in one frame, by the sole of a foot, or by the lowest point where only others touch.
struct Touch {
  bool is_bound = false;                 ///< nothing touches: the ground is at most as high
  int side = 0;                          ///< 1: left foot, -1: right
  Vector3d place_m = Vector3d::Zero();   ///< of the ground under it
  Vector3d camera_m = Vector3d::Zero();  ///< position of the camera
  double seconds = 0;
};

void FindTouches(const SequenceProblem& problem, const std::vector<ContactPoint>& points,
                 const std::vector<char>& touching, const Heights& all, size_t t, std::vector<Touch>* touches) {
  const Vector3d up = problem.frames[t].ground->up;
  const bool has_before = t > 0 && problem.cut_before[t] == 0;
  const double seconds = has_before ? problem.timestamps[t] - problem.timestamps[t - 1] : 0;
  const CameraPose* camera = problem.frames[t].camera_from_scene;
  const Vector3d camera_m = camera != nullptr ? CentreOf(*camera) : Vector3d::Zero();
  bool soles = false;
  for (const int leg : {0, 1}) {
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (size_t k = 0; k < touching.size(); ++k) {
      if (touching[k] == 0 || !points[k].sole || points[k].leg != leg) continue;
      sum += all.places[t].col(static_cast<Eigen::Index>(k)) - points[k].rest_m * up;
      ++count;
    }
    if (count == 0) continue;
    touches->push_back({false, leg == 0 ? 1 : -1, sum / count, camera_m, seconds});
    soles = true;
  }
  if (soles) return;
  Eigen::Index lowest = 0;
  all.heights[t].minCoeff(&lowest);
  const bool others =
      std::any_of(touching.begin(), touching.end(), [](char touches_here) { return touches_here != 0; });
  touches->push_back({!others, 0, all.places[t].col(lowest), camera_m, seconds});
}

/// Fits the grounds of one shot by Gauss–Newton with weights of Geman–McClure; of bounds, Huber's.
void FitGrounds(const std::vector<FrameGround*>& grounds, const std::vector<std::vector<Touch>>& touches) {
  const auto n = static_cast<Eigen::Index>(grounds.size());
  const Vector3d measured = grounds.front()->measured_up;
  const double sigma_u = std::max(grounds.front()->measured_up_sigma_rad, kMinUpSigma),
               depth_m = grounds.front()->depth_sigma_m;
  const Vector3d e1 = measured.unitOrthogonal(), e2 = measured.cross(e1);
  VectorXd x = VectorXd::Zero(3 + n);
  const Vector3d up0 = grounds.front()->up / grounds.front()->up.dot(measured);
  x[0] = e1.dot(up0);
  x[1] = e2.dot(up0);
  for (Eigen::Index k = 0; k < n; ++k) x[2 + k] = grounds[k]->level_m / grounds[k]->up.dot(measured);
  Eigen::MatrixXd H;
  for (int pass = 0; pass < 10; ++pass) {
    H = Eigen::MatrixXd::Zero(3 + n, 3 + n);
    VectorXd rhs = VectorXd::Zero(3 + n);
    H(0, 0) = H(1, 1) = 1 / (sigma_u * sigma_u);
    H(2 + n, 2 + n) = 1 / (kFeetApartM * kFeetApartM);
    for (Eigen::Index k = 0; k < n; ++k) {
      // A level that nothing touches stays where it is.
      H(2 + k, 2 + k) = 1e-6;
      rhs[2 + k] = 1e-6 * x[2 + k];
      for (const Touch& touch : touches[k]) {
        const double along = measured.dot((touch.place_m - touch.camera_m).normalized()) * depth_m;
        const double information = 1 / (kTouchSigmaM * kTouchSigmaM + along * along);
        VectorXd row = VectorXd::Zero(3 + n);
        row[0] = e1.dot(touch.place_m);
        row[1] = e2.dot(touch.place_m);
        row[2 + k] = -1;
        row[2 + n] = -touch.side;
        const double below = touch.is_bound ? kTouchingM : 0;
        const double residual = measured.dot(touch.place_m) + below + row.dot(x);
        if (touch.is_bound && residual > 0) continue;
        const double sigmas = std::abs(residual) * std::sqrt(information);
        const double robust = touch.is_bound ? std::min(1.0, 3 / sigmas) : GemanMcClure(sigmas * sigmas, 3).weight;
        const double weight = touch.seconds / kTouchErrorLasts_s * information * robust;
        H += weight * row * row.transpose();
        rhs -= weight * (measured.dot(touch.place_m) + below) * row;
      }
    }
    x = H.ldlt().solve(rhs);
  }
  const Vector3d up = measured + x[0] * e1 + x[1] * e2;
  const Eigen::MatrixXd covariance = H.inverse();
  for (Eigen::Index k = 0; k < n; ++k) {
    grounds[k]->up = up.normalized();
    grounds[k]->level_m = x[2 + k] / up.norm();
    grounds[k]->up_sigma_rad = std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)));
    grounds[k]->level_sigma_m = std::sqrt(1 / H(2 + k, 2 + k));
    Eigen::Matrix<double, 3, 2> across;
    across << e1, e2;
    grounds[k]->P = across * covariance.topLeftCorner<2, 2>() * across.transpose();
    grounds[k]->q = across * covariance.block<2, 1>(0, 2 + k);
    grounds[k]->s = covariance(2 + k, 2 + k);
  }
}

/// Moves the grounds of each shot to what touches them, and standing ankles with them.
void MoveGrounds(const std::vector<ContactPoint>& points, const std::vector<std::vector<char>>& touches,
                 SequenceProblem* problem, Heights* all) {
  const size_t T = touches.size();
  for (size_t begin = 0, end = 0; begin < T; begin = end) {
    std::vector<FrameGround*> grounds;
    std::vector<std::vector<Touch>> of_ground;
    for (end = begin; end < T && (end == begin || problem->cut_before[end] == 0); ++end) {
      FrameGround* ground = problem->frames[end].ground;
      if (ground == nullptr) continue;
      auto at = std::find(grounds.begin(), grounds.end(), ground) - grounds.begin();
      if (at == static_cast<std::ptrdiff_t>(grounds.size())) {
        grounds.push_back(ground);
        of_ground.emplace_back();
      }
      FindTouches(*problem, points, touches[end], *all, end, &of_ground[at]);
    }
    if (grounds.empty()) continue;
    std::vector<FrameGround> before;
    for (const FrameGround* ground : grounds) before.push_back(*ground);
    FitGrounds(grounds, of_ground);
    for (size_t t = begin; t < end; ++t) {
      FrameData& frame = problem->frames[t];
      if (frame.ground == nullptr) continue;
      const FrameGround& old = before[std::find(grounds.begin(), grounds.end(), frame.ground) - grounds.begin()];
      all->heights[t] = (frame.ground->up.transpose() * all->places[t]).array() - frame.ground->level_m;
      all->lowest[t] = all->heights[t].minCoeff();
      for (GroundContact& foot : frame.Get<GroundContactTerm>().feet) {
        Vector3d place = foot.target_m;
        const CameraPose* camera = frame.camera_from_scene;
        if (camera != nullptr) place = MovedPoint(Inverse(*camera), place);
        const double above = old.up.dot(place) - old.level_m;
        place += (above - (frame.ground->up.dot(place) - frame.ground->level_m)) * frame.ground->up;
        foot.target_m = camera != nullptr ? MovedPoint(*camera, place) : place;
      }
    }
  }
}

/// By frame and leg: any camera sees a landmark of its foot. Everything counts as seen in clips without 2D joints.
std::vector<std::array<bool, 2>> FindSeenFeet(const SequenceProblem& problem) {
  const BodyModel& body = *problem.layout.model;
  std::array<std::array<int, 2>, 2> joints{};
  for (const int leg : {0, 1}) {
    const std::string side = leg == 0 ? "l_" : "r_";
    joints[size_t(leg)] = {body.FindJoint(side + "ankle"), body.FindJoint(side + "foot")};
  }
  std::vector<std::array<bool, 2>> seen(problem.frames.size(), {false, false});
  bool any = false;
  for (size_t t = 0; t < seen.size(); ++t) {
    problem.frames[t].ForEachTerm([&](const FrameTerm* term, int /*view*/) {
      const auto* landmarks = dynamic_cast<const LandmarkTerm*>(term);
      if (landmarks == nullptr) return;
      for (const LandmarkObservation& observation : landmarks->seen) {
        any = true;
        for (const CompiledPoint::Bone& bone : observation.point->bones) {
          for (const size_t leg : {0, 1}) {
            if (bone.joint == joints[leg][0] || bone.joint == joints[leg][1]) seen[t][leg] = true;
          }
        }
      }
    });
  }
  if (!any) seen.assign(seen.size(), {true, true});
  return seen;
}

/// By point and frame: where it is held on the ground, in the frame of the states; soles only (docs/lab/world.md), and
/// not where their foot is not seen, as it rests where the frames around left it.
std::vector<std::vector<std::optional<Vector3d>>> FindHeld(const SequenceProblem& problem,
                                                           const std::vector<ContactPoint>& points,
                                                           const std::vector<std::vector<char>>& touches,
                                                           const Heights& all) {
  const size_t T = touches.size(), num_points = points.size();
  std::vector<char> begins(problem.cut_before);
  for (size_t t = 1; t < T; ++t) {
    if (problem.frames[t].ground != problem.frames[t - 1].ground) begins[t] = 1;
  }
  const std::vector<std::array<bool, 2>> seen = FindSeenFeet(problem);
  std::vector<std::vector<std::optional<Vector3d>>> held(num_points, std::vector<std::optional<Vector3d>>(T));
  for (size_t k = 0; k < num_points; ++k) {
    if (!points[k].sole) continue;
    std::vector<Vector3d> path(T, Vector3d::Zero());
    std::vector<char> touching(T, 0);
    for (size_t t = 0; t < T; ++t) {
      if (touches[t].empty() || touches[t][k] == 0 || !seen[t][size_t(points[k].leg)]) continue;
      touching[t] = 1;
      path[t] = all.places[t].col(static_cast<Eigen::Index>(k));
    }
    held[k] = HeldPlaces(path, touching, begins, problem.timestamps);
  }
  return held;
}

}  // namespace

std::vector<std::optional<Vector3d>> HeldPlaces(const std::vector<Vector3d>& path, const std::vector<char>& touches,
                                                const std::vector<char>& begins,
                                                const std::vector<double>& timestamps) {
  const size_t T = path.size();
  BODYLOOM_CHECK(touches.size() == T && begins.size() == T && timestamps.size() == T, touches.size(), " touches, ",
                 begins.size(), " beginnings and ", timestamps.size(), " timestamps of ", T, " places");
  std::vector<std::optional<Vector3d>> held(T);
  const auto mean = [&](size_t from, size_t to) {
    Vector3d sum = Vector3d::Zero();
    for (size_t t = from; t < to; ++t) sum += path[t];
    return Vector3d(sum / static_cast<double>(to - from));
  };
  for (size_t begin = 0, end = 0; begin < T; begin = end) {
    end = begin + 1;
    if (touches[begin] == 0) continue;
    Vector3d sum = path[begin];
    for (; end < T && begins[end] == 0 && touches[end] != 0; ++end) {
      if ((path[end] - sum / static_cast<double>(end - begin)).norm() > kHoldSpreadM) break;
      sum += path[end];
    }
    if (end - begin < 2 || timestamps[end - 1] - timestamps[begin] < kMinHold_s) continue;
    const size_t middle = (begin + end) / 2;
    if ((mean(begin, middle) - mean(middle, end)).norm() > 0.5 * kHoldSpreadM) continue;
    std::fill(held.begin() + static_cast<std::ptrdiff_t>(begin), held.begin() + static_cast<std::ptrdiff_t>(end),
              mean(begin, end));
  }
  return held;
}

ClipContacts::ClipContacts(const ClipTermInput& clip)
    : weight_(clip.options.ground.surface_weight),
      hold_weight_(kHoldWeight * clip.options.ground.hold_weight),
      level_is_given_(clip.input.ground != nullptr && clip.input.ground->has_plane),
      num_threads_(clip.num_threads),
      points_(FindContactPoints(*clip.layout.model)),
      centre_of_mass_(CompileCentreOfMass(*clip.layout.model, clip.layout.num_betas)) {}

void ClipContacts::Observe(SequenceProblem* problem) {
  for (FrameData& frame : problem->frames) frame.Get<SurfaceContactTerm>();
}

void ClipContacts::StartRound(int /*round*/, const std::vector<int>& /*frames*/, SequenceProblem* problem) {
  Heights all = Measure(*problem, points_, num_threads_);
  const std::vector<char> hovers = FindHovering(*problem, centre_of_mass_, all.lowest, num_threads_);
  std::vector<std::vector<char>> touches(problem->frames.size());
  for (size_t t = 0; t < problem->frames.size(); ++t) touches[t] = FindTouching(*problem, points_, all, hovers, t);
  if (!level_is_given_ && touches.size() >= whole_) MoveGrounds(points_, touches, problem, &all);
  const auto held = hold_weight_ > 0
                        ? FindHeld(*problem, points_, touches, all)
                        : std::vector(points_.size(), std::vector<std::optional<Vector3d>>(touches.size()));
  for (size_t t = 0; t < problem->frames.size(); ++t) {
    FrameData& frame = problem->frames[t];
    auto& term = frame.Get<SurfaceContactTerm>();
    term.contacts.clear();
    if (frame.ground == nullptr) continue;
    term.weight = weight_;
    term.hold_weight = hold_weight_;
    term.up = frame.ground->up;
    term.level_m = frame.ground->level_m;
    if (const CameraPose* camera = frame.camera_from_scene; camera != nullptr) {
      term.up = camera->camera_from_world_rotation * frame.ground->up;
      term.level_m += term.up.dot(camera->camera_from_world_translation);
    }
    for (size_t k = 0; k < points_.size(); ++k) {
      const bool near = all.heights[t][static_cast<Eigen::Index>(k)] <= kNearM;
      if (near || touches[t][k] != 0) {
        const double variance = term.sigma_m * term.sigma_m;
        const Vector3d place = all.places[t].col(static_cast<Eigen::Index>(k));
        const double share = variance / (variance + frame.ground->HeightVariance(place));
        term.contacts.push_back({points_[k].vertex, touches[t][k] != 0, points_[k].rest_m, share, held[k][t]});
        std::optional<Vector3d>& place_m = term.contacts.back().held_m;
        if (place_m && frame.camera_from_scene != nullptr) place_m = MovedPoint(*frame.camera_from_scene, *place_m);
      }
    }
  }
}

std::vector<PlanEntry> PlanSurfaceContact(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  std::string why_not = WhyNoGround(input, options);
  if (why_not.empty() && !(options.ground.surface_weight > 0)) why_not = "switched off";
  std::vector<PlanEntry> plan = {
      {"surface on the ground", why_not.empty(),
       why_not.empty() ? "where a ground is found: nothing is below it, and what touches it lies on it" : why_not}};
  if (why_not.empty() && !(options.ground.hold_weight > 0)) plan.push_back({"held contacts", false, "switched off"});
  return plan;
}

bool SeeksContacts(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  return PlanSurfaceContact(input, options).front().runs;
}

std::unique_ptr<ClipTerm> MakeClipContacts(const ClipTermInput& clip) {
  if (!SeeksContacts(clip.input, clip.options)) return nullptr;
  return std::make_unique<ClipContacts>(clip);
}

}  // namespace bodyloom
