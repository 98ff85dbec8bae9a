// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/chain/chain_problem.h"
#include "tracking/terms/landmarks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/support/sequence_scene.h"

namespace bodyloom::chain_problem_test {
namespace {

using Eigen::VectorXd;

/// Output of Linearise() for factorisation and marginalisation, and the cost.
struct System {
  double cost = 0;
  VectorXd gradient, diagonal, shared_gradient;
  Eigen::MatrixXd shared;
  ChainPrior prior;
  explicit System(ChainProblem* chain, const ChainPoint& x)
      : cost(chain->Linearise(x)),
        gradient(chain->gradient()),
        diagonal(chain->diagonal()),
        shared_gradient(chain->shared_gradient()),
        shared(chain->shared()) {
    EXPECT_TRUE(chain->Marginalise(x, &prior));
  }
  friend bool operator==(const System& a, const System& b) {
    return a.cost == b.cost && a.gradient == b.gradient && a.diagonal == b.diagonal &&
           a.shared_gradient == b.shared_gradient && a.shared == b.shared && a.prior.M == b.prior.M &&
           a.prior.m == b.prior.m;
  }
};

/// A point that is linearised again may be taken from memory. Whatever happened in between, what comes out is what a
/// problem that has no memory gives.
TEST(ChainProblem, LinearisedAgainAfterAnyChangeItIsTheSameAsAnew) {
  const auto scene = MakeSequenceScene({});
  SequenceProblem problem = scene->problem;
  ChainProblem chain(problem, false, false, 2);
  const ChainPoint x(problem.states, problem);
  const VectorXd step = VectorXd::Constant(static_cast<Eigen::Index>(x.states.size()) * chain.frame_size(), 0.01);
  ChainPoint y;
  chain.Plus(x, step, VectorXd::Constant(chain.shared_size(), 0.01), &y);
  const auto from_scratch = [&](const ChainPoint& at) {
    ChainProblem other(problem, false, false, 2);
    return System(&other, at);
  };
  const System first(&chain, x), second(&chain, x);
  EXPECT_TRUE(first == from_scratch(x) && second == first);
  chain.Cost(y);
  EXPECT_TRUE(System(&chain, x) == first) << "after the cost elsewhere";
  EXPECT_FALSE(System(&chain, y) == first);
  EXPECT_TRUE(System(&chain, x) == first) << "after another point";

  problem.frames[2].Get<LandmarkTerm>().seen.resize(3);
  chain.Forget(2);
  const System fewer(&chain, x);
  EXPECT_FALSE(fewer == first) << "other observations";
  EXPECT_TRUE(fewer == from_scratch(x));

  problem.cut_before[3] = 1;
  chain.Moved(0);
  const System cut(&chain, x);
  EXPECT_FALSE(cut == fewer) << "a cut";
  EXPECT_TRUE(cut == from_scratch(x));

  problem.shape_prior.weight *= 2;
  chain.Moved(0);
  const System stiff(&chain, x);
  EXPECT_FALSE(stiff == cut) << "another shape prior";
  EXPECT_TRUE(stiff == from_scratch(x));

  chain.SetPrior(&stiff.prior);
  EXPECT_FALSE(System(&chain, x) == stiff) << "a prior";
  chain.SetPrior(nullptr);
  EXPECT_TRUE(System(&chain, x) == stiff) << "the prior taken away";
}

/// While frames are frozen, what is evaluated beside the moving ones is what a problem that evaluates everything gives,
/// to the last bit.
TEST(ChainProblem, FrozenFramesChangeNothingButTheWork) {
  SequenceSceneOptions options;
  options.frames = 16;
  const auto scene = MakeSequenceScene(options);
  const SequenceProblem& problem = scene->problem;
  ChainProblem chain(problem, false, false, 2);
  const ChainPoint x(problem.states, problem);
  EXPECT_THROW(chain.SetFrozen(std::vector<char>(16, 1)), std::invalid_argument) << "not linearised yet";
  chain.Linearise(x);
  EXPECT_THROW(chain.SetFrozen(std::vector<char>(15, 1)), std::invalid_argument);
  std::vector<char> frozen(16, 1);
  for (const int t : {0, 6, 7, 13}) frozen[t] = 0;
  chain.SetFrozen(frozen);
  const int n = chain.frame_size();
  const VectorXd step = VectorXd::Constant(16 * n, 0.02), none = VectorXd::Zero(chain.shared_size());
  ChainPoint y;
  chain.Plus(x, step, none, &y);
  for (int t = 0; t < 16; ++t) {
    EXPECT_EQ(y.states[t].translation == x.states[t].translation, frozen[t] != 0) << t;
  }
  ChainProblem other(problem, false, false, 2);
  EXPECT_EQ(chain.Cost(y), other.Cost(y));
  EXPECT_EQ(chain.num_skipped(), 12);
  EXPECT_EQ(chain.Linearise(y), other.Linearise(y));
  EXPECT_EQ(chain.gradient(), other.gradient());
  EXPECT_EQ(chain.diagonal(), other.diagonal());
  for (int t = 0; t + 1 < 16; ++t) {
    EXPECT_TRUE(std::equal(chain.Next(t), chain.Next(t) + 3 * n, other.Next(t))) << t;
    EXPECT_TRUE(std::equal(chain.Second(t), chain.Second(t) + 3 * n, other.Second(t))) << t;
  }
  EXPECT_EQ(chain.Linearise(x), other.Linearise(x)) << "back again";
  EXPECT_EQ(chain.gradient(), other.gradient());
  chain.SetFrozen({});
  EXPECT_EQ(chain.shared(), other.shared());
  EXPECT_EQ(chain.shared_gradient(), other.shared_gradient());
  // Released where only the cost is known, the next linearisation makes everything.
  chain.SetFrozen(frozen);
  chain.Cost(y);
  chain.SetFrozen({});
  EXPECT_EQ(chain.Linearise(y), other.Linearise(y));
  EXPECT_EQ(chain.shared(), other.shared());
}

}  // namespace
}  // namespace bodyloom::chain_problem_test
