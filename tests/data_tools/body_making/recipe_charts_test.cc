// SPDX-License-Identifier: Apache-2.0
/// Promises of assets/body/RECIPE.md, section 8: charts and atlas.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <map>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <set>

#include "tests/data_tools/body_making/recipe_support.h"

namespace bodyloom::recipe_charts_test {
namespace {

using Triangle2 = Eigen::Matrix<double, 3, 2>;

Triangle2 AtlasTriangle(Eigen::Index f) {
  const BodyModelData& data = BuiltinBody().data();
  Triangle2 uv;
  for (int k = 0; k < 3; ++k) uv.row(k) = data.vt.row(data.ft(f, k)).cast<double>();
  return uv;
}

Triangle2 PartTriangle(Eigen::Index f) {
  return Eigen::Map<const Eigen::Matrix<float, 3, 2, Eigen::RowMajor>>(&BuiltinBody().data().face_iuv(f, 0))
      .cast<double>();
}

double SignedArea(const Triangle2& t) {
  const Eigen::RowVector2d a = t.row(1) - t.row(0), b = t.row(2) - t.row(0);
  return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

/// Island number of each face: faces connected through shared UV vertices.
std::vector<int> Islands(int* count) {
  const BodyModelData& data = BuiltinBody().data();
  std::vector<int> parent(data.vt.rows());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (Eigen::Index f = 0; f < data.ft.rows(); ++f) {
    for (int k = 1; k < 3; ++k) parent[find(data.ft(f, k))] = find(data.ft(f, 0));
  }
  std::map<int, int> number;
  std::vector<int> island;
  for (Eigen::Index f = 0; f < data.ft.rows(); ++f) {
    island.push_back(number.emplace(find(data.ft(f, 0)), static_cast<int>(number.size())).first->second);
  }
  *count = static_cast<int>(number.size());
  return island;
}

/// Counts, for each pixel centre of a size² image, the triangles that contain it, and stores `label` there. Centres are
/// moved by an irrational fraction of a pixel so that none lies on an edge.
void Rasterise(const Triangle2& uv, int label, cv::Mat1i* owner, cv::Mat1i* hits) {
  const int size = owner->rows;
  const double shift_x = 1e-4 * std::sqrt(2), shift_y = 1e-4 * std::sqrt(3);
  const auto pixel = [&](double x) { return std::clamp(static_cast<int>(std::floor(x * size)), 0, size - 1); };
  const double area = SignedArea(uv);
  for (int row = pixel(uv.col(1).minCoeff() - 1.0 / size); row <= pixel(uv.col(1).maxCoeff() + 1.0 / size); ++row) {
    for (int col = pixel(uv.col(0).minCoeff() - 1.0 / size); col <= pixel(uv.col(0).maxCoeff() + 1.0 / size); ++col) {
      const Eigen::RowVector2d p((col + 0.5 + shift_x) / size, (row + 0.5 + shift_y) / size);
      bool inside = true;
      for (int k = 0; k < 3 && inside; ++k) {
        Triangle2 part = uv;
        part.row(k) = p;
        inside = SignedArea(part) * area > 0;
      }
      if (!inside) continue;
      (*owner)(row, col) = label;
      ++(*hits)(row, col);
    }
  }
}

/// Singular values (large, small) of the map from the rest surface to the plane.
Eigen::Vector2d Stretch(Eigen::Index f, const Triangle2& uv) {
  const BodyModelData& data = BuiltinBody().data();
  const Eigen::Vector3d p0 = data.v_template.row(data.faces(f, 0)), p1 = data.v_template.row(data.faces(f, 1)),
                        p2 = data.v_template.row(data.faces(f, 2));
  const Eigen::Vector3d x = (p1 - p0).normalized(), n = (p1 - p0).cross(p2 - p0).normalized(), y = n.cross(x);
  Eigen::Matrix2d in_plane, in_uv;
  in_plane << (p1 - p0).dot(x), (p2 - p0).dot(x), (p1 - p0).dot(y), (p2 - p0).dot(y);
  in_uv.col(0) = (uv.row(1) - uv.row(0)).transpose();
  in_uv.col(1) = (uv.row(2) - uv.row(0)).transpose();
  return Eigen::JacobiSVD<Eigen::Matrix2d>(Eigen::Matrix2d(in_uv * in_plane.inverse())).singularValues();
}

double FaceArea(Eigen::Index f) {
  const BodyModelData& data = BuiltinBody().data();
  const Eigen::Vector3d a = data.v_template.row(data.faces(f, 0)), b = data.v_template.row(data.faces(f, 1)),
                        c = data.v_template.row(data.faces(f, 2));
  return 0.5 * (b - a).cross(c - a).norm();
}

Eigen::RowVector3d FaceCentre(Eigen::Index f) {
  const BodyModelData& data = BuiltinBody().data();
  return (data.v_template.row(data.faces(f, 0)) + data.v_template.row(data.faces(f, 1)) +
          data.v_template.row(data.faces(f, 2))) /
         3;
}

TEST(RecipeCharts, Islands) {
  const BodyModelData& data = BuiltinBody().data();
  int count = 0;
  const std::vector<int> island = Islands(&count);
  EXPECT_EQ(count, 28);
  EXPECT_EQ(data.vt.rows(), 8892);
  std::map<int, std::set<int>> islands_of_part, parts_of_island;
  for (Eigen::Index f = 0; f < data.ft.rows(); ++f) {
    islands_of_part[data.face_part[f]].insert(island[f]);
    parts_of_island[island[f]].insert(data.face_part[f]);
  }
  ASSERT_EQ(islands_of_part.size(), 24u);
  EXPECT_EQ(islands_of_part.begin()->first, 1);
  EXPECT_EQ(islands_of_part.rbegin()->first, 24);
  for (const auto& [part, islands] : islands_of_part) {
    EXPECT_EQ(islands.size(), part >= 3 && part <= 6 ? 2u : 1u) << "part " << part;
  }
  for (const auto& [number, parts] : parts_of_island) EXPECT_EQ(parts.size(), 1u);
  // UV vertices are split at seams only: within an island a body vertex has one of them.
  std::map<std::pair<int, int>, int> uv_of;
  for (Eigen::Index f = 0; f < data.ft.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto [it, is_new] = uv_of.emplace(std::pair(island[f], data.faces(f, k)), data.ft(f, k));
      EXPECT_EQ(it->second, data.ft(f, k));
    }
  }
}

TEST(RecipeCharts, NoFlipsNoOverlapsInTheAtlas) {
  const BodyModelData& data = BuiltinBody().data();
  constexpr int kSize = 2048;
  int count = 0;
  const std::vector<int> island = Islands(&count);
  cv::Mat1i owner(kSize, kSize, -1), hits(kSize, kSize, 0);
  double smallest_area = 1;
  for (Eigen::Index f = 0; f < data.ft.rows(); ++f) {
    smallest_area = std::min(smallest_area, SignedArea(AtlasTriangle(f)));
    Rasterise(AtlasTriangle(f), island[f], &owner, &hits);
  }
  EXPECT_GT(smallest_area, 0) << "a flipped triangle";
  EXPECT_EQ(cv::countNonZero(hits > 1), 0) << "overlapping pixels";
  const double coverage = static_cast<double>(cv::countNonZero(hits)) / (kSize * kSize);
  EXPECT_NEAR(coverage, 0.52, 0.005);
  RecordProperty("coverage", std::to_string(coverage));

  // Gutters: distance of every island to the nearest pixel of any other, and to the border.
  double gutter = 1;
  for (int i = 0; i < count; ++i) {
    cv::Mat1b others(kSize, kSize, uchar{255});
    others.setTo(0, (owner >= 0) & (owner != i));
    cv::Mat1f distance;
    cv::distanceTransform(others, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    double nearest = 0;
    cv::minMaxLoc(distance, &nearest, nullptr, nullptr, nullptr, owner == i);
    gutter = std::min(gutter, (nearest - 1) / kSize);
  }
  RecordProperty("smallest_gutter", std::to_string(gutter));
  EXPECT_GE(gutter, 0.0236);
  EXPECT_GE(data.vt.minCoeff(), 0.0097f);
  EXPECT_LE(data.vt.maxCoeff(), 1 - 0.0097f);
}

TEST(RecipeCharts, PartCoordinates) {
  const BodyModelData& data = BuiltinBody().data();
  EXPECT_GE(data.face_iuv.minCoeff(), 0.02f - 1e-6f);
  EXPECT_LE(data.face_iuv.maxCoeff(), 0.98f + 1e-6f);
  constexpr int kSize = 1024;
  for (int part = 1; part <= 24; ++part) {
    cv::Mat1i owner(kSize, kSize, -1), hits(kSize, kSize, 0);
    Eigen::Array2d low(1, 1), high(0, 0);
    for (Eigen::Index f = 0; f < data.ft.rows(); ++f) {
      if (data.face_part[f] != part) continue;
      const Triangle2 uv = PartTriangle(f);
      EXPECT_GT(SignedArea(uv), 0) << "part " << part << " face " << f;
      low = low.min(uv.colwise().minCoeff().transpose().array());
      high = high.max(uv.colwise().maxCoeff().transpose().array());
      Rasterise(uv, part, &owner, &hits);
    }
    EXPECT_EQ(cv::countNonZero(hits > 1), 0) << "part " << part;
    EXPECT_GT(cv::countNonZero(hits), 0.4 * kSize * kSize) << "part " << part;
    EXPECT_LT((low - 0.02).abs().maxCoeff(), 1e-4) << "part " << part;
    EXPECT_LT((high - 0.98).abs().maxCoeff(), 1e-4) << "part " << part;
  }
}

/// (i,u,v) of the right side is that of the left with u → 1 − u.
TEST(RecipeCharts, PartCoordinatesAreMirrorSymmetric) {
  const BodyModelData& data = BuiltinBody().data();
  const std::vector<int> mirror = MirrorByPosition(data.v_template);
  const int other_side[25] = {0, 1, 2, 4, 3, 6, 5, 8, 7, 10, 9, 12, 11, 14, 13, 16, 15, 18, 17, 20, 19, 22, 21, 24, 23};
  std::map<std::array<int, 3>, Eigen::Index> face_of;
  for (Eigen::Index f = 0; f < data.faces.rows(); ++f) {
    std::array<int, 3> corners = {data.faces(f, 0), data.faces(f, 1), data.faces(f, 2)};
    std::sort(corners.begin(), corners.end());
    face_of[corners] = f;
  }
  for (Eigen::Index f = 0; f < data.faces.rows(); ++f) {
    std::array<int, 3> corners = {mirror[data.faces(f, 0)], mirror[data.faces(f, 1)], mirror[data.faces(f, 2)]};
    std::sort(corners.begin(), corners.end());
    ASSERT_TRUE(face_of.contains(corners));
    const Eigen::Index g = face_of.at(corners);
    ASSERT_EQ(int{data.face_part[g]}, other_side[data.face_part[f]]);
    const Triangle2 a = PartTriangle(f), b = PartTriangle(g);
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        if (data.faces(g, l) != mirror[data.faces(f, k)]) continue;
        EXPECT_NEAR(b(l, 0), 1 - a(k, 0), 1e-6);
        EXPECT_NEAR(b(l, 1), a(k, 1), 1e-6);
      }
    }
  }
}

TEST(RecipeCharts, PartsLieWhereTheirNamesSay) {
  const BodyModelData& data = BuiltinBody().data();
  std::map<int, Eigen::RowVector3d> centre, normal;
  std::map<int, double> area;
  for (Eigen::Index f = 0; f < data.faces.rows(); ++f) {
    const Eigen::Vector3d a = data.v_template.row(data.faces(f, 0)), b = data.v_template.row(data.faces(f, 1)),
                          c = data.v_template.row(data.faces(f, 2));
    const int part = data.face_part[f];
    area.try_emplace(part, 0);
    centre.try_emplace(part, Eigen::RowVector3d::Zero());
    normal.try_emplace(part, Eigen::RowVector3d::Zero());
    area[part] += FaceArea(f);
    centre[part] += FaceArea(f) * FaceCentre(f);
    normal[part] += 0.5 * (b - a).cross(c - a).transpose();
  }
  for (auto& [part, sum] : centre) sum /= area[part];
  for (int left : {4, 5, 8, 10, 12, 14, 15, 17, 19, 21, 24}) EXPECT_GT(centre[left].x(), 0.02) << left;
  for (int right : {3, 6, 7, 9, 11, 13, 16, 18, 20, 22, 23}) EXPECT_LT(centre[right].x(), -0.02) << right;
  for (int front : {2, 9, 10, 13, 14}) EXPECT_GT(normal[front].z(), 0.5 * normal[front].norm()) << front;
  for (int back : {1, 7, 8, 11, 12}) EXPECT_LT(normal[back].z(), -0.5 * normal[back].norm()) << back;
  // In T-pose with the palms down the inner side of the arm looks down (and forward on the upper arm), the outer side
  // up.
  for (int inner : {15, 16, 19, 20}) EXPECT_LT(normal[inner].y(), -0.5 * normal[inner].norm()) << inner;
  for (int outer : {17, 18, 21, 22}) EXPECT_GT(normal[outer].y(), 0.5 * normal[outer].norm()) << outer;
  for (int upper : {15, 16, 17, 18}) EXPECT_LT(std::abs(centre[upper].x()), std::abs(centre[upper + 4].x()));
  EXPECT_GT(normal[15].z(), 0);
  EXPECT_LT(normal[17].z(), 0);
}

TEST(RecipeCharts, UpIsTowardsHeadShoulderFingersAndToes) {
  const BodyModelData& data = BuiltinBody().data();
  for (int part = 1; part <= 24; ++part) {
    Eigen::RowVector3d up(0, 1, 0);                                         // torso, legs, head
    if (part == 3 || part == 4) up = {part == 4 ? 1.0 : -1.0, 0, 0};        // fingers
    if (part == 5 || part == 6) up = {0, 0, 1};                             // toes
    if (part >= 15 && part <= 22) up = {part % 2 == 1 ? -1.0 : 1.0, 0, 0};  // shoulder
    double covariance = 0;
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    double total = 0, v_mean = 0;
    for (Eigen::Index f = 0; f < data.faces.rows(); ++f) {
      if (data.face_part[f] != part) continue;
      centre += FaceArea(f) * FaceCentre(f);
      v_mean += FaceArea(f) * PartTriangle(f).col(1).mean();
      total += FaceArea(f);
    }
    double variance_up = 0, variance_v = 0;
    for (Eigen::Index f = 0; f < data.faces.rows(); ++f) {
      if (data.face_part[f] != part) continue;
      const double height = (FaceCentre(f) - centre / total).dot(up),
                   v = PartTriangle(f).col(1).mean() - v_mean / total;
      covariance += FaceArea(f) * height * v;
      variance_up += FaceArea(f) * height * height;
      variance_v += FaceArea(f) * v * v;
    }
    EXPECT_GT(covariance / std::sqrt(variance_up * variance_v), 0.85) << "part " << part;
  }
}

TEST(RecipeCharts, TexelDensityAndDistortion) {
  const BodyModelData& data = BuiltinBody().data();
  std::map<int, double> area, uv_area, anisotropy;
  double worst = 0;
  int count = 0;
  const std::vector<int> island = Islands(&count);
  std::vector<int> part_of(count);
  for (Eigen::Index f = 0; f < data.faces.rows(); ++f) {
    const double a = FaceArea(f);
    const Eigen::Vector2d stretch = Stretch(f, AtlasTriangle(f));
    area[island[f]] += a;
    uv_area[island[f]] += SignedArea(AtlasTriangle(f));
    anisotropy[island[f]] += a * stretch[0] / stretch[1];
    worst = std::max(worst, stretch[0] / stretch[1]);
    part_of[island[f]] = data.face_part[f];
  }
  EXPECT_LT(worst, 3.2);
  for (int i = 0; i < count; ++i) {
    const int part = part_of[i];
    const double density = std::sqrt(uv_area[i] / area[i]) / 0.508;
    const double mean_anisotropy = anisotropy[i] / area[i];
    SCOPED_TRACE("part " + std::to_string(part));
    if (part == 5 || part == 6) {  // foot top 1.15, sole 1
      EXPECT_TRUE(std::abs(density - 1.15) < 0.02 || std::abs(density - 1) < 0.025) << density;
      EXPECT_TRUE(std::abs(mean_anisotropy - 1.09) < 0.02 || std::abs(mean_anisotropy - 1.24) < 0.02)
          << mean_anisotropy;
    } else if (part == 3 || part == 4) {
      EXPECT_NEAR(density, 1.5 / 1.015, 0.02);
      EXPECT_TRUE(mean_anisotropy > 1.03 && mean_anisotropy < 1.09) << mean_anisotropy;
    } else if (part >= 23) {
      EXPECT_NEAR(density, 1.5, 0.025);
      EXPECT_NEAR(mean_anisotropy, 1.09, 0.01);
    } else if (part >= 15) {  // arms: stretched after the charts were made
      EXPECT_NEAR(density, 0.97, 0.02);
      EXPECT_GT(mean_anisotropy, 1.0);
      EXPECT_LT(mean_anisotropy, 1.08);
    } else {
      EXPECT_NEAR(density, 1, 0.02);
      EXPECT_GT(mean_anisotropy, 1.0);
      EXPECT_LT(mean_anisotropy, 1.06);
    }
  }
}

}  // namespace
}  // namespace bodyloom::recipe_charts_test
