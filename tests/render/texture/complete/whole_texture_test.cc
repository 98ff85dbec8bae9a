// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/whole_texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "render/texture/complete/texel_counterparts.h"
#include "tests/render/garment/person_scene.h"

namespace bodyloom::whole_texture_test {
namespace {

using Paint = std::function<Eigen::Vector3f(const Eigen::Vector3d& place)>;

class WholeTextureTest : public ::testing::Test {
 protected:
  static constexpr int kSide = 128;
  /// The texels at places that `is_seen`, in their paint.
  [[nodiscard]] Texture Seen(const Paint& paint, const std::function<bool(const Eigen::Vector3d&)>& is_seen) const {
    Texture texture;
    texture.width = texture.height = kSide;
    texture.bgr.assign(3 * kSide * kSide, 0.0F);
    texture.confidence.assign(kSide * kSide, 0.0F);
    for (size_t i = 0; i < table_.size(); ++i) {
      const Eigen::Vector3d place = points_.row(static_cast<Eigen::Index>(i)).transpose();
      if (table_.in_gutter[i] || !is_seen(place)) continue;
      texture.confidence[table_.pixel[i]] = 0.8F;
      const Eigen::Vector3f colour = paint(place);
      for (int c = 0; c < 3; ++c) texture.bgr[c * kSide * kSide + table_.pixel[i]] = colour[c];
    }
    return texture;
  }
  [[nodiscard]] WholeTexture Make(const Texture& seen) const {
    return MakeWholeTexture(body_, table_, rest_, regions_, seen);
  }
  /// Visits the texels of the surface with their colour.
  void Visit(const WholeTexture& whole,
             const std::function<void(const Eigen::Vector3d& place, BodyRegion region, TexelSource source,
                                      const Eigen::Vector3f& colour)>& visit) const {
    for (size_t i = 0; i < table_.size(); ++i) {
      if (table_.in_gutter[i]) continue;
      const int p = table_.pixel[i];
      int corner = 0;
      table_.barycentric[i].maxCoeff(&corner);
      visit(points_.row(static_cast<Eigen::Index>(i)).transpose(), regions_[body_.data().faces(table_.face[i], corner)],
            whole.sources[p], {whole.bgr[p], whole.bgr[kSide * kSide + p], whole.bgr[2 * kSide * kSide + p]});
    }
  }

