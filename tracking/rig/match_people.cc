// SPDX-License-Identifier: Apache-2.0
#include "tracking/rig/match_people.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/scene/camera_path.h"

namespace bodyloom {
namespace {

constexpr double kAgreementStep_s = 1.0 / 15;

/// Greedy matching under a hypothesis; `unlike_m2`: squared distance of poses that have nothing to do with each other,
/// of each pair.
MatchedViews MatchUnder(const std::vector<ViewMotion>& first, const std::vector<ViewMotion>& other,
                        const MotionAlignment& alignment, const Eigen::MatrixXd& unlike_m2) {
  std::vector<std::tuple<double, int, int>> pairs;
  Eigen::MatrixXd overlap_s = Eigen::MatrixXd::Zero(unlike_m2.rows(), unlike_m2.cols());
  for (size_t i = 0; i < first.size(); ++i) {
    for (size_t j = 0; j < other.size(); ++j) {
      if (first[i].points.empty() || other[j].points.empty()) continue;
      const MotionAgreement agreement = AgreementOf(first[i], other[j], alignment.b_from_a, alignment.offset_s);
      overlap_s(static_cast<int>(i), static_cast<int>(j)) = agreement.overlap_s;
      const double apart = agreement.apart_m / kMaxApart_m;
      const double less_m2 =
          unlike_m2(static_cast<int>(i), static_cast<int>(j)) - agreement.distance_m * agreement.distance_m;
      if (agreement.overlap_s <= 0 || agreement.distance_m >= kMaxMotionDistance_m || apart >= 1) continue;
      pairs.emplace_back(agreement.overlap_s * less_m2 * (1 - apart * apart), static_cast<int>(i), static_cast<int>(j));
    }
  }
  std::sort(pairs.rbegin(), pairs.rend());
  MatchedViews matched;
  matched.person_of.assign(first.size(), -1);
  matched.evidence.assign(first.size(), 0);
  matched.alignment = alignment;
  std::vector<char> taken(other.size(), 0);
  for (const auto& [score, i, j] : pairs) {
    if (matched.person_of[i] >= 0 || taken[j] != 0) continue;
    matched.person_of[i] = j;
    matched.evidence[i] = overlap_s(i, j);
    taken[j] = 1;
    matched.score += score;
  }
  return matched;
}

}  // namespace

MotionAgreement AgreementOf(const ViewMotion& a, const ViewMotion& b, const CameraPose& b_from_a, double offset_s) {
  MotionAgreement agreement;
  double sum = 0;
  Eigen::Index count = 0;
  std::vector<double> apart;
  MatrixX3d p, q;
  for (double t = a.timestamps.front(); t <= a.timestamps.back(); t += kAgreementStep_s) {
    if (!PointsAt(a, t, &p) || !PointsAt(b, t + offset_s, &q)) continue;
    p = MovedPoints(b_from_a, p);
    const Eigen::RowVector3d centre = p.colwise().mean(), other = q.colwise().mean();
    sum += ((p.rowwise() - centre) - (q.rowwise() - other)).squaredNorm();
    count += p.rows();
    apart.push_back((centre - other).norm());
  }
  if (apart.empty()) return agreement;
  std::nth_element(apart.begin(), apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2), apart.end());
  agreement.distance_m = std::sqrt(sum / static_cast<double>(count));
  agreement.apart_m = apart[apart.size() / 2];
  agreement.overlap_s = static_cast<double>(apart.size()) * kAgreementStep_s;
  return agreement;
}

MatchedViews MatchPeople(const std::vector<ViewMotion>& first, const std::vector<ViewMotion>& other,
                         const MotionAlignment& alignment) {
  const Eigen::Index rows = static_cast<Eigen::Index>(first.size()), columns = static_cast<Eigen::Index>(other.size());
  return MatchUnder(first, other, alignment,
                    Eigen::MatrixXd::Constant(rows, columns, kMaxMotionDistance_m * kMaxMotionDistance_m));
}

MatchedViews MatchPeople(const std::vector<ViewMotion>& first, const std::vector<ViewMotion>& other) {
  const double limit = kMaxMotionDistance_m;
  Eigen::MatrixXd unlike_m2 = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(first.size()),
                                                        static_cast<Eigen::Index>(other.size()), limit * limit);
  MatchedViews best;
  best.person_of.assign(first.size(), -1);
  best.evidence.assign(first.size(), 0);
  Eigen::MatrixXd evidence = Eigen::MatrixXd::Zero(unlike_m2.rows(), unlike_m2.cols());
  std::vector<MotionAlignment> hypotheses;
  for (size_t i = 0; i < first.size(); ++i) {
    for (size_t j = 0; j < other.size(); ++j) {
      if (first[i].points.empty() || other[j].points.empty()) continue;
      const MotionAlignment alignment = AlignMotions(first[i], other[j]);
      if (alignment.found) {
        hypotheses.push_back(alignment);
        const double unlike = std::max(limit, alignment.other_distance_m);
        unlike_m2(static_cast<int>(i), static_cast<int>(j)) = unlike * unlike;
        evidence(static_cast<int>(i), static_cast<int>(j)) = alignment.score;
      } else if (best.alignment.why.empty()) {
        best.alignment.why = alignment.why;
      }
    }
  }
  for (const MotionAlignment& hypothesis : hypotheses) {
    MatchedViews matched = MatchUnder(first, other, hypothesis, unlike_m2);
    if (matched.score > best.score) best = std::move(matched);
  }
  for (size_t i = 0; i < first.size(); ++i) {
    if (best.person_of[i] >= 0) best.evidence[i] = evidence(static_cast<int>(i), best.person_of[i]);
  }
  return best;
}

}  // namespace bodyloom
