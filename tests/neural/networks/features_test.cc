// SPDX-License-Identifier: Apache-2.0
// Feature networks, weights from plain arrays, architecture cards, images as tensors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <limits>

#include "neural/base/image_tensor.h"
#include "neural/networks/architecture_card.h"
#include "neural/networks/load_weights.h"
#include "neural/networks/patch_discriminator.h"
#include "neural/networks/unet.h"
#include "neural/networks/vgg.h"

namespace bodyloom::features_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using torch::Tensor;
using Shape = std::vector<int64_t>;

FeatureNetworkOptions Small(FeatureTrunk trunk, std::vector<int> taps) {
  FeatureNetworkOptions options;
  options.trunk = trunk;
  options.taps = std::move(taps);
  options.random_features_divisor = 16;
  return options;
}

TEST(FeatureNetwork, LayersAreNumberedAsInTorchvision) {
  EXPECT_THAT(FeatureLayers(FeatureTrunk::kVgg16, {"conv1_2", "conv2_2", "conv3_2", "conv3_3", "conv4_2", "conv5_2"}),
              ElementsAre(2, 7, 12, 14, 19, 26));
  EXPECT_THAT(FeatureLayers(FeatureTrunk::kVgg16, {"relu1_2", "relu2_2", "relu3_3", "relu4_3", "relu5_3"}),
              ElementsAre(3, 8, 15, 22, 29));
  EXPECT_THAT(FeatureLayers(FeatureTrunk::kVgg19, {"relu1_1", "relu2_1", "relu3_1", "relu4_1", "relu5_1"}),
              ElementsAre(1, 6, 11, 20, 29));
  EXPECT_THAT(FeatureLayers(FeatureTrunk::kAlexNet, {"relu1", "relu2", "relu3", "relu4", "relu5"}),
              ElementsAre(1, 4, 7, 9, 11));
  EXPECT_THROW(FeatureLayer(FeatureTrunk::kVgg16, "conv3_4"), std::invalid_argument);
  EXPECT_THROW(FeatureLayer(FeatureTrunk::kVgg16, ""), std::invalid_argument);
}

TEST(FeatureNetwork, ShapesOfEveryTap) {
  FeatureNetwork vgg(Small(FeatureTrunk::kVgg16, {3, 8, 15, 22, 29}));
  const auto features = vgg(torch::rand({2, 3, 48, 32}));
  ASSERT_EQ(features.size(), 5U);
  EXPECT_EQ(features[0].sizes(), Shape({2, 4, 48, 32}));
  EXPECT_EQ(features[2].sizes(), Shape({2, 16, 12, 8}));
  EXPECT_EQ(features[4].sizes(), Shape({2, 32, 3, 2}));
  FeatureNetwork alex(Small(FeatureTrunk::kAlexNet, {1, 4, 7, 9, 11}));
  const auto small = alex(torch::rand({1, 3, 64, 64}));
  EXPECT_EQ(small[0].sizes(), Shape({1, 4, 15, 15}));
  EXPECT_EQ(small[1].sizes(), Shape({1, 12, 7, 7}));
  EXPECT_EQ(small[4].sizes(), Shape({1, 16, 3, 3}));
  EXPECT_THROW(alex(torch::rand({1, 3, 30, 64})), std::invalid_argument);
  EXPECT_NO_THROW(alex(torch::rand({1, 3, 31, 64})));
  EXPECT_THROW(vgg(torch::rand({1, 3, 15, 64})), std::invalid_argument);
}

// The first layers by hand, and that a tap before a ReLU is not overwritten by it.
TEST(FeatureNetwork, IsConvolutionsRectifiersAndPools) {
  FeatureNetwork vgg(Small(FeatureTrunk::kVgg16, {0, 1, 2, 4, 5}));
  const Tensor image = torch::rand({1, 3, 8, 8});
  const auto features = vgg(image);
  const auto p = vgg->named_parameters();
  const Tensor mean = torch::tensor({0.485F, 0.456F, 0.406F}).view({1, 3, 1, 1});
  const Tensor deviation = torch::tensor({0.229F, 0.224F, 0.225F}).view({1, 3, 1, 1});
  const Tensor conv1 = torch::conv2d((image - mean) / deviation, p["features.0.weight"], p["features.0.bias"], 1, 1);
  const Tensor conv2 = torch::conv2d(torch::relu(conv1), p["features.2.weight"], p["features.2.bias"], 1, 1);
  const Tensor pooled = torch::max_pool2d(torch::relu(conv2), 2);
  EXPECT_TRUE(torch::allclose(features[0], conv1, 1e-5, 1e-6));
  EXPECT_LT(features[0].min().item<float>(), 0);
  EXPECT_TRUE(torch::equal(features[1], torch::relu(features[0])));
  EXPECT_TRUE(torch::allclose(features[2], conv2, 1e-5, 1e-6));
  EXPECT_TRUE(torch::allclose(features[3], pooled, 1e-5, 1e-6));
  EXPECT_EQ(features[4].sizes(), Shape({1, 8, 4, 4}));
}

