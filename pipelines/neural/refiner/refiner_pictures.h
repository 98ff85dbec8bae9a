// SPDX-License-Identifier: Apache-2.0
/// What the picture refiner learns from: people of a multi-person dataset made from some of their pictures, drawn in the
/// poses of the others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bodyloom/neural/pictures/packed_picture.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

struct RefinerPicturesRequest {
  std::string data;   ///< a multi-person dataset
  std::string body;   ///< empty: the built-in body
  bool test = false;  ///< the people kept for testing, instead of those to train on
  int size = 512;     ///< of the windows
  int texture_size = 512;
  uint64_t seed = 1;         ///< of how many photos a person is made of (1, 2 or 4; of half of them 1)
  double body_error_px = 4;  ///< of every other person, whose labels are found by GrabCut: PeopleDataRequest
  int threads = 1;
};

/// Every other person is as anybody's photos show them: labels are found by GrabCut and bodies, in photos and pictures
/// alike, are not quite right. The rest have true labels and bodies. Pictures person by person; the same for any number
/// of threads. People of whom the photos show too little have none. Throws as PeopleData, Cancelled; the stage of
/// `callbacks` is `stage`.
std::vector<PackedPicture> RefinerPicturesOf(const RefinerPicturesRequest& request, const char* stage,
                                             const PipelineCallbacks& callbacks);

}  // namespace bodyloom
