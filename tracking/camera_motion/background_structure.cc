// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_motion/background_structure.h"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <ceres/sphere_manifold.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <unordered_map>

#include "geometry/base/percentile.h"
#include "geometry/base/units.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tracking/camera_motion/bundle_covariance.h"
#include "tracking/camera_motion/projected_point.h"
#include "tracking/camera_motion/turning_camera.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPointSigmaSmallPx = 0.3, kGoodSmallPx = 1.5, kKeptSmallPx = 4;
constexpr double kPointCauchy = 2;
constexpr double kKeyWaySmallPx = 12, kKeyS = 0.25;
constexpr size_t kMostKeyFrames = 400;
constexpr size_t kFewestCommon = 25, kFewestPlaced = 10;
constexpr double kCommonShare = 0.4;
constexpr size_t kStartKeys = 12, kStartsTried = 3;
constexpr int kMostStartViews = 8;
constexpr int kMostSamples = 150;          ///< of five points; half of them wrong: one in 32 is good
constexpr double kFarthestInPairs = 2000;  ///< baselines
constexpr double kLeastStartAngle = 0.5 * kDegree, kAmpleAngle = 4 * kDegree;
constexpr double kLeastAngle = 0.4 * kDegree;  ///< of a point while key frames are added
constexpr double kFarthest = 50;               ///< of a point, in median distances
constexpr int kLatestKeys = 12, kKeysBetween = 5;
constexpr double kGrowth = 1.25;
constexpr double kLeastGoodShare = 0.4;  ///< of a frame's points

/// A point seen in a frame; pixels from the picture's centre.
struct Glimpse {
  int point = 0;
  Vector2d pixel;
};

/// A frame with what is seen in it.
struct View {
  int frame = 0;
  bool is_key = false, is_anchor = false, is_placed = false;
  std::vector<Glimpse> glimpses;  ///< in rising order of points
  CameraPlace camera;
  double sigma_rad = 0, sigma_place = 0;
};

struct ScenePoint {
  int name = 0;
  bool is_placed = false;
  Vector3d at;
  std::vector<std::pair<int, int>> in_views;  ///< key view, index of the glimpse
};

/// Pixels of the points that two views share.
struct CommonPoints {
  std::vector<Vector2d> first, second;
  [[nodiscard]] size_t size() const { return first.size(); }
};
CommonPoints CommonOf(const View& a, const View& b) {
  CommonPoints common;
  for (size_t i = 0, j = 0; i < a.glimpses.size() && j < b.glimpses.size();) {
    const int first = a.glimpses[i].point, second = b.glimpses[j].point;
    if (first == second) {
      common.first.push_back(a.glimpses[i].pixel);
      common.second.push_back(b.glimpses[j].pixel);
    }
    i += first <= second ? 1 : 0;
    j += second <= first ? 1 : 0;
  }
  return common;
}

double MedianWay(const CommonPoints& common) {
  std::vector<double> ways;
  for (size_t i = 0; i < common.size(); ++i) ways.push_back((common.second[i] - common.first[i]).norm());
  return ways.empty() ? std::numeric_limits<double>::infinity() : Percentile(ways, 50);
}

/// A start: two views and the second's place from the first's, whose distance is 1.
struct StartPair {
  int first = 0, second = 0;
  CameraPlace camera;
  double score = 0;
};

