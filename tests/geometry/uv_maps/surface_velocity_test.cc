// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/surface_velocity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/body/surface_jacobian.h"
#include "geometry/math/rotation.h"
#include "tests/geometry/random_body.h"
#include "tests/support/toy_body.h"

namespace bodyloom::surface_velocity_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

std::vector<double> Times(int n, double fps, double jitter, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<double> times;
  times.reserve(static_cast<size_t>(n));
  for (int t = 0; t < n; ++t) times.push_back((t + jitter * (random() / 4294967296.0 - 0.5)) / fps);
  return times;
}

VelocityStencilOptions Scheme(VelocityScheme scheme) { return {.scheme = scheme}; }

double Apply(const VelocityStencil& stencil, const std::vector<double>& values) {
  double sum = 0;
  for (size_t k = 0; k < stencil.weights.size(); ++k) sum += stencil.weights[k] * values[stencil.first_frame + k];
  return sum;
}

TEST(VelocityStencil, IsExactForPolynomialsOfItsDegreeAtAnySpacing) {
  const std::vector<double> times = Times(40, 30, 0.4, 1);
  const std::vector<char> usable(times.size(), 1);
  for (const auto& [scheme, degree] :
       {std::pair{VelocityScheme::kBackward, 1}, {VelocityScheme::kCentral, 2}, {VelocityScheme::kSavitzkyGolay, 3}}) {
    const auto stencils = VelocityStencils(times, usable, Scheme(scheme));
    for (int power = 0; power <= degree; ++power) {
      std::vector<double> values;
      values.reserve(times.size());
      for (const double t : times) values.push_back(std::pow(t, power));
      for (size_t t = 0; t < times.size(); ++t) {  // ends included
        const double expected = power == 0 ? 0 : power * std::pow(times[t], power - 1);
        ASSERT_NEAR(Apply(stencils[t], values), expected, 1e-9) << "degree " << power << ", frame " << t;
      }
    }
    // One degree more is beyond it.
    std::vector<double> values;
    values.reserve(times.size());
    for (const double t : times) values.push_back(std::pow(t, degree + 1));
    EXPECT_GT(std::abs(Apply(stencils[20], values) - (degree + 1) * std::pow(times[20], degree)), 1e-6);
  }
}

TEST(VelocityStencil, HasTheWeightsOfTheTables) {
  const std::vector<double> times = Times(30, 30, 0, 1);
  const std::vector<char> usable(30, 1);
  const auto savgol = VelocityStencils(times, usable);
  // Savitzky and Golay's table: first derivative, cubic, seven points.
  const double table[7] = {22, -67, -58, 0, 58, 67, -22};
  ASSERT_EQ(savgol[15].weights.size(), 7U);
  EXPECT_EQ(savgol[15].first_frame, 12);
  for (int k = 0; k < 7; ++k) EXPECT_NEAR(savgol[15].weights[k], 30 * table[k] / 252, 1e-9) << k;
  // Closed forms of the noise: sqrt(2)/dt and 1/(sqrt(2) dt).
  EXPECT_NEAR(VelocityStencils(times, usable, Scheme(VelocityScheme::kBackward))[15].NoiseGain(), 30 * std::sqrt(2.0),
              1e-9);
  EXPECT_NEAR(VelocityStencils(times, usable, Scheme(VelocityScheme::kCentral))[15].NoiseGain(), 30 / std::sqrt(2.0),
              1e-9);
  EXPECT_NEAR(savgol[15].NoiseGain(), 30 * std::sqrt(0.26257), 1e-3);  // Σ table² / 252²
  // The window is a time: more frames at 60 a second, as few as the degree allows at 5.
  EXPECT_EQ(VelocityStencils(Times(60, 60, 0, 1), std::vector<char>(60, 1))[30].weights.size(), 15U);
  EXPECT_EQ(VelocityStencils(Times(60, 5, 0, 1), std::vector<char>(60, 1))[30].weights.size(), 5U);
}

