// SPDX-License-Identifier: Apache-2.0
/// What the clothes parser learns from: the pictures of a multi-person dataset, as users' photos are fitted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bodyloom/neural/pictures/packed_picture.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

struct ParserPicturesRequest {
  std::string data;          ///< a multi-person dataset
  std::string body;          ///< empty: the built-in body
  bool test = false;         ///< the people kept for testing, instead of those to train on
  int size = 512;            ///< of the windows
  double body_error_px = 4;  ///< bodies are off by up to this, each clip by its own: PeopleDataRequest
  uint64_t seed = 1;         ///< of those errors
  int threads = 1;
};

/// Masks are found by GrabCut around the bodies, which are not quite right. Planes of kParserPlanes, truth of ParserTruth;
/// person by person, the same for any number of threads. Frames whose body is not known are left out. Throws as
/// PeopleData, Cancelled; the stage of `callbacks` is `stage`.
std::vector<PackedPicture> ParserPicturesOf(const ParserPicturesRequest& request, const char* stage,
                                            const PipelineCallbacks& callbacks);

}  // namespace bodyloom
