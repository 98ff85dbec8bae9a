// SPDX-License-Identifier: Apache-2.0
#include "tracking/room/picture_vertical.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

namespace bodyloom::picture_vertical_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

/// Columns: right, down, forward of a room's axes as seen by a camera that looks down by `pitch`, turned by `yaw` and
/// rolled by `roll` degrees.
Eigen::Matrix3d RoomInCamera(double pitch, double yaw, double roll) {
  return (AngleAxisd(roll * kDegree, Vector3d::UnitZ()) * AngleAxisd(pitch * kDegree, Vector3d::UnitX()) *
          AngleAxisd(yaw * kDegree, Vector3d::UnitY()))
      .toRotationMatrix();
}

double AngleDeg(const Vector3d& a, const Vector3d& b) { return std::acos(std::min(1.0, a.dot(b))) / kDegree; }

/// A picture of lines in a room.
class Scene {
 public:
  Scene(unsigned seed, double focal_px) : random_(seed), camera_(MakePinhole(1280, 720, focal_px)) {}

  /// Segments along `direction` (camera axes), with Gaussian noise on their ends; within the columns given.
  void AddLines(int count, const Vector3d& direction, double noise_px, double x0 = 0, double x1 = 1279) {
    for (int added = 0; added < count;) {
      const double px = Uniform(x0, x1), py = Uniform(0, 719), depth = Uniform(3, 8), half = Uniform(0.25, 0.6);
      const Vector3d middle = depth * Vector3d((px - camera_.cx) / camera_.fx, (py - camera_.cy) / camera_.fy, 1);
      LineSegment segment;
      if (!camera_.Project(middle - half * direction, &segment.a)) continue;
      if (!camera_.Project(middle + half * direction, &segment.b)) continue;
      if (segment.length() < 25 || segment.length() > 900) continue;
      Disturb(noise_px, &segment);
      segments_.push_back(segment);
      ++added;
    }
  }
  /// Segments that point anywhere.
  void AddClutter(int count) {
    for (int i = 0; i < count; ++i) {
      const double x = Uniform(0, 1279), y = Uniform(0, 719), angle = Uniform(0, M_PI), half = Uniform(13, 60);
      const Vector2d reach = half * Vector2d(std::cos(angle), std::sin(angle));
      segments_.push_back({Vector2d(x, y) - reach, Vector2d(x, y) + reach});
    }
  }
  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] std::vector<LineSegment>& segments() { return segments_; }
  double Gauss() { return gauss_(random_); }

 private:
  double Uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  void Disturb(double noise_px, LineSegment* segment) {
    for (Vector2d* end : {&segment->a, &segment->b}) {
      for (int i = 0; i < 2; ++i) (*end)[i] += noise_px * Gauss();
    }
  }

  std::mt19937 random_;
  std::normal_distribution<> gauss_;
  Camera camera_;
  std::vector<LineSegment> segments_;
};

TEST(PictureVertical, IsExactWithoutNoise) {
  for (const double pitch : {-30.0, -8.0, 0.0, 15.0}) {
    for (const double roll : {-12.0, 0.0, 7.0}) {
      const Vector3d up = -RoomInCamera(pitch, 20, roll).col(1);
      Scene scene(1, 1000);
      scene.AddLines(20, up, 0);
      const PictureVertical lines = FindPictureVertical(scene.segments(), scene.camera());
      ASSERT_TRUE(lines.found) << lines.why;
      EXPECT_LT(AngleDeg(lines.up, up), 1e-4) << pitch << ", " << roll;
      EXPECT_EQ(lines.num_segments, 20);
      EXPECT_NEAR(lines.share, 1, 1e-12);
    }
  }
}

TEST(PictureVertical, IsFoundAmongClutter) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Vector3d up = -RoomInCamera(10, 20, -5).col(1);
    Scene scene(seed, 1000);
    scene.AddLines(25, up, 0.5);
    scene.AddClutter(100);
    const PictureVertical lines = FindPictureVertical(scene.segments(), scene.camera());
    ASSERT_TRUE(lines.found) << lines.why;
    EXPECT_LT(AngleDeg(lines.up, up), 1.5) << seed;
  }
}

