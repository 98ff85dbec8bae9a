// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace bodyloom::track_report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TrackReport SomeReport() {
  TrackReport report;
  report.solve.status = SolveStatus::kConverged;
  report.solve.solver = "ceres";
  report.solve.iterations = 12;
  report.solve.initial_cost = 345.25;
  report.solve.final_cost = std::numeric_limits<double>::quiet_NaN();
  report.solve.frames_by_status = {{"tracked", 8}, {"lost", 2}};
  report.solve.seconds = {{"initialise", 0.5}, {"fit", 1.0}};
  report.solve.plan = {{"2D joints", true, "given"}, {"overlay", false, "no --overlay"}};
  report.num_frames = 10;
  report.seconds = {{"read", 0.25}, {kSolveStage, 1.75}, {"write", 0.125}};
  report.total_seconds = 2.25;
  report.peak_memory_bytes = 3 << 20;
  report.outputs = {"track.npz"};
  return report;
}

TEST(TrackReport, AClockThatTheMotionDoesNotTellHasNoNumber) {
  TrackReport report = SomeReport();
  report.views.resize(2);
  report.views[0].camera.name = "left";
  ViewReport& view = report.views[1];
  view.camera.name = "right";
  view.fps = 30;
  view.camera.offset_s = 0.1;
  view.camera.offset_sigma_s = 0.004;
  EXPECT_THAT(ToText(report), HasSubstr("clock 0.100 s, 3.0 frames (within 0.004 s)"));
  view.camera.offset_sigma_s = 1.2;
  EXPECT_THAT(ToText(report), HasSubstr("the motion does not tell its clock"));
  EXPECT_THAT(ToText(report), Not(HasSubstr("clock 0.100")));
}

TEST(TrackReport, JsonHoldsWhatScriptsRelyOn) {
  const nlohmann::json json = nlohmann::json::parse(ToJson(SomeReport()));
  EXPECT_EQ(json["status"], ToString(SolveStatus::kConverged));
  EXPECT_EQ(json["frames"], 10);
  EXPECT_EQ(json["frames_by_status"]["lost"], 2);
  EXPECT_EQ(json["solver"], "ceres");
  EXPECT_EQ(json["iterations"], 12);
  EXPECT_EQ(json["initial_cost"], 345.25);
  EXPECT_TRUE(json["final_cost"].is_null()) << "not a number has no place in JSON";
  EXPECT_EQ(json["peak_memory_bytes"], 3 << 20);
  ASSERT_EQ(json["skipped"].size(), 1u);
  EXPECT_EQ(json["skipped"][0]["what"], "overlay");
  EXPECT_EQ(json["skipped"][0]["why"], "no --overlay");
}

TEST(TrackReport, TheGroundOrWhyThereIsNone) {
  TrackReport report = SomeReport();
  report.solve.ground.why = "no foot is seen to stand for long enough";
  nlohmann::json ground = nlohmann::json::parse(ToJson(report))["ground"];
  EXPECT_EQ(ground["found"], false);
  EXPECT_EQ(ground["why"], "no foot is seen to stand for long enough");
  EXPECT_FALSE(ground.contains("up_in_camera"));
  EXPECT_FALSE(ground.contains("camera_height_m"));
  EXPECT_THAT(ToText(report), HasSubstr("ground   none: no foot is seen to stand for long enough\n"));
  GroundSummary& found = report.solve.ground;
  found.has_up = found.has_plane = true;
  found.up = Eigen::Vector3d(0, -0.5, 0.25);
  found.camera_height_m = 1.25;
  found.contact_frames = 7;
  found.why = "3 stances on it";
  ground = nlohmann::json::parse(ToJson(report))["ground"];
  EXPECT_EQ(ground["found"], true);
  EXPECT_EQ(ground["up_in_camera"], nlohmann::json({0.0, -0.5, 0.25}));
  EXPECT_EQ(ground["camera_height_m"], 1.25);
  EXPECT_EQ(ground["contact_frames"], 7);
  EXPECT_THAT(ToText(report), HasSubstr("ground   1.25 m below the camera, feet held in 7 frames (3 stances on it)\n"));
  found.contact_frames = 0;
  found.why = "the body rests on it for 2.5 s";
  EXPECT_THAT(ToText(report), HasSubstr("ground   1.25 m below the camera (the body rests on it for 2.5 s)\n"));
}

TEST(TrackReport, SecondsSplitTheSolveAndLoseNothing) {
  const nlohmann::json seconds = nlohmann::json::parse(ToJson(SomeReport()))["seconds"];
  EXPECT_EQ(seconds["read"], 0.25);
  EXPECT_EQ(seconds["initialise"], 0.5);
  EXPECT_EQ(seconds["fit"], 1.0);
  EXPECT_EQ(seconds["solve, other"], 0.25);
  EXPECT_EQ(seconds["write"], 0.125);
  EXPECT_EQ(seconds["total"], 2.25);
}

TEST(TrackReport, TextNamesFramesErrorTimeAndSkips) {
  const std::string text = ToText(SomeReport());
  EXPECT_THAT(text, HasSubstr("10 frames: 2 lost, 8 tracked\n"));
  EXPECT_THAT(text, HasSubstr("225.00 ms a frame"));
  EXPECT_THAT(text, HasSubstr("skipped  overlay: no --overlay\n"));
  EXPECT_THAT(text, HasSubstr("wrote    track.npz\n"));
}

TEST(PlanText, AlignsRunsAndSkips) {
  EXPECT_EQ(ToText(SomeReport().solve.plan), "  run   2D joints  given\n  skip  overlay    no --overlay\n");
}

}  // namespace
}  // namespace bodyloom::track_report_test
