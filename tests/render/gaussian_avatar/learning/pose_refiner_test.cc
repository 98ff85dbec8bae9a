// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/pose_refiner.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "tests/render/gaussian_avatar/learning/training_example.h"
#include "tests/render/gaussian_avatar/person_scene.h"
#include "tests/render/splat/same_bytes.h"

namespace bodyloom::pose_refiner_test {
namespace {

using Eigen::Vector3d;

/// The toy body without pose correctives.
BodyModel PlainBody() {
  BodyModelData data = ToyBodyData();
  data.posedirs = {};
  return BodyModel(std::move(data));
}

/// The derivative by a correction, ours and by differences, of a linear loss on posed Gaussians.
struct Slopes {
  std::vector<double> ours, differences;
};

Slopes SlopesOn(const BodyModel& model) {
  const Eigen::VectorXd betas = Eigen::VectorXd::Constant(2, 0.5);
  std::vector<TrackedPose> poses(1);
  poses[0].pose = RandomPose(model, 4, 1.2, 2.5);
  const PoseRefiner refiner(model, betas, poses, {});
  PoseCorrections at;
  at.Reset(1, model.num_joints());
  std::mt19937 generator(8);
  const auto uniform = [&] { return generator() / 2147483648.0 - 1; };
  for (int c = 0; c < at.values.columns(); ++c) at.values(0, c) = static_cast<float>(0.4 * uniform());
  AvatarFrame frame;
  refiner.MakeFrame(0, at, 1, &frame);
  // On the skin, where correctives count in full.
  GaussianBody body = SkinGaussians(model, betas, BuildUvTexelTable(model, {.width = 24, .height = 24}));
  FloatColumns weights(CameraGaussians::kNumColumns, body.size());
  for (int c = 0; c < weights.columns(); ++c) {
    for (float& w : weights.values(c)) w = static_cast<float>(uniform());
  }
  const auto loss = [&](const PoseCorrections& corrections) {
    AvatarFrame moved;
    refiner.MakeFrame(0, corrections, 1, &moved);
    CameraGaussians posed;
    PoseGaussians(body, model.data().faces, moved, {}, &posed);
    double sum = 0;
    for (int c = 0; c < weights.columns(); ++c) {
      for (int i = 0; i < body.size(); ++i) sum += double{weights(i, c)} * posed.columns(i, c);
    }
    return sum;
  };
  PoseGradient pose_gradient;
  AvatarGradient gradient;
  pose_gradient.Compute(body, model.data().faces, frame, {}, weights, &gradient);
  Slopes slopes;
  const Eigen::VectorXd ours = refiner.ByCorrection(0, gradient.bones, at);
  for (int c = 0; c < at.values.columns(); ++c) {
    PoseCorrections above = at, below = at;
    const float step = 1e-2F;
    above.values(0, c) += step, below.values(0, c) -= step;
    slopes.ours.push_back(ours[c]);
    slopes.differences.push_back((loss(above) - loss(below)) / (double{above.values(0, c)} - below.values(0, c)));
  }
  return slopes;
}

TEST(PoseRefiner, DerivativeByACorrectionIsADifference) {
  const Slopes slopes = SlopesOn(PlainBody());
  int compared = 0;
  for (size_t c = 0; c < slopes.ours.size(); ++c) {
    EXPECT_NEAR(slopes.ours[c], slopes.differences[c], 2e-3 + 2e-4 * std::abs(slopes.differences[c])) << c;
    compared += static_cast<int>(std::abs(slopes.differences[c]) > 0.1);
  }
  EXPECT_GT(compared, 40);
}

TEST(PoseRefiner, CorrectivesLeftOutOfTheDerivativeAreASmallPartOfIt) {
  const Slopes slopes = SlopesOn(ToyBody());
  double left_out = 0, all = 0;
  for (size_t c = 0; c < slopes.ours.size(); ++c) {
    left_out += std::pow(slopes.ours[c] - slopes.differences[c], 2);
    all += std::pow(slopes.differences[c], 2);
  }
  EXPECT_GT(left_out, 0);
  EXPECT_LT(std::sqrt(left_out / all), 0.05);
}

/// The example's poses off by up to `degrees` a joint and some centimetres, with the truth's Gaussians.
struct OffPoses {
  std::vector<TrackedPose> poses;
  explicit OffPoses(double degrees) {
    std::mt19937 generator(2);
    const auto uniform = [&] { return generator() / 2147483648.0 - 1; };
    for (const BodyPose& truth : Example().poses) {
      TrackedPose tracked;
      tracked.pose = truth;
      for (Eigen::Matrix3d& rotation : tracked.pose.rotations) {
        rotation = rotation * RotationFromAxisAngle(degrees * M_PI / 180 * Vector3d{uniform(), uniform(), uniform()});
      }
      tracked.pose.trans += 0.004 * degrees * Vector3d{uniform(), uniform(), uniform()};
      poses.push_back(tracked);
    }
  }
  /// Mean distance of the joints from the truth across the view, millimetres: along it one picture says little.
  [[nodiscard]] double AcrossMm(const PoseRefiner& refiner, const PoseCorrections& corrections) const {
    const TrainingExample& example = Example();
    const MatrixX3d rest = example.model.RestJoints(example.betas);
    double sum = 0;
    for (int t = 0; t < refiner.num_frames(); ++t) {
      const MatrixX3d truth = PoseSkeleton(example.model, rest, example.poses[t]).joints;
      const MatrixX3d ours = PoseSkeleton(example.model, rest, refiner.PoseAt(t, corrections)).joints;
      sum += 1e3 * (truth - ours).leftCols<2>().rowwise().norm().mean();
    }
    return sum / refiner.num_frames();
  }
};

AvatarTrainerOptions PosesAlone(int64_t steps) {
  AvatarTrainerOptions options;
  options.steps = steps;
  options.learn_person = false, options.refine_from = 0;
  return options;
}

/// Poses that have nothing in common with those beside them, in small pictures that are sharp.
PoseRefinerOptions Unconnected() {
  PoseRefinerOptions options;
  options.drift = 1e6, options.photo_sigma = 0.01;
  return options;
}

AvatarTrainingState TrueState(const PoseRefiner& refiner) {
  AvatarTrainingState state = AvatarTrainingState::Of(Example().truth);
  state.poses.Reset(refiner.num_frames(), refiner.num_joints());
  return state;
}

TEST(PoseRefiner, BringsAPerturbedPoseBack) {
  const TrainingExample& example = Example();
  const OffPoses off(4);
  const PoseRefiner refiner(example.model, example.betas, off.poses, Unconnected());
  AvatarTrainingState state = TrueState(refiner);
  const double before = off.AcrossMm(refiner, state.poses);
  EXPECT_GT(before, 15);
  AvatarTrainer trainer(example.model.data().faces, example.views, PosesAlone(4 * 40), &refiner);
  const FloatColumns person = state.body.parameters;
  while (!trainer.IsDone(state)) trainer.Step(&state);
  EXPECT_LT(off.AcrossMm(refiner, state.poses), 0.25 * before) << before << " mm before";
  EXPECT_TRUE(SameBytes(person, state.body.parameters)) << "the person is not learned here";
}

TEST(PoseRefiner, TheTrueTrackStaysWhereItIs) {
  const TrainingExample& example = Example();
  const OffPoses none(0);
  const PoseRefiner refiner(example.model, example.betas, none.poses, Unconnected());
  AvatarTrainingState state = TrueState(refiner);
  AvatarTrainer trainer(example.model.data().faces, example.views, PosesAlone(4 * 40), &refiner);
  while (!trainer.IsDone(state)) trainer.Step(&state);
  EXPECT_LT(none.AcrossMm(refiner, state.poses), 3);
}

/// For comparisons to the bit, in which -0 is not 0.
template <class Matrix>
std::vector<uint64_t> BitsOf(const Matrix& matrix) {
  std::vector<uint64_t> bits(static_cast<size_t>(matrix.size()));
  for (size_t i = 0; i < bits.size(); ++i) bits[i] = std::bit_cast<uint64_t>(matrix.data()[i]);
  return bits;
}

TEST(PoseRefiner, ThePriorAloneLeavesTheTrack) {
  const TrainingExample& example = Example();
  const OffPoses off(5);
  const PoseRefiner refiner(example.model, example.betas, off.poses, {});
  PoseCorrections corrections;
  corrections.Reset(4, refiner.num_joints());
  const std::vector<float> nothing(12 * static_cast<size_t>(refiner.num_joints()), 0.0F);
  for (int step = 0; step < 40; ++step) refiner.Step(step % 4, nothing, 5000, step / 40.0, &corrections);
  for (int t = 0; t < 4; ++t) {
    EXPECT_TRUE(corrections.IsZero(t));
    const BodyPose pose = refiner.PoseAt(t, corrections);
    const BodyPose& track = off.poses[t].pose;
    EXPECT_EQ(BitsOf(pose.trans), BitsOf(track.trans));
    for (size_t j = 0; j < pose.rotations.size(); ++j) {
      EXPECT_EQ(BitsOf(pose.rotations[j]), BitsOf(track.rotations[j]));
    }
  }
}

TEST(PoseRefiner, ThePriorPullsBackToTheTrackAndToTheFramesBeside) {
  const TrainingExample& example = Example();
  const PoseRefiner refiner(example.model, example.betas, OffPoses(0).poses, {});
  const std::vector<float> nothing(12 * static_cast<size_t>(refiner.num_joints()), 0.0F);
  PoseCorrections corrections;
  corrections.Reset(4, refiner.num_joints());
  corrections.values(1, 50) = 0.05F;
  for (int step = 0; step < 60; ++step) refiner.Step(1, nothing, 5000, step / 60.0, &corrections);
  EXPECT_LT(std::abs(corrections.values(1, 50)), 0.005F);
  // A frame without a correction beside one that has one is pulled along.
  corrections.Reset(4, refiner.num_joints());
  corrections.values(1, 50) = 0.05F, corrections.steps[1] = 1;
  for (int step = 0; step < 60; ++step) refiner.Step(2, nothing, 5000, step / 60.0, &corrections);
  EXPECT_GT(corrections.values(2, 50), 0.02F);
  EXPECT_LT(corrections.values(2, 50), 0.05F);
}

TEST(PoseRefiner, SameBytesForAnyThreadsAndAfterAStop) {
  const TrainingExample& example = Example();
  const OffPoses off(3);
  const PoseRefiner refiner(example.model, example.betas, off.poses, {});
  AvatarTrainerOptions options;
  options.steps = 24, options.relocate_every = 10, options.refine_from = 0.2;
  const auto start = [&] {
    AvatarTrainingState state = AvatarTrainingState::Of(SkinGaussians(example.model, example.betas, example.texels));
    state.poses.Reset(refiner.num_frames(), refiner.num_joints());
    return state;
  };
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* table) {
    options.num_threads = threads;
    AvatarTrainer trainer(example.model.data().faces, example.views, options, &refiner);
    AvatarTrainingState state = start();
    while (!trainer.IsDone(state)) trainer.Step(&state);
    *table = state.poses.values;
  });
  AvatarTrainingState whole = start(), parts = start();
  const auto run = [&](int64_t until, AvatarTrainingState* state) {
    AvatarTrainer trainer(example.model.data().faces, example.views, options, &refiner);
    while (state->step < until) trainer.Step(state);
  };
  run(24, &whole);
  run(11, &parts);
  EXPECT_FALSE(parts.poses.IsZero(0) && parts.poses.IsZero(1)) << "refined by then";
  run(24, &parts);
  EXPECT_TRUE(SameBytes(whole.poses.values, parts.poses.values));
  EXPECT_TRUE(SameBytes(whole.poses.mean, parts.poses.mean));
  EXPECT_TRUE(SameBytes(whole.body.parameters, parts.body.parameters));
}

