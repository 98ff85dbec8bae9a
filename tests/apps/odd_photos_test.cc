// SPDX-License-Identifier: Apache-2.0
// `bodyloom animate photo` and `bodyloom animate guided` on typical users' photos: a one-line error, or an image with a
// report of substitutes for missing inputs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "tests/support/odd_images.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::odd_photos_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class OddPhotos : public ::testing::Test {
 protected:
  void SetUp() override {
    if (BODYLOOM_HAS_NEURAL == 0) GTEST_SKIP() << "built without LibTorch";
    const CommandResult made =
        RunCommand({"synth-people", "--motions", "demo", "--out", scratch_ / "people", "--people", "2", "--actions",
                    "1", "--views", "1", "--frames", "2", "--test-share", "0.5", "--size", "96", "--threads", "1"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const std::string person = scratch_ / "people/p000/a0_v0";
    image_ = ReadImage(person + "/images/000000.png");
    track_ = ReadTrack(person + "/track.npz");
    WriteImage(File("photo.png"), image_);
    WriteTrack(File("me.npz"), track_);
  }
  /// A run of `system`, one step old.
  void Train(const std::string& system) {
    system_ = system;
    std::vector<std::string> arguments = {
        "train", system,    "--data", scratch_ / "people", "--out", File("run"), "--profile",
        "tiny",  "--steps", "1",      "--batch",           "1",     "--threads", "1"};
    if (system == "guided") arguments.insert(arguments.end(), {"--image-size", "64", "--balance-steps", "1"});
    const CommandResult trained = RunCommand(arguments);
    ASSERT_EQ(trained.exit_code, 0) << trained.err;
  }
  [[nodiscard]] std::string File(const std::string& name) const { return scratch_ / name; }
  CommandResult Animate(const std::string& image, const std::vector<std::string>& more = {},
                        const std::string& track = "me.npz") {
    std::vector<std::string> arguments = {
        "animate", system_,        "--run", File("run"),     "--image", File(image),      "--image-track", File(track),
        "--track", File("me.npz"), "--out", File("out.mp4"), "--json",  File("out.json"), "--threads",     "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  /// The run succeeds, and screen and report name the photo and say `note` of it.
  void Takes(const std::string& image, const std::string& note, const std::vector<std::string>& more = {},
             const std::string& track = "me.npz") {
    SCOPED_TRACE(image);
    fs::remove(File("out.mp4"));
    fs::remove(File("out.json"));
    const CommandResult result = Animate(image, more, track);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr(File(image) + ": " + note));
    EXPECT_TRUE(fs::exists(File("out.mp4")));
    const nlohmann::json report = nlohmann::json::parse(std::ifstream(File("out.json")));
    EXPECT_THAT(report["notes"].get<std::string>(), HasSubstr(File(image) + ": " + note));
  }
  /// One line that names the file and says `what`; nothing is written.
  void Refuses(const std::string& image, const std::string& named, const std::string& what,
               const std::vector<std::string>& more = {}, const std::string& track = "me.npz", int code = 1) {
    SCOPED_TRACE(image + " " + track);
    fs::remove(File("out.mp4"));
    const CommandResult result = Animate(image, more, track);
    EXPECT_EQ(result.exit_code, code) << result.out;
    if (code == 1) {
      EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
    }
    EXPECT_THAT(result.err, HasSubstr(named));
    EXPECT_THAT(result.err, HasSubstr(what));
    EXPECT_FALSE(fs::exists(File("out.mp4")));
  }
  /// The left part of the picture, with the track of it.
  void WriteCut(int width) {
    Image cut(width, image_.height);
    Paste(image_, 0, 0, &cut);
    WriteImage(File("half.png"), cut);
    Track track = track_;
    track.camera.width = width;
    WriteTrack(File("half.npz"), track);
  }
  /// The file cut off, a text, another shape, another place.
  void RefusesWhatShowsNothing() {
    WriteImage(File("whole.jpg"), image_);
    const std::string jpeg = ReadFileBytes(File("whole.jpg"), 1 << 24);
    for (const size_t part : {2, 3, 10}) {
      WriteBytes(File("cut.jpg"), jpeg.substr(0, jpeg.size() * (part - 1) / part));
      Refuses("cut.jpg", "cut.jpg", "ends before its image does");
    }
    WriteBytes(File("text.jpg"), "a text\n");
    Refuses("text.jpg", "text.jpg", "not an image that can be decoded");
    WriteImage(File("wide.png"), Resized(image_, 144, 96));
    Refuses("wide.png", "wide.png has 144x96", "made for images of 96x96");
    Track away = track_;
    away.motion.trans.col(0).array() += 30;
    WriteTrack(File("away.npz"), away);
    Refuses("photo.png", "away.npz: its body lies outside", "is it this image's track?", {}, "away.npz");
    away.motion.trans = -track_.motion.trans;
    WriteTrack(File("behind.npz"), away);
    Refuses("photo.png", "behind.npz", "is it this image's track?", {}, "behind.npz");
    Track other = track_;
    other.motion.body = "another";
    WriteTrack(File("other.npz"), other);
    Refuses("photo.png", "me.npz: a track of the body", "the photo's is of \"another\"", {}, "other.npz");
    Refuses("photo.png", "other.npz: a track of the body \"another\"", "the same --body",
            {"--views", File("photo.png") + ":" + File("other.npz")});
  }

  ScratchFolder scratch_;
  std::string system_;
  Image image_;
  Track track_;
};

TEST_F(OddPhotos, AreTakenByThePhotoRendererAndNamed) {
  Train("photo");
  const std::vector<std::string> own = {"--background", "photo"};
  Takes("photo.png", "no labels: the outline is found by GrabCut");
  EXPECT_THAT(Animate("photo.png").out, Not(HasSubstr("grey-scale")));
  WriteGreyPng(File("grey.png"), image_);
  Takes("grey.png", "grey-scale", own);
  WriteDeepPng(File("deep.png"), image_);
  Takes("deep.png", "16 bits a channel");
  WriteBytes(File("cmyk.jpg"), FlatJpeg(12, 12, 4, [&](int x, int y, int c) {
               return c < 3 ? image_.pixel(8 * x + 4, 8 * y + 4)[2 - c] : uint8_t{255};
             }));
  Takes("cmyk.jpg", "CMYK");
  const Image labels = ReadImage(scratch_ / "people/p000/a0_v0/labels/000000.png");
  std::vector<uint8_t> alpha;
  for (size_t i = 0; i < labels.bgr.size(); i += 3) alpha.push_back(labels.bgr[i] != 0 ? 255 : 0);
  WriteTransparentPng(File("alpha.png"), image_, alpha);
  Takes("alpha.png", "no labels: the outline is its transparency's", own);
  WriteImage(File("large.png"), Resized(image_, 192, 192));
  Takes("large.png", "192x192 pixels: resized to the 96x96 of its track");
  WriteCut(48);
  Takes("half.png", "no labels", own, "half.npz");
  EXPECT_THAT(Animate("half.png", own, "half.npz").out, HasSubstr("% of the body lies outside the image"));
}

TEST_F(OddPhotos, AreRefusedByThePhotoRendererWhereNothingCanBeDone) {
  Train("photo");
  RefusesWhatShowsNothing();
  const std::string other = scratch_ / "people/p001/a0_v0";
  Refuses("photo.png", "--parts 25", "1 to 24", {"--garment-from", other, "--parts", "25"}, "me.npz", 2);
  Refuses("photo.png", "--parts 0", "1 to 24", {"--garment-from", other, "--parts", "top,0"}, "me.npz", 2);
  Refuses("photo.png", "--parts hat", "1 to 24", {"--garment-from", other, "--parts", "hat"}, "me.npz", 2);
  // A picture of which the feet are cut off lends no shoes.
  Image head(96, 40);
  Paste(image_, 0, 0, &head);
  WriteImage(File("head.png"), head);
  Track track = track_;
  track.camera.height = 40;
  WriteTrack(File("head.npz"), track);
  Refuses("photo.png", File("head.png"), "nothing of --parts is to be seen there",
          {"--garment-from", File("head.png") + ":" + File("head.npz"), "--parts", "shoes"});
  const CommandResult lent = Animate("photo.png", {"--garment-from", other, "--parts", "top,bottom"});
  EXPECT_EQ(lent.exit_code, 0) << lent.err;
  EXPECT_THAT(lent.out, HasSubstr(other + ": shows "));
}

TEST_F(OddPhotos, AreTakenOrRefusedByThePoseGuidedRenderer) {
  Train("guided");
  WriteGreyPng(File("grey.png"), image_);
  Takes("photo.png", "no labels: the outline is found by GrabCut",
        {"--views", File("grey.png") + ":" + File("me.npz")});
  EXPECT_THAT(Animate("photo.png", {"--views", File("grey.png") + ":" + File("me.npz")}).out,
              HasSubstr(File("grey.png") + ": grey-scale"));
  WriteCut(48);
  Takes("half.png", "no labels", {}, "half.npz");
  RefusesWhatShowsNothing();
}

}  // namespace
}  // namespace bodyloom::odd_photos_test
