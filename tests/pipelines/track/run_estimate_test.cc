// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/run_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace bodyloom::run_estimate_test {
namespace {

RunWork DancingMan() {
  RunWork work;
  work.num_frames = 367;
  work.width = 576;
  work.height = 1024;
  work.people_px = {700};
  return work;
}

TEST(RunEstimate, GrowsWithFramesPeopleAndPixels) {
  const RunEstimate one = EstimateRun(DancingMan());
  EXPECT_TRUE(std::isfinite(one.seconds));
  EXPECT_GT(one.seconds, 0);
  EXPECT_GT(one.peak_memory_bytes, 0U);
  const auto expect_more = [&](const char* what, const auto& change) {
    RunWork work = DancingMan();
    change(&work);
    const RunEstimate more = EstimateRun(work);
    EXPECT_GT(more.seconds, 1.05 * one.seconds) << what;
    EXPECT_GE(more.peak_memory_bytes, one.peak_memory_bytes) << what;
  };
  expect_more("frames", [](RunWork* work) { work->num_frames *= 2; });
  expect_more("people", [](RunWork* work) { work->people_px = {700, 600}; });
  expect_more("pixels", [](RunWork* work) {
    work->width *= 2;
    work->height *= 2;
    work->people_px = {1400};
  });
  expect_more("a slower machine", [](RunWork* work) {
    work->machine = 2;
    work->detect_s *= 2;
  });
  expect_more("one thread", [](RunWork* work) { work->threads = 1; });
}

TEST(RunEstimate, LessWithoutMasksAndOverlay) {
  const RunEstimate all = EstimateRun(DancingMan());
  for (bool RunWork::*part : {&RunWork::masks, &RunWork::overlay}) {
    RunWork work = DancingMan();
    work.*part = false;
    EXPECT_LT(EstimateRun(work).seconds, 0.95 * all.seconds);
  }
}

TEST(RunEstimate, StagesAddUpInTextAndJson) {
  RunPlan plan;
  plan.work = DancingMan();
  plan.work.threads = 1;
  plan.estimate = EstimateRun(plan.work);
  const nlohmann::json json = nlohmann::json::parse(ToJson(plan));
  double sum = 0;
  for (const auto& [stage, seconds] : json["processor_seconds"].items()) sum += seconds.get<double>();
  EXPECT_NEAR(sum, json["total_seconds"].get<double>(), 1e-9);
  EXPECT_EQ(json["frames"], 367);
  const std::string text = ToText(plan);
  EXPECT_EQ(text.rfind("about ", 0), 0U) << text;
  EXPECT_NE(text.find("367 frames of 576x1024 with 1 person"), std::string::npos) << text;
}

TEST(RunEstimate, RefusesNonsense) {
  RunWork work = DancingMan();
  work.num_frames = 0;
  EXPECT_THROW(EstimateRun(work), std::invalid_argument);
  work = DancingMan();
  work.fps = 0;
  EXPECT_THROW(EstimateRun(work), std::invalid_argument);
  EXPECT_THROW(PlanRun({}), std::exception);
}

}  // namespace
}  // namespace bodyloom::run_estimate_test
