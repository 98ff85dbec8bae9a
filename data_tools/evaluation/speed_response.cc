// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/speed_response.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "data_tools/evaluation/image_metrics.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/uv_maps/velocity_stencil.h"

namespace bodyloom {
namespace {

constexpr int kFewestPixels = 20;
constexpr double kSamePose = 1e-3;     ///< radians
constexpr double kSamePlace_m = 0.01;  ///< sets centre each motion on its mean position, which depends on its frames
constexpr int kFramesAfterGap = 10;

/// Value below which `share` of all counted columns (or rows) lie, in pixels.
double Quantile(const std::vector<int>& counts, int total, double share) {
  double sum = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0 && sum + counts[i] >= share * total) {
      return static_cast<double>(i) + (share * total - sum) / counts[i];
    }
    sum += counts[i];
  }
  return static_cast<double>(counts.size());
}

PixelMask MaskOfLabel(const Image& labels, PersonLabel label) {
  PixelMask mask{labels.width, labels.height, std::vector<uint8_t>(labels.bgr.size() / 3)};
  for (size_t i = 0; i < mask.inside.size(); ++i) mask.inside[i] = labels.bgr[3 * i] == static_cast<uint8_t>(label);
  return mask;
}

bool SamePose(const Track& a, int t, const Track& b, int u) {
  return (a.motion.poses.row(t) - b.motion.poses.row(u)).cwiseAbs().maxCoeff() < kSamePose &&
         (a.motion.trans.row(t) - b.motion.trans.row(u)).cwiseAbs().maxCoeff() < kSamePlace_m;
}

/// Number of frames of its gap-free run before each frame; −1: it has no result.
std::vector<int> FramesSinceGap(const Track& track) {
  std::vector<char> usable(track.num_frames());
  for (int t = 0; t < track.num_frames(); ++t) usable[t] = track.HasResult(t);
  const std::vector<VelocityStencil> runs = VelocityStencils(track.motion.timestamps, usable);
  std::vector<int> since(track.num_frames(), -1);
  for (int t = 0; t < track.num_frames(); ++t) {
    if (runs[t].segment < 0) continue;
    since[t] = t > 0 && runs[t].segment == runs[t - 1].segment ? since[t - 1] + 1 : 0;
  }
  return since;
}

void RequireMatch(const SinglePersonDataset& truth, const SinglePersonDataset& result) {
  const SinglePersonDatasetInfo &a = truth.info(), &b = result.info();
  if (!a.has.labels || !b.has.labels) {
    throw std::runtime_error((a.has.labels ? result : truth).path() + ": has no labels, which reactions are read from");
  }
  if (a.num_frames != b.num_frames || a.width != b.width || a.height != b.height) {
    throw std::runtime_error(Concatenate(result.path(), ": ", b.num_frames, " frames of ", b.width, "x", b.height,
                                         ", expected ", a.num_frames, " of ", a.width, "x", a.height, " as ",
                                         truth.path()));
  }
}

}  // namespace

LabelExtent MeasureLabelExtent(const Image& labels, PersonLabel label, const Track& track, int t) {
  const Eigen::Vector3d pelvis = track.joints[t].row(0).transpose();
  Eigen::Vector2d centre, beside;
  const Camera camera = track.CameraAt(t);
  constexpr double kStep_m = 0.1;
  BODYLOOM_CHECK(
      camera.Project(pelvis, &centre) && camera.Project(pelvis + kStep_m * Eigen::Vector3d::UnitX(), &beside), "frame ",
      t, ": the pelvis is not in front of the camera");
  const double pixels_per_metre = (beside - centre).norm() / kStep_m;
  std::vector<int> columns(labels.width, 0), rows(labels.height, 0);
  int count = 0;
  for (int y = 0; y < labels.height; ++y) {
    for (int x = 0; x < labels.width; ++x) {
      if (labels.pixel(x, y)[0] != static_cast<uint8_t>(label)) continue;
      ++columns[x], ++rows[y], ++count;
    }
  }
  LabelExtent extent;
  extent.values.fill(std::numeric_limits<double>::quiet_NaN());
  if (count < kFewestPixels) return extent;
  extent.values = {(Quantile(columns, count, 0.03) - centre.x()) / pixels_per_metre,
                   (Quantile(columns, count, 0.97) - centre.x()) / pixels_per_metre,
                   (Quantile(rows, count, 0.97) - centre.y()) / pixels_per_metre,
                   count / (pixels_per_metre * pixels_per_metre)};
  return extent;
}

std::vector<std::pair<int, int>> PairFramesByPose(const Track& a, const Track& b, int frames_after_gap) {
  BODYLOOM_CHECK(frames_after_gap >= 0, "frames_after_gap is ", frames_after_gap);
  BODYLOOM_CHECK(a.motion.poses.cols() == b.motion.poses.cols(), "tracks of ", a.motion.poses.cols() / 3, " and ",
                 b.motion.poses.cols() / 3, " joints");
  const std::vector<int> since_a = FramesSinceGap(a), since_b = FramesSinceGap(b);
  std::multimap<double, int> frame_at;  // by one coordinate, in which few frames are equal
  for (int u = 0; u < b.num_frames(); ++u) {
    if (since_b[u] >= frames_after_gap) frame_at.emplace(b.motion.trans(u, 0), u);
  }
  std::vector<std::pair<int, int>> pairs;
  int last = -1;
  for (int t = 0; t < a.num_frames(); ++t) {
    if (since_a[t] < frames_after_gap) continue;
    // A person who stands still repeats one pose: takes the next one in order.
    int best = -1;
    const double x = a.motion.trans(t, 0);
    for (auto at = frame_at.lower_bound(x - kSamePlace_m); at != frame_at.end() && at->first < x + kSamePlace_m; ++at) {
      const int u = at->second;
      if (u > last && (best < 0 || u < best) && SamePose(a, t, b, u)) best = u;
    }
    if (best < 0) continue;
    pairs.emplace_back(t, best);
    last = best;
  }
  return pairs;
}

