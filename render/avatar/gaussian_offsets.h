// SPDX-License-Identifier: Apache-2.0
/// What a network adds to a person's Gaussians for one frame.
#pragma once

#include "bodyloom/render/splat/float_columns.h"

namespace bodyloom {

struct GaussianOffsets {
  enum Column : int { kPosition = 0, kLogScale = 3, kOpacityLogit = 6, kAlbedo = 7, kNumColumns = 10 };
  FloatColumns columns;  ///< a row a Gaussian; without columns: nothing is added
};

}  // namespace bodyloom
