// SPDX-License-Identifier: Apache-2.0
// `bodyloom render` from the command line, on a short clip made once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/usage_error.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "data_tools/video/video_writer.h"
#include "render/raster/resolve_pixels.h"
#include "render/view/error_colours.h"
#include "render/view/overlay.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::render_verb_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kFrames = 14, kWidth = 160, kHeight = 120;

std::string Contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class RenderVerb : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new ScratchFolder;
    const CommandResult made =
        RunCommand({"synth", "--motion", "demo", "--frames", std::to_string(kFrames), "--out", Clip(""), "--width",
                    std::to_string(kWidth), "--height", std::to_string(kHeight), "--video"});
    ASSERT_EQ(made.exit_code, kExitOk) << made.err;
  }
  static void TearDownTestSuite() { delete shared_; }

  static std::string Clip(const std::string& name) { return *shared_ / ("clip/" + name); }
  std::string Out(const std::string& name) const { return folder_ / name; }

  CommandResult Run(const std::vector<std::string>& more, const std::string& track = Clip("truth.npz"),
                    const CommandOptions& options = {}) const {
    std::vector<std::string> arguments = {"render", "--track", track};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments, options);
  }
  CommandResult RunWell(const std::vector<std::string>& more, const std::string& track = Clip("truth.npz")) const {
    CommandResult result = Run(more, track);
    EXPECT_EQ(result.exit_code, kExitOk) << result.err;
    return result;
  }
  void ExpectUsageError(const std::vector<std::string>& more, const std::string& text) const {
    const CommandResult result = Run(more);
    EXPECT_EQ(result.exit_code, kExitUsage) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_THAT(folder_.Entries(), IsEmpty());
  }
  /// The clip's track with frames 3 to 5 lost.
  std::string TrackWithGap() const {
    Track track = ReadTrack(Clip("truth.npz"));
    for (int t = 3; t < 6; ++t) {
      track.motion.poses.row(t).setConstant(std::nan(""));
      track.motion.trans.row(t).setConstant(std::nan(""));
      track.joints[t].setConstant(std::nan(""));
      if (!track.coco17.empty()) {
        track.coco17[t].setConstant(std::nan(""));
      }
      track.frame_status[t] = FrameStatus::kLost;
    }
    WriteTrack(Out("gap.npz"), track);
    return Out("gap.npz");
  }
  /// A video of the clip's size with so many frames.
  std::string VideoOf(int frames) const {
    VideoWriter writer(Out("video.mp4"), kWidth, kHeight, 30);
    for (int t = 0; t < frames; ++t) {
      writer.Write(Image(kWidth, kHeight, {200, 40, 40}));
    }
    writer.Finish();
    return Out("video.mp4");
  }

  static ScratchFolder* shared_;
  ScratchFolder folder_;
};
ScratchFolder* RenderVerb::shared_ = nullptr;

TEST_F(RenderVerb, EveryKindBecomesAVideoAndAContactSheet) {
  WriteImage(Out("colours.png"), Image(64, 64, {10, 240, 30}));
  for (const std::string kind : {"overlay", "iuv", "parts", "normal", "depth", "texture", "error"}) {
    std::vector<std::string> more = {"--what", kind, "--out", Out(kind + ".mp4")};
    if (kind == "texture") {
      more.insert(more.end(), {"--texture", Out("colours.png")});
    }
    if (kind == "error") {
      more.insert(more.end(), {"--truth", Clip("truth.npz")});
    }
    RunWell(more);
    VideoReader video(Out(kind + ".mp4"));
    EXPECT_EQ(video.info().width, kWidth);
    EXPECT_EQ(video.Skip(1000), kFrames) << kind;
    more[3] = Out(kind + ".png");
    const CommandResult result = RunWell(more);
    EXPECT_THAT(result.out, HasSubstr("12 images of 160x120\n"));
    const Image sheet = ReadImage(Out(kind + ".png"));
    EXPECT_GT(sheet.width, 3 * 360) << kind;
    EXPECT_GT(sheet.height, 3 * 360);
  }
  // The textured body has the texture's colour and nothing else has.
  const Image sheet = ReadImage(Out("texture.png"));
  int green = 0;
  for (int y = 0; y < sheet.height; ++y) {
    for (int x = 0; x < sheet.width; ++x) green += sheet.at(x, y).green > 230 && sheet.at(x, y).red < 20;
  }
  EXPECT_GT(green, 12 * 2000);
}

