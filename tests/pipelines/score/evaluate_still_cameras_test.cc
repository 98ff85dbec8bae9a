// SPDX-License-Identifier: Apache-2.0
// Tracks against sequences in the form of RICH's and Human3.6M's: the numbers are those against the same motion as a
// track.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/human36m_evaluation.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/track_io.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/score/evaluate_track.h"
#include "tests/data_tools/datasets/still_camera_files.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::evaluate_still_cameras_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A person in the camera's frame, whose image is twice its principal point.
Track Truth(int fps) {
  Track track = ShortTrack(fps);
  track.joints.clear();
  track.coco17.clear();
  track.joint_sigma.resize(0, 0);
  track.world.reset();
  track.motion.betas = Eigen::VectorXd::Zero(10);
  track.motion.poses = RowMatrixXd(track.motion.poses.leftCols(72));
  track.motion.poses.rightCols(6).setZero();
  track.camera.cx = 160, track.camera.cy = 120;
  for (int t = 0; t < track.num_frames(); ++t) track.motion.timestamps[size_t(t)] = double(t) / fps;
  return track;
}

/// The same with errors of pose and place.
Track Estimate(const Track& truth) {
  Track track = truth;
  for (int t = 0; t < track.num_frames(); ++t) {
    track.motion.poses(t, 12) += 0.2;
    track.motion.trans(t, 0) += 0.05 + 0.002 * t;
  }
  track.motion.betas[0] += 0.5;
  return track;
}

/// The camera's place in the world of a data set, with the intrinsics of the track.
NamedCamera Placed(const Track& track) {
  NamedCamera camera = RoomCamera();
  camera.camera = track.camera;
  return camera;
}

Motion InWorld(const Track& track) {
  const CameraPose world_from_camera = Inverse(RoomCamera().pose);
  return MovedMotion(BuiltinBody(), track.motion, {&world_from_camera, 1});
}

class EvaluateStillCameras : public ::testing::Test {
 protected:
  void WriteEstimate(const Track& truth) {
    request_.track = folder_ / "track.npz";
    WriteTrack(request_.track, Estimate(truth));
  }
  Evaluation Run() {
    PipelineCallbacks callbacks;
    callbacks.message = [this](const std::string& text) { said_.push_back(text); };
    return EvaluateTrack(request_, callbacks);
  }
  void ExpectNumbersOf(const Track& truth, const Evaluation& read) {
    EvaluateTrackRequest request;
    request.track = request_.track;
    request.truth = folder_ / "truth.npz";
    WriteTrack(request.truth, truth);
    const Evaluation track = EvaluateTrack(request);
    for (const char* name :
         {"pa_mpjpe_mm", "mpjpe_mm", "pve_mm", "accel_err_ms2", "root_err_mm", "projection_mean_px"}) {
      EXPECT_NEAR(read.Value(name), track.Value(name), 1e-6 * (1 + std::abs(track.Value(name)))) << name;
    }
  }

  const ScratchFolder folder_;
  EvaluateTrackRequest request_;
  std::vector<std::string> said_;
};

TEST_F(EvaluateStillCameras, RichGivesTheNumbersOfTheSameTrack) {
  const Track truth = Truth(30);
  WriteEstimate(truth);
  const Motion world = InWorld(truth);
  Motion other = world;
  other.trans.array() += 3;
  request_.truth = folder_ / "Gym_010_012_train";
  for (int t = 0; t < truth.num_frames(); ++t) {
    const std::string frame = request_.truth + "/" + std::to_string(10000 + t);
    std::filesystem::create_directories(frame);
    WriteFileAtomically(frame + "/010.pkl", RichPickle(other, t));
    WriteFileAtomically(frame + "/012.pkl", RichPickle(world, t));
  }
  WriteFileAtomically(folder_ / "002.xml", RichXml(Placed(truth)));
  EXPECT_THAT([&] { Run(); }, ThrowsMessage<RequestError>(HasSubstr("give them, --cameras")));
  request_.cameras = folder_.path();
  request_.view = "2";
  request_.true_person = 1;
  const Evaluation rich = Run();
  EXPECT_EQ(rich.protocol, "rich");
  EXPECT_EQ(rich.frames, truth.num_frames());
  EXPECT_GT(rich.Value("pa_mpjpe_mm"), 5);
  EXPECT_GT(rich.Value("rte_percent"), 1);
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_THAT(said_[0], HasSubstr("of SMPL-X's subject 012's body"));
  ExpectNumbersOf(truth, rich);
  request_.true_person = 0;
  EXPECT_GT(Run().Value("root_err_mm"), 1000);
}

