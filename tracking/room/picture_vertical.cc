// SPDX-License-Identifier: Apache-2.0
#include "tracking/room/picture_vertical.h"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDegree = M_PI / 180;
constexpr double kInlierRad = 1 * kDegree, kTukeyRad = 1.5 * kDegree, kMaxCandidateRad = 35 * kDegree;
constexpr double kOtherRad = 3 * kDegree;  ///< farther from the vertical: a segment that may be level
constexpr size_t kMaxHypothesisSegments = 100, kMaxScoredSegments = 250;
constexpr double kMinLinesShare = 0.3, kMaxLinesSigmaRad = 8 * kDegree, kFloorRad = 1.5 * kDegree;
constexpr int kMinLines = 8, kRefinements = 15;
constexpr int kFocalSteps = 41;
constexpr double kFocalRange = 1.0986;  ///< ln 3
constexpr double kFocalFloor = 0.08, kMaxFocalSigma = 0.25, kApart = 0.25, kMaxRivalShare = 0.85, kNearBestShare = 0.9;

constexpr double kSameEdgeRad = 0.3 * kDegree;

/// A segment in the coordinates of a pinhole with f = 1 and its principal point at the origin.
struct NormalisedSegment {
  Vector2d a, b, middle, direction;
  double length = 0;
  Matrix3d camera_from_scene = Matrix3d::Identity();  ///< rotation of its picture
  int picture = 0;
  int edge = 0;  ///< of the room; several pictures may show it
};

/// The same for a focal length e^log_ratio times as long.
NormalisedSegment Rescaled(NormalisedSegment segment, double log_ratio) {
  const double scale = std::exp(-log_ratio);
  for (Vector2d* point : {&segment.a, &segment.b, &segment.middle}) *point *= scale;
  segment.length *= scale;
  return segment;
}

double FoldedAngle(double angle) { return angle - M_PI * std::round(angle / M_PI); }

/// r of a direction of the scene, and its derivative by it. A vanishing point on the segment itself says nothing: 90°.
double AngleToVanishingPoint(const NormalisedSegment& segment, const Vector3d& scene_d,
                             Vector3d* derivative = nullptr) {
  const Vector3d d = segment.camera_from_scene * scene_d;
  const Vector2d v = d.head<2>() - d.z() * segment.middle;
  const double squared = v.squaredNorm(), reach = 0.5 * segment.length * d.z();
  if (!(squared > reach * reach)) return M_PI / 2;
  if (derivative != nullptr) {
    const Vector2d by_v = Vector2d(-v.y(), v.x()) / squared;
    *derivative = segment.camera_from_scene.transpose() * Vector3d(by_v.x(), by_v.y(), -by_v.dot(segment.middle));
  }
  const Vector2d& s = segment.direction;
  return FoldedAngle(std::atan2(s.x() * v.y() - s.y() * v.x(), s.dot(v)));
}

/// 1 − (r / 1°)² for |r| < 1°, else 0; without a call of atan2.
double Agreement(const NormalisedSegment& segment, const Vector3d& scene_d) {
  const Vector3d d = segment.camera_from_scene * scene_d;
  const Vector2d v = d.head<2>() - d.z() * segment.middle;
  const double squared = v.squaredNorm(), reach = 0.5 * segment.length * d.z();
  if (!(squared > reach * reach)) return 0;
  const double cross = segment.direction.x() * v.y() - segment.direction.y() * v.x();
  return std::max(0.0, 1 - cross * cross / (squared * kInlierRad * kInlierRad));
}

