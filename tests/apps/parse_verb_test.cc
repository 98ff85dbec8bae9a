// SPDX-License-Identifier: Apache-2.0
// `bodyloom parse`, on a real photo.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>

#include <string>
#include <vector>

#include "data_tools/learned/parser_weights_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/support/paths.h"
#include "tests/support/random_image_unet.h"
#include "tests/support/real_video.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::parse_verb_test {
namespace {

using ::testing::HasSubstr;

class ParseVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (CommandPath().empty()) GTEST_SKIP() << "built without apps/";
    const std::string video = SharedDir() + "/data/tfjs_pose/pose_squats.mp4";
    const std::string why_not = WhyNoDetection(video);
    if (!why_not.empty()) GTEST_SKIP() << why_not;
    Image photo;
    VideoReader(video).Read(&photo);
    WriteImage(scratch_ / "photo.png", photo);
    width_ = photo.width, height_ = photo.height;
  }
  CommandResult Parse(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"parse", scratch_ / "photo.png", "--out", scratch_ / "labels.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  ScratchFolder scratch_;
  int width_ = 0, height_ = 0;
};

TEST_F(ParseVerb, WritesLabelsAndWhatTheyLookLike) {
  const CommandResult parsed = Parse({"--picture", scratch_ / "shown.png"});
  ASSERT_EQ(parsed.exit_code, 0) << parsed.err;
  EXPECT_THAT(parsed.out, HasSubstr("pixels of the person: top "));
  const Image labels = ReadImage(scratch_ / "labels.png"), shown = ReadImage(scratch_ / "shown.png");
  ASSERT_EQ(labels.width, width_);
  ASSERT_EQ(labels.height, height_);
  ASSERT_EQ(shown.width, width_);
  std::vector<size_t> count(256);
  for (size_t i = 0; i < labels.bgr.size(); i += 3) ++count[labels.bgr[i]];
  EXPECT_GT(count[0], labels.bgr.size() / 6) << "most of it is background";
  EXPECT_GT(count[1], count[0] / 50) << "top";
  EXPECT_GT(count[2], count[0] / 50) << "bottom";
  EXPECT_GT(count[4], count[0] / 500) << "hair";
  EXPECT_EQ(count[7], 0U);
}

TEST_F(ParseVerb, AsksWhereTheLabelsGo) {
  const CommandResult nowhere = RunCommand({"parse", scratch_ / "photo.png"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("--out or --picture"));
}

TEST_F(ParseVerb, TakesWeights) {
  WriteParserWeights(scratch_ / "parser.npz", RandomParser(1));
  const CommandResult parsed = Parse({"--weights", scratch_ / "parser.npz"});
  ASSERT_EQ(parsed.exit_code, 0) << parsed.err;
  const Image by_weights = ReadImage(scratch_ / "labels.png");
  ASSERT_EQ(Parse({"--weights", "body"}).exit_code, 0);
  const Image by_body = ReadImage(scratch_ / "labels.png");
  EXPECT_NE(by_weights.bgr, by_body.bgr);
  for (size_t i = 0; i < by_body.bgr.size(); i += 3) ASSERT_EQ(by_weights.bgr[i] == 0, by_body.bgr[i] == 0) << i;
  const CommandResult wrong = Parse({"--weights", scratch_ / "photo.png"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("photo.png"));
}

namespace fs = std::filesystem;

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

// `bodyloom train parser`, on synthetic people.

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

}  // namespace bodyloom::parse_verb_test
