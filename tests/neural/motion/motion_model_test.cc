// SPDX-License-Identifier: Apache-2.0
// The network of the motion-dependent renderer: sizes, ablations, descriptors.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "neural/base/image_tensor.h"
#include "neural/cards/network_cards.h"
#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_model.h"
#include "neural/networks/architecture_card.h"
#include "tests/neural/motion/toy_motion.h"
#include "tests/support/paths.h"
#include "tests/support/test_files.h"

namespace bodyloom::motion_model_test {
namespace {

using torch::Tensor;

int64_t Parameters(const torch::nn::Module& module) {
  int64_t count = 0;
  for (const Tensor& parameter : module.parameters()) count += parameter.numel();
  return count;
}

TEST(MotionModel, ProfilesHaveTheSizesThatTheyAreKnownFor) {
  // Computed apart from this code for the paper's blocks: base 64 with five levels 5.8 M, 45.8 M and 45.8 M; base 16
  // with four 0.37 M, 1.5 M and 1.5 M; base 8 0.09 M, 0.37 M, 0.37 M.
  const auto millions = [](const char* profile) {
    MotionConfig config;
    config.profile = MotionProfileNamed(profile);
    const MotionModel model(config);
    return std::vector<double>{1e-6 * Parameters(*model->encoder), 1e-6 * Parameters(*model->shape_decoder),
                               1e-6 * Parameters(*model->appearance_decoder)};
  };
  const std::vector<double> cpu = millions("cpu"), tiny = millions("tiny");
  EXPECT_NEAR(cpu[0], 0.37, 0.01);
  EXPECT_NEAR(cpu[1], 1.5, 0.05);
  EXPECT_NEAR(cpu[2], 1.5, 0.05);
  EXPECT_NEAR(tiny[0], 0.09, 0.005);
  EXPECT_NEAR(tiny[1], 0.37, 0.01);
  EXPECT_THROW(MotionProfileNamed("gpu"), std::invalid_argument);
}

TEST(MotionModel, AblationsLeaveOutWhatTheyName) {
  for (const int left_out : {0, 1, 2, 3, 4}) {
    MotionConfig config = Toy();
    config.shape = left_out != 1;
    config.normals = left_out != 2;
    config.motion = left_out != 3;
    config.texture = left_out != 4;
    MotionModel model(config);
    EXPECT_EQ(model->texture.is_empty(), left_out == 4);
    EXPECT_EQ(model->encoder.is_empty(), left_out == 3);
    EXPECT_EQ(model->shape_decoder.is_empty(), left_out == 1);
    std::vector<MotionFrame> frames(2);
    ToyFrame(0, true, &frames[0]);
    ToyFrame(1, true, &frames[1]);
    const MotionInput input = InputOf(frames, config);
    EXPECT_EQ(input.motion.defined(), left_out != 3);
    const MotionStepResult result = model(input, model->InitialState(2, 32, 32));
    EXPECT_EQ(result.state.image.sizes(), (std::vector<int64_t>{2, 3, 32, 32}));
    EXPECT_EQ(result.state.labels.defined(), left_out != 1);
    EXPECT_EQ(result.state.normals.defined(), left_out != 2);
    EXPECT_GE(result.state.image.min().item<float>(), 0);
    EXPECT_LE(result.state.image.max().item<float>(), 1);
    if (left_out == 1) continue;
    EXPECT_NEAR((result.state.labels.sum(1) - 1).abs().max().item<float>(), 0, 1e-5);
    // Certain background gives zero foreground.
    EXPECT_TRUE(torch::allclose(result.foreground, 1 - result.state.labels.slice(1, 0, 1)));
    EXPECT_TRUE((result.state.image <= result.foreground + 1e-6).all().item<bool>());
  }
}

/// If the decoders add nothing, a pixel has the class and colour of its texel.
TEST(MotionModel, ATexelShowsItsLearnedClassAndColour) {
  const torch::NoGradGuard no_grad;
  torch::manual_seed(4);
  MotionModel model(Toy());
  for (Tensor& parameter : model->shape_decoder->parameters()) parameter.zero_();
  for (Tensor& parameter : model->appearance_decoder->parameters()) parameter.zero_();
  model->texture->values.uniform_(-0.1, 0.1);
  MotionFrame frame;
  ToyFrame(0, false, &frame);
  // Each pixel of the body shows the centre of one texel: (x, y) modulo 16, rows from the top at v = 1.
  for (int i = 0; i < 32 * 32; ++i) {
    frame.uv[i] = (static_cast<float>(i % 32 % 16) + 0.5F) / 16;
    frame.uv[32 * 32 + i] = 1 - (static_cast<float>(i / 32 % 16) + 0.5F) / 16;
  }
  const MotionStepResult result =
      model(InputOf(std::vector<MotionFrame>{frame}, model->config), model->InitialState(1, 32, 32));
  const Tensor labels = model->texture->labels_of_texel->weight.flatten(1);
  const Tensor colour = model->texture->colour_of_texel->weight.flatten(1);
  for (const auto& [x, y] :
       {std::pair(7, 9), std::pair(20, 15), std::pair(12, 23), std::pair(2, 2), std::pair(30, 12)}) {
    const bool body = frame.body[y * 32 + x] != 0;
    const Tensor texel = body ? 10 * model->texture->values[0].slice(1, y % 16, y % 16 + 1).slice(2, x % 16, x % 16 + 1)
                              : torch::zeros({4, 1, 1});
    const Tensor logits = labels.matmul(texel.flatten()), classes = torch::softmax(logits, 0);
    const Tensor seen = (1 - classes[0]) * torch::sigmoid(colour.matmul(texel.flatten()));
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(result.label_logits[0][k][y][x].item<float>(), logits[k].item<float>(), 1e-5) << x << ", " << y;
      EXPECT_NEAR(result.state.image[0][k][y][x].item<float>(), seen[k].item<float>(), 1e-5) << x << ", " << y;
    }
  }
}

TEST(MotionModel, ShiftedImagesComeFromWhereTheyWere) {
  const Tensor image = torch::arange(2 * 1 * 4 * 5, torch::kFloat).reshape({2, 1, 4, 5});
  const Tensor moved = Shifted(image, 2, -1);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) {
      const bool inside = x - 2 >= 0 && y + 1 < 4;
      const float expected = inside ? image[1][0][y + 1][x - 2].item<float>() : 0.0F;
      EXPECT_EQ(moved[1][0][y][x].item<float>(), expected);
    }
  }
  EXPECT_TRUE(torch::equal(Shifted(image, 0, 0), image));
  EXPECT_EQ(Shifted(image, 5, 0).abs().max().item<float>(), 0);
}

