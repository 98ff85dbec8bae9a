// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <random>
#include <stdexcept>

#include <cmath>
#include <limits>
#include <string>

#include "render/gaussian_avatar/learning/avatar_trainer.h"

#include "render/gaussian_avatar/learning/loose_gaussians.h"
#include "tests/render/gaussian_avatar/learning/training_example.h"
#include "tests/render/splat/same_bytes.h"

namespace bodyloom::avatar_trainer_test {
namespace {

AvatarTrainerOptions Short(int64_t steps) {
  AvatarTrainerOptions options;
  options.steps = steps;
  options.relocate_every = 10;
  return options;
}

double MeanLoss(const std::vector<double>& losses, size_t first, size_t count) {
  double sum = 0;
  for (size_t i = first; i < first + count; ++i) sum += losses[i];
  return sum / static_cast<double>(count);
}

TEST(LearningRates, SettleAsTheirLawSays) {
  const AvatarRates rates;
  const auto at = [&](double progress, int64_t step, int column) { return rates.At(progress, step)[column]; };
  EXPECT_FLOAT_EQ(at(0, 0, GaussianBody::kAlbedo), rates.albedo);
  EXPECT_FLOAT_EQ(at(0.5, 0, GaussianBody::kAlbedo), rates.albedo) << "until the middle by the steps alone";
  EXPECT_FLOAT_EQ(at(0.3, 9000, GaussianBody::kNormal), rates.normal / 2);
  EXPECT_FLOAT_EQ(at(1, 9000, GaussianBody::kWeightLogit), 0.03F * rates.weight_logit / 2);
  EXPECT_FLOAT_EQ(at(0.75, 0, GaussianBody::kOpacityLogit), std::sqrt(0.03F) * rates.opacity_logit);
  EXPECT_FLOAT_EQ(at(0.5, 9000, GaussianBody::kPosition), std::sqrt(0.03F) * rates.position) << "places by progress";
  std::string why;
  AvatarRates bad;
  bad.settle_steps = 0;
  EXPECT_FALSE(bad.IsValid(&why));
  bad = {}, bad.others_at_end = 0;
  EXPECT_FALSE(bad.IsValid(&why));
}

TEST(AvatarTrainer, LearnsAPersonsColours) {
  const TrainingExample& example = Example();
  AvatarTrainer trainer(example.model.data().faces, example.views, Short(120));
  AvatarTrainingState state = example.Start();
  std::vector<double> losses;
  while (!trainer.IsDone(state)) losses.push_back(trainer.Step(&state).loss);
  ASSERT_EQ(losses.size(), 120U);
  EXPECT_LT(MeanLoss(losses, 100, 20), 0.55 * MeanLoss(losses, 0, 20));
  std::string why;
  EXPECT_TRUE(state.body.IsValid(example.model.num_joints(), example.model.num_faces(), &why)) << why;
  EXPECT_EQ(state.body.size(), example.Start().body.size());
}

TEST(AvatarTrainer, SameBytesForAnyThreadsAndInstructionSet) {
  const TrainingExample& example = Example();
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* table) {
    AvatarTrainerOptions options = Short(12);
    options.num_threads = threads;
    options.dead_opacity = 0.88F;  // half of them move
    AvatarTrainer trainer(example.model.data().faces, example.views, options);
    AvatarTrainingState state = example.Start();
    int relocated = 0;
    while (!trainer.IsDone(state)) relocated += trainer.Step(&state).relocated;
    EXPECT_GT(relocated, 0);
    *table = state.body.parameters;
    for (int k = 0; k < GaussianBody::kLightValues; ++k) (*table)(k, 0) += state.body.light[k];
  });
}

TEST(AvatarTrainer, AKeptStateGoesOnAsIfNeverLeft) {
  const TrainingExample& example = Example();
  const auto run = [&](int64_t until, AvatarTrainingState* state) {
    AvatarTrainer trainer(example.model.data().faces, example.views, Short(30));
    while (state->step < until) trainer.Step(state);
  };
  AvatarTrainingState whole = example.Start(), parts = example.Start();
  run(30, &whole);
  run(13, &parts);
  const AvatarTrainingState kept = parts;
  parts = kept;
  run(30, &parts);
  EXPECT_TRUE(SameBytes(whole.body.parameters, parts.body.parameters));
  EXPECT_EQ(whole.body.light, parts.body.light);
  EXPECT_TRUE(SameBytes(whole.adam.second, parts.adam.second));
}

