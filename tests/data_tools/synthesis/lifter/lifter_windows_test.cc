// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/lifter/lifter_windows.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "geometry/base/parallel.h"
#include "tests/data_tools/synthesis/lifter/lifter_support.h"

namespace bodyloom::lifter_windows_test {
namespace {

using Eigen::Vector3f;

LifterWindow Window(const LifterWindowGenerator& generator, uint64_t seed) {
  LifterWindow window;
  generator.Generate(seed, &window);
  return window;
}

bool Same(const LifterWindow& a, const LifterWindow& b) {
  return a.features == b.features && a.points == b.points && a.up == b.up && a.contact == b.contact &&
         a.confidence == b.confidence;
}

TEST(LifterWindows, TheSameSeedGivesTheSameWindowOnAnyThread) {
  const LifterWindowGenerator generator = Generator({});
  constexpr int kWindows = 40;
  std::vector<LifterWindow> alone(kWindows), together(kWindows);
  for (int i = 0; i < kWindows; ++i) generator.Generate(i, &alone[i]);
  ParallelFor(kWindows, 4, [&](int i) { generator.Generate(kWindows - 1 - i, &together[kWindows - 1 - i]); });
  for (int i = 0; i < kWindows; ++i) {
    EXPECT_TRUE(Same(alone[i], together[i])) << i;
    if (i > 0) {
      EXPECT_FALSE(Same(alone[i], alone[i - 1]));
    }
  }
}

TEST(LifterWindows, TwoThousandSeedsAreFiniteAndOfTheRightShape) {
  LifterWindowOptions options;
  options.num_frames = 27;
  const LifterWindowGenerator generator = Generator(options);
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    const LifterWindow w = Window(generator, seed);
    ASSERT_EQ(w.features.size(), 27U * kLifterInputs);
    ASSERT_EQ(w.points.size(), 27U * kLifterPoints * 3);
    ASSERT_EQ(w.up.size(), 27U * 3);
    ASSERT_EQ(w.contact.size(), 27U * 2);
    ASSERT_EQ(w.confidence.size(), 27U * kLifterPoints);
    for (const float f : w.features) ASSERT_TRUE(std::isfinite(f) && std::abs(f) < 20) << seed << " " << f;
    for (const float f : w.points) ASSERT_TRUE(std::isfinite(f) && std::abs(f) < 2) << seed << " " << f;
    for (int t = 0; t < 27; ++t) ASSERT_NEAR(Vector3f(&w.up[3 * t]).norm(), 1, 1e-4);
    for (const float c : w.contact) ASSERT_TRUE(c == 0 || c == 1);
    for (const float c : w.confidence) ASSERT_TRUE(c >= 0 && c <= 1);
  }
}

/// Largest distance between the rays in the features and the target points, placed where they fit the rays best.
double BackProjectionError(const LifterWindow& w, int T) {
  double worst = 0;
  for (int t = 0; t < T; ++t) {
    // x_k (Z + z_k) = X + X_k with (X, Y, Z) the mid-hip: linear. Features are rays over S, S is the same everywhere.
    Eigen::MatrixXd A(2 * kLifterPoints, 4);
    Eigen::VectorXd b(2 * kLifterPoints);
    // Unknowns X, Y, Z' = Z·S, S: f_k (Z' + S z_k) = (X or Y) + p_k.
    for (int k = 0; k < kLifterPoints; ++k) {
      for (int c = 0; c < 2; ++c) {
        const double f = w.features[t * kLifterInputs + 3 * k + c];
        const float* p = &w.points[3 * (t * kLifterPoints + k)];
        A.row(2 * k + c) << (c == 0 ? -1 : 0), (c == 1 ? -1 : 0), f, f * p[2];
        b[2 * k + c] = p[c];
      }
    }
    const Eigen::VectorXd x = A.colPivHouseholderQr().solve(b);
    worst = std::max(worst, (A * x - b).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(LifterWindows, WithoutNoiseRaysAndTargetsAgree) {
  LifterWindowOptions options = PlainOptions();
  options.num_frames = 9;
  options.max_distance = 5;
  options.mirror = 0.5;
  options.perturbation = 1.2;
  options.shape_sd = 1.2;
  options.bone_noise = 1;
  options.landmark_sd_m = 0.008;
  options.floor_poses = 0.3;
  options.moving_camera = 0.5;
  const LifterWindowGenerator exact = Generator(options);
  options.focal_known = 0;
  options.focal_guess_sd = 0;
  const LifterWindowGenerator unknown = Generator(options);
  options.noise = 1;
  const LifterWindowGenerator noisy = Generator(options);
  for (uint64_t seed = 0; seed < 60; ++seed) {
    EXPECT_LT(BackProjectionError(Window(exact, seed), 9), 2e-4) << seed;
    EXPECT_LT(BackProjectionError(Window(unknown, seed), 9), 2e-4) << seed;
    EXPECT_GT(BackProjectionError(Window(noisy, seed), 9), 2e-3) << seed;
  }
}

TEST(LifterWindows, TargetsAreInUnitsOfTheReferenceLengthAroundTheMidHip) {
  LifterWindowOptions options = PlainOptions();
  options.num_frames = 5;
  options.shape_sd = 1.2;
  const LifterWindowGenerator generator = Generator(options);
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const LifterWindow w = Window(generator, seed);
    const LifterPerson person = generator.MakePerson(seed);
    PosedPerson posed;
    const std::vector<Eigen::Quaternionf> straight(kPoseJoints, Eigen::Quaternionf::Identity());
    generator.body().Pose(person, straight.data(), Vector3f::Zero(), &posed);
    const auto at = [&](int k) { return Vector3f(&w.points[3 * k]); };
    EXPECT_NEAR((at(kLifterLeftHip) + at(kLifterLeftHip + 1)).norm(), 0, 1e-5);
    // Bones keep their lengths in any pose: the shin in units of Lref.
    const float shin = (posed.point[kLifterLeftKnee] - posed.point[kLifterLeftAnkle]).norm() / person.reference_length;
    EXPECT_NEAR((at(kLifterLeftKnee) - at(kLifterLeftAnkle)).norm(), shin, 0.01);
    EXPECT_NEAR(LifterReferenceLength({posed.point[0].data(), 63}), person.reference_length, 1e-5);
    // A person who walks is upright.
    const Vector3f up(w.up.data());
    EXPECT_GT((0.5F * (at(kLifterLeftShoulder) + at(kLifterLeftShoulder + 1))).dot(up), 0.25F);
  }
}

TEST(LifterWindows, MirroringTheMotionIsWhatMirroringDoes) {
  LifterWindowOptions options = PlainOptions();
  options.num_frames = 21;
  options.mirror = 1;
  const LifterWindowGenerator mirrors = Generator(options);
  options.mirror = 0;
  const LifterWindowGenerator mirrored = Generator(options, MirroredMotion(ShortDemoMotion()));
  const LifterWindowGenerator as_it_is = Generator(options);
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const LifterWindow a = Window(mirrors, seed), b = Window(mirrored, seed), c = Window(as_it_is, seed);
    double worst = 0, other = 0;
    for (size_t i = 0; i < a.points.size(); ++i) {
      worst = std::max<double>(worst, std::abs(a.points[i] - b.points[i]));
      other = std::max<double>(other, std::abs(a.points[i] - c.points[i]));
    }
    EXPECT_LT(worst, 1e-4);
    EXPECT_GT(other, 0.02);
  }
}

TEST(LifterWindows, UnknownFocalLengthChangesTheFeaturesAlone) {
  LifterWindowOptions options = PlainOptions();
  options.num_frames = 11;
  const LifterWindowGenerator known = Generator(options);
  options.focal_known = 0;
  const LifterWindowGenerator unknown = Generator(options);
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const LifterWindow a = Window(known, seed), b = Window(unknown, seed);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.up, b.up);
    EXPECT_NE(a.features, b.features);
    EXPECT_EQ(b.features[3 * kLifterPoints], 0);
    EXPECT_EQ(b.features[3 * kLifterPoints + 1], 0);
  }
}

