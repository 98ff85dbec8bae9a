// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/lifter/lifter_detections.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/data_tools/synthesis/lifter/lifter_support.h"

namespace bodyloom::lifter_detections_test {
namespace {

using Eigen::Vector3f;

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
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

}  // namespace
}  // namespace bodyloom::lifter_detections_test