TEST(FeatureNetwork, RandomFeaturesAreOrthogonalAndSeeded) {
  FeatureNetworkOptions options = Small(FeatureTrunk::kVgg16, {4, 12});
  torch::manual_seed(1);
  FeatureNetwork a(options);
  torch::manual_seed(2);
  FeatureNetwork b(options);
  options.random_features_seed = 7;
  FeatureNetwork c(options);
  EXPECT_TRUE(a->has_random_features);
  const Tensor weight = a->named_parameters()["features.12.weight"].flatten(1).to(torch::kDouble);
  const Tensor product = torch::mm(weight, weight.t());
  EXPECT_LT((product - 2 * torch::eye(product.size(0), torch::kDouble)).abs().max().item<double>(), 1e-5);
  for (const auto& item : a->named_parameters()) {
    EXPECT_TRUE(torch::equal(item.value(), b->named_parameters()[item.key()])) << item.key();
    EXPECT_FALSE(item.value().requires_grad());
  }
  EXPECT_FALSE(torch::equal(weight, c->named_parameters()["features.12.weight"].flatten(1).to(torch::kDouble)));
}

TEST(FeatureNetwork, GradientsReachTheImage) {
  FeatureNetwork vgg(Small(FeatureTrunk::kVgg19, {2, 12}));
  Tensor image = torch::rand({1, 3, 16, 16}).requires_grad_(true);
  const auto features = vgg(image);
  (features[0].square().mean() + features[1].square().mean()).backward();
  EXPECT_GT(image.grad().abs().min().item<float>(), 0);
}

FeatureNetworkOptions FirstLayers() {
  FeatureNetworkOptions options;
  options.taps = {2};
  return options;
}

NamedWeights RandomWeights(const FeatureNetwork& network) {
  NamedWeights weights = ExportWeights(*network);
  for (auto& item : weights) {
    for (float& v : item.second.values) v += 0.25F;
  }
  return weights;
}

TEST(LoadWeights, TrainedWeightsReplaceTheRandomFeatures) {
  FeatureNetwork vgg(FirstLayers());
  NamedWeights weights = RandomWeights(vgg);
  weights["classifier.0.weight"] = {{2}, {1, 2}};
  const LoadWeightsReport report = vgg->Load(weights, "vgg.pth");
  EXPECT_THAT(report.unused, ElementsAre("classifier.0.weight"));
  EXPECT_TRUE(report.missing.empty());
  EXPECT_FALSE(vgg->has_random_features);
  const NamedWeights now = ExportWeights(*vgg);
  EXPECT_EQ(now.at("features.2.weight").values, weights["features.2.weight"].values);
  EXPECT_EQ(now.at("features.2.weight").shape, Shape({64, 64, 3, 3}));
  FeatureNetworkOptions small = FirstLayers();
  small.random_features_divisor = 2;
  EXPECT_THROW(FeatureNetwork(small)->Load(weights, "vgg.pth"), std::invalid_argument);
}

TEST(LoadWeights, NamesOfBlocksAreUnderstood) {
  FeatureNetwork vgg(FirstLayers()), other(FirstLayers());
  const NamedWeights weights = RandomWeights(vgg);
  const NamedWeights blocks = {{"conv1_1.weight", weights.at("features.0.weight")},
                               {"conv1_1.bias", weights.at("features.0.bias")},
                               {"conv1_2.weight", weights.at("features.2.weight")},
                               {"conv1_2.bias", weights.at("features.2.bias")}};
  other->Load(blocks, "vgg_conv.pth");
  EXPECT_EQ(ExportWeights(*other).at("features.2.weight").values, weights.at("features.2.weight").values);
}

std::string LoadError(const NamedWeights& weights) {
  FeatureNetwork vgg(FirstLayers());
  const NamedWeights before = ExportWeights(*vgg);
  std::string text;
  try {
    vgg->Load(weights, "w.pth");
  } catch (const std::runtime_error& error) {
    text = error.what();
  }
  const NamedWeights after = ExportWeights(*vgg);
  for (const auto& item : before) EXPECT_EQ(item.second.values, after.at(item.first).values);
  EXPECT_TRUE(vgg->has_random_features);
  return text;
}

