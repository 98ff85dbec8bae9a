// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_batch.h"

#include <algorithm>

#include "render/texture/complete/partial_texture.h"

namespace bodyloom {
namespace {

/// The part of `box` inside `window`, in coordinates of the window; width 0 if there is none.
PhotoWindow Inside(const PhotoWindow& box, const PhotoWindow& window) {
  const int left = std::max(box.x, window.x), right = std::min(box.x + box.width, window.x + window.width);
  const int top = std::max(box.y, window.y), bottom = std::min(box.y + box.height, window.y + window.height);
  if (right <= left || bottom <= top) return {};
  return {left - window.x, top - window.y, right - left, bottom - top};
}

}  // namespace

PhotoBatch MakePhotoBatch(const PhotoSource& source, std::span<const PhotoPair> pairs, int reach, int smallest_side,
                          const TexelNeighbours* guess, std::span<const uint8_t> back_of_head) {
  std::vector<PartialTexture> from, to;
  std::vector<PhotoFrame> targets;
  std::vector<PhotoWindow> windows;
  PhotoFrame frame;
  for (const PhotoPair& pair : pairs) {
    source.fill(pair.person, pair.source, &frame);
    from.push_back(PartialTextureOf(frame));
    if (guess != nullptr) GuessTexture(*guess, &from.back());
    targets.emplace_back();
    source.fill(pair.person, pair.target, &targets.back());
    to.push_back(PartialTextureOf(targets.back()));
    windows.push_back(WindowAround(targets.back(), reach, smallest_side));
  }
  windows = EqualWindows(windows, source.size);
  PhotoBatch batch;
  batch.source = ToTensors(from);
  batch.target = ToTensors(to);
  batch.pose = PoseOf(targets, windows);
  batch.truth = ImageTensorsOf(targets, windows);
  for (size_t i = 0; i < targets.size() && !back_of_head.empty(); ++i) {
    batch.faces.push_back(Inside(FaceBox(targets[i], back_of_head), windows[i]));
  }
  return batch;
}

}  // namespace bodyloom
