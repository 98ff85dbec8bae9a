// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_motion/camera_motion.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <set>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/percentile.h"
#include "geometry/base/units.h"
#include "geometry/math/rotation.h"
#include "tracking/camera_motion/background_structure.h"
#include "tracking/camera_motion/projected_point.h"
#include "tracking/camera_motion/turning_camera.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFewestPoints = 16, kFewestParts = 5, kFewestMoved = 3;
constexpr double kMaxBrokenShare = 0.3;
constexpr double kMovedPx = 1, kRestsPx = 0.6;  ///< small pixels
constexpr double kMovedShare = 0.6, kRestsShare = 0.25, kTogether = 0.5;
constexpr double kMinExplained = 0.7, kMaxZoom = 1.04;
constexpr double kMinInSpace = 0.65, kLeastParallax = 0.3 * kDegree, kMostOff = 1.0 / 3;
constexpr double kUnexplainedShare = 0.5;  ///< of a zoom's, left by a path instead
constexpr double kMaxGapS = 1;             ///< CameraPathLimits::max_gap_s

void Check(const BackgroundTracks& tracks) {
  const auto frames = static_cast<int>(tracks.timestamps.size());
  int last = -1;
  for (const BackgroundTracks::Anchor& anchor : tracks.anchors) {
    BODYLOOM_CHECK(anchor.frame > last && anchor.frame < frames, "background points: anchor of frame ", anchor.frame,
                   " after ", last, " in a clip of ", frames);
    BODYLOOM_CHECK(anchor.points.size() == anchor.pixels.size(), "background points: ", anchor.points.size(),
                   " names, expected ", anchor.pixels.size());
    last = anchor.frame;
    for (const BackgroundTracks::Sight& sight : anchor.sights) {
      BODYLOOM_CHECK(sight.frame > anchor.frame && sight.frame < frames, "background points: frame ", sight.frame,
                     " seen from frame ", anchor.frame, " in a clip of ", frames);
      BODYLOOM_CHECK(sight.pixels.size() == anchor.pixels.size(), "background points: ", sight.pixels.size(),
                     " places, expected ", anchor.pixels.size());
    }
  }
}

/// Points of one sight, small pixels from the picture's centre.
struct SightPoints {
  std::vector<Vector2d> from, to;
  std::vector<double> ways;
  double median_way = 0;
};

SightPoints PointsOf(const BackgroundTracks& tracks, const BackgroundTracks::Anchor& anchor,
                     const BackgroundTracks::Sight& sight) {
  const Vector2d centre(0.5 * (tracks.width - 1), 0.5 * (tracks.height - 1));
  const double small = SmallPixel(tracks);
  SightPoints points;
  for (size_t i = 0; i < sight.pixels.size(); ++i) {
    if (!sight.pixels[i].allFinite()) continue;
    points.from.emplace_back((anchor.pixels[i].cast<double>() - centre) / small);
    points.to.emplace_back((sight.pixels[i].cast<double>() - centre) / small);
    points.ways.push_back((points.to.back() - points.from.back()).norm());
  }
  if (!points.ways.empty()) points.median_way = Percentile(points.ways, 50);
  return points;
}

