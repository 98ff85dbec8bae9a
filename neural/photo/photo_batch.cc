// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/photo/photo_batch.h"

#include <algorithm>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/hash_random.h"
#include "bodyloom/neural/training/photo_partner.h"
#include "bodyloom/render/texture/complete/partial_texture.h"

namespace bodyloom {
namespace {

/// The part of `box` inside `window`, in its coordinates; width 0 when there is none.
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
  batch.truth = PictureTensorsOf(targets, windows);
  for (size_t i = 0; i < targets.size() && !back_of_head.empty(); ++i) {
    batch.faces.push_back(Inside(FaceBox(targets[i], back_of_head), windows[i]));
  }
  return batch;
}

namespace {

/// 0 … count − 1.
int Draw(uint64_t hash, size_t count) {
  return std::min(static_cast<int>(UniformOf(hash) * static_cast<double>(count)), static_cast<int>(count) - 1);
}

PhotoPair PairOf(const PhotoSource& people, int person, uint64_t hash) {
  const std::vector<int>& num_frames = people.num_frames;
  BODYLOOM_CHECK(person >= 0 && static_cast<size_t>(person) < num_frames.size() && num_frames[person] > 0,
                 "photo pairs: person ", person, " has no frames");
  PhotoPair pair;
  pair.person = person;
  pair.source = Draw(Mix(hash ^ 1), num_frames[person]);
  pair.target = PartnerOf(people, person, pair.source, PartnerDiffers::kPose, UniformOf(Mix(hash ^ 2)));
  return pair;
}

}  // namespace

PhotoPair DrawPhotoPair(const PhotoSource& people, std::span<const int> persons, uint64_t seed, int64_t step,
                        int place) {
  BODYLOOM_CHECK(!persons.empty(), "photo pairs: no persons");
  const uint64_t hash = Mix(Mix(Mix(seed) ^ static_cast<uint64_t>(step)) ^ static_cast<uint64_t>(place));
  return PairOf(people, persons[Draw(hash, persons.size())], hash);
}

std::vector<PhotoPair> ValidationPairs(const PhotoSource& people, std::span<const int> persons, int per_person) {
  std::vector<PhotoPair> pairs;
  for (const int person : persons) {
    for (int i = 0; i < per_person; ++i) {
      pairs.push_back(PairOf(people, person, Mix(Mix(static_cast<uint64_t>(person)) ^ static_cast<uint64_t>(i))));
    }
  }
  return pairs;
}

}  // namespace bodyloom
