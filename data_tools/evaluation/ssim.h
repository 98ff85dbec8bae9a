// SPDX-License-Identifier: Apache-2.0
/// SSIM as named presets: implementations of "SSIM" differ in window, covariance, range and border, and by more than
/// the differences they are used to show. Users of each: docs/image_metrics.md.
///
/// At every window position, with weights w that sum to 1 and μ, σ², σ_ab the weighted moments there,
///   SSIM = (2 μ_a μ_b + C1)(2 σ_ab + C2) / ((μ_a² + μ_b² + C1)(σ_a² + σ_b² + C2)),  C1 = (0.01 L)², C2 = (0.03 L)²;
/// the SSIM of an image is the mean over positions, then over channels. "Sample" covariance is multiplied by N/(N − 1),
/// N the number of pixels in the window.
///
/// | preset     | window               | covariance | L                              | positions                 |
/// | wang2004   | Gaussian σ 1.5, 11²  | population | white                          | window inside the image   |
/// | skimage7   | uniform 7²           | sample     | white                          | inside                    |
/// | patn       | Gaussian σ 1.5, 11²  | population | max − min of the result        | inside                    |
/// | gfla51     | uniform 51²          | sample     | white                          | inside                    |
/// | neuralbody | uniform 7²           | sample     | 2 white                        | inside the mask's box     |
/// | 3dgs       | Gaussian σ 1.5, 11²  | population | white                          | every pixel, zeros around |
/// | piq        | Gaussian σ 1.5, 11²  | population | white                          | inside, after averaging   |
/// |            |                      |            |                                | f² pixels into one        |
/// f = round(min(width, height) / 256), halves to even, at least 1; left-over rows and columns are dropped.
/// Source: Wang et al., IEEE TIP 13(4), 2004; scikit-image structural_similarity; the programs named.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data_tools/evaluation/image_metrics.h"

namespace bodyloom {

enum class SsimPreset { kWang2004, kSkimage7, kPatn, kGfla51, kNeuralBody, k3dgs, kPiq };

/// "wang2004", …, in the order of the enumeration.
std::vector<std::string> SsimPresetNames();
std::string ToText(SsimPreset preset);
std::optional<SsimPreset> SsimPresetFrom(std::string_view name);

/// Smallest width and height that a preset takes (11, 7, 51, 1 for 3dgs).
int SsimMinimumSize(SsimPreset preset);

/// `white` is the value of white: 255 for bytes, 1 for images in [0, 1]. `mask` is used by neuralbody alone, which
/// compares the box around it (nullptr: the whole image). Computed in double, in O(pixels · taps) for Gaussian windows
/// and O(pixels) for uniform ones; 1 for equal images, at most 1. NaN when the result's range is 0 (patn), the mask's
/// box is smaller than the window (neuralbody), or a value is not finite. Throws std::invalid_argument when sizes
/// differ or are below SsimMinimumSize, or there is no channel.
double Ssim(const PlanarImage& truth, const PlanarImage& result, SsimPreset preset, double white,
            const PixelMask* mask = nullptr);
/// The same on bytes, white 255.
double Ssim(const Image& truth, const Image& result, SsimPreset preset, const PixelMask* mask = nullptr);

}  // namespace bodyloom