/// Median distance of the points from where their similarity of least squares, reweighted, puts them.
double MedianOffSimilarity(const SightPoints& points) {
  using Complex = std::complex<double>;
  const size_t count = points.from.size();
  std::vector<double> weights(count, 1), off(count);
  double median = 0;
  for (int pass = 0; pass < 8; ++pass) {
    Complex mean_from = 0, mean_to = 0;
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
      mean_from += weights[i] * Complex(points.from[i].x(), points.from[i].y());
      mean_to += weights[i] * Complex(points.to[i].x(), points.to[i].y());
      sum += weights[i];
    }
    mean_from /= sum;
    mean_to /= sum;
    Complex product = 0;
    double square = 0;
    for (size_t i = 0; i < count; ++i) {
      const Complex from = Complex(points.from[i].x(), points.from[i].y()) - mean_from,
                    to = Complex(points.to[i].x(), points.to[i].y()) - mean_to;
      product += weights[i] * std::conj(from) * to;
      square += weights[i] * std::norm(from);
    }
    const Complex turn = square > 0 ? product / square : Complex(1);
    for (size_t i = 0; i < count; ++i) {
      const Complex from = Complex(points.from[i].x(), points.from[i].y()) - mean_from,
                    to = Complex(points.to[i].x(), points.to[i].y()) - mean_to;
      off[i] = std::abs(turn * from - to);
    }
    median = Percentile(off, 50);
    const double scale = std::max(0.1, 1.5 * median);
    for (size_t i = 0; i < count; ++i) weights[i] = 1 / (1 + off[i] * off[i] / (scale * scale));
  }
  return median;
}

int PartsOf(const BackgroundTracks& tracks, const SightPoints& points) {
  std::set<int> parts;
  const double small = SmallPixel(tracks);
  for (const Vector2d& at : points.from) {
    const int x = static_cast<int>(4 * (at.x() * small / tracks.width + 0.5)),
              y = static_cast<int>(3 * (at.y() * small / tracks.height + 0.5));
    parts.insert(4 * std::clamp(y, 0, 2) + std::clamp(x, 0, 3));
  }
  return static_cast<int>(parts.size());
}

bool HasMoved(const BackgroundTracks& tracks, const SightPoints& points) {
  const auto count = static_cast<double>(points.ways.size());
  const auto share = [&](const auto& is) {
    return static_cast<double>(std::count_if(points.ways.begin(), points.ways.end(), is)) / count;
  };
  return share([](double way) { return way > kMovedPx; }) >= kMovedShare &&
         share([](double way) { return way < kRestsPx; }) <= kRestsShare &&
         MedianOffSimilarity(points) <= kTogether * points.median_way && PartsOf(tracks, points) >= kFewestParts;
}

// ---- Turning against moving: Torr's criterion ----

/// The 3×3 of least squares with xᵀ F y = 0, rank 2, from points scaled to a unit.
Matrix3d EpipolarOf(const std::vector<Vector2d>& from, const std::vector<Vector2d>& to,
                    const std::vector<size_t>& which) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(which.size()), 9);
  for (size_t n = 0; n < which.size(); ++n) {
    const Vector3d p = from[which[n]].homogeneous(), q = to[which[n]].homogeneous();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) rows(static_cast<Eigen::Index>(n), 3 * i + j) = q[i] * p[j];
    }
  }
  const Eigen::Matrix<double, 9, 9> normal = rows.transpose() * rows;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(normal);
  const Eigen::Matrix<double, 9, 1> f = eigen.eigenvectors().col(0);
  Matrix3d F;
  F << f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8];
  const Eigen::JacobiSVD<Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d values = svd.singularValues();
  values[2] = 0;
  return svd.matrixU() * values.asDiagonal() * svd.matrixV().transpose();
}

/// Σ min(e²/σ², 2 (4 − d)) of the best epipolar geometry of samples of eight points, refined on those it explains.
double EpipolarCost(const SightPoints& points, double sigma, uint64_t seed) {
  constexpr int kSamples = 150;
  constexpr double kUnit = 200;  // small pixels: coordinates near 1
  std::vector<Vector2d> from, to;
  for (size_t i = 0; i < points.from.size(); ++i) {
    from.push_back(points.from[i] / kUnit);
    to.push_back(points.to[i] / kUnit);
  }
  const double unit_sigma2 = sigma * sigma / (kUnit * kUnit);
  const auto cost_of = [&](const Matrix3d& F) {
    double sum = 0;
    for (size_t i = 0; i < from.size(); ++i) sum += std::min(2.0, EpipolarDistance2(F, from[i], to[i]) / unit_sigma2);
    return sum;
  };
  HashRandom random(seed, {7});
  double best = std::numeric_limits<double>::infinity();
  Matrix3d best_F = Matrix3d::Zero();
  for (int n = 0; n < kSamples; ++n) {
    std::set<size_t> sample;
    while (sample.size() < 8) sample.insert(random.Below(from.size()));
    const Matrix3d F = EpipolarOf(from, to, {sample.begin(), sample.end()});
    if (const double cost = cost_of(F); cost < best) best = cost, best_F = F;
  }
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<size_t> good;
    for (size_t i = 0; i < from.size(); ++i) {
      if (EpipolarDistance2(best_F, from[i], to[i]) < 4 * unit_sigma2) good.push_back(i);
    }
    if (good.size() < 8) break;
    const Matrix3d F = EpipolarOf(from, to, good);
    const double cost = cost_of(F);
    if (!(cost < best)) break;
    best = cost;
    best_F = F;
  }
  return best;
}

