// SPDX-License-Identifier: Apache-2.0
#include "neural/training/photo_partner.h"

#include <algorithm>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {

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

}  // namespace bodyloom
