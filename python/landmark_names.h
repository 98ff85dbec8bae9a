// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace bodyloom::python {

/// The name of a convention (data_tools/observations/keypoint_conventions.h), or a list of landmarks.
using LandmarkNames = std::variant<std::string, std::vector<std::string>>;

/// The convention's name and its landmarks; "custom" for a list. Throws std::invalid_argument for a name that there is
/// not, and for a list that is empty or names a landmark twice.
std::pair<std::string, std::vector<std::string>> ConventionFrom(const LandmarkNames& names);

}  // namespace bodyloom::python
