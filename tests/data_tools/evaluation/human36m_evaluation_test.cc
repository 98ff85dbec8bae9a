// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/human36m_evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "data_tools/formats/npz.h"
#include "geometry/scene/camera_path.h"
#include "tests/data_tools/datasets/still_camera_files.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/short_track.h"

namespace bodyloom::human36m_evaluation_test {
namespace {

using ::testing::HasSubstr;

constexpr int kFps = 50;

/// Joints of the track in the world of the camera; those without a place are at the hips.
std::vector<MatrixX3d> JointsInWorld(const Track& track, const RowMatrixXd& regressor = {}) {
  std::vector<MatrixX3d> joints;
  for (int t = 0; t < track.num_frames(); ++t) {
    MatrixX3d frame = Human36mJoints(BuiltinBody(), track.motion, t, regressor);
    for (Eigen::Index j = 0; j < frame.rows(); ++j) {
      if (!frame.row(j).allFinite()) frame.row(j) = frame.row(0);
    }
    joints.push_back(MovedPoints(Inverse(RoomCamera().pose), frame));
  }
  return joints;
}

Evaluation Evaluate(const Track& track, const std::vector<MatrixX3d>& joints, const RowMatrixXd& regressor = {}) {
  std::vector<int> frames(size_t(track.num_frames()));
  std::iota(frames.begin(), frames.end(), 0);
  return EvaluateHuman36m(track, joints, frames, RoomCamera().pose, BuiltinBody(), regressor);
}

/// Each joint is the mean of three vertices.
RowMatrixXd Regressor() {
  const int V = BuiltinBody().num_vertices();
  RowMatrixXd regressor = RowMatrixXd::Zero(17, V);
  for (int j = 0; j < 17; ++j) {
    for (const int k : {0, 1, 2}) regressor(j, (911 * j + 37 * k) % V) = 1.0 / 3;
  }
  return regressor;
}

TEST(Human36mEvaluation, TheTruthItselfHasNoError) {
  const Track track = ShortTrack(kFps);
  const Evaluation same = Evaluate(track, JointsInWorld(track));
  EXPECT_EQ(same.protocol, "h36m");
  EXPECT_EQ(same.frames, track.num_frames());
  for (const char* name : {"mpjpe_mm", "pa_mpjpe_mm", "root_err_mm", "w_mpjpe_100_mm", "wa_mpjpe_100_mm"}) {
    EXPECT_NEAR(same.Value(name), 0, 1e-6) << name;
  }
  EXPECT_NEAR(same.Value("accel_err_ms2"), 0, 1e-6);
  EXPECT_GT(same.Value("gt_accel_ms2"), 0.1);
  EXPECT_THROW((void)same.Value("mpjpe_17_mm"), std::invalid_argument) << "the body has no joint for spine and nose";
  ASSERT_EQ(same.breakdowns.size(), 1U);
  EXPECT_EQ(same.breakdowns[0].labels.size(), 14U);
}

TEST(Human36mEvaluation, ErrorsOfKnownSize) {
  const Track track = ShortTrack(kFps);
  std::vector<MatrixX3d> joints = JointsInWorld(track);
  for (MatrixX3d& frame : joints) frame(13, 2) += 0.14;  // the left wrist; the nose counts for nothing
  for (MatrixX3d& frame : joints) frame(9, 2) += 5;
  Evaluation off = Evaluate(track, joints);
  EXPECT_NEAR(off.Value("mpjpe_mm"), 10, 1e-6);
  EXPECT_NEAR(off.breakdowns[0].values[10], 140, 1e-6);
  EXPECT_EQ(off.breakdowns[0].labels[10], "left_wrist");
  // Another size and place: the similarity takes it away.
  joints = JointsInWorld(track);
  for (MatrixX3d& frame : joints) {
    const Eigen::RowVector3d root = frame.row(0);
    frame = (1.1 * (frame.rowwise() - root)).rowwise() + (root + Eigen::RowVector3d(0.3, 0, 0));
  }
  off = Evaluate(track, joints);
  EXPECT_NEAR(off.Value("pa_mpjpe_mm"), 0, 1e-6);
  EXPECT_GT(off.Value("mpjpe_mm"), 20);
  EXPECT_NEAR(off.Value("root_err_mm"), 300, 1e-6);
}

TEST(Human36mEvaluation, FramesThatAreNotToldAreLeftOut) {
  const Track track = ShortTrack(kFps);
  std::vector<MatrixX3d> joints = JointsInWorld(track);
  joints[3].resize(0, 3);
  EXPECT_EQ(Evaluate(track, joints).frames, track.num_frames() - 1);
  for (MatrixX3d& frame : joints) frame.resize(0, 3);
  EXPECT_THROW(Evaluate(track, joints), std::invalid_argument);
}

TEST(Human36mEvaluation, JointsOfTheRegressor) {
  const Track track = ShortTrack(6);
  const RowMatrixXd regressor = Regressor();
  const std::vector<MatrixX3d> joints = JointsInWorld(track, regressor);
  const Evaluation same = Evaluate(track, joints, regressor);
  EXPECT_NEAR(same.Value("mpjpe_mm"), 0, 1e-6);
  EXPECT_NEAR(same.Value("mpjpe_17_mm"), 0, 1e-6);
  EXPECT_GT(Evaluate(track, joints).Value("mpjpe_mm"), 50) << "the body's own joints are elsewhere";
  Evaluation added;
  std::vector<int> source(size_t(track.num_frames()));
  std::iota(source.begin(), source.end(), 0);
  Track other = track;
  other.motion.trans.array() += 1;
  AddRegressedJoints(other, source, track, BuiltinBody(), BuiltinBody(), regressor, &added);
  EXPECT_NEAR(added.Value("lsp14_mpjpe_mm"), 0, 1e-6) << "moved onto the root";
  other.motion.poses.col(12).array() += 0.5;
  added = {};
  AddRegressedJoints(other, source, track, BuiltinBody(), BuiltinBody(), regressor, &added);
  EXPECT_GT(added.Value("lsp14_pa_mpjpe_mm"), 1);
}

TEST(Human36mEvaluation, RegressorsOfOtherBodiesAreRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.File("J_regressor_h36m.npy");
  RowMatrixXd regressor = Regressor();
  WriteNpy(path, NdArray::FromDoubles(regressor.data(), {17, regressor.cols()}));
  EXPECT_EQ(ReadJointRegressor(path, BuiltinBody()), regressor);
  regressor(4, 0) += 0.5;
  WriteNpy(path, NdArray::FromDoubles(regressor.data(), {17, regressor.cols()}));
  EXPECT_THAT(FileErrorOf(path, [&] { ReadJointRegressor(path, BuiltinBody()); }), HasSubstr("row 4 has the sum 1.5"));
  WriteNpy(path, NdArray::FromDoubles(regressor.data(), {17, 6890}));
  EXPECT_THAT(FileErrorOf(path, [&] { ReadJointRegressor(path, BuiltinBody()); }), HasSubstr("17x6890, expected 17x"));
}

}  // namespace
}  // namespace bodyloom::human36m_evaluation_test
