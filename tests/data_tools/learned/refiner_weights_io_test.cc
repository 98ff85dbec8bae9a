// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/learned/refiner_weights_io.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/random_picture_unet.h"

namespace bodyloom {
namespace {

std::string BytesOfRefiner(const RefinerWeights& weights) {
  const TemporaryFolder folder;
  WriteRefinerWeights(folder.File("refiner.npz"), weights);
  return ReadFileBytes(folder.File("refiner.npz"));
}

/// "" when it reads.
std::string RefinerErrorOf(const std::function<void(NpzArrays*)>& change) {
  NpzArrays arrays = ReadNpzBytes(BytesOfRefiner(RandomRefiner(1)), "x");
  change(&arrays);
  const TemporaryFolder folder;
  WriteNpz(folder.File("changed.npz"), arrays);
  try {
    ReadRefinerWeightsBytes(ReadFileBytes(folder.File("changed.npz")), "some/refiner.npz");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(RefinerWeightsIo, KernelsComeBackToElevenBitsBiasesExactly) {
  const RefinerWeights written = RandomRefiner(1), read = ReadRefinerWeightsBytes(BytesOfRefiner(written), "x");
  ASSERT_TRUE(read.IsValid(nullptr));
  EXPECT_EQ(read.recipe, written.recipe);
  EXPECT_EQ(read.pixels_per_metre, written.pixels_per_metre);
  EXPECT_TRUE(read.moves_outline);
  EXPECT_EQ(read.network.num_parameters(), written.network.num_parameters());
  for (size_t i = 0; i < written.network.convolutions.size(); ++i) {
    EXPECT_TRUE(read.network.convolutions[i].bias == written.network.convolutions[i].bias);
    const auto difference =
        (read.network.convolutions[i].kernel - written.network.convolutions[i].kernel).cwiseAbs().array();
    EXPECT_TRUE((difference <= written.network.convolutions[i].kernel.cwiseAbs().array() / 2048 + 1e-7F).all()) << i;
  }
  EXPECT_EQ(BytesOfRefiner(read), BytesOfRefiner(ReadRefinerWeightsBytes(BytesOfRefiner(read), "x")));
}

TEST(RefinerWeightsIo, NamesWhatIsWrong) {
  EXPECT_EQ(RefinerErrorOf([](NpzArrays*) {}), "");
  const std::string missing = RefinerErrorOf([](NpzArrays* arrays) { arrays->erase("merge1"); });
  EXPECT_NE(missing.find("some/refiner.npz"), std::string::npos) << missing;
  EXPECT_NE(missing.find("merge1"), std::string::npos) << missing;
  const std::string small = RefinerErrorOf([](NpzArrays* arrays) { (*arrays)["down2"] = (*arrays)["down1"]; });
  EXPECT_NE(small.find("down2 is 48x288"), std::string::npos) << small;
  EXPECT_NE(small.find("expected 64x432"), std::string::npos) << small;
  const std::string flat = RefinerErrorOf([](NpzArrays* arrays) { (*arrays)["enter"] = (*arrays)["enter_bias"]; });
  EXPECT_NE(flat.find("enter"), std::string::npos) << flat;
  const std::string infinite = RefinerErrorOf([](NpzArrays* arrays) {
    const std::vector<float> bias(32, std::numeric_limits<float>::infinity());
    (*arrays)["first_bias"] = NdArray::FromFloats(bias.data(), {32});
  });
  EXPECT_NE(infinite.find("first has numbers that are not finite"), std::string::npos) << infinite;
  const std::string nobody = RefinerErrorOf([](NpzArrays* arrays) {
    const float none = 0;
    (*arrays)["pixels_per_metre"] = NdArray::FromFloats(&none, {1});
  });
  EXPECT_NE(nobody.find("pixels_per_metre is 0, expected 1 to 100000"), std::string::npos) << nobody;
  const std::string several = RefinerErrorOf([](NpzArrays* arrays) {
    const std::vector<float> two(2, 250);
    (*arrays)["pixels_per_metre"] = NdArray::FromFloats(two.data(), {2});
  });
  EXPECT_NE(several.find("pixels_per_metre has 2 numbers, expected one"), std::string::npos) << several;
  const std::string half = RefinerErrorOf([](NpzArrays* arrays) {
    const float number = 0.5F;
    (*arrays)["moves_outline"] = NdArray::FromFloats(&number, {1});
  });
  EXPECT_NE(half.find("moves_outline is 0.5, expected 0 or 1"), std::string::npos) << half;
  EXPECT_THROW(ReadRefinerWeightsBytes("no archive", "x"), std::runtime_error);
  EXPECT_THROW(ReadRefinerWeights("/nowhere/refiner.npz"), std::runtime_error);
}

TEST(RefinerWeightsIo, WritesNoInvalidWeights) {
  RefinerWeights weights = RandomRefiner(1);
  weights.network.convolutions.pop_back();
  const TemporaryFolder folder;
  EXPECT_THROW(WriteRefinerWeights(folder.File("refiner.npz"), weights), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
