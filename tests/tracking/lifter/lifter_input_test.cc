// SPDX-License-Identifier: Apache-2.0
#include "tracking/lifter/lifter_input.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/observations.h"

namespace bodyloom::lifter_input_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMore = 3 * kLifterPoints;  // the first feature after the points

/// The mean built-in body in T-pose, facing the camera (a half turn about x): 21 points, mid-hip at the origin.
MatrixX3d FacingBody() {
  const BodyModel& body = BuiltinBody();
  const BodyPose pose = PoseFromAxisAngle(body, Eigen::VectorXd::Zero(72), Vector3d::Zero());
  MatrixX3d points = PoseLandmarks(body, Eigen::VectorXd::Zero(body.num_betas()), pose, LifterPointNames());
  const Eigen::RowVector3d hip = 0.5 * (points.row(kLifterLeftHip) + points.row(kLifterLeftHip + 1));
  points.rowwise() -= hip;
  points.rightCols(2) *= -1;
  return points;
}

LifterFrames Empty(int T) {
  LifterFrames frames;
  frames.num_frames = T;
  const size_t N = static_cast<size_t>(T) * kLifterPoints;
  frames.x.assign(N, 0);
  frames.y.assign(N, 0);
  frames.confidence.assign(N, 0);
  frames.focal_known = true;
  return frames;
}

/// Frame t shows `points` moved by `trans` with confidence 0.8.
void Show(const MatrixX3d& points, const Vector3d& trans, int t, LifterFrames* frames) {
  for (int k = 0; k < kLifterPoints; ++k) {
    const Vector3d p = points.row(k).transpose() + trans;
    const int i = t * kLifterPoints + k;
    frames->x[i] = static_cast<float>(p.x() / p.z());
    frames->y[i] = static_cast<float>(p.y() / p.z());
    frames->confidence[i] = 0.8F;
  }
}

LifterFrames OneFrame(const MatrixX3d& points, const Vector3d& trans) {
  LifterFrames frames = Empty(1);
  Show(points, trans, 0, &frames);
  return frames;
}

/// Keeps only the listed points.
void KeepOnly(const std::vector<int>& kept, LifterFrames* frames) {
  for (int i = 0; i < static_cast<int>(frames->confidence.size()); ++i) {
    if (std::find(kept.begin(), kept.end(), i % kLifterPoints) == kept.end()) frames->confidence[i] = 0;
  }
}

void ExpectUsable(const LifterInput& input, int T) {
  ASSERT_EQ(input.features.size(), static_cast<size_t>(T) * kLifterInputs);
  ASSERT_EQ(input.camera_from_virtual.size(), static_cast<size_t>(T));
  ASSERT_EQ(input.scale.size(), static_cast<size_t>(T));
  ASSERT_EQ(input.seen.size(), static_cast<size_t>(T));
  for (const float f : input.features) ASSERT_TRUE(std::isfinite(f) && std::abs(f) <= 50) << f;
  for (const float s : input.scale) ASSERT_TRUE(s > 0 && std::isfinite(s)) << s;
  for (const auto& R : input.camera_from_virtual) {
    ASSERT_TRUE(R.allFinite());
    ASSERT_NEAR((R * R.transpose() - Eigen::Matrix3f::Identity()).norm(), 0, 1e-5);
    ASSERT_NEAR(R.determinant(), 1, 1e-5);
  }
}

TEST(LifterInput, NamesAndIndicesAgree) {
  const auto& names = LifterPointNames();
  ASSERT_EQ(names.size(), static_cast<size_t>(kLifterPoints));
  EXPECT_TRUE(std::equal(CocoNames().begin(), CocoNames().end(), names.begin()));
  EXPECT_EQ(names[kLifterLeftShoulder], "left_shoulder");
  EXPECT_EQ(names[kLifterLeftHip + 1], "right_hip");
  EXPECT_EQ(names[kLifterLeftBigToe], "left_big_toe");
  EXPECT_EQ(names[kLifterLeftBigToe + 1], "right_big_toe");
  EXPECT_EQ(names[kLifterLeftHeel], "left_heel");
  EXPECT_EQ(names[kLifterLeftHeel + 1], "right_heel");
}

