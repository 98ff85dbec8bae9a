// SPDX-License-Identifier: Apache-2.0
#include "render/raster/visibility_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::visibility_buffer_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Scene {
  MatrixX3d vertices;
  MatrixX3i faces;
  Camera camera;
};

Scene ToyScene(const Camera& camera, uint32_t seed, double distance_m = 2.5) {
  return {PoseVertices(ToyBody(), Eigen::VectorXd(), RandomPose(ToyBody(), seed, 1.0, distance_m)),
          ToyBody().data().faces, camera};
}

/// The law of the header once more, pixel by pixel over all faces and without any incremental arithmetic. A pixel
/// centre on an edge is decided by moving it to the right by a little, and down by much less: that is what top-left
/// means.
struct Seen {
  int face = -1;
  float nearness = -std::numeric_limits<float>::infinity();
};

struct Snapped {
  double x, y, nearness;  ///< 1/256 px
};

std::vector<Snapped> Snap(const Scene& scene) {
  std::vector<Snapped> result;
  for (int v = 0; v < scene.vertices.rows(); ++v) {
    const Vector3d X = scene.vertices.row(v);
    Vector2d pixel;
    EXPECT_TRUE(scene.camera.Project(X, &pixel));
    const bool weak = scene.camera.model == CameraModel::kWeakPerspective;
    result.push_back({std::floor(pixel.x() * 256 + 0.5), std::floor(pixel.y() * 256 + 0.5), weak ? -X.z() : 1 / X.z()});
  }
  return result;
}

Seen BruteForce(const std::vector<Snapped>& snapped, const MatrixX3i& faces, int x, int y, bool cull) {
  Seen best;
  for (int f = 0; f < faces.rows(); ++f) {
    const std::array<Snapped, 3> s = {snapped[faces(f, 0)], snapped[faces(f, 1)], snapped[faces(f, 2)]};
    const double area = (s[1].x - s[0].x) * (s[2].y - s[0].y) - (s[1].y - s[0].y) * (s[2].x - s[0].x);
    if (area == 0 || (cull && area > 0)) continue;
    const double sign = area > 0 ? 1 : -1;
    bool inside = true;
    double nearness = 0;
    for (int c = 0; c < 3; ++c) {
      const Snapped &p = s[(c + 1) % 3], &q = s[(c + 2) % 3];
      const double dx = q.x - p.x, dy = q.y - p.y;
      const double value = sign * (dx * (y * 256.0 - p.y) - dy * (x * 256.0 - p.x));  // exact: below 2^53
      const double moved_right = -sign * dy, moved_down = sign * dx;
      inside = inside && (value > 0 || (value == 0 && (moved_right > 0 || (moved_right == 0 && moved_down > 0))));
      nearness += value / std::abs(area) * s[c].nearness;
    }
    if (inside && static_cast<float>(nearness) > best.nearness) best = {f, static_cast<float>(nearness)};
  }
  return best;
}

void ExpectEqualToBruteForce(const Scene& scene, bool cull) {
  VisibilityBuffer buffer;
  buffer.Render(scene.vertices, scene.faces, scene.camera, {.cull_back_faces = cull});
  const std::vector<Snapped> snapped = Snap(scene);
  int covered = 0, different = 0;
  for (int y = 0; y < scene.camera.height; ++y) {
    for (int x = 0; x < scene.camera.width; ++x) {
      const Seen expected = BruteForce(snapped, scene.faces, x, y, cull);
      const int face = buffer.FaceAt(x, y);
      covered += expected.face >= 0;
      // Two faces may be equally near to the last bit of a float; which one wins then depends on how it was summed.
      if (face != expected.face) {
        ASSERT_GE(face, 0) << "hole at " << x << " " << y;
        ASSERT_GE(expected.face, 0) << "false hit at " << x << " " << y;
        ++different;
      }
      if (expected.face >= 0) {
        ASSERT_NEAR(buffer.nearness()[buffer.box().IndexOf(x, y)], expected.nearness,
                    1e-6 * std::abs(expected.nearness));
      }
    }
  }
  EXPECT_GT(covered, 250);
  EXPECT_LE(different, covered / 2000);
}

TEST(VisibilityBuffer, EqualsBruteForcePinhole) {
  for (uint32_t seed : {1, 2}) ExpectEqualToBruteForce(ToyScene(MakePinhole(80, 90, 95), seed), true);
}

TEST(VisibilityBuffer, EqualsBruteForceWithBackFaces) {
  ExpectEqualToBruteForce(ToyScene(MakePinhole(80, 90, 95), 3), false);
}

