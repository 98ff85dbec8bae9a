// SPDX-License-Identifier: Apache-2.0
// A track of one camera against the track of several, from files and in memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "data_tools/evaluation/triangulated_clip.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/observations/rig_io.h"
#include "geometry/base/callbacks.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/score/evaluate_track.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::evaluate_rig_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

/// A true track, two cameras of which the second is 60 degrees aside, and that camera's track, which is exact.
class EvaluateRig : public ::testing::Test {
 protected:
  EvaluateRig() : truth_(ShortTrack()), rig_(2) {
    rig_[0].name = "front";
    rig_[0].camera = truth_.camera;
    rig_[1].name = "side";
    rig_[1].camera = MakePinhole(400, 300, 350);
    rig_[1].camera_from_rig.camera_from_world_rotation = RotationFromAxisAngle({0, M_PI / 3, 0});
    rig_[1].camera_from_rig.camera_from_world_translation = {-3, 0, 2};
    rig_[1].offset_s = 2.5;
    track_ = truth_;
    track_.camera = rig_[1].camera;
    track_.motion = MovedMotion(BuiltinBody(), truth_.motion, {&rig_[1].camera_from_rig, 1});
    for (double& time : track_.motion.timestamps) time += 2.5;
    WriteTrack(folder_ / "track.npz", track_);
    WriteTrack(folder_ / "truth.npz", truth_);
    WriteRig(folder_ / "rig.json", rig_);
    request_.track = folder_ / "track.npz";
    request_.truth = folder_ / "truth.npz";
    request_.rig = folder_ / "rig.json";
    request_.view = "side";
  }
  template <typename Error>
  void ExpectError(const EvaluateTrackRequest& request, const std::string& text) const {
    EXPECT_THAT([&] { EvaluateTrack(request); }, ThrowsMessage<Error>(HasSubstr(text)));
  }

  Track truth_, track_;
  std::vector<RigCamera> rig_;
  ScratchFolder folder_;
  EvaluateTrackRequest request_;
};

TEST_F(EvaluateRig, AnExactTrackHasNoError) {
  request_.json = folder_ / "errors.json";
  const Evaluation e = EvaluateTrack(request_);
  EXPECT_EQ(e.protocol, "rig-track");
  EXPECT_EQ(e.frames, truth_.num_frames());
  for (const char* name : {"own_view_mean_px", "other_views_mean_px", "joint_err_mm", "limb_angle_err_deg"}) {
    EXPECT_NEAR(e.Value(name), 0, 1e-2) << name;
  }
  EXPECT_GE(e.Value("gt_self_penetration_mm"), 0);
  std::ifstream file(request_.json);
  const nlohmann::json json = nlohmann::json::parse(file);
  EXPECT_EQ(json["subject"]["view"], "side");
  EXPECT_EQ(json["subject"]["cameras"], "front, side");
  EXPECT_TRUE(json["breakdowns"]["view_mean_px"].contains("front"));
  EXPECT_EQ(json["values"]["truth_joint_sigma_mm"], 0);  // a synthetic truth is exact

  EvaluateTrackRequest in_memory;
  in_memory.view = "side";
  const Evaluation same = EvaluateTrack(in_memory, BuiltinBody(), track_, {&truth_, &rig_});
  EXPECT_EQ(EvaluationTable(same), EvaluationTable(e));
}

TEST_F(EvaluateRig, WithoutARigTheTruthIsOfTheSameCamera) {
  request_.rig.clear();
  EXPECT_EQ(EvaluateTrack(request_).protocol, "known-truth");
}

TEST_F(EvaluateRig, ContradictionsAreErrors) {
  EvaluateTrackRequest request = request_;
  request.truth.clear();
  ExpectError<RequestError>(request, "--truth FILE.npz");
  request.truth = folder_.path();
  ExpectError<RequestError>(request, "--truth FILE.npz");
  request = request_;
  request.cameras = folder_ / "rig.json";
  ExpectError<RequestError>(request, "leave out --cameras");
  request = request_;
  request.seen = {{"side", 0, folder_ / "track.npz"}};
  ExpectError<RequestError>(request, "--seen");
  request = request_;
  request.rig.clear();
  request.equal_clocks = true;
  ExpectError<RequestError>(request, "--equal-clocks");
  request = request_;
  request.rig = folder_ / "absent.json";
  ExpectError<std::runtime_error>(request, "absent.json: No such file");
  request.rig = folder_ / "track.npz";
  ExpectError<std::runtime_error>(request, "track.npz");
  request = request_;
  request.json = request.rig;
  ExpectError<RequestError>(request, "rig.json");
}