TEST(AvatarTrainer, AnotherSeedIsAnotherTraining) {
  const TrainingExample& example = Example();
  FloatColumns results[2];
  for (const int seed : {0, 1}) {
    AvatarTrainerOptions options = Short(5);
    options.seed = seed;
    AvatarTrainer trainer(example.model.data().faces, example.views, options);
    AvatarTrainingState state = example.Start();
    while (!trainer.IsDone(state)) trainer.Step(&state);
    results[seed] = state.body.parameters;
  }
  EXPECT_FALSE(SameBytes(results[0], results[1]));
}

TEST(AvatarTrainer, EveryViewComesOnceARound) {
  const TrainingExample& example = Example();
  AvatarTrainer trainer(example.model.data().faces, example.views, Short(100));
  AvatarTrainingState state = example.Start();
  for (int round = 0; round < 3; ++round) {
    std::vector<int> seen(example.views.size());
    for (size_t k = 0; k < example.views.size(); ++k) ++seen[trainer.Step(&state).view];
    EXPECT_EQ(seen, std::vector<int>(example.views.size(), 1));
  }
}

TEST(AvatarTrainer, LightIsLearned) {
  const TrainingExample& example = Example();
  AvatarTrainer trainer(example.model.data().faces, example.views, Short(3));
  AvatarTrainingState state = example.Start();
  const auto before = state.body.light;
  trainer.Step(&state);
  for (int k = 0; k < GaussianBody::kLightValues; ++k) {
    EXPECT_NEAR(std::abs(state.body.light[k] - before[k]), 2e-3, 1e-5) << k;
  }
}

TEST(AvatarTrainer, WhatIsHiddenLearnsNothing) {
  const TrainingExample& example = Example();
  const auto count = [&](double min_seen, int* skin_kept, int* loose_fading) {
    AvatarTrainerOptions options = Short(30);
    options.relocate_every = 0, options.min_seen = min_seen;
    // One frame, and so one side.
    AvatarTrainer trainer(example.model.data().faces, std::span(example.views).first(1), options);
    AvatarTrainingState state = example.Start();
    for (int i = 0; i < state.body.size(); ++i) {
      state.body.kinds[i] = i % 2 == 0 ? GaussianKind::kSkin : GaussianKind::kLoose;
      state.body.parameters(i, GaussianBody::kOpacityLogit) = 5;
    }
    const GaussianBody before = state.body;
    while (!trainer.IsDone(state)) trainer.Step(&state);
    *skin_kept = *loose_fading = 0;
    for (int i = 0; i < before.size(); ++i) {
      const auto same = [&](int c) { return state.body.parameters(i, c) == before.parameters(i, c); };
      const bool colour_same = same(GaussianBody::kAlbedo) && same(GaussianBody::kAlbedo + 1);
      const bool opacity_same = same(GaussianBody::kOpacityLogit);
      if (i % 2 == 0 && colour_same && opacity_same && same(GaussianBody::kPosition)) ++*skin_kept;
      if (i % 2 == 1 && colour_same && !opacity_same) {
        ++*loose_fading;
        EXPECT_LT(state.body.parameters(i, GaussianBody::kOpacityLogit),
                  before.parameters(i, GaussianBody::kOpacityLogit));
      }
    }
    return before.size();
  };
  int skin_kept = 0, loose_fading = 0;
  const int rows = count(0.1, &skin_kept, &loose_fading);
  EXPECT_GT(skin_kept, rows / 20) << "the back and the rims of what lies in front";
  EXPECT_GT(loose_fading, rows / 20);
  count(0, &skin_kept, &loose_fading);
  EXPECT_LT(skin_kept, rows / 40) << "what comes through by a thousandth moved it";
}

TEST(AvatarTrainer, TimeEndsItToo) {
  const TrainingExample& example = Example();
  AvatarTrainerOptions options = Short(1000000);
  options.seconds = 10;
  const AvatarTrainer trainer(example.model.data().faces, example.views, options);
  AvatarTrainingState state = example.Start();
  state.seconds = 5;
  EXPECT_DOUBLE_EQ(trainer.Progress(state), 0.5);
  state.seconds = 11;
  EXPECT_TRUE(trainer.IsDone(state));
}

