// SPDX-License-Identifier: Apache-2.0
// `bodyloom train motion` and `bodyloom animate motion`, from a synthetic person to a video.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "data_tools/motion/track_io.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "geometry/scene/track_edits.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom::train_motion_verb_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TrainMotionVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (BODYLOOM_HAS_NEURAL == 0) GTEST_SKIP() << "built without LibTorch";
    const CommandResult made = RunCommand({"synth-person", "--motion", "demo", "--first", "60", "--frames", "14",
                                           "--out", scratch_ / "person", "--size", "96", "--garment", "skirt"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  CommandResult Train(const std::string& run, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"train",        "motion",    "--data", scratch_ / "person", "--out",
                                          scratch_ / run, "--profile", "tiny",   "--batch",           "2",
                                          "--threads",    "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  ScratchFolder scratch_;
};

TEST_F(TrainMotionVerb, TimeStandsStillWhileTheViewTurns) {
  ASSERT_EQ(Train("run", {"--steps", "1", "--train", "0-9", "--validate", "10-10"}).exit_code, 0);
  const auto animate = [&](const std::string& freeze) {
    return RunCommand({"animate", "motion", "--run", scratch_ / "run", "--track", scratch_ / "person/track.npz",
                       "--out", scratch_ / "a.mp4", "--warmup", "0", "--freeze", freeze, "--view-yaw", "0:90"});
  };
  const CommandResult frozen = animate("5:4");
  ASSERT_EQ(frozen.exit_code, 0) << frozen.err;
  VideoReader video(scratch_ / "a.mp4");
  Image image;
  int frames = 0;
  while (video.Read(&image)) ++frames;
  EXPECT_EQ(frames, 18);
  for (const char* wrong : {"14:4", "-1:4", "5", "5:0", "5:4x"}) {
    const CommandResult refused = animate(wrong);
    EXPECT_EQ(refused.exit_code, 2) << wrong;
    EXPECT_THAT(refused.err, HasSubstr("frames 0 to 13")) << wrong;
  }
}

TEST_F(TrainMotionVerb, MotionIsShownAtTheRunsRate) {
  ASSERT_EQ(Train("run", {"--steps", "1", "--train", "0-9", "--validate", "10-10"}).exit_code, 0);
  const std::string path = scratch_ / "run/config.json";
  std::string text = FileBytes(path);
  const std::string rate = "\"fps\": 30.0";
  ASSERT_NE(text.find(rate), std::string::npos);
  text.replace(text.find(rate), rate.size(), "\"fps\": 15.0");  // as if it had been trained on half the rate
  std::ofstream(path) << text;
  const auto animate = [&](const std::string& option, const std::string& of) {
    return RunCommand({"animate", "motion", "--run", scratch_ / "run", option, scratch_ / of, "--out",
                       scratch_ / "a.mp4", "--warmup", "0"});
  };
  const CommandResult shown = animate("--track", "person/track.npz");
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("30 frames a second, is shown at the run's 15"));
  EXPECT_THAT(shown.out, HasSubstr("7 frames"));
  EXPECT_NEAR(VideoReader(scratch_ / "a.mp4").info().fps, 15, 0.01);
  const CommandResult scored = animate("--data", "person");
  EXPECT_EQ(scored.exit_code, 1);
  EXPECT_THAT(scored.err, HasSubstr("images at 30 frames a second, expected 15 as in training"));
}

TEST_F(TrainMotionVerb, AxesAndVelocitiesAreChosenAsThoseOfDescribe) {
  const CommandResult trained = Train("run", {"--steps", "1", "--train", "0-9", "--validate", "10-10", "--frame",
                                              "body", "--velocity", "central", "--longest-step", "0.1"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("velocities central in the body frame"));
  const nlohmann::json config = nlohmann::json::parse(FileBytes(scratch_ / "run/config.json"));
  EXPECT_EQ(config["surface_motion"]["frame"], "body");
  EXPECT_EQ(config["surface_motion"]["velocity"], "central");
  EXPECT_EQ(config["surface_motion"]["longest_step_s"], 0.1);
  const CommandResult animated =
      RunCommand({"animate", "motion", "--run", scratch_ / "run", "--data", scratch_ / "person", "--out",
                  scratch_ / "a.mp4", "--warmup", "0", "--like", scratch_ / "person"});
  EXPECT_EQ(animated.exit_code, 0) << animated.err;
  EXPECT_THAT(animated.out, HasSubstr("frames of similarity 1.000 and more"));
  EXPECT_EQ(Train("x", {"--velocity", "forward"}).exit_code, 2);
  EXPECT_THAT(Train("x", {"--cameras", scratch_ / "person/track.npz"}).err, HasSubstr("--frame world"));
  EXPECT_THAT(Train("x", {"--window", "0"}).err, HasSubstr("window_s is 0"));
}

TEST_F(TrainMotionVerb, WholeWindowsAreWhatOlderRunsLookAt) {
  const CommandResult trained =
      Train("run", {"--steps", "1", "--train", "0-9", "--validate", "10-10", "--whole-window"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("the whole window"));
  const auto animate = [&] {
    return RunCommand({"animate", "motion", "--run", scratch_ / "run", "--track", scratch_ / "person/track.npz",
                       "--out", scratch_ / "a.mp4", "--warmup", "0"});
  };
  const std::string path = scratch_ / "run/config.json";
  std::string text = FileBytes(path);
  const std::string key = "  \"around_body\": false,\n";
  ASSERT_NE(text.find(key), std::string::npos);
  text.erase(text.find(key), key.size());  // as these runs wrote it
  std::ofstream(path) << text;
  EXPECT_EQ(animate().exit_code, 0) << animate().err;
  text.insert(text.find("  \"pixels_per_metre\""), "  \"around_body\": true,\n");
  std::ofstream(path) << text;
  EXPECT_THAT(animate().err, HasSubstr("checkpoint.bin")) << "networks of whole windows taken for others";
}

TEST_F(TrainMotionVerb, TrainsGoesOnAndAnimates) {
  const CommandResult trained =
      Train("run", {"--steps", "3", "--train", "0-9", "--validate", "10-13", "--validate-every", "3"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("step 3 of 3"));
  EXPECT_THAT(trained.out, HasSubstr("random-feature substitute"));
  EXPECT_THAT(trained.out, HasSubstr("validation: L1"));
  EXPECT_THAT(trained.out, HasSubstr("px around the body"));
  for (const char* file : {"config.json", "checkpoint.bin", "metrics.csv", "preview_000003.png"}) {
    EXPECT_TRUE(fs::exists(scratch_ / ("run/" + std::string(file)))) << file;
  }
  EXPECT_THAT(FileBytes(scratch_ / "run/config.json"), HasSubstr("\"betas\": ["));
  EXPECT_EQ(Train("run", {"--steps", "5"}).exit_code, 2) << "took the folder of another run";
  const CommandResult resumed = Train("run", {"--steps", "5", "--train", "0-9", "--validate", "10-13", "--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.out, HasSubstr("step 5 of 5"));

  const CommandResult animated = RunCommand({"animate",      "motion",
                                             "--run",        scratch_ / "run",
                                             "--data",       scratch_ / "person",
                                             "--out",        scratch_ / "a.mp4",
                                             "--sheet",      scratch_ / "a.png",
                                             "--json",       scratch_ / "a.json",
                                             "--warmup",     "2",
                                             "--threads",    "1",
                                             "--like",       scratch_ / "person",
                                             "--frames",     scratch_ / "a.csv",
                                             "--background", scratch_ / "person/backgrounds"});
  ASSERT_EQ(animated.exit_code, 0) << animated.err;
  // Every frame that the run was trained on is like itself, the later ones are not.
  EXPECT_THAT(animated.out, HasSubstr("frames of similarity 1.000 and more"));
  std::ifstream csv(scratch_ / "a.csv");
  std::string line;
  int lines = 0;
  for (std::getline(csv, line); std::getline(csv, line); ++lines) {
    const double similarity = std::stod(line.substr(line.rfind(',') + 1));
    if (lines < 10) {
      EXPECT_NEAR(similarity, 1, 1e-3) << line;
    } else {
      EXPECT_LT(similarity, 0.999) << line;
    }
  }
  EXPECT_EQ(lines, 14);
  EXPECT_THAT(animated.out, HasSubstr("14 frames"));
  for (const std::string& text : {trained.out, animated.out}) {
    for (const char* score : {"SSIM ", "tLPIPS (random features) ", ", LPIPS (random features) "}) {
      EXPECT_THAT(text, HasSubstr(score));
    }
  }
  const nlohmann::json scores = nlohmann::json::parse(FileBytes(scratch_ / "a.json"))["scores"];
  for (const char* score : {"ssim", "lpips", "tlpips"}) {
    EXPECT_GT(scores[score], 0) << score;
    EXPECT_GT(scores["by_similarity"][3][score], 0) << score;
  }
  EXPECT_EQ(scores["ssim_preset"], "wang2004");
  EXPECT_EQ(scores["lpips_of_random_features"], true);
  EXPECT_EQ(FileBytes(scratch_ / "a.csv").rfind("frame,image_l1,ssim,lpips,tlpips,similarity\n0,0.", 0), 0U);
  EXPECT_THAT(animated.out, HasSubstr("silhouette IoU"));
  EXPECT_THAT(animated.out, HasSubstr("dB of the whole image"));
  VideoReader video(scratch_ / "a.mp4");
  EXPECT_EQ(video.info().width, 96);
  EXPECT_TRUE(fs::exists(scratch_ / "a.png"));
  const CommandResult turned =
      RunCommand({"animate", "motion", "--run", scratch_ / "run", "--track", scratch_ / "person/track.npz", "--out",
                  scratch_ / "b.mp4", "--view-yaw", "0:90", "--warmup", "0", "--threads", "1"});
  EXPECT_EQ(turned.exit_code, 0) << turned.err;

  // The pictures as a single-person dataset, which `metrics` compares with the truth, part by part.
  const CommandResult as_set =
      RunCommand({"animate", "motion", "--run", scratch_ / "run", "--data", scratch_ / "person", "--out",
                  scratch_ / "c.mp4", "--full-size", "--set", scratch_ / "set", "--warmup", "2", "--threads", "1"});
  ASSERT_EQ(as_set.exit_code, 0) << as_set.err;
  std::ifstream set_info(scratch_ / "set/person.json");
  const std::string info((std::istreambuf_iterator<char>(set_info)), {});
  EXPECT_THAT(info, HasSubstr("bodyloom animate motion --run " + std::string(scratch_ / "run") + " --data " +
                              std::string(scratch_ / "person") + " --warmup 2 --full-size --out " +
                              std::string(scratch_ / "c.mp4") + " --set " + std::string(scratch_ / "set")));
  const CommandResult compared =
      RunCommand({"metrics", "--truth", scratch_ / "person", "--result", scratch_ / "set", "--quiet"});
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_THAT(compared.out, HasSubstr("images: 14 frames"));
  EXPECT_THAT(compared.out, HasSubstr("labels: 14 frames"));
  EXPECT_THAT(compared.out, HasSubstr("normals: 14 frames"));
  const CommandResult no_size = RunCommand({"animate", "motion", "--run", scratch_ / "run", "--data",
                                            scratch_ / "person", "--out", scratch_ / "c.mp4", "--set", scratch_ / "s"});
  EXPECT_EQ(no_size.exit_code, 2);
  EXPECT_THAT(no_size.err, HasSubstr("--set requires --full-size"));

  // Half as fast: twice the frames, less one.
  const CommandResult slow =
      RunCommand({"animate", "motion", "--run", scratch_ / "run", "--track", scratch_ / "person/track.npz", "--out",
                  scratch_ / "slow.mp4", "--speed", "0.5", "--warmup", "0", "--threads", "1"});
  EXPECT_EQ(slow.exit_code, 0) << slow.err;
  EXPECT_THAT(slow.out, HasSubstr("27 frames"));

  // Other light: from a file of lights, and from an environment that is bright on one side.
  const auto relight = [&](const std::string& light) {
    return RunCommand({"animate", "motion", "--run", scratch_ / "run", "--track", scratch_ / "person/track.npz",
                       "--out", scratch_ / "light.mp4", "--relight", scratch_ / light, "--json",
                       scratch_ / "light.json", "--warmup", "0", "--threads", "1"});
  };
  std::ofstream(scratch_ / "light.json")
      << R"({"directional": [{"from": [1, 0.5, 1], "intensity": 1}], "ambient": 0.3})";
  fs::rename(scratch_ / "light.json", scratch_ / "lights.json");
  const CommandResult lit = relight("lights.json");
  EXPECT_EQ(lit.exit_code, 0) << lit.err;
  Image environment(32, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) environment.pixel(x, y)[1] = x < 16 ? 250 : 10;
  }
  WriteImage(scratch_ / "sky.png", environment);
  const CommandResult outdoors = relight("sky.png");
  EXPECT_EQ(outdoors.exit_code, 0) << outdoors.err;
  std::ofstream(scratch_ / "dark.json") << R"({"ambient": 0})";
  const CommandResult dark = relight("dark.json");
  EXPECT_EQ(dark.exit_code, 1);
  EXPECT_THAT(dark.err, HasSubstr("all intensities are 0"));
}

TEST_F(TrainMotionVerb, TheLightOfAClipIsThatOfItsPartsOnEitherSideOfACut) {
  ASSERT_EQ(Train("run", {"--steps", "2", "--train", "0-9", "--validate", "10-10", "--without", "shape"}).exit_code, 0);
  std::ofstream(scratch_ / "lights.json") << R"({"ambient": 1})";
  const Track whole = ReadTrack(scratch_ / "person/track.npz");
  const auto light = [&](const std::vector<int>& frames, const std::vector<double>& times) {
    Track track = FramesInOrder(whole, frames);
    track.motion.timestamps = times;
    WriteTrack(scratch_ / "clip.npz", track);
    const CommandResult result = RunCommand(
        {"animate", "motion", "--run", scratch_ / "run", "--track", scratch_ / "clip.npz", "--out", scratch_ / "a.mp4",
         "--relight", scratch_ / "lights.json", "--json", scratch_ / "a.json", "--warmup", "0", "--threads", "1"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(FileBytes(scratch_ / "a.json"))["relight"];
  };
  // One moment shown twice, and the same again after a cut: in the same window, with the same past.
  const double step = 1 / 30.0;
  const nlohmann::json once = light({3, 3}, {0, step}), twice = light({3, 3, 3, 3}, {0, step, 9, 9 + step});
  EXPECT_EQ(twice["samples"], 2 * once["samples"].get<int>());
  for (int k = 0; k < 9; ++k) {
    EXPECT_NEAR(once["coefficients"][k].get<double>(), twice["coefficients"][k].get<double>(), 1e-6) << k;
  }
}

TEST_F(TrainMotionVerb, TheDescriptorOf2dSystemsTrainsAndAnimates) {
  const CommandResult trained =
      Train("run", {"--steps", "2", "--train", "0-9", "--validate", "10-10", "--descriptor", "dense2d"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("dense UV coordinates and keypoints of 10 frames"));
  const nlohmann::json config = nlohmann::json::parse(FileBytes(scratch_ / "run/config.json"));
  EXPECT_EQ(config["descriptor"], "dense2d");
  EXPECT_EQ(config["motion_channels"], 60);
  for (const std::vector<std::string>& motion :
       std::vector<std::vector<std::string>>{{"--data", scratch_ / "person", "--like", scratch_ / "person"},
                                             {"--track", scratch_ / "person/track.npz", "--view-yaw", "0:90"}}) {
    std::vector<std::string> arguments = {"animate", "motion",           "--run",    scratch_ / "run",
                                          "--out",   scratch_ / "a.mp4", "--warmup", "1"};
    arguments.insert(arguments.end(), motion.begin(), motion.end());
    const CommandResult animated = RunCommand(arguments);
    EXPECT_EQ(animated.exit_code, 0) << animated.err;
    EXPECT_THAT(animated.out, HasSubstr("14 frames"));
  }
  EXPECT_EQ(Train("x", {"--descriptor", "keypoints"}).exit_code, 2);
}

TEST_F(TrainMotionVerb, EstimatesFromTheImagesStandInForTheBody) {
  const CommandResult trained = Train("run", {"--steps", "2", "--train", "0-9", "--iuv", "own", "--validate-data",
                                              scratch_ / "person", "--validate", "10-10"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  const auto score = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "animate", "motion",           "--run",  scratch_ / "run",    "--data",   scratch_ / "person",
        "--out",   scratch_ / "a.mp4", "--json", scratch_ / "a.json", "--warmup", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult animated = RunCommand(arguments);
    EXPECT_EQ(animated.exit_code, 0) << animated.err;
    return nlohmann::json::parse(FileBytes(scratch_ / "a.json"))["scores"]["image_l1"].get<double>();
  };
  const double of_body = score({}), of_estimates = score({"--iuv", "own"});
  EXPECT_NE(of_body, of_estimates);
  EXPECT_EQ(of_estimates, score({"--iuv", scratch_ / "person/iuv"}));
  EXPECT_THAT(
      Train("x", {"--steps", "1", "--iuv", scratch_ / "person/iuv", "--validate-data", scratch_ / "person"}).err,
      HasSubstr("expected \"own\""));
  EXPECT_THAT(Train("x", {"--steps", "1", "--iuv", scratch_ / "person/labels"}).err, HasSubstr("labels/000000.png"));
  fs::copy(scratch_ / "person/iuv", scratch_ / "fewer");
  fs::remove(scratch_ / "fewer/000013.png");
  EXPECT_THAT(Train("x", {"--steps", "1", "--iuv", scratch_ / "fewer"}).err,
              HasSubstr("13 IUV images, the track has 14"));
}

TEST_F(TrainMotionVerb, ThePredictedNormalsAreWhatTheLightFallsOn) {
  ASSERT_EQ(Train("run", {"--steps", "2", "--train", "0-9", "--validate", "10-10"}).exit_code, 0);
  std::ofstream(scratch_ / "lights.json") << R"({"directional": [{"from": [1, 0.5, 1]}], "encoding": "linear"})";
  const auto relight = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"animate",   "motion",
                                          "--run",     scratch_ / "run",
                                          "--out",     scratch_ / "a.mp4",
                                          "--relight", scratch_ / "lights.json",
                                          "--warmup",  "1",
                                          "--threads", "1",
                                          "--json",    scratch_ / "a.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  };
  const auto light = [&](const std::vector<std::string>& more) {
    const CommandResult result = relight(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(FileBytes(scratch_ / "a.json"))["relight"]["coefficients"];
  };
  const std::string data = scratch_ / "person", track = scratch_ / "person/track.npz";
  const nlohmann::json predicted = light({"--data", data, "--full-size", "--set", scratch_ / "set"});
  EXPECT_EQ(predicted, light({"--track", track})) << "the dataset's normals are not looked at";
  EXPECT_NE(predicted, light({"--data", data, "--true-normals", "--full-size", "--set", scratch_ / "true"}));
  EXPECT_NE(FileBytes(scratch_ / "set/images/000005.png"), FileBytes(scratch_ / "true/images/000005.png"));
  const auto degrees = [&](const std::string& set) {
    const CommandResult compared =
        RunCommand({"metrics", "--truth", data, "--result", scratch_ / set, "--json", scratch_ / "m.json", "--quiet"});
    EXPECT_EQ(compared.exit_code, 0) << compared.err;
    return nlohmann::json::parse(
               FileBytes(scratch_ / "m.json"))["kinds"]["normals"]["metrics"]["normal_mean_deg"]["mean"]
        .get<double>();
  };
  EXPECT_LT(degrees("true"), 8) << "resampled";
  EXPECT_GT(degrees("set"), 15) << "after two steps";
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
           {"--track", track, "--true-normals"}, {"--data", data, "--true-normals", "--view-yaw", "30"}}) {
    const CommandResult refused = relight(wrong);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("--true-normals"));
  }
}

/// A clip of one's own: pictures, a track, and where the person is.
TEST_F(TrainMotionVerb, AMaskGivesAClipLabelsAndNormalsOfItsOwn) {
  PartLabelSequence mask;
  mask.image_width = mask.image_height = 96;
  for (int t = 0; t < 14; ++t) {
    const Image labels = ReadImage(scratch_ / Concatenate("person/labels/", t < 10 ? "00000" : "0000", t, ".png"));
    LabelImage frame = {0, 0, 96, 96, std::vector<uint8_t>(96 * 96)};
    for (size_t i = 0; i < frame.labels.size(); ++i) frame.labels[i] = labels.bgr[3 * i] != 0 ? 1 : 0;
    mask.frames.emplace_back(frame);
    mask.timestamps.push_back(t / 30.0);
  }
  WriteMask(scratch_ / "mask.npz", mask);
  const auto train = [&](const std::string& run, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"train",      "motion",
                                          "--data",     scratch_ / "person/images",
                                          "--track",    scratch_ / "person/track.npz",
                                          "--out",      scratch_ / run,
                                          "--profile",  "tiny",
                                          "--batch",    "2",
                                          "--threads",  "1",
                                          "--steps",    "2",
                                          "--validate", "10-13",
                                          "--train",    "0-9"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  };
  const CommandResult with_mask = train("with", {"--mask", scratch_ / "mask.npz"});
  ASSERT_EQ(with_mask.exit_code, 0) << with_mask.err;
  EXPECT_THAT(with_mask.out, HasSubstr("within the mask, stand in for a parsing of the clothes"));
  EXPECT_THAT(with_mask.out, HasSubstr("the tracked body's normals stand in for those of the clothes"));
  EXPECT_THAT(with_mask.out, HasSubstr("silhouette IoU"));
  EXPECT_THAT(with_mask.out, HasSubstr("px around the body"));
  const nlohmann::json config = nlohmann::json::parse(FileBytes(scratch_ / "with/config.json"));
  EXPECT_EQ(config["shape"], true);
  EXPECT_EQ(config["normals"], true);
  const CommandResult without = train("without", {});
  ASSERT_EQ(without.exit_code, 0) << without.err;
  EXPECT_THAT(without.out, HasSubstr("no labels: trained without shape"));
  EXPECT_THAT(without.out, HasSubstr("no normals: trained without them"));
  EXPECT_EQ(nlohmann::json::parse(FileBytes(scratch_ / "without/config.json"))["normals"], false);
  // Normals were learned, so the light may be another.
  std::ofstream(scratch_ / "lights.json") << R"({"ambient": 1})";
  const auto relit = [&](const std::string& run) {
    return RunCommand({"animate", "motion", "--run", scratch_ / run, "--track", scratch_ / "person/track.npz", "--out",
                       scratch_ / "a.mp4", "--relight", scratch_ / "lights.json", "--warmup", "0", "--threads", "1"});
  };
  EXPECT_EQ(relit("with").exit_code, 0) << relit("with").err;
  EXPECT_THAT(relit("without").err, HasSubstr("was trained without surface normals"));

  mask.frames.pop_back(), mask.timestamps.pop_back();
  WriteMask(scratch_ / "short.npz", mask);
  EXPECT_THAT(train("x", {"--mask", scratch_ / "short.npz"}).err, HasSubstr("short.npz: 13 frames, the track 14"));
  EXPECT_THAT(Train("x", {"--steps", "1", "--mask", scratch_ / "mask.npz"}).out, HasSubstr("are not used"));
}

TEST_F(TrainMotionVerb, SaysWhatIsWrong) {
  const auto fails = [&](const std::vector<std::string>& arguments, int code, const std::string& says) {
    const CommandResult result = RunCommand(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(says));
  };
  EXPECT_EQ(Train("x", {"--train", "5"}).exit_code, 2);
  EXPECT_THAT(Train("x", {"--train", "0-99"}).err, HasSubstr("the clip has frames 0 to 13"));
  EXPECT_THAT(Train("x", {"--resume"}).err, HasSubstr("holds no run"));
  fails({"train", "motion", "--data", scratch_ / "nobody", "--out", scratch_ / "x"}, 1, "nobody");
  fails({"animate", "motion", "--run", scratch_ / "person", "--track", scratch_ / "person/track.npz", "--out",
         scratch_ / "a.mp4"},
        1, "config.json: not there");
  fails({"animate", "motion", "--run", scratch_ / "run", "--out", scratch_ / "a.mp4"}, 2, "--track and --data");
  EXPECT_EQ(Train("x", {"--device", "gpu"}).exit_code, 2);

  // Weights for the scores: from a folder that holds some, and only where there are scores.
  fs::create_directories(scratch_ / "empty");
  EXPECT_THAT(Train("x", {"--weights", scratch_ / "empty"}).err, HasSubstr("empty: none of vgg16"));

  // A track of another clip.
  const CommandResult other = RunCommand({"synth-person", "--motion", "demo", "--frames", "20", "--out",
                                          scratch_ / "other", "--size", "96", "--garment", "suit"});
  ASSERT_EQ(other.exit_code, 0) << other.err;
  EXPECT_THAT(Train("x", {"--track", scratch_ / "other/track.npz"}).err, HasSubstr("20 frames"));

  // A run whose checkpoint was cut off, and one of another profile.
  ASSERT_EQ(Train("run", {"--steps", "1", "--train", "0-9", "--validate", "10-10"}).exit_code, 0);
  const std::string checkpoint = scratch_ / "run/checkpoint.bin";
  const auto animate = [&] {
    return RunCommand({"animate", "motion", "--run", scratch_ / "run", "--track", scratch_ / "person/track.npz",
                       "--out", scratch_ / "a.mp4"});
  };
  fails({"animate", "motion", "--run", scratch_ / "run", "--data", scratch_ / "person", "--out", scratch_ / "a.mp4",
         "--weights", scratch_ / "empty"},
        1, "empty: none of vgg16");
  fails({"animate", "motion", "--run", scratch_ / "run", "--track", scratch_ / "person/track.npz", "--out",
         scratch_ / "a.mp4", "--weights", scratch_ / "empty"},
        2, "--weights");
  std::ifstream config(scratch_ / "run/config.json");
  std::string text((std::istreambuf_iterator<char>(config)), {});
  std::string changed = text;
  changed.replace(changed.find("\"features\": 8"), 13, "\"features\": 9");
  std::ofstream(scratch_ / "run/config.json") << changed;
  EXPECT_THAT(animate().err, HasSubstr("checkpoint.bin"));
  std::ofstream(scratch_ / "run/config.json") << text;
  fs::resize_file(checkpoint, 1000);
  const CommandResult cut = animate();
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_THAT(cut.err, HasSubstr("checkpoint.bin"));
  EXPECT_EQ(cut.NumErrorLines(), 1);
  EXPECT_FALSE(fs::exists(scratch_ / "a.mp4"));
}

}  // namespace
}  // namespace bodyloom::train_motion_verb_test
