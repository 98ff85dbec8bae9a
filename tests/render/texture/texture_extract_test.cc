// SPDX-License-Identifier: Apache-2.0
#include "render/texture/texture_extract.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/render/painted_body.h"
#include "tests/support/meshes.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::texture_extract_test {
namespace {

using Eigen::Vector3d;

MatrixX3d Posed(uint32_t seed, double turn) {
  BodyPose pose = RandomPose(ToyBody(), seed, 0.7, 2.2);
  pose.rotations[0] = RotationFromAxisAngle(Vector3d(0, turn, 0)) * pose.rotations[0];
  return PoseVertices(ToyBody(), Eigen::VectorXd(), pose);
}

struct Comparison {
  double psnr = 0, worst = 0;
  int compared = 0;
};

Comparison Compare(const Texture& texture, const UvTexelTable& table, const BodyModel& body) {
  Comparison result;
  double squares = 0;
  const size_t pixels = size_t(texture.width) * texture.height;
  for (size_t i = 0; i < table.size(); ++i) {
    if (!(texture.confidence[table.pixel[i]] > 0)) continue;
    ++result.compared;
    const Vector3d truth = PaintAt(body, table.face[i], table.barycentric[i].cast<double>());
    for (int c = 0; c < 3; ++c) {
      const double error = std::abs(texture.bgr[c * pixels + table.pixel[i]] - truth[c]);
      squares += error * error;
      result.worst = std::max(result.worst, error);
    }
  }
  result.psnr = -10 * std::log10(squares / (3 * result.compared));
  return result;
}

class TextureOfCamera : public testing::TestWithParam<Camera> {};

TEST_P(TextureOfCamera, IsThePaintOnTheBody) {
  const BodyModel& body = ToyBody();
  const Camera& camera = GetParam();
  TextureExtractOptions options;
  options.texels.width = options.texels.height = 128;
  for (const auto merge : {TextureExtractOptions::Merge::kMedian, TextureExtractOptions::Merge::kMean}) {
    options.merge = merge;
    TextureExtractor extractor(body, options);
    for (int t = 0; t < 8; ++t) {
      const MatrixX3d vertices = Posed(t, 0.8 * t);
      EXPECT_GT(extractor.Add(PaintedImage(body, vertices, camera), vertices, camera, t), 300);
    }
    const Texture texture = extractor.Merge();
    const Comparison found = Compare(texture, extractor.table(), body);
    EXPECT_EQ(found.compared, texture.num_seen);
    EXPECT_GT(found.compared, 0.75 * extractor.table().num_inside);
    EXPECT_GT(found.psnr, 35);
    // Nothing of the background leaked in: that would be off by 0.2 at least.
    EXPECT_LT(found.worst, 0.18);
  }
}

INSTANTIATE_TEST_SUITE_P(All, TextureOfCamera,
                         testing::Values(MakePinhole(240, 240, 290), DistortedCamera(240, 240, 290),
                                         WeakCamera(240, 240, 125)));

TEST(TextureExtract, SourceMapsSayWhereTheColourIs) {
  const BodyModel& body = ToyBody();
  const Camera camera = MakePinhole(200, 200, 240);
  TextureExtractOptions options;
  options.texels.width = options.texels.height = 96;
  options.keep = 1;
  TextureExtractor extractor(body, options);
  std::vector<Image> images;
  std::vector<MatrixX3d> bodies;
  for (int t = 0; t < 3; ++t) {
    bodies.push_back(Posed(t, 2.0 * t));
    images.push_back(PaintedImage(body, bodies[t], camera));
    extractor.Add(images[t], bodies[t], camera, 10 + t);
  }
  const Texture texture = extractor.Merge();
  const UvTexelTable& table = extractor.table();
  for (size_t i = 0; i < table.size(); ++i) {
    const size_t p = table.pixel[i];
    if (!(texture.confidence[p] > 0)) {
      EXPECT_EQ(texture.source_frame[p], -1);
      EXPECT_EQ(texture.bgr[p], 0);
      continue;
    }
    ASSERT_LE(texture.confidence[p], 1);
    const int t = texture.source_frame[p] - 10;
    ASSERT_TRUE(t >= 0 && t < 3);
    float bgr[3];
    SampleImage(images[t], texture.source_x_px[p], texture.source_y_px[p], bgr);
    for (int c = 0; c < 3; ++c) ASSERT_EQ(texture.bgr[c * 9216 + p], bgr[c]);
    // The texel's point lies there.
    Vector3d point = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      point += double{table.barycentric[i][k]} * bodies[t].row(body.data().faces(table.face[i], k)).transpose();
    }
    Eigen::Vector2d pixel;
    ASSERT_TRUE(camera.Project(point, &pixel));
    ASSERT_LT((pixel - Eigen::Vector2d(texture.source_x_px[p], texture.source_y_px[p])).norm(), 1e-3);
  }
}

