// SPDX-License-Identifier: Apache-2.0
/// `bodyloom detect --dense-model`: DensePose as the detector of pipelines/detect/detect_dense.h.
#pragma once

#include <string>
#include <vector>

#include "neural/densepose/densepose_network.h"
#include "pipelines/detect/detect_dense.h"
#include "pipelines/score/frame_metric.h"

namespace bodyloom {

struct DensePoseDetectorOptions {
  std::string model;           ///< TorchScript file (neural/densepose/densepose_network.h)
  std::string device = "cpu";  ///< "cpu" or "cuda"
  DensePoseColours colours = DensePoseColours::kOfForm;
  int num_threads = 0;  ///< 0: all cores
};

/// Throws as UseNeuralDevice and DensePoseNetwork.
ChartDetector DensePoseDetector(const DensePoseDetectorOptions& options);

// `bodyloom metrics --lpips`: how pictures differ to networks that look at them.

/// LPIPS v0.1 on AlexNet, and tLPIPS of frames that follow another (FramePair::follows). `weights_folder` may be empty,
/// or lack the weights: then a random-feature substitute measures, and its columns are called so. Throws
/// std::runtime_error naming weights that do not fit.
std::vector<FrameMetric> LikenessMetrics(const std::string& weights_folder);

}  // namespace bodyloom
