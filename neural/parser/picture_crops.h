// SPDX-License-Identifier: Apache-2.0
/// Batches of crops of packed pictures, each in a light of its own. Internal: includes LibTorch.
///
/// Half of the crops lie around a pixel that tells much (where classes meet), the others
/// anywhere. What a batch holds depends on the seed and its number alone.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "neural/parser/packed_picture.h"

namespace bodyloom {

struct CropRequest {
  int planes = 0, truth = 0;  ///< of the pictures
  int side = 0, batch = 0;    ///< pixels of a crop, a multiple of kPictureUnetMultiple; crops
  uint64_t seed = 1;
  double light_strength = 1;                                           ///< 0: colours as they are
  std::function<bool(const PackedPicture&, size_t pixel)> tells_much;  ///< of a pixel
};

struct CropBatch {
  torch::Tensor bytes;   ///< B × (planes + truth) × side × side
  torch::Tensor lights;  ///< B × 3 × 3: colours are to be multiplied by it (Lit())
};

/// Number `step` of the batches. Where a picture ends within a crop nothing is drawn, and truth is 0.
CropBatch MakeCrops(const std::vector<PackedPicture>& pictures, const CropRequest& request, int step);

/// Colours B×3×H×W by the lights: brightness, each channel's own gain, and how much of the other channels comes in
/// (saturation, hue); within 0 and 1.
torch::Tensor Lit(const torch::Tensor& colours, const torch::Tensor& lights);

/// A whole picture as a batch of one, without lights.
torch::Tensor BytesOf(const PackedPicture& picture, int planes, int truth);

struct PlanesAndTruth {
  torch::Tensor planes;  ///< numbers
  torch::Tensor truth;   ///< bytes
};

/// Bytes to numbers, on the networks' device.
class PlaneUnpacker {
 public:
  explicit PlaneUnpacker(int planes);
  [[nodiscard]] PlanesAndTruth operator()(const torch::Tensor& bytes) const;

 private:
  torch::Tensor offsets_, scales_;
};

/// Throws std::invalid_argument naming `what` for a picture whose sides are not multiples of kPictureUnetMultiple or
/// whose bytes are not of its size.
void CheckPicture(const PackedPicture& picture, int planes, int truth, const char* what);

}  // namespace bodyloom
