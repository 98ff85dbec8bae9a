// SPDX-License-Identifier: Apache-2.0
/// DensePose as a detector of pipelines/detect/detect_dense.h (`bodyloom detect --dense-model`), and LPIPS metrics.
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

/// Makes the detector. Throws as UseNeuralDevice and DensePoseNetwork.
ChartDetector DensePoseDetector(const DensePoseDetectorOptions& options);

// Perceptual metrics of `bodyloom metrics --lpips`.

/// LPIPS v0.1 on AlexNet, and tLPIPS of consecutive frames (FramePair::follows). Without weights in `weights_folder`,
/// which may be empty, random features are used and the columns are named accordingly. Throws std::runtime_error naming
/// weights that do not fit.
std::vector<FrameMetric> LikenessMetrics(const std::string& weights_folder);

}  // namespace bodyloom