double TukeyWeight(double r) {
  const double u = r / kTukeyRad;
  return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

/// In the scene.
Vector3d RayPlane(const NormalisedSegment& segment) {
  return segment.camera_from_scene.transpose() * segment.a.homogeneous().cross(segment.b.homogeneous()).normalized();
}

/// Longest first; equal ones by their ends, so that the order given does not matter.
void SortByLength(std::vector<NormalisedSegment>* segments) {
  const auto key = [](const NormalisedSegment& s) { return std::array{-s.length, s.a.x(), s.a.y(), s.b.x(), s.b.y()}; };
  std::sort(segments->begin(), segments->end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

/// Usable segments of one picture, each an edge of its own.
std::vector<NormalisedSegment> Normalised(std::span<const LineSegment> segments, const Camera& camera) {
  std::vector<NormalisedSegment> usable;
  for (const LineSegment& given : segments) {
    if (!given.a.allFinite() || !given.b.allFinite() || !(given.length() > 0)) continue;
    NormalisedSegment segment;
    segment.a = camera.Unproject(given.a);
    segment.b = camera.Unproject(given.b);
    if (!segment.a.allFinite() || !segment.b.allFinite()) continue;
    segment.length = (segment.b - segment.a).norm();
    if (!(segment.length > 0)) continue;
    segment.middle = 0.5 * (segment.a + segment.b);
    segment.direction = (segment.b - segment.a) / segment.length;
    usable.push_back(segment);
  }
  SortByLength(&usable);
  for (size_t i = 0; i < usable.size(); ++i) usable[i].edge = static_cast<int>(i);
  return usable;
}

/// The usable segments of several pictures, longest first.
std::vector<NormalisedSegment> Normalised(std::span<const TurnedPicture> pictures, const Camera& camera) {
  std::vector<NormalisedSegment> usable;
  for (size_t i = 0; i < pictures.size(); ++i) {
    for (NormalisedSegment& segment : Normalised(pictures[i].segments, camera)) {
      segment.camera_from_scene = pictures[i].camera_from_scene;
      segment.picture = static_cast<int>(i);
      usable.push_back(segment);
    }
  }
  SortByLength(&usable);
  return usable;
}

/// An edge of the room by the longest segment that shows it.
class SeenEdge {
 public:
  explicit SeenEdge(const NormalisedSegment& longest) : plane_(RayPlane(longest)), picture_(longest.picture) {
    const Matrix3d scene_from_camera = longest.camera_from_scene.transpose();
    inwards_from_a_ = plane_.cross(scene_from_camera * longest.a.homogeneous());
    inwards_from_b_ = (scene_from_camera * longest.b.homogeneous()).cross(plane_);
  }
  [[nodiscard]] bool IsShownBy(const NormalisedSegment& segment) const {
    if (segment.picture == picture_) return false;
    const Matrix3d scene_from_camera = segment.camera_from_scene.transpose();
    for (const Vector2d& end : {segment.a, segment.b}) {
      const Vector3d ray = (scene_from_camera * end.homogeneous()).normalized();
      if (!(std::abs(ray.dot(plane_)) < std::sin(kSameEdgeRad))) return false;
    }
    const Vector3d middle = scene_from_camera * segment.middle.homogeneous();
    return middle.dot(inwards_from_a_) > 0 && middle.dot(inwards_from_b_) > 0;
  }

 private:
  Vector3d plane_, inwards_from_a_, inwards_from_b_;
  int picture_;
};

/// Numbers the edges that segments, longest first, show.
void FindEdges(std::vector<NormalisedSegment>* segments) {
  std::vector<SeenEdge> edges;
  for (NormalisedSegment& segment : *segments) {
    const auto same =
        std::find_if(edges.begin(), edges.end(), [&](const SeenEdge& edge) { return edge.IsShownBy(segment); });
    segment.edge = static_cast<int>(same - edges.begin());
    if (same == edges.end()) edges.emplace_back(segment);
  }
}

/// The first segment of each edge.
std::vector<NormalisedSegment> LongestOfEdges(const std::vector<NormalisedSegment>& segments) {
  std::set<int> seen;
  std::vector<NormalisedSegment> longest;
  for (const NormalisedSegment& segment : segments) {
    if (seen.insert(segment.edge).second) longest.push_back(segment);
  }
  return longest;
}

double TotalLength(const std::vector<NormalisedSegment>& segments) {
  double total = 0;
  for (const NormalisedSegment& segment : segments) total += segment.length;
  return total;
}

/// The best direction of step 2 (zero: none), towards the side of `expected`.
Vector3d BestHypothesis(const std::vector<NormalisedSegment>& candidates, const Vector3d& expected) {
  const size_t count = std::min(candidates.size(), kMaxHypothesisSegments);
  const size_t scored = std::min(candidates.size(), kMaxScoredSegments);
  std::vector<Vector3d> planes;
  for (size_t i = 0; i < count; ++i) planes.push_back(RayPlane(candidates[i]));
  Vector3d best = Vector3d::Zero();
  double best_score = 0;
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = i + 1; j < count; ++j) {
      Vector3d d = planes[i].cross(planes[j]);
      if (!(d.norm() > 1e-6)) continue;  // two pieces of one line
      d.normalize();
      if (d.dot(expected) < 0) d = -d;
      if (d.dot(expected) < std::cos(kMaxCandidateRad)) continue;
      double score = 0;
      for (size_t k = 0; k < scored; ++k) score += candidates[k].length * Agreement(candidates[k], d);
      if (score > best_score) best_score = score, best = d;
    }
  }
  return best;
}

/// Two unit vectors across a direction, as columns.
Eigen::Matrix<double, 3, 2> AcrossDirection(const Vector3d& d) {
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = d.unitOrthogonal();
  across.col(1) = d.cross(across.col(0));
  return across;
}

/// Normal equations of Σ L ρ(r) and their sandwich covariance, whose rows are joined by edges.
class RobustSums {
 public:
  explicit RobustSums(int size) : hessian_(MatrixXd::Zero(size, size)), gradient_(VectorXd::Zero(size)) {}

  void Add(double length, double r, const VectorXd& j, int edge) {
    const double weight = length * TukeyWeight(r);
    hessian_ += weight * j * j.transpose();
    gradient_ += weight * r * j;
    of_edge_[edge].push_back(rows_.size());
    rows_.push_back({weight, r, j, edge});
  }
  [[nodiscard]] MatrixXd Inverse() const {
    const double ridge = 1e-12 * hessian_.trace() + 1e-300;
    const auto size = hessian_.rows();
    return (hessian_ + ridge * MatrixXd::Identity(size, size)).ldlt().solve(MatrixXd::Identity(size, size));
  }
  /// The step of Gauss–Newton, at most 0.1 long: one that a direction that the lines leave open would be.
  [[nodiscard]] VectorXd Step() const {
    const VectorXd step = -Inverse() * gradient_;
    return step.norm() < 0.1 ? step : VectorXd(step * (0.1 / step.norm()));
  }
  [[nodiscard]] MatrixXd Covariance() const {
    const MatrixXd inverse = Inverse();
    MatrixXd scatter = MatrixXd::Zero(hessian_.rows(), hessian_.cols());
    for (const Row& row : rows_) {
      const std::vector<size_t>& same = of_edge_.at(row.edge);
      double leverage = 0;
      for (const size_t k : same) leverage += rows_[k].weight * rows_[k].j.dot(inverse * rows_[k].j);
      const double left = 1 - std::min(kMaxLeverage, leverage);
      const double scaled = row.weight * row.r / left;
      for (const size_t k : same) {
        scatter += scaled * (rows_[k].weight * rows_[k].r / left) * row.j * rows_[k].j.transpose();
      }
    }
    return inverse * scatter * inverse;
  }

 private:
  static constexpr double kMaxLeverage = 0.95;
  struct Row {
    double weight, r;
    VectorXd j;
    int edge;
  };
  MatrixXd hessian_;
  VectorXd gradient_;
  std::vector<Row> rows_;
  std::map<int, std::vector<size_t>> of_edge_;
};

/// Step 3 and 4.
void RefineVertical(const std::vector<NormalisedSegment>& candidates, PictureVertical* lines) {
  for (int pass = 0; pass <= kRefinements; ++pass) {
    const Eigen::Matrix<double, 3, 2> across = AcrossDirection(lines->up);
    RobustSums sums(2);
    for (const NormalisedSegment& segment : candidates) {
      Vector3d derivative;
      const double r = AngleToVanishingPoint(segment, lines->up, &derivative);
      if (std::abs(r) < kTukeyRad) sums.Add(segment.length, r, across.transpose() * derivative, segment.edge);
    }
    if (pass == kRefinements) {
      lines->covariance =
          across * (sums.Covariance() + kFloorRad * kFloorRad * MatrixXd::Identity(2, 2)) * across.transpose();
      return;
    }
    lines->up = (lines->up + across * sums.Step()).normalized();
  }
}

/// A room of right angles: up for the camera's focal length, one level direction, and the focal length.
class RoomAxes {
 public:
  RoomAxes(const Vector3d& up, double log_ratio, const Vector3d& level) : up_(up), log_ratio_(log_ratio) {
    Update();
    heading_ = std::atan2(level.dot(basis_.col(1)), level.dot(basis_.col(0)));
    Update();
  }
  /// Moves it by (two steps across up, heading, log f).
  [[nodiscard]] RoomAxes Moved(const VectorXd& step) const {
    RoomAxes moved = *this;
    moved.up_ = (up_ + AcrossDirection(up_) * step.head<2>()).normalized();
    moved.heading_ += step[2];
    moved.log_ratio_ += step[3];
    moved.Update();
    return moved;
  }
  [[nodiscard]] const Vector3d& up() const { return up_; }
  [[nodiscard]] double log_ratio() const { return log_ratio_; }
  [[nodiscard]] double LevelAngle(const NormalisedSegment& segment, int axis) const {
    return AngleToVanishingPoint(Rescaled(segment, log_ratio_), level_[axis]);
  }
  /// The level axis that a segment points to better.
  [[nodiscard]] int AxisOf(const NormalisedSegment& segment) const {
    return std::abs(LevelAngle(segment, 0)) <= std::abs(LevelAngle(segment, 1)) ? 0 : 1;
  }

 private:
  void Update() {
    const Vector3d up = Vector3d(up_.x(), up_.y(), up_.z() * std::exp(log_ratio_)).normalized();
    // Continuous in `up`: the picture's x axis and its z axis are not both vertical.
    const Vector3d sideways = std::abs(up.x()) < 0.8 ? Vector3d::UnitX() : Vector3d::UnitY();
    basis_.col(0) = (sideways - sideways.dot(up) * up).normalized();
    basis_.col(1) = up.cross(basis_.col(0));
    level_[0] = basis_ * Vector2d(std::cos(heading_), std::sin(heading_));
    level_[1] = up.cross(level_[0]);
  }

  Vector3d up_;
  double log_ratio_ = 0, heading_ = 0;
  Eigen::Matrix<double, 3, 2> basis_;
  std::array<Vector3d, 2> level_;
};

/// Best score of a focal length over headings, and the level direction that has it.
double BestHeading(const std::vector<NormalisedSegment>& others, const Vector3d& up_given, double log_ratio,
                   Vector3d* level) {
  const Vector3d up = Vector3d(up_given.x(), up_given.y(), up_given.z() * std::exp(log_ratio)).normalized();
  std::vector<NormalisedSegment> scaled;
  for (size_t i = 0; i < std::min(others.size(), kMaxScoredSegments); ++i) {
    scaled.push_back(Rescaled(others[i], log_ratio));
  }
  double best = 0;
  for (size_t i = 0; i < std::min(scaled.size(), kMaxHypothesisSegments); ++i) {
    const Vector3d along = RayPlane(scaled[i]).cross(up);
    if (!(along.norm() > 1e-3)) continue;
    const Vector3d first = along.normalized(), second = up.cross(first);
    double score = 0;
    for (const NormalisedSegment& segment : scaled) {
      score += segment.length * std::max(Agreement(segment, first), Agreement(segment, second));
    }
    score *= std::exp(log_ratio);  // lengths for the given focal length
    if (score > best) best = score, *level = first;
  }
  return best;
}

/// Gauss–Newton over up, heading and log f. Returns the covariance of the four.
MatrixXd RefineRoom(const std::vector<NormalisedSegment>& candidates, const std::vector<NormalisedSegment>& others,
                    RoomAxes* room) {
  constexpr double kStep = 1e-5;
  for (int pass = 0;; ++pass) {
    RobustSums sums(4);
    const auto add = [&](const NormalisedSegment& segment, const std::function<double(const RoomAxes&)>& angle) {
      const double r = angle(*room);
      if (!(std::abs(r) < kTukeyRad)) return;
      VectorXd j(4);
      for (int k = 0; k < 4; ++k) {
        const VectorXd step = kStep * VectorXd::Unit(4, k);
        j[k] = FoldedAngle(angle(room->Moved(step)) - angle(room->Moved(-step))) / (2 * kStep);
      }
      sums.Add(segment.length, r, j, segment.edge);
    };
    for (const NormalisedSegment& segment : candidates) {
      add(segment, [&](const RoomAxes& at) { return AngleToVanishingPoint(segment, at.up()); });
    }
    for (const NormalisedSegment& segment : others) {
      const int axis = room->AxisOf(segment);
      add(segment, [&](const RoomAxes& at) { return at.LevelAngle(segment, axis); });
    }
    if (pass == kRefinements) return sums.Covariance();
    *room = room->Moved(sums.Step());
  }
}

/// The focal length from level lines.
void FindFocal(const std::vector<NormalisedSegment>& candidates, const std::vector<NormalisedSegment>& others,
               PictureVertical* lines) {
  std::array<double, kFocalSteps> score{};
  std::array<Vector3d, kFocalSteps> level;
  const auto ratio = [](int step) { return kFocalRange * (2.0 * step / (kFocalSteps - 1) - 1); };
  for (int i = 0; i < kFocalSteps; ++i) score[i] = BestHeading(others, lines->up, ratio(i), &level[i]);
  const int best = static_cast<int>(std::max_element(score.begin(), score.end()) - score.begin());
  if (!(score[best] > 0)) return;
  RoomAxes room(lines->up, ratio(best), level[best]);
  const MatrixXd covariance = RefineRoom(candidates, others, &room);
  double length = 0;
  int count = 0;
  for (const NormalisedSegment& segment : others) {
    if (!(std::abs(room.LevelAngle(segment, room.AxisOf(segment))) < kInlierRad)) continue;
    length += segment.length;
    ++count;
  }
  bool rival = std::abs(room.log_ratio()) > kFocalRange - kApart;
  double near_best = 0;
  for (int i = 0; i < kFocalSteps; ++i) {
    near_best += score[i] > kNearBestShare * score[best] ? kFocalRange / (kFocalSteps - 1) : 0;
    rival = rival || (std::abs(ratio(i) - room.log_ratio()) > kApart && score[i] > kMaxRivalShare * score[best]);
  }
  const double sigma = std::sqrt(covariance(3, 3) + kFocalFloor * kFocalFloor + near_best * near_best);
  lines->has_focal =
      count >= kMinLines && length >= kMinLinesShare * TotalLength(others) && sigma <= kMaxFocalSigma && !rival;
  if (!lines->has_focal) return;
  lines->log_focal = std::log(lines->focal_px) + room.log_ratio();
  lines->log_focal_sigma = sigma;
}

}  // namespace

