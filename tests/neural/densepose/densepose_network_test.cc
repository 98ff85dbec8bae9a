// SPDX-License-Identifier: Apache-2.0
#include "neural/densepose/densepose_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/csrc/jit/serialization/pickle.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/neural/densepose/scripted_densepose.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::densepose_network_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using torch::Tensor;

constexpr int kRows = 12, kColumns = 8;

/// Charts 1, 2 and 5 in stripes, background in the first row; u by column, v by row.
struct Striped {
  Tensor part = torch::arange(kColumns).view({1, kColumns}).expand({kRows, kColumns}).remainder(3).clone();
  Tensor u = (torch::arange(kColumns, torch::kFloat).view({1, kColumns}).expand({kRows, kColumns}) + 0.5F) / kColumns;
  Tensor v = (torch::arange(kRows, torch::kFloat).view({kRows, 1}).expand({kRows, kColumns}) + 0.5F) / kRows;
  Striped() {
    part = torch::tensor({1, 2, 5}).index({part});
    part[0].zero_();
    u = u.contiguous();
    v = v.contiguous();
  }
  [[nodiscard]] ScriptedPlanes planes() const { return PlanesOf(part, u, v); }
};

class DensePoseFile : public ::testing::Test {
 protected:
  std::string Save(const torch::jit::Module& module) const {
    std::string path = folder_ / "densepose.torchscript";
    module.save(path);
    return path;
  }
  std::string Save(const char* forward) const { return Save(ScriptedDensePose(Striped().planes(), forward)); }
  std::string SaveBytes(const std::string& bytes) const {
    std::string path = folder_ / "densepose.torchscript";
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  /// The one line that is thrown, which begins with the file.
  template <class Call>
  std::string ErrorOf(const Call& call) const {
    try {
      call();
    } catch (const std::runtime_error& error) {
      std::string text = error.what();
      EXPECT_THAT(text, AllOf(StartsWith(folder_.path()), Not(HasSubstr("\n"))));
      return text;
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
  }
  std::string LoadError(const std::string& path) const {
    return ErrorOf([&] { DensePoseNetwork network(path); });
  }
  /// Of detecting somebody with a tuple of these planes.
  std::string AnswerError(const ScriptedPlanes& planes, const char* forward = kScriptedTuple) const {
    const DensePoseNetwork network(Save(ScriptedDensePose(planes, forward)));
    return ErrorOf([&] { (void)network.Detect(RedRectangle(20, 30, 4, 4, 8, 12)); });
  }

  ScratchFolder folder_;
};

TEST_F(DensePoseFile, BothFormsSeeThePersonWhereItIs) {
  const Striped truth;
  // A portrait and a landscape, with the person right of x = height: one cell a pixel.
  for (const auto& [width, height, x, y] : {std::array{50, 120, 31, 90}, std::array{300, 60, 280, 41}}) {
    for (const char* form : {kScriptedTuple, kScriptedDict}) {
      const DensePoseNetwork network(Save(form));
      const auto people = network.Detect(RedRectangle(width, height, x, y, kColumns, kRows));
      ASSERT_EQ(people.size(), 1U);
      EXPECT_EQ(people[0].x0, x);
      EXPECT_EQ(people[0].y0, y);
      EXPECT_EQ(people[0].x1, x + kColumns);
      EXPECT_EQ(people[0].y1, y + kRows);
      EXPECT_EQ(people[0].score, form == kScriptedTuple ? 1 : 0.75);
      const ChartImage& charts = people[0].charts;
      ASSERT_EQ(charts.x_begin, x);
      ASSERT_EQ(charts.y_begin, y);
      ASSERT_EQ(charts.width, kColumns);
      ASSERT_EQ(charts.height, kRows);
      for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
          const size_t i = size_t(row) * kColumns + size_t(column);
          ASSERT_EQ(charts.part[i], truth.part[row][column].item<int>());
          if (row == 0) continue;
          EXPECT_NEAR(charts.u[i], (column + 0.5) / kColumns, 1e-6);
          EXPECT_NEAR(charts.v[i], (row + 0.5) / kRows, 1e-6);
        }
      }
    }
  }
}

