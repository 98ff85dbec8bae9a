// SPDX-License-Identifier: Apache-2.0
// Every term of the frame cost against automatic differentiation of an independent twin, to 1e-9 relative.
#include "bodyloom/tracking/frame_cost.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/chain/panel_simd.h"
#include "bodyloom/tracking/residuals/compressed_frame_cost.h"
#include "bodyloom/tracking/robust.h"
#include "tests/support/frame_scene.h"
#include "tests/tracking/jet_twin.h"

namespace bodyloom {
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
    scene->data.landmarks.seen.push_back({&point, {640 + 200 * normal(random), 360 + 200 * normal(random)}, 8});
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
  scene->data.landmarks.kernel = 20;  // generic weights: neither all inliers nor all saturated
  scene->data.dense.kernel = 25;
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
  for (size_t i = 0; i < scene.data.landmarks.seen.size(); ++i) {
    const Landmark& landmark = scene.body.data().landmarks[scene.landmark_ids[i]];
    const auto vertices = body.Vertices(landmark.vertices);
    twin::Vector3<Jet> x = twin::Vector3<Jet>::Zero();
    for (size_t n = 0; n < vertices.size(); ++n) x += vertices[n] * Jet(landmark.weights[n]);
    add(x, scene.data.landmarks.seen[i].pixel, scene.data.landmarks.seen[i].sigma_px);
  }
  if (scene.data.dense.points != nullptr) {
    for (const DenseKeypoint& point : *scene.data.dense.points) {
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
  const size_t n =
      scene.data.landmarks.seen.size() + (scene.data.dense.points != nullptr ? scene.data.dense.points->size() : 0);
  MatrixXd J(2 * n, p);
  VectorXd r(2 * n);
  double cost = 0;
  for (int column = 0; column < p; ++column) {
    const auto residuals = TwinPixels(scene, column);
    cost = 0;
    for (size_t i = 0; i < n; ++i) {
      const double s = residuals[i][0].a * residuals[i][0].a + residuals[i][1].a * residuals[i][1].a;
      const double kernel =
          i < scene.data.landmarks.seen.size() ? scene.data.landmarks.kernel : scene.data.dense.kernel;
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
      scene->data.dense.points = &scene->dense;
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
  scene->data.dense.points = &scene->dense;
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
  for (size_t i = 0; i < scene->data.landmarks.seen.size(); ++i) {
    LandmarkObservation& observation = scene->data.landmarks.seen[i];
    observation.pixel += observation.sigma_px * Eigen::Vector2d(residuals[i][0].a, residuals[i][1].a);
  }
  const FrameSystem system = Evaluate(*scene);
  EXPECT_LT(system.cost, 1e-18);
  EXPECT_GT(system.H.norm(), 1.0);
  EXPECT_GT(CheckPixels(*scene), 0);
}

TEST(FrameCost, WeightsScaleLinearly) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.5, 6);
  scene->data.landmarks.kernel = 1e6;  // quadratic
  const FrameSystem once = Evaluate(*scene);
  for (LandmarkObservation& observation : scene->data.landmarks.seen) observation.sigma_px /= 2;
  const FrameSystem twice = Evaluate(*scene);
  EXPECT_NEAR(twice.cost, 4 * once.cost, 1e-6 * twice.cost);
  ExpectNear(twice.gradient, 4 * once.gradient, 1e-6, "gradient");
}

TEST(FrameCost, PointsBehindTheCameraCostTheSaturationAndAreCounted) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.2, 8);
  scene->state.translation = {0, 0, -4};
  const FrameSystem system = Evaluate(*scene);
  const double c = scene->data.landmarks.kernel;
  EXPECT_EQ(system.num_invalid, 17);
  EXPECT_DOUBLE_EQ(system.cost, 17 * 0.5 * c * c);
  EXPECT_EQ(system.gradient.norm(), 0);
}

/// Terms on the pose alone, each against central differences of the cost along right increments, and H against JᵀJ
/// where the residual is linear near the point (checked through the gradient's change).
void CheckPoseTerm(Scene* scene, const std::function<double(const FrameState&)>& twin_cost) {
  scene->data.landmarks.seen.clear();
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
  scene->data.limits.limits = &limits;
  CheckPoseTerm(scene.get(), [&](const FrameState& state) {
    double cost = 0;
    for (const JointLimits::Range& range : limits.ranges) {
      const Vector3d w = twin::Log<double>(state.rotations[range.joint]);
      for (int c = 0; c < 3; ++c) {
        const double excess = w[c] > range.upper[c]   ? w[c] - range.upper[c]
                              : w[c] < range.lower[c] ? w[c] - range.lower[c]
                                                      : 0;
        cost += 0.5 * excess * excess / (scene->data.limits.sigma * scene->data.limits.sigma);
      }
    }
    return cost;
  });
}

