// SPDX-License-Identifier: Apache-2.0
/// `bodyloom detect --dense-model`: DensePose as the detector of pipelines/detect/detect_dense.h.
#pragma once

#include <string>

#include "bodyloom/neural/densepose/densepose_network.h"
#include "bodyloom/pipelines/detect/detect_dense.h"

namespace bodyloom {

struct DensePoseDetectorOptions {
  std::string model;           ///< TorchScript file (neural/densepose/densepose_network.h)
  std::string device = "cpu";  ///< "cpu" or "cuda"
  DensePoseColours colours = DensePoseColours::kOfForm;
  int num_threads = 0;  ///< 0: all cores
};

/// Throws as UseNeuralDevice and DensePoseNetwork.
ChartDetector DensePoseDetector(const DensePoseDetectorOptions& options);

}  // namespace bodyloom
