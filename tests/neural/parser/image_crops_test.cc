// SPDX-License-Identifier: Apache-2.0
#include "neural/parser/image_crops.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "neural/base/device.h"

namespace bodyloom::image_crops_test {
namespace {

constexpr int kPlanesHere = 4, kTruthHere = 1;

/// 64×48; one pixel is marked in the truth, and planes say where they are.
PackedImage Marked(size_t marked) {
  PackedImage image;
  image.width = 64, image.height = 48;
  for (int p = 0; p < kPlanesHere; ++p) {
    for (size_t i = 0; i < image.pixels(); ++i) image.planes.push_back(static_cast<uint8_t>(1 + (i + p) % 250));
  }
  image.truth.assign(image.pixels(), 0);
  image.truth[marked] = 9;
  return image;
}

CropRequest RequestOfCrops(int side, int batch) {
  CropRequest request = {kPlanesHere, kTruthHere, side, batch, 5, 1, nullptr};
  request.tells_much = [](const PackedImage& image, size_t pixel) { return image.truth[pixel] != 0; };
  return request;
}

TEST(ImageCrops, AreOfTheirNumberAlone) {
  const std::vector<PackedImage> images = {Marked(100), Marked(2000)};
  const CropRequest request = RequestOfCrops(32, 3);
  const CropBatch first = MakeCrops(images, request, 7), again = MakeCrops(images, request, 7);
  EXPECT_TRUE(torch::equal(first.bytes, again.bytes));
  EXPECT_TRUE(torch::equal(first.lights, again.lights));
  EXPECT_FALSE(torch::equal(first.bytes, MakeCrops(images, request, 8).bytes));
}

TEST(ImageCrops, ArePartsOfAImage) {
  const std::vector<PackedImage> images = {Marked(1000)};
  const CropBatch batch = MakeCrops(images, RequestOfCrops(32, 16), 0);
  for (int b = 0; b < 16; ++b) {
    const std::vector<uint8_t> crop = HostValues<uint8_t>(batch.bytes[b][0]);
    for (int x = 1; x < 32; ++x) ASSERT_EQ((crop[x - 1] - 1 + 1) % 250, crop[x] - 1) << "a row goes on";
  }
}

TEST(ImageCrops, BeyondAImageNothingIsDrawn) {
  const std::vector<PackedImage> images = {Marked(1000)};
  const CropBatch batch = MakeCrops(images, RequestOfCrops(80, 4), 0);
  for (int b = 0; b < 4; ++b) {
    const std::vector<uint8_t> crop = HostValues<uint8_t>(batch.bytes[b][0]);
    int drawn = 0;
    for (const uint8_t value : crop) drawn += value != PackPlane(0, 0) ? 1 : 0;
    EXPECT_EQ(drawn, 64 * 48) << "the whole image lies in the crop";
  }
}

TEST(ImageCrops, HalfLieAroundWhatTellsMuch) {
  // Of 1,024 × 1,024 pixels a twentieth tells much, in one corner: crops anywhere would seldom touch it.
  PackedImage image;
  image.width = image.height = 1024;
  image.planes.assign(kPlanesHere * image.pixels(), 1);
  image.truth.assign(image.pixels(), 0);
  for (int y = 0; y < 230; ++y) std::fill_n(image.truth.begin() + y * 1024, 230, uint8_t{1});
  int touching = 0;
  for (int step = 0; step < 40; ++step) {
    const CropBatch batch = MakeCrops({image}, RequestOfCrops(64, 10), step);
    for (int b = 0; b < 10; ++b) touching += batch.bytes[b][kPlanesHere].any().item<bool>() ? 1 : 0;
  }
  EXPECT_NEAR(touching, 220, 50) << "of 400";
}

TEST(ImageCrops, LightsMixChannels) {
  const torch::Tensor colours = torch::rand({2, 3, 4, 5});
  torch::Tensor lights = torch::zeros({2, 3, 3});
  lights[0] = torch::eye(3);
  lights[1][0][2] = 0.5;
  const torch::Tensor lit = Lit(colours, lights);
  EXPECT_TRUE(torch::allclose(lit[0], colours[0]));
  EXPECT_TRUE(torch::allclose(lit[1][0], 0.5 * colours[1][2]));
  EXPECT_EQ(lit[1][1].abs().max().item<float>(), 0);
}

TEST(ImageCrops, BytesBecomeNumbers) {
  PackedImage image;
  image.width = image.height = 16;
  for (int p = 0; p < PersonPlane::kCount; ++p) {
    image.planes.insert(image.planes.end(), image.pixels(), PackPlane(p, 0.5F));
  }
  image.truth.assign(image.pixels(), 3);
  const auto [planes, truth] = PlaneUnpacker(PersonPlane::kCount)(BytesOf(image, PersonPlane::kCount, 1));
  EXPECT_LT((planes - 0.5).abs().max().item<float>(), 0.01F);
  EXPECT_EQ(truth.min().item<int>(), 3);
  EXPECT_NO_THROW(CheckImage(image, PersonPlane::kCount, 1, "test"));
  EXPECT_THROW(CheckImage(image, PersonPlane::kCount, 2, "test"), std::invalid_argument);
  image.width = 15;
  EXPECT_THROW(CheckImage(image, PersonPlane::kCount, 1, "test"), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::image_crops_test