TEST(VelocityStencil, NeverReachesAcrossAGap) {
  std::vector<double> times = Times(40, 30, 0, 1);
  for (size_t t = 25; t < times.size(); ++t) times[t] += 1 / 30.0;  // one frame was dropped
  std::vector<char> usable(40, 1);
  usable[10] = usable[12] = 0;
  for (const VelocityScheme scheme :
       {VelocityScheme::kBackward, VelocityScheme::kCentral, VelocityScheme::kSavitzkyGolay}) {
    const auto stencils = VelocityStencils(times, usable, Scheme(scheme));
    const auto run_of = [](int t) { return t < 10 ? 0 : t == 11 ? 1 : t < 25 ? 2 : 3; };
    for (int t = 0; t < 40; ++t) {
      if (t == 10 || t == 12) {
        EXPECT_TRUE(stencils[t].weights.empty());
        EXPECT_EQ(stencils[t].segment, -1);
        continue;
      }
      EXPECT_EQ(stencils[t].segment, run_of(t)) << t;
      EXPECT_EQ(stencils[t].weights.empty(), t == 11) << t;  // alone between two lost frames
      for (size_t k = 0; k < stencils[t].weights.size(); ++k) {
        const int from = stencils[t].first_frame + static_cast<int>(k);
        EXPECT_EQ(run_of(from), run_of(t)) << t;
        EXPECT_TRUE(usable[from]) << t;
      }
    }
  }
  // A longer limit lets the dropped frame pass.
  EXPECT_EQ(VelocityStencils(times, usable, {.longest_step_s = 0.1})[39].segment, 2);
}

TEST(VelocityStencil, OfShortRunsUsesTheDegreeTheyAllow) {
  for (int n = 1; n <= 9; ++n) {
    const std::vector<double> times = Times(n, 30, 0.3, n);
    const auto stencils = VelocityStencils(times, std::vector<char>(n, 1));
    for (int t = 0; t < n; ++t) {
      ASSERT_EQ(stencils[t].weights.size(), n == 1 ? 0U : static_cast<size_t>(std::min(n, 7)));
      if (n > 1) {
        EXPECT_NEAR(Apply(stencils[t], times), 1, 1e-9);
      }
    }
  }
  EXPECT_TRUE(VelocityStencils({}, {}).empty());
}

