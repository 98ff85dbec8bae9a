// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/person_detection.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kNumbers = 12;
constexpr double kMaxLogit = 100, kSamePersonOverlap = 0.3;

struct AnchorGrid {
  int cells = 0, anchors_per_cell = 0;
};
constexpr std::array<AnchorGrid, 3> kGrids = {AnchorGrid{28, 2}, AnchorGrid{14, 2}, AnchorGrid{7, 6}};

PersonDetection Decoded(std::span<const float> numbers, const Eigen::Vector2d& anchor, double score) {
  const auto pair = [numbers](int i) -> Eigen::Vector2d {
    return Eigen::Vector2d(numbers[i], numbers[i + 1]) / kPersonDetectorSize;
  };
  const Eigen::Vector2d centre = anchor + pair(0), size = pair(2);
  PersonDetection result{.box_min = centre - size / 2, .box_max = centre + size / 2, .score = score};
  for (int point = 0; point < 4; ++point) result.points[point] = anchor + pair(4 + 2 * point);
  return result;
}

double Area(const Eigen::Vector2d& min, const Eigen::Vector2d& max) { return (max - min).cwiseMax(0).prod(); }

double IntersectionOverUnion(const PersonDetection& a, const PersonDetection& b) {
  const double both = Area(a.box_min.cwiseMax(b.box_min), a.box_max.cwiseMin(b.box_max));
  const double either = Area(a.box_min, a.box_max) + Area(b.box_min, b.box_max) - both;
  return either > 0 ? both / either : 0;
}

/// The candidates, best first, with overlapping ones merged.
std::vector<PersonDetection> Merged(std::vector<PersonDetection> candidates) {
  std::vector<PersonDetection> result;
  while (!candidates.empty()) {
    const PersonDetection best = candidates.front();
    PersonDetection mean{.score = best.score};
    double sum = 0;
    std::vector<PersonDetection> rest;
    for (const PersonDetection& other : candidates) {
      // The best one belongs to its own group even when its box has no area.
      if (&other != candidates.data() && IntersectionOverUnion(best, other) <= kSamePersonOverlap) {
        rest.push_back(other);
        continue;
      }
      sum += other.score;
      mean.box_min += other.score * other.box_min;
      mean.box_max += other.score * other.box_max;
      for (int i = 0; i < 4; ++i) mean.points[i] += other.score * other.points[i];
    }
    mean.box_min /= sum;
    mean.box_max /= sum;
    for (Eigen::Vector2d& point : mean.points) point /= sum;
    result.push_back(mean);
    candidates = std::move(rest);
  }
  return result;
}

}  // namespace

std::vector<PersonDetection> DecodePersonDetections(std::span<const float> boxes, std::span<const float> logits,
                                                    double min_score) {
  BODYLOOM_CHECK(boxes.size() == size_t(kPersonDetectorAnchors) * kNumbers && logits.size() == kPersonDetectorAnchors,
                 "the person detector gives 2254 x 12 box numbers and 2254 scores, got ", boxes.size(), " and ",
                 logits.size());
  std::vector<PersonDetection> candidates;
  size_t i = 0;
  for (const AnchorGrid& grid : kGrids) {
    for (int cell = 0; cell < grid.cells * grid.cells; ++cell) {
      const int row = cell / grid.cells, column = cell % grid.cells;
      const Eigen::Vector2d anchor((column + 0.5) / grid.cells, (row + 0.5) / grid.cells);
      for (int k = 0; k < grid.anchors_per_cell; ++k, ++i) {
        const double score = 1 / (1 + std::exp(-std::clamp<double>(logits[i], -kMaxLogit, kMaxLogit)));
        const std::span<const float> numbers = boxes.subspan(i * kNumbers, kNumbers);
        const bool finite = std::all_of(numbers.begin(), numbers.end(), [](float v) { return std::isfinite(v); });
        // NaN compares false.
        if (score >= min_score && finite && numbers[2] >= 0 && numbers[3] >= 0) {
          candidates.push_back(Decoded(numbers, anchor, score));
        }
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PersonDetection& a, const PersonDetection& b) { return a.score > b.score; });
  return Merged(std::move(candidates));
}

}  // namespace bodyloom
