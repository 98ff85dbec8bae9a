// SPDX-License-Identifier: Apache-2.0
// Every term of the frame cost against automatic differentiation of an independent twin, to 1e-9 relative.
#include "tracking/problem/frame_cost.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "geometry/math/rotation.h"
#include "tests/support/frame_scene.h"
#include "tests/tracking/jet_twin.h"
#include "tracking/problem/panel_simd.h"
#include "tracking/problem/robust.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/initialiser.h"
#include "tracking/terms/joint_limits.h"
#include "tracking/terms/landmarks.h"
#include "tracking/terms/pose_prior/pose_prior.h"
#include "tracking/terms/straight_knees.h"
#include "tracking/terms/upright.h"

namespace bodyloom::frame_cost_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using twin::Jet;

constexpr double kRelative = 1e-9;

struct Scene : FrameScene {
  using FrameScene::FrameScene;
  std::vector<CompiledPoint> compiled;
  std::vector<int> landmark_ids;
};

/// Random pose of the given size in front of the camera, with 17 landmarks and 40 dense keypoints seen with noise.
std::unique_ptr<Scene> MakeScene(CameraKnowledge knowledge, double pose_size, uint64_t seed,
                                 std::vector<int> active = {}, const BodyModelData& body = ToyBodyData()) {
  auto scene = std::make_unique<Scene>(body);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  if (active.empty()) active = AllJoints(scene->body);
  PlaceCamera(knowledge, MakePinhole(1280, 720, 1000), 1100, active, &random, scene.get());
  PoseAtRandom(knowledge, pose_size, &random, scene.get());
  for (const std::string& name : CocoNames()) {
    const int id = scene->body.FindLandmark(name);
    scene->landmark_ids.push_back(id);
    const Landmark& landmark = scene->body.data().landmarks[id];
    scene->compiled.push_back(CompilePoint(scene->body, landmark.vertices, landmark.weights, scene->body.num_betas()));
  }
  for (const CompiledPoint& point : scene->compiled) {
    scene->data.Get<LandmarkTerm>().seen.push_back(
        {&point, {640 + 200 * normal(random), 360 + 200 * normal(random)}, 8});
  }
  std::uniform_int_distribution<int> face(0, scene->body.num_faces() - 1);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  for (int i = 0; i < 40; ++i) {
    DenseKeypoint point;
    point.face = face(random);
    point.barycentric = Eigen::Vector3f{unit(random), unit(random), unit(random) + 0.1F};
    point.barycentric /= point.barycentric.sum();
    point.pixel = {640 + 100 * static_cast<float>(normal(random)), 360 + 100 * static_cast<float>(normal(random))};
    point.sigma_px = 5 + unit(random);
    scene->dense.push_back(point);
  }
  scene->data.Get<LandmarkTerm>().kernel = 20;  // generic weights: neither all inliers nor all saturated
  scene->data.Get<DenseTerm>().kernel = 25;
  return scene;
}

/// Raw residual vectors of the image observations with their derivative by parameter `column` in the Jets.
std::vector<Eigen::Matrix<Jet, 2, 1>> TwinPixels(const Scene& scene, int column) {
  const twin::SeededFrame seeded =
      twin::SeedFrame(scene.body, scene.layout, scene.state, scene.betas, scene.log_focal, column);
  const twin::Body<Jet>& body = seeded.body;

  std::vector<Eigen::Matrix<Jet, 2, 1>> residuals;
  const auto add = [&](const twin::Vector3<Jet>& x, const Eigen::Vector2d& pixel, double sigma) {
    residuals.push_back((seeded.Project(x) - pixel.cast<Jet>()) / Jet(sigma));
  };
  for (size_t i = 0; i < scene.data.Get<LandmarkTerm>().seen.size(); ++i) {
    const Landmark& landmark = scene.body.data().landmarks[scene.landmark_ids[i]];
    const auto vertices = body.Vertices(landmark.vertices);
    twin::Vector3<Jet> x = twin::Vector3<Jet>::Zero();
    for (size_t n = 0; n < vertices.size(); ++n) x += vertices[n] * Jet(landmark.weights[n]);
    add(x, scene.data.Get<LandmarkTerm>().seen[i].pixel, scene.data.Get<LandmarkTerm>().seen[i].sigma_px);
  }
  if (scene.data.Get<DenseTerm>().points != nullptr) {
    for (const DenseKeypoint& point : *scene.data.Get<DenseTerm>().points) {
      const auto f = scene.body.data().faces.row(point.face);
      const auto v = body.Vertices({f[0], f[1], f[2]});
      twin::Vector3<Jet> x = twin::Vector3<Jet>::Zero();
      const double sum = point.barycentric.cast<double>().sum();
      for (int k = 0; k < 3; ++k) x += v[k] * Jet(point.barycentric[k] / sum);
      add(x, point.pixel.cast<double>(), static_cast<double>(point.sigma_px));
    }
  }
  return residuals;
}