std::string ErrorOf(const std::vector<double>& times, size_t frames, const VelocityStencilOptions& options = {}) {
  try {
    VelocityStencils(times, std::vector<char>(frames, 1), options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(VelocityStencil, RefusesTimesThatDoNotGrow) {
  EXPECT_THAT(ErrorOf({0, 0.1, 0.1, 0.2}, 4), HasSubstr("frame 2"));
  EXPECT_THAT(ErrorOf({0, 0.1, 0.05, 0.2}, 4), HasSubstr("frame 2 is at 0.05 s after 0.1 s"));
  EXPECT_THAT(ErrorOf({0, std::nan(""), 0.2}, 3), HasSubstr("frame 1"));
  EXPECT_THAT(ErrorOf({0, 0.1}, 3), HasSubstr("2 timestamps for 3"));
  EXPECT_THAT(ErrorOf({0, 0.1}, 2, {.window_s = 0}), HasSubstr("window_s"));
  EXPECT_THAT(ErrorOf({0, 0.1}, 2, {.order = 6}), HasSubstr("order"));
  EXPECT_THAT(ErrorOf({0, 0.1}, 2, {.longest_step_s = std::nan("")}), HasSubstr("longest_step_s"));
}

/// A clip of the toy body as the describing code sees it: poses, vertices from the root, roots.
struct Clip {
  std::vector<BodyPose> poses;
  std::vector<double> times;
  std::vector<float> vertices;
  std::vector<Vector3d> roots;
  ShapedBody shape;
};

Clip MakeClip(const BodyModel& body, const std::vector<BodyPose>& poses, const std::vector<double>& times) {
  Clip clip{poses, times, std::vector<float>(3 * poses.size() * body.num_vertices()), {}, {}};
  const Skinner skinner(body);
  clip.shape = skinner.Shape(Eigen::VectorXd());
  MatrixX3d roots;
  skinner.SkinFromRoot(clip.shape, poses, clip.vertices, &roots);
  for (Eigen::Index t = 0; t < roots.rows(); ++t) clip.roots.push_back(roots.row(t).transpose());
  return clip;
}

MatrixX3f Differences(const Clip& clip, const VelocityStencil& stencil) {
  const size_t stride = clip.vertices.size() / clip.poses.size();
  std::vector<const float*> frames;
  std::vector<Vector3d> roots;
  for (size_t k = 0; k < stencil.weights.size(); ++k) {
    frames.push_back(clip.vertices.data() + stride * (stencil.first_frame + k));
    roots.push_back(clip.roots[stencil.first_frame + k]);
  }
  MatrixX3f result(stride / 3, 3);
  DifferenceVertices(stencil, frames, roots, {result.data(), stride});
  return result;
}

PoseRates Rates(const Clip& clip, const VelocityStencil& stencil, int t) {
  std::vector<const BodyPose*> poses;
  for (size_t k = 0; k < stencil.weights.size(); ++k) poses.push_back(&clip.poses[stencil.first_frame + k]);
  return RatesOf(stencil, poses, clip.poses[t]);
}

MatrixX3f Analytic(const BodyModel& body, const Clip& clip, const PoseRates& rates, int t, int threads = 1) {
  MatrixX3f result(body.num_vertices(), 3);
  VelocitySkinner(body).Velocities(clip.shape, std::span(&clip.poses[t], 1), std::span(&rates, 1),
                                   {result.data(), static_cast<size_t>(result.size())}, threads);
  return result;
}

/// Turning about a fixed axis through the pelvis, which moves at a constant speed.
const Vector3d kSpin(0.7, 2.1, -0.4), kPush(1.5, -0.3, 0.8);

std::vector<BodyPose> RigidMotion(const BodyModel& body, const std::vector<double>& times, const Vector3d& far_away) {
  const BodyPose start = RandomPose(body, 3, 0.8);
  const Vector3d rest_root = body.RestJoints(Eigen::VectorXd()).row(0).transpose();
  std::vector<BodyPose> poses;
  for (const double t : times) {
    BodyPose pose = start;
    pose.rotations[0] = RotationFromAxisAngle(kSpin * t) * start.rotations[0];
    pose.trans = far_away + kPush * t - rest_root;
    poses.push_back(pose);
  }
  return poses;
}

TEST(SurfaceVelocity, OfATurningRigidBodyIsTheClosedForm) {
  const BodyModel& body = ToyBody();
  const std::vector<double> times = Times(31, 30, 0, 1);
  const std::vector<char> usable(times.size(), 1);
  for (const double distance : {0.0, 1e4}) {  // far from the origin nothing is lost
    const Clip clip = MakeClip(body, RigidMotion(body, times, {0, 0, distance}), times);
    const int t = 15;
    const Eigen::Map<const MatrixX3f> from_root(clip.vertices.data() + size_t(3) * t * body.num_vertices(),
                                                body.num_vertices(), 3);
    MatrixX3d truth(body.num_vertices(), 3);
    for (int v = 0; v < body.num_vertices(); ++v) {
      truth.row(v) = (kPush + kSpin.cross(from_root.row(v).transpose().cast<double>())).transpose();
    }
    const auto error = [&](const MatrixX3f& found) {
      return (found.cast<double>() - truth).rowwise().norm().maxCoeff();
    };
    // Of the part that turns, errors are ω dt/2, (ω dt)²/6 and of fourth order; the analytic rate of a constant spin is
    // exact.
    const double speed = (truth.rowwise() - kPush.transpose()).rowwise().norm().maxCoeff();
    ASSERT_GT(speed, 1);
    const double phase = kSpin.norm() / 30;
    const auto stencil = [&](VelocityScheme s) { return VelocityStencils(times, usable, Scheme(s))[t]; };
    EXPECT_NEAR(error(Differences(clip, stencil(VelocityScheme::kBackward))) / speed, phase / 2, 0.01 * phase);
    EXPECT_LT(error(Differences(clip, stencil(VelocityScheme::kCentral))), 1.01 * speed * phase * phase / 6);
    EXPECT_LT(error(Differences(clip, stencil(VelocityScheme::kSavitzkyGolay))), speed * std::pow(phase, 4) * 2 + 2e-5);
    const auto savgol = stencil(VelocityScheme::kSavitzkyGolay);
    EXPECT_LT(error(Analytic(body, clip, Rates(clip, savgol, t), t)), 5e-6) << distance;
  }
}

TEST(SurfaceVelocity, OfARigidBodyInItsOwnFrameIsZero) {
  const BodyModel& body = ToyBody();
  Track track;
  track.motion.timestamps = Times(20, 30, 0.2, 1);
  const std::vector<BodyPose> poses = RigidMotion(body, track.motion.timestamps, {0, 0, 3});
  track.motion.poses.resize(20, 72);
  track.motion.trans.resize(20, 3);
  for (int t = 0; t < 20; ++t) {
    track.motion.poses.row(t) = AxisAngleFromPose(body, poses[t]).transpose();
    track.motion.trans.row(t) = poses[t].trans.transpose();
  }
  track.frame_status.assign(20, FrameStatus::kTracked);
  std::vector<BodyPose> own;
  for (const auto& pose : PosesInFrame(body, track, SurfaceFrame::kBody)) own.push_back(*pose);
  const Clip clip = MakeClip(body, own, track.motion.timestamps);
  for (const VelocityStencil& stencil : VelocityStencils(track.motion.timestamps, std::vector<char>(20, 1))) {
    EXPECT_LT(Differences(clip, stencil).cwiseAbs().maxCoeff(), 2e-5F);
  }
}

/// Smooth articulated motion.
std::vector<BodyPose> Swinging(const BodyModel& body, const std::vector<double>& times) {
  const BodyPose centre = RandomPose(body, 5, 0.7);
  std::mt19937 random(9);
  std::vector<Vector3d> amplitude, phase;
  for (int j = 0; j < body.num_joints(); ++j) {
    const auto uniform = [&] { return random() / 4294967296.0 * 2 - 1; };
    amplitude.push_back({0.5 * uniform(), 0.5 * uniform(), 0.5 * uniform()});
    phase.push_back({3 * uniform(), 3 * uniform(), 3 * uniform()});
  }
  std::vector<BodyPose> poses;
  for (const double t : times) {
    BodyPose pose = centre;
    for (int j = 0; j < body.num_joints(); ++j) {
      const Vector3d swing = amplitude[j].array() * (4 * t + phase[j].array()).sin();
      pose.rotations[j] = centre.rotations[j] * RotationFromAxisAngle(swing);
    }
    pose.trans = Vector3d(std::sin(3 * t), 0.2 * std::cos(5 * t), 2 + t);
    poses.push_back(pose);
  }
  return poses;
}

TEST(SurfaceVelocity, AnalyticIsTheJacobianTimesTheRates) {
  RandomBodyOptions options;
  options.num_vertices = 200;
  options.correctives_per_vertex = 5;
  const BodyModel random_body = RandomBody(options);
  for (const BodyModel* body : {&random_body, &ToyBody()}) {
    const std::vector<double> times = Times(11, 30, 0, 1);
    const Clip clip = MakeClip(*body, Swinging(*body, times), times);
    const PoseRates rates = Rates(clip, VelocityStencils(times, std::vector<char>(11, 1))[5], 5);
    const MatrixX3f found = Analytic(*body, clip, rates, 5);
    const SurfaceJacobian jacobian(*body, Eigen::VectorXd(), clip.poses[5]);
    int checked = 0;
    for (int v = 0; v < body->num_vertices(); v += 3, ++checked) {
      const double one = 1;
      const PointJacobian point = jacobian.OfVertices(std::span(&v, 1), std::span(&one, 1));
      Vector3d velocity = rates.trans;
      for (size_t k = 0; k < point.joints.size(); ++k) {
        velocity += point.d_point_d_rotation[k] * rates.angular[point.joints[k]];
      }
      ASSERT_LT((found.row(v).transpose().cast<double>() - velocity).norm(), 1e-5 * (1 + velocity.norm())) << v;
    }
    EXPECT_GT(checked, 60);
  }
}

TEST(SurfaceVelocity, OfASmoothMotionConvergesToTheTruth) {
  const BodyModel& body = ToyBody();
  const double now = 0.5;
  // Truth: central differences of the exact body at a tiny step, in double.
  const double h = 1e-5;
  const std::vector<BodyPose> around = Swinging(body, {now - h, now + h});
  const MatrixX3d truth =
      (PoseVertices(body, Eigen::VectorXd(), around[1]) - PoseVertices(body, Eigen::VectorXd(), around[0])) / (2 * h);
  const auto rms = [&](const MatrixX3f& found) {
    return std::sqrt((found.cast<double>() - truth).squaredNorm() / static_cast<double>(truth.rows()));
  };
  double before[3] = {1, 1, 1};
  for (const int fps : {30, 60}) {
    std::vector<double> times;
    for (int t = -10; t <= 10; ++t) times.push_back(now + t / static_cast<double>(fps));
    const std::vector<char> usable(times.size(), 1);
    const Clip clip = MakeClip(body, Swinging(body, times), times);
    const auto savgol = VelocityStencils(times, usable, {.window_s = 6.6 / fps})[10];
    const double errors[3] = {
        rms(Differences(clip, VelocityStencils(times, usable, Scheme(VelocityScheme::kBackward))[10])),
        rms(Differences(clip, VelocityStencils(times, usable, Scheme(VelocityScheme::kCentral))[10])),
        rms(Analytic(body, clip, Rates(clip, savgol, 10), 10))};
    if (fps == 60) {
      EXPECT_NEAR(before[0] / errors[0], 2, 0.2);  // first order
      EXPECT_NEAR(before[1] / errors[1], 4, 0.6);  // second
      EXPECT_NEAR(before[2] / errors[2], 16, 4);   // fourth
      EXPECT_LT(errors[2], 2e-3);
    }
    std::copy(errors, errors + 3, before);
  }
}

/// A track from poses, and the analytic velocities of frame t in a frame of reference.
struct InFrame {
  MatrixX3f velocities;
  MatrixX3d from_root;
  PoseRates rates;
  BodyPose pose;
};

InFrame VelocitiesIn(SurfaceFrame frame, const BodyModel& body, const Track& track, const CameraPose& camera, int t) {
  std::vector<BodyPose> poses;
  for (const auto& pose : PosesInFrame(body, track, frame, camera)) poses.push_back(*pose);
  const Clip clip = MakeClip(body, poses, track.motion.timestamps);
  InFrame result;
  result.rates = Rates(clip, VelocityStencils(clip.times, std::vector<char>(clip.times.size(), 1))[t], t);
  result.velocities = Analytic(body, clip, result.rates, t);
  result.pose = clip.poses[t];
  result.from_root =
      Eigen::Map<const MatrixX3f>(clip.vertices.data() + size_t(3) * t * body.num_vertices(), body.num_vertices(), 3)
          .cast<double>();
  return result;
}

TEST(SurfaceVelocity, OfTheFramesFollowFromEachOther) {
  const BodyModel& body = ToyBody();
  Track track;
  track.motion.timestamps = Times(15, 30, 0, 1);
  const std::vector<BodyPose> poses = Swinging(body, track.motion.timestamps);
  track.motion.poses.resize(15, 72);
  track.motion.trans.resize(15, 3);
  for (int t = 0; t < 15; ++t) {
    track.motion.poses.row(t) = AxisAngleFromPose(body, poses[t]).transpose();
    track.motion.trans.row(t) = poses[t].trans.transpose();
  }
  track.frame_status.assign(15, FrameStatus::kTracked);
  CameraPose camera{RotationFromAxisAngle(Vector3d(0.5, -0.9, 2)), Vector3d(3, 1, -2)};
  const int t = 7;
  const InFrame of_camera = VelocitiesIn(SurfaceFrame::kCamera, body, track, camera, t);
  const InFrame of_world = VelocitiesIn(SurfaceFrame::kWorld, body, track, camera, t);
  const InFrame of_body = VelocitiesIn(SurfaceFrame::kBody, body, track, camera, t);
  const Matrix3d R = of_camera.pose.rotations[0];
  const Vector3d spin = R * of_camera.rates.angular[0];
  for (int v = 0; v < body.num_vertices(); ++v) {
    const Vector3d velocity = of_camera.velocities.row(v).transpose().cast<double>();
    const Vector3d x = of_camera.from_root.row(v).transpose();
    const Vector3d world = camera.camera_from_world_rotation.transpose() * velocity;
    const Vector3d own = R.transpose() * (velocity - of_camera.rates.trans - spin.cross(x));
    ASSERT_LT((of_world.velocities.row(v).transpose().cast<double>() - world).norm(), 1e-5);
    ASSERT_LT((of_body.velocities.row(v).transpose().cast<double>() - own).norm(), 1e-5);
  }
  EXPECT_GT(of_body.velocities.rowwise().norm().maxCoeff(), 0.5F);
  // The root's world position is the camera's, carried over.
  const Vector3d rest_root = body.RestJoints(Eigen::VectorXd()).row(0).transpose();
  EXPECT_LT((camera.camera_from_world_rotation * (rest_root + of_world.pose.trans) +
             camera.camera_from_world_translation - rest_root - of_camera.pose.trans)
                .norm(),
            1e-12);
}

TEST(PosesInFrame, LeaveOutLostFramesAndAddTheOffsetsOfWeakPerspective) {
  const BodyModel& body = ToyBody();
  Track track;
  track.camera.model = CameraModel::kWeakPerspective;
  track.motion.poses = RowMatrixXd::Zero(3, 72);
  track.motion.trans = MatrixX3d::Zero(3, 3);
  track.motion.timestamps = {0, 1, 2};
  track.weak_camera.resize(3, 3);
  track.weak_camera << 100, 0.25, -0.5, 100, std::nan(""), 0, 100, 1, 2;
  track.frame_status = {FrameStatus::kInterpolated, FrameStatus::kTracked, FrameStatus::kLost};
  const auto poses = PosesInFrame(body, track, SurfaceFrame::kCamera);
  ASSERT_TRUE(poses[0].has_value());
  EXPECT_EQ(poses[0]->trans, Vector3d(0.25, -0.5, 0));
  EXPECT_FALSE(poses[1].has_value());
  EXPECT_FALSE(poses[2].has_value());
}

TEST(SurfaceVelocity, SameBytesForAnyNumberOfThreads) {
  const BodyModel& body = ToyBody();
  const std::vector<double> times = Times(41, 30, 0, 1);
  const Clip clip = MakeClip(body, Swinging(body, times), times);
  const auto stencils = VelocityStencils(times, std::vector<char>(41, 1));
  std::vector<PoseRates> rates;
  rates.reserve(41);
  for (int t = 0; t < 41; ++t) rates.push_back(Rates(clip, stencils[t], t));
  std::vector<float> one(clip.vertices.size()), many(clip.vertices.size());
  const VelocitySkinner skinner(body);
  skinner.Velocities(clip.shape, clip.poses, rates, one, 1);
  for (const int threads : {2, 5}) {
    skinner.Velocities(clip.shape, clip.poses, rates, many, threads);
    EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(float)), 0);
  }
  EXPECT_THROW(skinner.Velocities(clip.shape, clip.poses, std::span(rates).first(3), many, 1), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::surface_velocity_test
