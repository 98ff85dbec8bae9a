// SPDX-License-Identifier: Apache-2.0
#include "tracking/lifter/lifter_reading.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tracking/lifter/lifter_input.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Index of the mirrored landmark: left and right exchanged.
int MirroredPoint(int k) { return k == kLifterNose ? k : ((k - 1) ^ 1) + 1; }
int MirroredLimb(int limb) { return limb ^ 1; }

/// One run's output of one frame; a mirrored run is mirrored back.
class OutputReader {
 public:
  OutputReader(const RowMatrixXf& output, Eigen::Index row, bool mirrored)
      : y_(output.row(row).data()), mirrored_(mirrored) {}

  [[nodiscard]] Vector3d TorsoPoint(int i) const { return PointAt(LifterOutput::TorsoOffset(TorsoIndex(i))); }
  [[nodiscard]] Vector2d TorsoSigma(int i) const { return SigmaAt(LifterOutput::TorsoOffset(TorsoIndex(i))); }
  [[nodiscard]] Vector3d Up() const { return PointAt(LifterOutput::kUp); }
  [[nodiscard]] double UpSigma() const { return Sigma(y_[LifterOutput::kUp + 3]); }
  [[nodiscard]] double Contact(int side) const {
    return 1 / (1 + std::exp(-double{y_[LifterOutput::kContact + (mirrored_ ? 1 - side : side)]}));
  }
  [[nodiscard]] std::vector<LiftedLimb> Limb(int limb) const {
    const int from = mirrored_ ? MirroredLimb(limb) : limb;
    const float* logits = y_ + LifterOutput::LogitOffset(from);
    const float largest = *std::max_element(logits, logits + LifterOutput::kHypotheses);
    std::vector<LiftedLimb> result(LifterOutput::kHypotheses);
    double sum = 0;
    for (int m = 0; m < LifterOutput::kHypotheses; ++m) sum += result[m].weight = std::exp(double{logits[m] - largest});
    for (int m = 0; m < LifterOutput::kHypotheses; ++m) {
      result[m].weight /= sum;
      result[m].points.fill(Vector3d::Zero());
      result[m].sigma.fill(Vector2d::Zero());
      for (size_t i = 0; i < LifterOutput::LimbPoints(limb).size(); ++i) {
        const int offset = LifterOutput::PointOffset(from, m, static_cast<int>(i));
        result[m].points[i] = PointAt(offset);
        result[m].sigma[i] = SigmaAt(offset);
      }
    }
    return result;
  }

 private:
  // The range that training clamps to (neural/lifter/lifter_module.cc).
  static double Sigma(float log_sigma) { return std::exp(std::clamp(double{log_sigma}, -5.0, 1.0)); }
  [[nodiscard]] int TorsoIndex(int i) const {
    if (!mirrored_) return i;
    const int point = MirroredPoint(LifterOutput::kTorso[i]);
    return static_cast<int>(std::find(LifterOutput::kTorso.begin(), LifterOutput::kTorso.end(), point) -
                            LifterOutput::kTorso.begin());
  }
  [[nodiscard]] Vector3d PointAt(int offset) const {
    return {mirrored_ ? -y_[offset] : y_[offset], y_[offset + 1], y_[offset + 2]};
  }
  [[nodiscard]] Vector2d SigmaAt(int offset) const { return {Sigma(y_[offset + 3]), Sigma(y_[offset + 4])}; }

  const float* y_;
  bool mirrored_;
};

}  // namespace

RowMatrixXf MirrorFeatures(const RowMatrixXf& features) {
  RowMatrixXf result = features;
  for (int k = 0; k < kLifterPoints; ++k) {
    const int from = MirroredPoint(k);
    result.col(3 * k) = -features.col(3 * from);
    result.middleCols(3 * k + 1, 2) = features.middleCols(3 * from + 1, 2);
  }
  const int motion = 3 * kLifterPoints + 3;
  result.col(motion) = -features.col(motion);
  const int bones = motion + 2;
  for (int b = 0; b < kLifterBones; ++b) {
    result.middleCols(bones + 2 * b, 2) = features.middleCols(bones + 2 * MirroredLifterBone(b), 2);
  }
  return result;
}

