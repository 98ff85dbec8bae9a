// SPDX-License-Identifier: Apache-2.0
#include "tracking/residuals/part_label_term.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <functional>
#include <memory>

#include "geometry/rotation.h"
#include "tests/support/toy_body.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kWidth = 320, kHeight = 360;
constexpr double kPersonPx = 170;

struct Scene {
  BodyModel body{ToyBodyData()};
  FrameLayout layout;
  FrameState truth;
  VectorXd betas;
  std::shared_ptr<const Skinner> skinner = std::make_shared<const Skinner>(body);
  PartLabelSequence labels;
};

/// The toy body in front of the camera and the part map of what the camera sees of it.
std::unique_ptr<Scene> MakeScene(const Vector3d& translation = Vector3d(0, 0, 3)) {
  auto scene = std::make_unique<Scene>();
  std::vector<int> joints;
  for (int j = 0; j < scene->body.num_joints(); ++j) joints.push_back(j);
  scene->layout = FrameLayout::Make(scene->body, CameraKnowledge::kKnown, MakePinhole(kWidth, kHeight, 310), joints,
                                    scene->body.num_betas());
  scene->betas = VectorXd::Zero(scene->body.num_betas());
  scene->truth.rotations.assign(scene->body.num_joints(), Matrix3d::Identity());
  scene->truth.rotations[0] = RotationFromAxisAngle(Vector3d(M_PI, 0, 0));
  scene->truth.rotations[16] = RotationFromAxisAngle(Vector3d(0, 0, -0.8));  // arms lowered
  scene->truth.rotations[17] = RotationFromAxisAngle(Vector3d(0, 0, 0.6));
  scene->truth.translation = translation;
  VisibleSurface surface;
  EXPECT_TRUE(surface.Render(scene->skinner, scene->body, scene->betas, scene->truth.rotations,
                             scene->truth.translation, scene->layout.camera));
  LabelImage image{0, 0, kWidth, kHeight, {}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int face = surface.buffer().FaceAt(x, y);
      image.labels.push_back(face < 0 ? 0 : scene->body.data().face_part[face]);
    }
  }
  scene->labels.frames = {image};
  scene->labels.timestamps = {0};
  scene->labels.image_width = kWidth;
  scene->labels.image_height = kHeight;
  return scene;
}

std::unique_ptr<PartLabelTerm> MakeTerm(const Scene& scene, const FrameState& state,
                                        const PartLabelOptions& options = {}, double kernel = 8) {
  auto term = std::make_unique<PartLabelTerm>(scene.labels, 0, scene.skinner, options);
  VisibleSurface surface;
  term->Correspond(scene.layout, state, scene.betas, 0, kPersonPx, kernel, &surface);
  return term;
}

FrameSystem Evaluate(const Scene& scene, const PartLabelTerm& term, const FrameState& state,
                     FrameResiduals* residuals = nullptr) {
  FrameData data;
  data.part_labels = &term;
  FrameEvaluator evaluator;
  FrameSystem system;
  evaluator.Evaluate(scene.layout, data, state, scene.betas, 0, true, &system, residuals);
  return system;
}

TEST(PartLabelTerm, CostsLittleWhereItsLabelsComeFrom) {
  const auto scene = MakeScene();
  const auto term = MakeTerm(*scene, scene->truth);
  EXPECT_GT(term->num_person_pixels(), 4000);
  EXPECT_GT(term->outline().size(), 200U);
  EXPECT_GT(term->targets().size(), 200U);
  EXPECT_EQ(term->silhouette_unmatched(), 0);
  FrameResiduals residuals;
  const double at_truth = Evaluate(*scene, *term, scene->truth, &residuals).cost;
  double largest = 0;
  for (const double px : residuals.silhouette_px) largest = std::max(largest, px);
  EXPECT_LT(largest, 1.6);
  ASSERT_GT(residuals.part_px.size(), 50U);
  FrameState moved = scene->truth;
  moved.translation.x() += 0.1;
  EXPECT_GT(Evaluate(*scene, *MakeTerm(*scene, moved), moved).cost, 100 * at_truth);
  EXPECT_GT(Evaluate(*scene, *term, moved).cost, 50 * at_truth);
}