/// GRIC of rotation and of an epipolar geometry for the sights that moved farthest.
struct ModelChoice {
  double rotation = 0, epipolar = 0;
  int sights = 0;
};

struct MovedSight {
  size_t anchor = 0;
  int frame = 0;
  SightPoints points;
};

ModelChoice Choose(const std::vector<MovedSight>& moved, const BackgroundTracks& tracks, const TurningCamera& camera) {
  constexpr int kSights = 20;
  constexpr double kSigma = 0.4;  // small pixels
  ModelChoice choice;
  const double focal = std::exp(camera.log_focal) / SmallPixel(tracks);
  const auto index_of = [&](int frame) {
    const auto at = std::lower_bound(camera.frames.begin(), camera.frames.end(), frame);
    return at != camera.frames.end() && *at == frame ? int(at - camera.frames.begin()) : -1;
  };
  const auto size = static_cast<int>(moved.size());
  const int stretches = std::min(kSights, size);
  for (int s = 0; s < stretches; ++s) {
    const auto begin = moved.begin() + std::ptrdiff_t(s) * size / stretches,
               end = moved.begin() + std::ptrdiff_t(s + 1) * size / stretches;
    const MovedSight& sight = *std::max_element(
        begin, end, [](const MovedSight& a, const MovedSight& b) { return a.points.median_way < b.points.median_way; });
    const int from = index_of(tracks.anchors[sight.anchor].frame), to = index_of(sight.frame);
    if (from < 0 || to < 0) continue;
    const Matrix3d turn = camera.camera_from_first[size_t(to)] * camera.camera_from_first[size_t(from)].transpose();
    const double focal_from = focal * std::exp(camera.zoom[size_t(from)]),
                 focal_to = focal * std::exp(camera.zoom[size_t(to)]);
    double turned = 0;
    for (size_t i = 0; i < sight.points.from.size(); ++i) {
      const Vector3d ray = turn * (sight.points.from[i] / focal_from).homogeneous();
      const double e2 = ray.z() > 1e-3 ? (focal_to * ray.head<2>() / ray.z() - sight.points.to[i]).squaredNorm() : 1e9;
      turned += std::min(4.0, e2 / (kSigma * kSigma));
    }
    const auto n = static_cast<double>(sight.points.from.size());
    choice.rotation += turned + 2 * n * std::log(4.0) + 3 * std::log(4 * n);
    choice.epipolar += EpipolarCost(sight.points, kSigma, static_cast<uint64_t>(sight.frame)) + 3 * n * std::log(4.0) +
                       7 * std::log(4 * n);
    ++choice.sights;
  }
  return choice;
}

/// A path found, of frames with a sight of the background.
struct PlacedFrames {
  std::vector<int> frames;
  std::vector<CameraPose> poses;
  std::vector<double> sigma_rad, sigma_place;  ///< the latter empty for a camera that turns
};

