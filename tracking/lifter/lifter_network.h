// SPDX-License-Identifier: Apache-2.0
/// Runs the lifter (geometry/scene/lifter_weights.h) with plain matrix products: about a million of them a frame.
#pragma once

#include "geometry/math/arrays.h"
#include "geometry/scene/lifter_weights.h"

namespace bodyloom {

/// Returns T×LifterOutput::kSize for T×num_inputs features of consecutive frames, padded with zeros at the ends as in
/// training. `last_frames` n > 0: only the last n rows and what they depend on are computed; they equal those of the
/// whole. Throws std::invalid_argument when the features have another number of columns.
RowMatrixXf RunLifter(const LifterWeights& weights, const RowMatrixXf& features, int last_frames = 0);

}  // namespace bodyloom
