// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/track/track_to_memory.h"

#include <string>

#include "bodyloom/pipelines/track/solve_track.h"
#include "bodyloom/pipelines/track/track_inputs.h"

namespace bodyloom {
namespace {

/// What is given in memory counts as named, under these names in messages.
TrackRequest NamedRequest(TrackRequest request, const GivenInMemory& given) {
  if (given.keypoints != nullptr) request.detections = "keypoints";
  if (given.camera) request.cameras = "camera";
  request.out = "track";
  request.overlay = request.json = request.report = request.reference = "";
  request.plan = request.side_view = false;
  return request;
}

}  // namespace

TrackSequenceResult TrackToMemory(const TrackRequest& request, const GivenInMemory& given,
                                  const PipelineCallbacks& callbacks) {
  const TrackRequest named = NamedRequest(request, given);
  CheckTrackRequest(named);
  TrackRequest files = named;
  if (given.keypoints != nullptr) files.detections = "";
  if (given.camera) files.cameras = "";
  RequireTrackInputs(files);
  const TrackInputs inputs = LoadTrackInputs(named, callbacks, given);
  callbacks.Begin("tracking " + std::to_string(inputs.num_frames()) + " frames");
  return SolveTrack(named, inputs, callbacks);
}

}  // namespace bodyloom
