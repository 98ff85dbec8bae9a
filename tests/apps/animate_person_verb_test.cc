// SPDX-License-Identifier: Apache-2.0
// `bodyloom animate person` on typical users' photos: a person, or a one-line error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/support/paths.h"
#include "tests/support/real_video.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::animate_person_verb_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Rows [y0, y1) of an image.
Image Rows(const Image& image, int y0, int y1) {
  Image part(image.width, y1 - y0);
  Paste(image, 0, -y0, &part);
  return part;
}

class AnimatePersonVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (CommandPath().empty()) GTEST_SKIP() << "built without apps/";
    const std::string video = SharedDir() + "/data/tfjs_pose/pose_squats.mp4";
    const std::string why_not = WhyNoDetection(video);
    if (!why_not.empty()) GTEST_SKIP() << why_not;
    VideoReader(video).Read(&photo_);
    WriteTrack(File("motion.npz"), ShortTrack(3));
  }
  [[nodiscard]] std::string File(const std::string& name) const { return scratch_ / name; }
  [[nodiscard]] CommandResult Animate(const Image& image) const {
    WriteImage(File("photo.png"), image);
    return RunCommand({"animate", "person", "--image", File("photo.png"), "--track", File("motion.npz"), "--out",
                       File("out.mp4"), "--json", File("out.json"), "--texture-size", "128"});
  }
  /// The share of the surface that the photo shows, by the report.
  double Seen(const Image& image) const {
    const CommandResult result = Animate(image);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("6 frames of 320x240 px"));
    return nlohmann::json::parse(std::ifstream(File("out.json")))["person"]["texture_shares"]["seen"].get<double>();
  }

  ScratchFolder scratch_;
  Image photo_;
};

TEST_F(AnimatePersonVerb, TakesThePhotosThatPeopleHave) {
  const double whole = Seen(photo_);
  EXPECT_GT(whole, 0.2);
  Image grey = photo_;
  for (size_t p = 0; p < grey.bgr.size(); p += 3) grey.bgr[p] = grey.bgr[p + 1] = grey.bgr[p + 2];
  EXPECT_NEAR(Seen(grey), whole, 0.08);
  EXPECT_NEAR(Seen(Resized(photo_, 2 * photo_.width, 2 * photo_.height)), whole, 0.08);
  EXPECT_GT(Seen(Resized(photo_, photo_.width / 6, photo_.height / 6)), 0.1) << "130 px tall";
  const double half = Seen(Rows(photo_, 0, photo_.height * 45 / 100));
  EXPECT_GT(half, 0.08);
  EXPECT_LT(half, whole);
}

TEST_F(AnimatePersonVerb, OfTwoPeopleTheLargerIsTakenUnlessAskedFor) {
  Image both(2 * photo_.width, photo_.height, Colour{160, 160, 165});
  Paste(photo_, 0, 0, &both);
  Paste(Resized(photo_, photo_.width / 2, photo_.height / 2), photo_.width + photo_.width / 4, photo_.height / 2,
        &both);
  ASSERT_EQ(Animate(both).exit_code, 0);
  const auto report = nlohmann::json::parse(std::ifstream(File("out.json")));
  EXPECT_EQ(report["person"]["photos"][0]["people_found"], 2);
  EXPECT_EQ(RunCommand({"animate", "person", "--image", File("photo.png"), "--person", "1", "--keep", File("other"),
                        "--texture-size", "128"})
                .exit_code,
            0);
  const CommandResult third = RunCommand({"animate", "person", "--image", File("photo.png"), "--person", "2", "--keep",
                                          File("third"), "--texture-size", "128"});
  EXPECT_EQ(third.exit_code, 1);
  EXPECT_THAT(third.err, HasSubstr("photo.png"));
}

TEST_F(AnimatePersonVerb, WhatShowsNobodyIsRefusedInOneLineAndLeavesNothing) {
  const CommandResult result = Animate(Image(320, 240, Colour{120, 130, 140}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("photo.png: nobody was found"));
  EXPECT_FALSE(fs::exists(File("out.mp4")));
  EXPECT_FALSE(fs::exists(File("out.json")));
}

}  // namespace
}  // namespace bodyloom::animate_person_verb_test
