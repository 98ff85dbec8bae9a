// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/sigma_reliability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "data_tools/evaluation/metrics.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/observations.h"

namespace bodyloom {
namespace {

constexpr double kMinErrorM = 1e-4;
constexpr int kFirstLimbPoint = 5, kCocoPoints = 17;

/// "left_elbow" → "l_elbow".
std::string JointOfLandmark(const std::string& landmark) {
  return landmark.substr(0, 1) + landmark.substr(landmark.find('_'));
}

/// Adds nothing if the track has no σ of the joint.
void AddPair(double error_m, const Track& track, int frame, Eigen::Index joint, std::vector<JudgedSigma>* pairs) {
  if (frame >= track.joint_sigma.rows() || joint >= track.joint_sigma.cols()) return;
  pairs->push_back({error_m, track.joint_sigma(frame, joint)});
}

double MeanOfFirst(const std::vector<JudgedSigma>& sorted, double share) {
  const auto count = static_cast<size_t>(std::llround(share * static_cast<double>(sorted.size())));
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += sorted[i].error_m;
  return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

double LogCorrelation(const std::vector<JudgedSigma>& pairs) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  if (n < 2) return std::numeric_limits<double>::quiet_NaN();
  Eigen::ArrayXd e(n), s(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    e[i] = std::log(std::max(kMinErrorM, pairs[i].error_m));
    s[i] = std::log(pairs[i].sigma_m);
  }
  e -= e.mean();
  s -= s.mean();
  return (e * s).sum() / std::sqrt(e.square().sum() * s.square().sum());
}

}  // namespace

SigmaReliability JudgeSigmas(std::span<const JudgedSigma> pairs) {
  std::vector<JudgedSigma> sorted;
  for (const JudgedSigma& pair : pairs) {
    if (std::isfinite(pair.error_m) && std::isfinite(pair.sigma_m) && pair.sigma_m > 0) sorted.push_back(pair);
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const JudgedSigma& a, const JudgedSigma& b) { return a.sigma_m < b.sigma_m; });
  SigmaReliability result;
  result.count = static_cast<int64_t>(sorted.size());
  for (int multiple = 1; multiple <= 3; ++multiple) {
    const auto within = std::count_if(sorted.begin(), sorted.end(),
                                      [&](const JudgedSigma& pair) { return pair.error_m <= multiple * pair.sigma_m; });
    result.within_percent[multiple - 1] = 100 * static_cast<double>(within) / static_cast<double>(sorted.size());
  }
  result.log_correlation = LogCorrelation(sorted);
  result.mean_m = MeanOfFirst(sorted, 1);
  result.surest_90_m = MeanOfFirst(sorted, 0.9);
  result.surest_75_m = MeanOfFirst(sorted, 0.75);
  return result;
}

std::vector<JudgedSigma> JudgedLandmarks(const Track& track, const std::vector<int>& source,
                                         const std::vector<MatrixX3d>& from_hips,
                                         const std::vector<MatrixX3d>& true_from_hips) {
  BODYLOOM_CHECK(from_hips.size() == source.size() && true_from_hips.size() == source.size(),
                 "JudgedLandmarks: ", source.size(), " frames, ", from_hips.size(), " estimated and ",
                 true_from_hips.size(), " true ones");
  std::vector<JudgedSigma> pairs;
  for (int k = kFirstLimbPoint; k < kCocoPoints; ++k) {
    const auto& names = SmplJointNames();
    const auto joint = std::find(names.begin(), names.end(), JointOfLandmark(CocoNames()[k])) - names.begin();
    for (size_t t = 0; t < source.size(); ++t) {
      AddPair((from_hips[t].row(k) - true_from_hips[t].row(k)).norm(), track, source[t], joint, &pairs);
    }
  }
  return pairs;
}

std::vector<JudgedSigma> JudgedJoints(const Track& track, const std::vector<int>& source, const BodyModel& body,
                                      const std::vector<MatrixX3d>& joints, const std::vector<MatrixX3d>& true_joints) {
  const std::array<int, 2> hips = HipJoints(body);
  const std::vector<int> root = {hips[0], hips[1]};
  const std::vector<MatrixX3d> a = RelativeTo(joints, RootPositions(joints, root));
  const std::vector<MatrixX3d> b = RelativeTo(true_joints, RootPositions(true_joints, root));
  std::vector<JudgedSigma> pairs;
  for (size_t t = 0; t < source.size(); ++t) {
    for (Eigen::Index j = 1; j < a[t].rows(); ++j) {
      AddPair((a[t].row(j) - b[t].row(j)).norm(), track, source[t], j, &pairs);
    }
  }
  return pairs;
}

void AddSigmaReliability(std::span<const JudgedSigma> pairs, Evaluation* result) {
  const SigmaReliability judged = JudgeSigmas(pairs);
  if (judged.count == 0) return;
  const char* meanings[] = {"joints within one joint_sigma of the truth, about the mid-hip (Gaussian: 19.9)",
                            "within two (73.9)", "within three (97.1)"};
  for (int i = 0; i < 3; ++i) {
    result->Add("sigma_within_" + std::to_string(i + 1) + "_percent", judged.within_percent[i], meanings[i]);
  }
  result->Add("sigma_log_correlation", judged.log_correlation, "correlation of log error and log joint_sigma");
  result->Add("sigma_surest_90_mm", judged.surest_90_m * kMmPerMetre,
              "error without the least sure tenth of the joints");
  result->Add("sigma_surest_75_mm", judged.surest_75_m * kMmPerMetre, "error without the least sure quarter");
}

}  // namespace bodyloom
