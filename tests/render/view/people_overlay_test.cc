// SPDX-License-Identifier: Apache-2.0
#include "render/view/people_overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/image/palette.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::people_overlay_test {
namespace {

const Camera kCamera = MakePinhole(480, 360, 390);
constexpr int kCaptionEnd = 90;  ///< rows above hold the caption

/// A body that stands still from frame `first` of the clip on.
Track Standing(double x, double z, int first, int num_frames) {
  Track track;
  track.camera = kCamera;
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses = RowMatrixXd::Zero(num_frames, 72);
  track.motion.trans.resize(num_frames, 3);
  for (int t = 0; t < num_frames; ++t) {
    track.motion.poses.row(t) = RandomAxisAngle(ToyBody(), 0, 0).transpose();
    track.motion.trans.row(t) << x, 0.2, z;
    track.motion.timestamps.push_back((first + t) / 30.0);
  }
  track.frame_status.assign(size_t(num_frames), FrameStatus::kTracked);
  return track;
}

bool SameBelowCaption(const Image& a, const Image& b) {
  for (int y = kCaptionEnd; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (!(a.at(x, y) == b.at(x, y))) return false;
    }
  }
  return a.width == b.width && a.height == b.height;
}

TEST(PeopleOverlay, OnePersonIsDrawnAsAlways) {
  const Track track = Standing(0, 3, 0, 3);
  const Image video(480, 360, {0, 200, 0});
  const PeopleOverlay people({{.body = &ToyBody(), .track = &track}});
  const OverlayRenderer alone(ToyBody(), track);
  EXPECT_TRUE(SameBelowCaption(people.Render(1, &video), alone.Render(1, {.background = &video})));
  EXPECT_TRUE(SameBelowCaption(people.Render(1, nullptr), alone.Render(1, {}))) << "on a floor, with a shadow";
}

TEST(PeopleOverlay, TheNearerBodyCoversWhicheverComesFirst) {
  const Track near = Standing(0, 3, 0, 1), far = Standing(0.1, 4, 0, 1);
  const Image video(480, 360, {0, 200, 0});
  const PersonInOverlay front{.body = &ToyBody(), .track = &near, .number = 0};
  const PersonInOverlay back{.body = &ToyBody(), .track = &far, .number = 1};
  const Image image = PeopleOverlay({front, back}).Render(0, &video);
  EXPECT_TRUE(SameBelowCaption(image, PeopleOverlay({back, front}).Render(0, &video)));
  const Image front_alone = PeopleOverlay({front}).Render(0, &video);
  const Image back_alone = PeopleOverlay({back}).Render(0, &video);
  int covered = 0, both_seen = 0;
  for (int y = kCaptionEnd; y < 360; ++y) {
    for (int x = 0; x < 480; ++x) {
      const bool of_front = !(front_alone.at(x, y) == video.at(0, 0));
      const bool of_back = !(back_alone.at(x, y) == video.at(0, 0));
      covered += of_front && of_back && image.at(x, y) == front_alone.at(x, y);
      both_seen += of_front && of_back;
      // The dark line along the front body's contour falls onto the other body's pixels too: only where it is alone.
      if (!of_front && !of_back) {
        ASSERT_EQ(image.at(x, y), video.at(0, 0)) << x << " " << y;
      }
    }
  }
  EXPECT_GT(both_seen, 1000);
  EXPECT_GT(covered, 0.85 * both_seen);
  EXPECT_FALSE(SameBelowCaption(image, front_alone)) << "the other one is seen beside it";
}

TEST(PeopleOverlay, WhoeverIsNotThereIsNotDrawn) {
  const Track early = Standing(-0.4, 3, 0, 4), late = Standing(0.4, 3, 2, 4);
  const PersonInOverlay a{.body = &ToyBody(), .track = &early, .number = 0};
  const PersonInOverlay b{.body = &ToyBody(), .track = &late, .number = 1};
  const PeopleOverlay both({a, b});
  ASSERT_EQ(both.timestamps().size(), 6U);
  EXPECT_EQ(both.timestamps()[5], 5 / 30.0);
  const Image video(480, 360, {0, 200, 0});
  EXPECT_EQ(both.Render(1, &video), PeopleOverlay({a}).Render(1, &video));
  EXPECT_TRUE(SameBelowCaption(both.Render(5, &video), PeopleOverlay({b}).Render(3, &video)));
  EXPECT_FALSE(SameBelowCaption(both.Render(2, &video), PeopleOverlay({a}).Render(2, &video)));
}

/// Pixels of a person's colour (PersonColour: 0 is blue, 1 is yellow) in the panel below its captions, and their mean
/// column.
struct Coloured {
  int count = 0;
  double column = 0;
};
Coloured InPanel(const Image& image, bool blue) {
  Coloured found;
  for (int y = kCaptionEnd; y < 330; ++y) {
    for (int x = 480; x < image.width; ++x) {
      const Colour c = image.at(x, y);
      if (blue ? c.blue <= c.red + 40 : c.red <= c.blue + 40) continue;
      found.column += x;
      ++found.count;
    }
  }
  found.column /= std::max(1, found.count);
  return found;
}