TEST(PoseRefiner, NothingIsRefinedBeforeItsTime) {
  const TrainingExample& example = Example();
  const PoseRefiner refiner(example.model, example.betas, OffPoses(3).poses, {});
  AvatarTrainerOptions options;
  options.steps = 20, options.refine_from = 0.5;
  AvatarTrainer trainer(example.model.data().faces, example.views, options, &refiner);
  AvatarTrainingState state = AvatarTrainingState::Of(SkinGaussians(example.model, example.betas, example.texels));
  state.poses.Reset(refiner.num_frames(), refiner.num_joints());
  const auto corrected = [&] {
    int count = 0;
    for (int t = 0; t < 4; ++t) count += state.poses.IsZero(t) ? 0 : 1;
    return count;
  };
  while (state.step < 10) trainer.Step(&state);
  EXPECT_EQ(corrected(), 0);
  while (!trainer.IsDone(state)) trainer.Step(&state);
  EXPECT_EQ(corrected(), 4);
}

TEST(PoseRefiner, RefusesWhatDoesNotFit) {
  const TrainingExample& example = Example();
  const OffPoses off(1);
  PoseRefinerOptions options;
  options.photo_sigma = 0;
  EXPECT_THROW(PoseRefiner(example.model, example.betas, off.poses, options), std::invalid_argument);
  std::vector<TrackedPose> other = off.poses;
  other[1].pose.rotations.pop_back();
  EXPECT_THROW(PoseRefiner(example.model, example.betas, other, {}), std::invalid_argument);
  const PoseRefiner refiner(example.model, example.betas, off.poses, {});
  PoseCorrections corrections;
  corrections.Reset(4, refiner.num_joints());
  std::vector<float> by_bones(12 * static_cast<size_t>(refiner.num_joints()), 1.0F);
  by_bones[7] = std::numeric_limits<float>::quiet_NaN();
  refiner.Step(0, by_bones, 5000, 0, &corrections);
  EXPECT_TRUE(corrections.IsZero(0)) << "no number, no step";
  by_bones[7] = 1;
  refiner.Step(0, by_bones, 5000, 0, &corrections);
  EXPECT_FALSE(corrections.IsZero(0)) << "and the next one goes on";
  by_bones.pop_back();
  EXPECT_THROW(refiner.Step(0, by_bones, 5000, 0, &corrections), std::invalid_argument);
  const PoseRefiner fewer(example.model, example.betas, {off.poses[0]}, {});
  EXPECT_THROW(AvatarTrainer(example.model.data().faces, example.views, PosesAlone(4), &fewer), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::pose_refiner_test