TEST_F(EvaluateRig, ErrorsNameTheTrackAndTheReason) {
  EvaluateTrackRequest request = request_;
  request.view = "top";
  EXPECT_THAT([&] { EvaluateTrack(request); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(StartsWith(request.track + ": "), HasSubstr("no camera 'top', expected one of front, side"))));
  rig_[1].offset_s = std::nan("");
  WriteRig(request_.rig, rig_);
  ExpectError<std::runtime_error>(request_, "the clock of the rig's camera 'side' is not known");
  request_.equal_clocks = true;  // 2.5 seconds late, when the truth is over
  ExpectError<std::runtime_error>(request_, "none of the track's frames");
}

using Eigen::Vector3d;

constexpr int kFrames = 8, kTrackBegins = 3;

/// Seventeen points that move, metres, world frame (that of the first camera).
MatrixX3d WorldPoints(int frame) {
  MatrixX3d points(17, 3);
  for (int k = 0; k < 17; ++k) {
    points.row(k) << 0.3 * std::sin(k) + 0.02 * frame, 0.1 * k - 0.8, 4 + 0.2 * std::cos(3 * k);
  }
  return points;
}

/// Two cameras about 40° apart and what they saw, exactly; a track of the frames from kTrackBegins on that was fitted
/// to the first.
class RigClip : public ::testing::Test {
 protected:
  RigClip() {
    NamedCamera first, second;
    first.name = "cam_01";
    second.name = "cam_02";
    first.camera = second.camera = MakePinhole(640, 480, 600);
    second.pose.camera_from_world_rotation = RotationFromAxisAngle(Vector3d(0, 0.7, 0));
    second.pose.camera_from_world_translation = Vector3d(-2.4, 0, 1.2);
    WriteCameras(rig_, {first, second});
    for (const NamedCamera& camera : {first, second}) WriteDetections(camera);
    track_.camera = first.camera;
    track_.motion.up = Motion::Up::kCamera;
    track_.motion.poses = RowMatrixXd::Zero(kFrames - kTrackBegins, 72);
    track_.motion.trans = MatrixX3d::Zero(kFrames - kTrackBegins, 3);
    track_.frame_status.assign(kFrames - kTrackBegins, FrameStatus::kTracked);
    for (int t = kTrackBegins; t < kFrames; ++t) {
      track_.motion.timestamps.push_back(t / 30.0);
      track_.coco17.push_back(WorldPoints(t));
    }
  }

  void WriteDetections(const NamedCamera& camera) const {
    KeypointSequence seen;
    seen.convention = "coco17";
    seen.names = CocoNames();
    seen.image_width = 640;
    seen.image_height = 480;
    for (int t = 0; t < kFrames; ++t) {
      seen.timestamps.push_back(t / 30.0);
      const MatrixX3d points = WorldPoints(t);
      for (int k = 0; k < 17; ++k) {
        const Vector3d X = camera.pose.camera_from_world_rotation * points.row(k).transpose() +
                           camera.pose.camera_from_world_translation;
        Eigen::Vector2d pixel(0, 0);
        EXPECT_TRUE(camera.camera.Project(X, &pixel));
        seen.points.push_back({float(pixel.x()), float(pixel.y()), 0.9F});
      }
    }
    WriteObservations(folder_ / (camera.name + ".npz"), &seen, nullptr);
  }

  [[nodiscard]] std::vector<RigDetections> Seen() const {
    return {{"cam_01", 0, folder_ / "cam_01.npz"}, {"cam02", 0, folder_ / "cam_02.npz"}};
  }

  const ScratchFolder folder_;
  const std::string rig_ = folder_ / "rig.json";
  Track track_;
};

