// SPDX-License-Identifier: Apache-2.0
#include "data_tools/learned/parser_weights_io.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/random_image_unet.h"

namespace bodyloom::parser_weights_io_test {
namespace {

std::string BytesOfParser(const ParserWeights& weights) {
  const TemporaryFolder folder;
  WriteParserWeights(folder.File("parser.npz"), weights);
  return ReadFileBytes(folder.File("parser.npz"));
}

std::string ParserErrorOf(const std::function<void(NpzArrays*)>& change) {
  NpzArrays arrays = ReadNpzBytes(BytesOfParser(RandomParser(1)), "x");
  change(&arrays);
  const TemporaryFolder folder;
  WriteNpz(folder.File("changed.npz"), arrays);
  try {
    ReadParserWeightsBytes(ReadFileBytes(folder.File("changed.npz")), "some/parser.npz");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(ParserWeightsIo, ComeBack) {
  const ParserWeights written = RandomParser(1), read = ReadParserWeightsBytes(BytesOfParser(written), "x");
  ASSERT_TRUE(read.IsValid(nullptr));
  EXPECT_EQ(read.recipe, written.recipe);
  EXPECT_EQ(read.pixels_per_metre, written.pixels_per_metre);
  EXPECT_EQ(read.network.num_parameters(), written.network.num_parameters());
  EXPECT_LT(read.network.num_parameters(), 2'000'000U);
  for (size_t i = 0; i < written.network.convolutions.size(); ++i) {  // kernels to eleven bits, biases exactly
    EXPECT_TRUE(read.network.convolutions[i].bias == written.network.convolutions[i].bias);
    const auto difference =
        (read.network.convolutions[i].kernel - written.network.convolutions[i].kernel).cwiseAbs().array();
    EXPECT_TRUE((difference <= written.network.convolutions[i].kernel.cwiseAbs().array() / 2048 + 1e-7F).all()) << i;
  }
  EXPECT_EQ(BytesOfParser(read), BytesOfParser(ReadParserWeightsBytes(BytesOfParser(read), "x")));
}

TEST(ParserWeightsIo, TheBuiltInParserSaysHowItWasMade) {
  const ParserWeights& weights = BuiltinParser();
  EXPECT_TRUE(weights.IsValid(nullptr));
  EXPECT_NE(weights.recipe.find("bodyloom train parser"), std::string::npos);
  EXPECT_GT(weights.network.convolutions.back().kernel.norm(), 0);
}

TEST(ParserWeightsIo, NamesWhatIsWrong) {
  EXPECT_EQ(ParserErrorOf([](NpzArrays*) {}), "");
  const std::string missing = ParserErrorOf([](NpzArrays* arrays) { arrays->erase("merge1"); });
  EXPECT_NE(missing.find("some/parser.npz"), std::string::npos) << missing;
  EXPECT_NE(missing.find("merge1"), std::string::npos) << missing;
  const std::string other = ParserErrorOf([](NpzArrays* arrays) { (*arrays)["leave"] = (*arrays)["merge0"]; });
  EXPECT_NE(other.find("leave is 32x288"), std::string::npos) << other;
  const std::string flat = ParserErrorOf([](NpzArrays* arrays) { (*arrays)["enter"] = (*arrays)["enter_bias"]; });
  EXPECT_NE(flat.find("enter"), std::string::npos) << flat;
  const std::string infinite = ParserErrorOf([](NpzArrays* arrays) {
    const std::vector<float> bias(32, std::numeric_limits<float>::infinity());
    (*arrays)["first_bias"] = NdArray::FromFloats(bias.data(), {32});
  });
  EXPECT_NE(infinite.find("first has numbers that are not finite"), std::string::npos) << infinite;
  const std::string nobody = ParserErrorOf([](NpzArrays* arrays) {
    const float none = 0;
    (*arrays)["pixels_per_metre"] = NdArray::FromFloats(&none, {1});
  });
  EXPECT_NE(nobody.find("pixels_per_metre is 0, expected 1 to 100000"), std::string::npos) << nobody;
  const std::string several = ParserErrorOf([](NpzArrays* arrays) {
    const std::vector<float> two(2, 250);
    (*arrays)["pixels_per_metre"] = NdArray::FromFloats(two.data(), {2});
  });
  EXPECT_NE(several.find("pixels_per_metre has 2 numbers, expected one"), std::string::npos) << several;
  EXPECT_THROW(ReadParserWeightsBytes("no archive", "x"), std::runtime_error);
  EXPECT_THROW(ReadParserWeights("/nowhere/parser.npz"), std::runtime_error);
  ParserWeights weights = RandomParser(1);
  weights.network.convolutions.pop_back();
  const TemporaryFolder folder;
  EXPECT_THROW(WriteParserWeights(folder.File("parser.npz"), weights), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::parser_weights_io_test