/// Far away, so that lengths in the image are lengths across the view.
TEST(LifterInput, ForeshorteningTellsDepthsApart) {
  const MatrixX3d body = FacingBody();
  MatrixX3d bent = body;
  // The left forearm turns by 60° towards the camera, about its elbow and the vertical.
  const Vector3d elbow = body.row(kLifterLeftElbow).transpose(),
                 forearm = body.row(kLifterLeftWrist).transpose() - elbow;
  const double side = forearm.x() > 0 ? 1 : -1;
  bent.row(kLifterLeftWrist) = (elbow + Eigen::AngleAxisd(side * M_PI / 3, Vector3d::UnitY()) * forearm).transpose();
  ASSERT_LT(bent(kLifterLeftWrist, 2), body(kLifterLeftWrist, 2) - 0.1);
  const double distance = 200;
  LifterFrames frames = Empty(2);
  Show(body, {0, 0, distance}, 0, &frames);
  Show(bent, {0, 0, distance}, 1, &frames);
  const LifterInput input = MakeLifterInput(frames);
  ExpectUsable(input, 2);
  const auto feature = [&](int t, int bone, int which) {
    return distance * input.scale[t] * input.features[t * kLifterInputs + kMore + 5 + 2 * bone + which];
  };
  const int left = 2, right = 3;
  const double across = forearm.head<2>().norm(),
               now = (bent.row(kLifterLeftWrist).transpose() - elbow).head<2>().norm();
  EXPECT_NEAR(feature(1, left, 1), across, 0.003);  // as long as its mirror image
  EXPECT_NEAR(feature(1, left, 0), std::sqrt(across * across - now * now), 0.003);
  EXPECT_NEAR(feature(1, left, 0), across * std::sin(M_PI / 3), 0.02);
  EXPECT_NEAR(feature(0, left, 0), 0, 0.02);
  EXPECT_NEAR(feature(1, right, 0), 0, 0.02);
  EXPECT_EQ(MirroredLifterBone(left), right);
  for (int bone = 0; bone < kLifterBones; ++bone) EXPECT_EQ(MirroredLifterBone(MirroredLifterBone(bone)), bone);

  KeepOnly({kLifterLeftElbow, kLifterLeftShoulder}, &frames);
  const LifterInput without = MakeLifterInput(frames);
  for (int bone = 0; bone < kLifterBones; ++bone) {
    const float* f = &without.features[kLifterInputs + kMore + 5 + 2 * bone];
    EXPECT_EQ(f[0] == 0 && f[1] == 0, bone != 0)
        << bone;  // the left upper arm is all there is; its full length is known
  }
}

TEST(LifterInput, FeaturesGiveTheRaysBack) {
  const MatrixX3d body = FacingBody();
  const LifterFrames frames = OneFrame(body, {1.1, -0.4, 3.2});
  const LifterInput input = MakeLifterInput(frames);
  ExpectUsable(input, 1);
  const Matrix3d R = input.camera_from_virtual[0].cast<double>();
  for (int k = 0; k < kLifterPoints; ++k) {
    const Vector3d v(input.features[3 * k] * input.scale[0], input.features[3 * k + 1] * input.scale[0], 1);
    const Vector3d back = R * v;
    EXPECT_NEAR(back.x() / back.z(), frames.x[k], 2e-6);
    EXPECT_NEAR(back.y() / back.z(), frames.y[k], 2e-6);
    EXPECT_FLOAT_EQ(input.features[3 * k + 2], 0.8F);
  }
}

TEST(LifterInput, VirtualCameraLooksAtTheMiddleWithoutRolling) {
  const MatrixX3d body = FacingBody();
  const Vector3d trans(-0.9, 0.5, 2.8);
  const LifterInput input = MakeLifterInput(OneFrame(body, trans));
  Vector3d middle = Vector3d::Zero();
  for (const int k : {kLifterLeftShoulder + 0, kLifterLeftShoulder + 1, kLifterLeftHip + 0, kLifterLeftHip + 1})
    middle += (body.row(k).transpose() + trans).normalized();
  const Matrix3d R = input.camera_from_virtual[0].cast<double>();
  EXPECT_NEAR((R.col(2) - middle.normalized()).norm(), 0, 1e-6);
  const Eigen::AngleAxisd turn(R);
  EXPECT_NEAR(turn.angle(), std::acos(middle.normalized().z()), 1e-4);  // no smaller rotation does it
  EXPECT_NEAR(turn.axis().z(), 0, 1e-4);
}