TEST(PictureVertical, OrderOfSegmentsAndOfTheirEndsDoesNotMatter) {
  Scene scene(3, 1000);
  scene.AddLines(20, -RoomInCamera(10, 20, -5).col(1), 0.5);
  scene.AddClutter(30);
  const Vector3d up = FindPictureVertical(scene.segments(), scene.camera()).up;
  std::vector<LineSegment> other(scene.segments().rbegin(), scene.segments().rend());
  for (size_t i = 0; i < other.size(); i += 2) std::swap(other[i].a, other[i].b);
  EXPECT_LT((FindPictureVertical(other, scene.camera()).up - up).norm(), 1e-9);
}

TEST(PictureVertical, ClutterAloneIsNotAVertical) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Scene scene(seed, 1000);
    scene.AddClutter(200);
    const PictureVertical lines = FindPictureVertical(scene.segments(), scene.camera());
    EXPECT_FALSE(lines.found) << seed << ": " << lines.BriefReport();
    EXPECT_LT(lines.share, 0.25) << seed;
    EXPECT_FALSE(lines.why.empty());
  }
}

/// Errors of many rooms in units of their stated covariance.
struct Coverage {
  int found = 0, inside = 0;  ///< inside: the ellipse that holds 90 % of a Gaussian
  double mean_square = 0;     ///< 2 for a Gaussian in two dimensions
};

/// The stated covariance is the fit's and a floor of 1.5° for what lines of one room are off together. So the rooms'
/// lines are off by that, and by the noise of their ends.
Coverage CoverageOf(int num_lines, double noise_px, double half_width) {
  Coverage coverage;
  for (unsigned seed = 0; seed < 300; ++seed) {
    Scene scene(seed, 1000);
    const Vector3d up = -RoomInCamera(12, 20, 4).col(1), side = up.unitOrthogonal();
    Vector3d built = up + 1.5 * kDegree * scene.Gauss() * side;
    built = (built + 1.5 * kDegree * scene.Gauss() * up.cross(side)).normalized();
    scene.AddLines(num_lines, built, noise_px, 640 - half_width, 640 + half_width);
    const PictureVertical lines = FindPictureVertical(scene.segments(), scene.camera());
    if (!lines.found) continue;
    ++coverage.found;
    Eigen::Matrix<double, 3, 2> across;
    across << lines.up.unitOrthogonal(), lines.up.cross(lines.up.unitOrthogonal());
    const Vector2d error = across.transpose() * up;
    const Eigen::Matrix2d covariance = across.transpose() * lines.covariance * across;
    const double squared = error.dot(covariance.inverse() * error);
    coverage.inside += squared < 4.605 ? 1 : 0;
    coverage.mean_square += std::min(squared, 20.0);
  }
  coverage.mean_square /= std::max(1, coverage.found);
  return coverage;
}

TEST(PictureVertical, CoversItsErrors) {
  // In a narrow strip it is hard to see how steeply the camera looks: there the fit's own part is the larger one.
  for (const double half_width : {60.0, 160.0, 500.0}) {
    const Coverage coverage = CoverageOf(20, 0.6, half_width);
    EXPECT_EQ(coverage.found, 300) << half_width;
    EXPECT_NEAR(coverage.inside / 300.0, 0.9, 0.04) << half_width;
    EXPECT_NEAR(coverage.mean_square, 2, 0.3) << half_width;
  }
}

