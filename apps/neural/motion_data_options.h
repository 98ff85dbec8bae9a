// SPDX-License-Identifier: Apache-2.0
/// Options of `bodyloom train motion` that say what is trained on.
#pragma once

#include "bodyloom/pipelines/neural/motion/motion_data.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// --data, --track, --body, --iuv, --mask, --part-labels.
void AddMotionDataOptions(CLI::App* verb, MotionDataRequest* request);

}  // namespace bodyloom
