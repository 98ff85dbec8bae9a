// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/part_labels/part_label_term.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <functional>
#include <memory>

#include "geometry/math/rotation.h"
#include "tests/support/frame_scene.h"
#include "tests/tracking/jet_twin.h"
#include "tracking/problem/robust.h"
#include "tracking/terms/part_labels/part_labels.h"

namespace bodyloom::part_label_term_test {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kWidth = 320, kHeight = 360;
constexpr double kPersonPx = 170;

struct Scene : SharedValues {
  BodyModel body{ToyBodyData()};
  FrameLayout layout;
  FrameState truth;
  std::shared_ptr<const Skinner> skinner = std::make_shared<const Skinner>(body);
  PartLabelSequence labels;
};

/// The toy body in front of the camera and the part map of what the camera sees of it.
std::unique_ptr<Scene> MakeScene(const Vector3d& translation = Vector3d(0, 0, 3)) {
  auto scene = std::make_unique<Scene>();
  scene->layout = FrameLayout::Make(scene->body, CameraKnowledge::kKnown, MakePinhole(kWidth, kHeight, 310),
                                    AllJoints(scene->body), scene->body.num_betas());
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

std::unique_ptr<PartLabelMatches> MakeTerm(const Scene& scene, const FrameState& state,
                                           const PartLabelOptions& options = {}, double kernel = 8) {
  auto term = std::make_unique<PartLabelMatches>(scene.labels, 0, scene.skinner, options);
  VisibleSurface surface;
  term->Correspond(scene.layout, state, scene.betas, scene.log_focal, kPersonPx, kernel, 1, &surface);
  return term;
}

int NumRows(const PartLabelMatches& term) { return term.num_rows(true) + term.num_rows(false); }

FrameSystem Evaluate(const Scene& scene, const PartLabelSource& term, const FrameState& state,
                     FrameResiduals* residuals = nullptr) {
  FrameData data;
  data.Get<SilhouetteTerm>().matches = &term;
  data.Get<PartLabelTerm>().matches = &term;
  FrameEvaluator evaluator;
  FrameSystem system;
  evaluator.Evaluate(scene.layout, data, state, scene, true, &system, residuals);
  return system;
}

TEST(PartLabelTerm, CostsLittleWhereItsLabelsComeFrom) {
  const auto scene = MakeScene();
  const auto term = MakeTerm(*scene, scene->truth);
  EXPECT_GT(term->num_person_pixels(), 4000);
  EXPECT_GT(term->contour().size(), 200U);
  EXPECT_GT(term->targets().size(), 200U);
  EXPECT_EQ(term->silhouette_unmatched(), 0);
  FrameResiduals residuals;
  const double at_truth = Evaluate(*scene, *term, scene->truth, &residuals).cost;
  double largest = 0;
  for (const double px : residuals["silhouette"].px) largest = std::max(largest, px);
  EXPECT_LT(largest, 1.6);
  ASSERT_GT(residuals["part labels"].px.size(), 50U);
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
  EXPECT_GT(term->contour().size(), 150U);
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

using twin::Jet;

/// Projections of the term's points as functions of parameter `column`.
std::vector<Eigen::Matrix<Jet, 2, 1>> TwinPixels(const Scene& scene, const PartLabelMatches& term,
                                                 const FrameState& state, int column) {
  const twin::SeededFrame frame =
      twin::SeedFrame(scene.body, scene.layout, state, scene.betas, scene.log_focal, column);
  std::vector<int> corners;
  std::vector<Vector3d> barycentrics;
  const auto add = [&](int face, const Vector3d& barycentric) {
    for (int c = 0; c < 3; ++c) corners.push_back(scene.body.data().faces(face, c));
    barycentrics.push_back(barycentric);
  };
  for (const PartLabelMatches::Target& target : term.targets()) add(target.face, target.barycentric);
  for (const PartLabelMatches::ContourPoint& point : term.contour()) add(point.face, point.barycentric);
  const auto vertices = frame.body.Vertices(corners);
  std::vector<Eigen::Matrix<Jet, 2, 1>> pixels;
  for (size_t i = 0; i < barycentrics.size(); ++i) {
    twin::Vector3<Jet> x = twin::Vector3<Jet>::Zero();
    for (size_t c = 0; c < 3; ++c) x += vertices[3 * i + c] * Jet(barycentrics[i][static_cast<int>(c)]);
    pixels.push_back(frame.Project(x));
  }
  return pixels;
}

/// The term from its definition with the correspondences held, which is what a round does. The distance field's own
/// derivative is checked where the field is (distance_field_test.cc). Returns the number of rows.
int CheckAgainstTwin(const Scene& scene, const PartLabelMatches& term, const FrameState& state) {
  const size_t num_targets = term.targets().size(), n = num_targets + term.contour().size();
  MatrixXd J = MatrixXd::Zero(static_cast<int>(2 * n), scene.layout.num_columns);
  VectorXd r = VectorXd::Zero(static_cast<int>(2 * n));
  double cost = 0;
  for (int column = 0; column < scene.layout.num_columns; ++column) {
    const auto pixels = TwinPixels(scene, term, state, column);
    cost = 0;
    for (size_t i = 0; i < n; ++i) {
      Eigen::Matrix<Jet, 2, 1> raw(Jet(0.0), Jet(0.0));
      double weight;
      if (i < num_targets) {
        const PartLabelMatches::Target& target = term.targets()[i];
        const Vector2d off(pixels[i][0].a - target.pixel.x(), pixels[i][1].a - target.pixel.y());
        const bool is_inside = target.outward.dot(off) < 0;
        raw = (is_inside ? target.whitening_inside : target.whitening).cast<Jet>() *
              (pixels[i] - target.pixel.cast<Jet>());
        weight = target.weight;
      } else {
        const PartLabelMatches::ContourPoint& point = term.contour()[i - num_targets];
        Eigen::RowVector2d slope;
        const double distance = point.field->Evaluate(Eigen::Vector2d(pixels[i][0].a, pixels[i][1].a), &slope);
        raw[0] = Jet(distance - point.offset_px);
        raw[0].v[0] = slope[0] * pixels[i][0].v[0] + slope[1] * pixels[i][1].v[0];
        raw[0] *= Jet(raw[0].a < 0 ? point.inverse_sigma_inside : point.inverse_sigma);
        weight = point.weight;
      }
      const RobustValue robust = GemanMcClure(raw[0].a * raw[0].a + raw[1].a * raw[1].a, term.kernel());
      cost += 0.5 * weight * robust.rho;
      for (int c = 0; c < 2; ++c) {
        const int row = static_cast<int>(2 * i) + c;
        r[row] = std::sqrt(weight * robust.weight) * raw[c].a;
        J(row, column) = std::sqrt(weight * robust.weight) * raw[c].v[0];
      }
    }
  }
  ExpectMatchesTwin(Evaluate(scene, term, state), cost, J, r);
  return static_cast<int>(2 * n);
}

TEST(PartLabelTerm, MatchesAutomaticDerivativesInEveryCamera) {
  for (const CameraKnowledge knowledge :
       {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    const auto scene = MakeScene();
    Camera camera = scene->layout.camera;
    if (knowledge == CameraKnowledge::kKnown) camera.distortion = {-0.12, 0.03, 0.001, -0.002, 0.004, 0.01, 0, 0};
    scene->layout = FrameLayout::Make(scene->body, knowledge, camera, AllJoints(scene->body), scene->body.num_betas());
    scene->log_focal = std::log(320.0);
    FrameState state = scene->truth;
    state.rotations[1] = RotationFromAxisAngle(Vector3d(0.1, 0.2, 0.3));
    state.rotations[16] = RotationFromAxisAngle(Vector3d(0.1, 0.2, -0.4));
    state.rotations[18] = RotationFromAxisAngle(Vector3d(0.3, -0.2, 0.5));
    state.translation =
        knowledge == CameraKnowledge::kWeak ? Vector3d(std::log(100.0), 0.05, -0.04) : Vector3d(0.05, -0.04, 3.1);
    const auto term = MakeTerm(*scene, state);
    // Away from where the correspondences were made.
    state.rotations[0] = state.rotations[0] * RotationFromAxisAngle(Vector3d(0.02, 0.01, -0.03));
    EXPECT_GT(CheckAgainstTwin(*scene, *term, state), 600) << static_cast<int>(knowledge);
  }
}

TEST(PartLabelTerm, AMaskMatchesAutomaticDerivativesOnBothSides) {
  const auto scene = MakeScene();
  scene->labels.AsMask();
  FrameState state = scene->truth;
  state.translation += Vector3d(0.05, -0.04, 0.1);
  const auto term = MakeTerm(*scene, state);
  EXPECT_GT(CheckAgainstTwin(*scene, *term, state), 300);
}

/// A mask that reaches `grown_px` pixels beyond the body on all sides; negative: that stays so far inside.
std::unique_ptr<Scene> MakeMaskScene(int grown_px) {
  auto scene = MakeScene();
  LabelImage image = scene->labels.frames[0].Unpacked();
  const std::vector<uint8_t> body = image.labels;
  const int reach = std::abs(grown_px);
  for (int y = reach; y < kHeight - reach; ++y) {
    for (int x = reach; x < kWidth - reach; ++x) {
      int seen = 0;
      for (int v = y - reach; v <= y + reach; ++v) {
        for (int u = x - reach; u <= x + reach; ++u) seen += body[v * kWidth + u] > 0;
      }
      const int needed = grown_px >= 0 ? 1 : (2 * reach + 1) * (2 * reach + 1);
      image.labels[y * kWidth + x] = seen >= needed;
    }
  }
  scene->labels.frames[0] = image;
  scene->labels.AsMask();
  return scene;
}

TEST(PartLabelTerm, ClothesBeyondTheBodyCostLittle) {
  PartLabelOptions loose, tight;
  loose.clothes_sigma_share = 3 * loose.sigma_share;
  tight.clothes_sigma_share = 0;
  const auto dressed = MakeMaskScene(4), narrow = MakeMaskScene(-2);
  const auto cost = [&](const Scene& scene, const PartLabelOptions& options) {
    return Evaluate(scene, *MakeTerm(scene, scene.truth, options, 100), scene.truth).cost;
  };
  // Quadratic within so wide a kernel: three times σ costs a ninth. Part of each residual is along the boundary.
  EXPECT_NEAR(cost(*dressed, loose) / cost(*dressed, tight), 1.0 / 9, 0.06);
  // A body that reaches beyond the mask costs what it did.
  EXPECT_GT(cost(*narrow, tight), 1);
  EXPECT_NEAR(cost(*narrow, loose) / cost(*narrow, tight), 1, 0.02);
}

TEST(PartLabelTerm, ClothesAreAMasksAlone) {
  const auto scene = MakeScene();
  FrameState moved = scene->truth;
  moved.translation.x() += 0.1;
  PartLabelOptions loose;
  loose.clothes_sigma_share = 0.05;
  const double of_labels = Evaluate(*scene, *MakeTerm(*scene, moved), moved).cost;
  EXPECT_EQ(Evaluate(*scene, *MakeTerm(*scene, moved, loose), moved).cost, of_labels);
  scene->labels.AsMask();
  EXPECT_LT(Evaluate(*scene, *MakeTerm(*scene, moved, loose), moved).cost,
            0.95 * Evaluate(*scene, *MakeTerm(*scene, moved, {.clothes_sigma_share = 0}), moved).cost);
}

/// Gauss–Newton steps with rounds; returns the largest distance of a joint from the truth, metres.
double Fit(const Scene& scene, FrameState state, const PartLabelOptions& options, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const auto term = MakeTerm(scene, state, options, round + 1 < rounds ? 16 : 4);
    for (int i = 0; i < 4; ++i) {
      const FrameSystem system = Evaluate(scene, *term, state);
      Eigen::MatrixXd H = system.H.selfadjointView<Eigen::Lower>();
      H.diagonal().array() += 30;  // damping, for what a contour does not show
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
  EXPECT_GT(residuals["silhouette"].px.size(), 0U);
  EXPECT_EQ(residuals["part labels"].px.size(), 0U);
  EXPECT_EQ(silhouette->Field(2), nullptr);
  options.silhouette_weight = 0;
  EXPECT_EQ(NumRows(*MakeTerm(*scene, scene->truth, options)), 0);
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
  const auto term = MakeTerm(*scene, moved, {.clothes_sigma_share = 0});
  const FrameSystem system = Evaluate(*scene, *term, moved);
  EXPECT_EQ(term->num_person_pixels(), of_parts->num_person_pixels());
  EXPECT_GT(system.cost, 1);
  EXPECT_EQ(system.cost, expected.cost);
  EXPECT_EQ(system.gradient, expected.gradient);
  EXPECT_EQ(term->Field(1), nullptr);
}

TEST(PartLabelTerm, MatchesThatWereForgottenAreFoundAgain) {
  const auto scene = MakeScene();
  scene->labels.AsMask();
  FrameState moved = scene->truth;
  moved.translation.x() += 0.1;
  const FrameSystem expected = Evaluate(*scene, *MakeTerm(*scene, scene->truth), moved);
  KeptMatches kept(1);
  const PartLabelOptions options;
  std::vector<std::unique_ptr<LabelledFrame>> frames;
  for (int i = 0; i < 2; ++i) {
    frames.push_back(std::make_unique<LabelledFrame>(scene->labels, 0, scene->skinner, options, &kept));
    frames.back()->StartRound(scene->layout, {scene->truth, scene->betas, scene->log_focal, kPersonPx, 8, 1}, true);
    EXPECT_GE(frames.back()->num_rows(true), MakeTerm(*scene, scene->truth)->num_rows(true));
  }
  const auto first = frames[0]->Get(scene->layout);
  EXPECT_EQ(frames[0]->Get(scene->layout), first);
  for (const int i : {0, 1, 0, 0, 1}) {
    const FrameSystem system = Evaluate(*scene, *frames[i], moved);
    EXPECT_EQ(system.cost, expected.cost);
    EXPECT_EQ(system.gradient, expected.gradient);
    EXPECT_EQ(system.H, expected.H);
  }
  EXPECT_NE(frames[0]->Get(scene->layout), first);
  EXPECT_EQ(frames[0]->num_rows(true), MakeTerm(*scene, scene->truth)->num_rows(true));
  EXPECT_EQ(frames[0]->num_person_pixels(), first->num_person_pixels());
}

TEST(PartLabelTerm, MergedPartsHaveNoBoundaryBetweenThem) {
  const auto scene = MakeScene();
  scene->labels.Merge(1, 2);
  EXPECT_EQ(scene->labels.part_of_label[1], 2);
  EXPECT_EQ(scene->labels.part_of_chart[1], 2);
  EXPECT_EQ(MakeTerm(*scene, scene->truth)->Field(1), nullptr);
  EXPECT_NE(MakeTerm(*scene, scene->truth)->Field(2), nullptr);
}

TEST(PartLabelTerm, NothingSeenAsksForNothing) {
  const auto scene = MakeScene();
  LabelImage image = scene->labels.frames[0].Unpacked();
  for (const uint8_t label : {PartLabelSequence::kBackground, PartLabelSequence::kUnknown}) {
    std::fill(image.labels.begin(), image.labels.end(), label);
    scene->labels.frames[0] = image;
    const auto term = MakeTerm(*scene, scene->truth);
    EXPECT_EQ(term->num_person_pixels(), 0);
    EXPECT_EQ(NumRows(*term), 0);
    EXPECT_EQ(Evaluate(*scene, *term, scene->truth).cost, 0);
  }
  scene->labels.frames[0] = LabelImage();
  EXPECT_EQ(NumRows(*MakeTerm(*scene, scene->truth)), 0);
}

TEST(PartLabelTerm, UnknownPixelsHaveNoBoundary) {
  // The right half of the person is unknown: no boundary there, and the silhouette's points there have no residual.
  const auto scene = MakeScene();
  LabelImage image = scene->labels.frames[0].Unpacked();
  for (int y = 0; y < kHeight; ++y) {
    for (int x = kWidth / 2; x < kWidth; ++x) image.labels[y * kWidth + x] = PartLabelSequence::kUnknown;
  }
  scene->labels.frames[0] = image;
  const auto term = MakeTerm(*scene, scene->truth);
  ASSERT_GT(NumRows(*term), 100);
  for (const PartLabelMatches::Target& target : term->targets()) EXPECT_LT(target.pixel.x(), kWidth / 2 + 1);
  const FrameSystem system = Evaluate(*scene, *term, scene->truth);
  FrameState moved = scene->truth;
  moved.translation.x() += 0.05;
  EXPECT_LT(system.cost, 0.1 * Evaluate(*scene, *MakeTerm(*scene, moved), moved).cost);
}

TEST(PartLabelTerm, SpecksAreLeftOut) {
  const auto scene = MakeScene();
  const auto clean = MakeTerm(*scene, scene->truth);
  LabelImage image = scene->labels.frames[0].Unpacked();
  for (int y = 5; y < 15; ++y) {
    for (int x = 5; x < 15; ++x) image.labels[y * kWidth + x] = 3;  // far from the person
  }
  scene->labels.frames[0] = image;
  const PartMap map = MakePartMap(scene->labels, 0, PartLabelMatches::kSpeckShare);
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
  scene->labels.frames[0] = image;
  const PartMap with_hole = MakePartMap(scene->labels, 0, PartLabelMatches::kSpeckShare);
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
  for (const double px : residuals["silhouette"].px) largest = std::max(largest, px);
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
  EXPECT_EQ(NumRows(*MakeTerm(*scene, broken)), 0);
}

}  // namespace
}  // namespace bodyloom::part_label_term_test
