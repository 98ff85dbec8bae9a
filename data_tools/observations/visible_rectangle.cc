// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/observations/visible_rectangle.h"

#include <algorithm>
#include <limits>

namespace bodyloom {
namespace {

constexpr float kVisible = 0.5F;

}  // namespace

ImageRectangle VisibleRectangle(const DetectedPerson& person) {
  const auto is_visible = [](const Keypoint& p) { return p.confidence >= kVisible; };
  const bool some = std::any_of(person.points.begin(), person.points.end(), is_visible);
  constexpr double kMost = std::numeric_limits<double>::max();
  ImageRectangle box = {kMost, kMost, -kMost, -kMost};
  for (const Keypoint& p : person.points) {
    if (some ? !is_visible(p) : !(p.confidence > 0)) continue;
    box.x0 = std::min(box.x0, double{p.x}), box.x1 = std::max(box.x1, double{p.x});
    box.y0 = std::min(box.y0, double{p.y}), box.y1 = std::max(box.y1, double{p.y});
  }
  return box;
}

}  // namespace bodyloom
