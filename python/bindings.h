// SPDX-License-Identifier: Apache-2.0
/// Parts of the Python module, one per file, in the order in which they depend on each other.
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
void BindViews(pybind11::module_& module);
void BindPeople(pybind11::module_& module);
void BindLive(pybind11::module_& module);
void BindDescriptors(pybind11::module_& module);
void BindRendering(pybind11::module_& module);
void BindPerson(pybind11::module_& module);
void BindAvatar(pybind11::module_& module);
void BindResults(pybind11::module_& module);
void BindGait(pybind11::module_& module);

/// Name of a convention (data_tools/observations/keypoint_conventions.h), or a list of landmarks.
using LandmarkNames = std::variant<std::string, std::vector<std::string>>;

/// The convention's name and its landmarks; "custom" for a list. Throws std::invalid_argument for an unknown name, and
/// for a list that is empty or has duplicates.
std::pair<std::string, std::vector<std::string>> ConventionFrom(const LandmarkNames& names);

}  // namespace bodyloom::python