TEST(LifterInput, FewerThanTwoOfShouldersAndHipsCentreAllPoints) {
  LifterFrames frames = OneFrame(FacingBody(), {0, 0, 3});
  KeepOnly({kLifterLeftShoulder, kLifterLeftElbow, kLifterLeftWrist}, &frames);
  const LifterInput input = MakeLifterInput(frames);
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const int k : {kLifterLeftShoulder, kLifterLeftElbow, kLifterLeftWrist})
    middle += Eigen::Vector3f(frames.x[k], frames.y[k], 1).normalized();
  EXPECT_NEAR((input.camera_from_virtual[0].col(2) - middle.normalized()).norm(), 0, 1e-5);
}

TEST(LifterInput, ScaleIsTheBodysLengthOverItsDistance) {
  const MatrixX3d body = FacingBody();
  std::vector<float> flat;
  for (int k = 0; k < kLifterPoints; ++k) {
    for (int c = 0; c < 3; ++c) flat.push_back(static_cast<float>(body(k, c)));
  }
  const float length = LifterReferenceLength(flat);
  EXPECT_NEAR(length, 1.314, 2e-3);  // |mid-shoulder − mid-hip| 0.514, thigh 0.390, shin 0.411 m
  for (const double distance : {20.0, 40.0}) {
    const LifterInput input = MakeLifterInput(OneFrame(body, {0, 0, distance}));
    EXPECT_NEAR(input.scale[0] * distance / length, 1, 0.01);
    EXPECT_NEAR(input.features[kMore], std::log(length / distance) + 1.3, 0.01);
    EXPECT_EQ(input.features[kMore + 1], 1);
    EXPECT_NEAR(input.features[kMore + 2], 0.1, 1e-6);  // S_t = S
  }
}

TEST(LifterInput, PartsOfTheBodyGiveNearlyTheSameScale) {
  const LifterFrames whole = OneFrame(FacingBody(), {0, 0, 30});
  const float scale = MakeLifterInput(whole).scale[0];
  const int shoulder = kLifterLeftShoulder, hip = kLifterLeftHip, knee = kLifterLeftKnee, ankle = kLifterLeftAnkle;
  const auto scale_of = [&](const std::vector<int>& kept) {
    LifterFrames part = whole;
    KeepOnly(kept, &part);
    return MakeLifterInput(part).scale[0] / scale;
  };
  // The shares are those that the network was trained with first, of a body with shins 4 % longer and arms 5 to 7 %
  // shorter.
  EXPECT_NEAR(scale_of({shoulder, shoulder + 1, hip, hip + 1}), 1.022, 0.01);
  EXPECT_NEAR(scale_of({hip, knee, ankle}), 0.986, 0.01);
  EXPECT_NEAR(scale_of({hip, knee, hip + 1, knee + 1}), 1.014, 0.01);
  EXPECT_NEAR(scale_of({knee, ankle}), 0.96, 0.01);
  EXPECT_NEAR(scale_of({shoulder, shoulder + 1}), 1, 0.01);
  EXPECT_NEAR(scale_of({shoulder + 1, kLifterLeftElbow + 1}), 1.073, 0.01);
  EXPECT_NEAR(scale_of({kLifterLeftElbow, kLifterLeftWrist}), 1.053, 0.01);
  EXPECT_NEAR(scale_of({kLifterLeftEar, kLifterLeftEar + 1}), 1.016, 0.01);
}

TEST(LifterInput, ScaleIsThePercentileOfItsWindow) {
  const int T = 150;
  const MatrixX3d body = FacingBody();
  LifterFrames frames = Empty(T);
  std::mt19937 random(3);
  std::vector<float> single(T);
  for (int t = 0; t < T; ++t) {
    const double squeeze = std::uniform_real_distribution<>(0.3, 1)(random);
    MatrixX3d folded = body;
    folded.col(1) *= squeeze;
    Show(folded, {0.2, 0, 5}, t, &frames);
    if (t % 7 == 3) {
      for (int k = 0; k < kLifterPoints; ++k) frames.confidence[t * kLifterPoints + k] = 0;
    } else {
      single[t] = MakeLifterInput(OneFrame(folded, {0.2, 0, 5})).scale[0];
    }
  }
  const LifterInput input = MakeLifterInput(frames);
  for (int t = 0; t < T; ++t) {
    std::vector<float> window;
    for (int s = std::max(0, t - 40); s <= std::min(T - 1, t + 40); ++s) {
      if (single[s] > 0) window.push_back(single[s]);
    }
    std::sort(window.begin(), window.end());
    const double at = 0.85 * (static_cast<double>(window.size()) - 1);
    const double expected =
        window[static_cast<size_t>(at)] +
        (at - std::floor(at)) * (window[static_cast<size_t>(std::ceil(at))] - window[static_cast<size_t>(at)]);
    ASSERT_NEAR(input.scale[t], expected, 1e-6) << t;
    const float by_frame = input.features[t * kLifterInputs + kMore + 2];
    if (single[t] > 0) {
      ASSERT_NEAR(by_frame, single[t] / expected - 0.9, 1e-5);
    } else {
      ASSERT_EQ(by_frame, 0);
    }
  }
}