TEST(VisibilityBuffer, EqualsBruteForceDistorted) {
  ExpectEqualToBruteForce(ToyScene(DistortedCamera(80, 90, 95), 4), true);
}

TEST(VisibilityBuffer, EqualsBruteForceWeakPerspective) {
  ExpectEqualToBruteForce(ToyScene(WeakCamera(80, 90, 40), 5), true);
}

TEST(VisibilityBuffer, EqualsBruteForceWhenThePersonLeavesTheImage) {
  Scene scene = ToyScene(MakePinhole(60, 60, 120), 6);
  scene.camera.cx = 10;
  scene.camera.cy = 70;
  ExpectEqualToBruteForce(scene, true);
}

/// A regular grid of cells×cells quads, `step` pixels apart, from pixel (1, 1), seen by a camera of 1 px a metre.
Scene GridScene(int cells, double step, double shear) {
  Scene scene;
  scene.camera = WeakCamera(int(cells * step * (1 + shear)) + 4, int(cells * step) + 4, 1);
  scene.camera.cx = scene.camera.cy = 0;
  scene.vertices.resize((cells + 1) * (cells + 1), 3);
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      scene.vertices.row(i * (cells + 1) + j) << 1 + step * j + shear * step * i, 1 + step * i, 5;
    }
  }
  scene.faces.resize(2 * cells * cells, 3);
  for (int i = 0, f = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const int a = i * (cells + 1) + j, b = a + 1, c = b + cells + 1, d = a + cells + 1;
      scene.faces.row(f++) << a, c, b;  // counter-clockwise with y down
      scene.faces.row(f++) << a, d, c;
    }
  }
  return scene;
}

/// Number of faces that cover each pixel, each face drawn alone.
std::vector<int> Coverage(const Scene& scene) {
  std::vector<int> count(size_t(scene.camera.width) * scene.camera.height, 0);
  VisibilityBuffer buffer;
  for (int f = 0; f < scene.faces.rows(); ++f) {
    buffer.Render(scene.vertices, scene.faces.row(f), scene.camera);
    for (int y = 0; y < scene.camera.height; ++y) {
      for (int x = 0; x < scene.camera.width; ++x)
        count[size_t(y) * scene.camera.width + x] += buffer.FaceAt(x, y) >= 0;
    }
  }
  return count;
}

TEST(VisibilityBuffer, EdgesThroughPixelCentresGiveNoHolesAndNoDoubleHits) {
  for (const double step : {1.0, 2.0, 3.5}) {
    for (const double shear : {0.0, 1.0}) {
      const Scene scene = GridScene(8, step, shear);
      const std::vector<int> count = Coverage(scene);
      int covered = 0;
      for (int y = 0; y < scene.camera.height; ++y) {
        for (int x = 0; x < scene.camera.width; ++x) {
          const double left = 1 + shear * (y - 1);
          const bool inside = y >= 1 && y < 1 + 8 * step && x >= left && x < left + 8 * step;
          ASSERT_EQ(count[size_t(y) * scene.camera.width + x], inside ? 1 : 0)
              << "pixel " << x << " " << y << ", step " << step << ", shear " << shear;
          covered += inside;
        }
      }
      EXPECT_EQ(covered, int(8 * step) * int(8 * step));
    }
  }
}

TEST(VisibilityBuffer, RandomTrianglesThatShareEdgesCoverEachPixelOnce) {
  // A fan around a pixel centre with rim points on pixel centres: edges in all directions through many centres.
  Scene scene;
  scene.camera = WeakCamera(64, 64, 1);
  scene.camera.cx = scene.camera.cy = 0;
  const int n = 24;
  scene.vertices.resize(n + 1, 3);
  scene.vertices.row(n) << 31, 30, 2;
  for (int k = 0; k < n; ++k) {
    scene.vertices.row(k) << std::round(31 + 28 * std::cos(2 * M_PI * k / n)),
        std::round(30 + 28 * std::sin(2 * M_PI * k / n)), 2;
  }
  scene.faces.resize(n, 3);
  for (int k = 0; k < n; ++k) scene.faces.row(k) << n, (k + 1) % n, k;
  const std::vector<int> count = Coverage(scene);
  EXPECT_EQ(*std::max_element(count.begin(), count.end()), 1);
  EXPECT_GT(std::accumulate(count.begin(), count.end(), 0), 2300);  // π 28² = 2463
  for (int y = 10; y < 50; ++y) EXPECT_EQ(count[size_t(y) * 64 + 31], 1) << "hole at 31 " << y;
}

