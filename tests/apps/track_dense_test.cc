// SPDX-License-Identifier: Apache-2.0
// Noise of dense keypoints in `bodyloom track`, from files to the plan: this project's .npz, DensePose images, and the
// user's setting.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/usage_error.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/video/image_file.h"
#include "render/raster/visible_points.h"
#include "render/view/overlay.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::track_dense_test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kRunsUv = "run   rendered UV (L_r)";
constexpr const char* kSkipsUv = "skip  rendered UV (L_r)";

CommandResult RunWell(const std::vector<std::string>& arguments) {
  CommandResult result = RunCommand(arguments);
  EXPECT_EQ(result.exit_code, kExitOk) << arguments[0] << ": " << result.err;
  return result;
}

class TrackDense : public ::testing::Test {
 protected:
  void Synth(const std::vector<std::string>& noise) {
    std::vector<std::string> command = {"synth",          "--motion", "demo", "--frames", "6",   "--out",
                                        folder_ / "clip", "--width",  "240",  "--height", "240", "--quiet"};
    command.insert(command.end(), noise.begin(), noise.end());
    RunWell(command);
  }

  std::string Plan(const std::vector<std::string>& more) {
    std::vector<std::string> command = {"track", "--cameras", folder_ / "clip/camera.json", "--plan"};
    command.insert(command.end(), more.begin(), more.end());
    return RunWell(command).out;
  }

  /// The true body as DensePose would label it, one PNG a frame: blue is the part, bytes rounded down.
  void WriteIuvImages() {
    std::filesystem::create_directory(folder_ / "iuv");
    const Track truth = ReadTrack(folder_ / "clip/truth.npz");
    const BodyModel& body = BuiltinBody();
    VisibilityBuffer buffer;
    for (int t = 0; t < truth.num_frames(); ++t) {
      const MatrixX3d vertices = TrackVertices(body, truth, t);
      buffer.Render(vertices, body.data().faces, truth.camera);
      const VisiblePoints points =
          ResolveVisiblePoints(buffer, body, vertices, truth.camera, {.part = true, .chart_uv = true});
      Image image(truth.camera.width, truth.camera.height);
      for (size_t k = 0; k < points.size(); ++k) {
        uint8_t* pixel = image.pixel(points.x[k], points.y[k]);
        pixel[0] = points.part[k];
        pixel[1] = static_cast<uint8_t>(std::floor(255 * points.chart_uv[k].x()));
        pixel[2] = static_cast<uint8_t>(std::floor(255 * points.chart_uv[k].y()));
      }
      char name[32];
      std::snprintf(name, sizeof name, "iuv/f_%04d_IUV.png", t);
      WriteImage(folder_ / name, image);
    }
  }

  ScratchFolder folder_;
};

TEST_F(TrackDense, TheNoiseOfAClipReachesTheTrackerThroughItsFile) {
  Synth({"--uv-noise", "0.02", "--quantise"});
  const std::string file = folder_ / "clip/observations.npz";
  EXPECT_NEAR(ReadDenseObservations(file).uv_sigma, std::hypot(0.02, 1 / (255 * std::sqrt(12.0))), 1e-12);
  EXPECT_THAT(Plan({"--detections", file}), HasSubstr(kRunsUv));
  EXPECT_THAT(Plan({"--detections", file, "--dense-uv-sigma", "0"}), HasSubstr(kSkipsUv));

  Synth({"--pixel-noise", "1"});
  EXPECT_THAT(Plan({"--detections", file}), HasSubstr(kSkipsUv));
  EXPECT_THAT(Plan({"--detections", file, "--dense-uv-sigma", "0.01"}), HasSubstr(kRunsUv));
}

TEST_F(TrackDense, AFileWithoutTheNoiseIsReadAsNotKnown) {
  Synth({"--uv-noise", "0.02"});
  NpzArrays arrays = ReadNpz(folder_ / "clip/observations.npz");
  arrays.erase("dense_uv_sigma");
  arrays.erase("dense_pixel_sigma_px");
  WriteNpz(folder_ / "older.npz", arrays);
  EXPECT_THAT(Plan({"--detections", folder_ / "older.npz"}), HasSubstr(kSkipsUv));
}

TEST_F(TrackDense, DensePoseImagesAreTrackedWithTheirNoise) {
  Synth({"--dense", "0", "--init-error", "10"});
  WriteIuvImages();
  const std::vector<std::string> inputs = {"--dense", folder_ / "iuv", "--fps",
                                           "60",      "--init",        folder_ / "clip/initialiser.npz"};
  EXPECT_THAT(Plan(inputs), HasSubstr(kRunsUv));
  std::vector<std::string> unknown = inputs;
  unknown.insert(unknown.end(), {"--dense-uv-sigma", "0"});
  EXPECT_THAT(Plan(unknown), HasSubstr(kSkipsUv));

  std::vector<std::string> command = {"track", "--cameras",           folder_ / "clip/camera.json",
                                      "--out", folder_ / "track.npz", "--quiet"};
  command.insert(command.end(), inputs.begin(), inputs.end());
  RunWell(command);
  RunWell({"evaluate", "--track", folder_ / "track.npz", "--truth", folder_ / "clip/truth.npz", "--json",
           folder_ / "errors.json"});
  std::ifstream file(folder_ / "errors.json");
  EXPECT_LT(nlohmann::json::parse(file)["values"]["projection_mean_px"].get<double>(), 2) << "began at 10";
}

TEST_F(TrackDense, NoiseWithoutDenseKeypointsIsAMistake) {
  const CommandResult result = RunCommand({"track", "--detections", "x.json", "--dense-uv-sigma", "0.1", "--plan"});
  EXPECT_EQ(result.exit_code, kExitUsage);
  EXPECT_THAT(result.err, HasSubstr("give --dense"));
}

}  // namespace
}  // namespace bodyloom::track_dense_test