TEST_F(RenderVerb, ArraysHoldWhatTheLibraryResolves) {
  const Track track = ReadTrack(Clip("truth.npz"));
  RunWell({"--what", "iuv", "--frames", "2:9", "--out", Out("iuv.npz")});
  RunWell({"--what", "normal", "--frames", "2:9", "--out", Out("normal.npz")});
  RunWell({"--what", "depth", "--frames", "2:9", "--out", Out("depth.npz")});
  const NpzArrays iuv = ReadNpz(Out("iuv.npz")), normal = ReadNpz(Out("normal.npz")), depth = ReadNpz(Out("depth.npz"));
  EXPECT_THAT(iuv.at("part").shape, ElementsAre(7, kHeight, kWidth));
  EXPECT_THAT(iuv.at("uv").shape, ElementsAre(7, kHeight, kWidth, 2));
  EXPECT_THAT(normal.at("normal").shape, ElementsAre(7, kHeight, kWidth, 3));
  EXPECT_THAT(depth.at("depth").shape, ElementsAre(7, kHeight, kWidth));
  EXPECT_THAT(iuv.at("frames").ToInts(), ElementsAre(2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(iuv.at("image_size").ToInts(), ElementsAre(kWidth, kHeight));
  const std::vector<int64_t> part = iuv.at("part").ToInts();
  const std::vector<float> uv = iuv.at("uv").ToFloats(), n = normal.at("normal").ToFloats(),
                           z = depth.at("depth").ToFloats();
  int covered = 0;
  for (int i = 0; i < 7; ++i) {
    const MatrixX3d vertices = TrackVertices(BuiltinBody(), track, 2 + i);
    VisibilityBuffer buffer;
    buffer.Render(vertices, BuiltinBody().data().faces, track.camera);
    ResolvedPixels pixels;
    ResolvePixels(buffer, BuiltinBody(), vertices, track.camera,
                  {.part = true, .chart_uv = true, .depth = true, .normal = true}, &pixels);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const size_t at = (size_t(i) * kHeight + y) * kWidth + x;
        if (buffer.FaceAt(x, y) < 0) {
          ASSERT_EQ(part[at], 0);
          ASSERT_TRUE(std::isinf(z[at]));
          continue;
        }
        ++covered;
        const size_t from = pixels.box.IndexOf(x, y);
        ASSERT_EQ(part[at], pixels.part[from]);
        ASSERT_EQ(uv[2 * at + 1], pixels.chart_uv[2 * from + 1]);
        ASSERT_EQ(n[3 * at + 2], pixels.normal[3 * from + 2]);
        ASSERT_EQ(z[at], pixels.depth_m[from]);
      }
    }
  }
  EXPECT_GT(covered, 7 * 400);
}

/// A track whose pelvis is lifted by 0.1 m is wrong by nothing in mm, pelvis on pelvis, and everywhere in pixels.
TEST_F(RenderVerb, ErrorsAreThoseOfEvaluate) {
  Track track = ReadTrack(Clip("truth.npz"));
  track.motion.trans.col(1).array() -= 0.1;
  track.motion.poses(3, 3 * 16 + 2) += 0.3;  // a left arm
  WriteTrack(Out("moved.npz"), track);
  const std::vector<std::string> error = {"--what", "error", "--truth", Clip("truth.npz"), "--frames", "2:4"};
  const auto errors_of = [&](const std::string& unit) {
    std::vector<std::string> more = error;
    more.insert(more.end(), {"--error-unit", unit, "--out", Out("e.npz")});
    RunWell(more, Out("moved.npz"));
    return ReadNpz(Out("e.npz")).at("error");
  };
  const NdArray mm = errors_of("mm"), px = errors_of("px");
  EXPECT_THAT(mm.shape, ElementsAre(2, kHeight, kWidth));
  std::vector<float> known[2], known_px;
  for (int i = 0; i < 2 * kHeight * kWidth; ++i) {
    EXPECT_EQ(std::isnan(mm.ToFloats()[i]), std::isnan(px.ToFloats()[i]));
    if (std::isnan(mm.ToFloats()[i])) continue;
    known[i / (kHeight * kWidth)].push_back(mm.ToFloats()[i]);
    known_px.push_back(px.ToFloats()[i]);
  }
  ASSERT_GT(known[0].size(), 500U);
  EXPECT_LT(*std::max_element(known[0].begin(), known[0].end()), 1e-3);
  // A hand half a metre from the shoulder: 0.15 m.
  EXPECT_NEAR(*std::max_element(known[1].begin(), known[1].end()), 1000 * 2 * std::sin(0.15) * 0.6, 60);
  EXPECT_GT(*std::min_element(known_px.begin(), known_px.end()), 2);

  std::vector<std::string> more = error;
  more.insert(more.end(), {"--error-max", "80", "--out", Out("e.png")});
  const CommandResult result = RunWell(more, Out("moved.npz"));
  EXPECT_THAT(result.out, HasSubstr("vertex error, pelvis on pelvis: violet 0, yellow 80 mm and more\n"));
  const Image sheet = ReadImage(Out("e.png"));
  int violet = 0, yellow = 0;
  for (int y = 0; y < sheet.height; ++y) {
    for (int x = 0; x < sheet.width; ++x) {
      violet += sheet.at(x, y) == ErrorColour(0) ? 1 : 0;
      yellow += sheet.at(x, y) == ErrorColour(1) ? 1 : 0;
    }
  }
  EXPECT_GT(violet, 500) << "the first frame's body";
  EXPECT_GT(yellow, 20) << "the second one's hand, and the end of the legend's bar";
}

