// SPDX-License-Identifier: Apache-2.0
/// Long work on behalf of Python: the interpreter's lock is released while it runs, and Ctrl-C, the caller's progress
/// function and the log reach it through the pipelines' callbacks.
#pragma once

#include <pybind11/pybind11.h>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_request.h"
#include "python/track_object.h"
#include "tracking/detection/frame_detector.h"

namespace bodyloom::python {

namespace py = pybind11;

/// One call's. Messages go to the logger "bodyloom" as warnings.
class PythonCallbacks {
 public:
  /// `progress(stage, fraction)`, or None. The work is cancelled when it returns False; what it raises is raised out of
  /// Run().
  explicit PythonCallbacks(py::object progress) : progress_(std::move(progress)) {}

  /// work(callbacks) without the interpreter's lock. Afterwards what a callback raised is raised, KeyboardInterrupt
  /// among it, else what the work threw.
  template <typename Work>
  auto Run(const Work& work) {
    using Result = decltype(work(std::declval<const PipelineCallbacks&>()));
    const PipelineCallbacks callbacks = ForPipeline();
    try {
      if constexpr (std::is_void_v<Result>) {
        const py::gil_scoped_release unlocked;
        work(callbacks);
      } else {
        Result result = [&] {
          const py::gil_scoped_release unlocked;
          return work(callbacks);
        }();
        RethrowRaised();
        return result;
      }
    } catch (...) {
      RethrowRaised();
      throw;
    }
    if constexpr (std::is_void_v<Result>) RethrowRaised();
  }

 private:
  [[nodiscard]] PipelineCallbacks ForPipeline();
  bool GoesOn(const std::string& stage, double fraction);
  void Log(const std::string& line);
  /// With the interpreter's lock: calls Python, and keeps what it raises.
  template <typename Call>
  bool Keeping(const Call& call);
  void RethrowRaised();

  py::object progress_;
  std::mutex mutex_;
  Stopwatch watch_;
  double next_check_s_ = 0;
  bool stopped_ = false;
  std::exception_ptr raised_;
};

// How arguments that several functions take become a request for tracks.

using CameraArgument = std::variant<Camera, Path>;

/// The number given, checked; 0 when there is none.
double PositiveOr0(const std::optional<double>& value, const char* name);

/// A file is named in the request, an object is given.
void TakeCamera(const std::optional<CameraArgument>& argument, TrackSettings* request, GivenInMemory* given);
void TakeBody(const std::optional<BodyArgument>& argument, TrackSettings* request, GivenInMemory* given);

/// The body in memory that a track is of, so that what is asked of it later finds it; the request's file is read, and
/// given from then on. Null: the built-in one.
std::shared_ptr<const BodyModel> BodyToKeep(const TrackSettings& request, GivenInMemory* given);

/// What detects people: networks of BlazePose ("lite", "full", "heavy") or of the user's own.
FrameDetectorOptions DetectorFrom(const std::string& detector, const std::optional<Path>& pose_model,
                                  const std::optional<Path>& box_model, const std::optional<Path>& models);

/// Throws std::invalid_argument for a number of threads that cannot be.
void CheckThreads(int threads);

}  // namespace bodyloom::python
