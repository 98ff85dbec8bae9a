// SPDX-License-Identifier: Apache-2.0
// A track of one camera against the track of several, from files and in memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "data_tools/motion/track_io.h"
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

}  // namespace
}  // namespace bodyloom::evaluate_rig_test