TEST(AvatarTrainer, RefusesClipsWithoutAPersonAndOptionsOutOfRange) {
  const TrainingExample& example = Example();
  const std::vector<TrainingView> nobody(3);
  EXPECT_THROW(AvatarTrainer(example.model.data().faces, nobody, {}), std::invalid_argument);
  AvatarTrainerOptions options;
  options.steps = 0;
  EXPECT_THROW(AvatarTrainer(example.model.data().faces, example.views, options), std::invalid_argument);
  options.steps = 1, options.rates.albedo = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(AvatarTrainer(example.model.data().faces, example.views, options), std::invalid_argument);
}

TEST(LearningRates, PlacesBecomeFiner) {
  const AvatarRates rates;
  EXPECT_FLOAT_EQ(rates.At(0, 0)[GaussianBody::kPosition + 2], 3e-4F);
  EXPECT_FLOAT_EQ(rates.At(1, 500)[GaussianBody::kPosition], 9e-6F);
  EXPECT_NEAR(rates.At(0.5, 500)[GaussianBody::kPosition], 3e-4 * std::sqrt(0.03), 1e-9);
  EXPECT_EQ(rates.At(0.2, 70)[GaussianBody::kAlbedo + 2], rates.At(0.4, 70)[GaussianBody::kAlbedo]);
}

TEST(RelocateGaussians, DeadOnesBecomeCopiesOfWhatPulls) {
  GaussianBody body = Example().Start().body;
  const GaussianBody before = body;
  std::vector<float> pull(body.size(), 0.0F);
  pull[20] = 3, pull[21] = std::numeric_limits<float>::quiet_NaN(), pull[22] = -1;
  body.parameters(5, GaussianBody::kOpacityLogit) = -6;
  const std::vector<int> moved = RelocateGaussians(pull, {}, &body);
  ASSERT_EQ(moved, std::vector<int>{5});
  EXPECT_EQ(body.anchors[5].face, before.anchors[20].face);
  EXPECT_EQ(body.parameters(5, GaussianBody::kAlbedo), before.parameters(20, GaussianBody::kAlbedo));
  const auto opacity = [](const GaussianBody& of, int row) {
    return 1 / (1 + std::exp(-static_cast<double>(of.parameters(row, GaussianBody::kOpacityLogit))));
  };
  // The two together let through what the one did.
  EXPECT_NEAR((1 - opacity(body, 5)) * (1 - opacity(body, 20)), 1 - opacity(before, 20), 1e-6);
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double apart =
        body.parameters(5, GaussianBody::kPosition + k) - before.parameters(20, GaussianBody::kPosition + k);
    square += apart * apart;
    EXPECT_NEAR(body.parameters(5, GaussianBody::kLogScale + k),
                before.parameters(20, GaussianBody::kLogScale + k) + std::log(0.8), 1e-6);
  }
  EXPECT_GT(square, 0);
  EXPECT_LT(std::sqrt(square), 5 * std::exp(before.parameters(20, GaussianBody::kLogScale)));
  EXPECT_TRUE(RelocateGaussians(std::vector<float>(body.size(), 0), {}, &body).empty());
  EXPECT_THROW(RelocateGaussians(std::vector<float>(3), {}, &body), std::invalid_argument);
}

TEST(SmoothSkinWeights, AreTheBodysOnTheSkinAndSmoothOffIt) {
  const TrainingExample& example = Example();
  const SmoothSkinWeights skin(example.model, example.betas, 0.3F, 2);
  std::vector<float> weights(skin.num_joints());
  int compared = 0;
  for (int v = 0; v < example.model.num_vertices(); v += 40) {
    const Eigen::Vector3f place = skin.vertices().row(v).transpose();
    EXPECT_LT(skin.DistanceTo(place), 0.04) << v;
    skin.WeightsAt(place, weights.data());
    double sum = 0, overlap = 0;
    for (const float w : weights) sum += w;
    for (int k = example.model.influence_begin()[v]; k < example.model.influence_begin()[v + 1]; ++k) {
      overlap += std::min<double>(weights[example.model.influence_joint()[k]], example.model.influence_weight()[k]);
    }
    EXPECT_NEAR(sum, 1, 1e-5);
    EXPECT_GT(overlap, 0.4) << v;
    EXPECT_EQ(skin.NearestVertex(place + Eigen::Vector3f::Constant(1e-5F)), v);
    ++compared;
  }
  EXPECT_GT(compared, 15);
  EXPECT_GT(skin.DistanceTo(Eigen::Vector3f(0, 50, 0)), 0.3);
  EXPECT_THROW(SmoothSkinWeights(example.model, example.betas, 0, 1), std::invalid_argument);
}

