// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bodyloom/pipelines/neural/motion/clip_scores.h"

namespace bodyloom {

nlohmann::ordered_json ToJson(const ClipScores& scores);

}  // namespace bodyloom
