// SPDX-License-Identifier: Apache-2.0
// The verbs in their basic use, on a short clip that `bodyloom synth` makes once for all tests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/usage_error.h"
#include "data_tools/body/body_io.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/video_reader.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::verbs_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr int kFrames = 12;

std::string Contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

nlohmann::json JsonOf(const std::string& path) { return nlohmann::json::parse(Contents(path)); }

/// Ends well, or shows its output.
CommandResult RunWell(const std::vector<std::string>& arguments) {
  CommandResult result = RunCommand(arguments);
  EXPECT_EQ(result.exit_code, kExitOk) << arguments[0] << ": " << result.err;
  return result;
}

/// A clip of kFrames frames with 2D joints only and its track, made once.
class Verbs : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new ScratchFolder;
    RunWell({"synth",
             "--motion",
             "demo",
             "--first",
             "60",
             "--frames",
             std::to_string(kFrames),
             "--out",
             Shared("clip"),
             "--dense",
             "0",
             "--joint-noise",
             "0",
             "--dropouts",
             "0",
             "--swaps",
             "0",
             "--width",
             "320",
             "--height",
             "240",
             "--video"});
    tracking_ =
        new CommandResult(RunWell({"track", "--detections", Observations(), "--cameras", Shared("clip/camera.json"),
                                   "--out", Shared("track.npz"), "--json", Shared("summary.json"), "--threads", "1"}));
  }
  static void TearDownTestSuite() {
    delete tracking_;
    delete shared_;
  }

  static std::string Shared(const std::string& name) { return *shared_ / name; }
  static std::string Observations() { return Shared("clip/observations.npz"); }
  static std::vector<std::string> TrackTo(const std::string& out) {
    return {"track", "--detections", Observations(), "--cameras", Shared("clip/camera.json"), "--out", out};
  }

  static ScratchFolder* shared_;
  static CommandResult* tracking_;
  ScratchFolder folder_;
};
ScratchFolder* Verbs::shared_ = nullptr;
CommandResult* Verbs::tracking_ = nullptr;

TEST_F(Verbs, AClipFromTheMiddleOfAMotionBeginsAtZeroAsItsVideoDoes) {
  EXPECT_EQ(ReadTrack(Shared("clip/truth.npz")).motion.timestamps.front(), 0);
}

TEST_F(Verbs, SynthWritesObservationsTruthCameraAndVideo) {
  EXPECT_TRUE(fs::exists(Observations()));
  EXPECT_TRUE(fs::exists(Shared("clip/camera.json")));
  EXPECT_EQ(ReadTrack(Shared("clip/truth.npz")).num_frames(), kFrames);
  EXPECT_EQ(VideoReader(Shared("clip/clip.mp4")).info().width, 320);
}

TEST_F(Verbs, SynthIsTheSameForTheSameSeed) {
  const auto synth = [&](const std::string& name, const std::string& seed) {
    RunWell({"synth", "--motion", "demo", "--frames", "3", "--out", folder_ / name, "--seed", seed, "--realistic",
             "--init-error", "10", "--quiet"});
    return Contents(folder_ / (name + "/observations.npz")) + Contents(folder_ / (name + "/initialiser.npz"));
  };
  const std::string first = synth("a", "7");
  EXPECT_EQ(first, synth("b", "7"));
  EXPECT_NE(first, synth("c", "8"));
}

