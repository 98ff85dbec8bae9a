// SPDX-License-Identifier: Apache-2.0
#include "render/view/shaded_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "render/raster/raster_simd.h"
#include "render/view/overlay.h"
#include "render/view/shade_simd.h"
#include "render/view/view_camera.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::shaded_mesh_test {
namespace {

MatrixX3d ToyVertices(uint32_t seed, double distance_m) {
  return PoseVertices(ToyBody(), Eigen::VectorXd(), RandomPose(ToyBody(), seed, 0.8, distance_m));
}

Image Noise(int width, int height) {
  Image image(width, height);
  std::mt19937 generator(3);
  for (uint8_t& byte : image.bgr) byte = static_cast<uint8_t>(generator());
  return image;
}

std::vector<Colour> PartColours() {
  std::vector<Colour> colours;
  for (const uint8_t part : ToyBody().data().face_part) colours.push_back(PartColour(part));
  return colours;
}

TEST(MeshDrawer, SameBytesForAnyNumberOfThreadsAndEveryInstructionSet) {
  const MatrixX3d vertices = ToyVertices(41, 2.2);
  for (const Camera& camera : {MakePinhole(203, 170, 190), WeakCamera(203, 170, 80), DistortedCamera(203, 170, 190)}) {
    for (const int samples : {1, 2, 3, 4}) {
      const MeshStyle style{.face_colours = PartColours(), .alpha = 0.7, .samples = samples};
      Image expected = Noise(203, 170);
      DrawMesh(vertices, ToyBody().data().faces, camera, style, &expected);
      MeshDrawer drawer;
      for (const int threads : {2, 5}) {
        MeshStyle threaded = style;
        threaded.num_threads = threads;
        Image image = Noise(203, 170);
        drawer.Draw(vertices, ToyBody().data().faces, camera, threaded, &image);
        ASSERT_EQ(image, expected) << threads << " threads, " << samples << " samples";
      }
      for (const int64_t target : raster_internal::SimdTargets()) {
        raster_internal::ForceSimdTarget(target);
        Image image = Noise(203, 170);
        drawer.Draw(vertices, ToyBody().data().faces, camera, style, &image);
        raster_internal::ForceSimdTarget(0);
        ASSERT_EQ(image, expected) << raster_internal::SimdTargetName(target);
      }
    }
  }
}

TEST(MeshDrawer, OneLightAPixelLooksLikeOneASample) {
  // The same picture three times as large, every sample a pixel of its own, shrunk by averaging.
  const Camera camera = MakePinhole(200, 200, 230);
  const MatrixX3d vertices = ToyVertices(42, 2.2);
  const Image background(200, 200, {60, 140, 90});
  Image image = background, large(600, 600, {60, 140, 90});
  const MeshStyle style{.face_colours = PartColours(), .alpha = 0.8, .contour_px = 1, .samples = 3};
  DrawMesh(vertices, ToyBody().data().faces, camera, style, &image);
  MeshStyle fine = style;
  fine.samples = 1, fine.contour_px = 3;
  DrawMesh(vertices, ToyBody().data().faces, ScaledCamera(camera, 3), fine, &large);
  double sum = 0;
  int worst = 0, touched = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      touched += !(image.at(x, y) == background.at(x, y));
      for (int c = 0; c < 3; ++c) {
        int mean = 4;
        for (int j = 0; j < 3; ++j) {
          for (int i = 0; i < 3; ++i) mean += large.pixel(3 * x + i, 3 * y + j)[c];
        }
        const int difference = std::abs(mean / 9 - image.pixel(x, y)[c]);
        sum += difference;
        worst = std::max(worst, difference);
      }
    }
  }
  EXPECT_GT(touched, 4000);
  EXPECT_LE(worst, 16);  // where the toy body's coarse faces bend within a pixel
  EXPECT_LT(sum / (3.0 * touched), 0.6);
}

TEST(MeshDrawer, TouchesOnlyTheMeshAndItsLine) {
  const Image before = Noise(320, 240);
  Image image = before;
  const Camera camera = MakePinhole(320, 240, 120);
  const MatrixX3d vertices = ToyVertices(43, 3);
  DrawMesh(vertices, ToyBody().data().faces, camera, {}, &image);
  VisibilityBuffer buffer;
  buffer.Render(vertices, ToyBody().data().faces, camera);
  const PixelBox box = buffer.box().GrownBy(1);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      ASSERT_TRUE(box.Contains(x, y) || image.at(x, y) == before.at(x, y)) << x << " " << y;
    }
  }
  EXPECT_NE(image, before);
  MatrixX3d beside = vertices;
  beside.col(0).array() += 50;
  image = before;
  DrawMesh(beside, ToyBody().data().faces, camera, {}, &image);
  EXPECT_EQ(image, before);
}

TEST(MeshDrawer, BordersOfTheImageEndNoSurface) {
  // A wall that reaches beyond the image on all sides has no contour.
  MatrixX3d vertices(4, 3);
  vertices << -9, -9, 2, 9, -9, 2, 9, 9, 2, -9, 9, 2;
  MatrixX3i faces(2, 3);
  faces << 0, 2, 1, 0, 3, 2;
  for (const int samples : {1, 2, 3}) {
    Image image(40, 30), plain(40, 30);
    DrawMesh(vertices, faces, MakePinhole(40, 30, 40), {.samples = samples}, &image);
    DrawMesh(vertices, faces, MakePinhole(40, 30, 40), {.contour_px = 0, .samples = samples}, &plain);
    EXPECT_EQ(image, plain);
  }
}

TEST(Overlay, SameImageForAnyNumberOfThreads) {
  Track track;
  track.camera = MakePinhole(160, 120, 130);
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses = RandomAxisAngle(ToyBody(), 44, 0.5).transpose();
  track.motion.trans = Eigen::RowVector3d(0, 0.2, 3);
  track.motion.timestamps = {0};
  track.frame_status = {FrameStatus::kTracked};
  OverlayOptions one, three;
  one.side_view = three.side_view = true;
  three.num_threads = 3;
  EXPECT_EQ(OverlayRenderer(ToyBody(), track, three).Render(0, {}),
            OverlayRenderer(ToyBody(), track, one).Render(0, {}));
  three.num_threads = 0;
  EXPECT_THROW(OverlayRenderer(ToyBody(), track, three), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::shaded_mesh_test