TEST(TextureExtract, StaysAwayFromContours) {
  const BodyModel& body = ToyBody();
  const Camera camera = MakePinhole(200, 200, 240);
  const MatrixX3d vertices = Posed(2, 0.4);
  const Image image = PaintedImage(body, vertices, camera);
  const Colour background = {255, 0, 255};
  size_t before = 1 << 30;
  for (const int margin : {0, 2, 6}) {
    TextureExtractOptions options;
    options.texels.width = options.texels.height = 96;
    options.edge_margin_px = margin;
    TextureExtractor extractor(body, options);
    extractor.Add(image, vertices, camera, 0);
    const Texture texture = extractor.Merge();
    EXPECT_GT(texture.num_seen, margin == 6 ? 50 : 300);
    EXPECT_LT(static_cast<size_t>(texture.num_seen), before);
    before = texture.num_seen;
    for (size_t p = 0; p < texture.confidence.size(); ++p) {
      if (!(texture.confidence[p] > 0)) continue;
      const int x = static_cast<int>(std::lround(texture.source_x_px[p]));
      const int y = static_cast<int>(std::lround(texture.source_y_px[p]));
      for (int d = -margin; d <= margin; ++d) {
        ASSERT_FALSE(image.at(x + d, y) == background) << margin;
        ASSERT_FALSE(image.at(x, y + d) == background) << margin;
      }
    }
  }
}

TEST(TextureExtract, MedianForgetsAMisplacedFrame) {
  const BodyModel& body = ToyBody();
  const Camera camera = MakePinhole(200, 200, 240);
  double psnr[2] = {};
  std::vector<float> seen_by_the_others;
  for (const int kind : {0, 1, 2}) {  // without the misplaced frame; with it, by median and by mean
    TextureExtractOptions options;
    options.texels.width = options.texels.height = 96;
    if (kind == 2) options.merge = TextureExtractOptions::Merge::kMean;
    TextureExtractor extractor(body, options);
    for (int t = 0; t < 5; ++t) {
      if (t == 2 && kind == 0) continue;
      const MatrixX3d vertices = Posed(1, 0.05 * t);
      MatrixX3d tracked = vertices;
      if (t == 2) tracked.col(0).array() += 0.08;  // the track was 8 cm off
      extractor.Add(PaintedImage(body, vertices, camera), tracked, camera, t);
    }
    Texture texture = extractor.Merge();
    if (kind == 0) {
      seen_by_the_others = texture.confidence;
      continue;
    }
    for (size_t p = 0; p < texture.confidence.size(); ++p) texture.confidence[p] *= seen_by_the_others[p];
    psnr[kind - 1] = Compare(texture, extractor.table(), body).psnr;
  }
  EXPECT_GT(psnr[0], psnr[1] + 3);
}

TEST(TexelVisibility, HiddenTexelsAreNotSeen) {
  // Two spheres, the small one in front; what the small one covers of the large one is hidden.
  const BodyModelData one = SphereOfOctants(4);
  BodyModelData two = one;
  const Eigen::Index V = one.v_template.rows(), F = one.faces.rows();
  MatrixX3d vertices(2 * V, 3);
  vertices << one.v_template.rowwise() + Eigen::RowVector3d(0, 0, 5),
      (0.3 * one.v_template).rowwise() + Eigen::RowVector3d(0.2, 0, 3.2);
  two.v_template = vertices;
  two.faces.resize(2 * F, 3);
  two.faces << one.faces, one.faces.array() + static_cast<int>(V);
  two.ft.resize(2 * F, 3);
  two.ft << one.ft, one.ft.array() + static_cast<int>(one.vt.rows());
  two.vt.resize(2 * one.vt.rows(), 2);
  two.vt << one.vt, one.vt;
  two.vt.col(0) *= 0.5F;
  two.vt.bottomRows(one.vt.rows()).col(0).array() += 0.5F;
  two.shapedirs.resize(6 * V, 0);
  std::vector<Eigen::Triplet<double>> regressor, weights;
  for (Eigen::Index v = 0; v < 2 * V; ++v) {
    regressor.emplace_back(0, v, 0.5 / static_cast<double>(V));
    weights.emplace_back(v, 0, 1.0);
  }
  two.J_regressor.resize(1, 2 * V);
  two.J_regressor.setFromTriplets(regressor.begin(), regressor.end());
  two.weights.resize(2 * V, 1);
  two.weights.setFromTriplets(weights.begin(), weights.end());
  const BodyModel body(two);
  const Camera camera = MakePinhole(300, 300, 420);
  VisibilityBuffer buffer;
  buffer.Render(vertices, body.data().faces, camera);
  const UvTexelTable table = BuildUvTexelTable(body, {.width = 256, .height = 128});
  const auto sights = ComputeTexelVisibility(table, body, vertices, camera, buffer, {.min_cosine = 0.1});
  int seen = 0, hidden = 0;
  for (size_t i = 0; i < table.size(); ++i) {
    if (table.in_gutter[i]) {
      EXPECT_EQ(sights[i].cosine, 0);
      continue;
    }
    Vector3d p = Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      p += double{table.barycentric[i][k]} * vertices.row(body.data().faces(table.face[i], k)).transpose();
    const bool large = table.face[i] < F;
    const Vector3d centre = large ? Vector3d(0, 0, 5) : Vector3d(0.2, 0, 3.2);
    const double cosine = -(p - centre).normalized().dot(p.normalized());
    // Distance of the ray from the small sphere's centre.
    const double miss = p.normalized().cross(Vector3d(0.2, 0, 3.2)).norm();
    if (cosine < 0.05 || (large && miss < 0.29)) {
      EXPECT_EQ(sights[i].cosine, 0) << (large ? "large" : "small");
      ++hidden;
    } else if (cosine > 0.15 && !(large && miss < 0.31)) {
      ASSERT_GT(sights[i].cosine, 0) << (large ? "large " : "small ") << cosine << " " << miss;
      EXPECT_NEAR(sights[i].cosine, cosine, 0.1);
      ++seen;
    }
  }
  EXPECT_GT(seen, 2000);
  EXPECT_GT(hidden, 3000);
  // A body out of the picture, and one behind the camera, are not seen at all.
  for (const Vector3d& away : {Vector3d(50, 0, 0), Vector3d(0, 0, -20)}) {
    const MatrixX3d moved = vertices.rowwise() + away.transpose();
    buffer.Render(moved, body.data().faces, camera);
    for (const TexelVisibility& sight : ComputeTexelVisibility(table, body, moved, camera, buffer))
      ASSERT_EQ(sight.cosine, 0);
  }
}