TEST(LoadWeights, FaultsNameTheTensorAndLeaveTheModule) {
  const NamedWeights good = RandomWeights(FeatureNetwork(FirstLayers()));
  NamedWeights bad = good;
  bad["features.2.weight"].shape = {64, 32, 3, 6};
  EXPECT_EQ(LoadError(bad), "w.pth: tensor features.2.weight: shape [64, 32, 3, 6], expected [64, 64, 3, 3]");
  bad = good;
  bad["features.2.bias"].values.pop_back();
  EXPECT_EQ(LoadError(bad), "w.pth: tensor features.2.bias: 63 values, expected 64");
  bad = good;
  bad["features.2.bias"].values[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(LoadError(bad), HasSubstr("tensor features.2.bias: a value that is not finite"));
  bad = good;
  bad.erase("features.0.bias");
  EXPECT_EQ(LoadError(bad),
            "w.pth: no tensor features.0.bias; the file has features.0.weight, features.2.bias, features.2.weight");
  EXPECT_THAT(LoadError({}), HasSubstr("w.pth: no tensor features.0.weight"));
}

TEST(LoadWeights, MissingTensorsMayBeAllowed) {
  FeatureNetwork vgg(FirstLayers());
  NamedWeights weights = RandomWeights(vgg);
  const std::vector<float> before = ExportWeights(*vgg).at("features.0.bias").values;
  weights.erase("features.0.bias");
  LoadWeightsOptions options;
  options.allow_missing = true;
  EXPECT_THAT(LoadWeights(weights, "w", vgg.get(), options).missing, ElementsAre("features.0.bias"));
  EXPECT_EQ(ExportWeights(*vgg).at("features.0.bias").values, before);
}

TEST(ArchitectureCard, SmallUNet) {
  torch::manual_seed(1);
  UNet net(UNetOptions{3, {2}, {4}});
  EXPECT_EQ(ArchitectureCard(net, {1, 3, 8, 8}),
            "encoder0.conv1.weight   4 x 3 x 3 x 3   108\n"
            "encoder0.conv2.weight   4 x 4 x 3 x 3   144\n"
            "encoder0.down.weight    4 x 4 x 4 x 4   256\n"
            "decoder0.conv1.weight   4 x 4 x 3 x 3   144\n"
            "decoder0.conv2.weight   4 x 4 x 3 x 3   144\n"
            "decoder0.conv3.weight   4 x 4 x 3 x 3   144\n"
            "decoder0.up.weight      4 x 4 x 4 x 4   256\n"
            "decoder0.up.bias        4               4\n"
            "head0.weight            2 x 4 x 3 x 3   72\n"
            "head0.bias              2               2\n"
            "input 1 x 3 x 8 x 8\n"
            "parameters      1274\n"
            // 64 (108 + 144) + 16·256 + 16·3·144 + 16·256 + 64·72
            "multiply-adds   35840\n");
}

// The sizes of the profiles, by a quarter of the image's side where that is faster: convolutions scale with the area.
TEST(ArchitectureCard, PublishedSizes) {
  UNet encoder(UNetOptions{33, {16}, {64, 128, 256}});
  const auto count = [](auto& net, const Shape& shape) {
    return CountMultiplyAdds([&] {
      const torch::NoGradGuard no_grad;
      net(torch::zeros(shape));
    });
  };
  EXPECT_EQ(16 * count(encoder, {1, 33, 32, 32}), 5881462784);
  UNet shape(UNetOptions{23, {7}, {16, 32, 64, 128}});
  EXPECT_EQ(16 * count(shape, {1, 23, 64, 64}), 2116026368);
  torch::nn::Linear linear(5, 7);
  EXPECT_EQ(CountMultiplyAdds([&] { linear(torch::zeros({3, 5})); }), 105);
  EXPECT_EQ(CountMultiplyAdds([] {}), 0);
}

TEST(ImageTensor, RoundTrip) {
  Image image(5, 3);
  for (size_t i = 0; i < image.bgr.size(); ++i) image.bgr[i] = static_cast<uint8_t>(17 * i);
  const Tensor tensor = ToTensor(image);
  EXPECT_EQ(tensor.sizes(), Shape({1, 3, 3, 5}));
  EXPECT_FLOAT_EQ(tensor[0][0][1][2].item<float>(), image.pixel(2, 1)[2] / 255.0F);
  EXPECT_FLOAT_EQ(tensor[0][2][1][2].item<float>(), image.pixel(2, 1)[0] / 255.0F);
  EXPECT_EQ(ToImage(tensor), image);
  EXPECT_EQ(ToImage(torch::full({3, 1, 1}, 7.0F)).at(0, 0), (Colour{255, 255, 255}));
  EXPECT_EQ(ToImage(torch::full({3, 1, 1}, NAN)).at(0, 0), (Colour{0, 0, 0}));
  EXPECT_THROW(ToTensor(Image()), std::invalid_argument);
  EXPECT_THROW(ToImage(torch::zeros({1, 2, 2})), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::features_test