TEST(VisibilityBuffer, FaceThatReachesBehindTheCameraIsClippedNotLost) {
  // A floor 1 m below the camera, from 10 m behind it to 1000 m in front.
  Scene scene;
  scene.camera = MakePinhole(64, 64, 50);
  scene.vertices.resize(4, 3);
  scene.vertices << -500, 1, -10, 500, 1, -10, 500, 1, 1000, -500, 1, 1000;
  scene.faces.resize(2, 3);
  scene.faces << 0, 1, 2, 0, 2, 3;  // the sight from above
  VisibilityBuffer buffer;
  buffer.Render(scene.vertices, scene.faces, scene.camera, {.cull_back_faces = false});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double slope = (y - 31.5) / 50;  // the ray meets the floor at z = 1 / slope
      const bool expected = slope > 0 && 1 / slope < 1000 && std::abs((x - 31.5) / 50 / slope) < 500;
      ASSERT_EQ(buffer.FaceAt(x, y) >= 0, expected) << x << " " << y;
      // Rounding to 1/256 px moves the clipped corners, which lie 10^5 px away, by very little.
      if (!expected) continue;
      ASSERT_NEAR(buffer.DepthAt(x, y), 1 / slope, 2e-3 / slope) << x << " " << y;
    }
  }
}

TEST(VisibilityBuffer, NothingNearerThanTheNearPlaneIsSeen) {
  Scene scene;
  scene.camera = MakePinhole(32, 32, 30);
  scene.vertices.resize(6, 3);
  scene.vertices << -9, -9, 0.4, 9, -9, 0.4, 0, 9, 0.4, -9, -9, 2, 9, -9, 2, 0, 9, 2;
  scene.faces.resize(2, 3);
  scene.faces << 0, 2, 1, 3, 5, 4;
  VisibilityBuffer buffer;
  buffer.Render(scene.vertices, scene.faces, scene.camera, {.cull_back_faces = false, .near_m = 0.5});
  EXPECT_EQ(buffer.FaceAt(16, 16), 1);
  buffer.Render(scene.vertices, scene.faces, scene.camera, {.cull_back_faces = false, .near_m = 0.3});
  EXPECT_EQ(buffer.FaceAt(16, 16), 0);
  scene.vertices.col(2).array() -= 10;  // all behind
  buffer.Render(scene.vertices, scene.faces, scene.camera, {.cull_back_faces = false});
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) ASSERT_EQ(buffer.FaceAt(x, y), -1);
  }
}

TEST(VisibilityBuffer, FacesOutsideTheGuardBandAreClipped) {
  for (const bool weak : {false, true}) {
    Scene scene;
    scene.camera = weak ? WeakCamera(40, 40, 1000) : MakePinhole(40, 40, 1000);
    scene.vertices.resize(3, 3);
    scene.vertices << -1e7, -1e7, 1, 1e7, -1e7, 1, 0, 2e7, 1;  // 10^10 px
    scene.faces.resize(1, 3);
    scene.faces << 0, 2, 1;
    VisibilityBuffer buffer;
    buffer.Render(scene.vertices, scene.faces, scene.camera);
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) ASSERT_EQ(buffer.FaceAt(x, y), 0) << (weak ? "weak " : "pinhole ") << x << " " << y;
    }
    EXPECT_NEAR(buffer.DepthAt(20, 20), 1, 1e-6);
  }
}

TEST(VisibilityBuffer, LowestFaceWinsATie) {
  Scene scene = GridScene(4, 3.5, 0);
  const MatrixX3i once = scene.faces;
  scene.faces.resize(2 * once.rows(), 3);
  scene.faces << once, once;
  VisibilityBuffer buffer, plain;
  buffer.Render(scene.vertices, scene.faces, scene.camera);
  plain.Render(scene.vertices, once, scene.camera);
  EXPECT_TRUE(std::equal(buffer.faces().begin(), buffer.faces().end(), plain.faces().begin(), plain.faces().end()));
}

TEST(VisibilityBuffer, OrderOfFacesCornersAndVerticesDoesNotMatter) {
  const Scene scene = ToyScene(MakePinhole(200, 200, 220), 7);
  std::mt19937 generator(8);
  std::vector<int> face_order(scene.faces.rows()), vertex_order(scene.vertices.rows());
  std::iota(face_order.begin(), face_order.end(), 0);
  std::iota(vertex_order.begin(), vertex_order.end(), 0);
  std::shuffle(face_order.begin(), face_order.end(), generator);
  std::shuffle(vertex_order.begin(), vertex_order.end(), generator);
  Scene shuffled = scene;
  for (int v = 0; v < scene.vertices.rows(); ++v) shuffled.vertices.row(vertex_order[v]) = scene.vertices.row(v);
  for (int f = 0; f < scene.faces.rows(); ++f) {
    for (int c = 0; c < 3; ++c) shuffled.faces(f, (c + f) % 3) = vertex_order[scene.faces(face_order[f], c)];
  }
  VisibilityBuffer a, b;
  a.Render(scene.vertices, scene.faces, scene.camera);
  b.Render(shuffled.vertices, shuffled.faces, scene.camera);
  int different = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const int face = b.FaceAt(x, y);
      ASSERT_EQ(a.FaceAt(x, y) >= 0, face >= 0);
      different += face >= 0 && face_order[face] != a.FaceAt(x, y);
    }
  }
  EXPECT_EQ(different, 0);
}

