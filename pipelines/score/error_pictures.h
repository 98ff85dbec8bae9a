// SPDX-License-Identifier: Apache-2.0
/// Pictures of where a picture differs from the truth.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/pipelines/score/frame_metric.h"
#include "bodyloom/render/error_colours.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// Distance of two pictures of one size, pixel by pixel, in grey levels: √(mean over the three channels of (a − b)²), 0
/// to 255. The mean of its square is the MSE of psnr_db. Throws std::invalid_argument when the sizes differ.
std::vector<float> PixelErrors(const Image& truth, const Image& result);

/// Truth, result and their distance side by side, each at its own size under its name, and the legend of the colours
/// below the distance.
Image ErrorPicture(const Image& truth, const Image& result, const ErrorScale& scale);

/// A metric without columns that writes the ErrorPicture of every frame to FOLDER/NAME.png, the last colour at
/// `maximum` grey levels.
FrameMetric ErrorPictures(const std::string& folder, double maximum);

}  // namespace bodyloom
