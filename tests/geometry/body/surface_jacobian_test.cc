// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/surface_jacobian.h"

#include <ceres/jet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/math/rotation.h"
#include "tests/geometry/random_body.h"
#include "tests/geometry/slow_body.h"
#include "tests/support/toy_body.h"

namespace bodyloom::surface_jacobian_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using ::testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;
constexpr int kMaxBetas = 10;
/// 3 an increment of each of 24 joints, betas, translation.
constexpr int kParameters = 3 * 24 + kMaxBetas + 3;
using Jet = ceres::Jet<double, kParameters>;

/// The slow body with every parameter a Jet: R exp([δ]×) to second order about δ = 0.
SlowBody<Jet> PoseWithJets(const BodyModel& model, const VectorXd& betas, const BodyPose& pose,
                           const std::vector<int>& vertices) {
  const int J = model.num_joints();
  std::vector<Slow33<Jet>> rotations(J);
  for (int j = 0; j < J; ++j) {
    Slow33<Jet> S, E;
    const Jet x(0.0, 3 * j), y(0.0, 3 * j + 1), z(0.0, 3 * j + 2), zero(0.0);
    S[0] = {zero, -z, y};
    S[1] = {z, zero, -x};
    S[2] = {-y, x, zero};
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        E[r][c] = S[r][c] + Jet(r == c ? 1.0 : 0.0);
        for (int k = 0; k < 3; ++k) E[r][c] += 0.5 * S[r][k] * S[k][c];
      }
    }
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        rotations[j][r][c] = Jet(0.0);
        for (int k = 0; k < 3; ++k) rotations[j][r][c] += pose.rotations[j](r, k) * E[k][c];
      }
    }
  }
  std::vector<Jet> beta_jets;
  beta_jets.reserve(static_cast<size_t>(betas.size()));
  for (int b = 0; b < betas.size(); ++b) beta_jets.emplace_back(betas[b], 3 * J + b);
  Slow3<Jet> trans;
  for (int c = 0; c < 3; ++c) trans[c] = Jet(pose.trans[c], 3 * J + kMaxBetas + c);
  return PoseSlowly<Jet>(model.data(), beta_jets, rotations, trans, vertices);
}

/// The Jacobian written out: 3 × kParameters in the Jets' order.
Eigen::Matrix<double, 3, kParameters> Dense(const BodyModel& model, const PointJacobian& jacobian) {
  Eigen::Matrix<double, 3, kParameters> dense = Eigen::Matrix<double, 3, kParameters>::Zero();
  for (size_t i = 0; i < jacobian.joints.size(); ++i) {
    dense.middleCols<3>(3 * jacobian.joints[i]) = jacobian.d_point_d_rotation[i];
  }
  dense.middleCols(3 * model.num_joints(), jacobian.d_point_d_betas.cols()) = jacobian.d_point_d_betas;
  dense.rightCols<3>() = jacobian.d_point_d_trans * Matrix3d::Identity();
  return dense;
}

/// Largest difference relative to the largest derivative; also checks values, order and that listed blocks exist.
double Compare(const BodyModel& model, const PointJacobian& jacobian, const Slow3<Jet>& truth) {
  EXPECT_TRUE(std::is_sorted(jacobian.joints.begin(), jacobian.joints.end()));
  EXPECT_EQ(jacobian.joints.size(), jacobian.d_point_d_rotation.size());
  const auto dense = Dense(model, jacobian);
  double difference = 0, scale = 1e-3;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(jacobian.point[c], truth[c].a, 1e-12);
    difference = std::max(difference, (dense.row(c).transpose() - truth[c].v).cwiseAbs().maxCoeff());
    scale = std::max(scale, truth[c].v.cwiseAbs().maxCoeff());
    if (!dense.allFinite()) difference = std::numeric_limits<double>::infinity();
  }
  return difference / scale;
}

std::vector<BodyPose> TestPoses(const BodyModel& model) {
  std::vector<BodyPose> poses = {RestPose(model)};
  for (unsigned seed = 0; seed < 6; ++seed) poses.push_back(RandomPose(model, seed, seed < 3 ? 0.5 : 3.1));
  for (double angle : {1e-12, 1e-6, kPi - 1e-9, kPi, kPi + 1e-9}) {
    BodyPose pose = RandomPose(model, 77);
    for (Matrix3d& R : pose.rotations) {
      const Vector3d w = AxisAngleFromRotation(R);
      R = RotationFromAxisAngle(angle * w.normalized());
    }
    poses.push_back(pose);
  }
  return poses;
}

struct NamedBody {
  const char* name;
  const BodyModel& (*body)();
};
void PrintTo(const NamedBody& body, std::ostream* out) { *out << body.name; }

const BodyModel& DenseBody() {
  static const BodyModel body = [] {
    RandomBodyOptions options;
    options.correctives_per_vertex = 1000;
    return RandomBody(options);
  }();
  return body;
}

