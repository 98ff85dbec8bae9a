// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/part_labels/part_map.h"

#include <algorithm>
#include <array>
#include <vector>

#include "geometry/base/equal_bytes.h"

namespace bodyloom {
namespace {

/// Pixels of one row that lie together and belong to one piece: columns begin..end−1.
struct Run {
  int row, begin, end;
  uint8_t part;
};

/// 4-connected pieces, as sets of runs that touch.
class Pieces {
 public:
  /// With `by_part` a piece has one part, else any.
  Pieces(const PartMap& map, bool by_part) : by_part_(by_part) {
    const int width = map.box.width();
    size_t above = 0;  // the first run of the row above
    for (int y = 0; y < map.box.height(); ++y) {
      const size_t here = runs_.size();
      const uint8_t* parts = &map.parts[static_cast<size_t>(y) * width];
      for (int x = 0; x < width;) {
        const int begin = x;
        x = EndOfRun(parts, begin, width);
        if (!IsPart(parts[begin])) continue;
        while (!by_part && x < width && IsPart(parts[x])) x = EndOfRun(parts, x, width);
        runs_.push_back({y, begin, x, parts[begin]});
        first_.push_back(static_cast<int>(first_.size()));
      }
      JoinRows(above, here);
      above = here;
    }
    pixels_.assign(runs_.size(), 0);
    for (size_t i = 0; i < runs_.size(); ++i) pixels_[PieceOf(i)] += runs_[i].end - runs_[i].begin;
  }

  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
  /// Pixels of the piece that run i belongs to.
  [[nodiscard]] int PixelsAround(size_t i) { return pixels_[PieceOf(i)]; }

 private:
  void JoinRows(size_t above, size_t here) {
    size_t a = above;
    for (size_t b = here; b < runs_.size(); ++b) {
      while (a < here && runs_[a].end <= runs_[b].begin) ++a;
      for (size_t c = a; c < here && runs_[c].begin < runs_[b].end; ++c) {
        if (!by_part_ || runs_[c].part == runs_[b].part) first_[PieceOf(b)] = static_cast<int>(PieceOf(c));
      }
    }
  }

  /// The run that represents the piece of run i.
  size_t PieceOf(size_t i) {
    while (static_cast<size_t>(first_[i]) != i) {
      first_[i] = first_[static_cast<size_t>(first_[i])];
      i = static_cast<size_t>(first_[i]);
    }
    return i;
  }

  bool by_part_;
  std::vector<Run> runs_;
  std::vector<int> first_;  ///< another run of the same piece, or the run itself
  std::vector<int> pixels_;
};

/// Pieces smaller than this share of the largest (of their part, or of the person) become unknown.
void RemoveSpecks(bool by_part, double speck_share, PartMap* map) {
  Pieces pieces(*map, by_part);
  std::array<int, 256> largest{};  // by part; of the person at 0
  for (size_t i = 0; i < pieces.runs().size(); ++i) {
    int& record = largest[by_part ? pieces.runs()[i].part : 0];
    record = std::max(record, pieces.PixelsAround(i));
  }
  for (size_t i = 0; i < pieces.runs().size(); ++i) {
    const Run& run = pieces.runs()[i];
    if (pieces.PixelsAround(i) >= speck_share * largest[by_part ? run.part : 0]) continue;
    uint8_t* row = &map->parts[static_cast<size_t>(run.row) * map->box.width()];
    std::fill(row + run.begin, row + run.end, PartLabelSequence::kUnknown);
  }
}

}  // namespace

void PartMap::ReadRow(int y, int x_begin, int x_end, uint8_t* row) const {
  const auto fill = [&](int begin, int end, uint8_t part) {
    begin = std::max(begin, x_begin), end = std::min(end, x_end);
    if (begin < end) std::fill(row + (begin - x_begin), row + (end - x_begin), part);
  };
  fill(x_begin, x_end, PartLabelSequence::kUnknown);
  if (y < image.y_begin || y >= image.y_end) return;
  fill(image.x_begin, image.x_end, PartLabelSequence::kBackground);
  const int begin = std::max(x_begin, box.x_begin), end = std::min(x_end, box.x_end);
  if (y < box.y_begin || y >= box.y_end || begin >= end) return;
  std::copy_n(&parts[box.IndexOf(begin, y)], end - begin, row + (begin - x_begin));
}

PartMap MakePartMap(const PartLabelSequence& labels, int t, double speck_share) {
  LabelImage image = labels.PartsOf(t);
  PartMap map;
  map.image = {0, 0, labels.image_width, labels.image_height};
  map.box = {image.x_begin, image.y_begin, image.x_begin + image.width, image.y_begin + image.height};
  if (map.box.empty()) {
    map.box = {};
    return map;
  }
  map.parts = std::move(image.labels);
  RemoveSpecks(false, speck_share, &map);
  RemoveSpecks(true, speck_share, &map);
  return map;
}

}  // namespace bodyloom
