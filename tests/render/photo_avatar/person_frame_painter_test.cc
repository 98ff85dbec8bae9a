// SPDX-License-Identifier: Apache-2.0
#include "render/photo_avatar/draw_person.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "render/view/overlay.h"
#include "tests/support/coloured_person.h"
#include "tests/support/short_track.h"

namespace bodyloom::person_frame_painter_test {
namespace {

DrawnPerson TwoPixels() {
  DrawnPerson person = {Image(2, 1), {0, 51}};  // a fifth
  person.image.pixel(1, 0)[0] = 10, person.image.pixel(1, 0)[1] = 51, person.image.pixel(1, 0)[2] = 0;
  return person;
}

TEST(DrawnPerson, LiesOverAImage) {
  Image image(2, 1, Colour{100, 200, 250});
  const Image before = image;
  LayOver(TwoPixels(), &image);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(image.pixel(0, 0)[c], before.pixel(0, 0)[c]) << "nobody there";
    EXPECT_NEAR(image.pixel(1, 0)[c], TwoPixels().image.pixel(1, 0)[c] + 0.8 * before.pixel(1, 0)[c], 0.5);
  }
  Image other(1, 1);
  EXPECT_THROW(LayOver(TwoPixels(), &other), std::invalid_argument);
}

TEST(DrawnPerson, HasColoursOfItsOwnAndAlpha) {
  EXPECT_EQ(BgraOf(TwoPixels()), (std::vector<uint8_t>{0, 0, 0, 0, 50, 255, 0, 51}));
}

TEST(PersonFramePainter, AreTheSameForAnyNumberDrawnAtOnce) {
  const PhotoPerson person = ColouredPerson();
  const Track moved = MovedByPerson(person, ShortTrack(2));
  std::vector<PersonPose> poses;
  poses.reserve(3);
  for (int t = 0; t < 3; ++t) poses.push_back({TrackVertices(*person.body, moved, t), moved.CameraAt(t)});
  poses[1].vertices_in_camera.resize(0, 3);  // nobody
  PersonFramePainter one(person, 1), three(person, 3);
  ASSERT_EQ(three.at_once(), 3);
  const std::vector<DrawnPerson> together = three.Draw(poses);
  for (int t = 0; t < 3; ++t) {
    const DrawnPerson alone = one.Draw({&poses[t], 1})[0];
    EXPECT_EQ(alone.image.bgr, together[t].image.bgr) << t;
    EXPECT_EQ(alone.coverage, together[t].coverage) << t;
    int covered = 0;
    for (const uint8_t share : alone.coverage) covered += share > 0 ? 1 : 0;
    EXPECT_EQ(covered > 1000, t != 1);
  }
  EXPECT_THROW(one.Draw(poses), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::person_frame_painter_test
