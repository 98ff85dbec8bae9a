// SPDX-License-Identifier: Apache-2.0
#include "neural/parser/image_crops.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "neural/base/device.h"
#include "render/image/parser_weights.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr int kTries = 64;  ///< to find an informative pixel

void DrawLight(uint64_t hash, double strength, float* matrix) {
  const auto next = [&hash] {
    hash = Mix(hash);
    return 2 * UniformOf(hash) - 1;
  };
  const double brightness = std::exp(0.5 * strength * next());
  for (int r = 0; r < 3; ++r) {
    const double gain = brightness * std::exp(0.3 * strength * next());
    double others = 0;
    for (int c = 0; c < 3; ++c) {
      if (c == r) continue;
      const double share = 0.3 * strength * next();
      matrix[3 * r + c] = static_cast<float>(gain * share);
      others += share;
    }
    matrix[3 * r + r] = static_cast<float>(gain * (1 - others));
  }
}

/// Start of a crop along one axis: the crop lies inside the image or, if the image is smaller, contains it.
int CropStart(int centre, int side, int size) {
  const int start = centre - side / 2;
  return size <= side ? std::clamp(start, size - side, 0) : std::clamp(start, 0, size - side);
}

/// Finds an informative pixel; −1 if none was found.
int64_t TellingPixel(const PackedImage& image, const CropRequest& request, uint64_t hash) {
  for (int i = 0; i < kTries; ++i) {
    hash = Mix(hash);
    const size_t p = hash % image.pixels();
    if (request.tells_much(image, p)) return static_cast<int64_t>(p);
  }
  return -1;
}

void CopyCrop(const std::vector<uint8_t>& from, int planes, const PackedImage& image, int x0, int y0, int side,
              uint8_t* to) {
  for (int p = 0; p < planes; ++p) {
    for (int y = std::max(0, -y0); y < std::min(side, image.height - y0); ++y) {
      const int x = std::max(0, -x0), end = std::min(side, image.width - x0);
      const size_t row = p * image.pixels() + static_cast<size_t>(y0 + y) * image.width;
      std::memcpy(to + (static_cast<size_t>(p) * side + y) * side + x, from.data() + row + x0 + x, end - x);
    }
  }
}

/// Fills bytes with the values of empty pixels.
void FillEmpty(const CropRequest& request, uint8_t* to) {
  const size_t pixels = static_cast<size_t>(request.side) * request.side;
  for (int p = 0; p < request.planes; ++p) std::memset(to + p * pixels, PackPlane(p, 0), pixels);
  std::memset(to + request.planes * pixels, 0, request.truth * pixels);
}

}  // namespace

CropBatch MakeCrops(const std::vector<PackedImage>& images, const CropRequest& request, int step) {
  const int side = request.side, together = request.planes + request.truth;
  const size_t numbers = static_cast<size_t>(together) * side * side;
  CropBatch crops = {torch::empty({request.batch, together, side, side}, torch::kUInt8),
                     torch::empty({request.batch, 3, 3})};
  for (int b = 0; b < request.batch; ++b) {
    uint64_t hash = Mix(Mix(request.seed) ^ (static_cast<uint64_t>(step) * request.batch + b));
    const PackedImage& image = images[hash % images.size()];
    hash = Mix(hash);
    int64_t centre = hash % 2 == 0 ? TellingPixel(image, request, hash) : -1;
    hash = Mix(hash);
    if (centre < 0) centre = static_cast<int64_t>(hash % image.pixels());
    hash = Mix(hash);
    const int jitter = side / 2, dx = static_cast<int>(hash % jitter) - jitter / 2,
              dy = static_cast<int>((hash >> 32) % jitter) - jitter / 2;
    const int x0 = CropStart(static_cast<int>(centre % image.width) + dx, side, image.width);
    const int y0 = CropStart(static_cast<int>(centre / image.width) + dy, side, image.height);
    uint8_t* to = crops.bytes.data_ptr<uint8_t>() + b * numbers;
    FillEmpty(request, to);
    CopyCrop(image.planes, request.planes, image, x0, y0, side, to);
    CopyCrop(image.truth, request.truth, image, x0, y0, side, to + static_cast<size_t>(request.planes) * side * side);
    for (int unused = 0; unused < 3; ++unused)
      hash = Mix(hash);  // keeps the random stream of the built-in parser's training
    DrawLight(Mix(hash), request.light_strength, crops.lights.data_ptr<float>() + 9 * b);
  }
  return crops;
}

Tensor Lit(const Tensor& colours, const Tensor& lights) {
  return torch::clamp(torch::einsum("brc,bchw->brhw", {lights, colours}), 0, 1);
}

Tensor BytesOf(const PackedImage& image, int planes, int truth) {
  Tensor bytes = torch::empty({1, planes + truth, image.height, image.width}, torch::kUInt8);
  std::memcpy(bytes.data_ptr<uint8_t>(), image.planes.data(), image.planes.size());
  std::memcpy(bytes.data_ptr<uint8_t>() + image.planes.size(), image.truth.data(), image.truth.size());
  return bytes;
}

PlaneUnpacker::PlaneUnpacker(int planes) {
  std::vector<float> offsets, scales;
  for (int p = 0; p < planes; ++p) {
    offsets.push_back(PackingOf(p).offset);
    scales.push_back(PackingOf(p).scale);
  }
  offsets_ = OnDevice(torch::tensor(offsets)).view({1, planes, 1, 1});
  scales_ = OnDevice(torch::tensor(scales)).view({1, planes, 1, 1});
}

PlanesAndTruth PlaneUnpacker::operator()(const Tensor& bytes) const {
  const Tensor there = OnDevice(bytes);
  const int64_t planes = offsets_.size(1);
  return {(there.narrow(1, 0, planes).to(torch::kFloat) - offsets_) / scales_,
          there.narrow(1, planes, there.size(1) - planes)};
}

void CheckImage(const PackedImage& image, int planes, int truth, const char* what) {
  BODYLOOM_CHECK(image.width > 0 && image.height > 0 && image.width % kImageUnetMultiple == 0 &&
                     image.height % kImageUnetMultiple == 0 && image.planes.size() == planes * image.pixels() &&
                     image.truth.size() == truth * image.pixels(),
                 what, ": an image of ", image.width, "x", image.height, " pixels with ", image.planes.size(),
                 " bytes of planes and ", image.truth.size(), " of truth");
}

}  // namespace bodyloom