Vector3d PictureVertical::Up(double focal) const {
  const Vector3d along = along_axes * up;
  return (up - along + along * focal / focal_px).normalized();
}

Vector3d PictureVertical::UpByLogFocal(double focal) const {
  const Vector3d along = along_axes * up, grown = along * focal / focal_px, at = Up(focal);
  const Vector3d by_focal = grown / (up - along + grown).norm(), direction = by_focal.normalized();
  return by_focal.norm() * (direction - direction.dot(at) * at);
}

Matrix3d PictureVertical::CovarianceAt(double focal, double log_sigma) const {
  const Matrix3d scale = Matrix3d::Identity() - along_axes + along_axes * (focal / focal_px);
  const Vector3d moved = scale * up, at = moved.normalized();
  const Matrix3d jacobian = (Matrix3d::Identity() - at * at.transpose()) * scale / moved.norm();
  const Vector3d by_focal = log_sigma * UpByLogFocal(focal);
  return jacobian * covariance * jacobian.transpose() + by_focal * by_focal.transpose();
}

double PictureVertical::Sigma() const { return std::sqrt(covariance.trace() / 2); }

std::string PictureVertical::BriefReport() const {
  if (!found) return why;
  const auto tenths = [](double rad) { return std::round(10 * rad / kDegree) / 10; };
  const double pitch = tenths(std::asin(std::clamp(up.z(), -1.0, 1.0)));
  std::string report = Concatenate(why, ": camera looks ", pitch < 0 ? "down " : "up ", std::abs(pitch), "°, rolled ",
                                   tenths(std::atan2(up.x(), -up.y())), "°, σ ", tenths(Sigma()), "°");
  if (has_focal) {
    report += Concatenate("; focal length ", std::lround(std::exp(log_focal)), " px ± ",
                          std::lround(100 * log_focal_sigma), " %");
  }
  return report;
}

