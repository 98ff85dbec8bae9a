// SPDX-License-Identifier: Apache-2.0
/// Pictures to learn from, made person by person on several threads.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bodyloom/neural/pictures/packed_picture.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/neural/photo/people_data.h"

namespace bodyloom {

struct PicturesOfPeopleRequest {
  std::string data;          ///< a multi-person dataset
  std::string body;          ///< empty: the built-in body
  bool test = false;         ///< the people kept for testing, instead of those to train on
  int size = 512;            ///< of the windows
  double body_error_px = 4;  ///< bodies are off by up to this, each clip by its own: PeopleDataRequest
  uint64_t seed = 1;         ///< of those errors
  int threads = 1;
};

/// The people, with labels of the nearest part of the body and bodies that are off.
PeopleDataRequest AsPhotosShowThem(const PicturesOfPeopleRequest& request);

/// pictures_of(person) of all people, in their order, for any number of threads. Throws what it throws, Cancelled; the
/// stage of `callbacks` is `stage`.
std::vector<PackedPicture> PicturesByPerson(int num_people, int threads, const char* stage,
                                            const PipelineCallbacks& callbacks,
                                            const std::function<std::vector<PackedPicture>(int)>& pictures_of);

/// The median of people's sizes, pixels a metre; of at least one picture.
double MedianPersonSize(const std::vector<PackedPicture>& pictures);

}  // namespace bodyloom
