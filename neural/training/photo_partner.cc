// SPDX-License-Identifier: Apache-2.0
#include "neural/training/photo_partner.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"

namespace bodyloom {
namespace {

/// Uniform number in 0 … count − 1.
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

int PartnerOf(const PhotoSource& people, int person, int source, PartnerDiffers differs, double uniform) {
  BODYLOOM_CHECK(person >= 0 && static_cast<size_t>(person) < people.num_frames.size(), "pairs of photos: person ",
                 person, " of ", people.num_frames.size());
  const int frames = people.num_frames[person];
  BODYLOOM_CHECK(source >= 0 && source < frames, "pairs of photos: image ", source, " of ", frames);
  std::vector<int> others, of_another_pose, of_another_view_too;
  for (int k = 1; k < frames; ++k) {
    const int frame = (source + k) % frames;
    others.push_back(frame);
    if (people.places.empty()) continue;
    BODYLOOM_CHECK(
        people.places.size() == people.num_frames.size() && people.places[person].size() == static_cast<size_t>(frames),
        "pairs of photos: places of other images than there are");
    const ImagePlace &here = people.places[person][source], &there = people.places[person][frame];
    if (here.pose == there.pose) continue;
    of_another_pose.push_back(frame);
    if (here.view != there.view) of_another_view_too.push_back(frame);
  }
  const std::vector<int>* choice = &others;
  if (!of_another_pose.empty()) choice = &of_another_pose;
  if (differs == PartnerDiffers::kPoseAndView && !of_another_view_too.empty()) choice = &of_another_view_too;
  if (choice->empty()) return source;
  const int count = static_cast<int>(choice->size());
  return (*choice)[std::min(count - 1, static_cast<int>(uniform * count))];
}

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
