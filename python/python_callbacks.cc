// SPDX-License-Identifier: Apache-2.0
#include "python/python_callbacks.h"

#include <cmath>
#include <string>

#include "geometry/base/check.h"

namespace bodyloom::python {
namespace {

/// Taking the interpreter's lock may wait for another thread's turn, 5 ms; so signals are looked at this often.
constexpr double kSecondsBetweenChecks = 0.02;

}  // namespace

template <typename Call>
bool PythonCallbacks::Keeping(const Call& call) {
  const py::gil_scoped_acquire locked;
  try {
    return call();
  } catch (...) {
    if (!raised_) raised_ = std::current_exception();
    stopped_ = true;
    return false;
  }
}

bool PythonCallbacks::ReportProgress(const std::string& stage, double fraction) {
  const std::lock_guard<std::mutex> one_at_a_time(mutex_);
  const bool has_progress = !progress_.is_none();
  if (stopped_) return false;
  if (!has_progress && watch_.seconds() < next_check_s_) return true;
  next_check_s_ = watch_.seconds() + kSecondsBetweenChecks;
  return Keeping([&] {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!has_progress) return true;
    const py::object answer = progress_(stage, fraction);
    stopped_ = answer.ptr() == Py_False;
    return !stopped_;
  });
}

void PythonCallbacks::Log(const std::string& line) {
  const std::lock_guard<std::mutex> one_at_a_time(mutex_);
  Keeping([&] {
    py::module_::import("logging").attr("getLogger")("bodyloom").attr("warning")("%s", line);
    return true;
  });
}

PipelineCallbacks PythonCallbacks::ForPipeline() {
  PipelineCallbacks callbacks;
  callbacks.progress = [this](const std::string& stage, double fraction) { return ReportProgress(stage, fraction); };
  callbacks.message = [this](const std::string& line) { Log(line); };
  return callbacks;
}

void PythonCallbacks::RethrowRaised() {
  if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
}

std::optional<int> TurnFrom(const TurnArgument& rotate) {
  if (const auto* degrees = std::get_if<int>(&rotate)) return *degrees;
  const auto& word = std::get<std::string>(rotate);
  BODYLOOM_CHECK(word == "auto", "rotate: \"", word, "\", expected 0, 90, 180, 270 or \"auto\"");
  return std::nullopt;
}

double PositiveOr0(const std::optional<double>& value, const char* name) {
  BODYLOOM_CHECK(!value || (*value > 0 && std::isfinite(*value)), name, ": expected a number above 0, found ", *value);
  return value.value_or(0);
}

void TakeCamera(const std::optional<CameraArgument>& argument, TrackSettings* request, GivenInMemory* given) {
  if (!argument) return;
  if (const auto* path = std::get_if<Path>(&*argument)) {
    request->cameras = path->string();
  } else {
    given->camera = std::get<Camera>(*argument);
  }
}

void TakeBody(const std::optional<BodyArgument>& argument, TrackSettings* request, GivenInMemory* given) {
  if (!argument) return;
  if (const auto* path = std::get_if<Path>(&*argument)) {
    request->body = path->string();
  } else {
    given->body = std::get<std::shared_ptr<BodyModel>>(*argument);
  }
}

std::shared_ptr<const BodyModel> BodyToKeep(const TrackSettings& request, GivenInMemory* given) {
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
