// SPDX-License-Identifier: Apache-2.0
// `bodyloom track` with several views, and `bodyloom export` of their rig.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "apps/usage_error.h"
#include "data_tools/observations/load_cameras.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::track_views_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

CommandResult Well(const std::vector<std::string>& arguments) {
  CommandResult result = RunCommand(arguments);
  EXPECT_EQ(result.exit_code, kExitOk) << arguments[0] << ": " << result.err;
  return result;
}

/// Two clips of one motion, 70 degrees apart, made once.
class TrackViewsVerb : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new ScratchFolder;
    for (const std::string yaw : {"0", "70"}) {
      Well({"synth", "--motion", "demo", "--frames", "60", "--fps", "30", "--dense", "0", "--yaw", yaw, "--out",
            *shared_ / yaw, "--quiet"});
    }
  }
  static void TearDownTestSuite() { delete std::exchange(shared_, nullptr); }
  static std::string Seen(const std::string& yaw) { return *shared_ / (yaw + "/observations.npz"); }
  /// `track` of both views with further arguments.
  std::vector<std::string> Track(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"track", "--detections",       Seen("0"), "--detections", Seen("70"),
                                          "--out", folder_ / "track.npz"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void ExpectError(const CommandResult& result, int exit_code, const std::string& text) const {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    const int lines = exit_code == kExitUsage ? 2 : 1;  // the second: where the options are listed
    EXPECT_EQ(result.NumErrorLines(), lines) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "track.npz"));
  }

  static ScratchFolder* shared_;
  ScratchFolder folder_;
};
ScratchFolder* TrackViewsVerb::shared_ = nullptr;

TEST_F(TrackViewsVerb, TwoFilesGiveATrackAndARig) {
  const CommandResult run = Well(Track({"--threads", "2"}));
  EXPECT_THAT(run.out, HasSubstr("view     view1  first; focal length "));
  EXPECT_THAT(run.out, HasSubstr("view     view2  "));
  EXPECT_THAT(run.out, HasSubstr("wrote    " + (folder_ / "rig.json")));
  ASSERT_EQ(LoadCameras(folder_ / "rig.json").size(), 2U);

  Well({"export", "--cameras", folder_ / "rig.json", "--what", "rig-toml", "--out", folder_ / "Calib.toml"});
  EXPECT_EQ(LoadCameras(folder_ / "Calib.toml")[1].name, "view2");
  Well({"export", "--cameras", folder_ / "rig.json", "--what", "rig-colmap", "--out", folder_ / "model"});
  EXPECT_TRUE(std::filesystem::exists(folder_ / "model/cameras.txt"));

  // The rig's cameras are known from now on.
  const CommandResult same = RunCommand(Track({"--cameras", folder_ / "rig.json"}));
  EXPECT_EQ(same.exit_code, kExitUsage);
  EXPECT_THAT(same.err, HasSubstr("would be overwritten: give --rig-out FILE"));
  const CommandResult again = Well(Track({"--cameras", folder_ / "rig.json", "--plan"}));
  EXPECT_THAT(again.out, HasSubstr("60 frames, its camera and clock are known"));
}

TEST_F(TrackViewsVerb, TheirTrackJudgesTheTrackOfOneView) {
  Well(Track({"--threads", "2", "--quiet"}));
  Well({"track", "--detections", Seen("70"), "--threads", "2", "--out", folder_ / "one.npz", "--quiet"});
  const CommandResult run = Well({"evaluate", "--track", folder_ / "one.npz", "--truth", folder_ / "track.npz", "--rig",
                                  folder_ / "rig.json", "--view", "view2"});
  EXPECT_THAT(run.out, HasSubstr("protocol rig-track"));
  EXPECT_THAT(run.out, HasSubstr("  view: view2\n"));
  EXPECT_THAT(run.out, HasSubstr("  truth_joint_sigma_mm "));
  EXPECT_THAT(run.out, HasSubstr("  view_mean_px:\n    view1 "));
  const CommandResult unknown = RunCommand({"evaluate", "--track", folder_ / "one.npz", "--truth",
                                            folder_ / "track.npz", "--rig", folder_ / "rig.json", "--view", "c05"});
  EXPECT_EQ(unknown.exit_code, kExitFailed);
  EXPECT_EQ(unknown.NumErrorLines(), 1) << unknown.err;
  EXPECT_THAT(unknown.err, HasSubstr("no camera 'c05', expected one of view1, view2"));
}

TEST_F(TrackViewsVerb, ThePlanWritesNothing) {
  const CommandResult plan = Well(Track({"--plan"}));
  EXPECT_THAT(plan.out, HasSubstr("shared by 2 views"));
  EXPECT_THAT(plan.out, HasSubstr("60 frames, estimated with the track: place and direction, focal length, clock"));
  EXPECT_TRUE(folder_.Entries().empty());
}

TEST_F(TrackViewsVerb, ContradictionsAreErrors) {
  ExpectError(RunCommand(Track({"--view", "c01,c01"})), kExitUsage, "--view lists c01 twice");
  ExpectError(RunCommand(Track({"--view", "c01"})), kExitUsage, "2 files of --detections and 1 names");
  ExpectError(RunCommand(Track({"--camera", "weak"})), kExitUsage, "leave out --camera weak");
  ExpectError(RunCommand(Track({"--camera-path", "x"})), kExitUsage, "several views need a path each");
  ExpectError(RunCommand(Track({"--dense", "x"})), kExitUsage, "leave out --dense");
  ExpectError(RunCommand(Track({"--known", "poses"})), kExitUsage, "give --cameras");
  ExpectError(RunCommand(Track({"--known", "lenses"})), kExitUsage, "--known");
  ExpectError(RunCommand(Track({"--rig-out", Seen("0")})), kExitUsage, "both to read and to write");
  ExpectError(RunCommand({"track", "--detections", Seen("0"), "--rig-out", "r.json", "--out", folder_ / "track.npz"}),
              kExitUsage, "--rig-out is of several views");
  ExpectError(RunCommand({"track", "--view", "c01,c02", "--video", "v.mp4", "--out", folder_ / "track.npz"}),
              kExitUsage, "give --detections");
  const std::string cameras = *shared_ / "0/camera.json";
  ExpectError(RunCommand(Track({"--view", "c01,c02", "--cameras", cameras})), kExitFailed, "no camera 'c01'");
  ExpectError(RunCommand({"export", "--what", "rig-toml", "--out", folder_ / "o"}), kExitUsage, "give --cameras");
  ExpectError(RunCommand({"export", "--what", "rig-toml", "--cameras", cameras, "--track", "t.npz", "--out", "o"}),
              kExitUsage, "leave out --track");
  ExpectError(RunCommand({"export", "--what", "bvh", "--cameras", cameras, "--track", "t.npz", "--out", "o"}),
              kExitUsage, "--cameras is of rig-toml");
  ExpectError(RunCommand({"export", "--what", "bvh", "--out", folder_ / "o"}), kExitUsage, "--track is required");
}

}  // namespace
}  // namespace bodyloom::track_views_test
