// SPDX-License-Identifier: Apache-2.0
/// The body of a person in a photo: people are detected, and the body is fitted to one's landmarks and mask.
#pragma once

#include <memory>
#include <string>

#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/person/photo_person_builder.h"
#include "bodyloom/pipelines/track/track_request.h"

namespace bodyloom {

/// The person of the photo at `path`; `body` becomes what was fitted. `fit`: the body, the detector, the focal length, the
/// person's height and how to solve; `person` is who of a photo, 0: the largest. Its video, observations and outputs are
/// not used. `clock` times the stages "read", "detect" and "fit". Throws RequestError for a request that contradicts
/// itself, NothingToTrack naming a photo in which nobody is found or could be fitted, std::runtime_error naming a file that
/// cannot be used, Cancelled.
FittedPhoto FitPhoto(const TrackRequest& fit, const std::string& path, const PipelineCallbacks& callbacks,
                     StageClock* clock, std::shared_ptr<const BodyModel>* body);

}  // namespace bodyloom
