// SPDX-License-Identifier: Apache-2.0
// The table of docs/lab/track_kinds.md, made by trying each verb with each kind of track: it either takes the track or
// refuses it in one line.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/paths.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::track_kinds_test {
namespace {

Track Distorted() {
  Track track = ShortTrack();
  track.camera.distortion = {-0.2, 0.05, 0.001, -0.001, 0.01};
  return track;
}

Track Weak() {
  Track track = ShortTrack();
  Camera& camera = track.camera;
  const double depth = track.joints[0].col(2).mean();
  camera.model = CameraModel::kWeakPerspective;
  track.weak_camera.resize(track.num_frames(), 3);
  for (int t = 0; t < track.num_frames(); ++t) track.weak_camera.row(t) << camera.fx / depth, 0, 0;
  return track;
}

/// Frames 4 and 5 show nobody.
Track LostBetween() {
  Track track = ShortTrack();
  for (const int t : {4, 5}) {
    track.frame_status[size_t(t)] = FrameStatus::kLost;
    track.motion.poses.row(t).setConstant(NAN);
    track.motion.trans.row(t).setConstant(NAN);
    track.joints[size_t(t)].setConstant(NAN);
    track.coco17[size_t(t)].setConstant(NAN);
  }
  return track;
}

/// Of a video whose frames are turned, which was filmed eight times as fast as it is played.
Track TurnedInSlowMotion() {
  Track track = ShortTrack();
  track.playback = {90, 8};
  for (double& time : track.motion.timestamps) time /= 8;
  return track;
}

const std::vector<std::pair<std::string, std::function<Track()>>>& Kinds() {
  static const std::vector<std::pair<std::string, std::function<Track()>>> kinds = {
      {"static camera", [] { return ShortTrack(); }},
      {"distorted lens", Distorted},
      {"moving camera", [] { return ShortTrack(6, SynthCameraMotion::kWalking); }},
      {"weak perspective", Weak},
      {"lost frames between", LostBetween},
      {"turned, slow motion", TurnedInSlowMotion}};
  return kinds;
}

struct Use {
  std::string name;
  std::vector<std::string> command;  ///< TRACK, OUT and RUN stand for files
};

std::vector<Use> Uses() {
  std::vector<Use> uses;
  for (const char* what : {"overlay", "normal"}) {
    uses.push_back({std::string("render --what ") + what,
                    {"render", "--track", "TRACK", "--what", what, "--out", std::string("OUT") + ".mp4"}});
  }
  uses.push_back({"describe", {"describe", "--track", "TRACK", "--size", "32", "--out", "OUT.npy"}});
  for (const char* form :
       {"glb", "fbx", "bvh", "amass", "smplx", "trc", "c3d", "colmap", "pose2sim", "vertices", "joints", "angles"}) {
    const std::map<std::string, std::string> endings = {{"amass", ".npz"},     {"smplx", ".npz"},    {"colmap", ""},
                                                        {"pose2sim", ".toml"}, {"vertices", ".npy"}, {"joints", ".npy"},
                                                        {"angles", ".csv"}};
    const auto ending = endings.find(form);
    uses.push_back({std::string("export --what ") + form,
                    {"export", "--track", "TRACK", "--what", form, "--out",
                     std::string("OUT") + (ending == endings.end() ? std::string(".") + form : ending->second)}});
  }
  uses.push_back({"evaluate --truth", {"evaluate", "--track", "TRACK", "--truth", "TRACK"}});
  uses.push_back({"animate avatar",
                  {"animate", "avatar", "--run", "RUN", "--track", "TRACK", "--size", "64", "--out", "OUT.mp4"}});
  uses.push_back(
      {"animate avatar --report", {"animate", "avatar", "--run", "RUN", "--track", "TRACK", "--report", "OUT.html"}});
  return uses;
}

std::string Row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + cell + " |";
  return row + "\n";
}

TEST(TrackKinds, TheTableOfTheManualIsTrue) {
  const ScratchFolder scratch;
  ASSERT_EQ(RunCommand({"synth-person", "--motion", "demo", "--frames", "4", "--size", "64", "--out",
                        scratch / "person", "--quiet"})
                .exit_code,
            0);
  const CommandResult trained =
      RunCommand({"train", "avatar", "--data", scratch / "person", "--out", scratch / "run", "--steps", "4", "--skin",
                  "48", "--loose", "100", "--train", "0-2", "--validate", "3-3"});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  std::vector<std::string> header = {"verb"};
  for (const auto& [kind, make] : Kinds()) {
    header.push_back(kind);
    WriteTrack(scratch / (kind + ".npz"), make());
  }
  std::string table = Row(header) + "|";
  for (size_t i = 0; i < header.size(); ++i) table += "---|";
  table += "\n";
  int number = 0;
  for (const Use& use : Uses()) {
    std::vector<std::string> cells = {"`" + use.name + "`"};
    for (const auto& [kind, make] : Kinds()) {
      std::vector<std::string> command = use.command;
      for (std::string& word : command) {
        if (word == "TRACK") word = scratch / (kind + ".npz");
        if (word == "RUN") word = scratch / "run";
        if (word.starts_with("OUT")) word = scratch / ("out" + std::to_string(++number) + word.substr(3));
      }
      const CommandResult result = RunCommand(command);
      cells.push_back(result.exit_code == 0 ? "yes" : "no");
      if (result.exit_code == 0) continue;
      EXPECT_EQ(result.exit_code, 1) << use.name << " of " << kind << ": " << result.err;
      EXPECT_EQ(result.NumErrorLines(), 1) << use.name << " of " << kind << ": " << result.err;
    }
    table += Row(cells);
  }
  EXPECT_NE(ReadFileBytes(SourceDir() + "/docs/lab/track_kinds.md").find(table), std::string::npos)
      << "docs/lab/track_kinds.md lacks this table:\n"
      << table;
}

}  // namespace
}  // namespace bodyloom::track_kinds_test
