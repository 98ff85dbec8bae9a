// SPDX-License-Identifier: Apache-2.0
#include "python/request_arguments.h"

#include <cmath>
#include <string>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom::python {

double PositiveOr0(const std::optional<double>& value, const char* name) {
  BODYLOOM_CHECK(!value || (*value > 0 && std::isfinite(*value)), name, ": expected a number above 0, found ", *value);
  return value.value_or(0);
}

void TakeCamera(const std::optional<CameraArgument>& argument, TrackRequest* request, GivenInMemory* given) {
  if (!argument) return;
  if (const auto* path = std::get_if<Path>(&*argument)) {
    request->cameras = path->string();
  } else {
    given->camera = std::get<Camera>(*argument);
  }
}

void TakeBody(const std::optional<BodyArgument>& argument, TrackRequest* request, GivenInMemory* given) {
  if (!argument) return;
  if (const auto* path = std::get_if<Path>(&*argument)) {
    request->body = path->string();
  } else {
    given->body = std::get<std::shared_ptr<BodyModel>>(*argument);
  }
}

std::shared_ptr<const BodyModel> BodyToKeep(const TrackRequest& request, GivenInMemory* given) {
  if (given->body == nullptr && !request.body.empty()) given->body = BodyFrom(BodyArgument(Path(request.body)));
  return given->body;
}

FrameDetectorOptions DetectorFrom(const std::string& detector, const std::optional<Path>& pose_model,
                                  const std::optional<Path>& box_model, const std::optional<Path>& models) {
  FrameDetectorOptions options;
  bool known = false;
  for (const PoseNetworkSize size : {PoseNetworkSize::kLite, PoseNetworkSize::kFull, PoseNetworkSize::kHeavy}) {
    if (ToText(size) != detector) continue;
    options.blazepose.network = size;
    known = true;
  }
  BODYLOOM_CHECK(known, "detector: \"", detector, "\", expected lite, full or heavy");
  options.pose_model = TextOf(pose_model);
  options.box_model = TextOf(box_model);
  options.models = TextOf(models);
  return options;
}

void CheckThreads(int threads) {
  BODYLOOM_CHECK(threads >= 0 && threads <= 256, "threads: expected 0 to 256, found ", threads);
}

}  // namespace bodyloom::python
