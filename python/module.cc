// SPDX-License-Identifier: Apache-2.0
// The Python module bodyloom._bodyloom; python/bodyloom/__init__.py hands its names on. docs/python.md.
#include <pybind11/pybind11.h>

#include "geometry/base/callbacks.h"
#include "python/bindings.h"

PYBIND11_MODULE(_bodyloom, module) {
  using namespace bodyloom::python;
  module.doc() = "Bodyloom's libraries for NumPy.";
  module.attr("__version__") = BODYLOOM_VERSION;
  pybind11::register_exception<bodyloom::Cancelled>(module, "Cancelled", PyExc_RuntimeError).doc() =
      "The progress function returned False. Nothing half-written is left.";
  BindKeypoints(module);
  BindCamera(module);
  BindBody(module);
  BindTrack(module);
  BindTracking(module);
  BindViews(module);
  BindPeople(module);
  BindLive(module);
  BindDescriptors(module);
  BindRendering(module);
  BindPerson(module);
  BindAvatar(module);
  BindResults(module);
  BindGait(module);
}