TEST_F(DensePoseFile, NobodyIsNoError) {
  for (const char* form : {kScriptedTuple, kScriptedDict}) {
    EXPECT_TRUE(DensePoseNetwork(Save(form)).Detect(Image(40, 30, {90, 90, 90})).empty());
  }
  EXPECT_THROW((void)DensePoseNetwork(Save(kScriptedDict)).Detect(Image()), std::invalid_argument);
}

TEST_F(DensePoseFile, ColoursGoInAsTheFormHasThemOrAsTold) {
  const Image red = RedRectangle(40, 30, 5, 5, kColumns, kRows);
  for (const char* form : {kScriptedTuple, kScriptedDict}) {
    const bool is_tuple = form == kScriptedTuple;
    EXPECT_EQ(DensePoseNetwork(Save(form), DensePoseColours::kRgb).Detect(red).size(), is_tuple ? 1U : 0U);
    EXPECT_EQ(DensePoseNetwork(Save(form), DensePoseColours::kBgr).Detect(red).size(), is_tuple ? 0U : 1U);
  }
}

TEST_F(DensePoseFile, PaddingHasTheMeanColourAndWhoeverIsFoundInItIsDropped) {
  // Its people are the padding with some of the picture above it, and one inside.
  const char* finds_padding = R"(
def forward(self, image: Tensor):
    pad = ((image[0] == 124) & (image[1] == 116) & (image[2] == 104)).nonzero()
    y = pad[:, 0]
    x = pad[:, 1]
    box = torch.stack([x.min(), y.min(), x.max() + 1, y.max() + 1]).float()
    inside = torch.tensor([0.0, 0.0, 8.0, 12.0])
    boxes = torch.stack([box - torch.tensor([0.0, 10.0, 0.0, 0.0]), inside])
    assert int(box[1]) == 20 and int(box[3]) == 50 and int(box[2]) == 50 and int(box[0]) == 0
    return boxes, self.coarse.repeat([2, 1, 1, 1]), self.fine.repeat([2, 1, 1, 1]), self.u.repeat([2, 1, 1, 1]), self.v.repeat([2, 1, 1, 1])
)";
  const auto people = DensePoseNetwork(Save(finds_padding)).Detect(Image(50, 20, {90, 90, 90}));
  ASSERT_EQ(people.size(), 1U);
  EXPECT_EQ(people[0].x1, 8);
}

TEST_F(DensePoseFile, HalfFloatsBecomeFloats) {
  torch::jit::Module module("DensePose");
  module.register_parameter("weight", torch::eye(25, torch::kHalf), /*is_buffer=*/false);
  module.register_buffer("planes", Striped().planes().fine.to(torch::kHalf));
  // The processor multiplies no matrices of halves.
  module.define(R"(
def forward(self, image: Tensor):
    boxes = torch.tensor([[5.0, 5.0, 13.0, 17.0]])
    fine = torch.mm(self.weight, self.planes.view([25, -1])).view([1, 25, 12, 8])
    nobody = fine[:, :1]
    return boxes, torch.cat([nobody, 1 - nobody], 1), fine, fine, fine
)");
  const auto people = DensePoseNetwork(Save(module)).Detect(Image(40, 30, {90, 90, 90}));
  ASSERT_EQ(people.size(), 1U);
  const std::vector<uint8_t>& part = people[0].charts.part;
  EXPECT_EQ(std::count(part.begin(), part.end(), 2), 3 * (kRows - 1));
}

