// SPDX-License-Identifier: Apache-2.0
/// Labels of the built-in body's texels from an image that is the atlas itself.
#include "render/photo_avatar/texel_labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/body/posed_body.h"

namespace bodyloom::texel_labels_test {
namespace {

using enum PersonLabel;

constexpr int kSide = 256;

class TexelLabelsTest : public ::testing::Test {
 protected:
  TexelLabelsTest()
      : body_(BuiltinBody()),
        table_(BuildUvTexelTable(body_, {.width = kSide, .height = kSide, .gutter = 1})),
        rest_(ShapeVertices(body_, Eigen::VectorXd::Zero(0))),
        regions_(BodyRegions(body_, rest_)) {
    seen_.width = seen_.height = kSide;
    seen_.source_frame.assign(size_t{kSide} * kSide, -1);
    seen_.source_x_px.assign(seen_.source_frame.size(), 0);
    seen_.source_y_px.assign(seen_.source_frame.size(), 0);
    photo_ = {kSide, kSide, std::vector<uint8_t>(seen_.source_frame.size(), 0)};
  }
  [[nodiscard]] int CornerOf(size_t i) const {
    Eigen::Index corner = 0;
    table_.barycentric[i].maxCoeff(&corner);
    return body_.data().faces(table_.face[i], corner);
  }
  /// The texels whose nearest vertex is in front of the body's middle are seen, with this label.
  void SeeFront(const std::function<PersonLabel(int vertex)>& label_of) {
    for (size_t i = 0; i < table_.size(); ++i) {
      const int v = CornerOf(i), at = table_.pixel[i];
      if (rest_(v, 2) < 0.02) continue;
      seen_.source_frame[at] = 0;
      seen_.source_x_px[at] = static_cast<float>(at % kSide) + 0.5F;
      seen_.source_y_px[at] = static_cast<float>(at / kSide) + 0.5F;
      photo_.labels[at] = static_cast<uint8_t>(label_of(v));
    }
  }
  [[nodiscard]] std::vector<uint8_t> Run() const {
    return TexelLabels(body_, table_, rest_, regions_, seen_, std::vector{photo_});
  }
  [[nodiscard]] PersonLabel Truth(int v) const {
    if (regions_[v] == BodyRegion::kFace) return kFace;
    if (regions_[v] == BodyRegion::kScalp) return kHair;
    return rest_(v, 1) > body_.joint_template()(0, 1) ? kTop : kBottom;
  }
  const BodyModel& body_;
  UvTexelTable table_;
  MatrixX3d rest_;
  std::vector<BodyRegion> regions_;
  Texture seen_;
  PhotoLabels photo_;
};

TEST_F(TexelLabelsTest, TheBackIsLabelledLikeTheFrontAndTheBackOfTheHeadIsHair) {
  SeeFront([&](int v) { return Truth(v); });
  const std::vector<uint8_t> labels = Run();
  int behind = 0, right = 0, scalp = 0, hair = 0;
  for (size_t i = 0; i < table_.size(); ++i) {
    const int v = CornerOf(i), at = table_.pixel[i];
    EXPECT_NE(labels[at], 0);
    if (seen_.source_frame[at] >= 0) continue;
    const auto label = static_cast<PersonLabel>(labels[at]);
    if (regions_[v] == BodyRegion::kScalp) {
      ++scalp;
      hair += label == kHair ? 1 : 0;
    } else if (regions_[v] != BodyRegion::kFace && std::abs(rest_(v, 1) - body_.joint_template()(0, 1)) > 0.08) {
      ++behind;
      right += label == Truth(v) ? 1 : 0;
    }
  }
  EXPECT_GT(behind, 1000);
  EXPECT_GT(right, 0.98 * behind);
  EXPECT_GT(scalp, 100);
  EXPECT_EQ(hair, scalp);
}

TEST_F(TexelLabelsTest, ASeenTexelThatNoneOfItsNeighboursAgreesWithIsNoise) {
  SeeFront([](int) { return kTop; });
  int noisy = 0;
  for (size_t i = 0; i < table_.size(); i += 97) {
    const int at = table_.pixel[i];
    if (seen_.source_frame[at] < 0) continue;
    photo_.labels[at] = static_cast<uint8_t>(kShoes);
    ++noisy;
  }
  ASSERT_GT(noisy, 10);
  const std::vector<uint8_t> labels = Run();
  int shoes = 0;
  for (const uint8_t label : labels) shoes += label == static_cast<uint8_t>(kShoes) ? 1 : 0;
  EXPECT_LT(shoes, noisy / 2);
}

TEST_F(TexelLabelsTest, WhereNothingIsSeenNothingIsKnown) {
  for (const uint8_t label : Run()) ASSERT_EQ(label, 0);
}

TEST_F(TexelLabelsTest, RefusesOtherSizes) {
  SeeFront([](int) { return kTop; });
  photo_.labels.pop_back();
  EXPECT_THROW(Run(), std::invalid_argument);
  photo_.labels.push_back(0);
  seen_.source_frame[table_.pixel[0]] = 1;
  EXPECT_THROW(Run(), std::invalid_argument) << "a photo that is not there";
  seen_.source_frame[table_.pixel[0]] = 0;
  seen_.width = kSide / 2;
  EXPECT_THROW(Run(), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::texel_labels_test