TEST_F(EvaluateStillCameras, JointsOfHuman36mInBothForms) {
  const Track truth = Truth(50);
  WriteEstimate(truth);
  std::vector<MatrixX3d> joints;
  const Motion world = InWorld(truth);
  for (int t = 0; t < truth.num_frames(); ++t) {
    MatrixX3d frame = Human36mJoints(BuiltinBody(), world, t, {});
    frame.row(7) = frame.row(9) = frame.row(0);
    joints.push_back(frame);
  }
  request_.truth = folder_ / "Human36M_subject9_joint_3d.json";
  WriteFileAtomically(request_.truth, Human36mJointsJson(joints));
  WriteFileAtomically(folder_ / "Human36M_subject9_camera.json", Human36mCameraJson(RoomCamera(), true));
  request_.sequence = "Directions/1";
  request_.view = "1";
  const Evaluation json = Run();
  EXPECT_EQ(json.protocol, "h36m");
  EXPECT_EQ(json.frames, truth.num_frames());
  EXPECT_GT(json.Value("pa_mpjpe_mm"), 2);
  EXPECT_LT(json.Value("pa_mpjpe_mm"), json.Value("mpjpe_mm"));
  EXPECT_GT(json.Value("root_err_mm"), 50);
  EXPECT_GT(json.Value("wa_mpjpe_100_mm"), 1);
  EXPECT_GT(json.Value("rte_percent"), 0.1);

  request_.truth = folder_ / "data_3d_h36m.npz";
  WriteFileAtomically(request_.truth, Human36mPositionsNpz(joints));
  request_.sequence = "S9/Directions 1";
  EXPECT_THAT([&] { Run(); }, ThrowsMessage<RequestError>(HasSubstr("give them, --cameras")));
  request_.cameras = folder_ / "Human36M_subject9_camera.json";
  const Evaluation npz = Run();
  for (const EvaluationValue& value : json.values) {
    if (!std::isfinite(value.value)) continue;
    EXPECT_NEAR(npz.Value(value.name), value.value, 1e-5 * (1 + std::abs(value.value))) << value.name;
  }
  // The estimate is the truth: none of its joints is off.
  WriteTrack(request_.track, truth);
  EXPECT_NEAR(Run().Value("mpjpe_mm"), 0, 1e-3);

  const int V = BuiltinBody().num_vertices();
  RowMatrixXd regressor = RowMatrixXd::Zero(17, V);
  for (int j = 0; j < 17; ++j) regressor(j, 100 * j) = 1;
  request_.joint_regressor = folder_ / "J_regressor_h36m.npy";
  WriteNpy(request_.joint_regressor, NdArray::FromDoubles(regressor.data(), {17, V}));
  EXPECT_GT(Run().Value("mpjpe_17_mm"), 10) << "vertices that are not the joints";
}

TEST_F(EvaluateStillCameras, SmplFitsOfHuman36m) {
  const Track truth = Truth(50);
  WriteEstimate(truth);
  request_.truth = folder_ / "Human36M_subject9_smpl_param.json";
  WriteFileAtomically(request_.truth, Human36mSmplJson(InWorld(truth), 1));
  NamedCamera camera = RoomCamera();
  WriteFileAtomically(folder_ / "Human36M_subject9_camera.json", Human36mCameraJson(camera, false));
  request_.sequence = "2/1";
  const Evaluation smpl = Run();
  EXPECT_EQ(smpl.protocol, "h36m-smpl");
  EXPECT_TRUE(said_.empty()) << "neutral";
  EXPECT_EQ(smpl.frames, truth.num_frames());
  EXPECT_GT(smpl.Value("pve_mm"), 1);
  WriteFileAtomically(request_.truth, Human36mSmplJson(InWorld(truth), 5));
  EXPECT_EQ(Run().frames, (truth.num_frames() + 4) / 5);
}

TEST_F(EvaluateStillCameras, OptionsOfOthersAreRefused) {
  WriteEstimate(Truth(6));
  request_.joint_regressor = folder_ / "none.npy";
  EXPECT_THAT([&] { Run(); }, ThrowsMessage<RequestError>(HasSubstr("--joint-regressor is of motions of data sets")));
  request_.truth = folder_ / "a.json";
  WriteFileAtomically(request_.truth, "{}");
  EXPECT_THAT([&] { Run(); }, ThrowsMessage<std::runtime_error>(HasSubstr("none.npy")));
}

}  // namespace
}  // namespace bodyloom::evaluate_still_cameras_test
