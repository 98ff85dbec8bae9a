// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/observations/cut_frames.h"

#include <cstddef>
#include <vector>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

/// Keeps frames [first, last] of what has `each` elements a frame.
template <typename T>
void Cut(int first, int last, int each, std::vector<T>* all) {
  all->erase(all->begin() + std::ptrdiff_t{each} * (last + 1), all->end());
  all->erase(all->begin(), all->begin() + std::ptrdiff_t{each} * first);
}

void CheckSpan(int first, int last, int num_frames) {
  BODYLOOM_CHECK(0 <= first && first <= last && last < num_frames, "frames ", first, " to ", last, " of a clip of ",
                 num_frames);
}

}  // namespace

KeypointSequence CutFrames(KeypointSequence keypoints, int first, int last) {
  CheckSpan(first, last, keypoints.num_frames());
  Cut(first, last, keypoints.num_points(), &keypoints.points);
  Cut(first, last, 1, &keypoints.timestamps);
  return keypoints;
}

PartLabelSequence CutFrames(PartLabelSequence labels, int first, int last) {
  CheckSpan(first, last, labels.num_frames());
  Cut(first, last, 1, &labels.frames);
  Cut(first, last, 1, &labels.timestamps);
  return labels;
}

}  // namespace bodyloom
