// SPDX-License-Identifier: Apache-2.0
#include "pipelines/runs/motion_run.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "pipelines/runs/run_config.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::motion_run_test {
namespace {

using ::testing::HasSubstr;

MotionRun Tiny() {
  MotionRun run;
  run.config.profile = MotionProfileNamed("tiny");
  run.pixels_per_metre = 60;
  run.reach = 3;
  return run;
}

class MotionRuns : public ::testing::Test {
 protected:
  MotionRun Read(const std::string& text) {
    std::filesystem::create_directories(scratch_ / "run");
    std::ofstream(RunConfigPath(scratch_ / "run")) << text;
    return ReadMotionRun(scratch_ / "run");
  }
  std::string Refusal(const nlohmann::json& json) {
    try {
      Read(json.dump());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  ScratchFolder scratch_;
};

TEST_F(MotionRuns, ThePersonsShapeComesBackToTheBit) {
  MotionRun run = Tiny();
  run.betas = Eigen::Vector3d(1.0 / 3, -2.5e-7, 0);
  const MotionRun read = Read(MotionRunJson(run));
  ASSERT_TRUE(read.betas.has_value());
  EXPECT_EQ(*read.betas, *run.betas);
  run.betas = Eigen::VectorXd();  // the mean shape is a shape too
  EXPECT_EQ(Read(MotionRunJson(run)).betas->size(), 0);
}

TEST_F(MotionRuns, OlderOnesHoldNoShape) { EXPECT_FALSE(Read(MotionRunJson(Tiny())).betas.has_value()); }

TEST_F(MotionRuns, AxesAndVelocitiesComeBack) {
  MotionRun run = Tiny();
  run.motion.frame = SurfaceFrame::kWorld;
  run.motion.camera_pose.camera_from_world_rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  run.motion.camera_pose.camera_from_world_translation << 1, 2, 1.0 / 3;
  SetVelocity("analytic", &run.motion);
  run.motion.velocity.window_s = 0.3;
  run.motion.velocity.order = 2;
  run.motion.velocity.longest_step_s = 0.2;
  const SurfaceMotion motion = Read(MotionRunJson(run)).motion;
  EXPECT_EQ(motion.frame, SurfaceFrame::kWorld);
  EXPECT_EQ(motion.camera_pose.camera_from_world_rotation, run.motion.camera_pose.camera_from_world_rotation);
  EXPECT_EQ(motion.camera_pose.camera_from_world_translation, run.motion.camera_pose.camera_from_world_translation);
  EXPECT_EQ(VelocityName(motion), "analytic");
  EXPECT_EQ(motion.velocity.window_s, 0.3);
  EXPECT_EQ(motion.velocity.order, 2);
  EXPECT_EQ(motion.velocity.longest_step_s, 0.2);
  SetVelocity("central", &run.motion);
  run.motion.frame = SurfaceFrame::kBody;
  EXPECT_EQ(VelocityName(Read(MotionRunJson(run)).motion), "central");
  EXPECT_EQ(Read(MotionRunJson(run)).motion.frame, SurfaceFrame::kBody);
}

TEST_F(MotionRuns, OlderOnesDescribedMotionInTheOnlyWayThereWas) {
  nlohmann::json json = nlohmann::json::parse(MotionRunJson(Tiny()));
  json.erase("surface_motion");
  const SurfaceMotion motion = Read(json.dump()).motion;
  EXPECT_EQ(motion.frame, SurfaceFrame::kCamera);
  EXPECT_EQ(VelocityName(motion), "savgol");
  EXPECT_EQ(motion.velocity.window_s, 0.22);
  EXPECT_EQ(motion.velocity.order, 3);
}

TEST_F(MotionRuns, TheDescriptorComesBack) {
  MotionRun run = Tiny();
  EXPECT_EQ(Read(MotionRunJson(run)).config.descriptor, MotionDescriptor::kSurface);
  run.config.descriptor = MotionDescriptor::kDense2d;
  run.config.motion_channels = MotionChannels(MotionDescriptor::kDense2d, run.past);
  EXPECT_EQ(run.config.motion_channels, 60);
  EXPECT_EQ(Read(MotionRunJson(run)).config.descriptor, MotionDescriptor::kDense2d);
  nlohmann::json json = nlohmann::json::parse(MotionRunJson(run));
  json["descriptor"] = "keypoints";
  EXPECT_THAT(Refusal(json), HasSubstr("expected surface or dense2d"));
  json.erase("descriptor");
  EXPECT_THAT(Refusal(json), HasSubstr("do not make sense")) << "older runs have the surface's 33 channels";
  json["motion_channels"] = 33;
  EXPECT_EQ(Read(json.dump()).config.descriptor, MotionDescriptor::kSurface);
}

TEST_F(MotionRuns, TheFramesTrainedOnComeBack) {
  MotionRun run = Tiny();
  run.notes = R"({"data": "dancer", "track": "", "train": [[0, 9], [20, 31]]})";
  const MotionRun read = Read(MotionRunJson(run));
  EXPECT_EQ(read.data, "dancer");
  EXPECT_EQ(read.trained, (std::vector<std::pair<int, int>>{{0, 9}, {20, 31}}));
  EXPECT_TRUE(Read(MotionRunJson(Tiny())).trained.empty());
}

TEST_F(MotionRuns, RefusesMotionThatCannotBeDescribed) {
  MotionRun run = Tiny();
  run.motion.frame = SurfaceFrame::kWorld;
  const nlohmann::json good = nlohmann::json::parse(MotionRunJson(run));
  const std::vector<std::pair<const char*, nlohmann::json>> wrong = {
      {"frame", "ground"},
      {"velocity", "forward"},
      {"window_s", 0},
      {"order", 9},
      {"longest_step_s", -1},
      {"camera_from_world_rotation", {1, 2, 3, 4, 5, 6, 7, 8, 9}},
      {"camera_from_world_translation", {1, 2}}};
  for (const auto& [key, value] : wrong) {
    nlohmann::json json = good;
    json["surface_motion"][key] = value;
    EXPECT_THAT(Refusal(json), HasSubstr("config.json: surface_motion")) << key;
  }
}

TEST_F(MotionRuns, RefusesWhatIsNoShape) {
  nlohmann::json json = nlohmann::json::parse(MotionRunJson(Tiny()));
  for (const nlohmann::json& wrong : {nlohmann::json(1), nlohmann::json({1, "x"}), nlohmann::json(nullptr),
                                      nlohmann::json(std::vector<double>(1001, 0.0))}) {
    json["betas"] = wrong;
    EXPECT_THAT(Refusal(json), HasSubstr("config.json: betas")) << wrong;
  }
}

}  // namespace
}  // namespace bodyloom::motion_run_test
