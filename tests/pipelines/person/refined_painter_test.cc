// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/refined_painter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bodyloom/pipelines/person/open_refiner.h"
#include "bodyloom/render/overlay.h"
#include "bodyloom/render/view_camera.h"
#include "tests/support/coloured_person.h"
#include "tests/support/random_picture_unet.h"
#include "tests/support/short_track.h"

namespace bodyloom {
namespace {

TEST(RefinedPainter, ARefinerThatChangesNothingDrawsThePerson) {
  const PhotoPerson person = ColouredPerson();
  const Track moved = MovedByPerson(person, ShortTrack(2));
  const MatrixX3d vertices = TrackVertices(*person.body, moved, 0);
  const Camera camera = moved.CameraAt(0);
  PictureRefiner refiner(RandomRefiner(0));
  const Image background(camera.width, camera.height, Colour{10, 250, 90});
  Image drawn = background, refined = background;
  std::vector<uint8_t> covered(static_cast<size_t>(camera.width) * camera.height, 0), covered_refined = covered;
  RefinedPainter(person, 1, nullptr).Draw(vertices, camera, &drawn, &covered);
  RefinedPainter(person, 1, &refiner).Draw(vertices, camera, &refined, &covered_refined);
  EXPECT_EQ(covered, covered_refined);
  int person_pixels = 0;
  for (size_t i = 0; i < drawn.bgr.size(); ++i) {
    ASSERT_NEAR(drawn.bgr[i], refined.bgr[i], 2) << i;
    person_pixels += covered[i / 3] == 255 ? 1 : 0;
  }
  EXPECT_GT(person_pixels, 1000);
}

TEST(RefinedPainter, LayersAreThoseOfTheSurfaceForAnyThreads) {
  const PhotoPerson person = ColouredPerson();
  const Track moved = MovedByPerson(person, ShortTrack(2));
  const MatrixX3d vertices = TrackVertices(*person.body, moved, 0);
  const PersonLayers layers = PersonLayerPainter(person, 1).Draw(vertices, moved.CameraAt(0));
  EXPECT_EQ(layers.planes, PersonLayerPainter(person, 3).Draw(vertices, moved.CameraAt(0)).planes);
  EXPECT_EQ(layers.width % kLayersMultiple, 0);
  EXPECT_EQ(layers.height % kLayersMultiple, 0);
  double highest = -10, lowest = 10, seen = 0, mirrored = 0;
  for (size_t i = 0; i < layers.pixels(); ++i) {
    const auto at = [&](int plane) { return layers.Plane(plane)[i]; };
    const float square = at(PersonPlane::kNormal) * at(PersonPlane::kNormal) +
                         at(PersonPlane::kNormal + 1) * at(PersonPlane::kNormal + 1) +
                         at(PersonPlane::kNormal + 2) * at(PersonPlane::kNormal + 2);
    if (square == 0) continue;
    ASSERT_NEAR(square, 1, 1e-3);
    EXPECT_LT(at(PersonPlane::kNormal + 2), 0.6F) << "towards the viewer, at the rim interpolated";
    highest = std::max<double>(highest, at(PersonPlane::kPlace + 1));
    lowest = std::min<double>(lowest, at(PersonPlane::kPlace + 1));
    seen += at(PersonPlane::kSeen);
    mirrored += at(PersonPlane::kMirrored);
  }
  const auto& rest = person.body->data().v_template;
  EXPECT_NEAR(highest, rest.col(1).maxCoeff(), 0.05);
  EXPECT_NEAR(lowest, rest.col(1).minCoeff(), 0.1);
  EXPECT_GT(seen, 500);
  EXPECT_GT(mirrored, 500);
}

/// How far the covered pixels reach.
struct Reach {
  int left, right;
};

Reach ReachOf(const std::vector<uint8_t>& coverage, int width) {
  Reach reach = {width, -1};
  for (size_t i = 0; i < coverage.size(); ++i) {
    if (coverage[i] < 128) continue;
    reach.left = std::min(reach.left, static_cast<int>(i) % width);
    reach.right = std::max(reach.right, static_cast<int>(i) % width);
  }
  return reach;
}

TEST(RefinedPainter, ALargePersonIsRefinedAtTheSizeThatTheRefinerKnows) {
  const PhotoPerson person = ColouredPerson();
  const Track moved = MovedByPerson(person, ShortTrack(2));
  const MatrixX3d vertices = TrackVertices(*person.body, moved, 0);
  const Camera camera = moved.CameraAt(0);
  const double size = PixelsPerMetre(camera, vertices.col(2).mean());
  RefinerWeights weights = RandomRefiner(0);
  for (Eigen::Index i = PersonPlane::kAlpha; i < 16; i += 4)
    weights.network.convolutions.back().bias[i] = 5;  // all it may grow
  const auto reach_at = [&](double known) {
    weights.pixels_per_metre = known;
    PictureRefiner refiner(weights);
    Image picture(camera.width, camera.height);
    std::vector<uint8_t> covered(static_cast<size_t>(camera.width) * camera.height, 0);
    RefinedPainter(person, 1, &refiner).Draw(vertices, camera, &picture, &covered);
    return ReachOf(covered, camera.width);
  };
  Image picture(camera.width, camera.height);
  std::vector<uint8_t> covered(static_cast<size_t>(camera.width) * camera.height, 0);
  RefinedPainter(person, 1, nullptr).Draw(vertices, camera, &picture, &covered);
  const Reach drawn = ReachOf(covered, camera.width), as_known = reach_at(size), half = reach_at(size / 2);
  ASSERT_GT(drawn.left, 3 * OutlineReach::kOutwards);
  EXPECT_NEAR(drawn.left - as_known.left, OutlineReach::kOutwards, 1);
  EXPECT_NEAR(as_known.right - drawn.right, OutlineReach::kOutwards, 1);
  // Pixels of the small picture are twice as large, and one of them may be covered in part.
  for (const int growth : {drawn.left - half.left, half.right - drawn.right}) {
    EXPECT_GE(growth, 2 * OutlineReach::kOutwards);
    EXPECT_LE(growth, 2 * OutlineReach::kOutwards + 3);
  }
  EXPECT_EQ(reach_at(2 * size).left, as_known.left) << "a small person is refined as it is";
}

TEST(RefinedPainter, ALargePersonWhoIsNotChangedIsThePerson) {
  const PhotoPerson person = ColouredPerson();
  const Track moved = MovedByPerson(person, ShortTrack(2));
  const MatrixX3d vertices = TrackVertices(*person.body, moved, 0);
  const Camera camera = moved.CameraAt(0);
  RefinerWeights weights = RandomRefiner(0);
  weights.pixels_per_metre = 0.4 * PixelsPerMetre(camera, vertices.col(2).mean());
  PictureRefiner refiner(weights);
  Image drawn(camera.width, camera.height, Colour{10, 250, 90}), refined = drawn;
  RefinedPainter(person, 1, nullptr).Draw(vertices, camera, &drawn);
  RefinedPainter(person, 1, &refiner).Draw(vertices, camera, &refined);
  for (size_t i = 0; i < drawn.bgr.size(); ++i) ASSERT_NEAR(drawn.bgr[i], refined.bgr[i], 2) << i;
}

TEST(RefinedPainter, DrawsNothingWhereNobodyIs) {
  const PhotoPerson person = ColouredPerson();
  const Track moved = MovedByPerson(person, ShortTrack(2));
  MatrixX3d vertices = TrackVertices(*person.body, moved, 0);
  vertices.col(0).array() += 100;
  PictureRefiner refiner(RandomRefiner(1));
  const Camera camera = moved.CameraAt(0);
  Image picture(camera.width, camera.height, Colour{1, 2, 3});
  RefinedPainter(person, 1, &refiner).Draw(vertices, camera, &picture);
  for (size_t i = 3; i < picture.bgr.size(); ++i) ASSERT_EQ(picture.bgr[i], picture.bgr[i % 3]);
  Image other(3, 3);
  EXPECT_THROW(RefinedPainter(person, 1, &refiner).Draw(vertices, camera, &other), std::invalid_argument);
}

TEST(OpenRefiner, NoneIsNone) {
  EXPECT_EQ(OpenRefiner(kNoRefiner), nullptr);
  EXPECT_THROW(OpenRefiner("/nowhere/refiner.npz"), std::runtime_error);
}

}  // namespace
}  // namespace bodyloom
