// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/global_errors.h"

#include "data_tools/evaluation/evaluation.h"
#include "geometry/base/check.h"
#include "geometry/math/procrustes.h"

namespace bodyloom {
namespace {

constexpr int kEmdbWindow = 100, kEmdbFirstFrames = 2;

MatrixX3d MovedBySimilarity(const MatrixX3d& points, const MatrixX3d& fitted, const MatrixX3d& target) {
  return AlignPoints(fitted, target).target_from_source.Apply(points);
}

}  // namespace

MatrixX3d StackedFrames(std::span<const MatrixX3d> frames) {
  const Eigen::Index joints = frames.front().rows();
  MatrixX3d all(joints * static_cast<Eigen::Index>(frames.size()), 3);
  for (size_t t = 0; t < frames.size(); ++t) all.middleRows(joints * static_cast<Eigen::Index>(t), joints) = frames[t];
  return all;
}

double WindowError(const std::vector<MatrixX3d>& joints, const std::vector<MatrixX3d>& true_joints, int fitted_frames,
                   const FittedMotion& moved) {
  double sum = 0;
  int windows = 0;
  for (size_t begin = 0; begin + kEmdbWindow <= joints.size(); begin += kEmdbWindow, ++windows) {
    const MatrixX3d x = StackedFrames(std::span(joints).subspan(begin, kEmdbWindow));
    const MatrixX3d g = StackedFrames(std::span(true_joints).subspan(begin, kEmdbWindow));
    const Eigen::Index rows = joints[begin].rows() * static_cast<Eigen::Index>(fitted_frames);
    sum += (moved(x, MatrixX3d(x.topRows(rows)), MatrixX3d(g.topRows(rows))) - g).rowwise().norm().mean();
  }
  return windows == 0 ? kNotMeasured : sum / windows;
}

GlobalErrors MeasureGlobalErrors(const std::vector<MatrixX3d>& joints, const std::vector<MatrixX3d>& true_joints,
                                 const MatrixX3d& roots, const MatrixX3d& true_roots) {
  const auto T = static_cast<Eigen::Index>(joints.size());
  BODYLOOM_CHECK(joints.size() == true_joints.size() && roots.rows() == T && true_roots.rows() == T,
                 "global errors: ", T, " frames of joints, ", true_joints.size(), " true ones, ", roots.rows(), " and ",
                 true_roots.rows(), " roots");
  for (Eigen::Index t = 0; t < T; ++t) {
    BODYLOOM_CHECK(joints[t].rows() == joints[0].rows() && true_joints[t].rows() == joints[0].rows(),
                   "global errors: frame ", t, " has ", joints[t].rows(), " joints and ", true_joints[t].rows(),
                   " true ones, expected ", joints[0].rows());
  }
  GlobalErrors errors;
  errors.w_mpjpe_100_m = WindowError(joints, true_joints, kEmdbFirstFrames, MovedBySimilarity);
  errors.wa_mpjpe_100_m = WindowError(joints, true_joints, kEmdbWindow, MovedBySimilarity);
  errors.rte = kNotMeasured;
  if (T < 2) return errors;
  AlignmentOptions rigid;
  rigid.estimate_scale = false;
  const MatrixX3d moved = AlignPoints(roots, true_roots, rigid).target_from_source.Apply(roots);
  const double path = (true_roots.bottomRows(T - 1) - true_roots.topRows(T - 1)).rowwise().norm().sum();
  if (path > 0) errors.rte = (moved - true_roots).rowwise().norm().mean() / path;
  return errors;
}

}  // namespace bodyloom
