// SPDX-License-Identifier: Apache-2.0
/// Scores of people rendered from photos, in a report.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "neural/metrics/person_scores.h"

namespace bodyloom {

/// One object, without SSIM; what features measured is named for it.
nlohmann::ordered_json ToJson(const PersonScores& scores);

}  // namespace bodyloom
