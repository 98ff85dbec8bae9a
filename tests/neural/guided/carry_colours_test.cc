// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/guided_model.h"

#include <gtest/gtest.h>

namespace bodyloom::carry_colours_test {
namespace {

using torch::Tensor;

/// 16² pixels: a red skirt (label 2) known in columns 4–5, green stockings (label 5) known in columns 8–9.
struct Known {
  Tensor image = torch::zeros({1, 3, 16, 16}), known = torch::zeros({1, 1, 16, 16}),
         classes = torch::zeros({1, 1, 16, 16});
  Known() {
    const auto fill = [&](int column, int64_t label, int64_t channel) {
      image.slice(3, column, column + 2).slice(1, channel, channel + 1).fill_(1);
      known.slice(3, column, column + 2).fill_(1);
      classes.slice(3, column, column + 2).fill_(label);
    };
    fill(4, 2, 0), fill(8, 5, 1);
  }
};

TEST(CarryColours, AGarmentTakesItsOwnColourHoweverNearAnother) {
  const Known k;
  Tensor classes = torch::full({1, 1, 16, 16}, 2);
  classes.slice(3, 8, 16).fill_(5);
  const Tensor x = CarryColours(k.image, k.known, k.classes, classes);
  for (int64_t column = 0; column < 16; ++column) {
    EXPECT_TRUE(torch::allclose(x[0][0].select(1, column), torch::full({16}, column < 8 ? 1.0 : 0.0))) << column;
    EXPECT_TRUE(torch::allclose(x[0][1].select(1, column), torch::full({16}, column < 8 ? 0.0 : 1.0))) << column;
  }
  // Column 7 lies beside the stockings: without labels it takes some of their green.
  const Tensor blind = CarryColours(k.image, k.known, k.classes, {});
  EXPECT_GT(blind[0][1][8][7].item<double>(), 0.1);
  EXPECT_TRUE(torch::equal(blind * k.known, k.image)) << "what is known stays";
}

TEST(CarryColours, ALabelThatIsKnownNowhereTakesWhatIsNearest) {
  const Known k;
  const Tensor shoes = CarryColours(k.image, k.known, k.classes, torch::full({1, 1, 16, 16}, 6));
  EXPECT_TRUE(torch::equal(shoes, CarryColours(k.image, k.known, k.classes, {})));
  // Each picture of a batch by itself: the second one knows nothing of the skirt.
  const Tensor two = torch::cat({k.image, k.image}, 0), known = torch::cat({k.known, k.known}, 0);
  const Tensor of = torch::cat({k.classes, torch::full_like(k.classes, 5) * k.known}, 0);
  const Tensor x = CarryColours(two, known, of, torch::full({2, 1, 16, 16}, 2));
  EXPECT_NEAR(x[0][0][8][12].item<double>(), 1, 1e-6);
  EXPECT_LT(x[1][0][8][12].item<double>(), 0.9);
  EXPECT_TRUE(torch::equal(CarryColours(k.image * 0, k.known * 0, k.classes * 0, k.classes), k.image * 0));
}

}  // namespace
}  // namespace bodyloom::carry_colours_test
