// SPDX-License-Identifier: Apache-2.0
/// Which joints move a vertex, from its skinning weights.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

/// V: the joint with the largest skinning weight; of equals the first.
std::vector<int> StrongestJoints(const BodyModel& body);

/// V: the sum of the weights of the named joints and of all that hang on them, in [0, 1]. Names that the body lacks count
/// for nothing.
std::vector<double> WeightsBelow(const BodyModel& body, const std::vector<std::string>& joints);

}  // namespace bodyloom
