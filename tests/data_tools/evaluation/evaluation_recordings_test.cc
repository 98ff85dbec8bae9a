// SPDX-License-Identifier: Apache-2.0
// The protocols on real recordings, where they are present, against an independent scorer and known noise floors.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/triangulated_clip.h"
#include "data_tools/formats/npz.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"

namespace bodyloom::evaluation_recordings_test {
namespace {

const std::string kShared = SharedDir();
const std::string kAist = kShared + "/data/aistpp";
const char* const kSequences[] = {"gBR_sBM_cAll_d06_mBR2_ch06", "gJS_sBM_cAll_d03_mJS2_ch07"};

std::string OutputOf(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> buffer{};
  while (pipe && fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) text += buffer.data();
  return text;
}

/// A track as a tracker might leave it: the reference in the view's camera frame, smaller, nearer, wobbling, with noise
/// and with frames missing at the beginning, in the middle (an even gap: a tie) and at the end.
Track FaultyTrack(const MultiViewClip& clip, const std::string& view, int num_frames) {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  Track track;
  for (const RigView& v : clip.views) {
    if (v.name != view) continue;
    track.camera = v.camera;
    for (int t = 0; t < num_frames; ++t) {
      const Eigen::Matrix3d turn = RotationFromAxisAngle({0.1 * std::sin(0.05 * t), 0.3, 0.05});
      MatrixX3d points = (clip.coco17_in_world[t] * v.pose.camera_from_world_rotation.transpose()).rowwise() +
                         v.pose.camera_from_world_translation.transpose();
      const Eigen::RowVector3d hip = points.middleRows(11, 2).colwise().mean();
      points = (0.9 * (points.rowwise() - hip) * turn.transpose()).rowwise() + 0.95 * hip;
      for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] += 0.02 * normal(rng);
      if (t < 3 || (t >= 200 && t < 205) || t == 300 || t > num_frames - 5) points.setConstant(NAN);
      track.coco17.push_back(points);
    }
  }
  track.motion.poses = RowMatrixXd::Zero(num_frames, 72);
  track.motion.trans = MatrixX3d::Zero(num_frames, 3);
  return track;
}

void WriteCoco17(const std::string& path, const Track& track) {
  std::vector<double> values;
  for (const MatrixX3d& frame : track.coco17) values.insert(values.end(), frame.data(), frame.data() + frame.size());
  WriteNpz(path, {{"coco17", NdArray::FromDoubles(values.data(), {static_cast<int64_t>(track.coco17.size()), 17, 3})}});
}

TEST(EvaluationRecordingsTest, AistAgreesWithTheIndependentScorer) {
  const std::string scorer = kShared + "/tools/score_aist.py";
  if (!std::filesystem::exists(kAist) || !std::filesystem::exists(scorer)) {
    GTEST_SKIP() << "no AIST++ recordings or scorer in " << kShared;
  }
  if (OutputOf("/usr/bin/python3 -c 'import numpy; print(1)' 2>/dev/null") != "1\n") {
    GTEST_SKIP() << "no numpy for /usr/bin/python3";
  }
  TemporaryFolder folder;
  int compared = 0;
  for (const char* sequence : kSequences) {
    const MultiViewClip clip = ReadAistClip(kAist, kAist + "/cameras", sequence);
    ASSERT_EQ(clip.views.size(), 9u);
    // SMPL's origin lies about 0.3 m above the hips; scaling is cm a metre of SMPL's body.
    const Eigen::RowVector3d hip = clip.coco17_in_world[0].middleRows(11, 2).colwise().mean();
    EXPECT_LT((0.9 * clip.motion.trans.row(0) - hip).norm(), 0.6);
    for (const auto& [view, frames] : {std::pair<std::string, int>{"c01", 576}, {"c05", 400}}) {
      const Track track = FaultyTrack(clip, view, frames);
      const std::string path = folder.File("track.npz");
      WriteCoco17(path, track);
      const nlohmann::json expected = nlohmann::json::parse(OutputOf(
          "/usr/bin/python3 " + scorer + " " + path + " " + kAist + " " + kAist + "/cameras " + sequence + " " + view));
      const Evaluation e = EvaluateAist(track, clip, view);
      EXPECT_EQ(e.frames, expected["frames"].get<int>());
      EXPECT_EQ(e.frames_without_result, expected["frames_without_result"].get<int>());
      EXPECT_EQ(e.frames_without_result, 13);
      for (const char* name :
           {"clip_scale", "mpjpe_mm", "mpjpe_scaled_mm", "pa_mpjpe_mm", "pa_p95_mm", "accel_err_ms2", "gt_accel_ms2",
            "root_err_mm", "heldout_median_px", "heldout_p95_px", "fitview_median_px", "fitview_p95_px"}) {
        // The scorer prints three decimals; half a unit of the last, and rounding of the sums.
        EXPECT_NEAR(e.Value(name), expected[name].get<double>(), 0.5e-3 + 1e-9)
            << sequence << " " << view << " " << name;
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 48);
}

TEST(EvaluationRecordingsTest, RoomErrorsAgreeWithTheIndependentScorer) {
  const std::string scorer = kShared + "/tools/score_room.py";
  if (!std::filesystem::exists(kAist) || !std::filesystem::exists(scorer)) {
    GTEST_SKIP() << "no AIST++ recordings or scorer in " << kShared;
  }
  if (OutputOf("/usr/bin/python3 -c 'import numpy; print(1)' 2>/dev/null") != "1\n") {
    GTEST_SKIP() << "no numpy for /usr/bin/python3";
  }
  const std::pair<const char*, const char*> kNames[] = {
      {"room_g_mpjpe_mm", "g_mpjpe"},     {"room_w_mpjpe_mm", "w_mpjpe"},
      {"room_wa_mpjpe_mm", "wa_mpjpe"},   {"tilt_deg", "tilt_deg"},
      {"knee_err_deg", "knee_deg"},       {"ankle_height_err_mm", "ankle_height_abs_mm"},
      {"knee_bias_deg", "knee_bias_deg"}, {"ankle_height_bias_mm", "ankle_height_bias_mm"},
      {"trunk_err_deg", "trunk_deg"}};
  TemporaryFolder folder;
  for (const char* sequence : kSequences) {
    const MultiViewClip clip = ReadAistClip(kAist, kAist + "/cameras", sequence);
    const std::string view = "c05";
    Track track = FaultyTrack(clip, view, 576);
    const CameraPose& pose = clip.views[4].pose;
    ASSERT_EQ(clip.views[4].name, view);
    // A vertical that is off by some degrees, and a ground a little too high.
    const Eigen::Matrix3d off = RotationFromAxisAngle({0.06, 0, 0.04});
    const Eigen::Vector3d centre = -pose.camera_from_world_rotation.transpose() * pose.camera_from_world_translation;
    track.world = WorldOverGround(off * pose.camera_from_world_rotation * Eigen::Vector3d::UnitY(), centre.y() - 0.05);
    std::vector<double> values, world;
    for (const MatrixX3d& points : track.coco17)
      values.insert(values.end(), points.data(), points.data() + points.size());
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 4; ++c) {
        world.push_back(r == 3 ? double(c == 3) : c == 3 ? track.world->translation[r] : track.world->rotation(r, c));
      }
    }
    const std::string path = folder.File("track.npz");
    WriteNpz(path, {{"coco17", NdArray::FromDoubles(values.data(), {576, 17, 3})},
                    {"world_from_camera", NdArray::FromDoubles(world.data(), {4, 4})},
                    {"world_source", NdArray::FromString("given")}});
    const nlohmann::json expected = nlohmann::json::parse(OutputOf(
        "/usr/bin/python3 " + scorer + " " + path + " " + kAist + " " + kAist + "/cameras " + sequence + " " + view));
    const Evaluation e = EvaluateAist(track, clip, view);
    for (const auto& [name, key] : kNames) {
      // The scorer prints two decimals.
      EXPECT_NEAR(e.Value(name), expected[key].get<double>(), 0.5e-2 + 1e-6) << sequence << " " << name;
    }
  }
}

TEST(EvaluationRecordingsTest, AistReferenceReprojectsAtTheNoiseFloor) {
  if (!std::filesystem::exists(kAist)) GTEST_SKIP() << "no AIST++ recordings in " << kShared;
  for (const char* sequence : kSequences) {
    const MultiViewClip clip = ReadAistClip(kAist, kAist + "/cameras", sequence);
    Track track;
    for (const MatrixX3d& points : clip.coco17_in_world) {
      const CameraPose& pose = clip.views[0].pose;
      track.coco17.push_back((points * pose.camera_from_world_rotation.transpose()).rowwise() +
                             pose.camera_from_world_translation.transpose());
    }
    track.camera = clip.views[0].camera;
    track.motion = clip.motion;
    for (Eigen::Index t = 0; t < track.motion.poses.rows(); ++t) {
      track.motion.poses.row(t).head<3>() =
          AxisAngleFromRotation(clip.views[0].pose.camera_from_world_rotation *
                                RotationFromAxisAngle(clip.motion.poses.row(t).head<3>().transpose()))
              .transpose();
    }
    const Evaluation e = EvaluateAist(track, clip, "c01");
    EXPECT_NEAR(e.Value("pa_mpjpe_mm"), 0, 1e-9);
    EXPECT_NEAR(e.Value("joint_angle_err_deg"), 0, 1e-5);
    EXPECT_NEAR(e.Value("root_rotation_err_deg"), 0, 1e-5);
    EXPECT_GT(e.Value("heldout_median_px"), 3);
    EXPECT_LT(e.Value("heldout_median_px"), 7);
    EXPECT_LT(e.Value("heldout_p95_px"), 22);
    EXPECT_GT(e.Value("heldout_pck_box_05"), 0.9);
  }
}

TEST(EvaluationRecordingsTest, AistFilesThatCannotBeUsedAreNamed) {
  if (!std::filesystem::exists(kAist)) GTEST_SKIP() << "no AIST++ recordings in " << kShared;
  const auto message = [](const std::string& annotations, const std::string& cameras, const std::string& sequence) {
    try {
      ReadAistClip(annotations, cameras, sequence);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("nothing was thrown");
  };
  EXPECT_NE(message(kAist, kAist + "/cameras", "gXX").find("gXX"), std::string::npos);
  EXPECT_NE(message(kAist, kShared + "/nowhere", kSequences[0]).find("nowhere"), std::string::npos);
  EXPECT_NE(message(kShared + "/nowhere", kAist + "/cameras", kSequences[0]).find("nowhere"), std::string::npos);
}

TEST(EvaluationRecordingsTest, Pose2SimTriangulatesAndScores) {
  const std::string folder = kShared + "/data/pose2sim";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no Pose2Sim recordings in " << kShared;
  const MultiViewClip clip = ReadPose2SimClip(folder);
  ASSERT_EQ(clip.views.size(), 2u);
  ASSERT_EQ(clip.coco17_in_world.size(), 100u);
  // The triangulated joints themselves, smaller and nearer; an unknown joint stays where it was last known.
  Track track;
  const CameraPose& pose = clip.views[0].pose;
  MatrixX3d known = MatrixX3d::Zero(17, 3);
  for (const MatrixX3d& points : clip.coco17_in_world) {
    for (int k = 0; k < 17; ++k) {
      if (points.row(k).allFinite()) known.row(k) = points.row(k);
    }
    track.coco17.emplace_back(0.9 * ((known * pose.camera_from_world_rotation.transpose()).rowwise() +
                                     pose.camera_from_world_translation.transpose()));
  }
  track.camera = clip.views[0].camera;
  track.motion.poses = RowMatrixXd::Zero(100, 72);
  const Evaluation e = EvaluatePose2Sim(track, clip);
  EXPECT_EQ(e.protocol, "pose2sim-held-out");
  EXPECT_GT(e.Value("triangulated_percent"), 70);
  EXPECT_LT(e.Value("triangulation_median_px"), 10);
  EXPECT_GT(e.Value("triangulation_median_px"), 0.5);
  // Nothing is lost by triangulating: both views see the joints where they were detected.
  EXPECT_NEAR(e.Value("clip_scale"), 1 / 0.9, 1e-6);
  EXPECT_LT(e.Value("heldout_median_px"), 6);
  EXPECT_LT(e.Value("fitview_median_px"), 6);
  EXPECT_LT(e.Value("heldout_median_height_percent"), 1);
  EXPECT_NEAR(e.Value("pa_mpjpe_mm"), 0, 1e-6);

  Pose2SimOptions strict;
  strict.triangulation.max_triangulation_px = 3;
  const Evaluation fewer = EvaluatePose2Sim(track, ReadPose2SimClip(folder, strict), "cam_01", strict);
  EXPECT_LT(fewer.Value("triangulated_percent"), e.Value("triangulated_percent") - 10);
  EXPECT_LT(fewer.Value("triangulation_p95_px"), 6);
}

}  // namespace
}  // namespace bodyloom::evaluation_recordings_test