TEST(LooseGaussians, LieInTheShellOfTheHull) {
  const TrainingExample& example = Example();
  LooseGaussiansOptions options;
  options.spacing_m = 0.03F, options.reach_m = 0.2F, options.count = 500;
  const GaussianBody loose = LooseGaussians(example.model, example.betas, example.views, options);
  ASSERT_GT(loose.size(), 20);
  ASSERT_LE(loose.size(), 500);
  std::string why;
  EXPECT_TRUE(loose.IsValid(example.model.num_joints(), example.model.num_faces(), &why)) << why;
  const SmoothSkinWeights skin(example.model, example.betas, 0.2F, 1);
  for (int i = 0; i < loose.size(); ++i) {
    const Eigen::Vector3f place(loose.parameters(i, 0), loose.parameters(i, 1), loose.parameters(i, 2));
    EXPECT_LE(skin.DistanceTo(place), 0.2F);
    EXPECT_EQ(loose.kinds[i], GaussianKind::kLoose);
    const int32_t* joints = loose.joints.data() + static_cast<size_t>(i) * GaussianBody::kInfluences;
    EXPECT_EQ(std::count(joints, joints + GaussianBody::kInfluences, 0) > 0, true) << "the pelvis is missing";
    EXPECT_GE(loose.anchors[i].corrective_factor, 0);
  }
  options.num_threads = 3;
  EXPECT_TRUE(
      SameBytes(loose.parameters, LooseGaussians(example.model, example.betas, example.views, options).parameters));
  options.seed = 2, options.count = 15;
  EXPECT_EQ(LooseGaussians(example.model, example.betas, example.views, options).size(), 15);
  // Without a visible person nothing is trained.
  std::vector<TrainingView> nobody = example.views;
  for (TrainingView& view : nobody) std::fill(view.pixels.begin(), view.pixels.end(), uint8_t{0});
  EXPECT_EQ(LooseGaussians(example.model, example.betas, nobody, options).size(), 0);
  options.spacing_m = 0;
  EXPECT_THROW(LooseGaussians(example.model, example.betas, nobody, options), std::invalid_argument);
}

TEST(LooseGaussians, AppendedRowsFollowTheOthers) {
  const GaussianBody skin = Example().Start().body;
  GaussianBody both = skin;
  AppendGaussians(skin, &both);
  ASSERT_EQ(both.size(), 2 * skin.size());
  const int i = skin.size() + 3;
  for (int c = 0; c < GaussianBody::kNumParameters; ++c) EXPECT_EQ(both.parameters(i, c), skin.parameters(3, c));
  EXPECT_EQ(both.anchors[i].face, skin.anchors[3].face);
  EXPECT_EQ(both.joints[i * GaussianBody::kInfluences], skin.joints[3 * GaussianBody::kInfluences]);
  EXPECT_EQ(both.light, skin.light);
}

