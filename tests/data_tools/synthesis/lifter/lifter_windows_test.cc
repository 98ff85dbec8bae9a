// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/synthesis/lifter/lifter_windows.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "bodyloom/data_tools/synthesis/lifter/lifter_detections.h"
#include "bodyloom/geometry/base/parallel.h"
#include "tests/data_tools/synthesis/lifter/lifter_support.h"

namespace bodyloom {
namespace {

using Eigen::Vector3f;

LifterWindowGenerator Generator(const LifterWindowOptions& options, const Motion& motion = ShortDemoMotion()) {
  return LifterWindowGenerator({motion}, {1}, ToyBody(), options);
}

LifterWindow Window(const LifterWindowGenerator& generator, uint64_t seed) {
  LifterWindow window;
  generator.Generate(seed, &window);
  return window;
}

bool Same(const LifterWindow& a, const LifterWindow& b) {
  return a.features == b.features && a.points == b.points && a.up == b.up && a.contact == b.contact &&
         a.confidence == b.confidence;
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
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
  EXPECT_NEAR(lowest, -10, 1);
  EXPECT_NEAR(highest, 40, 1);
  EXPECT_NEAR(nearest, 2.6, 0.1);
  EXPECT_NEAR(farthest, 9, 0.2);
  for (const int n : yaws) EXPECT_NEAR(n, 125, 45);
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

/// A detection and the truth it is of, in person heights.
struct Error {
  double x, y, confidence;
  int point;
};

/// Errors of the noise model alone, window after window (27 frames at the rate given).
std::vector<std::vector<std::vector<Error>>> Errors(double rate, int windows) {
  LifterWindowOptions options = PlainOptions();
  options.rate = rate;
  options.num_frames = 61;
  const LifterWindowGenerator generator = Generator(options);
  LifterWindowOptions noisy = options;
  noisy.noise = 1;
  noisy.noise_spread = 0;
  std::vector<std::vector<std::vector<Error>>> errors;
  for (int seed = 0; seed < windows; ++seed) {
    const LifterPerson person = generator.MakePerson(seed);
    const LifterScene scene = generator.MakeScene(seed, person, generator.MakePoses(seed, person));
    const LifterFrames exact = DetectScene(scene, options, seed), found = DetectScene(scene, noisy, seed);
    EXPECT_EQ(exact.confidence, found.confidence);
    std::vector<std::vector<Error>> frames(options.num_frames);
    for (int t = 0; t < options.num_frames; ++t) {
      const Vector3f* p = &scene.points[t * kLifterPoints];
      const double depth = 0.5 * (p[kLifterLeftHip].z() + p[kLifterLeftHip + 1].z());
      const double height = 1.3 * scene.reference_length / depth;
      for (int k = 0; k < kLifterPoints; ++k) {
        const int i = t * kLifterPoints + k;
        frames[t].push_back(
            {(found.x[i] - exact.x[i]) / height, (found.y[i] - exact.y[i]) / height, found.confidence[i], k});
      }
    }
    errors.push_back(std::move(frames));
  }
  return errors;
}

TEST(LifterDetections, NoiseIsAsMeasuredOnRealDetections) {
  // Median error by confidence of real detections of people 370 px high (nine cameras, two dance clips).
  struct Row {
    double low, high, median_px_low, median_px_high;
  };
  const Row rows[] = {{.9, 1.01, 2.3, 6.5}, {.8, .9, 3, 5},    {.7, .8, 3.4, 5.6},
                      {.5, .7, 4.5, 7.5},   {.3, .5, 6, 10.5}, {0, .3, 8.5, 19}};
  const auto errors = Errors(20, 150);
  for (const Row& row : rows) {
    std::vector<double> lengths;
    for (const auto& window : errors) {
      for (const auto& frame : window) {
        for (const Error& e : frame) {
          if (e.confidence >= row.low && e.confidence < row.high) lengths.push_back(370 * std::hypot(e.x, e.y));
        }
      }
    }
    ASSERT_GT(lengths.size(), 500U) << row.low;
    const double median = Median(lengths);
    EXPECT_GT(median, row.median_px_low) << "confidence from " << row.low;
    EXPECT_LT(median, row.median_px_high) << "confidence from " << row.low;
  }
}

TEST(LifterDetections, NoiseIsCorrelatedInTimeAsMeasured) {
  // Of real detections at 60 frames a second: lag 1 0.75, lag 5 0.5, lag 15 0.17, lag 30 0 (after taking out each
  // window's constant part, as there).
  const auto errors = Errors(60, 150);
  const auto correlation = [&](int lag) {
    double product = 0, square = 0;
    for (const auto& window : errors) {
      for (int k = kLifterLeftShoulder; k < kLifterPoints; ++k) {
        for (size_t t = 0; t + lag < window.size(); ++t) {
          const Error &a = window[t][k], &b = window[t + lag][k];
          if (a.confidence < 0.4 || b.confidence < 0.4) continue;
          product += a.x * b.x + a.y * b.y;
          square += 0.5 * (a.x * a.x + a.y * a.y + b.x * b.x + b.y * b.y);
        }
      }
    }
    return product / square;
  };
  // The constant part (0.005 beside σ of 0.01) adds to every lag here.
  const double constant = correlation(58);
  const auto changing = [&](int lag) { return (correlation(lag) - constant) / (1 - constant); };
  EXPECT_NEAR(changing(1), 0.75, 0.07);
  EXPECT_NEAR(changing(5), 0.55, 0.09);
  EXPECT_NEAR(changing(15), 0.25, 0.12);
  EXPECT_NEAR(changing(30), 0.07, 0.1);
}

TEST(LifterDetections, NoiseScalesWithItsOption) {
  LifterWindowOptions options = PlainOptions();
  const LifterWindowGenerator generator = Generator(options);
  const LifterPerson person = generator.body().Person({});
  const LifterScene scene = generator.MakeScene(1, person, generator.MakePoses(1, person));
  const LifterFrames exact = DetectScene(scene, options, 5);
  options.noise_spread = 0;
  options.noise = 1;
  const LifterFrames once = DetectScene(scene, options, 5);
  options.noise = 2;
  const LifterFrames twice = DetectScene(scene, options, 5);
  for (size_t i = 0; i < exact.x.size(); ++i) EXPECT_NEAR(twice.x[i] - exact.x[i], 2 * (once.x[i] - exact.x[i]), 1e-5);
}

/// The scene of one standing body, `turn` about the vertical (0 faces the camera), with `pose` changes.
LifterScene StandingScene(
    float turn, const std::function<void(PoseSequence*)>& change = [](PoseSequence*) {}) {
  const LifterBody body(ToyBody());
  PoseSequence poses;
  poses.num_frames = 40;
  poses.has_floor = true;
  poses.rotations.assign(40 * kPoseJoints, Eigen::Quaternionf::Identity());
  poses.trans.assign(40, Vector3f::Zero());
  poses.clearance.assign(40, 0);
  for (int t = 0; t < 40; ++t) poses.at(t, kPelvis) = TurnBy({0, turn, 0});
  change(&poses);
  const LifterPerson person = body.Person({});
  const WorldMotion motion = PoseInWorld(body, person, poses, 20);
  LifterScene scene;  // a camera four metres before the body, by hand
  scene.num_frames = 40;
  scene.reference_length = person.reference_length;
  scene.contact = motion.contact;
  scene.up.assign(40, {0, -1, 0});
  for (const Vector3f& p : motion.points) scene.points.emplace_back(p.x(), 1 - p.y(), 4 - p.z());
  scene.detected = scene.points;
  return scene;
}

double MeanConfidence(const LifterScene& scene, int point) {
  LifterWindowOptions options = PlainOptions();
  double sum = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const LifterFrames frames = DetectScene(scene, options, seed);
    for (int t = 0; t < 40; ++t) sum += frames.confidence[t * kLifterPoints + point] / 800;
  }
  return sum;
}

TEST(LifterDetections, ConfidenceFallsBehindTheBodyAndTellsWhereTheFaceLooks) {
  const LifterScene front = StandingScene(0), back = StandingScene(static_cast<float>(M_PI));
  const LifterScene side = StandingScene(static_cast<float>(M_PI_2));  // the body's left turns away from the camera
  EXPECT_GT(MeanConfidence(front, kLifterNose), 0.9);
  EXPECT_LT(MeanConfidence(back, kLifterNose), 0.2);
  EXPECT_LT(MeanConfidence(back, kLifterLeftEye), 0.1);
  EXPECT_NEAR(MeanConfidence(front, kLifterLeftKnee), 0.74, 0.04);
  // Source: wrist behind the trunk 0.10, in front 0.65.
  const auto wrist = [&](float turn) {
    const auto hand_on_belly = [](PoseSequence* poses) {
      for (int t = 0; t < poses->num_frames; ++t) {
        poses->at(t, kLeftShoulder) =
            Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitX(), Vector3f(0.15F, -0.8F, 0.5F));
        poses->at(t, kLeftElbow) = TurnBy({0, -1.6F, 0});
      }
    };
    return MeanConfidence(StandingScene(turn, hand_on_belly), kLifterLeftWrist);
  };
  EXPECT_LT(wrist(static_cast<float>(M_PI)), 0.2);
  EXPECT_GT(wrist(0), 0.5);
  // Left or right is far in profile; only the far hip and shoulder are less certain.
  const double left = MeanConfidence(side, kLifterLeftHip), right = MeanConfidence(side, kLifterLeftHip + 1);
  EXPECT_GT(std::abs(left - right), 0.03);
  EXPECT_GT(std::abs(MeanConfidence(side, kLifterLeftEar) - MeanConfidence(side, kLifterLeftEar + 1)), 0.5);
}

/// Share of windows in which `holds`.
double Share(const LifterWindowOptions& options, int windows, const std::function<bool(const LifterFrames&)>& holds) {
  const LifterScene scene = StandingScene(0.3F);
  int count = 0;
  for (int seed = 0; seed < windows; ++seed) count += holds(DetectScene(scene, options, seed));
  return static_cast<double>(count) / windows;
}

int Missing(const LifterFrames& frames, int first, int end) {
  int count = 0;
  for (size_t i = 0; i < frames.confidence.size(); ++i) {
    const int k = static_cast<int>(i % kLifterPoints);
    count += k >= first && k < end && frames.confidence[i] == 0;
  }
  return count;
}

TEST(LifterDetections, PointsGoMissingAsOftenAsAsked) {
  LifterWindowOptions options = PlainOptions();
  const auto any = [](const LifterFrames& f) { return Missing(f, 0, kLifterPoints) > 0; };
  EXPECT_EQ(Share(options, 50, any), 0);
  options.no_feet = 0.6;
  EXPECT_NEAR(Share(options, 400, [](const LifterFrames& f) { return Missing(f, 17, 21) == 160; }), 0.6, 0.08);
  options = PlainOptions();
  options.no_face = 0.5;
  EXPECT_NEAR(Share(options, 400, [](const LifterFrames& f) { return Missing(f, 1, 5) == 160; }), 0.5, 0.08);
  options = PlainOptions();
  options.missing_lower_half = 1;
  EXPECT_NEAR(
      Share(options, 200, [](const LifterFrames& f) { return Missing(f, 13, 21) > 0 && Missing(f, 0, 11) == 0; }), 1,
      0.05);
  options = PlainOptions();
  options.missing_limb = 1;
  EXPECT_NEAR(Share(options, 200, any), 1, 0.05);
  options = PlainOptions();
  options.nothing = 1;
  EXPECT_NEAR(
      Share(options, 200, [](const LifterFrames& f) { return Missing(f, 0, 21) > 0 && Missing(f, 0, 21) % 21 == 0; }),
      1, 0.05);
  options = PlainOptions();
  options.image_border = 1;
  EXPECT_GT(Share(options, 200, any), 0.4);
  options = PlainOptions();
  options.cut_off = 1;  // of a person in plain view only the far ear is ever below
  EXPECT_GT(Share(options, 200, any), 0.08);
  options = PlainOptions();
  options.dropout = 0.1;
  double share = 0;
  const LifterScene scene = StandingScene(0);
  for (int seed = 0; seed < 50; ++seed) share += Missing(DetectScene(scene, options, seed), 0, 21) / (50.0 * 840);
  EXPECT_NEAR(share, 0.1, 0.01);
  options = PlainOptions();
  options.constant_confidence = 1;
  EXPECT_EQ(Share(options, 50,
                  [](const LifterFrames& f) {
                    return std::all_of(f.confidence.begin(), f.confidence.end(), [](float c) { return c == 1; });
                  }),
            1);
}

TEST(LifterDetections, SwapsExchangePairs) {
  LifterWindowOptions options = PlainOptions();
  const LifterScene scene = StandingScene(0);
  for (const bool whole : {false, true}) {
    options.pair_swap = whole ? 0 : 1;
    options.body_swap = whole ? 1 : 0;
    int exchanged = 0, hips = 0;
    for (int seed = 0; seed < 50; ++seed) {
      const LifterFrames frames = DetectScene(scene, options, seed);
      for (int t = 0; t < 40; ++t) {
        const auto swapped = [&](int k) {
          const Vector3f& p = scene.points[t * kLifterPoints + k + 1];
          return std::abs(frames.x[t * kLifterPoints + k] - p.x() / p.z()) < 1e-5;
        };
        exchanged += swapped(kLifterLeftKnee);
        hips += swapped(kLifterLeftHip);
        EXPECT_EQ(swapped(kLifterLeftAnkle), swapped(kLifterLeftBigToe));
      }
    }
    EXPECT_GT(exchanged, 40);
    EXPECT_EQ(hips > 0, whole);
  }
}

TEST(LifterWindows, RejectsMotionsThatCannotBeUsed) {
  const auto expect_rejected = [](const std::function<void(Motion*)>& change) {
    Motion motion = ShortDemoMotion();
    change(&motion);
    try {
      LifterWindowGenerator({ShortDemoMotion(), motion}, {1, 1}, ToyBody(), {});
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
  EXPECT_TRUE(rejected([](auto* o) { o->max_elevation_deg = -20; }));
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
}  // namespace bodyloom