TEST(PictureVertical, TurnsWithTheFocalLengthAsTheVanishingPointSays) {
  const Vector3d up = -RoomInCamera(15, 0, 6).col(1);
  Scene scene(5, 1000);
  scene.AddLines(20, up, 0);
  // Seen with a wrong focal length first, evaluated at the right one.
  const PictureVertical lines = FindPictureVertical(scene.segments(), MakePinhole(1280, 720, 700));
  ASSERT_TRUE(lines.found) << lines.why;
  EXPECT_GT(AngleDeg(lines.up, up), 3);
  EXPECT_LT(AngleDeg(lines.Up(1000), up), 1e-3);
  const double h = 1e-5;
  const Vector3d numeric = (lines.Up(1000 * std::exp(h)) - lines.Up(1000 * std::exp(-h))) / (2 * h);
  EXPECT_LT((lines.UpByLogFocal(1000) - numeric).norm(), 1e-8);
  EXPECT_NEAR(numeric.norm(), std::sin(15 * kDegree) * std::cos(15 * kDegree), 1e-4);
  // An unknown focal length adds its share, along this derivative alone.
  const Eigen::Matrix3d added = lines.CovarianceAt(1000, 0.2) - lines.CovarianceAt(1000, 0);
  EXPECT_LT((added - 0.04 * numeric * numeric.transpose()).norm(), 1e-9);
}

TEST(PictureVertical, LensDistortionIsUndone) {
  const Vector3d up = -RoomInCamera(-20, 0, 3).col(1);
  Scene scene(6, 700);
  scene.AddLines(20, up, 0);
  Camera lens = scene.camera();
  lens.distortion = {-0.2, 0.05};
  for (LineSegment& segment : scene.segments()) {
    for (Vector2d* end : {&segment.a, &segment.b}) {
      const Vector3d ray = scene.camera().Unproject(*end).homogeneous();
      ASSERT_TRUE(lens.Project(ray, end));
    }
  }
  EXPECT_LT(AngleDeg(FindPictureVertical(scene.segments(), lens).up, up), 1e-3);
  EXPECT_GT(AngleDeg(FindPictureVertical(scene.segments(), scene.camera()).up, up), 0.5);
}

TEST(PictureVertical, ThreeDirectionsTellTheFocalLength) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Eigen::Matrix3d room = RoomInCamera(14, 35, 4);
    Scene scene(seed, 1100);
    scene.AddLines(30, -room.col(1), 0.4);
    scene.AddLines(30, room.col(0), 0.4);
    scene.AddLines(30, room.col(2), 0.4);
    scene.AddClutter(40);
    const PictureVertical lines = FindPictureVertical(scene.segments(), MakePinhole(1280, 720, 900));
    ASSERT_TRUE(lines.found) << lines.why;
    ASSERT_TRUE(lines.has_focal) << seed;
    EXPECT_LT(std::abs(lines.log_focal - std::log(1100)), 2 * lines.log_focal_sigma) << seed;
    EXPECT_LT(std::abs(lines.log_focal - std::log(1100)), 0.05) << seed;
    EXPECT_LT(AngleDeg(lines.Up(std::exp(lines.log_focal)), -room.col(1)), 1.5) << seed;
  }
}

TEST(PictureVertical, AWallSeenFromTheFrontTellsNoFocalLength) {
  const Eigen::Matrix3d room = RoomInCamera(0, 0, 0);
  Scene scene(7, 1100);
  scene.AddLines(30, -room.col(1), 0.4);
  scene.AddLines(60, room.col(0), 0.4);
  const PictureVertical lines = FindPictureVertical(scene.segments(), MakePinhole(1280, 720, 900));
  EXPECT_TRUE(lines.found) << lines.why;
  EXPECT_FALSE(lines.has_focal) << std::exp(lines.log_focal);
}

TEST(PictureVertical, LevelLinesWithoutOrderTellNoFocalLength) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Scene scene(seed, 1100);
    scene.AddLines(30, -RoomInCamera(14, 35, 4).col(1), 0.4);
    scene.AddClutter(150);
    const PictureVertical lines = FindPictureVertical(scene.segments(), MakePinhole(1280, 720, 900));
    EXPECT_TRUE(lines.found) << lines.why;
    EXPECT_FALSE(lines.has_focal) << seed << ": " << lines.BriefReport();
  }
}

