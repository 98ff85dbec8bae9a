// SPDX-License-Identifier: Apache-2.0
/// Photos of a person to a body and a texture (photo_person.h). Nothing is trained and no video is needed.
///
/// Each photo by itself: people are detected and the body is fitted to the person's landmarks and mask. What the fitted
/// photos show becomes the person (photo_person_builder.h).
#pragma once

#include <string>
#include <vector>

#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/person/photo_person.h"
#include "bodyloom/pipelines/track/track_request.h"

namespace bodyloom {

struct PhotoPersonRequest {
  std::vector<std::string> images;  ///< photos of the person, at least one
  /// The body, the detector, the focal length, the person's height and how to solve; `person` is who of a photo, 0: the
  /// largest. Its video, observations and outputs are not used.
  TrackRequest fit;
  int texture_size = 1024;    ///< texels a side, 64 to 8192
  bool loose_garment = true;  ///< look for a skirt, dress or coat
};

/// Throws RequestError for a request that contradicts itself, NothingToTrack naming a photo in which nobody is found or
/// could be fitted, std::runtime_error naming a file that cannot be used, Cancelled.
PhotoPerson MakePhotoPerson(const PhotoPersonRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
