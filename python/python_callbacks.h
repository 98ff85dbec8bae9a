// SPDX-License-Identifier: Apache-2.0
/// Runs long jobs called from Python: releases the GIL while they run, and connects Ctrl-C, the caller's progress
/// function and the log to the pipelines' callbacks.
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

/// Callbacks of one call. Messages are logged as warnings to the logger "bodyloom".
class PythonCallbacks {
 public:
  /// `progress(stage, fraction)`, or None. The job is cancelled when it returns False; exceptions it raises are
  /// rethrown by Run().
  explicit PythonCallbacks(py::object progress) : progress_(std::move(progress)) {}

  /// Runs work(callbacks) without the GIL. Afterwards rethrows what a callback raised, including KeyboardInterrupt, or
  /// else what the job threw.
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
  bool ReportProgress(const std::string& stage, double fraction);
  void Log(const std::string& line);
  /// Calls Python with the GIL held and stores what it raises.
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

// Conversion of arguments shared by several functions to requests for tracks.

using CameraArgument = std::variant<Camera, Path>;

/// The given number, which must be positive; 0 if there is none.
double PositiveOr0(const std::optional<double>& value, const char* name);

/// A clockwise turn in degrees, or "auto", which gives none. Throws std::invalid_argument for another text.
using TurnArgument = std::variant<int, std::string>;
std::optional<int> TurnFrom(const TurnArgument& rotate);

/// A path is stored in the request, an object in `given`.
void TakeCamera(const std::optional<CameraArgument>& argument, TrackSettings* request, GivenInMemory* given);
void TakeBody(const std::optional<BodyArgument>& argument, TrackSettings* request, GivenInMemory* given);

/// The body of a track, loaded so that the track can keep it: the request's file is read and replaced by an object in
/// `given`. Null: the built-in one.
std::shared_ptr<const BodyModel> BodyToKeep(const TrackSettings& request, GivenInMemory* given);

/// Options of the people detector: networks of BlazePose ("lite", "full", "heavy") or of the user.
FrameDetectorOptions DetectorFrom(const std::string& detector, const std::optional<Path>& pose_model,
                                  const std::optional<Path>& box_model, const std::optional<Path>& models);

/// Throws std::invalid_argument for an invalid number of threads.
void CheckThreads(int threads);

}  // namespace bodyloom::python
