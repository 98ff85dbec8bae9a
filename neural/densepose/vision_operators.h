// SPDX-License-Identifier: Apache-2.0
/// Operators of torchvision that exported detectors call, implemented here because Debian has no such library.
/// Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

/// Greedy non-maximum suppression: boxes (n×4: x0, y0, x1, y1) by descending score, equal ones in their order; each is
/// kept unless its intersection over union with one kept before exceeds `iou_threshold`. Returns the indices kept
/// (int64), in that order, on the boxes' device. Throws c10::Error for shapes that do not fit each other.
torch::Tensor NonMaximumSuppression(const torch::Tensor& boxes, const torch::Tensor& scores, double iou_threshold);

/// RoIAlign (He et al., Mask R-CNN, ICCV 2017): for each region (k×5: index in the batch, x0, y0, x1, y1, times
/// `spatial_scale` in cells of the features) pooled_height × pooled_width means of features (N×C×H×W), each over a grid
/// of bilinear samples: sampling_ratio² of them, or with sampling_ratio <= 0 ⌈side/pooled side⌉ per axis. `aligned`
/// shifts regions by half a cell, so that cell centres lie at integers; without it a side is at least one cell. Samples
/// more than a cell outside the features are 0. Returns k×C×pooled_height×pooled_width in the features' type, on their
/// device; computed on the CPU. Throws c10::Error for shapes that do not fit.
torch::Tensor RegionAlign(const torch::Tensor& features, const torch::Tensor& regions, double spatial_scale,
                          int64_t pooled_height, int64_t pooled_width, int64_t sampling_ratio, bool aligned);

/// Registers the two with TorchScript as torchvision::nms and torchvision::roi_align, unless they are registered
/// already. May be called repeatedly.
void RegisterVisionOperators();

}  // namespace bodyloom