void ExpectNear(const MatrixXd& actual, const MatrixXd& expected, double relative, const char* what) {
  ASSERT_EQ(actual.rows(), expected.rows()) << what;
  ASSERT_EQ(actual.cols(), expected.cols()) << what;
  ASSERT_TRUE(actual.allFinite()) << what;
  EXPECT_LE((actual - expected).norm(), relative * std::max(1e-3, expected.norm())) << what;
}

/// Image terms: cost, gradient and Gauss–Newton matrix against the twin. Returns the number of derivatives compared.
int CheckPixels(const Scene& scene) {
  const int p = scene.layout.num_columns;
  const size_t n = scene.data.Get<LandmarkTerm>().seen.size() +
                   (scene.data.Get<DenseTerm>().points != nullptr ? scene.data.Get<DenseTerm>().points->size() : 0);
  MatrixXd J(2 * n, p);
  VectorXd r(2 * n);
  double cost = 0;
  for (int column = 0; column < p; ++column) {
    const auto residuals = TwinPixels(scene, column);
    cost = 0;
    for (size_t i = 0; i < n; ++i) {
      const double s = residuals[i][0].a * residuals[i][0].a + residuals[i][1].a * residuals[i][1].a;
      const double kernel = i < scene.data.Get<LandmarkTerm>().seen.size() ? scene.data.Get<LandmarkTerm>().kernel
                                                                           : scene.data.Get<DenseTerm>().kernel;
      const RobustValue robust = GemanMcClure(s, kernel);
      cost += 0.5 * robust.rho;
      for (int c = 0; c < 2; ++c) {
        r[2 * i + c] = std::sqrt(robust.weight) * residuals[i][c].a;
        J(2 * i + c, column) = std::sqrt(robust.weight) * residuals[i][c].v[0];
      }
    }
  }
  const FrameSystem system = Evaluate(scene);
  EXPECT_EQ(system.num_invalid, 0);
  ExpectMatchesTwin(system, cost, J, r);
  EXPECT_NEAR(Evaluate(scene, false).cost, system.cost, 1e-12 * system.cost);
  return static_cast<int>(J.size());
}

TEST(FrameCost, LandmarksMatchAutomaticDerivativesInEveryCamera) {
  int checked = 0;
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    for (double size : {0.0, 0.3, 1.0, 1.7}) checked += CheckPixels(*MakeScene(knowledge, size, 7));
  }
  EXPECT_GE(checked, 12 * 34 * 80);
}

TEST(FrameCost, DenseKeypointsMatchAutomaticDerivatives) {
  int checked = 0;
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kWeak}) {
    for (double size : {0.0, 0.4, 1.2}) {
      auto scene = MakeScene(knowledge, size, 11);
      scene->data.Get<DenseTerm>().points = &scene->dense;
      checked += CheckPixels(*scene);
    }
  }
  EXPECT_GE(checked, 6 * 114 * 80);
}

