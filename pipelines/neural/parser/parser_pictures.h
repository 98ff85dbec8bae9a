// SPDX-License-Identifier: Apache-2.0
/// What the clothes parser learns from: the pictures of a multi-person dataset, as users' photos are fitted.
#pragma once

#include <vector>

#include "bodyloom/neural/pictures/packed_picture.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/neural/people/pictures_by_person.h"

namespace bodyloom {

/// Masks are found by GrabCut around the bodies, which are not quite right. Planes of kParserPlanes, truth of ParserTruth;
/// person by person, the same for any number of threads. Frames whose body is not known are left out. Throws as
/// PeopleData, Cancelled; the stage of `callbacks` is `stage`.
std::vector<PackedPicture> ParserPicturesOf(const PicturesOfPeopleRequest& request, const char* stage,
                                            const PipelineCallbacks& callbacks);

}  // namespace bodyloom
