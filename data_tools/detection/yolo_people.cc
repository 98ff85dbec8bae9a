// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/detection/yolo_people.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kLeastScore = 0.25, kSameBoxOverlap = 0.7;
constexpr size_t kMostPeople = 300;

double Overlap(const PersonBox& a, const PersonBox& b) {
  const auto area = [](const PersonBox& box) { return (box.x1 - box.x0) * (box.y1 - box.y0); };
  const double width = std::min(a.x1, b.x1) - std::max(a.x0, b.x0);
  const double height = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
  if (!(width > 0 && height > 0)) return 0;
  return width * height / (area(a) + area(b) - width * height);
}

/// The network's numbers, rows × anchors.
class Numbers {
 public:
  Numbers(std::span<const float> values, size_t rows) : values_(values), anchors_(values.size() / rows) {}
  [[nodiscard]] size_t anchors() const { return anchors_; }
  [[nodiscard]] double At(size_t row, size_t anchor) const { return values_[row * anchors_ + anchor]; }

 private:
  std::span<const float> values_;
  size_t anchors_;
};

bool IsPerson(const Numbers& numbers, size_t anchor, int classes) {
  const double score = numbers.At(4, anchor);
  if (!(score >= kLeastScore)) return false;  // not a number compares false
  for (int c = 1; c < classes; ++c) {
    if (numbers.At(4 + size_t(c), anchor) > score) return false;
  }
  return true;
}

PersonBox BoxOf(const Numbers& numbers, size_t anchor, const PictureCrop& crop) {
  const Eigen::Array2d middle(numbers.At(0, anchor), numbers.At(1, anchor));
  const Eigen::Array2d half = Eigen::Array2d(numbers.At(2, anchor), numbers.At(3, anchor)) / 2;
  const Eigen::Array2d low = crop.ImageFromCrop(middle - half), high = crop.ImageFromCrop(middle + half);
  return {low.x(), low.y(), high.x(), high.y(), std::min(numbers.At(4, anchor), 1.0)};
}

bool IsUsable(const PersonBox& box) {
  return std::isfinite(box.x0) && std::isfinite(box.y0) && std::isfinite(box.x1) && std::isfinite(box.y1) &&
         box.x1 > box.x0 && box.y1 > box.y0;
}

Keypoint PointOf(const Numbers& numbers, size_t row, size_t anchor, const PictureCrop& crop) {
  const Eigen::Array2d place = crop.ImageFromCrop({numbers.At(row, anchor), numbers.At(row + 1, anchor)});
  const double visibility = numbers.At(row + 2, anchor);
  const Keypoint point = {float(place.x()), float(place.y()), float(std::clamp(visibility, 0.0, 1.0))};
  const bool finite = std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(visibility);
  return finite ? point : Keypoint{0, 0, 0};
}

}  // namespace

std::vector<YoloPerson> DecodeYolo(std::span<const float> output, int classes, int landmarks, const PictureCrop& crop) {
  BODYLOOM_CHECK(classes >= 1 && landmarks >= 0, classes, " classes and ", landmarks, " landmarks");
  const size_t rows = 4 + size_t(classes) + 3 * size_t(landmarks);
  BODYLOOM_CHECK(output.size() % rows == 0, output.size(), " numbers, expected ", rows, " for each anchor");
  const Numbers numbers(output, rows);
  std::vector<std::pair<PersonBox, size_t>> candidates;
  for (size_t anchor = 0; anchor < numbers.anchors(); ++anchor) {
    if (!IsPerson(numbers, anchor, classes)) continue;
    const PersonBox box = BoxOf(numbers, anchor, crop);
    if (IsUsable(box)) candidates.emplace_back(box, anchor);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first.score > b.first.score; });
  std::vector<YoloPerson> people;
  for (const auto& [box, anchor] : candidates) {
    if (people.size() == kMostPeople) break;
    const auto is_same = [&b = box](const YoloPerson& other) { return Overlap(b, other.box) > kSameBoxOverlap; };
    if (std::any_of(people.begin(), people.end(), is_same)) continue;
    YoloPerson& person = people.emplace_back();
    person.box = box;
    for (int k = 0; k < landmarks; ++k) {
      person.points.push_back(PointOf(numbers, 4 + size_t(classes) + 3 * size_t(k), anchor, crop));
    }
  }
  return people;
}

}  // namespace bodyloom