/// The loops are compiled once per instruction set, with vectors of two to eight values; shapes do not fill them.
TEST(FrameCost, DenseKeypointsMatchAutomaticDerivativesOnEveryInstructionSet) {
  BodyModelData body = ToyBodyData();
  const auto given = body.shapedirs.cols();
  body.shapedirs.conservativeResize(Eigen::NoChange, 19);
  for (Eigen::Index c = given; c < body.shapedirs.cols(); ++c) {
    body.shapedirs.col(c) = 0.5F * body.shapedirs.col(c - given) - 0.3F * body.shapedirs.col(c - 2);
  }
  auto scene = MakeScene(CameraKnowledge::kUnknownFocal, 0.8, 5, {}, body);
  scene->data.Get<DenseTerm>().points = &scene->dense;
  const VectorXd betas = scene->betas;
  for (const int num_betas : {0, 1, 7, 8, 9, 16, 19}) {
    scene->layout = FrameLayout::Make(scene->body, CameraKnowledge::kUnknownFocal, scene->layout.camera,
                                      scene->layout.active_joints, num_betas);
    scene->betas = betas.head(num_betas);
    for (const int64_t target : panel_internal::SimdTargets()) {
      SCOPED_TRACE(panel_internal::SimdTargetName(target) + ", " + std::to_string(num_betas) + " components");
      panel_internal::ForceSimdTarget(target);
      EXPECT_GT(CheckPixels(*scene), 0);
    }
    panel_internal::ForceSimdTarget(0);
  }
}

TEST(FrameCost, HeldJointsHaveNoColumns) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.4, 3, {0, 1, 2, 4, 5, 16, 17, 18, 19});
  EXPECT_EQ(scene->layout.num_columns, 9 * 3 + 3 + scene->body.num_betas());
  EXPECT_GT(CheckPixels(*scene), 0);
}

TEST(FrameCost, DerivativesAreNotZeroWhereTheResidualIs) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.5, 5);
  const auto residuals = TwinPixels(*scene, 0);
  for (size_t i = 0; i < scene->data.Get<LandmarkTerm>().seen.size(); ++i) {
    LandmarkObservation& observation = scene->data.Get<LandmarkTerm>().seen[i];
    observation.pixel += observation.sigma_px * Eigen::Vector2d(residuals[i][0].a, residuals[i][1].a);
  }
  const FrameSystem system = Evaluate(*scene);
  EXPECT_LT(system.cost, 1e-18);
  EXPECT_GT(system.H.norm(), 1.0);
  EXPECT_GT(CheckPixels(*scene), 0);
}

TEST(FrameCost, WeightsScaleLinearly) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.5, 6);
  scene->data.Get<LandmarkTerm>().kernel = 1e6;  // quadratic
  const FrameSystem once = Evaluate(*scene);
  for (LandmarkObservation& observation : scene->data.Get<LandmarkTerm>().seen) observation.sigma_px /= 2;
  const FrameSystem twice = Evaluate(*scene);
  EXPECT_NEAR(twice.cost, 4 * once.cost, 1e-6 * twice.cost);
  ExpectNear(twice.gradient, 4 * once.gradient, 1e-6, "gradient");
}

TEST(FrameCost, PointsBehindTheCameraCostTheSaturationAndAreCounted) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.2, 8);
  scene->state.translation = {0, 0, -4};
  const FrameSystem system = Evaluate(*scene);
  const double c = scene->data.Get<LandmarkTerm>().kernel;
  EXPECT_EQ(system.num_invalid, 17);
  EXPECT_DOUBLE_EQ(system.cost, 17 * 0.5 * c * c);
  EXPECT_EQ(system.gradient.norm(), 0);
}

/// Terms on the pose alone, each against central differences of the cost along right increments, and H against JᵀJ
/// where the residual is linear near the point (checked through the gradient's change).
void CheckPoseTerm(Scene* scene, const std::function<double(const FrameState&)>& twin_cost) {
  scene->data.Get<LandmarkTerm>().seen.clear();
  const FrameSystem system = Evaluate(*scene);
  EXPECT_NEAR(system.cost, twin_cost(scene->state), kRelative * system.cost);
  ASSERT_GT(system.cost, 0);
  constexpr double kStep = 1e-6;
  int checked = 0;
  for (size_t a = 0; a < scene->layout.active_joints.size(); ++a) {
    for (int c = 0; c < 3; ++c) {
      FrameState plus = scene->state, minus = scene->state;
      const int j = scene->layout.active_joints[a];
      plus.rotations[j] = plus.rotations[j] * RotationFromAxisAngle(kStep * Vector3d::Unit(c));
      minus.rotations[j] = minus.rotations[j] * RotationFromAxisAngle(-kStep * Vector3d::Unit(c));
      const double numeric = (twin_cost(plus) - twin_cost(minus)) / (2 * kStep);
      EXPECT_NEAR(system.gradient[3 * a + c], numeric, 1e-6 * std::max(1.0, std::abs(system.cost)));
      ++checked;
    }
  }
  EXPECT_EQ(checked, 72);
}

