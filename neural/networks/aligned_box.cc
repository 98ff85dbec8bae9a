// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/aligned_box.h"

#include <algorithm>

namespace bodyloom {
namespace {

/// Widens [begin, end) to whole cells, of `cells` in all, and to at least `minimum` of them, alternating between both
/// sides.
void Align(int cells, int multiple, int minimum, int* begin, int* end) {
  int from = *begin / multiple, to = (*end + multiple - 1) / multiple;
  minimum = std::min(minimum, cells);
  while (to - from < minimum) {
    if (from > 0) --from;
    if (to - from < minimum && to < cells) ++to;
  }
  *begin = from * multiple;
  *end = to * multiple;
}

}  // namespace

int MinBoxSide(int multiple) { return std::max(2 * multiple, 32); }

PixelBox AlignedBox(const PixelBox& box, const PixelBox& window, int multiple, int min_width, int min_height) {
  PixelBox aligned = box.ClippedTo(window);
  if (aligned.empty()) {
    const int x = window.x_end / 2, y = window.y_end / 2;
    aligned = {x, y, x + 1, y + 1};
  }
  const auto cells = [&](int pixels) { return (pixels + multiple - 1) / multiple; };
  Align(window.x_end / multiple, multiple, cells(min_width), &aligned.x_begin, &aligned.x_end);
  Align(window.y_end / multiple, multiple, cells(min_height), &aligned.y_begin, &aligned.y_end);
  return aligned;
}

std::vector<PixelBox> AlignedBoxes(std::vector<PixelBox> boxes, const PixelBox& window, int multiple) {
  int width = MinBoxSide(multiple), height = width;
  for (const PixelBox& box : boxes) {
    const PixelBox aligned = AlignedBox(box, window, multiple, width, height);
    width = std::max(width, aligned.width());
    height = std::max(height, aligned.height());
  }
  for (PixelBox& box : boxes) box = AlignedBox(box, window, multiple, width, height);
  return boxes;
}

}  // namespace bodyloom
