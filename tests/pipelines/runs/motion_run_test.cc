// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/runs/motion_run.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bodyloom/pipelines/runs/run_config.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom {
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

TEST_F(MotionRuns, RefusesWhatIsNoShape) {
  nlohmann::json json = nlohmann::json::parse(MotionRunJson(Tiny()));
  for (const nlohmann::json& wrong : {nlohmann::json(1), nlohmann::json({1, "x"}), nlohmann::json(nullptr),
                                      nlohmann::json(std::vector<double>(1001, 0.0))}) {
    json["betas"] = wrong;
    EXPECT_THAT(Refusal(json), HasSubstr("config.json: betas")) << wrong;
  }
}

}  // namespace
}  // namespace bodyloom
