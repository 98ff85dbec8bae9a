// SPDX-License-Identifier: Apache-2.0
/// A bare body of two colours, photographed by the renderer itself: the person made from the photos must equal that
/// body.
#include "render/photo_avatar/photo_person_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track_edits.h"
#include "render/photo_avatar/draw_person.h"
#include "render/view/overlay.h"
#include "tests/support/short_track.h"

namespace bodyloom::photo_person_builder_test {
namespace {

using ::testing::HasSubstr;

constexpr int kSide = 320;
constexpr int kBlue = 60, kGreen = 120, kRed = 200;

/// At rest before the camera, turned about the vertical.
Track BodyInImage(double yaw) {
  Track track = FramesInOrder(ShortTrack(), std::array{0});
  track.joints.clear(), track.coco17.clear();
  track.camera = Camera();
  track.camera.width = track.camera.height = kSide;
  track.camera.fx = track.camera.fy = 1.2 * kSide;
  track.camera.cx = track.camera.cy = 0.5 * kSide;
  track.motion.betas.setZero();
  track.motion.poses.setZero();
  const Eigen::AngleAxisd root(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()));
  track.motion.poses.row(0).head<3>() = root.angle() * root.axis().transpose();
  track.motion.trans.row(0) = Eigen::RowVector3d(0, 0, 3.2);
  return track;
}

/// The bare body in one colour.
FittedPhoto Photo(double yaw) {
  PhotoPerson plain;
  plain.body = plain.bare = BodyOrBuiltin("");
  plain.texture = Image(8, 8);
  for (size_t i = 0; i < 64; ++i) {
    plain.texture.bgr[3 * i] = kBlue, plain.texture.bgr[3 * i + 1] = kGreen, plain.texture.bgr[3 * i + 2] = kRed;
  }
  FittedPhoto photo;
  photo.name = "photo.png";
  photo.image = Image(kSide, kSide);
  photo.track = BodyInImage(yaw);
  std::vector<uint8_t> coverage(size_t{kSide} * kSide, 0);
  PersonPainter(plain, 1).Draw(TrackVertices(*plain.body, photo.track, 0), photo.track.camera, &photo.image, &coverage);
  photo.mask.width = photo.mask.height = kSide;
  for (const uint8_t covered : coverage) photo.mask.labels.push_back(covered >= 128 ? 1 : 0);
  return photo;
}

PhotoPerson PersonOf(std::initializer_list<FittedPhoto> photos) {
  PhotoPersonBuilder builder(BodyOrBuiltin(""), 128);
  for (const FittedPhoto& photo : photos) builder.Add(photo);
  return builder.Finish();
}

TEST(PhotoPersonBuilder, ABareBodyWearsNothing) {
  const PhotoPerson person = PersonOf({Photo(0)});
  EXPECT_LT(std::abs(person.report.clothes_median_m), 0.006) << "a pixel is 8 mm";
  EXPECT_LT(person.report.clothes_max_m, 0.03);
  EXPECT_EQ(person.body->num_vertices(), person.bare->num_vertices());
  ASSERT_EQ(person.report.photos.size(), 1U);
  EXPECT_EQ(person.report.photos[0].image, "photo.png");
  EXPECT_GT(person.report.photos[0].rim_measured, 100);
}

TEST(PhotoPersonBuilder, OneColourStaysOneColour) {
  const PhotoPerson person = PersonOf({Photo(0)});
  const size_t texels = person.texture.bgr.size() / 3;
  int coloured = 0, far = 0;
  for (size_t p = 0; p < texels; ++p) {
    const uint8_t* source = &person.sources.bgr[3 * p];
    if (source[0] + source[1] + source[2] == 0) continue;  // nothing of the atlas
    ++coloured;
    const uint8_t* colour = &person.texture.bgr[3 * p];
    const int off = std::max({std::abs(colour[0] - kBlue), std::abs(colour[1] - kGreen), std::abs(colour[2] - kRed)});
    far += off > 8 ? 1 : 0;
  }
  EXPECT_GT(coloured, 4000);
  EXPECT_LT(far, coloured / 50) << "of " << coloured;
}

TEST(PhotoPersonBuilder, ASecondPhotoFromBehindShowsTheRest) {
  const PhotoPerson one = PersonOf({Photo(0)}), two = PersonOf({Photo(0), Photo(M_PI)});
  EXPECT_GT(one.report.seen, 0.15);
  EXPECT_GT(two.report.seen, one.report.seen + 0.1);
  EXPECT_EQ(two.tracks.size(), 2U);
  EXPECT_NEAR(two.report.seen + two.report.mirrored + two.report.behind + two.report.hair + two.report.limb_neighbour +
                  two.report.smooth_fill,
              1, 1e-9);
}

TEST(PhotoPersonBuilder, TimesItsStages) {
  StageClock clock;
  PhotoPersonBuilder builder(BodyOrBuiltin(""), 64, &clock);
  builder.Add(Photo(0));
  builder.Finish();
  clock.End();
  ASSERT_EQ(clock.seconds().size(), 3U);
  EXPECT_EQ(clock.seconds()[0].first, "clothes");
  EXPECT_EQ(clock.seconds()[1].first, "texture");
  EXPECT_EQ(clock.seconds()[2].first, "complete");
}

TEST(PhotoPersonBuilder, RefusesWhatShowsTooLittle) {
  PhotoPersonBuilder builder(BodyOrBuiltin(""), 64);
  FittedPhoto hidden = Photo(0);
  std::fill(hidden.mask.labels.begin(), hidden.mask.labels.end(), uint8_t{0});
  try {
    builder.Add(hidden);
    FAIL() << "a mask of nobody";
  } catch (const NoPersonFound& error) {
    EXPECT_THAT(error.what(), HasSubstr("photo.png: shows too little of the person"));
  }
  builder.Add(Photo(0));
  const PhotoPerson person = builder.Finish();
  EXPECT_EQ(person.tracks.size(), 1U) << "the photo after it is the first";
  EXPECT_GT(person.report.seen, 0.1);
  EXPECT_THROW(PhotoPersonBuilder(BodyOrBuiltin(""), 64).Finish(), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::photo_person_builder_test