TEST(PictureVertical, GarbageIsNotFound) {
  const Camera camera = MakePinhole(1280, 720, 1000);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(FindPictureVertical({}, camera).found);
  std::vector<LineSegment> one = {{{100, 100}, {110, 500}}};
  EXPECT_FALSE(FindPictureVertical(one, camera).found);
  EXPECT_FALSE(FindPictureVertical(std::vector<LineSegment>(50, one[0]), camera).found) << "one line, fifty times";
  EXPECT_FALSE(FindPictureVertical(std::vector<LineSegment>(50, {{5, 5}, {5, 5}}), camera).found);
  EXPECT_FALSE(FindPictureVertical(std::vector<LineSegment>(50, {{nan, 5}, {5, 50}}), camera).found);
  EXPECT_FALSE(FindPictureVertical(std::vector<LineSegment>(50, {{1, infinite}, {5, 50}}), camera).found);
  // Among good ones it changes nothing.
  Scene scene(8, 1000);
  scene.AddLines(20, -RoomInCamera(5, 0, 2).col(1), 0.3);
  const Vector3d up = FindPictureVertical(scene.segments(), camera).up;
  scene.segments().push_back({{nan, nan}, {nan, nan}});
  scene.segments().push_back({{7, 7}, {7, 7}});
  EXPECT_EQ(FindPictureVertical(scene.segments(), camera).up, up);
  EXPECT_THROW(FindPictureVertical(one, MakePinhole(1280, 720, nan)), std::invalid_argument);
  EXPECT_THROW(FindPictureVertical(one, camera, Vector3d(0, -2, 0)), std::invalid_argument);
  Camera weak = camera;
  weak.model = CameraModel::kWeakPerspective;
  EXPECT_THROW(FindPictureVertical(one, weak), std::invalid_argument);
}

/// Edges of a room that a camera turns in, in the axes of a scene in which up is `up`.
class TurnedRoom {
 public:
  explicit TurnedRoom(unsigned seed) : random_(seed) {}
  const Vector3d up = -RoomInCamera(12, 0, 3).col(1);

  /// Upright edges within `yaw` degrees of the scene's view, each leaning by `lean` degrees in some direction.
  void AddEdges(int count, double yaw, double lean) {
    for (int i = 0; i < count; ++i) {
      const Vector3d side = up.unitOrthogonal(), other = up.cross(side);
      const Vector2d leans = lean * kDegree * Gauss2();
      const Vector3d along = (up + leans.x() * side + leans.y() * other).normalized();
      const double pitch = Uniform(-12, 12), turn = Uniform(-yaw, yaw);
      const Vector3d view = RoomInCamera(pitch, turn, 0) * Vector3d::UnitZ();
      const Vector3d middle = Uniform(3, 8) * view;
      const double half = Uniform(0.3, 0.7);
      edges_.push_back({middle - half * along, middle + half * along});
    }
  }
  /// The edges that are whole in the picture of a camera at `place`, and clutter of its own.
  TurnedPicture See(const Eigen::Matrix3d& R, double noise_px, int clutter = 0, const Vector3d& place = {0, 0, 0}) {
    const Camera camera = MakePinhole(1280, 720, 1000);
    TurnedPicture picture;
    picture.camera_from_scene = R;
    for (const auto& [from, to] : edges_) {
      LineSegment segment;
      if (!camera.Project(R * (from - place), &segment.a) || !camera.Project(R * (to - place), &segment.b)) continue;
      const auto inside = [](const Vector2d& p) { return p.x() > 0 && p.x() < 1279 && p.y() > 0 && p.y() < 719; };
      if (!inside(segment.a) || !inside(segment.b)) continue;
      for (Vector2d* end : {&segment.a, &segment.b}) *end += noise_px * Gauss2();
      picture.segments.push_back(segment);
    }
    Scene other(random_(), 1000);
    other.AddClutter(clutter);
    picture.segments.insert(picture.segments.end(), other.segments().begin(), other.segments().end());
    return picture;
  }
  /// Pictures of a camera that trembles by `tremor` degrees about each axis and pans by ±`pan`.
  std::vector<TurnedPicture> Pictures(int count, double tremor, double pan, double noise_px, int clutter = 0) {
    std::vector<TurnedPicture> pictures;
    for (int i = 0; i < count; ++i) {
      const double yaw = pan * (count > 1 ? 2.0 * i / (count - 1) - 1 : 0) + tremor * gauss_(random_);
      const Vector2d trembles = tremor * Gauss2();
      pictures.push_back(See(RoomInCamera(trembles.x(), yaw, trembles.y()), noise_px, clutter));
    }
    return pictures;
  }