const BodyModel& UncorrectedBody() {
  static const BodyModel body = [] {
    RandomBodyOptions options;
    options.correctives_per_vertex = 0;
    options.seed = 5;
    return RandomBody(options);
  }();
  return body;
}

class SurfaceJacobianOf : public ::testing::TestWithParam<NamedBody> {};

TEST_P(SurfaceJacobianOf, SurfacePointsAgreeWithJets) {
  const BodyModel& model = GetParam().body();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  int checked = 0, blocks = 0, absent = 0;
  for (const BodyPose& pose : TestPoses(model)) {
    const VectorXd betas = RandomBetas(model.num_betas(), random());
    const SurfaceJacobian surface(model, betas, pose);
    for (int i = 0; i < 12; ++i) {
      SurfacePoint point;
      point.face = static_cast<int>(random() % model.num_faces());
      point.barycentric = Vector3d{uniform(random), uniform(random), uniform(random)};
      if (i == 0) point.barycentric = Vector3d(0, 1, 0);
      if (i == 1) point.barycentric = Vector3d(1.5, -0.75, 0.25);  // outside the face, still linear
      point.barycentric /= point.barycentric.sum();
      const Eigen::RowVector3i corners = model.data().faces.row(point.face);
      const SlowBody<Jet> body = PoseWithJets(model, betas, pose, {corners[0], corners[1], corners[2]});
      Slow3<Jet> truth{Jet(0.0), Jet(0.0), Jet(0.0)};
      for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 3; ++c) truth[c] += point.barycentric[k] * body.vertices[k][c];
      }
      const PointJacobian jacobian = surface.At(point);
      EXPECT_LT(Compare(model, jacobian, truth), 1e-12);
      EXPECT_NEAR(jacobian.d_point_d_trans, 1, 1e-14);
      blocks += static_cast<int>(jacobian.joints.size());
      absent += model.num_joints() - static_cast<int>(jacobian.joints.size());
      ++checked;
    }
  }
  EXPECT_EQ(checked, 12 * 12);
  EXPECT_GT(blocks, 4 * checked);
  const int expected_absent = &model == &DenseBody() ? -1 : 4 * checked;
  EXPECT_GT(absent, expected_absent);  // joints that cannot move the point are not listed
}

TEST_P(SurfaceJacobianOf, JointsAgreeWithJets) {
  const BodyModel& model = GetParam().body();
  int checked = 0;
  for (const BodyPose& pose : TestPoses(model)) {
    const VectorXd betas = RandomBetas(model.num_betas(), 9);
    const SurfaceJacobian surface(model, betas, pose);
    const SlowBody<Jet> body = PoseWithJets(model, betas, pose, {});
    for (int j = 0; j < model.num_joints(); ++j) {
      EXPECT_LT(Compare(model, surface.OfJoint(j), body.joints[j]), 1e-12) << j;
      EXPECT_EQ(surface.OfJoint(j).joints.size() + 1, model.ancestors(j).size());
      ++checked;
    }
  }
  EXPECT_EQ(checked, 12 * 24);
}

TEST_P(SurfaceJacobianOf, CentralDifferencesThroughTheBodyItself) {
  const BodyModel& model = GetParam().body();
  const double h = 1e-5;
  const std::vector<int> vertices = {0, 17, 101, 250};
  const std::vector<double> weights = {0.5, -0.25, 0.75, 0.3};
  int checked = 0;
  for (const BodyPose& pose : TestPoses(model)) {
    const VectorXd betas = RandomBetas(model.num_betas(), 10);
    const auto value = [&](const VectorXd& b, const BodyPose& p) -> Vector3d {
      const MatrixX3d x = PoseVertices(model, b, p, vertices);
      return x.transpose() * Eigen::Map<const VectorXd>(weights.data(), 4);
    };
    const PointJacobian jacobian = SurfaceJacobian(model, betas, pose).OfVertices(vertices, weights);
    EXPECT_LT((jacobian.point - value(betas, pose)).norm(), 1e-12);
    EXPECT_NEAR(jacobian.d_point_d_trans, 1.3, 1e-14);
    const auto dense = Dense(model, jacobian);
    for (int j = 0; j < model.num_joints(); ++j) {
      for (int k = 0; k < 3; ++k) {
        BodyPose plus = pose, minus = pose;
        plus.rotations[j] = pose.rotations[j] * RotationFromAxisAngle(h * Vector3d::Unit(k));
        minus.rotations[j] = pose.rotations[j] * RotationFromAxisAngle(-h * Vector3d::Unit(k));
        EXPECT_LT(((value(betas, plus) - value(betas, minus)) / (2 * h) - dense.col(3 * j + k)).norm(), 1e-9);
        ++checked;
      }
    }
    for (int b = 0; b < model.num_betas(); ++b) {
      const VectorXd step = h * VectorXd::Unit(model.num_betas(), b);
      const Vector3d difference = (value(betas + step, pose) - value(betas - step, pose)) / (2 * h);
      EXPECT_LT((difference - jacobian.d_point_d_betas.col(b)).norm(), 1e-9);
      ++checked;
    }
  }
  EXPECT_EQ(checked, 12 * (72 + model.num_betas()));
}