namespace {

void CheckPinhole(const Camera& camera) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole && camera.fx > 0 && camera.fy > 0 && std::isfinite(camera.fx) &&
                     std::isfinite(camera.fy),
                 "vertical of a picture: focal length ", camera.fx, ", ", camera.fy,
                 ", expected a pinhole camera with positive numbers");
}

std::vector<NormalisedSegment> NearVertical(const std::vector<NormalisedSegment>& usable, const Vector3d& expected_up) {
  std::vector<NormalisedSegment> candidates;
  for (const NormalisedSegment& segment : usable) {
    if (std::abs(AngleToVanishingPoint(segment, expected_up)) <= kMaxCandidateRad) candidates.push_back(segment);
  }
  return candidates;
}

/// Without the focal length.
PictureVertical VerticalOf(const std::vector<NormalisedSegment>& candidates, double focal_px,
                           const Vector3d& expected_up) {
  PictureVertical lines;
  lines.focal_px = focal_px;
  const std::vector<NormalisedSegment> edges = LongestOfEdges(candidates);
  if (static_cast<int>(edges.size()) < kMinLines) {
    lines.why = Concatenate(edges.size(), " lines near the vertical, expected ", kMinLines, " or more");
    return lines;
  }
  const Vector3d start = BestHypothesis(edges, expected_up);
  if (start.isZero()) {
    lines.why = "no lines meet near the vertical";
    return lines;
  }
  lines.up = start;
  RefineVertical(candidates, &lines);
  double length = 0;
  std::set<int> agreeing;
  for (const NormalisedSegment& segment : candidates) {
    if (!(std::abs(AngleToVanishingPoint(segment, lines.up)) < kInlierRad)) continue;
    length += segment.length;
    agreeing.insert(segment.edge);
  }
  lines.num_segments = static_cast<int>(agreeing.size());
  lines.share = length / TotalLength(candidates);
  lines.found = lines.num_segments >= kMinLines && lines.share >= kMinLinesShare &&
                lines.Sigma() <= kMaxLinesSigmaRad && lines.up.dot(expected_up) >= std::cos(kMaxCandidateRad);
  lines.why = Concatenate(lines.num_segments, " of ", edges.size(), " lines agree, ",
                          static_cast<int>(std::lround(100 * lines.share)), " % of their length");
  return lines;
}

}  // namespace

