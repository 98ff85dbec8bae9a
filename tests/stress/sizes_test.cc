// SPDX-License-Identifier: Apache-2.0
// Images, bodies and units of unusual size.
#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "tests/stress/bodies_of_any_size.h"
#include "tests/stress/stress_support.h"
#include "tests/support/toy_body.h"

namespace bodyloom::stress::sizes_test {
namespace {

class Sizes : public EngineTest {};
BODYLOOM_WITH_EVERY_ENGINE(Sizes);

SynthClip ClipInImage(int width, int height, int dense) {
  SynthClipOptions options;
  options.camera.width = width;
  options.camera.height = height;
  return DemoClip(BuiltinBody(), 20, 15, dense, options);
}

TEST_P(Sizes, ImagesFrom64PixelsTo8K) {
  struct Size {
    int width, height;
    double mm;
  };
  for (const Size& size : {Size{64, 48, 110}, Size{960, 720, 80}, Size{7680, 4320, 80}, Size{4320, 7680, 80}}) {
    const SynthClip clip = ClipInImage(size.width, size.height, 0);
    for (const CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal}) {
      TrackSequenceOptions options = OptionsOf(GetParam());
      options.camera_knowledge = knowledge;
      const TrackSequenceResult result = Fit(InputOf(BuiltinBody(), clip), options);
      ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
      EXPECT_LT(ErrorMm(result, clip), size.mm) << size.width << "x" << size.height;
    }
  }
}

TEST_P(Sizes, DenseKeypointsIn64PixelsAnd8K) {
  for (const int width : {64, 7680}) {
    const SynthClip clip = ClipInImage(width, width * 3 / 4, 100);
    const TrackSequenceResult result = Fit(InputOf(BuiltinBody(), clip), OptionsOf(GetParam()));
    ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
    EXPECT_LT(ErrorMm(result, clip), 45) << width;
  }
}

TEST_P(Sizes, BodiesOf100And50000Vertices) {
  const auto error = [&](const BodyModel& body) {
    const SynthClip clip = DemoClip(body, 20);
    const TrackSequenceResult result = Fit(InputOf(body, clip), OptionsOf(GetParam()));
    EXPECT_TRUE(result.summary.IsUsable()) << result.summary.message;
    return result.summary.IsUsable() ? ErrorMm(result, clip) : 1e9;
  };
  const double toy = error(ToyBody());
  EXPECT_LT(toy, 90);
  EXPECT_LT(error(BodyOf100Vertices()), toy + 20);
  EXPECT_LT(error(BodyOfManyVertices(50000)), toy + 20);
}

TEST_P(Sizes, ABodyInMillimetresIsRefusedInOneLine) {
  const SynthClip clip = DemoClip(BuiltinBody(), 5);
  for (const double scale : {1000.0, 100.0, 0.001}) {
    const BodyModel body = ScaledBody(BuiltinBody(), scale);
    TrackSequenceInput input = InputOf(body, clip);
    try {
      (void)FitClip(input, OptionsOf(GetParam()));
      FAIL() << "a body " << 1.7 * scale << " m tall was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("metres"), std::string::npos) << error.what();
    }
  }
}

TEST_P(Sizes, AnInitialiserInMillimetresIsRefusedInOneLine) {
  const SynthClip clip = DemoClip(BuiltinBody(), 5);
  Motion start = clip.truth.motion;
  start.trans *= 1000;
  TrackSequenceInput input = InputOf(BuiltinBody(), clip);
  input.initialiser = &start;
  try {
    (void)FitClip(input, OptionsOf(GetParam()));
    FAIL() << "a person kilometres away was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("metres"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace bodyloom::stress::sizes_test