 private:
  double Uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  Vector2d Gauss2() {
    const double first = gauss_(random_);
    return {first, gauss_(random_)};
  }
  std::mt19937 random_;
  std::normal_distribution<> gauss_;
  std::vector<std::pair<Vector3d, Vector3d>> edges_;
};

TEST(SharedVertical, AreExactWithoutNoise) {
  const Camera camera = MakePinhole(1280, 720, 1000);
  for (unsigned seed = 0; seed < 5; ++seed) {
    TurnedRoom room(seed);
    room.AddEdges(60, 180, 0);
    for (const auto& [tremor, pan] : {std::pair(3.0, 0.0), {0.3, 40.0}, {1.0, 170.0}}) {
      const PictureVertical lines = FindSharedVertical(room.Pictures(12, tremor, pan, 0), camera);
      ASSERT_TRUE(lines.found) << lines.why;
      EXPECT_LT(AngleDeg(lines.up, room.up), 1e-4) << tremor << ", " << pan;
      EXPECT_NEAR(lines.share, 1, 1e-12);
    }
  }
}

TEST(SharedVertical, OfACameraThatGoesSomewhereShareTheVertical) {
  TurnedRoom room(3);
  room.AddEdges(40, 30, 0);
  std::vector<TurnedPicture> pictures;
  for (int i = 0; i < 8; ++i) pictures.push_back(room.See(RoomInCamera(i, 2 * i, -i), 0.3, 20, {0.2 * i, 0, 0.1 * i}));
  const PictureVertical lines = FindSharedVertical(pictures, MakePinhole(1280, 720, 1000));
  ASSERT_TRUE(lines.found) << lines.why;
  EXPECT_LT(AngleDeg(lines.up, room.up), 0.3);
}

TEST(SharedVertical, TellMoreThanEachOfThem) {
  // The edges of some pictures are too few, those of a pan over all sixteen are not.
  TurnedRoom room(9);
  room.AddEdges(16, 60, 0);
  const std::vector<TurnedPicture> pictures = room.Pictures(12, 0, 55, 0.3);
  int alone = 0;
  for (const TurnedPicture& picture : pictures) {
    alone += FindPictureVertical(picture.segments, MakePinhole(1280, 720, 1000)).num_segments >= 8 ? 1 : 0;
  }
  const PictureVertical lines = FindSharedVertical(pictures, MakePinhole(1280, 720, 1000));
  ASSERT_TRUE(lines.found) << lines.why;
  EXPECT_LT(alone, 12);
  EXPECT_GE(lines.num_segments, 14);
  EXPECT_LT(AngleDeg(lines.up, room.up), 0.3);
}

/// Mean over rooms of the error squared, and of the stated variance without its floor, in deg², of two directions.
std::pair<double, double> ErrorAndVariance(int pictures, double tremor) {
  double squares = 0, stated = 0;
  int found = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    TurnedRoom room(seed);
    room.AddEdges(25, 25, 0.35);
    const PictureVertical lines =
        FindSharedVertical(room.Pictures(pictures, tremor, 0, 0.2), MakePinhole(1280, 720, 1000));
    if (!lines.found) continue;
    ++found;
    squares += std::pow(AngleDeg(lines.up, room.up), 2);
    stated += lines.covariance.trace() / (kDegree * kDegree) - 2 * 1.5 * 1.5;
  }
  EXPECT_GT(found, 95);
  return {squares / found, stated / found};
}

TEST(SharedVertical, SigmaShrinksWithEdgesAndNotWithPictures) {
  const auto [error_of_one, stated_of_one] = ErrorAndVariance(1, 1);
  const auto [error, stated] = ErrorAndVariance(16, 1);
  // The edges lean, each by itself, and do so in every picture. (The kernel leaves out those that lean most, so that
  // the variance stated is somewhat small, for one picture as for many.)
  EXPECT_GT(error, 0.7 * error_of_one);
  EXPECT_GT(stated, 0.7 * stated_of_one);
  EXPECT_NEAR(stated / error, stated_of_one / error_of_one, 0.2);
}

