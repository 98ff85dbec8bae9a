// SPDX-License-Identifier: Apache-2.0
/// Where a person is in a picture, by the person's landmarks.
#pragma once

#include "bodyloom/data_tools/observations/people.h"

namespace bodyloom {

struct ImageRectangle {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels; empty when x1 < x0
};

/// The rectangle of the landmarks with a confidence of at least ½, or of all that are seen when none has: those below are
/// where the detector would put them if they were seen, which may be far from the person. Empty when none is seen.
ImageRectangle VisibleRectangle(const DetectedPerson& person);

}  // namespace bodyloom