TEST(VisibilityBuffer, VisitsOnlyThePersonAndForgetsTheLastFrame) {
  Scene scene = ToyScene(MakePinhole(1000, 800, 150), 9);
  VisibilityBuffer buffer, fresh;
  buffer.Render(scene.vertices, scene.faces, scene.camera);
  const PixelBox first = buffer.box();
  EXPECT_LT(first.width(), 200);
  EXPECT_LT(first.height(), 200);
  EXPECT_GT(first.height(), 50);
  const auto any_in_row = [&](int y) {
    for (int x = first.x_begin; x < first.x_end; ++x) {
      if (buffer.FaceAt(x, y) >= 0) return true;
    }
    return false;
  };
  EXPECT_TRUE(any_in_row(first.y_begin + 1));
  EXPECT_TRUE(any_in_row(first.y_end - 2));
  scene.vertices.col(0).array() += 1.5;
  buffer.Render(scene.vertices, scene.faces, scene.camera);
  fresh.Render(scene.vertices, scene.faces, scene.camera);
  EXPECT_TRUE(std::equal(buffer.faces().begin(), buffer.faces().end(), fresh.faces().begin(), fresh.faces().end()));
  EXPECT_EQ(buffer.FaceAt(first.x_begin, first.y_begin + 1), -1);
  scene.vertices.col(0).array() += 100;
  buffer.Render(scene.vertices, scene.faces, scene.camera);
  EXPECT_TRUE(buffer.box().empty());
  EXPECT_EQ(buffer.FaceAt(500, 400), -1);
  EXPECT_EQ(buffer.DepthAt(500, 400), std::numeric_limits<double>::infinity());
}

TEST(VisibilityBuffer, TellsHiddenPointsFromVisibleOnes) {
  const Camera camera = MakePinhole(200, 200, 220);
  Eigen::VectorXd upright = RandomAxisAngle(ToyBody(), 0, 0);
  const BodyPose pose = PoseFromAxisAngle(ToyBody(), upright, Vector3d(0, 0, 2.5));
  VisibilityBuffer buffer;
  buffer.Render(PoseVertices(ToyBody(), Eigen::VectorXd(), pose), ToyBody().data().faces, camera);
  const MatrixX3d landmarks = PoseLandmarks(ToyBody(), Eigen::VectorXd(), pose, {"nose", "left_heel", "left_ear"});
  EXPECT_TRUE(buffer.IsVisible(landmarks.row(0), 0.01));
  EXPECT_FALSE(buffer.IsVisible(landmarks.row(1), 0.01));      // behind the foot
  EXPECT_FALSE(buffer.IsVisible(Vector3d(0, 0, 3), 0.1));      // behind the belly
  EXPECT_TRUE(buffer.IsVisible(Vector3d(0, 0, 1), 0.01));      // in front of it
  EXPECT_TRUE(buffer.IsVisible(Vector3d(0.9, 0.9, 3), 0.01));  // beside the body
  EXPECT_FALSE(buffer.IsVisible(Vector3d(9, 0, 3), 0.01));     // outside the image
  EXPECT_FALSE(buffer.IsVisible(Vector3d(0, 0, -1), 0.01));    // behind the camera
}

TEST(VisibilityBuffer, RefusesWhatItCannotSee) {
  Scene scene = ToyScene(MakePinhole(20, 20, 20), 10);
  VisibilityBuffer buffer;
  Camera no_size = scene.camera;
  no_size.width = 0;
  EXPECT_THROW(buffer.Render(scene.vertices, scene.faces, no_size), std::invalid_argument);
  EXPECT_THROW(buffer.Render(scene.vertices.topRows(5), scene.faces, scene.camera), std::invalid_argument);
  EXPECT_THROW(buffer.Render(scene.vertices, scene.faces, scene.camera, {.near_m = 0}), std::invalid_argument);
  scene.vertices(3, 1) = std::nan("");
  EXPECT_THROW(buffer.Render(scene.vertices, scene.faces, scene.camera), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::visibility_buffer_test
