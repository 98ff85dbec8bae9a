// SPDX-License-Identifier: Apache-2.0
/// The parts of the module, one a file: each adds its names, in the order in which they need each other.
#pragma once

#include <pybind11/pybind11.h>

namespace bodyloom::python {

void BindKeypoints(pybind11::module_& module);
void BindCamera(pybind11::module_& module);
void BindBody(pybind11::module_& module);
void BindTrack(pybind11::module_& module);
void BindTracking(pybind11::module_& module);
void BindPeople(pybind11::module_& module);
void BindLive(pybind11::module_& module);
void BindDescriptors(pybind11::module_& module);
void BindRendering(pybind11::module_& module);
void BindPerson(pybind11::module_& module);
void BindAvatar(pybind11::module_& module);
void BindResults(pybind11::module_& module);

}  // namespace bodyloom::python