INSTANTIATE_TEST_SUITE_P(Bodies, SurfaceJacobianOf,
                         ::testing::Values(NamedBody{"toy", &ToyBody}, NamedBody{"dense", &DenseBody},
                                           NamedBody{"uncorrected", &UncorrectedBody}),
                         [](const auto& info) { return info.param.name; });

TEST(SurfaceJacobian, AxisAngleThroughTheRightJacobian) {
  const BodyModel& model = ToyBody();
  const VectorXd values = VectorXd::Random(72) * 1.5;
  const BodyPose pose = PoseFromAxisAngle(model, values, Vector3d::Zero());
  const PointJacobian jacobian = SurfaceJacobian(model, VectorXd(), pose).At({100, {0.2, 0.3, 0.5}});
  const double h = 1e-5;
  for (size_t i = 0; i < jacobian.joints.size(); ++i) {
    const int j = jacobian.joints[i];
    const Matrix3d expected = jacobian.d_point_d_rotation[i] * RightJacobian(values.segment<3>(3 * j));
    for (int k = 0; k < 3; ++k) {
      const auto point = [&](double step) {
        const BodyPose moved =
            PoseFromAxisAngle(model, values + step * VectorXd::Unit(72, 3 * j + k), Vector3d::Zero());
        return SurfaceJacobian(model, VectorXd(), moved).At({100, {0.2, 0.3, 0.5}}).point;
      };
      EXPECT_LT(((point(h) - point(-h)) / (2 * h) - expected.col(k)).norm(), 1e-9);
    }
  }
}

TEST(SurfaceJacobian, OnlyTheBetasThatWereGiven) {
  const BodyModel& model = ToyBody();
  const BodyPose pose = RandomPose(model, 3);
  VectorXd betas = RandomBetas(6, 1);
  betas.tail(4).setZero();
  const PointJacobian all = SurfaceJacobian(model, betas, pose).At({5, {1, 0, 0}});
  const PointJacobian two = SurfaceJacobian(model, betas.head(2), pose).At({5, {1, 0, 0}});
  ASSERT_EQ(two.d_point_d_betas.cols(), 2);
  EXPECT_LT((all.d_point_d_betas.leftCols(2) - two.d_point_d_betas).norm(), 1e-15);
  EXPECT_EQ(SurfaceJacobian(model, VectorXd(), pose).At({5, {1, 0, 0}}).d_point_d_betas.cols(), 0);
}

TEST(SurfaceJacobian, VerticesOfWeightZeroAreLeftOut) {
  const BodyModel& model = ToyBody();
  const SurfaceJacobian surface(model, VectorXd(), RandomPose(model, 4));
  const PointJacobian one = surface.OfVertices(std::vector<int>{3}, std::vector<double>{1});
  const PointJacobian two = surface.OfVertices(std::vector<int>{3, 700}, std::vector<double>{1, 0});
  EXPECT_EQ(one.joints, two.joints);
  EXPECT_EQ(one.point, two.point);
  const PointJacobian none = surface.OfVertices({}, {});
  EXPECT_TRUE(none.joints.empty());
  EXPECT_EQ(none.point, Vector3d(Vector3d::Zero()));
}

std::string MessageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

TEST(SurfaceJacobian, BrokenContractsAreNamed) {
  const BodyModel& model = ToyBody();
  const SurfaceJacobian surface(model, VectorXd(), RestPose(model));
  EXPECT_THAT(MessageOf([&] { (void)surface.At({model.num_faces(), {1, 0, 0}}); }), HasSubstr("is outside 0.."));
  EXPECT_THAT(MessageOf([&] { (void)surface.At({-1, {1, 0, 0}}); }), HasSubstr("face -1"));
  EXPECT_THAT(MessageOf([&] { (void)surface.OfJoint(24); }), HasSubstr("joint 24 is outside 0..23"));
  EXPECT_THAT(MessageOf([&] { (void)surface.OfVertices(std::vector<int>{804}, std::vector<double>{1}); }),
              HasSubstr("vertex 804 is outside 0..803"));
  EXPECT_THAT(MessageOf([&] {
                (void)surface.OfVertices(std::vector<int>{1, 2}, std::vector<double>{1});
              }),
              HasSubstr("2 vertices and 1 weights"));
  EXPECT_THAT(MessageOf([&] { SurfaceJacobian(model, RandomBetas(7, 1), RestPose(model)); }), HasSubstr("betas has 7"));
}

}  // namespace
}  // namespace bodyloom::surface_jacobian_test
