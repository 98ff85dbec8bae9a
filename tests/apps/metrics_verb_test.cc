// SPDX-License-Identifier: Apache-2.0
// `bodyloom metrics` from the command line, and the job behind it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/usage_error.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_writer.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::metrics_verb_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr int kWidth = 40, kHeight = 30;

std::string Contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Image Grey(int value) {
  const auto v = static_cast<uint8_t>(value);
  return Image(kWidth, kHeight, {v, v, v});
}

class MetricsVerb : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_ / name; }
  /// FOLDER/000000.png, … one grey picture a value.
  std::string Images(const std::string& folder, const std::vector<int>& values) const {
    fs::create_directories(Path(folder));
    for (size_t i = 0; i < values.size(); ++i) {
      char name[32];
      std::snprintf(name, sizeof name, "/%06zu.png", i);
      WriteImage(Path(folder) + name, Grey(values[i]));
    }
    return Path(folder);
  }
  CommandResult Run(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"metrics"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }
  /// Fails with one line that holds `text`.
  void ExpectError(std::vector<std::string> more, const std::string& text) const {
    more.emplace_back("--quiet");
    const CommandResult result = Run(more);
    EXPECT_EQ(result.exit_code, kExitFailed) << result.err;
    EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
  }

  ScratchFolder folder_;
};

double PsnrOfOffset(double offset) { return 20 * std::log10(255 / offset); }

TEST_F(MetricsVerb, ImagesByName) {
  const std::string truth = Images("truth", {100, 100, 100, 100}), result = Images("result", {110, 120, 100, 130});
  const CommandResult run =
      Run({"--truth", truth, "--result", result, "--json", Path("m.json"), "--csv", Path("m.csv"), "--quiet"});
  ASSERT_EQ(run.exit_code, kExitOk) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, StartsWith("images: 4 frames\n"));
  EXPECT_THAT(run.out, HasSubstr("1 frames equal, left out"));
  const auto json = nlohmann::json::parse(Contents(Path("m.json")));
  EXPECT_EQ(json["ssim_preset"], "wang2004");
  const auto& metrics = json["kinds"]["images"]["metrics"];
  const double a = PsnrOfOffset(10), b = PsnrOfOffset(20), c = PsnrOfOffset(30), mean = (a + b + c) / 3;
  EXPECT_NEAR(metrics["psnr_db"]["mean"], mean, 1e-9);
  EXPECT_NEAR(metrics["psnr_db"]["std"],
              std::sqrt(((a - mean) * (a - mean) + (b - mean) * (b - mean) + (c - mean) * (c - mean)) / 3), 1e-9);
  EXPECT_EQ(metrics["psnr_db"]["frames"], 3);
  EXPECT_EQ(metrics["psnr_db"]["infinite"], 1);
  const auto ssim = [](double x, double y) { return (2 * x * y + 6.5025) / (x * x + y * y + 6.5025); };
  EXPECT_NEAR(metrics["ssim_wang2004"]["mean"], (ssim(100, 110) + ssim(100, 120) + 1 + ssim(100, 130)) / 4, 1e-9);
  std::istringstream csv(Contents(Path("m.csv")));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "frame,psnr_db,ssim_wang2004");
  std::getline(csv, line);
  EXPECT_THAT(line, StartsWith("\"000000\",28.13"));
  std::getline(csv, line);
  std::getline(csv, line);
  EXPECT_EQ(line, "\"000002\",inf,1");
}

TEST_F(MetricsVerb, AnyNumberOfThreadsGivesTheSameBytes) {
  std::vector<int> values;
  values.reserve(13);
  for (int i = 0; i < 13; ++i) values.push_back(90 + 3 * i);
  const std::string truth = Images("truth", std::vector<int>(13, 100)), result = Images("result", values);
  for (const char* threads : {"1", "2", "5"}) {
    ASSERT_EQ(Run({"--truth", truth, "--result", result, "--csv", Path(threads), "--threads", threads}).exit_code, 0);
    EXPECT_EQ(Contents(Path(threads)), Contents(Path("1")));
  }
}

