// SPDX-License-Identifier: Apache-2.0
/// Scores of the pose-guided renderer in a report.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bodyloom/neural/guided/guided_scores.h"

namespace bodyloom {

/// One object; what features measured is named for it.
nlohmann::ordered_json ToJson(const GuidedScores& scores);

}  // namespace bodyloom