TEST(SharedVertical, ClutterIsNotAVertical) {
  const Camera camera = MakePinhole(1280, 720, 1000);
  for (unsigned seed = 0; seed < 20; ++seed) {
    TurnedRoom room(seed);
    const PictureVertical of_each = FindSharedVertical(room.Pictures(12, 2, 0, 0, 150), camera);
    EXPECT_FALSE(of_each.found) << seed << ": " << of_each.BriefReport();
    // The same clutter again and again, as leaves that hang still.
    const TurnedPicture once = room.See(Eigen::Matrix3d::Identity(), 0, 200);
    const PictureVertical again = FindSharedVertical(std::vector<TurnedPicture>(12, once), camera);
    EXPECT_FALSE(again.found) << seed << ": " << again.BriefReport();
    EXPECT_FALSE(again.why.empty());
  }
}

TEST(SharedVertical, AFewEdgesSeenOftenAreAFewEdges) {
  TurnedRoom room(4);
  room.AddEdges(5, 10, 0);
  const PictureVertical lines = FindSharedVertical(room.Pictures(20, 1, 0, 0.3), MakePinhole(1280, 720, 1000));
  EXPECT_FALSE(lines.found) << lines.BriefReport();
}

TEST(SharedVertical, TurnWithTheFocalLengthAlongTheirAxes) {
  TurnedRoom room(6);
  room.AddEdges(60, 60, 0);
  const std::vector<TurnedPicture> pictures = room.Pictures(12, 2, 40, 0);
  const PictureVertical lines = FindSharedVertical(pictures, MakePinhole(1280, 720, 950));
  ASSERT_TRUE(lines.found) << lines.why;
  EXPECT_GT(AngleDeg(lines.up, room.up), 0.15);
  EXPECT_LT(AngleDeg(lines.Up(1000), room.up), 0.2 * AngleDeg(lines.up, room.up)) << AngleDeg(lines.up, room.up);
  const double h = 1e-5;
  const Vector3d numeric = (lines.Up(950 * std::exp(h)) - lines.Up(950 * std::exp(-h))) / (2 * h);
  EXPECT_LT((lines.UpByLogFocal(950) - numeric).norm(), 1e-8);
  // The covariance is that of (I − A + A f/f₀) up, normalised.
  Eigen::Matrix3d jacobian;
  for (int k = 0; k < 3; ++k) {
    PictureVertical moved[2] = {lines, lines};
    for (int side : {0, 1}) moved[side].up += (side == 0 ? h : -h) * Vector3d::Unit(k);
    jacobian.col(k) = (moved[0].Up(1200) - moved[1].Up(1200)) / (2 * h);
  }
  EXPECT_LT((lines.CovarianceAt(1200, 0) - jacobian * lines.covariance * jacobian.transpose()).norm(), 1e-9);
}

TEST(SharedVertical, OneThatIsNotTurnedIsThePictureItself) {
  Scene scene(3, 1000);
  scene.AddLines(20, -RoomInCamera(10, 20, -5).col(1), 0.5);
  scene.AddClutter(30);
  const PictureVertical alone = FindPictureVertical(scene.segments(), scene.camera());
  const PictureVertical lines = FindSharedVertical(std::vector<TurnedPicture>{{scene.segments()}}, scene.camera());
  EXPECT_EQ(lines.up, alone.up);
  EXPECT_EQ(lines.covariance, alone.covariance);
  EXPECT_EQ(lines.num_segments, alone.num_segments);
  EXPECT_LT((lines.UpByLogFocal(1000) - alone.UpByLogFocal(1000)).norm(), 1e-9);
}

