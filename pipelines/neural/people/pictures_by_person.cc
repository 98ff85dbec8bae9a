// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/people/pictures_by_person.h"

#include <iterator>
#include <mutex>
#include <utility>

#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/geometry/base/percentile.h"

namespace bodyloom {

PeopleDataRequest AsPhotosShowThem(const PicturesOfPeopleRequest& request) {
  constexpr int kMapSize = 64;  // of maps that nobody reads
  PeopleDataRequest people;
  people.data = request.data, people.body = request.body, people.size = request.size;
  people.texture_size = kMapSize, people.test = request.test;
  people.given.estimated_labels = people.labels_of_body = true;
  people.body_error_px = request.body_error_px;
  people.seed = request.seed;
  return people;
}

std::vector<PackedPicture> PicturesByPerson(int num_people, int threads, const char* stage,
                                            const PipelineCallbacks& callbacks,
                                            const std::function<std::vector<PackedPicture>(int)>& pictures_of) {
  std::vector<std::vector<PackedPicture>> of_person(num_people);
  std::mutex mutex;
  int done = 0;
  ParallelFor(num_people, threads, [&](int person) {
    of_person[person] = pictures_of(person);
    const std::lock_guard lock(mutex);
    callbacks.Update(stage, static_cast<double>(++done) / num_people);
  });
  std::vector<PackedPicture> pictures;
  for (std::vector<PackedPicture>& of_one : of_person) {
    std::move(of_one.begin(), of_one.end(), std::back_inserter(pictures));
  }
  return pictures;
}

double MedianPersonSize(const std::vector<PackedPicture>& pictures) {
  std::vector<double> sizes;
  sizes.reserve(pictures.size());
  for (const PackedPicture& picture : pictures) sizes.push_back(picture.pixels_per_metre);
  return Percentile(sizes, 50);
}

}  // namespace bodyloom
