// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "bodyloom/pipelines/people/motion_errors.h"

namespace bodyloom {

/// [{"least_similarity": …, "image_l1": …, "ssim": …, "lpips": …, "tlpips": …, "frames": …}, …]; null: not measured
nlohmann::ordered_json ToJson(const std::vector<MotionErrors::Quarter>& quarters);

}  // namespace bodyloom