TEST(MotionModel, FeaturesOfTheImagesPlaneGoStraightToTheDecoders) {
  torch::manual_seed(8);
  MotionModel model(DenseToy());
  model->eval();
  const torch::NoGradGuard no_grad;
  std::vector<MotionFrame> frames(1);
  DenseToyFrame(3, false, &frames[0]);
  const MotionInput input = InputOf(frames, model->config);
  ASSERT_EQ(input.motion.sizes(), (std::vector<int64_t>{1, 2, 32, 32}));
  const Tensor features = model->Encode(input.motion), projected = model->Project(features, input.uv, input.body);
  EXPECT_TRUE(torch::equal(projected.slice(1, 0, 4), features)) << "on the body and off it";
  frames[0].dense.clear();
  EXPECT_THROW(InputOf(frames, model->config), std::invalid_argument);
  MotionConfig deep = DenseToy();
  deep.profile.encoder_widths.assign(3, 4);
  std::string why;
  EXPECT_FALSE(deep.IsValid(&why));
  EXPECT_NE(ToText(DenseToy()), ToText(Toy()));
  EXPECT_EQ(MotionDescriptorNamed("dense2d"), MotionDescriptor::kDense2d);
  EXPECT_THROW(MotionDescriptorNamed("keypoints"), std::invalid_argument);
}

/// Whole architectures, as `bodyloom neural card` prints them: a change of a shape anywhere is a change of these files.
TEST(MotionModel, IsWhatItsCardsSay) {
  for (const char* profile : {"tiny", "cpu", "paper"}) {
    MotionConfig config;
    config.profile = MotionProfileNamed(profile);
    EXPECT_EQ(MotionCard(config), FileBytes(SourceDir() + "/tests/neural/cards/motion_" + profile + ".txt"));
  }
}

}  // namespace
}  // namespace bodyloom::motion_model_test