TEST(FrameCost, JointLimitsMatchTheirFormula) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.9, 21);
  const JointLimits limits = JointLimits::ForBody(scene->body);
  ASSERT_EQ(limits.ranges.size(), 19U);
  scene->data.Get<JointLimitTerm>().limits = Borrowed(limits);
  CheckPoseTerm(scene.get(), [&](const FrameState& state) {
    double cost = 0;
    for (const JointLimits::Range& range : limits.ranges) {
      const Vector3d w = twin::Log<double>(state.rotations[range.joint]);
      for (int c = 0; c < 3; ++c) {
        const double excess = w[c] > range.upper[c]   ? w[c] - range.upper[c]
                              : w[c] < range.lower[c] ? w[c] - range.lower[c]
                                                      : 0;
        cost +=
            0.5 * excess * excess / (scene->data.Get<JointLimitTerm>().sigma * scene->data.Get<JointLimitTerm>().sigma);
      }
    }
    return cost;
  });
}

TEST(FrameCost, UprightTermMatchesItsFormula) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.9, 22);
  scene->data.Get<UprightTerm>().weight = 3;
  CheckPoseTerm(scene.get(), [&](const FrameState& state) {
    const double r = state.rotations[0](2, 1) / kUprightSigma;
    return 0.5 * 3 * GemanMcClure(r * r, kUprightKernel).rho;
  });
}

TEST(FrameCost, InitialiserTermMatchesItsFormula) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.6, 23);
  scene->data.Get<InitialiserTerm>().rotations.assign(scene->body.num_joints(), Eigen::Matrix3d::Identity());
  scene->data.Get<InitialiserTerm>().translation = {0.5, 0.5, 3};
  scene->data.Get<InitialiserTerm>().weight = 0.7;
  CheckPoseTerm(scene.get(), [&](const FrameState& state) {
    double cost = 0;
    for (const Eigen::Matrix3d& R : state.rotations) {
      cost += 0.5 * 0.7 * twin::Log<double>(R).squaredNorm() / std::pow(scene->data.Get<InitialiserTerm>().sigma, 2);
    }
    return cost + 0.5 * 0.7 * (state.translation - scene->data.Get<InitialiserTerm>().translation).squaredNorm() /
                      std::pow(scene->data.Get<InitialiserTerm>().translation_sigma, 2);
  });
}

PosePrior RandomPrior(const std::vector<std::string>& joints, int components, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  PosePrior prior;
  prior.joints = joints;
  const int D = prior.dim();
  prior.log_weights = VectorXd::Constant(components, -std::log(components));
  prior.means = RowMatrixXd::NullaryExpr(components, D, [&]() { return 0.3 * normal(random); });
  for (int k = 0; k < components; ++k) {
    const MatrixXd A = MatrixXd::NullaryExpr(D, D, [&]() { return 0.1 * normal(random); });
    prior.covariances.push_back(A * A.transpose() + 0.05 * MatrixXd::Identity(D, D));
  }
  return prior;
}

TEST(FrameCost, PriorIsTheEnergyOfTheNearestComponent) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.5, 24);
  const std::vector<std::string> names(SmplJointNames().begin() + 1, SmplJointNames().begin() + 22);
  const PosePrior prior = RandomPrior(names, 3, 1);
  const MixturePrior mixture(prior, scene->body, scene->layout.active_joints);
  ASSERT_EQ(mixture.joints().size(), 21U);
  scene->data.Get<PosePriorTerm>().mixture = Borrowed(mixture);
  scene->data.Get<PosePriorTerm>().weight = 0.4;
  CheckPoseTerm(scene.get(), [&](const FrameState& state) {
    VectorXd x(prior.dim());
    for (int i = 0; i < 21; ++i) x.segment<3>(3 * i) = twin::Log<double>(state.rotations[i + 1]);
    VectorXd energy(3);
    for (int k = 0; k < 3; ++k) {
      const VectorXd d = x - prior.means.row(k).transpose();
      energy[k] = d.dot(prior.covariances[k].inverse() * d) - 2 * prior.log_weights[k] +
                  std::log(prior.covariances[k].determinant());
    }
    // Offsets are shifted so that the smallest is zero.
    double smallest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      smallest = std::min(smallest, -2 * prior.log_weights[k] + std::log(prior.covariances[k].determinant()));
    }
    return 0.5 * 0.4 * (energy.minCoeff() - smallest);
  });
}