TEST(LifterInput, UnknownFocalLengthHidesTheScaleAlone) {
  LifterFrames frames = OneFrame(FacingBody(), {0.5, 0, 4});
  const LifterInput known = MakeLifterInput(frames);
  frames.focal_known = false;
  const LifterInput unknown = MakeLifterInput(frames);
  EXPECT_NE(known.features[kMore], 0);
  EXPECT_EQ(unknown.features[kMore], 0);
  EXPECT_EQ(unknown.features[kMore + 1], 0);
  for (int i = 0; i < kMore; ++i) EXPECT_EQ(known.features[i], unknown.features[i]);
}

TEST(LifterInput, MotionOfTheCentreIsInBodySizes) {
  const MatrixX3d body = FacingBody();
  LifterFrames frames = Empty(4);
  const Vector3d step(0.06, -0.02, 0);
  for (const int t : {0, 1, 3}) Show(body, Vector3d(-0.1, 0, 30) + t * step, t, &frames);
  const LifterInput input = MakeLifterInput(frames);
  const auto motion = [&](int t, int c) { return input.features[t * kLifterInputs + kMore + 3 + c]; };
  EXPECT_EQ(motion(0, 0), 0);
  EXPECT_NEAR(motion(1, 0), 0.06 / 1.317, 1e-3);
  EXPECT_NEAR(motion(1, 1), -0.02 / 1.317, 1e-3);
  for (const int t : {2, 3}) {
    EXPECT_EQ(motion(t, 0), 0) << "nothing is seen in frame 2";
    EXPECT_EQ(motion(t, 1), 0);
  }
}

TEST(LifterInput, GapsLookWhereTheBodyMustHaveBeen) {
  const MatrixX3d body = FacingBody();
  LifterFrames frames = Empty(9);
  Show(body, {-1, 0, 4}, 2, &frames);
  Show(body, {1, 0, 4}, 6, &frames);
  const LifterInput input = MakeLifterInput(frames);
  ExpectUsable(input, 9);
  const auto axis = [&](int t) { return Eigen::Vector3f(input.camera_from_virtual[t].col(2)); };
  EXPECT_EQ(axis(0), axis(2));
  EXPECT_EQ(axis(8), axis(6));
  EXPECT_NEAR((axis(4) - (axis(2) + axis(6)).normalized()).norm(), 0, 1e-6);
  for (int t = 0; t < 9; ++t) EXPECT_EQ(input.seen[t], t == 2 || t == 6);
}

TEST(LifterInput, FramesWithoutSizeTakeTheNearestOne) {
  const MatrixX3d body = FacingBody();
  LifterFrames frames = Empty(200);
  Show(body, {0, 0, 4}, 0, &frames);
  Show(body, {0, 0, 8}, 199, &frames);
  const LifterInput input = MakeLifterInput(frames);
  EXPECT_EQ(input.scale[90], input.scale[0]);
  EXPECT_EQ(input.scale[110], input.scale[199]);
  EXPECT_GT(input.scale[0], 1.9 * input.scale[199]);
}

TEST(LifterInput, MirroredDetectionsGiveMirroredFeatures) {
  const MatrixX3d body = FacingBody();
  LifterFrames frames = Empty(3), mirrored = frames;
  for (int t = 0; t < 3; ++t) Show(body, {0.4 * t, 0.2, 3}, t, &frames);
  frames.confidence[5] = 0;
  mirrored.focal_known = frames.focal_known;
  const auto twin = [](int k) { return k == 0 ? 0 : k + (k % 2 == 1 ? 1 : -1); };
  for (int i = 0; i < 3 * kLifterPoints; ++i) {
    const int j = i / kLifterPoints * kLifterPoints + twin(i % kLifterPoints);
    mirrored.x[j] = -frames.x[i];
    mirrored.y[j] = frames.y[i];
    mirrored.confidence[j] = frames.confidence[i];
  }
  const LifterInput a = MakeLifterInput(frames), b = MakeLifterInput(mirrored);
  for (int t = 0; t < 3; ++t) {
    const float* fa = &a.features[t * kLifterInputs];
    const float* fb = &b.features[t * kLifterInputs];
    for (int k = 0; k < kLifterPoints; ++k) {
      EXPECT_NEAR(fa[3 * k], -fb[3 * twin(k)], 1e-5);
      EXPECT_NEAR(fa[3 * k + 1], fb[3 * twin(k) + 1], 1e-5);
      EXPECT_EQ(fa[3 * k + 2], fb[3 * twin(k) + 2]);
    }
    EXPECT_NEAR(fa[kMore + 3], -fb[kMore + 3], 1e-5);
  }
}