SpeedResponse MeasureSpeedResponse(const SinglePersonDataset& truth, const SinglePersonDataset& result,
                                   const SinglePersonDataset& other_truth, const SinglePersonDataset& other_result,
                                   PersonLabel label, int num_threads) {
  RequireMatch(truth, result);
  RequireMatch(other_truth, other_result);
  const Track track = truth.track(), other_track = other_truth.track();
  for (const auto& [set, its] : {std::pair(&truth, &track), std::pair(&other_truth, &other_track)}) {
    if (static_cast<int>(its->joints.size()) != its->num_frames()) {
      throw std::runtime_error(set->path() + "/track.npz: has no joints, from which extents are measured");
    }
  }
  const auto pairs = PairFramesByPose(track, other_track, kFramesAfterGap);
  if (pairs.empty()) {
    throw std::runtime_error(Concatenate(other_truth.path(), ": shows none of the poses of ", truth.path(),
                                         " (ten frames after a cut and later)"));
  }
  struct Change {
    std::array<double, 4> truth, result;
    double truth_iou = 0, result_iou = 0;  ///< between the speeds
    double iou = 0, other_iou = 0;         ///< of the results with their truths
  };
  std::vector<Change> changes(pairs.size());
  ParallelFor(static_cast<int>(pairs.size()), num_threads, [&](int i) {
    const int t = pairs[i].first, u = pairs[i].second;
    const RenderedPeople wanted{true, false, false, false};
    struct Masks {
      PixelMask here, there;
    };
    const auto change = [&](const SinglePersonDataset& set, const SinglePersonDataset& other,
                            std::array<double, 4>* difference) {
      const Image here = set.Read(t, wanted).labels, there = other.Read(u, wanted).labels;
      const LabelExtent a = MeasureLabelExtent(here, label, track, t),
                        b = MeasureLabelExtent(there, label, other_track, u);
      for (int k = 0; k < 4; ++k) (*difference)[k] = a.values[k] - b.values[k];
      return Masks{MaskOfLabel(here, label), MaskOfLabel(there, label)};
    };
    const Masks of_truth = change(truth, other_truth, &changes[i].truth);
    const Masks of_result = change(result, other_result, &changes[i].result);
    changes[i].truth_iou = MaskIoU(of_truth.here, of_truth.there);
    changes[i].result_iou = MaskIoU(of_result.here, of_result.there);
    changes[i].iou = MaskIoU(of_truth.here, of_result.here);
    changes[i].other_iou = MaskIoU(of_truth.there, of_result.there);
  });
  changes.erase(std::remove_if(changes.begin(), changes.end(),
                               [](const Change& c) { return !std::isfinite(c.truth[0] + c.result[0]); }),
                changes.end());
  SpeedResponse reaction;
  reaction.label = label;
  reaction.pairs = static_cast<int>(changes.size());
  const double n = std::max<double>(1, reaction.pairs);
  for (const Change& c : changes) reaction.truth_iou += c.truth_iou / n, reaction.result_iou += c.result_iou / n;
  for (int k = 0; k < 4; ++k) {
    double mean_truth = 0, mean_result = 0, truth2 = 0, product = 0;
    for (const Change& c : changes) {
      mean_truth += c.truth[k] / n, mean_result += c.result[k] / n;
      truth2 += c.truth[k] * c.truth[k], product += c.truth[k] * c.result[k];
    }
    double var_truth = 0, var_result = 0, covariance = 0;
    for (const Change& c : changes) {
      const double a = c.truth[k] - mean_truth, b = c.result[k] - mean_result;
      var_truth += a * a / n, var_result += b * b / n, covariance += a * b / n;
    }
    SpeedResponse::OfExtent& extent = reaction.extents[k];
    extent.truth_std = std::sqrt(var_truth), extent.result_std = std::sqrt(var_result);
    if (var_truth > 0 && var_result > 0) extent.correlation = covariance / std::sqrt(var_truth * var_result);
    if (truth2 > 0) extent.slope = product / truth2;
  }
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.truth_iou > b.truth_iou; });
  for (size_t i = 0; i < changes.size(); ++i) {
    SpeedResponse::Quarter& quarter = reaction.quarters[i * reaction.quarters.size() / changes.size()];
    ++quarter.pairs;
    quarter.between_speeds += changes[i].truth_iou;
    quarter.iou += changes[i].iou, quarter.other_iou += changes[i].other_iou;
  }
  for (SpeedResponse::Quarter& quarter : reaction.quarters) {
    const double count = std::max(1, quarter.pairs);
    quarter.between_speeds /= count, quarter.iou /= count, quarter.other_iou /= count;
  }
  return reaction;
}

}  // namespace bodyloom
