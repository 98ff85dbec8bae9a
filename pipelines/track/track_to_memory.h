// SPDX-License-Identifier: Apache-2.0
/// A clip tracked for a program that goes on with the track: as TrackClip(), without files of results.
#pragma once

#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/track/scene_inputs.h"
#include "bodyloom/pipelines/track/track_request.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {

/// The track that TrackClip() would write for this request, to the byte, and how it went; a clip in which nothing can be
/// estimated has the status kFailure with a message. What `given` holds takes the place of the request's files; the
/// request's outputs are not looked at. Throws RequestError for a request that contradicts itself, Cancelled, and
/// std::runtime_error naming a file that cannot be used.
TrackSequenceResult TrackToMemory(const TrackRequest& request, const GivenInMemory& given = {},
                                  const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
