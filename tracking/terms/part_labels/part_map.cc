// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/part_labels/part_map.h"

#include <algorithm>
#include <array>

namespace bodyloom {
namespace {

constexpr uint8_t kBackground = PartLabelSequence::kBackground, kUnknown = PartLabelSequence::kUnknown;

bool IsPart(uint8_t part) { return part != kBackground && part != kUnknown; }

/// 4-connected pieces; with `by_part` a piece has one part, else any. Small ones become unknown.
void RemoveSpecks(bool by_part, double speck_share, PartMap* map) {
  const int width = map->box.width(), height = map->box.height();
  std::vector<int> piece(map->parts.size(), -1), stack;
  std::vector<int> size_of_piece;
  std::array<int, 256> largest{};  // by part; of the person at 0
  for (size_t start = 0; start < map->parts.size(); ++start) {
    if (piece[start] >= 0 || !IsPart(map->parts[start])) continue;
    const int id = static_cast<int>(size_of_piece.size());
    int size = 0;
    stack.assign(1, static_cast<int>(start));
    piece[start] = id;
    while (!stack.empty()) {
      const int at = stack.back();
      stack.pop_back();
      ++size;
      const auto visit = [&](int next) {
        const uint8_t part = map->parts[next];
        if (piece[next] >= 0 || !IsPart(part) || (by_part && part != map->parts[start])) return;
        piece[next] = id;
        stack.push_back(next);
      };
      const int x = at % width, y = at / width;
      if (x > 0) visit(at - 1);
      if (x + 1 < width) visit(at + 1);
      if (y > 0) visit(at - width);
      if (y + 1 < height) visit(at + width);
    }
    size_of_piece.push_back(size);
    int& record = largest[by_part ? map->parts[start] : 0];
    record = std::max(record, size);
  }
  for (size_t i = 0; i < map->parts.size(); ++i) {
    if (piece[i] < 0) continue;
    const int record = largest[by_part ? map->parts[i] : 0];
    if (size_of_piece[piece[i]] < speck_share * record) map->parts[i] = kUnknown;
  }
}

}  // namespace

PartMap MakePartMap(const PartLabelSequence& labels, int t, double speck_share) {
  const LabelImage& image = labels.frames[t];
  PartMap map;
  map.image = {0, 0, labels.image_width, labels.image_height};
  map.box = {image.x_begin, image.y_begin, image.x_begin + image.width, image.y_begin + image.height};
  if (map.box.empty()) {
    map.box = {};
    return map;
  }
  map.parts.resize(map.box.area());
  std::transform(image.labels.begin(), image.labels.end(), map.parts.begin(),
                 [&](uint8_t label) { return labels.part_of_label[label]; });
  RemoveSpecks(false, speck_share, &map);
  RemoveSpecks(true, speck_share, &map);
  return map;
}

}  // namespace bodyloom
