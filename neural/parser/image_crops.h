// SPDX-License-Identifier: Apache-2.0
/// Batches of random crops of packed images with random lights. Internal: includes LibTorch.
///
/// Half of the crops contain an informative pixel (where classes meet), the others are anywhere. A batch depends only
/// on the seed and its number.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "neural/parser/packed_image.h"

namespace bodyloom {

struct CropRequest {
  int planes = 0, truth = 0;  ///< of the images
  int side = 0, batch = 0;    ///< pixels of a crop, a multiple of kImageUnetMultiple; crops
  uint64_t seed = 1;
  double light_strength = 1;                                         ///< 0: colours are unchanged
  std::function<bool(const PackedImage&, size_t pixel)> tells_much;  ///< true for informative pixels
};

struct CropBatch {
  torch::Tensor bytes;   ///< B × (planes + truth) × side × side
  torch::Tensor lights;  ///< B × 3 × 3: matrices applied to colours (Lit())
};

/// Creates batch number `step`. Pixels of a crop outside the image are empty, with truth 0.
CropBatch MakeCrops(const std::vector<PackedImage>& images, const CropRequest& request, int step);

/// Applies lights to colours B×3×H×W: brightness, a gain per channel, and mixing of channels (saturation, hue); clamped
/// to [0, 1].
torch::Tensor Lit(const torch::Tensor& colours, const torch::Tensor& lights);

/// Converts a whole image to a batch of one, without lights.
torch::Tensor BytesOf(const PackedImage& image, int planes, int truth);

struct PlanesAndTruth {
  torch::Tensor planes;  ///< floats
  torch::Tensor truth;   ///< bytes
};

/// Converts bytes to floats on the networks' device.
class PlaneUnpacker {
 public:
  explicit PlaneUnpacker(int planes);
  [[nodiscard]] PlanesAndTruth operator()(const torch::Tensor& bytes) const;

 private:
  torch::Tensor offsets_, scales_;
};

/// Throws std::invalid_argument naming `what` for an image whose sides are not multiples of kImageUnetMultiple or whose
/// bytes are not of its size.
void CheckImage(const PackedImage& image, int planes, int truth, const char* what);

}  // namespace bodyloom
