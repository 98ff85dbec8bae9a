// SPDX-License-Identifier: Apache-2.0
// `bodyloom train photo` and `bodyloom animate photo`, from synthetic people to a video.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/weights_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::train_photo_verb_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TrainPhotoVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (BODYLOOM_HAS_NEURAL == 0) GTEST_SKIP() << "built without LibTorch";
    const CommandResult made =
        RunCommand({"synth-people", "--motions", "demo", "--out", scratch_ / "people", "--people", "3", "--test-share",
                    "0.34", "--actions", "1", "--views", "2", "--frames", "2", "--size", "96", "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  CommandResult Train(const std::string& run, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"train",        "photo",     "--data", scratch_ / "people", "--out",
                                          scratch_ / run, "--profile", "tiny",   "--batch",           "1",
                                          "--threads",    "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  CommandResult Animate(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"animate",   "photo",
                                          "--run",     scratch_ / "run",
                                          "--image",   scratch_ / "people/p000/a0_v0",
                                          "--track",   scratch_ / "people/p001/a0_v0/track.npz",
                                          "--out",     scratch_ / "a.mp4",
                                          "--threads", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  ScratchFolder scratch_;
};

TEST_F(TrainPhotoVerb, TrainsGoesOnAndAnimates) {
  const CommandResult trained = Train("run", {"--steps", "2", "--validate-every", "2"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("the discriminator joins after step 1 of 2"));
  std::ifstream config(scratch_ / "run/config.json");
  EXPECT_THAT(std::string((std::istreambuf_iterator<char>(config)), {}), HasSubstr("\"gan_from\": 0.5"));
  EXPECT_THAT(trained.out, HasSubstr("2 people to train on, 1 kept for validation"));
  EXPECT_THAT(trained.out, HasSubstr("step 2 of 2"));
  EXPECT_THAT(trained.out, HasSubstr("random-feature substitute"));
  EXPECT_THAT(trained.out, HasSubstr("loss switched off: face"));
  EXPECT_THAT(trained.out, HasSubstr("validation of 2 pairs (true labels and bodies given)"));
  for (const char* file : {"config.json", "checkpoint.bin", "metrics.csv", "preview_000002.png"}) {
    EXPECT_TRUE(fs::exists(scratch_ / ("run/" + std::string(file)))) << file;
  }
  EXPECT_EQ(Train("run", {"--steps", "3"}).exit_code, 2) << "took the folder of another run";
  const CommandResult resumed = Train("run", {"--steps", "3", "--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.out, HasSubstr("step 3 of 3"));

  const CommandResult animated = Animate({"--sheet", scratch_ / "a.png", "--texture", scratch_ / "t.png", "--json",
                                          scratch_ / "a.json", "--view-yaw", "0:90", "--background", "studio",
                                          "--garment-from", (scratch_ / "people/p002/a0_v0") + "::1", "--parts",
                                          "top,bottom", "--views", (scratch_ / "people/p000/a0_v1") + "::1"});
  ASSERT_EQ(animated.exit_code, 0) << animated.err;
  EXPECT_THAT(animated.out, HasSubstr("2 frames"));
  VideoReader video(scratch_ / "a.mp4");
  EXPECT_GT(video.info().width, 32);
  EXPECT_EQ(ReadImage(scratch_ / "t.png").width, 128);
  EXPECT_TRUE(fs::exists(scratch_ / "a.png"));
  std::ifstream json(scratch_ / "a.json");
  const std::string report((std::istreambuf_iterator<char>(json)), {});
  EXPECT_THAT(report, HasSubstr("\"texels_seen\""));
  EXPECT_THAT(report, HasSubstr("\"frames_per_second\""));

  const CommandResult large = Animate({"--full-size", "--background", "photo"});
  ASSERT_EQ(large.exit_code, 0) << large.err;
  VideoReader large_video(scratch_ / "a.mp4");
  EXPECT_EQ(large_video.info().width, ReadImage(scratch_ / "people/p000/a0_v0/images/000000.png").width);
}

/// Both renderers of one photo draw the same pictures from the same photos, whatever they are given.
TEST_F(TrainPhotoVerb, PeopleAreScoredUnderOneProtocol) {
  ASSERT_EQ(Train("photo", {"--steps", "1"}).exit_code, 0);
  const CommandResult guided =
      RunCommand({"train", "guided", "--data", scratch_ / "people", "--out", scratch_ / "guided", "--profile", "tiny",
                  "--batch", "1", "--threads", "1", "--steps", "1"});
  ASSERT_EQ(guided.exit_code, 0) << guided.err;
  const auto score = [&](const std::string& verb, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"animate",   verb,
                                          "--run",     scratch_ / verb,
                                          "--score",   scratch_ / "people",
                                          "--json",    scratch_ / (verb + ".json"),
                                          "--sheet",   scratch_ / (verb + ".png"),
                                          "--threads", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = RunCommand(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    nlohmann::json json = nlohmann::json::parse(std::ifstream(scratch_ / (verb + ".json")));
    EXPECT_THAT(result.out, HasSubstr(json["given"].get<std::string>() + " given"));
    return json;
  };
  const nlohmann::json photo = score("photo", {}), animate = score("guided", {});
  EXPECT_EQ(photo["given"], "true labels and bodies");
  EXPECT_EQ(photo["scores"][0]["frames"], 3);
  EXPECT_FALSE(photo["scores"][0].contains("label_iou")) << "it draws none";
  ASSERT_EQ(photo["scores"][0]["lpips_of_people_random_features"].size(), 1) << "the person kept for testing";
  EXPECT_EQ(photo["scores"][0]["lpips_of_people_random_features"][0].size(), 3) << "a figure an image";
  EXPECT_TRUE(animate["scores"][0].contains("label_iou"));
  for (const char* value : {"frames", "photos", "texels_seen"}) {
    EXPECT_NEAR(photo["scores"][0][value].get<double>(), animate["scores"][0][value].get<double>(), 0.01) << value;
  }
  const Image of_photo = ReadImage(scratch_ / "photo.png"), of_animate = ReadImage(scratch_ / "guided.png");
  ASSERT_EQ(of_photo.width, of_animate.width);
  int same = 0, other = 0;
  for (int x = 0; x < of_photo.width; ++x) {  // photo, what it shows, result, truth
    const bool given = x < of_photo.width / 4 - 8 || x > 3 * of_photo.width / 4 + 8;
    for (int y = 0; y < of_photo.height; ++y) {
      const bool alike = std::equal(of_photo.pixel(x, y), of_photo.pixel(x, y) + 3, of_animate.pixel(x, y));
      ASSERT_TRUE(alike || !given) << x << ", " << y;
      same += given ? 1 : 0;
      other += given || alike ? 0 : 1;
    }
  }
  EXPECT_GT(same, 1000);
  EXPECT_GT(other, 100);

  // Methods without training draw the same images from the same photos; a textured body is better than the photo warped
  // by the body, which is better than nothing.
  const auto untrained = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"animate",        "person", "--score", scratch_ / "people",
                                          "--size",         "128",    "--json",  scratch_ / (name + ".json"),
                                          "--texture-size", "128",    "--sheet", scratch_ / (name + ".png"),
                                          "--threads",      "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = RunCommand(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("given): SSIM"));
    return nlohmann::json::parse(std::ifstream(scratch_ / (name + ".json")));
  };
  const nlohmann::json person = untrained("person", {}), floor = untrained("floor", {"--score-floor"});
  const Image of_person = ReadImage(scratch_ / "person.png");
  ASSERT_EQ(of_person.width, of_photo.width);
  for (int y = 0; y < of_photo.height; ++y) {
    ASSERT_TRUE(std::equal(of_photo.pixel(0, y), of_photo.pixel(of_photo.width / 4 - 8, y), of_person.pixel(0, y)))
        << y;
  }
  EXPECT_EQ(person["scores"][0]["frames"], 3);
  EXPECT_FALSE(person["scores"][0].contains("label_iou"));
  EXPECT_GT(person["scores"][0]["psnr_db"], floor["scores"][0]["psnr_db"].get<double>() + 1);
  EXPECT_GT(person["scores"][0]["silhouette_iou"], floor["scores"][0]["silhouette_iou"].get<double>());
  EXPECT_GT(person["scores"][0]["ssim"], photo["scores"][0]["ssim"].get<double>()) << "of one step of training";
  const nlohmann::json guessed = untrained("labels", {"--score-labels", "estimated"});
  EXPECT_EQ(guessed["given"], "estimated labels, true bodies");
  EXPECT_NE(guessed["scores"], person["scores"]);
  const CommandResult no_iuv = RunCommand({"animate", "person", "--score", scratch_ / "people", "--score-iuv"});
  EXPECT_EQ(no_iuv.exit_code, 2);
  EXPECT_THAT(no_iuv.err, HasSubstr("--score-iuv: a body with a texture takes bodies"));

  // The renderer's input is estimated, in part or entirely.
  const nlohmann::json labels = score("photo", {"--score-labels", "estimated"});
  EXPECT_EQ(labels["given"], "estimated labels, true bodies");
  EXPECT_NE(labels["scores"][0]["texels_seen"], photo["scores"][0]["texels_seen"]);
  const nlohmann::json own = score("photo", {"--score-tracks", "track.npz"});
  EXPECT_EQ(own["scores"], photo["scores"]);
  for (const char* clip : {"a0_v0", "a0_v1"}) {
    const std::string folder = scratch_ / ("people/p002/" + std::string(clip) + "/");
    Track track = ReadTrack(folder + "track.npz");
    track.motion.poses.col(16 * 3 + 2).array() += 0.3;  // an upper arm
    WriteTrack(folder + "tracked.npz", track);
  }
  const nlohmann::json bodies = score("guided", {"--score-tracks", "tracked.npz"});
  EXPECT_EQ(bodies["given"], "true labels, bodies of tracked.npz");
  EXPECT_NE(bodies["scores"], animate["scores"]);
  for (const std::string verb : {"photo", "guided"}) {
    const nlohmann::json& truth = verb == "photo" ? photo : animate;
    const nlohmann::json iuv = score(verb, {"--score-iuv"});
    EXPECT_EQ(iuv["given"], "true labels, true bodies, IUV images");
    EXPECT_NE(iuv["scores"], truth["scores"]);
    EXPECT_NEAR(iuv["scores"][0]["texels_seen"].get<double>(), truth["scores"][0]["texels_seen"].get<double>(), 0.08);
  }
  const auto fails = [&](const std::vector<std::string>& more, int code, const std::string& says) {
    std::vector<std::string> arguments = {"animate", "photo", "--run", scratch_ / "photo"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = RunCommand(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(says));
  };
  fails({"--score", scratch_ / "people", "--score-tracks", "no.npz"}, 1, "no.npz");
  fails({"--score", scratch_ / "people", "--view-yaw", "30"}, 2, "--score measures people as they are");
  fails({"--image", scratch_ / "people/p002/a0_v0", "--out", scratch_ / "a.mp4", "--score-iuv"}, 2,
        "belong to --score");
  fails({"--image", scratch_ / "people/p002/a0_v0", "--out", scratch_ / "a.mp4"}, 2, "--track is needed");
  fails({}, 2, "--image and --out");
}

TEST_F(TrainPhotoVerb, IuvImagesStandInForTheBody) {
  ASSERT_EQ(Train("run", {"--steps", "1"}).exit_code, 0);
  const auto sheet = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"--sheet", scratch_ / "a.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = Animate(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return ReadImage(scratch_ / "a.png").bgr;
  };
  const std::string photo = scratch_ / "people/p000/a0_v0/iuv", motion = scratch_ / "people/p001/a0_v0/iuv";
  const std::vector<uint8_t> plain = sheet({}), of_photo = sheet({"--image-iuv", photo});
  EXPECT_NE(of_photo, plain);
  EXPECT_EQ(sheet({"--image-iuv", photo + "/000000.png"}), of_photo);
  EXPECT_NE(sheet({"--image-iuv", photo, "--image-frame", "1"}), of_photo);
  EXPECT_NE(sheet({"--iuv", motion}), plain);
  EXPECT_EQ(Animate({"--iuv", motion, "--view-yaw", "30"}).exit_code, 2);
  const CommandResult none = Animate({"--iuv", scratch_ / "people/p001/a0_v0/labels"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("labels/"));
  EXPECT_EQ(none.NumErrorLines(), 1);
}

TEST_F(TrainPhotoVerb, SaysWhatIsWrong) {
  const auto fails = [&](const CommandResult& result, int code, const std::string& says) {
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(says));
  };
  fails(Train("x", {"--resume"}), 2, "holds no run");
  fails(Train("x", {"--baseline", "best"}), 2, "baseline");
  fails(Train("x", {"--gan-from", "200"}), 2, "gan-from");
  fails(Train("x", {"--weights", scratch_ / "nowhere"}), 1, "nowhere: not a folder");
  fs::create_directories(scratch_ / "weights");
  fails(Train("x", {"--weights", scratch_ / "weights"}), 1, "none of vgg16, vgg19");
  std::ofstream(scratch_ / "weights/vgg19.pth") << "no weights";
  fails(Train("x", {"--weights", scratch_ / "weights"}), 1, "vgg19.pth");
  fs::remove(scratch_ / "weights/vgg19.pth");
  const std::vector<float> values(64 * 3 * 3, 0.1F);
  WriteSafetensors(scratch_ / "weights/vgg19.safetensors",
                   {{"features.0.weight", NdArray::FromFloats(values.data(), {64, 3, 3})}});
  const CommandResult shape = Train("x", {"--weights", scratch_ / "weights"});
  fails(shape, 1, "vgg19.safetensors: tensor features.0.weight");
  EXPECT_EQ(fs::exists(scratch_ / "x/checkpoint.bin"), false);

  ASSERT_EQ(Train("run", {"--steps", "1", "--baseline", "warp"}).exit_code, 0);
  fails(Animate({"--garment-from", scratch_ / "people/p002/a0_v0"}), 2, "belong together");
  fails(Animate({"--garment-from", scratch_ / "people/p002/a0_v0", "--parts", "hat"}), 2, "--parts hat");
  fails(Animate({"--garment-from", scratch_ / "nobody", "--parts", "top"}), 1, "nobody");
  fails(Animate({"--image-frame", "7"}), 1, "requested frame 7");
  fails(Animate({"--view-yaw", "left"}), 2, "--view-yaw left");

  // The run's files: another config, a checkpoint that was cut off.
  std::ifstream config(scratch_ / "run/config.json");
  const std::string text((std::istreambuf_iterator<char>(config)), {});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    std::ofstream(scratch_ / "run/config.json") << changed;
    return Animate();
  };
  fails(with("\"warp\"", "\"full\""), 1, "checkpoint.bin");
  fails(with("\"warp\"", "\"best\""), 1, "config.json");
  fails(with("\"features\": 16", "\"features\": 1e9"), 1, "config.json");
  fails(with("\"features\": 16", "\"features\": \"many\""), 1, "config.json: features");
  fails(with("train photo", "train motion"), 1, "a run of \"bodyloom train motion\"");
  for (size_t size = 0; size < text.size(); size += text.size() / 5) {
    std::ofstream(scratch_ / "run/config.json") << text.substr(0, size);
    fails(Animate(), 1, "config.json");
  }
  std::ofstream(scratch_ / "run/config.json") << text;
  fs::resize_file(scratch_ / "run/checkpoint.bin", 1000);
  const CommandResult cut = Animate();
  fails(cut, 1, "checkpoint.bin");
  EXPECT_EQ(cut.NumErrorLines(), 1);
  EXPECT_FALSE(fs::exists(scratch_ / "a.mp4"));
}

}  // namespace
}  // namespace bodyloom::train_photo_verb_test