TEST(PartLabelTerm, DerivativesMatchDifferences) {
  const auto scene = MakeScene();
  FrameState state = scene->truth;
  state.rotations[1] = RotationFromAxisAngle(Vector3d(0.1, 0.2, 0.3));
  state.rotations[16] = RotationFromAxisAngle(Vector3d(0.1, 0.2, -0.4));
  state.rotations[18] = RotationFromAxisAngle(Vector3d(0.3, -0.2, 0.5));
  state.translation += Vector3d(0.05, -0.04, 0.1);
  const auto term = MakeTerm(*scene, state);
  EXPECT_GT(term->targets().size(), 150U);
  EXPECT_GT(term->outline().size(), 150U);
  // Away from where the correspondences were made.
  state.rotations[0] = state.rotations[0] * RotationFromAxisAngle(Vector3d(0.02, 0.01, -0.03));
  const FrameSystem system = Evaluate(*scene, *term, state);
  constexpr double kStep = 1e-6;
  int moving = 0;
  const auto check = [&](int column, const std::function<void(double, FrameState*, VectorXd*)>& move) {
    double cost[2];
    const VectorXd betas = scene->betas;
    for (int side = 0; side < 2; ++side) {
      FrameState moved = state;
      move(side == 0 ? kStep : -kStep, &moved, &scene->betas);
      cost[side] = Evaluate(*scene, *term, moved).cost;
      scene->betas = betas;
    }
    const double numeric = (cost[0] - cost[1]) / (2 * kStep);
    EXPECT_NEAR(system.gradient[column], numeric, 1e-6 * system.gradient.norm()) << column;
    moving += std::abs(numeric) > 1e-3;
  };
  for (int j = 0; j < scene->body.num_joints(); ++j) {
    for (int c = 0; c < 3; ++c) {
      check(3 * j + c, [&](double h, FrameState* s, VectorXd*) {
        s->rotations[j] = s->rotations[j] * RotationFromAxisAngle(h * Vector3d::Unit(c));
      });
    }
  }
  for (int c = 0; c < 3; ++c) {
    check(scene->layout.translation_column + c, [&](double h, FrameState* s, VectorXd*) { s->translation[c] += h; });
  }
  for (int b = 0; b < scene->layout.num_betas; ++b) {
    check(scene->layout.beta_column + b, [&](double h, FrameState*, VectorXd* betas) { (*betas)[b] += h; });
  }
  EXPECT_GT(moving, 60);
}

/// Gauss–Newton steps with rounds; returns the largest distance of a joint from the truth, metres.
double Fit(const Scene& scene, FrameState state, const PartLabelOptions& options, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const auto term = MakeTerm(scene, state, options, round + 1 < rounds ? 16 : 4);
    for (int i = 0; i < 4; ++i) {
      const FrameSystem system = Evaluate(scene, *term, state);
      Eigen::MatrixXd H = system.H.selfadjointView<Eigen::Lower>();
      H.diagonal().array() += 30;  // damping, for what an outline does not show
      const int pose_columns = scene.layout.num_frame_columns();
      const VectorXd step =
          -H.topLeftCorner(pose_columns, pose_columns).ldlt().solve(system.gradient.head(pose_columns));
      for (int j = 0; j < scene.body.num_joints(); ++j) {
        state.rotations[j] = state.rotations[j] * RotationFromAxisAngle(Vector3d(step.segment<3>(3 * j)));
      }
      state.translation += step.tail<3>();
    }
  }
  Kinematics fitted, truth;
  fitted.Set(scene.body, scene.betas, state.rotations, state.translation, false);
  truth.Set(scene.body, scene.betas, scene.truth.rotations, scene.truth.translation, false);
  double largest = 0;
  for (int j = 0; j < scene.body.num_joints(); ++j) {
    const Vector3d off = fitted.p[j] - truth.p[j];
    largest = std::max(largest, off.head<2>().norm());  // one camera hardly sees depth
  }
  return largest;
}