TEST(SharedVertical, GarbageIsNotFound) {
  const Camera camera = MakePinhole(1280, 720, 1000);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FindSharedVertical(std::span<const TurnedPicture>(), camera).why, "no pictures");
  TurnedRoom room(4);
  room.AddEdges(20, 20, 0);
  const TurnedPicture upright = room.See(Eigen::Matrix3d::Identity(), 0.3);
  TurnedPicture upside_down = upright;
  upside_down.camera_from_scene = RoomInCamera(0, 0, 180);
  EXPECT_FALSE(FindSharedVertical(std::vector<TurnedPicture>{upright, upside_down}, camera).found);
  TurnedPicture broken = upright;
  for (LineSegment& segment : broken.segments) segment.a.x() = nan;
  EXPECT_FALSE(FindSharedVertical(std::vector<TurnedPicture>(10, broken), camera).found);
  EXPECT_THROW(FindSharedVertical(std::vector<TurnedPicture>{upright}, MakePinhole(1280, 720, nan)),
               std::invalid_argument);
}

PictureVertical Given(const Vector3d& up, double sigma_rad) {
  PictureVertical lines;
  lines.found = true;
  lines.up = up;
  lines.focal_px = 1000;
  lines.covariance = sigma_rad * sigma_rad * (Eigen::Matrix3d::Identity() - up * up.transpose());
  return lines;
}

TEST(JoinVerticals, WeighsBothByTheirInformation) {
  const Vector3d lifter(0, -1, 0), lines = RoomInCamera(-6, 0, 0) * lifter;
  // σ of 2 : 1, so the lines have four fifths of the say.
  const JoinedVertical joined = JoinVerticals(lifter, 0.06, Given(lines, 0.03), 1000, 0);
  EXPECT_TRUE(joined.used);
  EXPECT_NEAR(joined.angle_deg, 6, 1e-9);
  EXPECT_NEAR(AngleDeg(joined.up, lifter), 4.8, 0.03);
  EXPECT_NEAR(joined.sigma_rad, 0.06 / std::sqrt(5), 2e-4);
  EXPECT_NEAR(joined.up.norm(), 1, 1e-12);
}

TEST(JoinVerticals, AnUnknownFocalLengthLeavesTheRoll) {
  const Vector3d lifter = RoomInCamera(20, 0, 0) * Vector3d(0, -1, 0);
  const Vector3d lines = RoomInCamera(26, 0, 6) * Vector3d(0, -1, 0);
  const JoinedVertical joined = JoinVerticals(lifter, 0.06, Given(lines, 0.01), 1000, 10);
  // With the focal length open, nothing is known of how steeply the camera looks, but the roll is the lines'.
  EXPECT_NEAR(std::asin(joined.up.z()) / kDegree, -20, 1);
  EXPECT_NEAR(std::atan2(joined.up.x(), -joined.up.y()) / kDegree, 6, 0.8);
}

TEST(JoinVerticals, LinesOfSomethingElseAreLeftOut) {
  const Vector3d lifter(0, -1, 0);
  const JoinedVertical far = JoinVerticals(lifter, 0.06, Given(RoomInCamera(26, 0, 0) * lifter, 0.01), 1000, 0);
  EXPECT_FALSE(far.used);
  EXPECT_EQ(far.up, lifter);
  EXPECT_EQ(far.sigma_rad, 0.06);
  EXPECT_NEAR(far.angle_deg, 26, 1e-9);
  PictureVertical none = Given(lifter, 0.01);
  none.found = false;
  EXPECT_FALSE(JoinVerticals(lifter, 0.06, none, 1000, 0).used);
}

TEST(JoinFocalPrior, IsTheMeanByInformation) {
  PictureVertical lines;
  const FocalPrior prior{.log_mean = std::log(1000), .log_sigma = 0.2};
  EXPECT_EQ(JoinFocalPrior(prior, lines).log_mean, prior.log_mean);
  lines.has_focal = true;
  lines.log_focal = std::log(1500);
  lines.log_focal_sigma = 0.1;
  const FocalPrior joined = JoinFocalPrior(prior, lines);
  EXPECT_NEAR(joined.log_mean, 0.2 * std::log(1000) + 0.8 * std::log(1500), 1e-12);
  EXPECT_NEAR(joined.log_sigma, 0.1 * std::sqrt(0.8), 1e-12);
}

}  // namespace
}  // namespace bodyloom::picture_vertical_test
