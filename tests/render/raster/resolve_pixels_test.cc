// SPDX-License-Identifier: Apache-2.0
#include "render/raster/resolve_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/math/rotation.h"
#include "render/raster/visible_points.h"
#include "render/view/shaded_mesh.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::resolve_pixels_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct View {
  Camera camera;
  MatrixX3d vertices;
  VisibilityBuffer buffer;
  View(const Camera& view, uint32_t seed, double distance_m = 2.5)
      : camera(view),
        vertices(PoseVertices(ToyBody(), Eigen::VectorXd(), RandomPose(ToyBody(), seed, 1.0, distance_m))) {
    buffer.Render(vertices, ToyBody().data().faces, camera);
  }
  ResolvedPixels Resolve(const ResolveRequest& request) const {
    ResolvedPixels result;
    ResolvePixels(buffer, ToyBody(), vertices, camera, request, &result);
    return result;
  }
};

ResolveRequest Everything() {
  ResolveRequest request;
  request.part = request.chart_uv = request.atlas_uv = request.depth = request.normal = request.barycentric = true;
  return request;
}

class ResolvedPixelsOfCamera : public testing::TestWithParam<Camera> {};

TEST_P(ResolvedPixelsOfCamera, EqualTheDoublePrecisionPath) {
  for (const double distance_m : {2.5, 0.45}) {  // the second one stands in the near plane
    const View view(GetParam(), 31, distance_m);
    const ResolvedPixels pixels = view.Resolve(Everything());
    const VisiblePoints points = ResolveVisiblePoints(view.buffer, ToyBody(), view.vertices, view.camera,
                                                      {.part = true, .chart_uv = true, .depth = true});
    ASSERT_GT(points.size(), 1000u);
    size_t covered = 0;
    for (const int face : view.buffer.faces()) covered += face >= 0;
    ASSERT_EQ(covered, points.size());
    for (size_t i = 0; i < points.size(); ++i) {
      const size_t at = pixels.box.IndexOf(points.x[i], points.y[i]);
      ASSERT_EQ(pixels.part[at], points.part[i]);
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(pixels.barycentric[3 * at + c], points.barycentric[i][c], 1e-5)
            << points.x[i] << " " << points.y[i];
      }
      for (int c = 0; c < 2; ++c) ASSERT_NEAR(pixels.chart_uv[2 * at + c], points.chart_uv[i][c], 1e-5);
      ASSERT_NEAR(pixels.depth_m[at], points.depth_m[i], 1e-5);
      Vector2d uv = Vector2d::Zero();
      for (int c = 0; c < 3; ++c) {
        uv += points.barycentric[i][c] *
              ToyBody().data().vt.row(ToyBody().data().ft(points.face[i], c)).cast<double>().transpose();
      }
      ASSERT_NEAR(pixels.atlas_uv[2 * at], uv.x(), 1e-5);
      ASSERT_NEAR(pixels.atlas_uv[2 * at + 1], uv.y(), 1e-5);
    }
    // The background.
    for (size_t at = 0; at < pixels.box.area(); ++at) {
      if (view.buffer.faces()[at] >= 0) continue;
      ASSERT_EQ(pixels.part[at], 0);
      ASSERT_EQ(pixels.normal[3 * at + 2], 0);
      ASSERT_TRUE(std::isinf(pixels.depth_m[at]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ResolvedPixelsOfCamera,
                         testing::Values(MakePinhole(160, 160, 180), DistortedCamera(160, 160, 180),
                                         WeakCamera(160, 160, 75)));

TEST(ResolvePixels, AreCorrectInPerspective) {
  // A wall of the toy body's first face, tilted steeply: 1 m to 9 m away.
  BodyModelData data = ToyBodyData();
  const BodyModel body(std::move(data));
  MatrixX3d vertices = MatrixX3d::Constant(body.num_vertices(), 3, 50);
  const auto face = body.data().faces.row(0);
  vertices.row(face[0]) << -1, 1, 1;
  vertices.row(face[1]) << 1, 1, 1;
  vertices.row(face[2]) << 0, 1, 9;
  const Camera camera = MakePinhole(301, 301, 150);
  VisibilityBuffer buffer;
  buffer.Render(vertices, body.data().faces, camera, {.cull_back_faces = false});
  ASSERT_EQ(buffer.FaceAt(150, 200), 0);
  ResolvedPixels pixels;
  ResolvePixels(buffer, body, vertices, camera, {.depth = true, .barycentric = true}, &pixels);
  const size_t at = pixels.box.IndexOf(150, 200);  // meets z = 3
  EXPECT_NEAR(pixels.barycentric[3 * at + 2], 0.25, 1e-6);
  EXPECT_NEAR(pixels.depth_m[at], 3, 1e-5);
}

TEST(ResolvePixels, SameBytesForAnyNumberOfThreadsAndWhateverElseIsAsked) {
  const View view(DistortedCamera(200, 220, 230), 33);
  ResolveRequest all = Everything();
  std::vector<float> ramp(3 * size_t(ToyBody().num_vertices())), map(16 * 8 * 2);
  for (size_t i = 0; i < ramp.size(); ++i) ramp[i] = std::sin(0.37F * static_cast<float>(i));
  for (size_t i = 0; i < map.size(); ++i) map[i] = std::cos(1.7F * static_cast<float>(i));
  all.vertex_attributes = {{ramp, 3}};
  all.texel_attributes = {{map, 16, 8, 2}};
  const ResolvedPixels one = view.Resolve(all);
  for (const int threads : {2, 5}) {
    all.num_threads = threads;
    const ResolvedPixels many = view.Resolve(all);
    EXPECT_EQ(many.part, one.part);
    EXPECT_EQ(many.chart_uv, one.chart_uv);
    EXPECT_EQ(many.normal, one.normal);
    EXPECT_EQ(many.depth_m, one.depth_m);
    EXPECT_EQ(many.vertex_attributes, one.vertex_attributes);
    EXPECT_EQ(many.texel_attributes, one.texel_attributes);
  }
  EXPECT_EQ(view.Resolve({.part = true}).part, one.part);
  EXPECT_EQ(view.Resolve({.chart_uv = true}).chart_uv, one.chart_uv);
  EXPECT_EQ(view.Resolve({.atlas_uv = true}).atlas_uv, one.atlas_uv);
  EXPECT_EQ(view.Resolve({.depth = true}).depth_m, one.depth_m);
  EXPECT_EQ(view.Resolve({.normal = true}).normal, one.normal);
  EXPECT_EQ(view.Resolve({.barycentric = true}).barycentric, one.barycentric);
  EXPECT_EQ(view.Resolve({.texel_attributes = all.texel_attributes}).texel_attributes, one.texel_attributes);
  const ResolvedPixels nothing = view.Resolve({});
  EXPECT_TRUE(nothing.part.empty() && nothing.chart_uv.empty() && nothing.atlas_uv.empty() && nothing.depth_m.empty() &&
              nothing.normal.empty() && nothing.barycentric.empty() && nothing.vertex_attributes.empty());
}

TEST(ResolvePixels, TheWholeImageResolvesToTheSame) {
  const View view(MakePinhole(180, 150, 120), 34);
  VisibilityBuffer whole;
  whole.Render(view.vertices, ToyBody().data().faces, view.camera, {.whole_image = true});
  ResolvedPixels wide;
  ResolvePixels(whole, ToyBody(), view.vertices, view.camera, Everything(), &wide);
  const ResolvedPixels pixels = view.Resolve(Everything());
  for (int y = pixels.box.y_begin; y < pixels.box.y_end; ++y) {
    for (int x = pixels.box.x_begin; x < pixels.box.x_end; ++x) {
      const size_t a = pixels.box.IndexOf(x, y), b = wide.box.IndexOf(x, y);
      ASSERT_EQ(pixels.part[a], wide.part[b]);
      ASSERT_EQ(pixels.depth_m[a], wide.depth_m[b]);
      for (int c = 0; c < 3; ++c) ASSERT_EQ(pixels.normal[3 * a + c], wide.normal[3 * b + c]);
    }
  }
}

TEST(ResolvePixels, PositionsAsAttributesProjectBackOntoTheirPixels) {
  for (const Camera& camera : {MakePinhole(160, 160, 180), WeakCamera(160, 160, 75)}) {
    const View view(camera, 35);
    const MatrixX3f positions = view.vertices.cast<float>();
    ResolveRequest request;
    request.vertex_attributes = {{{positions.data(), size_t(positions.size())}, 3}};
    const ResolvedPixels pixels = view.Resolve(request);
    int exact = 0, all = 0;
    for (size_t at = 0; at < pixels.box.area(); ++at) {
      if (view.buffer.faces()[at] < 0) continue;
      const float* p = &pixels.vertex_attributes[0][3 * at];
      Vector2d pixel;
      ASSERT_TRUE(camera.Project(Vector3d(p[0], p[1], p[2]), &pixel));
      const int x = pixels.box.x_begin + static_cast<int>(at % pixels.box.width());
      const int y = pixels.box.y_begin + static_cast<int>(at / pixels.box.width());
      const double error = (pixel - Vector2d(x, y)).norm();
      ASSERT_LT(error, 0.01) << x << " " << y;  // pixels that rounding gave to a face they are just outside of
      exact += error < 1e-3, ++all;
    }
    EXPECT_GT(all, 1000);
    EXPECT_GT(exact, 0.97 * all);
  }
}

TEST(ResolvePixels, NormalsInOtherFramesAreTurnedCameraOnes) {
  const View view(MakePinhole(120, 120, 130), 36);
  const Eigen::Matrix3d R = RotationFromAxisAngle(Vector3d(0.3, -1.1, 0.6));
  const ResolvedPixels camera = view.Resolve({.normal = true});
  const ResolvedPixels turned = view.Resolve({.normal = true, .normal_frame_from_camera = R});
  const MatrixX3f flat = MatrixX3f::Zero(ToyBody().num_vertices(), 3);
  const ResolvedPixels none = view.Resolve({.normal = true, .vertex_normals = &flat});
  int towards = 0, covered = 0;
  for (size_t at = 0; at < camera.box.area(); ++at) {
    if (view.buffer.faces()[at] < 0) continue;
    const Vector3d n(camera.normal[3 * at], camera.normal[3 * at + 1], camera.normal[3 * at + 2]);
    const Vector3d m(turned.normal[3 * at], turned.normal[3 * at + 1], turned.normal[3 * at + 2]);
    ASSERT_NEAR(n.norm(), 1, 1e-5);
    ASSERT_LT((R * n - m).norm(), 1e-5);
    ASSERT_EQ(none.normal[3 * at], 0);
    towards += n.z() < 0.2, ++covered;  // what is seen faces the camera, but for interpolation at the rim
  }
  EXPECT_GT(towards, 0.97 * covered);
}

TEST(ResolvePixels, TexelsAreSampledBilinearlyInFloat) {
  // A map that is linear in u and v comes back exactly, between texel centres and beyond 1/32 texel.
  const int width = 40, height = 20;
  std::vector<float> values;
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const double u = (c + 0.5) / width, v = 1 - (r + 0.5) / height;
      values.push_back(static_cast<float>(2 * u - 3 * v + 1));
      values.push_back(static_cast<float>(5 * v));
    }
  }
  const TexelAttribute map{values, width, height, 2};
  std::mt19937 generator(37);
  for (int i = 0; i < 2000; ++i) {
    const float u = generator() / 4294967296.0F, v = generator() / 4294967296.0F;
    const double uc = std::clamp<double>(u, 0.5 / width, 1 - 0.5 / width);
    const double vc = std::clamp<double>(v, 0.5 / height, 1 - 0.5 / height);
    float got[2];
    SampleTexels(map, u, v, got);
    ASSERT_NEAR(got[0], 2 * uc - 3 * vc + 1, 2e-6);
    ASSERT_NEAR(got[1], 5 * vc, 3e-6);
  }
  for (const float out : {-3.0F, 7.5F, 1e9F}) {  // outside: the border
    float got[2], border[2];
    SampleTexels(map, out, 0.4F, got);
    SampleTexels(map, out < 0 ? 0.0F : 1.0F, 0.4F, border);
    EXPECT_EQ(got[0], border[0]);
  }
  const float one = 4.5F;
  float got;
  SampleTexels({{&one, 1}, 1, 1, 1}, 0.3F, 0.9F, &got);
  EXPECT_EQ(got, one);
}

TEST(ResolvePixels, AnEmptyImageResolvesToNothing) {
  View view(MakePinhole(64, 64, 60), 38);
  view.vertices.col(0).array() += 100;
  view.buffer.Render(view.vertices, ToyBody().data().faces, view.camera);
  const ResolvedPixels pixels = view.Resolve(Everything());
  EXPECT_TRUE(pixels.box.empty());
  EXPECT_TRUE(pixels.part.empty());
}

TEST(ResolvePixels, RefuseWhatTheBodyLacksAndSizesThatDoNotFit) {
  const View view(MakePinhole(64, 64, 60), 39);
  const std::vector<float> few(5);
  EXPECT_THROW(view.Resolve({.vertex_attributes = {{few, 1}}}), std::invalid_argument);
  EXPECT_THROW(view.Resolve({.vertex_attributes = {{few, 0}}}), std::invalid_argument);
  EXPECT_THROW(view.Resolve({.texel_attributes = {{few, 2, 2, 1}}}), std::invalid_argument);
  EXPECT_THROW(view.Resolve({.part = true, .num_threads = 0}), std::invalid_argument);
  const MatrixX3f normals = MatrixX3f::Zero(3, 3);
  EXPECT_THROW(view.Resolve({.normal = true, .vertex_normals = &normals}), std::invalid_argument);
  BodyModelData data = ToyBodyData();
  data.face_part.clear();
  data.face_iuv.resize(0, 6);
  data.vt.resize(0, 2);
  data.ft.resize(0, 3);
  const BodyModel plain(std::move(data));
  ResolvedPixels result;
  for (const ResolveRequest& request : {ResolveRequest{.part = true}, {.chart_uv = true}, {.atlas_uv = true}}) {
    EXPECT_THROW(ResolvePixels(view.buffer, plain, view.vertices, view.camera, request, &result),
                 std::invalid_argument);
  }
  EXPECT_NO_THROW(ResolvePixels(view.buffer, plain, view.vertices, view.camera, {.normal = true}, &result));
}

}  // namespace
}  // namespace bodyloom::resolve_pixels_test