TEST_F(RenderVerb, SameBytesForAnyNumberOfThreads) {
  for (const std::string name : {"a.png", "a.npz"}) {
    RunWell({"--what", "overlay", "--out", Out("1" + name), "--threads", "1", "--frames", "0:4"});
    RunWell({"--what", "overlay", "--out", Out("3" + name), "--threads", "3", "--frames", "0:4"});
    EXPECT_EQ(Contents(Out("1" + name)), Contents(Out("3" + name)));
  }
}

TEST_F(RenderVerb, LostFramesAreShownWithoutABodyAndCounted) {
  const std::string track = TrackWithGap();
  const CommandResult result =
      RunWell({"--what", "parts", "--out", Out("gap.npz.npz"), "--json", Out("gap.json")}, track);
  EXPECT_THAT(result.out, HasSubstr("3 of 14 frames are lost: they are shown without a body\n"));
  EXPECT_EQ(nlohmann::json::parse(Contents(Out("gap.json")))["frames_without_body"], 3);
  const NpzArrays arrays = ReadNpz(Out("gap.npz.npz"));
  const std::vector<int64_t> part = arrays.at("part").ToInts(), status = arrays.at("frame_status").ToInts();
  for (int t = 0; t < kFrames; ++t) {
    const auto begin = part.begin() + t * kWidth * kHeight;
    const bool any = std::any_of(begin, begin + kWidth * kHeight, [](int64_t p) { return p > 0; });
    EXPECT_EQ(any, status[t] != 3) << t;
    EXPECT_EQ(status[t] == 3, t >= 3 && t < 6);
  }
  // A new view follows the person across the gap.
  RunWell({"--what", "overlay", "--view-yaw", "40", "--out", Out("gap.mp4")}, track);
  EXPECT_EQ(VideoReader(Out("gap.mp4")).Skip(1000), kFrames);
}

TEST_F(RenderVerb, ATrackWithoutAnyBodyHasNoOtherSide) {
  Track track = ReadTrack(Clip("truth.npz"));
  track.motion.poses.setConstant(std::nan(""));
  for (auto& status : track.frame_status) status = FrameStatus::kLost;
  for (auto& joints : track.joints) joints.setConstant(std::nan(""));
  for (auto& points : track.coco17) points.setConstant(std::nan(""));
  WriteTrack(Out("lost.npz"), track);
  RunWell({"--what", "depth", "--out", Out("lost.png")}, Out("lost.npz"));
  const CommandResult result =
      Run({"--what", "depth", "--out", Out("side.png"), "--view-yaw", "90", "--quiet"}, Out("lost.npz"));
  EXPECT_EQ(result.exit_code, kExitFailed);
  EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr(Out("lost.npz") + ": every frame is lost"));
  EXPECT_FALSE(fs::exists(Out("side.png")));
}

TEST_F(RenderVerb, AVideoThatIsTooShortOrTooLongIsSaidSo) {
  const std::string shorter = VideoOf(10);
  CommandResult result = RunWell({"--what", "overlay", "--video", shorter, "--out", Out("o.mp4")});
  EXPECT_THAT(result.out, HasSubstr("\n4 of 14 images have no video frame at their time"));
  VideoReader reader(Out("o.mp4"));
  Image image;
  reader.Skip(9);
  ASSERT_TRUE(reader.Read(&image));
  EXPECT_NEAR(image.at(2, 118).red, 200, 12);  // the video
  ASSERT_TRUE(reader.Read(&image));
  EXPECT_LT(std::abs(image.at(2, 118).red - image.at(2, 118).blue), 12);  // the studio
  const std::string longer = VideoOf(20);
  result = RunWell({"--what", "parts", "--video", longer, "--out", Out("o.mp4"), "--json", Out("o.json")});
  EXPECT_THAT(result.out, HasSubstr("the video goes on for 6 frames after the track: left out\n"));
  const nlohmann::json json = nlohmann::json::parse(Contents(Out("o.json")));
  EXPECT_EQ(json["pictures_without_video"], 0);
  EXPECT_EQ(json["video_frames_left"], 6);
  EXPECT_EQ(json["pictures"], kFrames);
}