TEST(TextureExtract, TakesNothingWhereTheMaskShowsSomethingElse) {
  const Camera camera = MakePinhole(200, 300, 260);
  const MatrixX3d vertices = Posed(3, 0.4);
  TextureExtractOptions options;
  options.texels.width = options.texels.height = 128;
  options.edge_margin_px = 2;
  TextureExtractor extractor(ToyBody(), options);
  std::vector<uint8_t> person(size_t(200) * 300, 1);
  EXPECT_EQ(TextureExtractor(ToyBody(), options).Add(Image(200, 300), vertices, camera, 0, person),
            TextureExtractor(ToyBody(), options).Add(Image(200, 300), vertices, camera, 0));
  for (int y = 0; y < 300; ++y) std::fill_n(person.begin() + size_t(y) * 200, 100, uint8_t{0});
  EXPECT_GT(extractor.Add(Image(200, 300), vertices, camera, 0, person), 50);
  const Texture texture = extractor.Merge();
  for (size_t p = 0; p < texture.confidence.size(); ++p) {
    if (texture.confidence[p] > 0) {
      EXPECT_GT(texture.source_x_px[p], 100);
    }
  }
  person.pop_back();
  EXPECT_THROW(extractor.Add(Image(200, 300), vertices, camera, 0, person), std::invalid_argument);
}

TEST(TextureExtract, KeepsFurtherAwayFromLimbsInFront) {
  const Camera camera = MakePinhole(400, 600, 520);
  // The right arm before the trunk.
  BodyPose pose = PoseFromAxisAngle(ToyBody(), Eigen::VectorXd::Zero(72), {0, 0, 2.5});
  pose.rotations[0] = RotationFromAxisAngle(Vector3d(EIGEN_PI, 0, 0));
  pose.rotations[ToyBody().FindJoint("r_shoulder")] = RotationFromAxisAngle(Vector3d(0, 2.2, 0));
  const MatrixX3d vertices = PoseVertices(ToyBody(), Eigen::VectorXd(), pose);
  std::vector<int> seen;
  for (const int margin : {-1, 2, 12}) {
    TextureExtractOptions options;
    options.texels.width = options.texels.height = 128;
    options.step_margin_px = margin;
    seen.push_back(TextureExtractor(ToyBody(), options).Add(Image(400, 600), vertices, camera, 0));
  }
  EXPECT_EQ(seen[0], seen[1]) << "both are 2 px";
  EXPECT_LT(seen[2], 0.99 * seen[1]);
  EXPECT_GT(seen[2], 0.5 * seen[1]) << "the outer contour keeps its own margin";
}

TEST(TextureExtract, RefusesWhatDoesNotFit) {
  TextureExtractOptions options;
  options.keep = 0;
  EXPECT_THROW(TextureExtractor(ToyBody(), options), std::invalid_argument);
  options = {};
  options.sight.min_cosine = 1;
  EXPECT_THROW(TextureExtractor(ToyBody(), options), std::invalid_argument);
  options = {};
  options.texels.width = options.texels.height = 16;
  TextureExtractor extractor(ToyBody(), options);
  EXPECT_THROW(extractor.Add(Image(10, 10), Posed(1, 0), MakePinhole(11, 10, 10), 0), std::invalid_argument);
  EXPECT_EQ(extractor.Merge().num_seen, 0);
}

}  // namespace
}  // namespace bodyloom::texture_extract_test
