// SPDX-License-Identifier: Apache-2.0
/// Long work on behalf of Python: the interpreter's lock is released while it runs, and Ctrl-C, the caller's progress
/// function and the log reach it through the pipelines' callbacks.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <mutex>
#include <string>
#include <utility>

#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom::python {

namespace py = pybind11;

/// One call's. Messages go to the logger "bodyloom" as warnings.
class PythonCallbacks {
 public:
  /// `progress(stage, fraction)`, or None. The work is cancelled when it returns False; what it raises is raised out of
  /// Run().
  explicit PythonCallbacks(py::object progress) : progress_(std::move(progress)) {}

  /// work(callbacks) without the interpreter's lock. Afterwards what a callback raised is raised, KeyboardInterrupt among
  /// it, else what the work threw.
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

}  // namespace bodyloom::python