TEST_F(RenderVerb, AVideoOfAnotherShapeIsRefused) {
  VideoWriter writer(Out("square.mp4"), 100, 100, 30);
  writer.Write(Image(100, 100));
  writer.Finish();
  const CommandResult result =
      Run({"--what", "overlay", "--video", Out("square.mp4"), "--out", Out("o.mp4"), "--quiet"});
  EXPECT_EQ(result.exit_code, kExitFailed);
  EXPECT_EQ(result.NumErrorLines(), 1);
  EXPECT_THAT(result.err, HasSubstr("square.mp4: frames of 100x100, expected those of the camera, 160x120"));
}

TEST_F(RenderVerb, TurntablesAndNewViews) {
  RunWell({"--what", "normal", "--frames", "5", "--turntable", "--out", Out("held.mp4")});
  EXPECT_EQ(VideoReader(Out("held.mp4")).Skip(1000), 120);
  RunWell({"--what", "parts", "--turntable", "--out", Out("turn.mp4")});
  EXPECT_EQ(VideoReader(Out("turn.mp4")).Skip(1000), kFrames);
  // Seen from the back there is no face; from both sides the figure is as high.
  RunWell({"--what", "parts", "--frames", "13", "--view-yaw", "0", "--out", Out("front.npz")});
  RunWell({"--what", "parts", "--frames", "13", "--view-yaw", "180", "--out", Out("back.npz")});
  const auto rows_with_body = [&](const std::string& name) {
    const std::vector<int64_t> part = ReadNpz(Out(name)).at("part").ToInts();
    int rows = 0;
    for (int y = 0; y < kHeight; ++y) {
      rows += std::any_of(part.begin() + y * kWidth, part.begin() + (y + 1) * kWidth, [](int64_t p) { return p > 0; });
    }
    return rows;
  };
  EXPECT_GT(rows_with_body("front.npz"), kHeight / 3);
  constexpr int kTolerance = kHeight / 8;
  EXPECT_NEAR(rows_with_body("front.npz"), rows_with_body("back.npz"), kTolerance);
  const NpzArrays back = ReadNpz(Out("back.npz"));
  EXPECT_THAT(back.at("view_rotation").shape, ElementsAre(1, 3, 3));
  // The view's own camera explains where the body is seen: its pelvis lies on a body pixel.
  const Track track = ReadTrack(Clip("truth.npz"));
  const RowMatrixXd R = back.at("view_rotation").ToMatrix(), K = back.at("K").ToMatrix();
  const std::vector<double> t = back.at("view_translation").ToDoubles();
  const Eigen::Matrix3d rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.data());
  const Eigen::Vector3d x = K * (rotation * track.joints[13].row(0).transpose() + Eigen::Vector3d(t[0], t[1], t[2]));
  const auto column = std::lround(x.x() / x.z()), row = std::lround(x.y() / x.z());
  EXPECT_GT(back.at("part").ToInts().at(row * kWidth + column), 0);
}

TEST_F(RenderVerb, OptionsThatContradictEachOther) {
  ExpectUsageError({"--what", "overlay", "--out", Out("o.avi")}, "expected a name that ends in .mp4, .png or .npz");
  ExpectUsageError({"--what", "texture", "--out", Out("o.png")}, "give --texture FILE");
  ExpectUsageError({"--what", "parts", "--texture", Clip("clip.mp4"), "--out", Out("o.png")}, "--what texture");
  ExpectUsageError({"--what", "error", "--out", Out("o.png")}, "give --truth FILE");
  ExpectUsageError({"--what", "parts", "--truth", Clip("truth.npz"), "--out", Out("o.png")}, "--what error");
  ExpectUsageError({"--what", "parts", "--video", Clip("clip.mp4"), "--view-yaw", "3", "--out", Out("o.png")},
                   "from its own camera alone");
  ExpectUsageError({"--what", "parts", "--video", Clip("clip.mp4"), "--turntable", "--out", Out("o.png")},
                   "from its own camera alone");
  ExpectUsageError({"--what", "parts", "--video", Clip("clip.mp4"), "--out", Out("o.npz")}, "leave --video out");
  ExpectUsageError({"--what", "nothing", "--out", Out("o.png")}, "nothing");
  ExpectUsageError({"--what", "parts"}, "--out is required");
  for (const std::string frames : {"x", "3:2", "1:2:3", "-1", "5:5", "1e3", "99999999999"}) {
    ExpectUsageError({"--what", "parts", "--out", Out("o.png"), "--frames=" + frames}, "frames");
  }
}

