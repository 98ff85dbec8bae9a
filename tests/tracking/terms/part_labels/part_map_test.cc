// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/part_labels/part_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "geometry/base/hash_random.h"

namespace bodyloom::part_map_test {
namespace {

constexpr uint8_t kBackground = PartLabelSequence::kBackground, kUnknown = PartLabelSequence::kUnknown;

PartLabelSequence OneFrame(int width, int height, std::vector<uint8_t> labels) {
  PartLabelSequence sequence;
  sequence.image_width = width;
  sequence.image_height = height;
  sequence.timestamps = {0};
  sequence.frames = {LabelImage{0, 0, width, height, std::move(labels)}};
  return sequence;
}

/// One pixel of a piece after the other, by looking at all pixels again and again: slow, and nothing like what it
/// judges.
void RemoveSpecksSlowly(int width, int height, bool by_part, double share, std::vector<uint8_t>* parts) {
  std::vector<int> piece(parts->size());
  for (size_t i = 0; i < piece.size(); ++i) piece[i] = static_cast<int>(i);
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < width * height; ++i) {
      for (const int next : {i % width + 1 < width ? i + 1 : i, i + width < width * height ? i + width : i}) {
        const uint8_t a = (*parts)[i], b = (*parts)[next];
        if (!IsPart(a) || !IsPart(b) || (by_part && a != b) || piece[i] == piece[next]) continue;
        piece[i] = piece[next] = std::min(piece[i], piece[next]);
        changed = true;
      }
    }
  }
  std::map<int, int> size;
  std::map<uint8_t, int> largest;
  for (size_t i = 0; i < piece.size(); ++i) size[piece[i]] += IsPart((*parts)[i]) ? 1 : 0;
  for (size_t i = 0; i < piece.size(); ++i) {
    int& record = largest[by_part ? (*parts)[i] : 0];
    if (IsPart((*parts)[i])) record = std::max(record, size[piece[i]]);
  }
  const std::vector<uint8_t> before = *parts;
  for (size_t i = 0; i < piece.size(); ++i) {
    if (IsPart(before[i]) && size[piece[i]] < share * largest[by_part ? before[i] : 0]) (*parts)[i] = kUnknown;
  }
}

TEST(PartMap, RandomMapsLoseTheSpecksThatASlowTwinFinds) {
  int removed = 0, kept = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    HashRandom random(seed, {7});
    const int width = 1 + static_cast<int>(24 * random.Uniform()), height = 1 + static_cast<int>(18 * random.Uniform());
    const double density = 0.3 + 0.6 * random.Uniform(), share = 0.5 * random.Uniform();
    std::vector<uint8_t> labels(static_cast<size_t>(width) * height);
    for (uint8_t& label : labels) {
      const double u = random.Uniform();
      label = u > density ? (u > 0.95 ? kUnknown : kBackground) : static_cast<uint8_t>(1 + 3 * random.Uniform());
    }
    std::vector<uint8_t> expected = labels;
    RemoveSpecksSlowly(width, height, false, share, &expected);
    RemoveSpecksSlowly(width, height, true, share, &expected);
    EXPECT_EQ(MakePartMap(OneFrame(width, height, labels), 0, share).parts, expected) << seed;
    for (size_t i = 0; i < labels.size(); ++i) (expected[i] == labels[i] ? kept : removed) += IsPart(labels[i]) ? 1 : 0;
  }
  EXPECT_GT(removed, 3000);
  EXPECT_GT(kept, 3000);
}

TEST(PartMap, ArmsOfOneShapeAreOnePiece) {
  // A comb whose teeth meet in the last row only, a spiral, and a ring around a speck.
  const std::vector<uint8_t> comb = {1, 0, 1, 0, 1,  //
                                     1, 0, 1, 0, 1,  //
                                     1, 1, 1, 1, 1};
  EXPECT_EQ(MakePartMap(OneFrame(5, 3, comb), 0, 1).parts, comb);
  const std::vector<uint8_t> spiral = {1, 1, 1, 1, 1,  //
                                       0, 0, 0, 0, 1,  //
                                       1, 1, 1, 0, 1,  //
                                       1, 0, 0, 0, 1,  //
                                       1, 1, 1, 1, 1};
  EXPECT_EQ(MakePartMap(OneFrame(5, 5, spiral), 0, 1).parts, spiral);
  std::vector<uint8_t> ring = {1, 1, 1, 1, 1,  //
                               1, 0, 0, 0, 1,  //
                               1, 0, 1, 0, 1,  //
                               1, 0, 0, 0, 1,  //
                               1, 1, 1, 1, 1};
  const std::vector<uint8_t> found = MakePartMap(OneFrame(5, 5, ring), 0, 0.5).parts;
  ring[12] = kUnknown;
  EXPECT_EQ(found, ring);
}

}  // namespace
}  // namespace bodyloom::part_map_test
