// SPDX-License-Identifier: Apache-2.0
/// What the picture refiner learns from: people of a multi-person dataset made from some of their pictures, drawn in the
/// poses of the others.
#pragma once

#include <vector>

#include "bodyloom/neural/pictures/packed_picture.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/neural/people/pictures_by_person.h"

namespace bodyloom {

/// `body_error_px` is of every other person, whose labels GrabCut and the clothes parser find; `seed` also of how many photos a person is
/// made of (1, 2 or 4; of half of them 1).
struct RefinerPicturesRequest : PicturesOfPeopleRequest {
  int texture_size = 512;
};

/// Every other person is as anybody's photos show them: labels are found by GrabCut and the clothes parser, and bodies, in
/// photos and pictures alike, are not quite right. The rest have true labels and bodies. Pictures person by person; the same for any number
/// of threads. People of whom the photos show too little have none. Throws as PeopleData, Cancelled; the stage of
/// `callbacks` is `stage`.
std::vector<PackedPicture> RefinerPicturesOf(const RefinerPicturesRequest& request, const char* stage,
                                             const PipelineCallbacks& callbacks);

}  // namespace bodyloom
