// SPDX-License-Identifier: Apache-2.0
// From a clip and a TorchScript file to input of `bodyloom track --dense`, by the command.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "apps/usage_error.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/video/image_file.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera.h"
#include "pipelines/track/track_inputs.h"
#include "render/raster/visible_points.h"
#include "tests/neural/densepose/scripted_densepose.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tracking/detection/iuv_to_dense.h"

namespace bodyloom::dense_verb_test {
namespace {

using ::testing::HasSubstr;

constexpr int kSide = 160, kFrames = 4;

/// The charts of the built-in body in its rest pose, seen from the front, without the margin around it.
ChartImage RenderedCharts() {
  const BodyModel& body = BuiltinBody();
  const Camera camera = MakePinhole(kSide, kSide, 200);
  BodyPose pose = PoseFromAxisAngle(body, Eigen::VectorXd::Zero(3 * body.num_joints()), Eigen::Vector3d(0, 0, 2.6));
  pose.rotations[0] = RotationFromAxisAngle({M_PI, 0, 0});
  const MatrixX3d vertices = PoseVertices(body, Eigen::VectorXd(), pose);
  VisibilityBuffer buffer;
  buffer.Render(vertices, body.data().faces, camera);
  const VisiblePoints points = ResolveVisiblePoints(buffer, body, vertices, camera, {.part = true, .chart_uv = true});
  ChartImage image;
  const auto [x0, x1] = std::minmax_element(points.x.begin(), points.x.end());
  const auto [y0, y1] = std::minmax_element(points.y.begin(), points.y.end());
  image.width = *x1 - *x0 + 1;
  image.height = *y1 - *y0 + 1;
  const size_t num_pixels = size_t(image.width) * size_t(image.height);
  image.part.resize(num_pixels);
  image.u.resize(num_pixels);
  image.v.resize(num_pixels);
  for (size_t k = 0; k < points.size(); ++k) {
    const size_t i = size_t(points.y[k] - *y0) * size_t(image.width) + size_t(points.x[k] - *x0);
    image.part[i] = points.part[k];
    image.u[i] = float(points.chart_uv[k].x());
    image.v[i] = float(points.chart_uv[k].y());
  }
  return image;
}

/// A clip in which the body's rectangle walks to the right in a landscape picture, and the model that sees it.
class DenseVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "clip");
    for (int t = 0; t < kFrames; ++t) {
      char name[32];
      std::snprintf(name, sizeof name, "clip/%04d.png", t);
      WriteImage(folder_ / name, RedRectangle(kWidth, kHeight, X(t), kY, truth_.width, truth_.height));
    }
    const auto tensor = [&](std::vector<float>& values) {
      return torch::from_blob(values.data(), {truth_.height, truth_.width}).clone();
    };
    std::vector<float> part(truth_.part.begin(), truth_.part.end());
    const ScriptedPlanes planes = PlanesOf(tensor(part).to(torch::kLong), tensor(truth_.u), tensor(truth_.v));
    ScriptedDensePose(planes, kScriptedTuple).save(folder_ / "tuple.torchscript");
    ScriptedDensePose(planes, kScriptedDict).save(folder_ / "dict.pt");
  }
  /// The last frame's person is right of x = height.
  static int X(int t) { return 20 + 70 * t; }
  [[nodiscard]] std::vector<std::string> Arguments(const std::string& model) const {
    return {"detect", "--video", folder_ / "clip", "--dense-model", model, "--dense-out", folder_ / "d.npz",
            "--fps",  "25"};
  }

  static constexpr int kWidth = 420, kHeight = 200, kY = 15;
  ChartImage truth_ = RenderedCharts();
  ScratchFolder folder_;
};

TEST_F(DenseVerb, WritesTheSurfacePointsThatThePixelsShow) {
  const ChartLookup charts(BuiltinBody());
  const std::vector<DenseKeypoint> expected = IuvToDense(truth_, charts, {});
  ASSERT_EQ(expected.size(), 1000U);
  for (const char* model : {"tuple.torchscript", "dict.pt"}) {
    const CommandResult result = RunCommand(Arguments(folder_ / model));
    ASSERT_EQ(result.exit_code, kExitOk) << result.err;
    EXPECT_THAT(result.out, HasSubstr("dense    1000 keypoints a frame in 4 frames, one of 1 people"));
    const DenseSequence dense = LoadDense(folder_ / "d.npz", BuiltinBody());
    ASSERT_EQ(dense.num_frames(), kFrames);
    EXPECT_EQ(dense.image_width, kWidth);
    EXPECT_EQ(dense.image_height, kHeight);
    EXPECT_EQ(dense.uv_sigma, kDensePoseUvSigma);
    EXPECT_EQ(dense.pixel_sigma_px, kPixelWidthSigma);
    for (int t = 0; t < kFrames; ++t) {
      EXPECT_NEAR(dense.timestamps[size_t(t)], t / 25.0, 1e-9);
      ASSERT_EQ(dense.frames[size_t(t)].size(), expected.size()) << t;
      for (size_t k = 0; k < expected.size(); ++k) {
        const DenseKeypoint& point = dense.frames[size_t(t)][k];
        ASSERT_EQ(point.face, expected[k].face);
        ASSERT_TRUE(point.barycentric.isApprox(expected[k].barycentric, 1e-4F));
        ASSERT_EQ(point.pixel, expected[k].pixel + Eigen::Vector2f(float(X(t)), float(kY)));
      }
    }
  }
}

TEST_F(DenseVerb, TheTrackerTakesWhatWasWritten) {
  ASSERT_EQ(RunCommand(Arguments(folder_ / "dict.pt")).exit_code, kExitOk);
  TrackRequest request;
  request.dense = folder_ / "d.npz";
  const TrackInputs inputs = LoadTrackInputs(request);
  ASSERT_TRUE(inputs.dense.has_value());
  EXPECT_EQ(inputs.num_frames(), kFrames);
  EXPECT_EQ(inputs.dense->frames[3].size(), 1000U);
  EXPECT_EQ(inputs.camera.camera.width, kWidth);
}

TEST_F(DenseVerb, FilesThatAreNoModelLeaveNothingBehind) {
  std::ofstream(folder_ / "garbage.pt") << "not a model";
  std::vector<std::string> arguments = Arguments(folder_ / "garbage.pt");
  arguments.emplace_back("--quiet");
  const CommandResult result = RunCommand(arguments);
  EXPECT_EQ(result.exit_code, kExitFailed);
  EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("bodyloom: " + folder_ / "garbage.pt"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "d.npz"));
}

}  // namespace
}  // namespace bodyloom::dense_verb_test