TEST(TrainingView, CutsThePersonAndRemembersWhoIsWhere) {
  Image image(30, 20, {10, 20, 30});
  const auto is_person = [](int x, int y) { return x >= 10 && x < 14 && y >= 5 && y < 9; };
  const TrainingView view = CutTrainingView(image, is_person, {0, 0, 12, 20}, {8, 2, 11, 4}, 2);
  EXPECT_EQ(view.person_pixels, 8) << "beyond the search nobody counts";
  EXPECT_EQ(view.window.x_begin, 6);
  EXPECT_EQ(view.window.y_begin, 0);
  EXPECT_EQ(view.window.x_end, 14);
  EXPECT_EQ(view.window.y_end, 11);
  EXPECT_TRUE(view.ShowsPerson(10, 5));
  EXPECT_FALSE(view.ShowsPerson(12, 5));
  EXPECT_FALSE(view.ShowsPerson(9, 5));
  EXPECT_FALSE(view.ShowsPerson(29, 19));
  ImageTruth truth;
  FillTruth(view, &truth);
  const int i = static_cast<int>(view.window.IndexOf(10, 5));
  EXPECT_FLOAT_EQ(truth.planes(i, 0), 10.0F / 255);
  EXPECT_FLOAT_EQ(truth.planes(i, 2), 30.0F / 255);
  EXPECT_EQ(truth.planes(i, 3), 1);
  EXPECT_EQ(truth.planes(i - 1, 0), 0);
  EXPECT_TRUE(CutTrainingView(
                  image, [](int, int) { return false; }, {0, 0, 30, 20}, {}, 2)
                  .window.empty());
}

GaussianBody RandomBody() {
  std::mt19937 numbers(3);
  const auto uniform = [&] { return static_cast<float>(numbers() / 2147483648.0 - 1); };
  GaussianBody body;
  body.Resize(7);
  for (int i = 0; i < body.size(); ++i) {
    for (int c = 0; c < GaussianBody::kNumParameters; ++c) body.parameters(i, c) = 2 * uniform();
    body.anchors[i].corrective_factor = std::abs(uniform());
    body.kinds[i] = static_cast<GaussianKind>(i % 3);
  }
  return body;
}

double Cost(const GaussianBody& body, const GaussianCost& cost) {
  double sum = 0;
  for (int i = 0; i < body.size(); ++i) {
    const double opacity = 1 / (1 + std::exp(-double(body.parameters(i, GaussianBody::kOpacityLogit))));
    if (body.kinds[i] != GaussianKind::kCloth) {
      sum += (cost.by_opacity + cost.by_distance * (1 - body.anchors[i].corrective_factor)) * opacity;
    }
    for (int c = 0; c < 3; ++c) sum += cost.by_scale * std::exp(body.parameters(i, GaussianBody::kLogScale + c));
  }
  return sum / body.size();
}

TEST(GaussianCost, IsTheFormulaAndItsDerivative) {
  const GaussianBody body = RandomBody();
  const GaussianCost cost{.by_opacity = 0.5, .by_scale = 0.25, .by_distance = 2};
  FloatColumns gradient(GaussianBody::kNumParameters, body.size());
  gradient.Fill(0);
  EXPECT_NEAR(AddGaussianCost(body, cost, &gradient), Cost(body, cost), 1e-6);
  for (int i = 0; i < body.size(); ++i) {
    for (int c = 0; c < GaussianBody::kNumParameters; ++c) {
      GaussianBody above = body, below = body;
      constexpr float kStep = 1e-2F;
      above.parameters(i, c) += kStep, below.parameters(i, c) -= kStep;
      const double step = double(above.parameters(i, c)) - below.parameters(i, c);
      EXPECT_NEAR(gradient(i, c), (Cost(above, cost) - Cost(below, cost)) / step, 2e-5) << i << " " << c;
    }
  }
}

TEST(GaussianCost, OffTheSkinCostsMore) {
  GaussianBody body = RandomBody();
  for (SkinAnchor& anchor : body.anchors) anchor.corrective_factor = 1;
  FloatColumns gradient(GaussianBody::kNumParameters, body.size());
  const double on_the_skin = AddGaussianCost(body, {}, &gradient);
  body.anchors[2].corrective_factor = 0;
  EXPECT_EQ(AddGaussianCost(body, {}, &gradient), on_the_skin) << "of cloth";
  body.anchors[1].corrective_factor = 0;
  EXPECT_GT(AddGaussianCost(body, {}, &gradient), on_the_skin);
  EXPECT_EQ(AddGaussianCost(body, {.by_distance = 0}, &gradient), on_the_skin);
}

TEST(GaussianCost, RefusesATableOfAnotherSize) {
  FloatColumns gradient(GaussianBody::kNumParameters, 3);
  EXPECT_THROW(AddGaussianCost(RandomBody(), {}, &gradient), std::invalid_argument);
}

}  // namespace

}  // namespace bodyloom::avatar_trainer_test
