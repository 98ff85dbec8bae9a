// SPDX-License-Identifier: Apache-2.0
/// How arguments that several functions take become a request for tracks.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "bodyloom/data_tools/detection/frame_detector.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/pipelines/track/scene_inputs.h"
#include "bodyloom/pipelines/track/track_request.h"
#include "python/track_object.h"

namespace bodyloom::python {

using CameraArgument = std::variant<Camera, Path>;

/// The number given, checked; 0 when there is none.
double PositiveOr0(const std::optional<double>& value, const char* name);

/// A file is named in the request, an object is given.
void TakeCamera(const std::optional<CameraArgument>& argument, TrackRequest* request, GivenInMemory* given);
void TakeBody(const std::optional<BodyArgument>& argument, TrackRequest* request, GivenInMemory* given);

/// The body in memory that a track is of, so that what is asked of it later finds it; the request's file is read, and
/// given from then on. Null: the built-in one.
std::shared_ptr<const BodyModel> BodyToKeep(const TrackRequest& request, GivenInMemory* given);

/// What detects people: networks of BlazePose ("lite", "full", "heavy") or of the user's own.
FrameDetectorOptions DetectorFrom(const std::string& detector, const std::optional<Path>& pose_model,
                                  const std::optional<Path>& box_model, const std::optional<Path>& models);

/// Throws std::invalid_argument for a number of threads that cannot be.
void CheckThreads(int threads);

}  // namespace bodyloom::python
