// SPDX-License-Identifier: Apache-2.0
#include "python/python_callbacks.h"

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

bool PythonCallbacks::GoesOn(const std::string& stage, double fraction) {
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
  callbacks.progress = [this](const std::string& stage, double fraction) { return GoesOn(stage, fraction); };
  callbacks.message = [this](const std::string& line) { Log(line); };
  return callbacks;
}

void PythonCallbacks::RethrowRaised() {
  if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
}

}  // namespace bodyloom::python