/// Longest time between two frames of the path, or from it to the clip's ends.
double LongestGap(const BackgroundTracks& tracks, const std::vector<int>& frames) {
  double last = tracks.timestamps.front(), gap = 0;
  for (const int frame : frames) {
    gap = std::max(gap, tracks.timestamps[size_t(frame)] - last);
    last = tracks.timestamps[size_t(frame)];
  }
  return std::max(gap, tracks.timestamps.back() - last);
}

/// Largest change a second between frames with a sight, of an angle or a distance of their poses.
template <typename Way>
double LargestSpeed(const BackgroundTracks& tracks, const PlacedFrames& placed, const Way& way) {
  double largest = 0;
  for (size_t i = 1; i < placed.frames.size(); ++i) {
    const double seconds =
        tracks.timestamps[size_t(placed.frames[i])] - tracks.timestamps[size_t(placed.frames[i - 1])];
    largest = std::max(largest, way(placed.poses[i - 1], placed.poses[i]) / seconds);
  }
  return largest;
}

void TakePath(const BackgroundTracks& tracks, const PlacedFrames& placed, CameraMotion* motion) {
  CameraPath& path = motion->path;
  for (const int frame : placed.frames) path.timestamps.push_back(tracks.timestamps[size_t(frame)]);
  path.poses = placed.poses;
  motion->sigma_rad = placed.sigma_rad;
  motion->sigma_place = placed.sigma_place;
  motion->of_frames = SigmasAt(tracks.timestamps, path, {placed.sigma_rad, placed.sigma_place});
  const double first_seen_s = path.timestamps.front(), last_seen_s = path.timestamps.back();
  // Frames before the first and after the last with a sight are held; σ: half of the way at the path's largest speed.
  const double turns = LargestSpeed(tracks, placed, [](const CameraPose& a, const CameraPose& b) {
    return RotationAngleBetween(a.camera_from_world_rotation, b.camera_from_world_rotation);
  });
  const double goes = LargestSpeed(
      tracks, placed, [](const CameraPose& a, const CameraPose& b) { return (CentreOf(a) - CentreOf(b)).norm(); });
  const auto hold = [&](std::vector<double>* sigmas, bool at_end, double way) {
    if (sigmas->empty()) return;
    const double sigma = std::hypot(at_end ? sigmas->back() : sigmas->front(), way);
    sigmas->insert(at_end ? sigmas->end() : sigmas->begin(), sigma);
  };
  if (path.timestamps.front() > tracks.timestamps.front()) {
    path.timestamps.insert(path.timestamps.begin(), tracks.timestamps.front());
    path.poses.insert(path.poses.begin(), CameraPose(path.poses.front()));
    const double held_s = path.timestamps[1] - path.timestamps[0];
    hold(&motion->sigma_rad, false, turns * held_s / 2);
    hold(&motion->sigma_place, false, goes * held_s / 2);
  }
  if (path.timestamps.back() < tracks.timestamps.back()) {
    const double held_s = tracks.timestamps.back() - path.timestamps.back();
    path.timestamps.push_back(tracks.timestamps.back());
    path.poses.push_back(CameraPose(path.poses.back()));
    hold(&motion->sigma_rad, true, turns * held_s / 2);
    hold(&motion->sigma_place, true, goes * held_s / 2);
  }
  const auto held = [&](double t, const std::vector<double>& of_poses, double* sigma) {
    const bool before = t < first_seen_s;
    if (of_poses.empty() || (!before && t <= last_seen_s)) return;
    const double seen_s = before ? first_seen_s : last_seen_s;
    const double end_s = before ? tracks.timestamps.front() : tracks.timestamps.back();
    const double at_seen = before ? of_poses[1] : of_poses[of_poses.size() - 2];
    const double at_end = before ? of_poses.front() : of_poses.back();
    *sigma = at_seen + (at_end - at_seen) * (t - seen_s) / (end_s - seen_s);
  };
  for (size_t t = 0; t < tracks.timestamps.size(); ++t) {
    held(tracks.timestamps[t], motion->sigma_rad, &motion->of_frames.rad[t]);
    if (!motion->sigma_place.empty()) held(tracks.timestamps[t], motion->sigma_place, &motion->of_frames.place[t]);
  }
}