PictureVertical FindPictureVertical(std::span<const LineSegment> segments, const Camera& camera,
                                    const Vector3d& expected_up) {
  CheckPinhole(camera);
  BODYLOOM_CHECK(std::abs(expected_up.norm() - 1) < 1e-6, "vertical of a picture: expected up has length ",
                 expected_up.norm(), ", expected 1");
  const std::vector<NormalisedSegment> usable = Normalised(segments, camera);
  const std::vector<NormalisedSegment> candidates = NearVertical(usable, expected_up);
  PictureVertical lines = VerticalOf(candidates, camera.fx, expected_up);
  if (!lines.found) return lines;
  std::vector<NormalisedSegment> others;
  for (const NormalisedSegment& segment : usable) {
    if (std::abs(AngleToVanishingPoint(segment, lines.up)) > kOtherRad) others.push_back(segment);
  }
  FindFocal(candidates, others, &lines);
  return lines;
}

PictureVertical FindSharedVertical(std::span<const TurnedPicture> pictures, const Camera& camera) {
  CheckPinhole(camera);
  Vector3d above = Vector3d::Zero();
  for (const TurnedPicture& picture : pictures) above -= picture.camera_from_scene.row(1).transpose();
  if (!(above.norm() > 0.5 * static_cast<double>(pictures.size()))) {
    PictureVertical none;
    none.why = pictures.empty() ? "no pictures" : "the pictures have no common side that is above";
    return none;
  }
  const Vector3d expected_up = above.normalized();
  std::vector<NormalisedSegment> candidates = NearVertical(Normalised(pictures, camera), expected_up);
  FindEdges(&candidates);
  PictureVertical lines = VerticalOf(candidates, camera.fx, expected_up);
  if (!lines.found) return lines;
  Matrix3d hessian = Matrix3d::Zero(), by_axes = Matrix3d::Zero();
  for (const NormalisedSegment& segment : candidates) {
    Vector3d j;
    const double r = AngleToVanishingPoint(segment, lines.up, &j);
    if (!(std::abs(r) < kTukeyRad)) continue;
    const Matrix3d information = segment.length * TukeyWeight(r) * j * j.transpose();
    const Vector3d axis = segment.camera_from_scene.row(2);
    hessian += information;
    by_axes += information * axis * axis.transpose();
  }
  const Eigen::Matrix<double, 3, 2> across = AcrossDirection(lines.up);
  const Matrix2d inverse = Matrix2d(across.transpose() * hessian * across).inverse();
  lines.along_axes = across * inverse * across.transpose() * by_axes;
  return lines;
}

