// SPDX-License-Identifier: Apache-2.0
// Bodies of a given stature: the complete built-in body.
#include "tracking/problem/stature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "tests/support/toy_body.h"
#include "tracking/problem/sequence_problem.h"

namespace bodyloom::stature_test {
namespace {

using Eigen::VectorXd;

/// V×3, about its mean.
MatrixX3d Shape(const BodyModel& body, const VectorXd& betas) {
  MatrixX3d v = body.data().v_template;
  const VectorXd moved = body.data().shapedirs.leftCols(betas.size()).cast<double>() * betas;
  for (Eigen::Index i = 0; i < v.rows(); ++i) v.row(i) += moved.segment<3>(3 * i).transpose();
  v.rowwise() -= v.colwise().mean().eval();
  return v;
}

double StatureOf(const BodyModel& body, const VectorXd& betas) {
  VectorXd gradient;
  return StatureOfMeanShape(body, int(betas.size()), &gradient) + gradient.dot(betas);
}

TEST(Stature, TheWholeBodyGrowsAndItsProportionsStay) {
  const BodyModel& body = BuiltinBody();
  VectorXd betas(10);
  betas << 0.3, -0.5, 0.8, 0.1, -0.2, 0.4, 0, 0.2, -0.1, 0.3;
  const double before = StatureOf(body, betas);
  for (const double size : {0.82, 0.95, 1.07}) {
    const VectorXd other = WithStature(body, betas, size * before);
    EXPECT_NEAR(StatureOf(body, other), size * before, 1e-9);
    const MatrixX3d expected = size * Shape(body, betas), got = Shape(body, other);
    const double off = (got - expected).rowwise().norm().mean(),
                 moved = (expected - Shape(body, betas)).rowwise().norm().mean();
    EXPECT_LT(off, 0.1 * moved) << size;
  }
  EXPECT_TRUE(WithStature(body, betas, before).isApprox(betas, 1e-9));
}

TEST(Stature, OneIsOneHundredPerCent) {
  const BodyModel& body = BuiltinBody();
  const MatrixX3d mean = Shape(body, VectorXd::Zero(10)), larger = Shape(body, 0.1 * SizeDirection(body, 10));
  EXPECT_NEAR(larger.norm() / mean.norm(), 1.1, 0.002);
}

TEST(Stature, WithoutComponentsOrWithNoneThatGrowsNothingChanges) {
  EXPECT_EQ(WithStature(BuiltinBody(), VectorXd(), 1.5).size(), 0);
  BodyModelData data = ToyBodyData();
  data.shapedirs.setZero();
  const BodyModel rigid(data);
  const VectorXd betas = VectorXd::Ones(rigid.num_betas());
  EXPECT_EQ(WithStature(rigid, betas, 1.5), betas);
}

TEST(Stature, WhatIsAssumedIsWhatIsGivenOrTheMeanBodys) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  EXPECT_NEAR(AssumedStature(input), StatureOf(BuiltinBody(), VectorXd::Zero(1)), 1e-12);
  input.stature_m = 1.5;
  EXPECT_EQ(AssumedStature(input), 1.5);
}

}  // namespace
}  // namespace bodyloom::stature_test