TEST(LifterWindows, CamerasCoverTheirRanges) {
  LifterWindowOptions options = PlainOptions();
  options.num_frames = 1;
  options.roll_sd_deg = 0;
  options.off_axis = 0;
  Motion still = ShortDemoMotion();
  still.poses.setZero();
  const LifterWindowGenerator generator = Generator(options, still);
  const LifterPerson person = generator.body().Person({});
  std::array<int, 8> yaws{};
  double lowest = 1e9, highest = -1e9, nearest = 1e9, farthest = 0;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    const LifterScene scene = generator.MakeScene(seed, person, generator.MakePoses(seed, person));
    const double elevation = std::asin(std::clamp(-scene.up[0].z(), -1.0F, 1.0F)) * 180 / M_PI;
    lowest = std::min(lowest, elevation);
    highest = std::max(highest, elevation);
    const Vector3f hip = 0.5F * (scene.points[kLifterLeftHip] + scene.points[kLifterLeftHip + 1]);
    nearest = std::min<double>(nearest, hip.norm());
    farthest = std::max<double>(farthest, hip.norm());
    const Vector3f left = scene.points[kLifterLeftHip] - hip;
    ++yaws[static_cast<int>((std::atan2(left.z(), left.x()) / (2 * M_PI) + 1) * 8) % 8];
  }
  EXPECT_NEAR(lowest, -20, 1);
  EXPECT_NEAR(highest, 40, 1);
  EXPECT_NEAR(nearest, 2.6, 0.1);
  EXPECT_NEAR(farthest, 9, 0.2);
  for (const int n : yaws) EXPECT_NEAR(n, 125, 45);
}

TEST(LifterWindows, SomeCamerasLookFromAnyHeight) {
  LifterWindowOptions options = PlainOptions();
  options.num_frames = 1;
  options.roll_sd_deg = options.off_axis = 0;
  options.any_elevation = 0.3;
  const LifterWindowGenerator generator = Generator(options, ShortDemoMotion());
  const LifterPerson person = generator.body().Person({});
  int below = 0, above = 0;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    const LifterScene scene = generator.MakeScene(seed, person, generator.MakePoses(seed, person));
    const double elevation = std::asin(std::clamp(-scene.up[0].z(), -1.0F, 1.0F)) * 180 / M_PI;
    EXPECT_TRUE(elevation > -36 && elevation < 76) << elevation;
    below += elevation < -20.01;
    above += elevation > 40.01;
  }
  EXPECT_NEAR(below, 1000 * 0.3 * 15 / 110, 25);
  EXPECT_NEAR(above, 1000 * 0.3 * 35 / 110, 35);
}