/// PlaceOfPair() by an essential matrix of this method of OpenCV.
std::optional<StartPair> PlaceByEssential(const CommonPoints& common, double focal, double small_px, int method) {
  std::vector<cv::Point2d> first, second;
  for (size_t i = 0; i < common.first.size(); ++i) {
    first.emplace_back(common.first[i].x(), common.first[i].y());
    second.emplace_back(common.second[i].x(), common.second[i].y());
  }
  const cv::Matx33d pinhole(focal, 0, 0, 0, focal, 0, 0, 0, 1);
  cv::Mat good;
  const cv::Mat essential = cv::findEssentialMat(first, second, pinhole, method, 0.99, small_px, kMostSamples, good);
  if (essential.rows != 3 || essential.cols != 3) return std::nullopt;
  const Matrix3d E = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(essential.ptr<double>());
  const double good2 = std::pow(small_px / focal, 2);
  for (size_t i = 0; i < common.size(); ++i) {
    const bool agrees = EpipolarDistance2(E, common.first[i] / focal, common.second[i] / focal) < good2;
    good.at<uint8_t>(static_cast<int>(i)) = agrees ? 1 : 0;
  }
  cv::Mat rotation, translation;
  const int in_front =
      cv::recoverPose(essential, first, second, pinhole, rotation, translation, kFarthestInPairs, good);
  const auto count = static_cast<double>(first.size());
  if (in_front < 12 || in_front < 0.5 * count) return std::nullopt;
  Matrix3d R;
  Vector3d t;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) R(r, c) = rotation.at<double>(r, c);
    t[r] = translation.at<double>(r, 0);
  }
  std::vector<double> angles;
  for (size_t i = 0; i < first.size(); ++i) {
    if (good.at<uint8_t>(static_cast<int>(i)) == 0) continue;
    const Vector3d a = (common.first[i] / focal).homogeneous(),
                   b = R.transpose() * (common.second[i] / focal).homogeneous();
    angles.push_back(std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  const double angle = Percentile(angles, 50);
  if (angle < kLeastStartAngle) return std::nullopt;
  StartPair pair;
  pair.camera = {AxisAngleFromRotation(NearestRotation(R)), -R.transpose() * t};
  pair.score = in_front / count * std::min(1.0, angle / kAmpleAngle);
  return pair;
}

/// The second camera's place of a pair of views; the score is the share of the points that the essential matrix
/// explains, times the share of an ample angle that the rays make. The matrix is that of least median error: points
/// are followed to a tenth of a small pixel, and within a whole one of all of them there are matrices whose scene is
/// inside out, near things far away and the path turned round. Of points on a plane the median may be that of another
/// matrix, without a place; then it is one that has most points within a small pixel.
std::optional<StartPair> PlaceOfPair(const CommonPoints& common, double focal, double small_px) {
  const std::optional<StartPair> pair = PlaceByEssential(common, focal, small_px, cv::LMEDS);
  return pair ? pair : PlaceByEssential(common, focal, small_px, cv::RANSAC);
}

/// The state of a reconstruction, copied to try starts.
struct Reconstruction {
  std::vector<View> views;
  std::vector<ScenePoint> points;
  double log_focal = 0, log_focal_sigma = 0;
  [[nodiscard]] double focal() const { return std::exp(log_focal); }
};

class StructureSolve {
 public:
  StructureSolve(const BackgroundTracks& tracks, const BackgroundStructureOptions& options)
      : tracks_(tracks), options_(options), small_px_(SmallPixel(tracks)) {}

  BackgroundStructure Run() {
    BackgroundStructure result;
    TakeViews();
    ChooseKeys();
    if (!FindStart(&result.why)) return result;
    AddKeys();
    for (int pass = 0; pass < 2; ++pass) {
      PlacePoints(&now_, 0);
      if (!Adjust(&now_, AllPlacedKeys(), 25)) {
        result.why = "the key frames do not agree";
        return result;
      }
    }
    ToUnits();
    if (!AdjustWithDeviations()) {
      result.why = "the key frames do not agree";
      return result;
    }
    PlaceOtherViews();
    Fill(&result);
    return result;
  }

 private:
  [[nodiscard]] double sigma_px() const { return kPointSigmaSmallPx * small_px_; }

  void TakeViews() {
    const Vector2d centre(0.5 * (tracks_.width - 1), 0.5 * (tracks_.height - 1));
    std::map<int, std::map<int, Vector2d>> by_frame;
    std::unordered_map<int, int> index_of;
    std::vector<int> anchors;
    const auto take = [&](int frame, int name, const Eigen::Vector2f& pixel) {
      const auto [index, is_new] = index_of.emplace(name, static_cast<int>(now_.points.size()));
      if (is_new) now_.points.emplace_back().name = name;
      // A point that an earlier anchor sees in this frame has its place from there, which has drifted less.
      by_frame[frame].emplace(index->second, pixel.cast<double>() - centre);
    };
    for (size_t k = 0; k < tracks_.anchors.size() && (k == 0 || !tracks_.anchors[k].after_break); ++k) {
      const BackgroundTracks::Anchor& anchor = tracks_.anchors[k];
      anchors.push_back(anchor.frame);
      for (size_t i = 0; i < anchor.pixels.size(); ++i) take(anchor.frame, anchor.points[i], anchor.pixels[i]);
      for (const BackgroundTracks::Sight& sight : anchor.sights) {
        for (size_t i = 0; i < sight.pixels.size(); ++i) {
          if (sight.pixels[i].allFinite()) take(sight.frame, anchor.points[i], sight.pixels[i]);
        }
      }
    }
    for (const auto& [frame, glimpses] : by_frame) {
      View& view = now_.views.emplace_back();
      view.frame = frame;
      view.is_anchor = std::binary_search(anchors.begin(), anchors.end(), frame);
      for (const auto& [point, pixel] : glimpses) view.glimpses.push_back({point, pixel});
    }
  }

  void ChooseKeys() {
    std::vector<size_t> keys;
    for (size_t v = 0; v < now_.views.size(); ++v) {
      const View& view = now_.views[v];
      const bool is_end = v + 1 == now_.views.size();
      if (!keys.empty() && !view.is_anchor && !is_end) {
        const View& last = now_.views[keys.back()];
        const double seconds = tracks_.timestamps[size_t(view.frame)] - tracks_.timestamps[size_t(last.frame)];
        if (seconds < kKeyS && MedianWay(CommonOf(last, view)) < kKeyWaySmallPx * small_px_) continue;
      }
      keys.push_back(v);
    }
    const size_t step = 1 + keys.size() / (kMostKeyFrames + 1);
    for (size_t i = 0; i < keys.size(); ++i) {
      if (i % step == 0 || i + 1 == keys.size()) keys_.push_back(keys[i]);
    }
    for (const size_t key : keys_) {
      View& view = now_.views[key];
      view.is_key = true;
      for (size_t i = 0; i < view.glimpses.size(); ++i) {
        now_.points[size_t(view.glimpses[i].point)].in_views.emplace_back(static_cast<int>(key), static_cast<int>(i));
      }
    }
  }

  [[nodiscard]] std::vector<size_t> AllPlacedKeys() const {
    std::vector<size_t> placed;
    for (const size_t key : keys_) {
      if (now_.views[key].is_placed) placed.push_back(key);
    }
    return placed;
  }

  // ---- Start ----

  /// The best pairs of keys, by points in common and parallax.
  [[nodiscard]] std::vector<StartPair> StartPairs(double focal) const {
    std::vector<StartPair> pairs;
    const size_t firsts = std::min(kStartKeys, keys_.size());
    for (size_t n = 0; n < firsts; ++n) {
      const size_t first = n * keys_.size() / firsts;
      const View& a = now_.views[keys_[first]];
      // Farther and farther keys, as long as they share points.
      for (size_t step = 1; first + step < keys_.size(); step += 1 + step / 2) {
        const size_t second = first + step;
        const CommonPoints common = CommonOf(a, now_.views[keys_[second]]);
        if (common.size() < kFewestCommon || double(common.size()) < kCommonShare * double(a.glimpses.size())) {
          break;
        }
        std::optional<StartPair> pair = PlaceOfPair(common, focal, small_px_);
        if (!pair) continue;
        pair->first = static_cast<int>(first);
        pair->second = static_cast<int>(second);
        pairs.push_back(*pair);
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const StartPair& a, const StartPair& b) { return a.score > b.score; });
    if (pairs.size() > kStartsTried) pairs.resize(kStartsTried);
    return pairs;
  }

  /// The best pairs at the prior's focal length, placed at this one.
  [[nodiscard]] std::vector<StartPair> PlacedAt(double focal, const std::vector<StartPair>& pairs) const {
    std::vector<StartPair> placed;
    for (const StartPair& pair : pairs) {
      const CommonPoints common =
          CommonOf(now_.views[keys_[size_t(pair.first)]], now_.views[keys_[size_t(pair.second)]]);
      std::optional<StartPair> again = PlaceOfPair(common, focal, small_px_);
      if (!again) continue;
      again->first = pair.first;
      again->second = pair.second;
      placed.push_back(*again);
    }
    return placed;
  }

  /// Takes the start of least cost.
  bool FindStart(std::string* why) {
    std::vector<double> focals = {options_.focal.log_mean};
    if (!options_.focal_known) {
      for (const double off : {-2.0, -1.0, 1.0, 2.0}) focals.push_back(focals[0] + off * options_.focal.log_sigma);
    }
    const std::vector<StartPair> at_mean = StartPairs(std::exp(focals[0]));
    double least = std::numeric_limits<double>::infinity();
    Reconstruction best;
    for (const double log_focal : focals) {
      for (const StartPair& pair : log_focal == focals[0] ? at_mean : PlacedAt(std::exp(log_focal), at_mean)) {
        Reconstruction tried = now_;
        tried.log_focal = log_focal;
        const double cost = TryStart(pair, &tried);
        if (cost < least) least = cost, best = std::move(tried);
      }
    }
    if (!std::isfinite(least)) {
      *why = "no two frames have enough parallax";
      return false;
    }
    now_ = std::move(best);
    return true;
  }

  /// Mean of min(r², 9) over what the pair's key frames and some between see, after their adjustment; infinite if that
  /// fails. A point that has no place counts as 9.
  double TryStart(const StartPair& pair, Reconstruction* tried) const {
    constexpr double kFailed = std::numeric_limits<double>::infinity();
    View &first = tried->views[keys_[size_t(pair.first)]], &second = tried->views[keys_[size_t(pair.second)]];
    first.camera = {};
    second.camera = pair.camera;
    first.is_placed = second.is_placed = true;
    PlacePoints(tried, kLeastAngle);
    std::vector<size_t> used = {keys_[size_t(pair.first)], keys_[size_t(pair.second)]};
    const int between = std::min(pair.second - pair.first - 1, kMostStartViews - 2);
    for (int n = 1; n <= between; ++n) {
      const size_t key = keys_[size_t(pair.first + n * (pair.second - pair.first) / (between + 1))];
      if (PlaceView(tried, key)) used.push_back(key);
    }
    if (!Adjust(tried, used, 20)) return kFailed;
    PlacePoints(tried, kLeastAngle);
    if (!Adjust(tried, used, 20)) return kFailed;
    double sum = 0;
    size_t count = 0;
    for (const size_t key : used) {
      const View& view = tried->views[key];
      for (const Glimpse& glimpse : view.glimpses) {
        const ScenePoint& point = tried->points[size_t(glimpse.point)];
        const auto in_used = std::count_if(point.in_views.begin(), point.in_views.end(),
                                           [&](const auto& in) { return tried->views[size_t(in.first)].is_placed; });
        if (in_used < 2) continue;
        ++count;
        const double r = point.is_placed
                             ? ProjectionDistance(view.camera, tried->focal(), {point.at, glimpse.pixel}) / sigma_px()
                             : 3;
        sum += std::min(9.0, r * r);
      }
    }
    return count < kFewestCommon ? kFailed : sum / static_cast<double>(count);
  }

  // ---- Growth ----

  [[nodiscard]] std::vector<PointInPicture> PlacedIn(const Reconstruction& state, const View& view) const {
    std::vector<PointInPicture> seen;
    for (const Glimpse& glimpse : view.glimpses) {
      const ScenePoint& point = state.points[size_t(glimpse.point)];
      if (point.is_placed) seen.push_back({point.at, glimpse.pixel});
    }
    return seen;
  }

  /// Places a view by its points, from the place of the nearest view that is placed.
  bool PlaceView(Reconstruction* state, size_t index) const {
    View& view = state->views[index];
    const std::vector<PointInPicture> seen = PlacedIn(*state, view);
    if (seen.size() < kFewestPlaced) return false;
    const View* nearest = nullptr;
    const size_t count = state->views.size();
    for (size_t step = 1; nearest == nullptr && step < count; ++step) {
      if (index >= step && state->views[index - step].is_placed) nearest = &state->views[index - step];
      if (index + step < count && state->views[index + step].is_placed) nearest = &state->views[index + step];
    }
    if (nearest == nullptr) return false;
    const std::optional<FittedPlace> fit = FitCameraPlace(seen, state->focal(), sigma_px(), nearest->camera);
    if (!fit || double(fit->num_good) < kLeastGoodShare * double(seen.size())) return false;
    view.camera = fit->place;
    view.is_placed = true;
    view.sigma_rad = std::sqrt(fit->covariance.topLeftCorner<3, 3>().trace() / 3);
    view.sigma_place = std::sqrt(fit->covariance.bottomRightCorner<3, 3>().trace() / 3);
    return true;
  }

  /// Places points that two placed keys or more see under this angle: of one view, or all.
  void PlacePoints(Reconstruction* state, double least_angle, const View* view = nullptr) const {
    const double farthest = FarthestOf(*state);
    const size_t count = view == nullptr ? state->points.size() : view->glimpses.size();
    for (size_t i = 0; i < count; ++i) {
      ScenePoint& point = state->points[view == nullptr ? i : size_t(view->glimpses[i].point)];
      if (point.is_placed) continue;
      std::vector<PixelOfCamera> seen;
      for (const auto& [key, glimpse] : point.in_views) {
        const View& in = state->views[size_t(key)];
        if (in.is_placed) seen.push_back({in.camera, in.glimpses[size_t(glimpse)].pixel});
      }
      const std::optional<FittedPoint> fit =
          FitPoint(seen, state->focal(), sigma_px(), kGoodSmallPx * small_px_, farthest);
      if (!fit || fit->angle < least_angle) continue;
      point.at = fit->point;
      point.is_placed = true;
    }
  }

  /// kFarthest median distances of the points from the cameras that see them.
  [[nodiscard]] static double FarthestOf(const Reconstruction& state) {
    const double median = MedianDistance(state);
    return median > 0 ? kFarthest * median : 1e4;
  }
  [[nodiscard]] static double MedianDistance(const Reconstruction& state) {
    std::vector<double> distances;
    for (const View& view : state.views) {
      if (!view.is_placed || !view.is_key) continue;
      for (const Glimpse& glimpse : view.glimpses) {
        const ScenePoint& point = state.points[size_t(glimpse.point)];
        if (point.is_placed) distances.push_back((point.at - view.camera.centre).norm());
      }
    }
    return distances.empty() ? 0 : Percentile(distances, 50);
  }

  void AddKeys() {
    std::vector<char> is_refused(now_.views.size(), 0);
    std::vector<size_t> latest;
    size_t placed = AllPlacedKeys().size();
    auto adjusted_at = static_cast<double>(placed);
    while (true) {
      size_t best = now_.views.size(), most = 0;
      for (const size_t key : keys_) {
        if (now_.views[key].is_placed || is_refused[key] != 0) continue;
        const size_t seen = PlacedIn(now_, now_.views[key]).size();
        if (seen > most) most = seen, best = key;
      }
      if (best == now_.views.size()) break;
      if (!PlaceView(&now_, best)) {
        PlacePoints(&now_, 0);
        if (!PlaceView(&now_, best)) {
          is_refused[best] = 1;
          continue;
        }
      }
      latest.push_back(best);
      ++placed;
      PlacePoints(&now_, kLeastAngle, &now_.views[best]);
      if (double(placed) >= kGrowth * adjusted_at) {
        Adjust(&now_, AllPlacedKeys(), 10);
        adjusted_at = static_cast<double>(placed);
      } else if (latest.size() % kKeysBetween == 0) {
        const size_t from = latest.size() > kLatestKeys ? latest.size() - kLatestKeys : 0;
        Adjust(&now_, {latest.begin() + std::ptrdiff_t(from), latest.end()}, 10);
      }
      if (placed % kKeysBetween == 0) std::fill(is_refused.begin(), is_refused.end(), 0);
    }
  }

  // ---- Adjustment ----

  /// A Ceres problem of some views and the points they see; other placed keys are held.
  struct Bundle {
    ceres::Problem problem{[] {
      ceres::Problem::Options options;
      options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
      return options;
    }()};
    std::vector<double*> points;
    std::vector<size_t> views;  ///< with a residual, free
    size_t residuals = 0;
    bool has_held = false;
  };

  void Build(Reconstruction* state, const std::vector<size_t>& free, double gate_px, Bundle* bundle) const {
    std::vector<char> is_free(state->views.size(), 0), is_in(state->points.size(), 0);
    for (const size_t v : free) {
      is_free[v] = 1;
      for (const Glimpse& glimpse : state->views[v].glimpses) is_in[size_t(glimpse.point)] = 1;
    }
    for (size_t p = 0; p < state->points.size(); ++p) {
      ScenePoint& point = state->points[p];
      if (!point.is_placed || is_in[p] == 0) continue;
      // Pixels far off are of what moves by itself, or of another point; one alone does not tell a place.
      std::vector<std::pair<int, const Vector2d*>> seen;
      for (const auto& [key, glimpse] : point.in_views) {
        const View& view = state->views[size_t(key)];
        const Vector2d& pixel = view.glimpses[size_t(glimpse)].pixel;
        if (view.is_placed && ProjectionDistance(view.camera, state->focal(), {point.at, pixel}) < gate_px) {
          seen.emplace_back(key, &pixel);
        }
      }
      if (seen.size() < 2) continue;
      bundle->residuals += seen.size();
      bundle->points.push_back(point.at.data());
      for (const auto& [key, pixel] : seen) {
        CameraPlace& camera = state->views[size_t(key)].camera;
        bundle->problem.AddResidualBlock(new ProjectedPointCost(*pixel, sigma_px()), &loss_, camera.w.data(),
                                         camera.centre.data(), point.at.data(), &state->log_focal);
        if (is_free[size_t(key)] != 0) continue;
        bundle->has_held = true;
        bundle->problem.SetParameterBlockConstant(camera.w.data());
        bundle->problem.SetParameterBlockConstant(camera.centre.data());
      }
    }
    for (const size_t v : free) {
      if (bundle->problem.HasParameterBlock(state->views[v].camera.w.data())) bundle->views.push_back(v);
    }
    if (bundle->residuals == 0) return;
    if (options_.focal_known || bundle->has_held) {
      bundle->problem.SetParameterBlockConstant(&state->log_focal);
    } else {
      bundle->problem.AddResidualBlock(new FocalPriorCost(options_.focal), nullptr, &state->log_focal);
    }
    if (!bundle->has_held) HoldScene(state, bundle);
  }

  /// Holds the camera at the origin, and the distance of the farthest one from it.
  static void HoldScene(Reconstruction* state, Bundle* bundle) {
    CameraPlace* farthest = nullptr;
    for (const size_t v : bundle->views) {
      CameraPlace& camera = state->views[v].camera;
      if (camera.centre.isZero(0)) {
        bundle->problem.SetParameterBlockConstant(camera.w.data());
        bundle->problem.SetParameterBlockConstant(camera.centre.data());
      } else if (farthest == nullptr || camera.centre.norm() > farthest->centre.norm()) {
        farthest = &camera;
      }
    }
    if (farthest != nullptr) {
      bundle->problem.SetManifold(farthest->centre.data(), new ceres::SphereManifold<3>);
    }
  }

  [[nodiscard]] bool Solve(Bundle* bundle, int iterations) const {
    ceres::Solver::Options solver;
    // Larger systems of cameras are mostly zeros: keys far apart share no points.
    constexpr size_t kDenseViews = 60;
    solver.linear_solver_type = bundle->views.size() > kDenseViews ? ceres::SPARSE_SCHUR : ceres::DENSE_SCHUR;
    solver.max_num_iterations = iterations;
    solver.num_threads = options_.num_threads;
    solver.logging_type = ceres::SILENT;
    std::vector<double*> blocks;
    bundle->problem.GetParameterBlocks(&blocks);
    solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (double* block : blocks) solver.linear_solver_ordering->AddElementToGroup(block, 1);
    for (double* point : bundle->points) solver.linear_solver_ordering->AddElementToGroup(point, 0);
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &bundle->problem, &summary);
    return summary.IsSolutionUsable();
  }

  /// Adjusts views, the points they see, and, where no other view is held, f; then drops points that do not agree.
  bool Adjust(Reconstruction* state, const std::vector<size_t>& free, int iterations) const {
    Bundle bundle;
    Build(state, free, 3 * kKeptSmallPx * small_px_, &bundle);
    if (bundle.views.empty() || bundle.residuals < kFewestCommon) return false;
    if (!Solve(&bundle, iterations) || !std::isfinite(state->log_focal)) return false;
    DropPoints(state);
    return true;
  }

  /// Points of which fewer than two pixels, or than two thirds, agree have no place.
  void DropPoints(Reconstruction* state) const {
    for (ScenePoint& point : state->points) {
      if (!point.is_placed) continue;
      int seen = 0, good = 0;
      for (const auto& [key, glimpse] : point.in_views) {
        const View& view = state->views[size_t(key)];
        if (!view.is_placed) continue;
        ++seen;
        const Vector2d& pixel = view.glimpses[size_t(glimpse)].pixel;
        good += ProjectionDistance(view.camera, state->focal(), {point.at, pixel}) < kKeptSmallPx * small_px_ ? 1 : 0;
      }
      point.is_placed = good >= 2 && 3 * good >= 2 * seen && point.at.allFinite();
    }
  }

  /// Moves the scene to the first key that is placed, and scales it.
  void ToUnits() {
    const double unit = MedianDistance(now_);
    const CameraPlace first = now_.views[AllPlacedKeys().front()].camera;
    const Matrix3d R = RotationFromAxisAngle(first.w);
    const auto moved = [&](const Vector3d& at) -> Vector3d { return R * (at - first.centre) / unit; };
    for (View& view : now_.views) {
      view.sigma_place /= unit;
      if (!view.is_placed) continue;
      const bool is_first = view.camera.centre == first.centre;
      view.camera.w =
          is_first ? Vector3d::Zero() : AxisAngleFromRotation(RotationFromAxisAngle(view.camera.w) * R.transpose());
      view.camera.centre = moved(view.camera.centre);
    }
    for (ScenePoint& point : now_.points) {
      if (point.is_placed) point.at = moved(point.at);
    }
  }

  /// The last adjustment, of pixels that agree, with deviations of all key frames.
  bool AdjustWithDeviations() {
    Bundle bundle;
    const std::vector<size_t> keys = AllPlacedKeys();
    Build(&now_, keys, kKeptSmallPx * small_px_, &bundle);
    if (bundle.residuals < kFewestCommon) return false;
    if (!Solve(&bundle, 50) || !std::isfinite(now_.log_focal)) return false;
    std::vector<double*> blocks;
    std::vector<size_t> views;
    for (const size_t v : bundle.views) {
      CameraPlace& camera = now_.views[v].camera;
      if (bundle.problem.IsParameterBlockConstant(camera.w.data())) continue;
      blocks.push_back(camera.w.data());
      blocks.push_back(camera.centre.data());
      views.push_back(v);
    }
    if (!options_.focal_known) blocks.push_back(&now_.log_focal);
    const std::vector<MatrixXd> covariances =
        BundleCovariances(&bundle.problem, {blocks, bundle.points}, options_.num_threads);
    if (covariances.size() != blocks.size()) return false;
    View& first = now_.views[keys.front()];
    first.sigma_rad = first.sigma_place = 0;  // it is held
    for (size_t i = 0; i < views.size(); ++i) {
      View& view = now_.views[views[i]];
      const Matrix3d by_w = RightJacobian(view.camera.w);
      view.sigma_rad = std::sqrt((by_w * covariances[2 * i] * by_w.transpose()).trace() / 3);
      view.sigma_place = std::sqrt(covariances[2 * i + 1].trace() / 3);
    }
    now_.log_focal_sigma = options_.focal_known ? 0 : std::sqrt(covariances.back()(0, 0));
    DropPoints(&now_);
    return true;
  }

  // ---- All frames ----

  void PlaceOtherViews() {
    std::vector<char> is_key_placed(now_.views.size(), 0);
    for (const size_t key : AllPlacedKeys()) is_key_placed[key] = 1;
    size_t key = AllPlacedKeys().front();
    for (size_t v = 0; v < now_.views.size(); ++v) {
      if (is_key_placed[v] != 0) key = v;
      if (now_.views[v].is_placed || !PlaceView(&now_, v)) continue;
      now_.views[v].sigma_rad = std::hypot(now_.views[v].sigma_rad, now_.views[key].sigma_rad);
      now_.views[v].sigma_place = std::hypot(now_.views[v].sigma_place, now_.views[key].sigma_place);
    }
  }

  void Fill(BackgroundStructure* result) const {
    result->solved = true;
    result->log_focal = now_.log_focal;
    result->log_focal_sigma = now_.log_focal_sigma;
    result->key_frames = static_cast<int>(AllPlacedKeys().size());
    std::optional<CameraPose> first_from_scene;
    std::vector<double> distances;
    size_t good = 0, all = 0;
    for (const View& view : now_.views) {
      for (const Glimpse& glimpse : view.glimpses) {
        const ScenePoint& point = now_.points[size_t(glimpse.point)];
        if (point.in_views.size() < 3) continue;
        ++all;
        if (!view.is_placed || !point.is_placed) continue;
        distances.push_back(ProjectionDistance(view.camera, now_.focal(), {point.at, glimpse.pixel}));
        good += distances.back() < kGoodSmallPx * small_px_ ? 1 : 0;
      }
      if (!view.is_placed) continue;
      const Matrix3d R = RotationFromAxisAngle(view.camera.w);
      const CameraPose pose{R, -R * view.camera.centre};
      if (!first_from_scene) first_from_scene = pose;
      result->frames.push_back(view.frame);
      result->camera_from_first.push_back(Compose(pose, Inverse(*first_from_scene)));
      result->sigma_rad.push_back(view.sigma_rad);
      result->sigma_place.push_back(view.sigma_place);
      result->extent = std::max(result->extent, CentreOf(result->camera_from_first.back()).norm());
    }
    std::vector<double> angles;
    for (const ScenePoint& point : now_.points) {
      if (!point.is_placed) continue;
      result->names.push_back(point.name);
      result->points.push_back(MovedPoint(*first_from_scene, point.at));
      double angle = 0;
      const Vector3d* first_centre = nullptr;
      for (const auto& [key, glimpse] : point.in_views) {
        const View& view = now_.views[size_t(key)];
        if (!view.is_placed) continue;
        if (first_centre == nullptr) first_centre = &view.camera.centre;
        const Vector3d a = point.at - *first_centre, b = point.at - view.camera.centre;
        angle = std::max(angle, std::atan2(a.cross(b).norm(), a.dot(b)));
      }
      angles.push_back(angle);
    }
    result->median_px = distances.empty() ? 0 : Percentile(distances, 50);
    result->explained = all == 0 ? 0 : static_cast<double>(good) / static_cast<double>(all);
    result->parallax = angles.empty() ? 0 : Percentile(angles, 50);
  }

  const BackgroundTracks& tracks_;
  BackgroundStructureOptions options_;
  double small_px_;
  std::vector<size_t> keys_;  ///< views that are key frames
  Reconstruction now_;
  mutable ceres::CauchyLoss loss_{kPointCauchy};
};

}  // namespace

BackgroundStructure ReconstructBackground(const BackgroundTracks& tracks, const BackgroundStructureOptions& options) {
  return StructureSolve(tracks, options).Run();
}

}  // namespace bodyloom
