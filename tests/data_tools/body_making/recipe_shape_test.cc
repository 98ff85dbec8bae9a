// SPDX-License-Identifier: Apache-2.0
/// Properties promised by assets/body/RECIPE.md, section 5: meaning of the shape components.
#include <gtest/gtest.h>

#include "tests/data_tools/body_making/recipe_support.h"

namespace bodyloom::recipe_shape_test {
namespace {

struct Measures {
  double height_m, volume_l, shoulder_breadth_m, hip_breadth_m, waist_breadth_m, leg_length_m, arm_span_m;
};

double BreadthAt(const MatrixX3d& vertices, double low_y, double high_y, double max_abs_x) {
  double breadth = 0;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    const double x = std::abs(vertices(v, 0));
    if (vertices(v, 1) > low_y && vertices(v, 1) < high_y && x < max_abs_x) breadth = std::max(breadth, 2 * x);
  }
  return breadth;
}

Measures Measure(const Eigen::VectorXd& betas) {
  const BodyModel& body = BuiltinBody();
  const MatrixX3d v = ShapeVertices(body, betas);
  const MatrixX3d joints = body.RestJoints(betas);
  const auto joint = [&](const char* name) { return Eigen::RowVector3d(joints.row(body.FindJoint(name))); };
  Measures m;
  m.height_m = v.col(1).maxCoeff() - v.col(1).minCoeff();
  m.volume_l = 1000 * MeshVolume(v, body.data().faces);
  m.shoulder_breadth_m = 2 * joint("l_shoulder").x();
  m.hip_breadth_m = BreadthAt(v, joint("l_hip").y() - 0.03, joint("l_hip").y() + 0.03, 0.3);
  m.waist_breadth_m = BreadthAt(v, joint("spine1").y() - 0.03, joint("spine1").y() + 0.03, 0.3);
  m.arm_span_m = v.col(0).maxCoeff() - v.col(0).minCoeff();
  m.leg_length_m = joint("l_hip").y() - joint("l_ankle").y();
  return m;
}

TEST(RecipeShape, StatureOfTheFirstComponent) {
  const Measures tall = Measure(OneBeta(0, 2)), small = Measure(OneBeta(0, -2));
  EXPECT_NEAR(tall.height_m, 1.895, 0.001);
  EXPECT_NEAR(tall.volume_l, 96, 0.5);
  EXPECT_NEAR(small.height_m, 1.530, 0.001);
  EXPECT_NEAR(small.volume_l, 48, 0.5);
}

TEST(RecipeShape, SexAtFixedStatureOfTheSecond) {
  const Measures male = Measure(OneBeta(1, 2)), female = Measure(OneBeta(1, -2));
  EXPECT_GT(male.shoulder_breadth_m, female.shoulder_breadth_m + 0.01);
  EXPECT_LT(male.hip_breadth_m, female.hip_breadth_m - 0.01);
  EXPECT_GT(male.arm_span_m, female.arm_span_m + 0.05);
  EXPECT_NEAR(male.leg_length_m - female.leg_length_m, 0.013, 0.002);
  EXPECT_LT(std::abs(male.height_m - female.height_m), 0.05) << "stature is the first component's";
}

TEST(RecipeShape, WeightOfTheThird) {
  const Measures heavy = Measure(OneBeta(2, 2)), light = Measure(OneBeta(2, -2));
  EXPECT_NEAR(light.volume_l, 50, 0.7);
  EXPECT_NEAR(heavy.volume_l, 90, 0.7);
  EXPECT_GT(heavy.waist_breadth_m, light.waist_breadth_m + 0.05);
  EXPECT_LT(std::abs(heavy.height_m - light.height_m), 0.05);
}

TEST(RecipeShape, AgeAndProportions) {
  const Measures old = Measure(OneBeta(3, 2)), young = Measure(OneBeta(3, -2));
  EXPECT_GT(old.waist_breadth_m, young.waist_breadth_m);
  const Measures ideal = Measure(OneBeta(4, 2)), other = Measure(OneBeta(4, -2));
  EXPECT_LT(ideal.waist_breadth_m, other.waist_breadth_m);
}

/// Components are principal axes in units of one standard deviation: mutually orthogonal under the area of the mean
/// body, and their squared lengths are shares of the population's variance. The recipe's cumulative shares, %:
TEST(RecipeShape, VarianceShares) {
  const BodyModelData& data = BuiltinBody().data();
  const Eigen::VectorXd areas = VertexAreas(data.v_template, data.faces);
  Eigen::MatrixXd weighted = data.shapedirs.cast<double>();
  for (Eigen::Index v = 0; v < areas.size(); ++v) weighted.middleRows<3>(3 * v) *= std::sqrt(areas[v] / areas.sum());
  const Eigen::MatrixXd gram = weighted.transpose() * weighted;
  const double cumulative[10] = {81.0, 88.4, 93.9, 95.9, 97.0, 98.0, 98.5, 98.9, 99.1, 99.3};
  const double all = gram.trace() / (cumulative[9] / 100);
  double sum = 0;
  for (int b = 0; b < 10; ++b) {
    sum += gram(b, b);
    EXPECT_NEAR(100 * sum / all, cumulative[b], 0.35) << "component " << b;
    EXPECT_TRUE(b == 0 || gram(b, b) < gram(b - 1, b - 1)) << "component " << b;
    for (int c = 0; c < b; ++c) {
      EXPECT_LT(std::abs(gram(b, c)) / std::sqrt(gram(b, b) * gram(c, c)), 0.05) << b << " and " << c;
    }
  }
}

}  // namespace
}  // namespace bodyloom::recipe_shape_test