TEST(FrameCost, UprightTermMatchesItsFormula) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.9, 22);
  scene->data.upright.weight = 3;
  CheckPoseTerm(scene.get(), [&](const FrameState& state) {
    const double r = state.rotations[0](2, 1) / kUprightSigma;
    return 0.5 * 3 * GemanMcClure(r * r, kUprightKernel).rho;
  });
}

TEST(FrameCost, InitialiserTermMatchesItsFormula) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.6, 23);
  scene->data.initialiser.rotations.assign(scene->body.num_joints(), Eigen::Matrix3d::Identity());
  scene->data.initialiser.translation = {0.5, 0.5, 3};
  scene->data.initialiser.weight = 0.7;
  CheckPoseTerm(scene.get(), [&](const FrameState& state) {
    double cost = 0;
    for (const Eigen::Matrix3d& R : state.rotations) {
      cost += 0.5 * 0.7 * twin::Log<double>(R).squaredNorm() / std::pow(scene->data.initialiser.sigma, 2);
    }
    return cost + 0.5 * 0.7 * (state.translation - scene->data.initialiser.translation).squaredNorm() /
                      std::pow(scene->data.initialiser.translation_sigma, 2);
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
  scene->data.prior.mixture = &mixture;
  scene->data.prior.weight = 0.4;
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

TEST(CompressedFrameCost, EqualsTheFullSystem) {
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    auto scene = MakeScene(knowledge, 0.5, 31);
    scene->data.dense.points = &scene->dense;
    const FrameSystem system = Evaluate(*scene);
    const CompressedFrameCost cost(scene->layout, scene->data, scene->state);
    std::vector<VectorXd> blocks;
    for (const Eigen::Matrix3d& R : scene->state.rotations) blocks.push_back(AxisAngleFromRotation(R));
    blocks.push_back(scene->state.translation);
    blocks.push_back(scene->betas);
    if (scene->layout.focal_column >= 0) blocks.push_back(VectorXd::Constant(1, scene->log_focal));
    ASSERT_EQ(cost.parameter_block_sizes().size(), blocks.size());
    const int p = scene->layout.num_columns;
    ASSERT_EQ(cost.num_residuals(), p + 1);
    std::vector<const double*> parameters;
    std::vector<RowMatrixXd> jacobians;
    for (const VectorXd& block : blocks) {
      parameters.push_back(block.data());
      jacobians.emplace_back(p + 1, block.size());
    }
    std::vector<double*> jacobian_pointers;
    jacobian_pointers.reserve(jacobians.size());
    for (RowMatrixXd& J : jacobians) jacobian_pointers.push_back(J.data());
    VectorXd r(p + 1), r_only(p + 1);
    ASSERT_TRUE(cost.Evaluate(parameters.data(), r.data(), jacobian_pointers.data()));
    ASSERT_TRUE(cost.Evaluate(parameters.data(), r_only.data(), nullptr));
    MatrixXd J(p + 1, p);
    int column = 0;
    for (const RowMatrixXd& block : jacobians) {
      J.middleCols(column, block.cols()) = block;
      column += static_cast<int>(block.cols());
    }
    const MatrixXd H = system.H.selfadjointView<Eigen::Lower>();
    EXPECT_NEAR(0.5 * r.squaredNorm(), system.cost, 1e-10 * system.cost);
    EXPECT_NEAR(0.5 * r_only.squaredNorm(), system.cost, 1e-10 * system.cost);
    ExpectNear(J.transpose() * r, system.gradient, 1e-10, "gradient");
    ExpectNear(J.transpose() * J, H, 1e-10, "Gauss-Newton matrix");
    const MatrixXd damping = 1e-3 * MatrixXd(H.diagonal().asDiagonal()) + 1e-9 * MatrixXd::Identity(p, p);
    ExpectNear((J.transpose() * J + damping).ldlt().solve(J.transpose() * r),
               (H + damping).ldlt().solve(system.gradient), 1e-7, "step");
  }
}

TEST(CompressedFrameCost, ParametersNothingDependsOnGiveZeroRows) {
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
}  // namespace bodyloom