TEST(MixturePrior, MarginalOfASubsetOfJoints) {
  const BodyModel body(ToyBodyData());
  const std::vector<std::string> names(SmplJointNames().begin() + 1, SmplJointNames().begin() + 22);
  const PosePrior prior = RandomPrior(names, 2, 3);
  const MixturePrior mixture(prior, body, {0, 4, 5});
  ASSERT_EQ(mixture.joints(), (std::vector<int>{4, 5}));
  for (int k = 0; k < 2; ++k) {
    const MatrixXd marginal = prior.covariances[k].block(9, 9, 6, 6);
    ExpectNear(mixture.sqrt_precision(k).transpose() * mixture.sqrt_precision(k), marginal.inverse(), 1e-9,
               "precision");
    ExpectNear(mixture.mean(k), prior.means.row(k).segment(9, 6).transpose(), 1e-12, "mean");
  }
}

/// Cost, gradient and Gauss–Newton matrix of residuals that were handed out one by one.
FrameSystem SumOf(const FrameRows& rows, const FrameLayout& layout) {
  const int p = layout.num_columns;
  FrameSystem sum;
  sum.H.setZero(p, p);
  sum.gradient.setZero(p);
  for (const ResidualGroup& group : rows.groups) {
    const auto r = rows.r.segment(group.first_row, group.num_rows);
    MatrixXd J = MatrixXd::Zero(group.num_rows, p);  // of what the group says that it depends on
    for (const int block : group.blocks) {
      const int first = layout.FirstColumn(block), columns = layout.NumColumns(block);
      J.middleCols(first, columns) = rows.J.block(group.first_row, first, group.num_rows, columns);
    }
    const double s = r.squaredNorm();
    const RobustValue robust = group.kernel > 0 ? GemanMcClure(s, group.kernel) : RobustValue{s, 1};
    sum.cost += 0.5 * group.weight * robust.rho;
    sum.H += group.weight * robust.weight * J.transpose() * J;
    sum.gradient += group.weight * robust.weight * J.transpose() * r;
  }
  return sum;
}

/// A scene with a term of each kind that the frame's cost knows.
std::unique_ptr<Scene> SceneOfManyTerms(CameraKnowledge knowledge, const MixturePrior& mixture,
                                        const JointLimits& limits) {
  auto scene = MakeScene(knowledge, 0.7, 31);
  scene->data.Get<DenseTerm>().points = &scene->dense;
  scene->data.Get<PosePriorTerm>().mixture = Borrowed(mixture);
  scene->data.Get<PosePriorTerm>().weight = 0.3;
  scene->data.Get<JointLimitTerm>().limits = Borrowed(limits);
  scene->data.Get<UprightTerm>().weight = 2;
  scene->data.Get<StraightKneesTerm>() = StraightKneesTerm(FindKnees(scene->body), 0.4);
  InitialiserTerm& initialiser = scene->data.Get<InitialiserTerm>();
  initialiser.rotations.assign(scene->body.num_joints(), Eigen::Matrix3d::Identity());
  initialiser.translation = {0.5, 0.5, 3};
  initialiser.weight = 0.7;
  return scene;
}

