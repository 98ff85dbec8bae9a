// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/image_tensor.h"

#include <cstring>

#include "bodyloom/geometry/base/check.h"

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

}  // namespace bodyloom
