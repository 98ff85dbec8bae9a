// SPDX-License-Identifier: Apache-2.0
/// DensePose as a TorchScript file, in the two forms that are passed around:
///
/// | form  | given                      | returns                                                                    |
/// |-------|----------------------------|----------------------------------------------------------------------------|
/// | tuple | 3×H×W bytes, RGB           | boxes, coarse, fine, u, v                                                  |
/// | dict  | H×W×3 floats 0..255, BGR   | pred_boxes, pred_densepose_coarse_segm, _fine_segm, _u, _v, and scores     |
///
/// boxes: n×4 (x0, y0, x1, y1) in pixels of the picture given; coarse: n×2×h×w logits (n×15×h×w of the oldest
/// networks); fine, u, v: n×25×h×w. Which form a file has is read from its declared types. Sources: LayerNorm's
/// densepose_r50_fpn_dl.torchscript, as comfyui_controlnet_aux calls it (tuple); dajes/DensePose-TorchScript (dict).
///
/// Pictures are given as squares, filled at the right and bottom with the networks' mean colour: the dict form confuses
/// width and height when it clips proposals, and would lose whoever stands right of x = height. Half floats become
/// floats. The operators of torchvision that such files call come with us (vision_operators.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/scene/label_image.h"
#include "render/image/image.h"

namespace bodyloom {

/// Order of the colours in which pictures are given to the network.
enum class DensePoseColours { kOfForm, kRgb, kBgr };

class DensePoseNetwork {
 public:
  /// Loads onto the networks' device (neural/base/runtime.h). Throws std::runtime_error in one line: the file is not
  /// there, is no TorchScript, calls an operator that is not here, or has neither form.
  explicit DensePoseNetwork(const std::string& path, DensePoseColours colours = DensePoseColours::kOfForm);
  ~DensePoseNetwork();
  DensePoseNetwork(DensePoseNetwork&&) noexcept;
  DensePoseNetwork& operator=(DensePoseNetwork&&) noexcept;

  /// Everybody in the picture, in the network's order, with charts as PasteCharts() lays them; people in none of whose
  /// pixels a part is seen are left out. Throws std::runtime_error naming the file when the network fails or returns
  /// what its form does not say, std::invalid_argument for an empty picture. One call at a time.
  [[nodiscard]] std::vector<ChartDetection> Detect(const Image& picture) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