TEST(LifterWindows, ThePersonStaysBeforeTheCamera) {
  LifterWindowOptions options;
  options.dropout = 0;
  options.min_distance = 1;
  const LifterWindowGenerator generator = Generator(options);
  for (uint64_t seed = 0; seed < 100; ++seed) {
    const LifterPerson person = generator.MakePerson(seed);
    const LifterScene scene = generator.MakeScene(seed, person, generator.MakePoses(seed, person));
    for (const Vector3f& p : scene.points) ASSERT_GT(p.z(), 0.5);
    for (int t = 0; t < scene.num_frames; ++t) {
      const Vector3f* p = &scene.points[t * kLifterPoints];
      const Vector3f hip = 0.5F * (p[kLifterLeftHip] + p[kLifterLeftHip + 1]);
      ASSERT_LT(hip.head<2>().cwiseAbs().maxCoeff(), 1.1 * hip.z());  // a shaking camera may go a little further
    }
  }
}

TEST(LifterWindows, ASteadyCameraSeesOneUp) {
  LifterWindowOptions options = PlainOptions();
  const LifterWindowGenerator steady = Generator(options);
  options.moving_camera = 1;
  const LifterWindowGenerator moving = Generator(options);
  const LifterPerson person = steady.body().Person({});
  const auto spread = [&](const LifterWindowGenerator& g, uint64_t seed) {
    const LifterScene scene = g.MakeScene(seed, person, g.MakePoses(seed, person));
    double worst = 0;
    for (const Vector3f& up : scene.up) worst = std::max<double>(worst, (up - scene.up[0]).norm());
    return worst;
  };
  EXPECT_EQ(spread(steady, 4), 0);
  EXPECT_GT(spread(moving, 4), 1e-3);
}

TEST(LifterWindows, RejectsMotionsThatCannotBeUsed) {
  const auto expect_rejected = [](const std::function<void(Motion*)>& change) {
    Motion motion = ShortDemoMotion();
    change(&motion);
    try {
      const LifterWindowGenerator generator({ShortDemoMotion(), motion}, {1, 1}, ToyBody(), {});
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("motion 1"), std::string::npos) << error.what();
    }
  };
  expect_rejected([](Motion* m) { m->poses(7, 5) = std::numeric_limits<double>::quiet_NaN(); });
  expect_rejected([](Motion* m) { m->trans(3, 1) = std::numeric_limits<double>::infinity(); });
  expect_rejected([](Motion* m) { m->up = Motion::Up::kZ; });
  expect_rejected([](Motion* m) { m->timestamps[9] += 3; });
  expect_rejected([](Motion* m) { m->timestamps.pop_back(); });
  expect_rejected([](Motion* m) { m->poses = m->poses.leftCols(30).eval(); });
  expect_rejected([](Motion* m) { *m = Motion(); });
  expect_rejected([](Motion* m) {
    m->poses = m->poses.topRows(1).eval();
    m->trans = m->trans.topRows(1).eval();
    m->timestamps.resize(1);
  });
  EXPECT_THROW(LifterWindowGenerator({}, {}, ToyBody(), {}), std::invalid_argument);
  EXPECT_THROW(LifterWindowGenerator({ShortDemoMotion()}, {}, ToyBody(), {}), std::invalid_argument);
}

TEST(LifterWindows, RejectsOptionsOutOfRange) {
  const auto rejected = [](const std::function<void(LifterWindowOptions*)>& change) {
    LifterWindowOptions options;
    change(&options);
    std::string why;
    return !options.IsValid(&why) && why.starts_with("lifter windows: ");
  };
  EXPECT_TRUE(LifterWindowOptions().IsValid(nullptr));
  EXPECT_TRUE(rejected([](auto* o) { o->num_frames = 0; }));
  EXPECT_TRUE(rejected([](auto* o) { o->rate = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(rejected([](auto* o) { o->min_distance = 10; }));
  EXPECT_TRUE(rejected([](auto* o) { o->floor_poses = 1.5; }));
  EXPECT_TRUE(rejected([](auto* o) { o->noise = -1; }));
  EXPECT_TRUE(rejected([](auto* o) { o->max_elevation_deg = -30; }));
}

TEST(LifterWindows, OneFrameAndManyFrames) {
  for (const int frames : {1, 2, 400}) {
    LifterWindowOptions options;
    options.num_frames = frames;
    const LifterWindowGenerator generator = Generator(options);
    for (uint64_t seed = 0; seed < 20; ++seed)
      EXPECT_EQ(Window(generator, seed).features.size(), static_cast<size_t>(frames) * kLifterInputs);
  }
}

}  // namespace
}  // namespace bodyloom::lifter_windows_test
