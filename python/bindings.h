// SPDX-License-Identifier: Apache-2.0
/// The parts of the module, one a file: each adds its names, in the order in which they need each other.
#pragma once

#include <pybind11/pybind11.h>
#include <string>
#include <utility>
#include <variant>
#include <vector>

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

/// The name of a convention (data_tools/observations/keypoint_conventions.h), or a list of landmarks.
using LandmarkNames = std::variant<std::string, std::vector<std::string>>;

/// The convention's name and its landmarks; "custom" for a list. Throws std::invalid_argument for a name that there is
/// not, and for a list that is empty or names a landmark twice.
std::pair<std::string, std::vector<std::string>> ConventionFrom(const LandmarkNames& names);

}  // namespace bodyloom::python
