// SPDX-License-Identifier: Apache-2.0
// `bodyloom train refiner`, and what it makes at `animate person --score`, on synthetic people.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TrainRefinerVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (BODYLOOM_HAS_NEURAL == 0) GTEST_SKIP() << "built without LibTorch";
    const CommandResult made =
        RunCommand({"synth-people", "--motions", "demo", "--out", scratch_ / "people", "--people", "2", "--actions",
                    "1", "--views", "2", "--frames", "2", "--test-share", "0.5", "--size", "128", "--threads", "1"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  CommandResult Train(const std::string& run, const std::vector<std::string>& more = {},
                      const std::string& crop = "64") {
    std::vector<std::string> arguments = {"train", "refiner", "--data", scratch_ / "people", "--out", scratch_ / run};
    arguments.insert(arguments.end(),
                     {"--size", "128", "--texture-size", "128", "--batch", "1", "--threads", "1", "--crop", crop});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  /// PSNR of the test person's pictures.
  double Scored(const std::string& refiner) {
    const CommandResult scored =
        RunCommand({"animate", "person", "--score", scratch_ / "people", "--size", "128", "--texture-size", "128",
                    "--score-frames", "2", "--refiner", refiner, "--json", scratch_ / "s.json", "--threads", "1"});
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
    return nlohmann::json::parse(std::ifstream(scratch_ / "s.json"))["scores"][0]["psnr_db"];
  }
  ScratchFolder scratch_;
};

TEST_F(TrainRefinerVerb, TrainsGoesOnAndRefines) {
  const CommandResult trained = Train("run", {"--steps", "2", "--learning-rate", "0.5"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("step 2 of 2"));
  EXPECT_THAT(trained.out, HasSubstr("pictures of people kept for testing: PSNR"));
  for (const char* file : {"config.json", "checkpoint.bin", "metrics.csv", "refiner.npz"}) {
    EXPECT_TRUE(fs::exists(scratch_ / ("run/" + std::string(file)))) << file;
  }
  EXPECT_EQ(Train("run", {"--steps", "3"}).exit_code, 2) << "took the folder of another run";
  const CommandResult resumed = Train("run", {"--steps", "3", "--learning-rate", "0.5", "--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.out, HasSubstr("step 3 of 3"));
  const double drawn = Scored("none"), refined = Scored(scratch_ / "run/refiner.npz");
  EXPECT_NE(drawn, refined);
}

TEST_F(TrainRefinerVerb, SaysWhatIsWrong) {
  EXPECT_THAT(Train("x", {"--resume"}).err, HasSubstr("holds no run"));
  const CommandResult odd = Train("x", {}, "70");
  EXPECT_EQ(odd.exit_code, 2);
  EXPECT_THAT(odd.err, HasSubstr("multiple of 16"));
  const CommandResult nobody =
      RunCommand({"train", "refiner", "--data", scratch_ / "nowhere", "--out", scratch_ / "x"});
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_THAT(nobody.err, HasSubstr("nowhere"));
  const CommandResult weights =
      RunCommand({"animate", "person", "--score", scratch_ / "people", "--refiner", scratch_ / "people/people.json"});
  EXPECT_EQ(weights.exit_code, 1);
  EXPECT_THAT(weights.err, HasSubstr("people.json"));
}

}  // namespace
}  // namespace bodyloom
