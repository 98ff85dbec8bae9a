// SPDX-License-Identifier: Apache-2.0
// The visibility buffer against its reference implementation: equal faces and bit-identical depths on every pixel, for
// every instruction set and any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "render/raster/raster_simd.h"
#include "render/raster/visibility_buffer.h"
#include "tests/support/raster_twin.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::raster_law_test {
namespace {

struct Scene {
  std::string name;
  MatrixX3d vertices;
  MatrixX3i faces;
  Camera camera;
  bool cull_back_faces = true;
};

/// Triangles of all sizes and shapes: needles, specks, repeated corners and positions, some beyond the image.
Scene Soup(const Camera& camera, uint32_t seed, bool cull, int count = 400) {
  Scene scene{"soup", MatrixX3d(3 * count, 3), MatrixX3i(count, 3), camera, cull};
  std::mt19937 generator(seed);
  const auto uniform = [&] { return generator() / 4294967296.0 * 2 - 1; };
  for (int f = 0; f < count; ++f) {
    const double size = std::pow(10.0, -2.5 + 2.5 * std::abs(uniform()));
    const Eigen::RowVector3d middle{1.2 * uniform(), 1.2 * uniform(), 3 + uniform()};
    for (int c = 0; c < 3; ++c) {
      scene.vertices.row(3 * f + c) = middle + size * Eigen::RowVector3d{uniform(), uniform(), uniform()};
      scene.vertices(3 * f + c, 2) = std::max(scene.vertices(3 * f + c, 2), 0.6);
      scene.faces(f, c) = 3 * f + c;
    }
    if (f % 16 == 3) scene.vertices.row(3 * f + 1) = scene.vertices.row(3 * f);                  // no area
    if (f % 16 == 5) scene.faces(f, 2) = scene.faces(f, 0);                                      // named twice
    if (f % 16 == 7 && f > 0) scene.faces.row(f) = scene.faces.row(f - 1);                       // there already
    if (f % 16 == 9) scene.vertices.row(3 * f + 2) = scene.vertices.row(3 * f) + 1e-4 * middle;  // a needle
  }
  return scene;
}

Scene Body(const Camera& camera, uint32_t seed, bool cull) {
  return {"body", PoseVertices(ToyBody(), Eigen::VectorXd(), RandomPose(ToyBody(), seed, 1.0, 2.2)),
          ToyBody().data().faces, camera, cull};
}

std::vector<Scene> Scenes() {
  std::vector<Scene> scenes;
  uint32_t seed = 1;
  for (const bool cull : {true, false}) {
    // The last one is so large that most faces need 64-bit edge functions.
    for (const int size : {1, 37, 150, 900}) {
      for (const Camera& camera : {MakePinhole(size, size + 7, 1.1 * size), DistortedCamera(size, size + 7, 1.1 * size),
                                   WeakCamera(size, size + 7, 0.4 * size)}) {
        scenes.push_back(Soup(camera, seed++, cull, size > 500 ? 60 : 400));
        scenes.push_back(Body(camera, seed++, cull));
      }
    }
  }
  return scenes;
}

void ExpectEqual(const Scene& scene, const TwinImage& twin, const VisibilityBuffer& buffer, const std::string& how) {
  int covered = 0;
  for (int y = 0; y < twin.height; ++y) {
    for (int x = 0; x < twin.width; ++x) {
      const size_t at = size_t(y) * twin.width + x;
      ASSERT_EQ(buffer.FaceAt(x, y), twin.face[at]) << scene.name << " at " << x << " " << y << ", " << how;
      if (twin.face[at] < 0) continue;
      ++covered;
      ASSERT_EQ(buffer.nearness()[buffer.box().IndexOf(x, y)], twin.nearness[at]) << scene.name << " " << x << " " << y;
    }
  }
  EXPECT_GE(covered, twin.width > 100 ? twin.width * twin.height / 50 : 0);
}

struct SimdTargetInUse {
  explicit SimdTargetInUse(int64_t target) { raster_internal::ForceSimdTarget(target); }
  ~SimdTargetInUse() { raster_internal::ForceSimdTarget(0); }
};

TEST(RasterLaw, EveryInstructionSetAndThreadCountEqualsTheTwin) {
  const std::vector<int64_t> targets = raster_internal::SimdTargets();
  EXPECT_GE(targets.size(), 1u);
  for (const Scene& scene : Scenes()) {
    const TwinImage twin = RasterTwin(scene.vertices, scene.faces, scene.camera, scene.cull_back_faces);
    for (const int64_t target : targets) {
      const SimdTargetInUse use(target);
      VisibilityBuffer buffer;
      for (const int threads : {1, 2, 5}) {
        buffer.Render(scene.vertices, scene.faces, scene.camera,
                      {.cull_back_faces = scene.cull_back_faces, .num_threads = threads});
        ExpectEqual(scene, twin, buffer,
                    raster_internal::SimdTargetName(target) + ", threads " + std::to_string(threads));
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

TEST(RasterLaw, TheTwinItselfNeedsNoBoundingBox) {
  for (const Camera& camera : {MakePinhole(90, 80, 100), WeakCamera(90, 80, 40)}) {
    const Scene scene = Soup(camera, 77, false, 60);
    const TwinImage twin = RasterTwin(scene.vertices, scene.faces, camera, false);
    const TwinImage all = RasterTwin(scene.vertices, scene.faces, camera, false, true);
    EXPECT_EQ(twin.face, all.face);
    EXPECT_EQ(twin.covers, all.covers);
  }
}

TEST(RasterLaw, TheWholeImageShowsWhatTheBoxShows) {
  for (const Scene& scene : {Body(MakePinhole(400, 300, 120), 5, true), Soup(WeakCamera(200, 100, 30), 6, false)}) {
    VisibilityBuffer box, whole;
    box.Render(scene.vertices, scene.faces, scene.camera, {.cull_back_faces = scene.cull_back_faces});
    whole.Render(scene.vertices, scene.faces, scene.camera,
                 {.cull_back_faces = scene.cull_back_faces, .whole_image = true});
    EXPECT_EQ(whole.box().area(), size_t(scene.camera.width) * scene.camera.height);
    EXPECT_LE(box.box().area(), whole.box().area());
    for (int y = 0; y < scene.camera.height; ++y) {
      for (int x = 0; x < scene.camera.width; ++x) {
        ASSERT_EQ(box.FaceAt(x, y), whole.FaceAt(x, y));
        ASSERT_EQ(box.DepthAt(x, y), whole.DepthAt(x, y));
      }
    }
  }
}

TEST(RasterLaw, AnImageOf16kPixelsCostsThePersonsBoxAlone) {
  const Camera camera = MakePinhole(16384, 16384, 900);
  const Scene scene = Body(camera, 8, true);
  VisibilityBuffer buffer, near;
  buffer.Render(scene.vertices, scene.faces, camera, {.num_threads = 2});
  EXPECT_LT(buffer.box().area(), 2000u * 2000u);
  EXPECT_GT(buffer.box().area(), 300u * 300u);
  Camera window = camera;  // the same pixels, named from the box's corner
  window.width = buffer.box().width(), window.height = buffer.box().height();
  window.cx -= buffer.box().x_begin, window.cy -= buffer.box().y_begin;
  near.Render(scene.vertices, scene.faces, window);
  ASSERT_EQ(near.box().area(), buffer.box().area());
  EXPECT_TRUE(std::equal(near.faces().begin(), near.faces().end(), buffer.faces().begin()));
}

TEST(RasterLaw, AFaceAcrossA16kImageIsDrawnToItsLastPixel) {
  // 16,000 px wide and 3 px high: exact 64-bit edges, thousands of tiles in a row.
  Scene scene{"stripe", MatrixX3d(4, 3), MatrixX3i(2, 3), WeakCamera(16384, 8, 1)};
  scene.camera.cx = scene.camera.cy = 0;
  scene.vertices << 100, 2, 1, 16100, 2, 1, 16100, 5, 1, 100, 5, 1;
  scene.faces << 0, 2, 1, 0, 3, 2;
  VisibilityBuffer buffer;
  buffer.Render(scene.vertices, scene.faces, scene.camera, {.num_threads = 2});
  const TwinImage twin = RasterTwin(scene.vertices, scene.faces, scene.camera, true);
  ExpectEqual(scene, twin, buffer, "stripe");
  EXPECT_EQ(std::count_if(buffer.faces().begin(), buffer.faces().end(), [](int f) { return f >= 0; }), 16000 * 3);
}

TEST(RasterLaw, TiesGoToTheLowestFaceAlsoBetweenSmallAndLargeOnes) {
  // Two squares in one plane, one of them 600 px wide; whichever comes first in the list is seen where both are.
  MatrixX3d vertices(8, 3);
  vertices << 10, 10, 2, 610, 10, 2, 610, 610, 2, 10, 610, 2, 100, 100, 2, 140, 100, 2, 140, 140, 2, 100, 140, 2;
  Camera camera = WeakCamera(640, 640, 1);
  camera.cx = camera.cy = 0;
  for (const bool large_first : {true, false}) {
    MatrixX3i faces(4, 3);
    faces << 0, 2, 1, 0, 3, 2, 4, 6, 5, 4, 7, 6;
    if (!large_first) faces << 4, 6, 5, 4, 7, 6, 0, 2, 1, 0, 3, 2;
    VisibilityBuffer buffer;
    buffer.Render(vertices, faces, camera);
    for (int y = 100; y < 140; ++y) {
      for (int x = 100; x < 140; ++x) ASSERT_LT(buffer.FaceAt(x, y), 2) << x << " " << y;
    }
    EXPECT_EQ(buffer.FaceAt(300, 200), large_first ? 0 : 2);
  }
}

TEST(RasterLaw, EdgesThroughPixelCentresOfALargeGridGiveNoHolesAndNoDoubleHits) {
  // Every vertex on a pixel centre, faces of 1 to 300 px, diagonals through centres.
  for (const int step : {1, 7, 300}) {
    const int cells = 600 / step;
    Scene scene{"grid", MatrixX3d((cells + 1) * (cells + 1), 3), MatrixX3i(2 * cells * cells, 3),
                WeakCamera(604, 604, 1)};
    scene.camera.cx = scene.camera.cy = 0;
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) scene.vertices.row(i * (cells + 1) + j) << 2 + step * j, 2 + step * i, 3;
    }
    for (int i = 0, f = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        const int a = i * (cells + 1) + j, b = a + 1, c = b + cells + 1, d = a + cells + 1;
        scene.faces.row(f++) << a, c, b;
        scene.faces.row(f++) << a, d, c;
      }
    }
    const TwinImage twin = RasterTwin(scene.vertices, scene.faces, scene.camera, true);
    VisibilityBuffer buffer;
    buffer.Render(scene.vertices, scene.faces, scene.camera);
    ExpectEqual(scene, twin, buffer, "grid");
    for (int y = 0; y < 604; ++y) {
      for (int x = 0; x < 604; ++x) {
        const bool inside = x >= 2 && x < 2 + cells * step && y >= 2 && y < 2 + cells * step;
        ASSERT_EQ(twin.covers[size_t(y) * 604 + x], inside ? 1 : 0) << x << " " << y << ", step " << step;
      }
    }
  }
}

/// First face hit by the ray through a pixel's centre, in double and in space: no projection, no clipping. `margin` is
/// the distance of the ray from an edge, in barycentrics of the nearest face hit or missed.
int RayCast(const Scene& scene, int x, int y, double near_m, double* margin, double* depth) {
  const Eigen::Vector2d a = scene.camera.Unproject(Eigen::Vector2d(x, y));
  const bool weak = scene.camera.model == CameraModel::kWeakPerspective;
  const Eigen::Vector3d origin = weak ? Eigen::Vector3d(a.x(), a.y(), 0) : Eigen::Vector3d::Zero();
  const Eigen::Vector3d ray = weak ? Eigen::Vector3d::UnitZ().eval() : Eigen::Vector3d(a.x(), a.y(), 1);
  int best = -1;
  *depth = std::numeric_limits<double>::infinity(), *margin = std::numeric_limits<double>::infinity();
  for (int f = 0; f < scene.faces.rows(); ++f) {
    Eigen::Matrix3d corners;
    for (int c = 0; c < 3; ++c) corners.col(c) = scene.vertices.row(scene.faces(f, c)).transpose();
    const Eigen::Vector3d e1 = corners.col(1) - corners.col(0), e2 = corners.col(2) - corners.col(0);
    const Eigen::Vector3d p = ray.cross(e2);
    const double det = e1.dot(p);
    if (det == 0) continue;
    const Eigen::Vector3d s = origin - corners.col(0), q = s.cross(e1);
    const double b = s.dot(p) / det, c = ray.dot(q) / det, z = e2.dot(q) / det;
    if (!(z >= near_m)) {
      if (z > 0.9 * near_m) *margin = 0;
      continue;
    }
    const double inside = std::min({b, c, 1 - b - c});
    *margin = std::min(*margin, std::abs(inside));
    if (inside >= 0 && z < *depth) *depth = z, best = f;
  }
  return best;
}

TEST(RasterLaw, ClippedFacesAreWhereRaysMeetThem) {
  // Triangles all around and through the camera: in front, behind, across the near plane.
  std::mt19937 generator(9);
  const auto uniform = [&] { return generator() / 4294967296.0 * 2 - 1; };
  Scene scene{"clipped", MatrixX3d(90, 3), MatrixX3i(30, 3), MakePinhole(120, 100, 70), false};
  for (int v = 0; v < 90; ++v) {
    scene.vertices.row(v) << 3 * uniform(), 3 * uniform(), 3 * uniform();
    scene.faces(v / 3, v % 3) = v;
  }
  const double near_m = 0.05;
  int compared = 0, hits = 0, clipped = 0;
  for (const int threads : {1, 3}) {
    VisibilityBuffer buffer;
    buffer.Render(scene.vertices, scene.faces, scene.camera,
                  {.cull_back_faces = false, .near_m = near_m, .num_threads = threads});
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 120; ++x) {
        double margin, depth;
        const int expected = RayCast(scene, x, y, near_m, &margin, &depth);
        if (margin < 2e-3) continue;  // rounding to 1/256 px may decide otherwise beside an edge
        ASSERT_EQ(buffer.FaceAt(x, y), expected) << x << " " << y;
        ++compared;
        if (expected < 0) continue;
        ++hits;
        ASSERT_NEAR(buffer.DepthAt(x, y) / depth, 1, 2e-2) << x << " " << y;
        clipped += scene.vertices(3 * expected, 2) < near_m || scene.vertices(3 * expected + 1, 2) < near_m ||
                   scene.vertices(3 * expected + 2, 2) < near_m;
      }
    }
  }
  EXPECT_GT(compared, 20000);
  EXPECT_GT(hits, 10000);
  EXPECT_GT(clipped, 5000);
}