TEST_F(MetricsVerb, MasksAndPresets) {
  const std::string truth = Images("truth", {100}), result = Images("result", {100});
  Image half = Grey(100), mask = Grey(0);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth / 2; ++x) {
      half.pixel(x, y)[0] = 130;
      mask.pixel(x, y)[1] = 255;
    }
  }
  WriteImage(result + "/000000.png", half);
  fs::create_directories(Path("mask"));
  WriteImage(Path("mask") + "/000000.png", mask);
  ASSERT_EQ(Run({"--truth", truth, "--result", result, "--mask", Path("mask"), "--preset", "neuralbody", "--json",
                 Path("m.json")})
                .exit_code,
            kExitOk);
  const auto metrics = nlohmann::json::parse(Contents(Path("m.json")))["kinds"]["images"]["metrics"];
  EXPECT_NEAR(metrics["psnr_mask_db"]["mean"], 10 * std::log10(255.0 * 255 / 300), 1e-9);
  EXPECT_NEAR(metrics["psnr_db"]["mean"], 10 * std::log10(255.0 * 255 / 150), 1e-9);
  const double blue = (2 * 100 * 130 + 26.01) / (100 * 100 + 130 * 130 + 26.01);
  EXPECT_NEAR(metrics["ssim_neuralbody"]["mean"], (blue + 2) / 3, 1e-9);
  EXPECT_EQ(Run({"--truth", truth, "--result", result, "--preset", "ssim"}).exit_code, kExitUsage);
  ExpectError({"--truth", truth, "--result", result, "--preset", "gfla51"}, "at least 51x51");
  fs::rename(Path("mask") + "/000000.png", Path("mask") + "/000001.png");
  ExpectError({"--truth", truth, "--result", result, "--mask", Path("mask")}, "no mask '000000'");
}

TEST_F(MetricsVerb, SinglePersonDatasets) {
  Images("truth/images", {10, 20});
  Images("result/images", {12, 20});
  Images("truth/labels", {1, 1});
  Images("truth/normals", {255, 255});  // all along (1, 1, 1), too long for a normal
  Images("result/labels", {1, 1});
  Image labels = Grey(1);
  for (int x = 0; x < kWidth; ++x) labels.pixel(x, 0)[0] = labels.pixel(x, 0)[1] = labels.pixel(x, 0)[2] = 6;
  for (int x = 0; x < kWidth; ++x) labels.pixel(x, 1)[0] = labels.pixel(x, 1)[1] = labels.pixel(x, 1)[2] = 0;
  WriteImage(Path("result/labels/000001.png"), labels);
  const CommandResult run = Run({"--truth", Path("truth"), "--result", Path("result"), "--json", Path("m.json")});
  ASSERT_EQ(run.exit_code, kExitOk) << run.err;
  EXPECT_THAT(run.out, HasSubstr("normals: only one side has them, not compared"));
  EXPECT_THAT(run.out, HasSubstr("nothing to measure in 2 frames"));
  EXPECT_THAT(run.out, Not(HasSubstr("nan")));
  const auto json = nlohmann::json::parse(Contents(Path("m.json")));
  const auto& metrics = json["kinds"]["labels"]["metrics"];
  EXPECT_NEAR(metrics["iou_top"]["mean"], (1 + 28.0 / 30) / 2, 1e-12);
  EXPECT_NEAR(metrics["label_miou"]["mean"], (1 + 28.0 / 90) / 2, 1e-12);
  EXPECT_NEAR(metrics["label_accuracy"]["mean"], (1 + 28.0 / 30) / 2, 1e-12);
  EXPECT_NEAR(metrics["mask_iou"]["mean"], (1 + 29.0 / 30) / 2, 1e-12);
  EXPECT_EQ(metrics["iou_hair"]["undefined"], 2);
  EXPECT_TRUE(metrics["iou_hair"]["mean"].is_null());
  EXPECT_EQ(json["only_one_side"], nlohmann::json::array({"normals"}));

  WriteImage(Path("truth/normals/000000.png"), Image(kWidth, kHeight, {128, 128, 0}));
  Images("result/normals", {0, 0});
  WriteImage(Path("result/normals/000000.png"), Image(kWidth, kHeight, {128, 0, 128}));
  ASSERT_EQ(Run({"--truth", Path("truth"), "--result", Path("result"), "--json", Path("m.json")}).exit_code, kExitOk);
  const auto normals = nlohmann::json::parse(Contents(Path("m.json")))["kinds"]["normals"]["metrics"];
  EXPECT_NEAR(normals["normal_mean_deg"]["mean"], 90, 0.5);
  EXPECT_EQ(normals["normal_mean_deg"]["undefined"], 1);

  WriteImage(Path("result/labels/000000.png"), Grey(7));
  ExpectError({"--truth", Path("truth"), "--result", Path("result")}, "label 7, expected 0 to 6");
  WriteImage(Path("result/labels/000000.png"), Image(kWidth, kHeight, {1, 2, 3}));
  ExpectError({"--truth", Path("truth"), "--result", Path("result")}, "labels/000000.png: pixel (0, 0) is coloured");
}

