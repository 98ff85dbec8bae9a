// SPDX-License-Identifier: Apache-2.0
#include "tracking/rig/match_people.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/scene/camera_path.h"

namespace bodyloom {
namespace {

constexpr double kAgreementStep_s = 1.0 / 15;

/// Greedy matching of people under a hypothesis.
MatchedViews MatchUnder(const std::vector<ViewMotion>& first, const std::vector<ViewMotion>& other,
                        const MotionAlignment& alignment) {
  std::vector<std::tuple<double, int, int>> pairs;
  std::vector<std::vector<MotionAgreement>> agreements(first.size(), std::vector<MotionAgreement>(other.size()));
  for (size_t i = 0; i < first.size(); ++i) {
    for (size_t j = 0; j < other.size(); ++j) {
      if (first[i].points.empty() || other[j].points.empty()) continue;
      MotionAgreement& agreement = agreements[i][j];
      agreement = AgreementOf(first[i], other[j], alignment.b_from_a, alignment.offset_s);
      const double share = agreement.distance_m / kMaxMotionDistance_m, apart = agreement.apart_m / kMaxApart_m;
      if (agreement.overlap_s <= 0 || share >= 1 || apart >= 1) continue;
      pairs.emplace_back(agreement.overlap_s * (1 - share * share) * (1 - apart * apart), static_cast<int>(i),
                         static_cast<int>(j));
    }
  }
  std::sort(pairs.rbegin(), pairs.rend());
  MatchedViews matched;
  matched.person_of.assign(first.size(), -1);
  matched.agreement.resize(first.size());
  matched.alignment = alignment;
  std::vector<char> taken(other.size(), 0);
  for (const auto& [score, i, j] : pairs) {
    if (matched.person_of[i] >= 0 || taken[j] != 0) continue;
    matched.person_of[i] = j;
    matched.agreement[i] = agreements[i][j];
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

MatchedViews MatchPeople(const std::vector<ViewMotion>& first, const std::vector<ViewMotion>& other) {
  MatchedViews best;
  best.person_of.assign(first.size(), -1);
  best.agreement.resize(first.size());
  for (const ViewMotion& a : first) {
    for (const ViewMotion& b : other) {
      if (a.points.empty() || b.points.empty()) continue;
      const MotionAlignment alignment = AlignMotions(a, b);
      if (!alignment.found) {
        if (best.alignment.why.empty()) best.alignment.why = alignment.why;
        continue;
      }
      MatchedViews matched = MatchUnder(first, other, alignment);
      if (matched.score > best.score) best = std::move(matched);
    }
  }
  return best;
}

}  // namespace bodyloom
