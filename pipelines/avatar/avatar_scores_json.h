// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bodyloom/pipelines/avatar/avatar_scores.h"

namespace bodyloom {

/// {"frames", "psnr_box_db", …}, as the fields are named, and "ssim_preset".
nlohmann::ordered_json ToJson(const AvatarScores& scores);

}  // namespace bodyloom