TEST_F(RigClip, JointsAreTriangulatedFromTheTracksFirstFrameOn) {
  const MultiViewClip clip = ReadRigClip(rig_, Seen(), "cam01", track_);
  ASSERT_EQ(clip.views.size(), 2U);
  EXPECT_EQ(clip.views[0].name, "cam01") << "as the caller spells it";
  EXPECT_NEAR(clip.fps, 30, 1e-9);
  ASSERT_EQ(clip.coco17_in_world.size(), size_t(kFrames - kTrackBegins));
  for (int t = kTrackBegins; t < kFrames; ++t) {
    // Pixels are stored as floats: 3e-5 px, at 4 m and 600 px some 1e-6 m.
    EXPECT_LT((clip.coco17_in_world[size_t(t - kTrackBegins)] - WorldPoints(t)).cwiseAbs().maxCoeff(), 1e-5) << t;
  }
}

TEST_F(RigClip, ATrackThatIsRightHasNoErrorInTheOtherCamera) {
  const MultiViewClip clip = ReadRigClip(rig_, Seen(), "cam_01", track_);
  const Evaluation right = EvaluateTriangulatedClip(track_, clip, "cam_01");
  EXPECT_EQ(right.protocol, "rig-held-out");
  EXPECT_LT(right.Value("heldout_median_px"), 1e-2);
  EXPECT_LT(right.Value("pa_mpjpe_mm"), 1e-2);
  EXPECT_NEAR(right.Value("clip_scale"), 1, 1e-5);
  EXPECT_EQ(right.Value("triangulated_percent"), 100);
  // Half as deep: hardly seen by the camera that was fitted, plainly by the other.
  for (MatrixX3d& points : track_.coco17) points.col(2) = (4 + 0.5 * (points.col(2).array() - 4)).matrix();
  EXPECT_GT(EvaluateTriangulatedClip(track_, clip, "cam_01").Value("heldout_median_px"), 3);
}

TEST_F(RigClip, WhatDoesNotFitIsNamed) {
  const auto read = [&](const std::vector<RigDetections>& seen, const std::string& view) {
    return [this, seen, view] { ReadRigClip(rig_, seen, view, track_); };
  };
  EXPECT_THAT(read({Seen()[0]}, "cam_01"), ThrowsMessage<RequestError>(HasSubstr("detections of two")));
  EXPECT_THAT(read({Seen()[1], Seen()[1]}, "cam_01"), ThrowsMessage<RequestError>(HasSubstr("cam_01")));
  EXPECT_THAT(read(Seen(), "cam_09"), ThrowsMessage<std::runtime_error>(HasSubstr("no camera 'cam_09'")));
  track_.motion.timestamps[0] = 40;
  EXPECT_THAT(read(Seen(), "cam_01"), ThrowsMessage<std::runtime_error>(HasSubstr("at which the track begins")));
}

TEST_F(RigClip, ARequestNamesOneTruth) {
  EvaluateTrackRequest request;
  request.track = rig_;
  request.seen = Seen();
  EXPECT_THAT([&] { EvaluateTrack(request); }, ThrowsMessage<RequestError>(HasSubstr("--cameras")));
  request.truth = rig_;
  EXPECT_THAT([&] { EvaluateTrack(request); }, ThrowsMessage<RequestError>(HasSubstr("expected --truth, or --seen")));
}

TEST(RigDetections, AreReadFromText) {
  const RigDetections plain = RigDetectionsFromText("cam_01=a=b.npz");
  EXPECT_EQ(plain.view, "cam_01");
  EXPECT_EQ(plain.person, 0);
  EXPECT_EQ(plain.detections, "a=b.npz");
  const RigDetections second = RigDetectionsFromText("c2:13=x/y.npz");
  EXPECT_EQ(second.view, "c2");
  EXPECT_EQ(second.person, 13);
  for (const char* text : {"", "cam_01", "=a", "cam=", "cam:=a", "cam:-1=a", "cam:x=a", ":1=a", "cam:999999=a"}) {
    EXPECT_THROW(RigDetectionsFromText(text), RequestError) << text;
  }
}

}  // namespace

}  // namespace bodyloom::evaluate_rig_test
