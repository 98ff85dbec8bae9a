// SPDX-License-Identifier: Apache-2.0
// `bodyloom train guided` and `bodyloom animate guided`, from synthetic people to a video.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::train_guided_verb_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TrainGuidedVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (BODYLOOM_HAS_NEURAL == 0) GTEST_SKIP() << "built without LibTorch";
    const CommandResult made =
        RunCommand({"synth-people", "--motions", "demo", "--out", scratch_ / "people", "--people", "2", "--actions",
                    "1", "--views", "2", "--frames", "3", "--test-share", "0.5", "--size", "96", "--threads", "1"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  CommandResult Train(const std::string& run, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {
        "train", "guided",       "--data", scratch_ / "people", "--out", scratch_ / run, "--profile",
        "tiny",  "--image-size", "64",     "--batch",           "2",     "--threads",    "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  CommandResult Animate(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"animate", "guided", "--run", scratch_ / "run", "--threads", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  ScratchFolder scratch_;
};

TEST_F(TrainGuidedVerb, TrainsGoesOnAndAnimates) {
  const CommandResult trained = Train("run", {"--steps", "3", "--balance-steps", "2", "--without", "kl"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("1 people to train on, 1 kept for validation"));
  EXPECT_THAT(trained.out, HasSubstr("step 3 of 3"));
  EXPECT_THAT(trained.out, HasSubstr("random-feature substitute"));
  EXPECT_THAT(trained.out, HasSubstr("weights of the losses: VGG"));
  for (const char* file : {"config.json", "checkpoint.bin", "metrics.csv", "preview_000003.png"}) {
    EXPECT_TRUE(fs::exists(scratch_ / ("run/" + std::string(file)))) << file;
  }
  EXPECT_EQ(Train("run", {"--steps", "4"}).exit_code, 2) << "took the folder of another run";
  const CommandResult resumed = Train("run", {"--steps", "4", "--balance-steps", "2", "--without", "kl", "--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.out, HasSubstr("step 4 of 4"));

  const std::string one = scratch_ / "people/p001/a0_v0", other = scratch_ / "people/p001/a0_v1";
  const CommandResult animated = Animate({"--image", one, "--image-frame", "1", "--views", other + "::2", "--data",
                                          other, "--out", scratch_ / "a.mp4", "--sheet", scratch_ / "a.png",
                                          "--uv-maps", scratch_ / "maps.png", "--json", scratch_ / "a.json"});
  ASSERT_EQ(animated.exit_code, 0) << animated.err;
  EXPECT_THAT(animated.out, HasSubstr("3 frames"));
  EXPECT_THAT(animated.out, HasSubstr("silhouette IoU"));
  VideoReader video(scratch_ / "a.mp4");
  EXPECT_EQ(video.info().width, 64);  // the picture at the size at which the person fills the window
  EXPECT_TRUE(fs::exists(scratch_ / "a.png"));
  EXPECT_TRUE(fs::exists(scratch_ / "maps.png"));
  const nlohmann::json report = nlohmann::json::parse(std::ifstream(scratch_ / "a.json"));
  EXPECT_EQ(report["photos"], 2);
  EXPECT_EQ(report["scores"]["frames"], 2) << "frame 2 is one of the photos";
  // Named by what measures, on the screen and in the file.
  EXPECT_THAT(trained.out, HasSubstr("LPIPS (random features) "));
  EXPECT_THAT(animated.out, HasSubstr("LPIPS (random features) "));
  EXPECT_THAT(animated.out, HasSubstr("CS (random features, a quarter of the channels) "));
  for (const char* score :
       {"lpips_random_features", "lpips_deviation_random_features", "contextual_quarter_random_features"}) {
    EXPECT_TRUE(report["scores"].contains(score)) << score;
  }
  EXPECT_GT(report["computed_share"].get<double>(), 0.1);

  const CommandResult scored = Animate({"--score", scratch_ / "people", "--score-photos", "1", "2", "--score-frames",
                                        "2", "--json", scratch_ / "s.json"});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const nlohmann::json scores = nlohmann::json::parse(std::ifstream(scratch_ / "s.json"))["scores"];
  ASSERT_EQ(scores.size(), 2U);
  EXPECT_THAT(scored.out, HasSubstr("true labels and bodies given"));
  EXPECT_THAT(trained.out, HasSubstr("true labels and bodies given"));
  EXPECT_EQ(nlohmann::json::parse(std::ifstream(scratch_ / "s.json"))["given"], "true labels and bodies");
  EXPECT_EQ(scores[0]["frames"], 2);
  EXPECT_GT(scores[1]["texels_seen"].get<double>(), scores[0]["texels_seen"].get<double>());

  const CommandResult as_seen = Animate({"--image", one, "--track", other + "/track.npz", "--out", scratch_ / "b.mp4",
                                         "--as-seen", "--whole-window", "--background", "studio"});
  EXPECT_EQ(as_seen.exit_code, 0) << as_seen.err;
  const CommandResult drawn =
      Animate({"--image", one, "--track", other + "/track.npz", "--out", scratch_ / "c.mp4", "--virtual-views",
               "--uv-maps", scratch_ / "drawn.png", "--json", scratch_ / "c.json", "--background", "studio"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(report["completion"], "nearest texels");
  EXPECT_EQ(nlohmann::json::parse(std::ifstream(scratch_ / "c.json"))["completion"], "virtual views");
  EXPECT_GT(ReadImage(scratch_ / "drawn.png").height, ReadImage(scratch_ / "maps.png").height)
      << "the views are on the sheet";
  EXPECT_EQ(Animate({"--image", one, "--virtual-views", "--as-seen"}).exit_code, 2);
  // As `animate photo` has them: from another side, in the motion's shape, in another one's clothes.
  const auto animated_with = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"--image",      one,
                                          "--track",      scratch_ / "people/p000/a0_v0/track.npz",
                                          "--out",        scratch_ / (name + ".mp4"),
                                          "--sheet",      scratch_ / (name + ".png"),
                                          "--json",       scratch_ / (name + ".json"),
                                          "--background", "studio"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = Animate(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return ReadImage(scratch_ / (name + ".png")).bgr;
  };
  const std::vector<uint8_t> plain = animated_with("plain", {});
  EXPECT_EQ(animated_with("same", {"--shape", "photo", "--view-yaw", "0"}), plain);
  EXPECT_NE(animated_with("turned", {"--view-yaw", "0:90"}), plain);
  EXPECT_NE(animated_with("shape", {"--shape", "motion"}), plain);
  const std::string lender = (scratch_ / "people/p000/a0_v0") + "::1";
  EXPECT_NE(animated_with("lent", {"--garment-from", lender, "--parts", "top,bottom"}), plain);
  EXPECT_THAT(nlohmann::json::parse(std::ifstream(scratch_ / "lent.json"))["notes"].get<std::string>(),
              HasSubstr("% of --parts"));
}

TEST_F(TrainGuidedVerb, SaysWhatIsWrong) {
  EXPECT_THAT(Train("x", {"--resume"}).err, HasSubstr("holds no run"));
  EXPECT_EQ(Train("x", {"--without", "hat"}).exit_code, 2);
  const CommandResult odd = RunCommand({"train", "guided", "--data", scratch_ / "people", "--out", scratch_ / "x",
                                        "--profile", "tiny", "--image-size", "70"});
  EXPECT_EQ(odd.exit_code, 2);
  EXPECT_THAT(odd.err, HasSubstr("multiple of 16"));
  ASSERT_EQ(Train("run", {"--steps", "1"}).exit_code, 0);
  const std::string person = scratch_ / "people/p001/a0_v0", track = person + "/track.npz", out = scratch_ / "a.mp4";
  const auto fails = [&](const std::vector<std::string>& arguments, int code, const std::string& says) {
    const CommandResult result = Animate(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(says));
    EXPECT_FALSE(fs::exists(out));
  };
  fails({"--out", out}, 2, "--image and --out");
  fails({"--image", person, "--out", out}, 2, "one of --track and --data");
  fails({"--image", scratch_ / "nobody.png", "--track", track, "--out", out}, 1, "nobody.png");
  fails({"--image", person, "--track", track, "--background", scratch_ / "no.jpg", "--out", out}, 1, "no.jpg");
  fails({"--image", person, "--image-frame", "9", "--track", track, "--out", out}, 1, "requested frame 9");
  fails({"--image", person, "--track", track, "--views", person + ":x:y", "--out", out}, 2, "--views");
  fails({"--score", scratch_ / "run"}, 1, "people.json");
  fails({"--score", scratch_ / "people", "--view-yaw", "30"}, 2, "--score measures people as they are");
  fails({"--image", person, "--data", person, "--out", out, "--view-yaw", "30"}, 2, "--data compares");
  fails({"--image", person, "--track", track, "--out", out, "--view-yaw", "left"}, 2, "--view-yaw left");
  fails({"--image", person, "--track", track, "--out", out, "--garment-from", person}, 2, "belong together");
  fails({"--image", person, "--track", track, "--out", out, "--garment-from", person, "--parts", "hat"}, 2,
        "--parts hat");
  fs::create_directories(scratch_ / "empty");
  const std::string empty = scratch_ / "empty";
  fails({"--score", scratch_ / "people", "--weights", empty}, 1, "empty: none of vgg16");
  fails({"--image", person, "--data", person, "--out", out, "--weights", empty}, 1, "empty: none of vgg16");
  fails({"--image", person, "--track", track, "--out", out, "--weights", empty}, 2, "--weights");

  // A run whose checkpoint was cut off, one of another profile, and no run at all.
  const std::string config = scratch_ / "run/config.json", checkpoint = scratch_ / "run/checkpoint.bin";
  std::ifstream file(config);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  std::string changed = text;
  changed.replace(changed.find("\"latent\": 16"), 12, "\"latent\": 17");
  std::ofstream(config) << changed;
  fails({"--image", person, "--track", track, "--out", out}, 1, "checkpoint.bin");
  changed = text;
  changed.replace(changed.find("\"without\": []"), 13, "\"without\": [\"hat\"]");
  std::ofstream(config) << changed;
  fails({"--image", person, "--track", track, "--out", out}, 1, "config.json: without: part \"hat\"");
  std::ofstream(config) << text.substr(0, text.size() / 2);
  fails({"--image", person, "--track", track, "--out", out}, 1, "config.json");
  std::ofstream(config) << text;
  fs::resize_file(checkpoint, 1000);
  fails({"--image", person, "--track", track, "--out", out}, 1, "checkpoint.bin");
  fs::remove(config);
  fails({"--image", person, "--track", track, "--out", out}, 1, "config.json: not there");
}

}  // namespace
}  // namespace bodyloom::train_guided_verb_test