double TurnedDeg(const std::vector<CameraPose>& poses) {
  double most = 0;
  for (const CameraPose& pose : poses) {
    most =
        std::max(most, RotationAngleBetween(poses.front().camera_from_world_rotation, pose.camera_from_world_rotation));
  }
  return most / kDegree;
}

PlacedFrames PlacedBy(const TurningCamera& camera) {
  PlacedFrames placed{camera.frames, {}, camera.sigma_rad, {}};
  for (const Matrix3d& rotation : camera.camera_from_first) placed.poses.push_back({rotation, Vector3d::Zero()});
  return placed;
}

double Tenths(double value) { return std::round(10 * value) / 10; }
double Percent(double share) { return std::floor(100 * share); }

/// The path of a camera that goes from place to place, if the background's structure explains what is seen; the
/// evidence, or why there is no path, is added to motion.why. Returns the share of the points that a path explains; 0:
/// there is none.
double TakeStructure(const BackgroundTracks& tracks, const CameraMotionOptions& options, CameraMotion* motion) {
  const BackgroundStructure structure = ReconstructBackground(
      tracks, {.focal = options.focal, .focal_known = options.focal_known, .num_threads = options.num_threads});
  if (!structure.solved) {
    motion->why += "; no path: " + structure.why;
    return 0;
  }
  motion->why +=
      Concatenate("; ", structure.points.size(), " points in space explain ", Percent(structure.explained), " %");
  const double off = Percentile(structure.sigma_place, 50);
  if (structure.explained < kMinInSpace || structure.points.size() < size_t(kFewestPoints)) return 0;
  if (structure.parallax < kLeastParallax) {
    motion->why += ", with too little parallax for a path";
    return 0;
  }
  if (off > kMostOff * structure.extent) {
    motion->why +=
        Concatenate(", its place within ", Percent(off / structure.extent), " % of its way, too little for a path");
    return 0;
  }
  if (const double gap = LongestGap(tracks, structure.frames); gap > kMaxGapS) {
    motion->why += Concatenate(", and are not seen for ", Tenths(gap), " s");
    return 0;
  }
  motion->turned_deg = TurnedDeg(structure.camera_from_first);
  motion->extent = structure.extent;
  motion->points = structure.points;
  motion->log_focal = structure.log_focal;
  motion->log_focal_sigma = structure.log_focal_sigma;
  TakePath(tracks, {structure.frames, structure.camera_from_first, structure.sigma_rad, structure.sigma_place}, motion);
  return structure.explained;
}

}  // namespace

std::string ToString(CameraMotionKind kind) {
  switch (kind) {
    case CameraMotionKind::kUnknown:
      return "unknown";
    case CameraMotionKind::kStill:
      return "still";
    case CameraMotionKind::kTurning:
      return "turning";
    case CameraMotionKind::kMoving:
      return "moving";
  }
  return "";
}

