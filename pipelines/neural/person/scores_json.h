// SPDX-License-Identifier: Apache-2.0
/// JSON of the scores of people rendered from photos.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "neural/metrics/person_scores.h"

namespace bodyloom {

/// One object, without SSIM; feature-based scores are named after the network that computed them.
nlohmann::ordered_json ToJson(const PersonScores& scores);

}  // namespace bodyloom