TEST(RasterLaw, ABodyThroughTheCameraIsDrawnInFrontOfItOnly) {
  for (const Camera& camera : {MakePinhole(160, 120, 100), DistortedCamera(160, 120, 100)}) {
    Scene scene = Body(camera, 11, false);
    scene.vertices.col(2).array() -= 2.2;  // the camera is inside the belly
    VisibilityBuffer buffer;
    buffer.Render(scene.vertices, scene.faces, camera, {.cull_back_faces = false});
    int covered = 0;
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        if (buffer.FaceAt(x, y) < 0) continue;
        ++covered;
        ASSERT_GE(buffer.DepthAt(x, y), 0.0099);
        ASSERT_LT(buffer.DepthAt(x, y), 3);
      }
    }
    EXPECT_GT(covered, 2000);
    scene.vertices.col(2).array() -= 5;  // all of it behind
    buffer.Render(scene.vertices, scene.faces, camera, {.cull_back_faces = false});
    EXPECT_TRUE(buffer.box().empty());
  }
}

TEST(RasterLaw, AFailedImageShowsNothing) {
  Scene scene = Body(MakePinhole(50, 50, 50), 12, true);
  VisibilityBuffer buffer;
  buffer.Render(scene.vertices, scene.faces, scene.camera);
  EXPECT_FALSE(buffer.box().empty());
  for (const int threads : {1, 4}) {
    MatrixX3d broken = scene.vertices;
    broken(17, 2) = std::numeric_limits<double>::infinity();
    EXPECT_THROW(buffer.Render(broken, scene.faces, scene.camera, {.num_threads = threads}), std::invalid_argument);
    EXPECT_TRUE(buffer.box().empty());
    EXPECT_TRUE(buffer.faces().empty());
  }
  EXPECT_THROW(buffer.Render(scene.vertices, scene.faces, scene.camera, {.num_threads = 0}), std::invalid_argument);
  MatrixX3i faces = scene.faces;
  faces(3, 1) = -1;
  EXPECT_THROW(buffer.Render(scene.vertices, faces, scene.camera), std::invalid_argument);
  buffer.Render(scene.vertices, MatrixX3i(0, 3), scene.camera);
  EXPECT_TRUE(buffer.box().empty());
  buffer.Render(MatrixX3d(0, 3), MatrixX3i(0, 3), scene.camera);
  EXPECT_TRUE(buffer.box().empty());
}

}  // namespace
}  // namespace bodyloom::raster_law_test
