// SPDX-License-Identifier: Apache-2.0
// `bodyloom detect --pose-model` with an ONNX network, and with files that are not ONNX.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "apps/usage_error.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/video/image_file.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tests/tracking/detection/inference/small_onnx.h"

namespace bodyloom::detect_onnx_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class DetectOnnx : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "clip");
    for (const char* name : {"clip/0.png", "clip/1.png"}) WriteImage(folder_ / name, Image(320, 320));
    Write("net.onnx", ScriptedYoloPose({1, 3, 640, 640}, {ScriptedStanding(300, 320, 400, 0.9F, 0.75F)}, 17, 80).Bytes());
  }
  void Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  [[nodiscard]] CommandResult Detect(const std::vector<std::string>& more) const {
    std::vector<std::string> command = {"detect", "--video", folder_ / "clip", "--out", folder_ / "found.npz"};
    command.insert(command.end(), more.begin(), more.end());
    return RunCommand(command);
  }

  const ScratchFolder folder_;
};

TEST_F(DetectOnnx, TakesTheFilesNetwork) {
  const CommandResult result = Detect({"--pose-model", folder_ / "net.onnx"});
  EXPECT_EQ(result.exit_code, kExitOk) << result.err;
  EXPECT_THAT(result.out, HasSubstr("2 with people"));
  EXPECT_THAT(result.out, HasSubstr("with net.onnx"));
  const KeypointSequence found = LoadDetections(folder_ / "found.npz");
  EXPECT_EQ(found.convention, "coco17");
  EXPECT_NEAR(found.at(1, 0).y, (320 - 0.44 * 400) / 2, 1e-3);
  EXPECT_EQ(found.at(1, 0).confidence, 0.75F);
}

TEST_F(DetectOnnx, FilesThatAreNoNetworkEndInOneLine) {
  Write("text.onnx", "not a network");
  Write("cut.onnx", ScriptedYoloPose({1, 3, 64, 64}, {}, 17, 80).Bytes().substr(0, 9000));
  Write("other.onnx", ScriptedYoloPose({1, 3, 64, 64}, {}, 5, 10).Bytes());
  OnnxWriter unknown = OnnxWriter().Input("images", {1, 3, 64, 64});
  Write("unknown.onnx", unknown.Node("NonMaxSuppression", {"images"}, {"y"}).Output("y").Bytes());
  for (const auto& [file, words] : {std::pair<std::string, std::string>{"text.onnx", "not an ONNX file"},
                                    {"cut.onnx", "not an ONNX file: byte "},
                                    {"other.onnx", "outputs of 1x20x10; expected 1x3xHxW and 1x56xN"},
                                    {"unknown.onnx", "node '/NonMaxSuppression' (NonMaxSuppression)"},
                                    {"absent.onnx", "No such file"}}) {
    const CommandResult result = Detect({"--pose-model", folder_ / file});
    EXPECT_EQ(result.exit_code, kExitFailed) << result.err;
    EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(folder_ / file + ": "));
    EXPECT_THAT(result.err, HasSubstr(words));
  }
  EXPECT_THAT(folder_.Entries(), Not(Contains("found.npz")));
}

TEST_F(DetectOnnx, TrackAndRunRefuseTheSameFilesBeforeTheyWrite) {
  Write("text.onnx", "not a network");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"track", "--video", folder_ / "clip", "--out", folder_ / "out.npz"},
        {"run", folder_ / "clip", "--out", folder_ / "out"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--pose-model", folder_ / "text.onnx"});
    const CommandResult result = RunCommand(arguments);
    EXPECT_EQ(result.exit_code, kExitFailed) << result.err;
    EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(folder_ / "text.onnx" + ": not an ONNX file"));
  }
  EXPECT_THAT(folder_.Entries(), Not(Contains("out.npz")));
}

TEST_F(DetectOnnx, WrongUse) {
  for (const auto& [arguments, words] :
       {std::pair<std::vector<std::string>, std::string>{{"--box-model", folder_ / "net.onnx"}, "--pose-model"},
        {{"--pose-model", folder_ / "net.onnx", "--mask", folder_ / "m.npz"}, "--mask is BlazePose's"}}) {
    const CommandResult result = Detect(arguments);
    EXPECT_EQ(result.exit_code, kExitUsage) << result.err;
    EXPECT_THAT(result.err, HasSubstr(words));
  }
}

}  // namespace
}  // namespace bodyloom::detect_onnx_test