TEST_F(Verbs, TrackTellsWhatItDidOnScreenAndAsJson) {
  EXPECT_THAT(tracking_->out, StartsWith("12 frames: 12 tracked\n"));
  EXPECT_THAT(tracking_->out, HasSubstr("skipped  overlay video: no --overlay\n"));
  EXPECT_THAT(tracking_->err, HasSubstr("tracking 12 frames 0 % "));
  const nlohmann::json json = JsonOf(Shared("summary.json"));
  for (const char* key : {"status", "frames", "frames_by_status", "solver", "iterations", "initial_cost", "final_cost",
                          "seconds", "peak_memory_bytes", "skipped"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["frames"], kFrames);
  EXPECT_EQ(json["frames_by_status"]["tracked"], kFrames);
  EXPECT_EQ(json["solver"], "chain+ceres");
  EXPECT_GE(json["ceres"]["iterations"], 1);
  EXPECT_GT(json["cost_by_term"]["2D joints"], 0);
  EXPECT_GT(json["initial_cost"], json["final_cost"]);
  EXPECT_GT(json["seconds"]["total"], 0);
}

TEST_F(Verbs, TrackHoldsWhatOthersNeedToEvaluateIt) {
  const NpzArrays arrays = ReadNpz(Shared("track.npz"));
  EXPECT_THAT(arrays.at("poses").shape, ElementsAre(kFrames, 72));
  EXPECT_THAT(arrays.at("trans").shape, ElementsAre(kFrames, 3));
  EXPECT_THAT(arrays.at("joints").shape, ElementsAre(kFrames, 24, 3));
  EXPECT_THAT(arrays.at("coco17").shape, ElementsAre(kFrames, 17, 3));
  EXPECT_THAT(arrays.at("joint_sigma").shape, ElementsAre(kFrames, 24));
  for (const char* key :
       {"betas", "mocap_framerate", "camera_model", "K", "timestamps", "image_size", "frame_status"}) {
    EXPECT_TRUE(arrays.contains(key)) << key;
  }
}

TEST_F(Verbs, EvaluateComparesWithTheTruth) {
  const CommandResult result = RunWell({"evaluate", "--track", Shared("track.npz"), "--truth", Shared("clip/truth.npz"),
                                        "--json", folder_ / "errors.json"});
  EXPECT_THAT(result.out, HasSubstr("protocol known-truth"));
  const nlohmann::json values = JsonOf(folder_ / "errors.json")["values"];
  EXPECT_LT(values["projection_mean_px"], 5) << "exact joints of a person who faces the camera";
  EXPECT_GT(values["projection_mean_px"], 0);
}

TEST_F(Verbs, EvaluateOfTheTruthItselfIsZero) {
  RunWell({"evaluate", "--track", Shared("clip/truth.npz"), "--truth", Shared("clip/truth.npz"), "--json",
           folder_ / "errors.json"});
  EXPECT_NEAR(JsonOf(folder_ / "errors.json")["values"]["mpjpe_mm"].get<double>(), 0, 1e-9);
}

TEST_F(Verbs, PlanSaysWhatWouldRunAndWritesNothing) {
  const CommandResult result = RunWell({"track", "--detections", Observations(), "--plan"});
  EXPECT_THAT(result.out, StartsWith("12 frames would be tracked:\n"));
  EXPECT_THAT(result.out, HasSubstr("  run   "));
  EXPECT_THAT(result.out, HasSubstr("  skip  "));
}

TEST_F(Verbs, TrackAgreesForAnyNumberOfThreads) {
  std::vector<std::string> command = TrackTo(folder_ / "two.npz");
  command.insert(command.end(), {"--threads", "2", "--quiet"});
  EXPECT_EQ(RunWell(command).out, "");
  const Motion one = ReadTrack(Shared("track.npz")).motion, two = ReadTrack(folder_ / "two.npz").motion;
  // Ceres sums over threads in their own order; only rounding may differ.
  constexpr double kRounding = 1e-6;
  EXPECT_LT((one.poses - two.poses).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_LT((one.trans - two.trans).cwiseAbs().maxCoeff(), kRounding);
}

TEST_F(Verbs, TrackIsTheSameTwice) {
  std::vector<std::string> command = TrackTo(folder_ / "again.npz");
  command.insert(command.end(), {"--threads", "1"});
  RunWell(command);
  EXPECT_EQ(Contents(folder_ / "again.npz"), Contents(Shared("track.npz")));
}

TEST_F(Verbs, LiveTracksEveryFrameAndSaysSo) {
  std::vector<std::string> command = TrackTo(folder_ / "live.npz");
  command.insert(command.end(), {"--live", "3", "--json", folder_ / "live.json"});
  RunWell(command);
  const nlohmann::json summary = JsonOf(folder_ / "live.json");
  EXPECT_EQ(summary["solver"], "chain, live");
  EXPECT_EQ(summary["ran"][0]["what"], "live");
  EXPECT_EQ(ReadTrack(folder_ / "live.npz").num_frames(), 12);
  EXPECT_EQ(summary["frames_by_status"]["tracked"], 12);
  command.insert(command.end(), {"--solver", "ceres"});
  EXPECT_EQ(RunCommand(command).exit_code, 2);
}

TEST_F(Verbs, OverlayHasAFrameForEveryFrameOfTheTrack) {
  std::vector<std::string> command = TrackTo(folder_ / "track.npz");
  command.insert(command.end(), {"--video", Shared("clip/clip.mp4"), "--overlay", folder_ / "overlay.mp4",
                                 "--side-view", "--reference", Shared("clip/truth.npz")});
  RunWell(command);
  VideoReader video(folder_ / "overlay.mp4");
  EXPECT_GT(video.info().width, 320) << "the side view stands beside the image";
  EXPECT_EQ(video.info().height, 240);
  EXPECT_EQ(video.Skip(2 * kFrames), kFrames);
}

TEST_F(Verbs, UnknownFocalLengthAndWeakPerspectiveNeedOnlyTheImageSize) {
  for (const std::string camera : {"unknown-focal", "weak"}) {
    const std::string out = folder_ / (camera + ".npz");
    RunWell({"track", "--detections", Observations(), "--camera", camera, "--out", out});
    EXPECT_EQ(ReadTrack(out).camera.model, camera == "weak" ? CameraModel::kWeakPerspective : CameraModel::kPinhole);
  }
}

TEST_F(Verbs, ExportWritesEveryKind) {
  const auto export_to = [&](const std::string& what, const std::string& name) {
    RunWell({"export", "--track", Shared("track.npz"), "--what", what, "--out", folder_ / name});
    return folder_ / name;
  };
  const int num_vertices = BuiltinBody().num_vertices();
  const NdArray vertices = ReadNpy(export_to("vertices", "v.npy"));
  EXPECT_THAT(vertices.shape, ElementsAre(kFrames, num_vertices, 3));
  const NdArray joints = ReadNpy(export_to("joints", "j.npy"));
  EXPECT_THAT(joints.shape, ElementsAre(kFrames, 24, 3));
  const Track track = ReadTrack(Shared("track.npz"));
  EXPECT_EQ(joints.ToDoubles()[2], track.joints[0](0, 2));
  for (const auto& [what, name] : {std::pair("amass", "a.npz"), std::pair("bvh", "m.bvh")}) {
    EXPECT_EQ(LoadMotion(export_to(what, name)).num_frames(), kFrames) << what;
  }
  EXPECT_EQ(LoadMotion(export_to("smplx", "x.npz")).num_frames(), kFrames);
  for (const auto& [what, name, begin] :
       {std::tuple("glb", "a.glb", "glTF"), std::tuple("fbx", "a.fbx", "Kaydara FBX Binary"),
        std::tuple("trc", "a.trc", "Path"), std::tuple("c3d", "a.c3d", "\x02\x50"),
        std::tuple("pose2sim", "Calib.toml", "[cam_01]"), std::tuple("colmap", "sparse/cameras.txt", "# CAMERA_ID"),
        std::tuple("angles", "a.csv", "frame,time,pelvis_tilt,"), std::tuple("angles", "a.mot", "Coordinates\n")}) {
    export_to(what, what == std::string("colmap") ? "sparse" : name);
    EXPECT_THAT(Contents(folder_ / name), StartsWith(begin)) << what;
  }
  const CommandResult two = RunCommand({"export", "--track", Shared("track.npz"), "--track", Shared("track.npz"),
                                        "--what", "glb", "--out", folder_ / "two.glb"});
  EXPECT_EQ(two.exit_code, 0) << two.err;
  EXPECT_THAT(two.out, HasSubstr("world    y up"));
  EXPECT_THAT(two.out, HasSubstr("mm at most"));
  const CommandResult gait = RunWell({"export", "--track", Shared("track.npz"), "--what", "angles", "--out",
                                      folder_ / "b.csv", "--events", folder_ / "b.json"});
  EXPECT_THAT(gait.out, HasSubstr("gait     "));
  EXPECT_THAT(Contents(folder_ / "b.json"), HasSubstr("\"walks\": "));
  EXPECT_EQ(Contents(folder_ / "b.csv"), Contents(folder_ / "a.csv"));
  export_to("obj", "meshes");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "meshes"), fs::directory_iterator()), kFrames);
  RunWell({"export", "--track", Shared("track.npz"), "--what", "obj", "--frame", "0", "--out", folder_ / "one.obj"});
  const std::string obj = Contents(folder_ / "one.obj");
  EXPECT_EQ(obj, Contents(folder_ / "meshes/frame_000000.obj"));
  EXPECT_THAT(obj, StartsWith("v "));
  EXPECT_THAT(obj, HasSubstr("\nf 1"));
}

