// SPDX-License-Identifier: Apache-2.0
/// Runs DensePose from a TorchScript file of either published form:
///
/// | form  | given                      | returns                                                                    |
/// |-------|----------------------------|----------------------------------------------------------------------------|
/// | tuple | 3×H×W bytes, RGB           | boxes, coarse, fine, u, v                                                  |
/// | dict  | H×W×3 floats 0..255, BGR   | pred_boxes, pred_densepose_coarse_segm, _fine_segm, _u, _v, and scores     |
///
/// boxes: n×4 (x0, y0, x1, y1) in pixels of the image given; coarse: n×2×h×w logits (n×15×h×w of the oldest networks);
/// fine, u, v: n×25×h×w. The form of a file is determined from its declared types. Sources: LayerNorm's
/// densepose_r50_fpn_dl.torchscript, as comfyui_controlnet_aux calls it (tuple); dajes/DensePose-TorchScript (dict).
///
/// Images are padded to squares at the right and bottom with the networks' mean colour: the dict form swaps width and
/// height when it clips proposals, and would lose people right of x = height. Half floats are converted to floats. The
/// required operators of torchvision are provided (vision_operators.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/scene/label_image.h"
#include "render/image/image.h"

namespace bodyloom {

/// Channel order of the network's input.
enum class DensePoseColours { kOfForm, kRgb, kBgr };

class DensePoseNetwork {
 public:
  /// Loads the file onto the networks' device (neural/base/runtime.h). Throws std::runtime_error with a message of one
  /// line if the file is missing, is not TorchScript, calls an unknown operator, or has neither form.
  explicit DensePoseNetwork(const std::string& path, DensePoseColours colours = DensePoseColours::kOfForm);
  ~DensePoseNetwork();
  DensePoseNetwork(DensePoseNetwork&&) noexcept;
  DensePoseNetwork& operator=(DensePoseNetwork&&) noexcept;

  /// Detects all people in the image, in the network's order, with charts from PasteCharts(); people without a pixel of
  /// any part are left out. Throws std::runtime_error naming the file when the network fails or its output does not
  /// match its form, std::invalid_argument for an empty image. One call at a time.
  [[nodiscard]] std::vector<ChartDetection> Detect(const Image& image) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