TEST_F(DensePoseFile, WhatIsNoTorchScriptIsRefusedInOneLine) {
  EXPECT_THAT(LoadError(folder_ / "nowhere.pt"), HasSubstr("cannot be read"));
  EXPECT_THAT(LoadError(folder_.path()), HasSubstr("TorchScript"));
  for (const std::string& bytes : {std::string(), std::string("not a model"), std::string(100000, '\x7f')}) {
    EXPECT_THAT(LoadError(SaveBytes(bytes)), HasSubstr("expected DensePose as torch.jit.save writes it"));
  }
  const std::string path = Save(kScriptedTuple);
  std::ifstream file(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  for (size_t kept = 1; kept < whole.size(); kept += whole.size() / 17) {
    EXPECT_THAT(LoadError(SaveBytes(whole.substr(0, kept))), HasSubstr("cannot be loaded")) << kept;
  }
  const std::vector<char> tensor = torch::jit::pickle_save(torch::ones({3}));  // without a program
  EXPECT_THAT(LoadError(SaveBytes({tensor.begin(), tensor.end()})), HasSubstr("cannot be loaded"));
}

TEST_F(DensePoseFile, OtherProgramsAreRefusedByTheirInterface) {
  const auto with = [&](const char* forward) { return LoadError(Save(forward)); };
  EXPECT_THAT(with("def run(self, image: Tensor):\n    return image\n"), HasSubstr("no forward()"));
  EXPECT_THAT(with("def forward(self, image: Tensor):\n    return image\n"), HasSubstr("returns Tensor, expected"));
  EXPECT_THAT(with("def forward(self, image: Tensor):\n    return image, image, image, image\n"),
              HasSubstr("returns Tuple[Tensor, Tensor, Tensor, Tensor], expected"));
  EXPECT_THAT(with("def forward(self, image: Tensor):\n    return image, image, image, image, 3\n"), HasSubstr("int]"));
  EXPECT_THAT(with("def forward(self, image: Tensor):\n    return {1: image}\n"), HasSubstr("returns Dict[int"));
  EXPECT_THAT(with("def forward(self, a: Tensor, b: Tensor):\n    return a, a, b, b, b\n"), HasSubstr("2 arguments"));
  EXPECT_THAT(with("def forward(self):\n    return 1\n"), HasSubstr("0 arguments"));
}

TEST_F(DensePoseFile, AnswersThatDoNotFitAreRefusedByName) {
  const ScriptedPlanes good = Striped().planes();
  ScriptedPlanes planes = good;
  planes.coarse = good.coarse.slice(1, 0, 1);
  EXPECT_THAT(AnswerError(planes),
              HasSubstr("coarse segmentation has shape [1, 1, 12, 8], expected [1, 2 or 15, h, w]"));
  planes = good;
  planes.fine = good.fine.slice(1, 0, 24);
  EXPECT_THAT(AnswerError(planes), HasSubstr("fine segmentation has shape [1, 24, 12, 8], expected [1, 25, h, w]"));
  planes = good;
  planes.u = good.u.slice(2, 0, 5);
  EXPECT_THAT(AnswerError(planes), HasSubstr("u has shape [1, 25, 5, 8]"));
  planes = good;
  planes.v = good.v[0];
  EXPECT_THAT(AnswerError(planes, kScriptedDict), HasSubstr("v has shape"));
  EXPECT_THAT(AnswerError(good, R"(
def forward(self, image: Tensor):
    return torch.zeros([3]), self.coarse, self.fine, self.u, self.v
)"),
              HasSubstr("boxes have shape [3], expected [n, 4]"));
  EXPECT_THAT(AnswerError(good, R"(
def forward(self, image: Tensor):
    return {"pred_boxes": torch.zeros([1, 4]), "scores": torch.ones([1])}
)"),
              HasSubstr("no pred_densepose_coarse_segm; it has "));
  EXPECT_THAT(AnswerError(good, R"(
def forward(self, image: Tensor):
    assert image.size(0) == 7, "seven"
    return self.coarse, self.coarse, self.fine, self.u, self.v
)"),
              AllOf(HasSubstr("failed on an image of 20x30"), HasSubstr("seven")));
}

TEST_F(DensePoseFile, FifteenCoarseChannelsAreAPersonWhereAnyBodyPartWins) {
  ScriptedPlanes planes = Striped().planes();
  const Tensor background = planes.coarse.slice(1, 0, 1), person = planes.coarse.slice(1, 1, 2);
  planes.coarse =
      torch::cat({background, torch::zeros({1, 9, kRows, kColumns}), person, torch::zeros({1, 4, kRows, kColumns})}, 1);
  const auto people = DensePoseNetwork(Save(ScriptedDensePose(planes, kScriptedTuple)))
                          .Detect(RedRectangle(40, 30, 5, 5, kColumns, kRows));
  ASSERT_EQ(people.size(), 1U);
  const std::vector<uint8_t>& part = people[0].charts.part;
  EXPECT_EQ(std::count(part.begin(), part.end(), 0), kColumns);
}

}  // namespace
}  // namespace bodyloom::densepose_network_test