TEST_F(Verbs, BodyInfoConvertAndMakeAgree) {
  const std::string info = RunWell({"body", "info"}).out;
  EXPECT_THAT(info, HasSubstr("7874"));
  RunWell({"body", "make", "--out", folder_ / "made.npz"});
  EXPECT_EQ(RunWell({"body", "info", folder_ / "made.npz"}).out, info);
  RunWell({"body", "convert", "--body", folder_ / "made.npz", "--out", folder_ / "converted.npz"});
  EXPECT_EQ(Contents(folder_ / "converted.npz"), Contents(folder_ / "made.npz"));
}

TEST_F(Verbs, ABodyFromAFileTracksLikeTheBuiltInOne) {
  RunWell({"body", "make", "--out", folder_ / "body.npz"});
  std::vector<std::string> command = TrackTo(folder_ / "track.npz");
  command.insert(command.end(), {"--body", folder_ / "body.npz"});
  RunWell(command);
  RunWell({"evaluate", "--track", folder_ / "track.npz", "--truth", Shared("track.npz"), "--json", folder_ / "e.json"});
  EXPECT_LT(JsonOf(folder_ / "e.json")["values"]["mpjpe_mm"], 1) << "the file rounds vertices to 1e-5 m";
}

}  // namespace
}  // namespace bodyloom::verbs_test
