// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/hand_prior.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/base/hash_random.h"

namespace bodyloom {
namespace {

using AngleMatrix = Eigen::Matrix<double, kHandAngles, kHandAngles>;

constexpr int kPriorHands = 8192, kThumbOfPrior = 4;
constexpr double kPriorDegree = M_PI / 180, kFloor_rad = 3 * kPriorDegree;

/// The point at `share` of the inner `part` of a range.
double Within(const AngleRange& range, double part, double share) {
  const double middle = 0.5 * (range.low + range.high), half = 0.5 * part * (range.high - range.low);
  return middle + half * (2 * share - 1);
}

HandAngleVector SampleHand(int sample) {
  HashRandom random(7, {static_cast<uint64_t>(sample)});
  const std::array<FingerJointRange, kHandJoints>& ranges = HandJointRanges();
  HandAngleVector angles = HandAngleVector::Zero();
  const auto put = [&](int joint, int axis, const AngleRange& range, double value) {
    angles[3 * joint + axis] = std::clamp(value, range.low, range.high);
  };
  const double grip = random.Uniform();
  for (int f = 0; f < kThumbOfPrior; ++f) {
    const double closed = (grip + 2 * random.Uniform()) / 3;
    const double knuckle = 0.5 * closed + 0.5 * random.Uniform();
    const double pip = kPriorDegree * (5 + 95 * closed);
    const double dip = kDipByPip * pip + 8 * kPriorDegree * random.Normal();
    const double sideways = random.Uniform();
    const FingerJointRange& first = ranges[size_t(3 * f)];
    put(3 * f, 0, first.flexion, kPriorDegree * (-10 + 90 * knuckle));
    put(3 * f, 1, first.radial, (1 - closed) * Within(first.radial, 2.0 / 3, sideways));
    put(3 * f + 1, 0, ranges[size_t(3 * f + 1)].flexion, pip);
    put(3 * f + 2, 0, ranges[size_t(3 * f + 2)].flexion, dip);
  }
  for (int j = 3 * kThumbOfPrior; j < kHandJoints; ++j) {
    const double share = 0.5 * grip + 0.5 * random.Uniform();
    put(j, 0, ranges[size_t(j)].flexion, Within(ranges[size_t(j)].flexion, 0.8, share));
  }
  const AngleRange& palmar = ranges[size_t(3 * kThumbOfPrior)].radial;
  put(3 * kThumbOfPrior, 1, palmar, Within(palmar, 0.8, random.Uniform()));
  return angles;
}

HandPrior MakeHandPrior() {
  HandPrior prior;
  prior.mean.setZero();
  AngleMatrix covariance = AngleMatrix::Zero();
  for (int s = 0; s < kPriorHands; ++s) {
    const HandAngleVector x = SampleHand(s);
    prior.mean += x / kPriorHands;
    covariance += x * x.transpose() / kPriorHands;
  }
  covariance -= prior.mean * prior.mean.transpose();
  covariance.diagonal().array() += kFloor_rad * kFloor_rad;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  prior.components = solver.eigenvectors().rowwise().reverse();
  prior.sigma = solver.eigenvalues().reverse().cwiseSqrt();
  return prior;
}

}  // namespace

const HandPrior& BuiltinHandPrior() {
  static const HandPrior prior = MakeHandPrior();
  return prior;
}

}  // namespace bodyloom
