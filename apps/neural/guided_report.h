// SPDX-License-Identifier: Apache-2.0
/// The lines of `bodyloom animate guided`.
#pragma once

#include "bodyloom/pipelines/neural/guided/animate_guided.h"

namespace bodyloom {

void Print(const AnimateGuidedSummary& summary, const AnimateGuidedRequest& request);

}  // namespace bodyloom
