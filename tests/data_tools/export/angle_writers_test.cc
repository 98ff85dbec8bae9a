// SPDX-License-Identifier: Apache-2.0
// Files of joint angles and gait, read back by readers of the test's own.
#include "data_tools/export/angle_writers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/data_tools/export/exported_scene.h"

namespace bodyloom::angle_writers_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A file's cells: of lines, split at a character; empty cells are NaN.
std::vector<std::vector<std::string>> Cells(const std::string& text, char separator) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    lines.emplace_back();
    std::istringstream cells(line + separator);
    for (std::string cell; std::getline(cells, cell, separator);) lines.back().push_back(cell);
  }
  return lines;
}

double Value(const std::string& cell) {
  return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(cell);
}

TrackAngles AnglesWithAGap() {
  Track track = TrackWithAGap();
  track.joint_sigma = RowMatrixXd::Constant(track.num_frames(), 24, 0.03);
  return AnglesOfTrack(BuiltinBody(), track, TiltedWorld());
}

TEST(AngleWriters, CsvReadsBack) {
  const TrackAngles angles = AnglesWithAGap();
  const auto lines = Cells(AnglesCsv(angles), ',');
  ASSERT_EQ(lines.size(), 13U);
  const std::vector<std::string>& names = lines[0];
  ASSERT_EQ(names.size(), 2U + kNumCoordinates + 12);
  EXPECT_THAT(std::vector<std::string>(names.begin(), names.begin() + 3), ElementsAre("frame", "time", "pelvis_tilt"));
  EXPECT_EQ(names[2 + kNumCoordinates], "hip_flexion_r_sigma");
  EXPECT_EQ(names.back(), "elbow_flex_l_sigma");
  for (size_t t = 0; t < 12; ++t) {
    ASSERT_EQ(lines[t + 1].size(), names.size());
    EXPECT_EQ(lines[t + 1][0], std::to_string(t));
    EXPECT_NEAR(Value(lines[t + 1][1]), angles.timestamps[t], 1e-6);
    for (size_t c = 0; c < kNumCoordinates; ++c) {
      const double value = Value(lines[t + 1][2 + c]), expected = angles.values(Eigen::Index(t), Eigen::Index(c));
      EXPECT_EQ(std::isnan(value), t == 3 || t == 4);
      if (std::isnan(value)) continue;
      EXPECT_NEAR(value, expected, IsAngle(int(c)) ? 5.1e-5 : 5.1e-7);
    }
    for (size_t s = 2 + kNumCoordinates; s < names.size(); ++s) {
      const int c = FindCoordinate(names[s].substr(0, names[s].size() - 6));
      ASSERT_GE(c, 0);
      if (t == 3 || t == 4) continue;
      EXPECT_NEAR(Value(lines[t + 1][s]), angles.sigma_deg(Eigen::Index(t), c), 5.1e-5);
    }
  }
  TrackAngles without = angles;
  without.sigma_deg.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(Cells(AnglesCsv(without), ',')[0].size(), 2U + kNumCoordinates);
}

TEST(AngleWriters, MotReadsBack) {
  const TrackAngles angles = AnglesWithAGap();
  const auto lines = Cells(AnglesMot(angles), '\t');
  EXPECT_EQ(lines[0][0], "Coordinates");
  EXPECT_EQ(lines[1][0], "version=1");
  EXPECT_EQ(lines[2][0], "nRows=10") << "two of twelve frames are lost";
  EXPECT_EQ(lines[3][0], "nColumns=32");
  EXPECT_EQ(lines[4][0], "inDegrees=yes");
  size_t end = 0;
  while (end < lines.size() && (lines[end].empty() || lines[end][0] != "endheader")) ++end;
  ASSERT_EQ(lines.size(), end + 2 + 10);
  ASSERT_EQ(lines[end + 1].size(), 32U);
  EXPECT_EQ(lines[end + 1][0], "time");
  size_t row = end + 2;
  for (Eigen::Index t = 0; t < 12; ++t) {
    if (t == 3 || t == 4) continue;
    ASSERT_EQ(lines[row].size(), 32U);
    EXPECT_NEAR(Value(lines[row][0]), angles.timestamps[size_t(t)], 1e-8);
    for (int c = 0; c < kNumCoordinates; ++c) {
      EXPECT_EQ(lines[end + 1][size_t(c) + 1], CoordinateNames()[size_t(c)]);
      EXPECT_NEAR(Value(lines[row][size_t(c) + 1]), angles.values(t, c), 1e-8);
    }
    ++row;
  }
  TrackAngles lost = angles;
  lost.values.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(AnglesMot(lost), std::invalid_argument);
  lost.values.resize(12, 5);
  EXPECT_THROW(AnglesMot(lost), std::invalid_argument);
  EXPECT_THROW(AnglesCsv(lost), std::invalid_argument);
}

TEST(AngleWriters, GaitReadsBack) {
  GaitReport gait;
  gait.reason = "the pelvis does not move as fast as in walking";
  nlohmann::json json = nlohmann::json::parse(GaitJson(gait));
  EXPECT_EQ(json["walks"], false);
  EXPECT_EQ(json["reason"], gait.reason);
  EXPECT_TRUE(json["cadence_per_min"].is_null() && json["step_length_m"]["left"].is_null());
  EXPECT_TRUE(json["events"].empty());
  gait.walks = true;
  gait.num_steps = 5;
  gait.cadence_per_min = 110;
  gait.step_length_m = {0.6, 0.7};
  gait.bouts_s = {{1, 3.5}};
  gait.events = {{1.25, 37, Foot::kRight, GaitEventKind::kFootStrike}, {1.5, 45, Foot::kLeft, GaitEventKind::kFootOff}};
  json = nlohmann::json::parse(GaitJson(gait));
  EXPECT_FALSE(json.contains("reason"));
  EXPECT_EQ(json["step_length_m"]["right"], 0.7);
  EXPECT_EQ(json["bouts_s"], nlohmann::json::parse("[[1.0, 3.5]]"));
  EXPECT_EQ(json["events"][0],
            nlohmann::json::parse(R"({"time_s": 1.25, "frame": 37, "foot": "right", "event": "foot_strike"})"));
  EXPECT_EQ(json["events"][1]["event"], "foot_off");
}

/// The demo's person walks up in a curve of planned footsteps, at rest before and after.
TEST(AngleWriters, TheDemosWalkIsOne) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  options.keypoints = false;
  const Track track = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 180, 30), options).truth;
  const GaitReport gait = AnalyseGait(BuiltinBody(), track, WorldFrame());
  ASSERT_TRUE(gait.walks) << gait.reason;
  EXPECT_GE(gait.num_steps, 3);
  EXPECT_NEAR(gait.mean_step_length_m() * gait.cadence_per_min / 60, gait.speed_mps, 0.2 * gait.speed_mps);
}

}  // namespace
}  // namespace bodyloom::angle_writers_test