TEST(FrameRows, OneByOneEqualTheSums) {
  const BodyModel body(ToyBodyData());
  const std::vector<std::string> names(SmplJointNames().begin() + 1, SmplJointNames().begin() + 22);
  const PosePrior prior = RandomPrior(names, 3, 1);
  const MixturePrior mixture(prior, body, AllJoints(body));
  const JointLimits limits = JointLimits::ForBody(body);
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    for (const bool behind : {false, true}) {
      auto scene = SceneOfManyTerms(knowledge, mixture, limits);
      if (behind && knowledge != CameraKnowledge::kWeak) scene->state.translation.z() = -4;
      const FrameSystem system = Evaluate(*scene);
      FrameEvaluator evaluator;
      FrameRows structure, rows, norms;
      const auto evaluate = [&](FrameAccumulator::Mode mode, FrameRows* result) {
        evaluator.EvaluateRows(scene->layout, scene->data, scene->state, *scene, mode, result);
      };
      evaluate(FrameAccumulator::Mode::kStructure, &structure);
      evaluate(FrameAccumulator::Mode::kRows, &rows);
      evaluate(FrameAccumulator::Mode::kNorms, &norms);
      ASSERT_EQ(rows.groups.size(), structure.groups.size());
      ASSERT_EQ(norms.groups.size(), structure.groups.size());
      EXPECT_GT(rows.groups.size(), 17U + 19U);
      for (size_t i = 0; i < rows.groups.size(); ++i) {
        rows.groups[i].blocks = structure.groups[i].blocks;
        EXPECT_EQ(norms.groups[i].num_rows, structure.groups[i].num_rows);
      }
      const FrameSystem sum = SumOf(rows, scene->layout);
      EXPECT_NEAR(sum.cost, system.cost, 1e-10 * system.cost);
      ExpectNear(sum.gradient, system.gradient, 1e-10, "gradient");
      ExpectNear(sum.H, system.H.selfadjointView<Eigen::Lower>(), 1e-10, "Gauss-Newton matrix");
      norms.J.setZero();
      EXPECT_NEAR(SumOf(norms, scene->layout).cost, system.cost, 1e-10 * system.cost);
    }
  }
}

TEST(FrameRows, CompressedEqualTheSystem) {
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    for (const bool dense : {false, true}) {  // without dense keypoints 2D joints leave directions open
      auto scene = MakeScene(knowledge, 0.5, 31);
      if (dense) scene->data.Get<DenseTerm>().points = &scene->dense;
      const FrameSystem system = Evaluate(*scene);
      const int p = scene->layout.num_columns;
      RowMatrixXd J(p + 2, p);
      VectorXd r(p + 2), r_only(p + 2);
      CompressedRows(system, true, J, r);
      CompressedRows(system, false, J.bottomRows(p + 2), r_only);
      const MatrixXd H = system.H.selfadjointView<Eigen::Lower>();
      EXPECT_NEAR(0.5 * r.squaredNorm(), system.cost, 1e-10 * system.cost);
      EXPECT_NEAR(0.5 * r_only.squaredNorm(), system.cost, 1e-10 * system.cost);
      ExpectNear(J.transpose() * r, system.gradient, 1e-10, "gradient");
      // The row that carries the gradient of directions left open has a little curvature of its own.
      ExpectNear(J.transpose() * J, H, dense ? 1e-10 : 1e-8, "Gauss-Newton matrix");
      if (!dense) continue;
      const MatrixXd damping = 1e-3 * MatrixXd(H.diagonal().asDiagonal()) + 1e-9 * MatrixXd::Identity(p, p);
      ExpectNear((J.transpose() * J + damping).ldlt().solve(J.transpose() * r),
                 (H + damping).ldlt().solve(system.gradient), 1e-7, "step");
    }
  }
}

TEST(SquareRootSystem, ParametersNothingDependsOnGiveZeroRows) {
  MatrixXd A(4, 6);
  A << 1, 2, 0, 3, 0, 1, 0, 1, 0, 1, 0, 1, 2, 0, 0, 1, 0, 1, 1, 1, 0, 1, 0, 2;  // columns 2 and 4 are zero, rank 4
  const VectorXd b = VectorXd::LinSpaced(4, -1, 2);
  MatrixXd R;
  VectorXd y;
  SquareRootSystem(A.transpose() * A, A.transpose() * b, &R, &y);
  ExpectNear(R.transpose() * R, A.transpose() * A, 1e-12, "H");
  ExpectNear(R.transpose() * y, A.transpose() * b, 1e-12, "gradient");
  EXPECT_EQ(R.row(2).norm(), 0);
  EXPECT_EQ(R.row(4).norm(), 0);
}

}  // namespace
}  // namespace bodyloom::frame_cost_test
