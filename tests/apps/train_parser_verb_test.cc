// SPDX-License-Identifier: Apache-2.0
// `bodyloom train parser`, on synthetic people.
#include <gmock/gmock.h>

#include <filesystem>

#include "data_tools/learned/parser_weights_io.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::train_parser_verb_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TrainParserVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (BODYLOOM_HAS_NEURAL == 0) GTEST_SKIP() << "built without LibTorch";
    const CommandResult made =
        RunCommand({"synth-people", "--motions", "demo", "--out", scratch_ / "people", "--people", "2", "--actions",
                    "1", "--views", "2", "--frames", "2", "--test-share", "0.5", "--size", "128", "--threads", "1"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  CommandResult Train(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"train", "parser", "--data", scratch_ / "people", "--out", scratch_ / "run"};
    arguments.insert(arguments.end(), {"--size", "128", "--batch", "1", "--threads", "1"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  ScratchFolder scratch_;
};

TEST_F(TrainParserVerb, TrainsGoesOnAndWritesWeights) {
  const CommandResult trained = Train({"--steps", "2", "--crop", "64"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("step 2 of 2"));
  EXPECT_THAT(trained.out, HasSubstr("intersection over union"));
  // A bar each: training does not begin where reading has ended.
  EXPECT_THAT(trained.err, HasSubstr("people 100 % read\npeople for validation 100 % read\ntraining 2 steps"));
  for (const char* file : {"config.json", "checkpoint.bin", "metrics.csv", "parser.npz"}) {
    EXPECT_TRUE(fs::exists(scratch_ / ("run/" + std::string(file)))) << file;
  }
  EXPECT_EQ(Train({"--steps", "3", "--crop", "64"}).exit_code, 2) << "took the folder of another run";
  const CommandResult resumed = Train({"--steps", "3", "--crop", "64", "--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  const ParserWeights weights = ReadParserWeights(scratch_ / "run/parser.npz");
  EXPECT_GT(weights.pixels_per_metre, 20);
  EXPECT_LT(weights.pixels_per_metre, 128);
  EXPECT_THAT(weights.recipe, HasSubstr("bodyloom train parser"));
}

TEST_F(TrainParserVerb, SaysWhatIsWrong) {
  const CommandResult odd = Train({"--crop", "70"});
  EXPECT_EQ(odd.exit_code, 2);
  EXPECT_THAT(odd.err, HasSubstr("multiple of 16"));
  const CommandResult nobody = RunCommand({"train", "parser", "--data", scratch_ / "nowhere", "--out", scratch_ / "x"});
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_THAT(nobody.err, HasSubstr("nowhere"));
}

}  // namespace
}  // namespace bodyloom::train_parser_verb_test