  const BodyModel& body_ = BuiltinBody();
  const MatrixX3d rest_ = ShapeVertices(body_, Eigen::VectorXd());
  const UvTexelTable table_ = BuildUvTexelTable(body_, {.width = kSide, .height = kSide, .gutter = 1});
  const MatrixX3d points_ = TexelPoints(rest_, body_.data().faces, table_);
  const std::vector<BodyRegion> regions_ = BodyRegions(body_, rest_);
};

TEST_F(WholeTextureTest, OneColourStaysOneColour) {
  Eigen::Vector3f colour(0.2F, 0.5F, 0.7F);
  const WholeTexture whole =
      Make(Seen([&](const auto&) { return colour; }, [](const Eigen::Vector3d& p) { return p.z() > 0; }));
  Visit(whole, [&](const auto&, BodyRegion, TexelSource source, const Eigen::Vector3f& found) {
    EXPECT_NE(source, TexelSource::kEmpty);
    EXPECT_LT((found - colour).cwiseAbs().maxCoeff(), 2e-3F);
  });
  for (size_t i = 0; i < table_.size(); ++i) {
    if (!table_.in_gutter[i]) continue;
    EXPECT_NEAR(whole.bgr[table_.pixel[i]], colour[0], 2e-3F) << "the gutter";
  }
}

TEST_F(WholeTextureTest, WhatWasSeenIsKeptToTheBit) {
  const Texture seen =
      Seen([](const Eigen::Vector3d& p) { return Eigen::Vector3f(0.5F + float(p.x()) / 3, 0.3F, 0.4F); },
           [](const Eigen::Vector3d& p) { return p.z() > 0; });
  const WholeTexture whole = Make(seen);
  int kept = 0;
  for (int p = 0; p < kSide * kSide; ++p) {
    if (whole.sources[p] != TexelSource::kSeen) continue;
    ++kept;
    for (int c = 0; c < 3; ++c) ASSERT_EQ(whole.bgr[c * kSide * kSide + p], seen.bgr[c * kSide * kSide + p]);
  }
  EXPECT_GT(kept, 2000);
}

TEST_F(WholeTextureTest, TheOtherHalfOfASymmetricPersonIsMirrored) {
  const auto paint = [](const Eigen::Vector3d& p) {
    return Eigen::Vector3f(0.5F + 0.2F * std::sin(12 * std::abs(float(p.x()))),
                           0.5F + 0.2F * std::sin(9 * float(p.y())), p.z() > 0 ? 0.7F : 0.3F);
  };
  double squares = 0;
  int count = 0;
  Visit(Make(Seen(paint, [](const Eigen::Vector3d& p) { return p.x() > -0.01; })),
        [&](const Eigen::Vector3d& p, BodyRegion, TexelSource source, const Eigen::Vector3f& found) {
          if (source != TexelSource::kMirror || std::abs(p.z()) < 0.03) return;
          squares += (found - paint(p)).squaredNorm() / 3;
          ++count;
        });
  EXPECT_GT(count, 2000);
  EXPECT_LT(std::sqrt(squares / count), 0.03);
}

TEST_F(WholeTextureTest, TheBackIsTheFrontButForTheFace) {
  const Eigen::Vector3f skin(0.5F, 0.6F, 0.8F), hair(0.1F, 0.1F, 0.15F);
  Eigen::Vector3f shirt(0.2F, 0.7F, 0.2F), trousers(0.6F, 0.3F, 0.1F);
  const double waist = body_.joint_template()(0, 1), neck = body_.joint_template()(body_.FindJoint("neck"), 1);
  const int nose = body_.data().landmarks[body_.FindLandmark("nose")].vertices[0];
  const double hairline = rest_(nose, 1) + 0.07;
  const auto front = [&](const Eigen::Vector3d& p) {
    if (p.y() < waist) return trousers;
    if (p.y() < neck) return shirt;
    return p.y() > hairline ? hair : skin;
  };
  const RestViews views(rest_, body_.data().faces);
  const int ear = body_.data().landmarks[body_.FindLandmark("left_ear")].vertices[0];
  int back_of_trunk = 0, back_of_head = 0;
  Visit(Make(Seen(front, [&](const Eigen::Vector3d& p) { return views.SideOf(p) == RestSide::kFront; })),
        [&](const Eigen::Vector3d& p, BodyRegion region, TexelSource source, const Eigen::Vector3f& found) {
          if (views.SideOf(p) != RestSide::kBack || std::abs(p.x()) > 0.2) return;
          if (region == BodyRegion::kScalp && p.y() > rest_(nose, 1) && p.z() < rest_(ear, 2) - 0.04) {
            EXPECT_EQ(source, TexelSource::kHair);
            EXPECT_LT((found - hair).cwiseAbs().maxCoeff(), 0.12F) << p.transpose();
            ++back_of_head;
          }
          // The edges of clothes lie within a texel or two.
          if (region == BodyRegion::kElsewhere && std::abs(p.y() - waist) > 0.05 && p.y() < neck - 0.08) {
            EXPECT_LT((found - front(p)).cwiseAbs().maxCoeff(), 0.05F) << p.transpose();
            ++back_of_trunk;
          }
        });
  EXPECT_GT(back_of_trunk, 500);
  EXPECT_GT(back_of_head, 100);
}

TEST_F(WholeTextureTest, AGuessMeetsWhatWasSeenWithoutAStep) {
  // All of the left, and of the right arm the part beyond the elbow, in brighter light.
  const double elbow = body_.joint_template()(body_.FindJoint("r_elbow"), 0);
  const auto paint = [&](const Eigen::Vector3d& p) {
    const float value = p.x() < elbow ? 0.62F : 0.5F;
    return Eigen::Vector3f(value, value, value);
  };
  const double reach = 0.03 * kSide * 0.008;  // metres: a texel of 128 a side is some 8 mm
  int near = 0, far = 0;
  Visit(Make(Seen(paint, [&](const Eigen::Vector3d& p) { return p.x() > 0 || p.x() < elbow; })),
        [&](const Eigen::Vector3d& p, BodyRegion, TexelSource source, const Eigen::Vector3f& found) {
          if (source != TexelSource::kMirror) return;
          if (p.x() < elbow + 0.02) {
            EXPECT_GT(found[0], 0.53F) << p.transpose();
            ++near;
          } else if (p.x() > elbow + 6 * reach && p.x() < -0.2) {
            EXPECT_NEAR(found[0], 0.5F, 0.02F) << p.transpose();
            ++far;
          }
        });
  EXPECT_GT(near, 8);
  EXPECT_GT(far, 50);
}

TEST_F(WholeTextureTest, TrousersBesideAHandDoNotBecomeFingers) {
  const Eigen::Vector3f skin(0.5F, 0.6F, 0.8F), trousers(0.05F, 0.05F, 0.05F);
  const double reach = points_.col(0).cwiseAbs().maxCoeff();
  const auto paint = [&](const Eigen::Vector3d& p) { return std::abs(p.x()) > reach - 0.05 ? trousers : skin; };
  Visit(Make(Seen(paint, [](const Eigen::Vector3d& p) { return p.z() > 0; })),
        [&](const Eigen::Vector3d&, BodyRegion region, TexelSource, const Eigen::Vector3f& found) {
          if (region != BodyRegion::kHand) return;
          EXPECT_LT((found - skin).cwiseAbs().maxCoeff(), 0.1F);
        });
}

TEST_F(WholeTextureTest, RefusesWhatItCannotFill) {
  EXPECT_THROW(Make(Seen([](const auto&) { return Eigen::Vector3f(1, 1, 1); }, [](const auto&) { return false; })),
               std::runtime_error);
  Texture other;
  other.width = other.height = 64;
  other.confidence.assign(64 * 64, 1.0F);
  other.bgr.assign(3 * 64 * 64, 1.0F);
  EXPECT_THROW(Make(other), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::whole_texture_test