TEST(PartLabelTerm, PullsAMovedBodyBack) {
  const auto scene = MakeScene();
  FrameState moved = scene->truth;
  moved.translation += Vector3d(0.12, -0.06, 0.1);
  moved.rotations[16] = RotationFromAxisAngle(Vector3d(0, 0, -0.3));
  moved.rotations[1] = RotationFromAxisAngle(Vector3d(0, 0, 0.15));
  const double before = Fit(*scene, moved, {}, 0), both = Fit(*scene, moved, {}, 8);
  EXPECT_GT(before, 0.2);
  EXPECT_LT(both, 0.03);
  PartLabelOptions only_parts, only_silhouette;
  only_parts.silhouette_weight = 0;
  only_silhouette.part_weight = 0;
  EXPECT_LT(Fit(*scene, moved, only_parts, 8), 0.05);
  EXPECT_LT(Fit(*scene, moved, only_silhouette, 8), 0.6 * before);
}

TEST(PartLabelTerm, APartFarFromItsPixelsIsDrawnToThem) {
  const auto scene = MakeScene();
  FrameState moved = scene->truth;
  moved.rotations[16] = RotationFromAxisAngle(Vector3d(0, 0, 0.7));  // the left arm up instead of down
  EXPECT_GT(Fit(*scene, moved, {}, 0), 0.5);
  EXPECT_LT(Fit(*scene, moved, {}, 12), 0.1);
}

TEST(PartLabelTerm, ATermThatIsOffHasNoRows) {
  const auto scene = MakeScene();
  PartLabelOptions options;
  options.part_weight = 0;
  FrameResiduals residuals;
  const auto silhouette = MakeTerm(*scene, scene->truth, options);
  (void)Evaluate(*scene, *silhouette, scene->truth, &residuals);
  EXPECT_GT(residuals.silhouette_px.size(), 0U);
  EXPECT_EQ(residuals.part_px.size(), 0U);
  EXPECT_EQ(silhouette->Field(2), nullptr);
  options.silhouette_weight = 0;
  EXPECT_EQ(MakeTerm(*scene, scene->truth, options)->num_rows(), 0);
}

TEST(PartLabelTerm, AMaskIsASilhouetteWithoutParts) {
  const auto scene = MakeScene();
  FrameState moved = scene->truth;
  moved.translation.x() += 0.1;
  PartLabelOptions silhouette;
  silhouette.part_weight = 0;
  const auto of_parts = MakeTerm(*scene, moved, silhouette);
  const FrameSystem expected = Evaluate(*scene, *of_parts, moved);
  scene->labels.AsMask();
  const auto term = MakeTerm(*scene, moved);
  const FrameSystem system = Evaluate(*scene, *term, moved);
  EXPECT_EQ(term->num_person_pixels(), of_parts->num_person_pixels());
  EXPECT_GT(system.cost, 1);
  EXPECT_EQ(system.cost, expected.cost);
  EXPECT_EQ(system.gradient, expected.gradient);
  EXPECT_EQ(term->Field(1), nullptr);
}

TEST(PartLabelTerm, MergedPartsHaveNoBorderBetweenThem) {
  const auto scene = MakeScene();
  scene->labels.frames[0].labels[0] = 0;
  scene->labels.Merge(1, 2);
  EXPECT_EQ(scene->labels.part_of_label[1], 2);
  EXPECT_EQ(scene->labels.part_of_chart[1], 2);
  EXPECT_EQ(MakeTerm(*scene, scene->truth)->Field(1), nullptr);
  EXPECT_NE(MakeTerm(*scene, scene->truth)->Field(2), nullptr);
}

TEST(PartLabelTerm, NothingSeenAsksForNothing) {
  const auto scene = MakeScene();
  LabelImage& image = scene->labels.frames[0];
  const std::vector<uint8_t> seen = image.labels;
  for (const uint8_t label : {PartLabelSequence::kBackground, PartLabelSequence::kUnknown}) {
    image.labels.assign(seen.size(), label);
    const auto term = MakeTerm(*scene, scene->truth);
    EXPECT_EQ(term->num_person_pixels(), 0);
    EXPECT_EQ(term->num_rows(), 0);
    EXPECT_EQ(Evaluate(*scene, *term, scene->truth).cost, 0);
  }
  scene->labels.frames[0] = LabelImage();
  EXPECT_EQ(MakeTerm(*scene, scene->truth)->num_rows(), 0);
}