void TurnLandmarks(const Eigen::Matrix3d& turn, LiftedFrame* frame) {
  frame->points = (frame->points * turn.transpose()).eval();
  for (auto& limb : frame->limbs) {
    for (LiftedLimb& guess : limb) {
      for (Eigen::Vector3d& point : guess.points) point = turn * point;
    }
  }
}

void SetLimb(int limb, const LiftedLimb& guess, LiftedFrame* frame) {
  const auto points = LifterOutput::LimbPoints(limb);
  for (size_t i = 0; i < points.size(); ++i) {
    frame->points.row(points[i]) = guess.points[i].transpose();
    frame->sigma.row(points[i]) = guess.sigma[i].transpose();
  }
}

LiftedLimb MeanLimb(const std::vector<LiftedLimb>& guesses, const Matrix3d& camera_from_virtual) {
  LiftedLimb mean;
  mean.weight = 1;
  for (size_t i = 0; i < mean.points.size(); ++i) {
    Vector3d& point = mean.points[i] = Vector3d::Zero();
    for (const LiftedLimb& guess : guesses) point += guess.weight * guess.points[i];
    Vector2d squared = Vector2d::Zero();
    for (const LiftedLimb& guess : guesses) {
      const Vector3d off = camera_from_virtual.transpose() * (guess.points[i] - point);
      const Vector2d spread(0.5 * off.head<2>().squaredNorm(), off.z() * off.z());
      squared += guess.weight * (guess.sigma[i].cwiseAbs2() + 0.25 * spread);
    }
    mean.sigma[i] = squared.cwiseSqrt();
  }
  return mean;
}

LiftedFrame ReadLifter(const RowMatrixXf& plain, const RowMatrixXf& mirrored, Eigen::Index row,
                       const Matrix3d& camera_from_virtual) {
  std::vector<OutputReader> runs = {OutputReader(plain, row, false)};
  if (mirrored.rows() > 0) runs.emplace_back(mirrored, row, true);
  LiftedFrame frame;
  frame.camera_from_virtual = camera_from_virtual;
  frame.points.setZero(kLifterPoints, 3);
  frame.sigma.setZero(kLifterPoints, 2);
  const double share = 1.0 / static_cast<double>(runs.size());
  Vector3d up = Vector3d::Zero();
  frame.up_sigma = 0;
  for (const OutputReader& run : runs) {
    for (size_t i = 0; i < LifterOutput::kTorso.size(); ++i) {
      const int index = static_cast<int>(i);
      frame.points.row(LifterOutput::kTorso[i]) += share * (camera_from_virtual * run.TorsoPoint(index)).transpose();
      frame.sigma.row(LifterOutput::kTorso[i]) += share * run.TorsoSigma(index).transpose();
    }
    up += run.Up();
    frame.up_sigma += share * run.UpSigma();
    for (int side = 0; side < 2; ++side) frame.contact[side] += share * run.Contact(side);
    for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
      for (LiftedLimb& guess : run.Limb(limb)) {
        guess.weight *= share;
        for (Vector3d& point : guess.points) point = camera_from_virtual * point;
        frame.limbs[limb].push_back(guess);
      }
    }
  }
  for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
    SetLimb(limb, MeanLimb(frame.limbs[limb], camera_from_virtual), &frame);
  }
  if (up.norm() > 1e-6) frame.up = (camera_from_virtual * up).normalized();
  return frame;
}

double ProbabilityWithin(double radius, const Vector2d& sigma) {
  constexpr int kSteps = 32;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double c = (i + 0.5) / kSteps;
    const double r = radius / std::sqrt(sigma[0] * sigma[0] * (1 - c * c) + sigma[1] * sigma[1] * c * c);
    sum += 1 - std::exp(-r) * (1 + r + 0.5 * r * r);
  }
  return sum / kSteps;
}

}  // namespace bodyloom
