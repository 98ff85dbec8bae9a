// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/person/person_layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace bodyloom {
namespace {

TEST(FillAround, GivesEmptyPixelsTheWeightedMeanNearby) {
  const int width = 4, height = 2;
  std::vector<float> alpha(8, 0), colour(24, -1);
  alpha[0] = 1, alpha[1] = 0.5F;
  for (size_t c = 0; c < 3; ++c) colour[8 * c] = 0.3F, colour[8 * c + 1] = 0.9F;
  FillAround(width, height, alpha, colour);
  EXPECT_FLOAT_EQ(colour[0], 0.3F) << "what is seen stays";
  EXPECT_FLOAT_EQ(colour[1], 0.9F);
  for (const size_t i : {2U, 3U, 4U, 5U, 6U, 7U}) EXPECT_NEAR(colour[i], (0.3 + 0.45) / 1.5, 1e-6) << i;
}

TEST(FillAround, LeavesAnEmptyPictureAlone) {
  std::vector<float> alpha(6, 0), colour(18, 0.25F);
  FillAround(3, 2, alpha, colour);
  for (const float c : colour) EXPECT_EQ(c, 0.25F);
  EXPECT_THROW(FillAround(4, 2, alpha, colour), std::invalid_argument);
}

/// One pixel of a person in a box of 64×64 that begins left of and above the picture.
PersonLayers OnePixel() {
  PersonLayers layers;
  layers.x = -62, layers.y = -63, layers.width = layers.height = kLayersMultiple;
  layers.planes.assign(PersonPlane::kCount * layers.pixels(), 0);
  const size_t i = 63 * layers.pixels() / 64 + 63;  // pixel (1, 0) of the picture
  layers.planes[i] = 0.5F, layers.planes[layers.pixels() + i] = 0.25F, layers.planes[2 * layers.pixels() + i] = 1;
  layers.planes[3 * layers.pixels() + i] = 0.75F;
  return layers;
}

TEST(PersonLayers, NoChangeIsThePersonOverThePicture) {
  const PersonLayers layers = OnePixel();
  Image picture(3, 2, Colour{200, 100, 40});
  std::vector<uint8_t> coverage(6, 7);
  LayOver(layers, ChangedPerson(layers, std::vector<float>(4 * layers.pixels(), 0)), &picture, coverage);
  EXPECT_EQ(picture.pixel(1, 0)[2], std::lround(0.25 * picture.pixel(0, 0)[2] + 0.75 * 127.5));
  EXPECT_EQ(picture.pixel(1, 0)[1], std::lround(0.25 * picture.pixel(0, 0)[1] + 0.75 * 63.75));
  EXPECT_EQ(coverage[1], std::lround(0.75 * 255));
  EXPECT_EQ(coverage[0], 0) << "inside the box, nobody there";
  EXPECT_EQ(coverage[2], 7) << "outside the box";
  EXPECT_EQ(picture.pixel(2, 1)[0], picture.pixel(0, 0)[0]);
}

TEST(PersonLayers, ChangesAreBoundedAndClamped) {
  const PersonLayers layers = OnePixel();
  std::vector<float> change(4 * layers.pixels(), 0);
  const size_t i = 63 * layers.pixels() / 64 + 63;
  change[i] = 0.1F, change[layers.pixels() + i] = -100, change[3 * layers.pixels() + i] = 100;
  const std::vector<float> person = ChangedPerson(layers, change);
  EXPECT_FLOAT_EQ(person[i], 0.5F + std::tanh(0.1F));
  EXPECT_EQ(person[layers.pixels() + i], 0);
  EXPECT_EQ(person[3 * layers.pixels() + i], 1);
  change.pop_back();
  EXPECT_THROW(ChangedPerson(layers, change), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