TEST(PartLabelTerm, UnknownPixelsHaveNoBorder) {
  // The right half of the person is unknown: no border there, and the silhouette's points there have no residual.
  const auto scene = MakeScene();
  LabelImage& image = scene->labels.frames[0];
  for (int y = 0; y < kHeight; ++y) {
    for (int x = kWidth / 2; x < kWidth; ++x) image.labels[y * kWidth + x] = PartLabelSequence::kUnknown;
  }
  const auto term = MakeTerm(*scene, scene->truth);
  ASSERT_GT(term->num_rows(), 100);
  for (const PartLabelTerm::Target& target : term->targets()) EXPECT_LT(target.pixel.x(), kWidth / 2 + 1);
  const FrameSystem system = Evaluate(*scene, *term, scene->truth);
  FrameState moved = scene->truth;
  moved.translation.x() += 0.05;
  EXPECT_LT(system.cost, 0.1 * Evaluate(*scene, *MakeTerm(*scene, moved), moved).cost);
}

TEST(PartLabelTerm, SpecksAreLeftOut) {
  const auto scene = MakeScene();
  const auto clean = MakeTerm(*scene, scene->truth);
  LabelImage& image = scene->labels.frames[0];
  for (int y = 5; y < 15; ++y) {
    for (int x = 5; x < 15; ++x) image.labels[y * kWidth + x] = 3;  // far from the person
  }
  const PartMap map = MakePartMap(scene->labels, 0, PartLabelTerm::kSpeckShare);
  EXPECT_EQ(map.At(10, 10), PartLabelSequence::kUnknown);
  EXPECT_EQ(map.At(20, 10), PartLabelSequence::kBackground);
  EXPECT_EQ(map.At(-1, 10), PartLabelSequence::kUnknown);
  const auto term = MakeTerm(*scene, scene->truth);
  EXPECT_EQ(term->num_person_pixels(), clean->num_person_pixels());
  EXPECT_EQ(Evaluate(*scene, *term, scene->truth).cost, Evaluate(*scene, *clean, scene->truth).cost);
  // A small piece of a part inside the person: only that piece.
  const int centre = kHeight / 2 * kWidth + kWidth / 2;
  const uint8_t around = image.labels[centre];
  image.labels[centre] = around == 3 ? 4 : 3;
  const PartMap with_hole = MakePartMap(scene->labels, 0, PartLabelTerm::kSpeckShare);
  EXPECT_EQ(with_hole.At(kWidth / 2, kHeight / 2), PartLabelSequence::kUnknown);
  EXPECT_EQ(with_hole.At(kWidth / 2 + 1, kHeight / 2), map.At(kWidth / 2 + 1, kHeight / 2));
}

TEST(PartLabelTerm, APersonCutByTheImageIsNotPulledInside) {
  const auto scene = MakeScene(Vector3d(1.55, 0, 3));  // half of the body is beyond the right edge
  const auto term = MakeTerm(*scene, scene->truth);
  ASSERT_GT(term->num_person_pixels(), 1000);
  FrameResiduals residuals;
  const FrameSystem system = Evaluate(*scene, *term, scene->truth, &residuals);
  double largest = 0;
  for (const double px : residuals.silhouette_px) largest = std::max(largest, px);
  EXPECT_LT(largest, 2.5);
  EXPECT_LT(system.cost, 3);
}

TEST(PartLabelTerm, ABodyOutOfTheImageOrBehindTheCameraStaysFinite) {
  const auto scene = MakeScene();
  for (const Vector3d& translation : {Vector3d(30, 0, 3), Vector3d(0, 0, -3), Vector3d(0, 0, 0)}) {
    FrameState lost = scene->truth;
    lost.translation = translation;
    const auto term = MakeTerm(*scene, lost);
    const FrameSystem system = Evaluate(*scene, *term, lost);
    EXPECT_TRUE(std::isfinite(system.cost));
    EXPECT_TRUE(system.gradient.allFinite());
    // Correspondences of a good state evaluated at the lost one.
    const FrameSystem jump = Evaluate(*scene, *MakeTerm(*scene, scene->truth), lost);
    EXPECT_TRUE(std::isfinite(jump.cost));
    EXPECT_TRUE(jump.gradient.allFinite());
  }
  FrameState broken = scene->truth;
  broken.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(MakeTerm(*scene, broken)->num_rows(), 0);
}

}  // namespace
}  // namespace bodyloom