JoinedVertical JoinVerticals(const Vector3d& up, double sigma_rad, const PictureVertical& lines, double focal_px,
                             double log_focal_sigma) {
  JoinedVertical joined{.up = up, .sigma_rad = sigma_rad};
  if (!lines.found) return joined;
  const Vector3d measured = lines.Up(focal_px);
  joined.angle_deg = std::acos(std::clamp(up.dot(measured), -1.0, 1.0)) / kDegree;
  if (!(joined.angle_deg <= kMaxPictureVerticalAngleDeg)) return joined;
  const Eigen::Matrix<double, 3, 2> across = AcrossDirection(up);
  const Matrix2d lines_information =
      Matrix2d(across.transpose() * lines.CovarianceAt(focal_px, log_focal_sigma) * across).inverse();
  const Matrix2d covariance = (lines_information + Matrix2d::Identity() / (sigma_rad * sigma_rad)).inverse();
  // Both are points of the plane that touches the sphere at `up`.
  const Vector2d at = across.transpose() * measured / measured.dot(up);
  joined.up = (up + across * (covariance * (lines_information * at))).normalized();
  joined.sigma_rad = std::sqrt(covariance.trace() / 2);
  joined.used = true;
  return joined;
}

FocalPrior JoinFocalPrior(const FocalPrior& prior, const PictureVertical& lines) {
  if (!lines.has_focal) return prior;
  const double before = 1 / (prior.log_sigma * prior.log_sigma),
               measured = 1 / (lines.log_focal_sigma * lines.log_focal_sigma);
  return {.log_mean = (before * prior.log_mean + measured * lines.log_focal) / (before + measured),
          .log_sigma = 1 / std::sqrt(before + measured)};
}

}  // namespace bodyloom