TEST_F(MetricsVerb, Videos) {
  const auto video = [&](const std::string& name, int frames) {
    VideoWriter writer(Path(name), 64, 48, 25);
    for (int t = 0; t < frames; ++t) writer.Write(Image(64, 48, {200, uint8_t(20 * t), 40}));
    writer.Finish();
    return Path(name);
  };
  const std::string truth = video("truth.mp4", 6), same = video("same.mp4", 6), shorter = video("short.mp4", 4);
  ASSERT_EQ(Run({"--truth", truth, "--result", same, "--preset", "skimage7", "--json", Path("m.json")}).exit_code, 0);
  const auto json = nlohmann::json::parse(Contents(Path("m.json")))["kinds"]["images"];
  EXPECT_EQ(json["frames"], 6);
  EXPECT_EQ(json["metrics"]["ssim_skimage7"]["mean"], 1.0);
  EXPECT_EQ(json["metrics"]["psnr_db"]["infinite"], 6);
  ExpectError({"--truth", truth, "--result", shorter}, "short.mp4: ends before frame 000004");
  ExpectError({"--truth", shorter, "--result", truth}, "short.mp4: ends before frame 000004");
  ExpectError({"--truth", truth, "--result", Images("frames", {1})}, "40x30 pixels, expected 64x48");
}

TEST_F(MetricsVerb, WhatCannotBeComparedIsNamed) {
  const std::string truth = Images("truth", {1, 2, 3}), result = Images("result", {1, 2});
  ExpectError({"--truth", truth, "--result", result}, "result: no image '000002'");
  ExpectError({"--truth", result, "--result", truth}, "result: no image '000002'");
  const CommandResult common = Run({"--truth", truth, "--result", result, "--common"});
  EXPECT_EQ(common.exit_code, kExitOk) << common.err;
  EXPECT_THAT(common.out, StartsWith("images: 2 frames, 1 that one side lacks left out\n"));
  WriteImage(result + "/000001.png", Image(41, 30));
  ExpectError({"--truth", truth, "--result", result, "--common"}, "000001.png: 41x30 pixels, expected 40x30");
  fs::create_directories(Path("other"));
  ExpectError({"--truth", truth, "--result", Path("other")}, "other: the folder holds no images");
  WriteImage(Path("other") + "/a.png", Grey(1));
  ExpectError({"--truth", truth, "--result", Path("other"), "--common"}, "no image has the name of one in");
  WriteImage(Path("other") + "/a.jpg", Grey(1));
  ExpectError({"--truth", Path("other"), "--result", truth}, "a second image of this name");
  ExpectError({"--truth", truth, "--result", Path("nowhere")}, "nowhere");
  WriteImage(result + "/000001.png", Grey(2));
  std::ofstream(truth + "/000000.png") << "not an image";
  ExpectError({"--truth", truth, "--result", result, "--common", "--json", Path("m.json")}, "000000.png: not an image");
  EXPECT_FALSE(fs::exists(Path("m.json")));
  EXPECT_EQ(Run({"--truth", truth}).exit_code, kExitUsage);
}