TEST(PeopleOverlay, TheSideViewHasACellForEachTheLargestFirst) {
  const Track near = Standing(0, 3, 0, 2), behind = Standing(0, 4.5, 0, 2), far = Standing(6, 30, 0, 2);
  OverlayOptions options;
  options.side_view = true;
  const auto drawn = [&](const Track& other) {
    const PeopleOverlay both(
        {{.body = &ToyBody(), .track = &other, .number = 1}, {.body = &ToyBody(), .track = &near, .number = 0}},
        options);
    EXPECT_EQ(both.width(), 480 + 270);
    return both.Render(1, nullptr);
  };
  const Image image = drawn(behind);
  const Coloured first = InPanel(image, true), second = InPanel(image, false);
  ASSERT_GT(first.count, 450);
  ASSERT_GT(second.count, 450);
  EXPECT_LT(first.column, 480 + 135);
  EXPECT_GT(second.column, 480 + 135);
  // Ten times as far away the other one changes nothing of the first, and is as large itself.
  const Coloured still_first = InPanel(drawn(far), true), still_second = InPanel(drawn(far), false);
  EXPECT_EQ(still_first.count, first.count);
  EXPECT_NEAR(still_second.count, second.count, 0.03 * second.count);
}

TEST(PeopleOverlay, TheSideViewShowsHowFarABodyIsFromTheFloor) {
  const Track track = Standing(0, 3, 0, 2);
  const std::vector<PersonInOverlay> person = {{.body = &ToyBody(), .track = &track}};
  OverlayOptions options;
  options.side_view = true;
  const double lowest = TrackVertices(ToyBody(), track, 0).col(1).maxCoeff();
  const auto panel = [&](double height) {
    const Floor floor{Eigen::Vector3d(0, lowest + height, 0), -Eigen::Vector3d::UnitY()};
    return PeopleOverlay(person, options, floor).Render(0, nullptr);
  };
  const auto count = [](const Image& image, auto is) {
    int sum = 0;
    for (int y = kCaptionEnd; y < 320; ++y) {
      for (int x = 480; x < image.width; ++x) sum += is(image.at(x, y));
    }
    return sum;
  };
  const auto red = [](const Colour& c) { return c.red > c.green + 80 && c.red > c.blue + 80; };
  const auto green = [](const Colour& c) { return c.green > c.red + 60 && c.green > c.blue + 40; };
  EXPECT_GT(count(panel(0), green), 4);
  EXPECT_EQ(count(panel(0), red), 0);
  EXPECT_EQ(count(panel(0.1), green), 0);
  EXPECT_EQ(count(panel(0.1), red), 0);
  EXPECT_GT(count(panel(-0.1), red), 10);
  EXPECT_EQ(panel(0.1), panel(0.1)) << "same input, same bytes";
}

TEST(PeopleOverlay, AGroundThatIsKnownIsWhereTheFloorIs) {
  const Track track = Standing(0, 3, 0, 2);
  const std::vector<PersonInOverlay> person = {{.body = &ToyBody(), .track = &track}};
  const std::optional<Floor> under = FloorUnder(TrackJoints(ToyBody(), track), -Eigen::Vector3d::UnitY());
  ASSERT_TRUE(under);
  const Image usual = PeopleOverlay(person).Render(0, nullptr);
  EXPECT_EQ(PeopleOverlay(person, {}, under).Render(0, nullptr), usual);
  EXPECT_NE(PeopleOverlay(person, {}, Floor{under->point + Eigen::Vector3d(0, 0.3, 0), under->up}).Render(0, nullptr),
            usual);
}

TEST(PeopleOverlay, RefusesWhatDoesNotFit) {
  EXPECT_THROW(PeopleOverlay({}), std::invalid_argument);
  const Track track = Standing(0, 3, 0, 2);
  Track other = track;
  other.camera = MakePinhole(481, 360, 130);
  const PersonInOverlay fits{.body = &ToyBody(), .track = &track}, odd{.body = &ToyBody(), .track = &other};
  EXPECT_THROW(PeopleOverlay({fits, odd}), std::invalid_argument);
  other.camera = WeakCamera(480, 360, 150);
  EXPECT_THROW(PeopleOverlay({fits, odd}), std::invalid_argument);
  const PeopleOverlay people({fits});
  const Image wrong(481, 360);
  EXPECT_THROW(people.Render(0, &wrong), std::invalid_argument);
  EXPECT_THROW(people.Render(2, nullptr), std::invalid_argument);
  EXPECT_THROW(people.Render(-1, nullptr), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::people_overlay_test