TEST(LifterInput, OneWildPointStaysWithinBounds) {
  LifterFrames frames = OneFrame(FacingBody(), {0, 0, 6});
  frames.x[kLifterLeftWrist] = 7;                                       // 82° off: seen, but bounded
  frames.x[kLifterLeftWrist + 1] = 1e30F;                               // 90° off: missing
  frames.y[kLifterLeftKnee] = std::numeric_limits<float>::quiet_NaN();  // missing
  frames.confidence[kLifterLeftAnkle] = std::numeric_limits<float>::quiet_NaN();
  frames.confidence[kLifterNose] = 1.7F;
  const LifterInput input = MakeLifterInput(frames);
  ExpectUsable(input, 1);
  EXPECT_EQ(input.features[3 * kLifterLeftWrist], 4);
  for (const int k : {kLifterLeftWrist + 1, kLifterLeftKnee + 0, kLifterLeftAnkle + 0}) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(input.features[3 * k + c], 0) << k;
  }
  EXPECT_EQ(input.features[2], 1);
}

TEST(LifterInput, LittleOrNothingSeenIsFinite) {
  ExpectUsable(MakeLifterInput(Empty(0)), 0);
  const LifterInput nothing = MakeLifterInput(Empty(5));
  ExpectUsable(nothing, 5);
  for (int t = 0; t < 5; ++t) {
    EXPECT_FALSE(nothing.seen[t]);
    EXPECT_TRUE(nothing.camera_from_virtual[t].isIdentity());
  }
  for (int k = 0; k < kLifterPoints; ++k) {
    LifterFrames frames = OneFrame(FacingBody(), {0.3, 0.1, 3});
    KeepOnly({k}, &frames);
    const LifterInput input = MakeLifterInput(frames);
    ExpectUsable(input, 1);
    EXPECT_TRUE(input.seen[0]);
    EXPECT_NEAR(input.features[3 * k], 0, 1e-5);  // the only point is the middle
  }
  LifterFrames heap = OneFrame(FacingBody(), {0, 0, 3});  // all points in one place
  std::fill(heap.x.begin(), heap.x.end(), 0.2F);
  std::fill(heap.y.begin(), heap.y.end(), -0.1F);
  ExpectUsable(MakeLifterInput(heap), 1);
}

TEST(LifterInput, GarbageIsFinite) {
  std::mt19937 random(11);
  const float strange[] = {0,
                           -1,
                           1e38F,
                           -1e38F,
                           1e-38F,
                           std::numeric_limits<float>::infinity(),
                           -std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::quiet_NaN()};
  for (int round = 0; round < 300; ++round) {
    LifterFrames frames = Empty(1 + round % 9);
    const auto draw = [&] {
      return random() % 3 == 0 ? strange[random() % 8]
                               : std::uniform_real_distribution<float>(-3, 3)(random) * (random() % 5 == 0 ? 100 : 1);
    };
    for (size_t i = 0; i < frames.x.size(); ++i) {
      frames.x[i] = draw();
      frames.y[i] = draw();
      frames.confidence[i] = draw();
    }
    frames.focal_known = round % 2 == 0;
    ExpectUsable(MakeLifterInput(frames), frames.num_frames);
  }
}

TEST(LifterInput, RejectsArraysOfAnotherLength) {
  LifterFrames frames = Empty(2);
  frames.y.pop_back();
  EXPECT_THROW(MakeLifterInput(frames), std::invalid_argument);
  frames = Empty(2);
  frames.num_frames = -1;
  EXPECT_THROW(MakeLifterInput(frames), std::invalid_argument);
  EXPECT_THROW(LifterReferenceLength(std::vector<float>(12)), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::lifter_input_test