CameraMotion FindCameraMotion(const BackgroundTracks& tracks, const CameraMotionOptions& options) {
  Check(tracks);
  CameraMotion motion;
  std::vector<MovedSight> moved;
  int sights = 0, poor = 0, breaks = 0;
  size_t points_seen = 0;
  for (size_t k = 0; k < tracks.anchors.size(); ++k) {
    const BackgroundTracks::Anchor& anchor = tracks.anchors[k];
    breaks += k > 0 && anchor.after_break ? 1 : 0;
    poor += anchor.sights.empty() ? 1 : 0;
    sights += anchor.sights.empty() ? 1 : 0;
    for (const BackgroundTracks::Sight& sight : anchor.sights) {
      SightPoints points = PointsOf(tracks, anchor, sight);
      ++sights;
      points_seen += points.ways.size();
      if (static_cast<int>(points.ways.size()) < kFewestPoints) {
        ++poor;
        continue;
      }
      if (!HasMoved(tracks, points)) continue;
      motion.shift_px = std::max(motion.shift_px, points.median_way * SmallPixel(tracks));
      moved.push_back({k, sight.frame, std::move(points)});
    }
  }
  const int mean_points = sights == 0 ? 0 : static_cast<int>(points_seen / size_t(sights));
  if (static_cast<int>(moved.size()) < kFewestMoved) {
    const bool unknown = 2 * poor > sights || sights == 0;
    motion.kind = unknown ? CameraMotionKind::kUnknown : CameraMotionKind::kStill;
    motion.why = unknown ? Concatenate("only ", mean_points, " points of the background were seen at a time")
                         : Concatenate(mean_points, " points of the background rest, within ",
                                       Tenths(SmallPixel(tracks)), " pixels");
    return motion;
  }
  // Points that are few or lost again and again may be of somebody whom nobody detected.
  if (mean_points < kFewestPoints || (breaks > 1 && breaks > kMaxBrokenShare * double(tracks.anchors.size()))) {
    motion.why = Concatenate(mean_points, " points were seen at a time, and lost ", breaks, " times");
    return motion;
  }
  motion.kind = CameraMotionKind::kMoving;
  const std::string shift = Concatenate("the background moves by up to ", Tenths(motion.shift_px), " pixels");
  if (breaks > 0) {
    motion.why =
        Concatenate(shift, ", and is lost ", breaks, breaks == 1 ? " time" : " times", " (cuts, blur, blank walls)");
    return motion;
  }
  TurningCameraOptions turning{
      .focal = options.focal, .focal_known = options.focal_known, .num_threads = options.num_threads};
  TurningCamera camera = SolveTurningCamera(tracks, turning);
  turning.zooms = true;
  const TurningCamera zooming = SolveTurningCamera(tracks, turning);
  if (zooming.solved) {
    const auto [least, most] = std::minmax_element(zooming.zoom.begin(), zooming.zoom.end());
    const double zoom = std::exp(*most - *least);
    if (zoom > kMaxZoom && zooming.median_px < 0.7 * camera.median_px) {
      camera = zooming;
      motion.zoom = zoom;
    }
  }
  if (!camera.solved) {
    motion.why = shift + "; no rotations explain it";
    TakeStructure(tracks, options, &motion);
    return motion;
  }
  const PlacedFrames placed = PlacedBy(camera);
  const ModelChoice choice = Choose(moved, tracks, camera);
  motion.turned_deg = TurnedDeg(placed.poses);
  if (camera.explained < kMinExplained || choice.epipolar < choice.rotation) {
    motion.zoom = 1;
    motion.why = Concatenate(shift, "; rotations explain ", Percent(camera.explained), " % of the points");
    TakeStructure(tracks, options, &motion);
    return motion;
  }
  if (motion.zoom > 1) {
    // A camera that goes towards things looks like one that zooms, but for their depth.
    CameraMotion goes = motion;
    goes.zoom = 1;
    goes.why = Concatenate(shift, "; rotations and a zoom explain ", Percent(camera.explained), " % of the points");
    const double in_space = TakeStructure(tracks, options, &goes);
    if (1 - in_space < kUnexplainedShare * (1 - camera.explained)) return goes;
  }
  if (const double gap = LongestGap(tracks, placed.frames); gap > kMaxGapS) {
    motion.why = Concatenate(shift, ", and is not seen for ", Tenths(gap), " s");
    return motion;
  }
  motion.kind = CameraMotionKind::kTurning;
  motion.why = Concatenate(shift, "; rotations explain ", Percent(camera.explained), " % of the points, up to ",
                           Tenths(motion.turned_deg), "°");
  if (motion.zoom > 1) motion.why += Concatenate(", zoomed by ", std::round(100 * motion.zoom) / 100);
  TakePath(tracks, placed, &motion);
  motion.log_focal = camera.log_focal;
  motion.log_focal_sigma = camera.log_focal_sigma;
  return motion;
}

}  // namespace bodyloom
