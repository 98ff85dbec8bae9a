// SPDX-License-Identifier: Apache-2.0
#include "neural/base/image_tensor.h"

#include <algorithm>
#include <cstdlib>

#include "geometry/base/check.h"

namespace bodyloom {

torch::Tensor ToTensor(const Image& image) {
  BODYLOOM_CHECK(!image.empty(), "image tensor: an empty image");
  const torch::Tensor bytes =
      torch::from_blob(const_cast<uint8_t*>(image.bgr.data()), {image.height, image.width, 3}, torch::kByte);
  return bytes.flip(2).permute({2, 0, 1}).unsqueeze(0).to(torch::kFloat).contiguous().div_(255);
}

Image ToImage(const torch::Tensor& rgb) {
  torch::Tensor planes = rgb.dim() == 4 && rgb.size(0) == 1 ? rgb[0] : rgb;
  BODYLOOM_CHECK(planes.dim() == 3 && planes.size(0) == 3 && planes.numel() > 0, "image tensor: shape ", rgb.sizes(),
                 ", expected 3 x H x W");
  planes = torch::nan_to_num(planes.detach().to(torch::kCPU, torch::kFloat)).clamp(0, 1);
  const torch::Tensor bytes = (planes * 255 + 0.5).to(torch::kByte).permute({1, 2, 0}).flip(2).contiguous();
  Image image;
  image.width = static_cast<int>(planes.size(2));
  image.height = static_cast<int>(planes.size(1));
  image.bgr.assign(bytes.data_ptr<uint8_t>(), bytes.data_ptr<uint8_t>() + bytes.numel());
  return image;
}

torch::Tensor Shifted(const torch::Tensor& image, int x, int y) {
  if (x == 0 && y == 0) return image;
  const int64_t h = image.size(2), w = image.size(3), dx = std::abs(x), dy = std::abs(y);
  torch::Tensor result = torch::zeros_like(image);
  if (dx >= w || dy >= h) return result;
  const int64_t from_x = std::max(0, -x), from_y = std::max(0, -y), to_x = std::max(0, x), to_y = std::max(0, y);
  result.slice(2, to_y, to_y + h - dy)
      .slice(3, to_x, to_x + w - dx)
      .copy_(image.slice(2, from_y, from_y + h - dy).slice(3, from_x, from_x + w - dx));
  return result;
}

}  // namespace bodyloom
