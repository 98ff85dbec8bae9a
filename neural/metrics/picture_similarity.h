// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "bodyloom/render/image.h"

namespace bodyloom {

/// SSIM of two pictures of the same size; the caller says which one (neural/ knows no evaluation library). Empty: not
/// measured.
using PictureSimilarity = std::function<double(const Image& truth, const Image& result)>;

}  // namespace bodyloom