TEST_F(RenderVerb, FilesThatCannotBeUsedAreNamed) {
  const auto expect = [&](const std::vector<std::string>& more, const std::string& text,
                          const std::string& track = Clip("truth.npz")) {
    std::vector<std::string> arguments = more;
    arguments.push_back("--quiet");
    const CommandResult result = Run(arguments, track);
    EXPECT_EQ(result.exit_code, kExitFailed) << result.err;
    EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_FALSE(fs::exists(Out("o.png")));
  };
  const std::vector<std::string> parts = {"--what", "parts", "--out", Out("o.png")};
  Track shorter = ReadTrack(Clip("truth.npz"));
  shorter.motion.poses.conservativeResize(kFrames - 1, Eigen::NoChange);
  shorter.motion.trans.conservativeResize(kFrames - 1, Eigen::NoChange);
  shorter.motion.timestamps.pop_back(), shorter.frame_status.pop_back(), shorter.joints.pop_back(),
      shorter.coco17.pop_back();
  shorter.joint_sigma.conservativeResize(kFrames - 1, Eigen::NoChange);
  WriteTrack(Out("shorter.npz"), shorter);
  expect({"--what", "error", "--truth", Out("shorter.npz"), "--out", Out("o.png")},
         "shorter.npz: 13 frames, expected 14 as " + Clip("truth.npz") + " has");
  expect(parts, Out("absent.npz"), Out("absent.npz"));
  std::ofstream(Out("broken.npz")) << Contents(Clip("truth.npz")).substr(0, 2000);
  expect(parts, Out("broken.npz"), Out("broken.npz"));
  expect({"--what", "parts", "--out", Out("o.png"), "--frames", "3:200"}, "14 frames, expected --frames within 0:14");
  expect({"--what", "parts", "--out", Out("no/o.png")}, Out("no"));
  expect({"--what", "overlay", "--video", Clip("truth.npz"), "--out", Out("o.png")}, Clip("truth.npz"));
  expect({"--what", "texture", "--texture", Clip("truth.npz"), "--out", Out("o.png")}, Clip("truth.npz"));
  Track track = ReadTrack(Clip("truth.npz"));
  track.camera.width = track.camera.height = 0;
  WriteTrack(Out("sizeless.npz"), track);
  expect(parts, "image_size is 0x0, expected the size of the images", Out("sizeless.npz"));
  RunWell({"--what", "overlay", "--video", Clip("clip.mp4"), "--out", Out("from_video.png")}, Out("sizeless.npz"));
}

TEST_F(RenderVerb, ArraysThatDoNotFitAreRefusedBeforeTheWork) {
  Track track = ReadTrack(Clip("truth.npz"));
  track.camera.width = track.camera.height = 16384;
  WriteTrack(Out("huge.npz"), track);
  const CommandResult result = Run({"--what", "normal", "--out", Out("o.npz"), "--quiet"}, Out("huge.npz"));
  EXPECT_EQ(result.exit_code, kExitFailed);
  EXPECT_EQ(result.NumErrorLines(), 1);
  EXPECT_THAT(result.err, HasSubstr("choose fewer frames with --frames a:b"));
  EXPECT_FALSE(fs::exists(Out("o.npz")));
}

TEST_F(RenderVerb, AFullDiskLeavesNothingBehind) {
  CommandOptions options;
  options.file_size_limit = 3000;
  for (const std::string name : {"o.mp4", "o.png", "o.npz"}) {
    const CommandResult result = Run({"--what", "overlay", "--out", Out(name), "--quiet"}, Clip("truth.npz"), options);
    EXPECT_EQ(result.exit_code, kExitFailed) << name;
    EXPECT_THAT(result.err, HasSubstr(Out(name)));
    EXPECT_THAT(folder_.Entries(), IsEmpty()) << name;
  }
}

}  // namespace
}  // namespace bodyloom::render_verb_test