TEST_F(MetricsVerb, LpipsComesFromTheNeuralHalf) {
  if (BODYLOOM_HAS_NEURAL == 0) GTEST_SKIP() << "built without LibTorch";
  for (const char* side : {"truth", "result"}) {
    std::filesystem::create_directories(Path(side));
    for (int t = 0; t < 3; ++t) {
      Image image(40, 36);
      for (size_t i = 0; i < image.bgr.size(); ++i) {
        image.bgr[i] = static_cast<uint8_t>(i * 7 % 251 + (side[0] == 'r' ? i % (3 + t) : 0));
      }
      WriteImage(Path(side) + "/" + std::to_string(t) + ".png", image);
    }
  }
  const CommandResult result = RunCommand({"metrics", "--truth", Path("truth"), "--result", Path("result"), "--lpips",
                                           "--csv", Path("frames.csv"), "--threads", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("lpips_random_features"));
  const std::string csv = ReadFileBytes(Path("frames.csv"));
  EXPECT_THAT(csv, HasSubstr("tlpips_random_features"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  std::filesystem::create_directories(Path("empty"));
  const CommandResult none = RunCommand(
      {"metrics", "--truth", Path("truth"), "--result", Path("result"), "--lpips", "--weights", Path("empty")});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("none of vgg16"));
  EXPECT_EQ(RunCommand({"metrics", "--truth", "a", "--result", "b", "--weights", "c"}).exit_code, 2);
}

TEST_F(MetricsVerb, ReactionToTheSpeedOfTheTruthItselfIsWhole) {
  for (const char* speed : {"1", "0.5"}) {
    const CommandResult made =
        RunCommand({"synth-person", "--motion", "demo", "--first", "40", "--frames", "20", "--fps", "30", "--speed",
                    speed, "--size", "96", "--garment", "skirt", "--out", Path(speed), "--quiet"});
    ASSERT_EQ(made.exit_code, kExitOk) << made.err;
  }
  const CommandResult run = Run({"--truth", Path("1"), "--result", Path("1"), "--other-truth", Path("0.5"),
                                 "--other-result", Path("0.5"), "--json", Path("m.json"), "--quiet"});
  ASSERT_EQ(run.exit_code, kExitOk) << run.err;
  EXPECT_THAT(run.out, HasSubstr("reaction of \"bottom\" to the speed: 10 pairs of equal poses"));
  const auto reaction = nlohmann::json::parse(Contents(Path("m.json")))["reaction"];
  EXPECT_EQ(reaction["pairs"], 10);
  EXPECT_EQ(reaction["truth_iou"], reaction["result_iou"]);
  for (const auto& [name, extent] : reaction["extents"].items()) {
    EXPECT_NEAR(extent["slope"].get<double>(), 1, 1e-12) << name;
    EXPECT_NEAR(extent["correlation"].get<double>(), 1, 1e-12) << name;
  }
  EXPECT_THAT(run.out, HasSubstr("a quarter of the pairs each"));
  ASSERT_EQ(reaction["quarters"].size(), 4U);
  EXPECT_GT(reaction["quarters"][0]["between_speeds"], reaction["quarters"][3]["between_speeds"]);
  for (const auto& quarter : reaction["quarters"]) EXPECT_EQ(quarter["iou"], 1);
  EXPECT_EQ(Run({"--truth", Path("1"), "--result", Path("1"), "--other-truth", Path("0.5")}).exit_code, kExitUsage);
  ExpectError({"--truth", Path("1"), "--result", Path("1"), "--other-truth", Path("0.5"), "--other-result", Path("1")},
              "frames of 96x96, expected");
}

}  // namespace
}  // namespace bodyloom::metrics_verb_test
