// SPDX-License-Identifier: Apache-2.0
// Prior of an unknown focal length.
#include "pipelines/track/scene_inputs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/callbacks.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/video/exif_maker.h"

namespace bodyloom::scene_inputs_test {
namespace {

TrackRequest RequestFor(const std::string& video) {
  TrackRequest request;
  request.video = video;
  request.out = "track.npz";
  return request;
}

TEST(SceneInputs, TheFocalLengthIsLookedForNearThatOfTheLens) {
  const TemporaryFolder folder;
  const std::string bare = folder.File("bare.jpg"), lens = folder.File("lens.jpg");
  const std::string jpeg = EncodeImage(Image(300, 200, Colour{90, 120, 30}), bare);
  WriteFileAtomically(bare, jpeg);
  WriteFileAtomically(lens, WithExif(jpeg, TiffWith(true, 0xA405, 3, 50)));

  EXPECT_FALSE(LoadSceneInputs(RequestFor(bare)).ForTracker().focal_prior);

  const auto noted = LoadSceneInputs(RequestFor(lens)).ForTracker().focal_prior;
  ASSERT_TRUE(noted);
  EXPECT_NEAR(std::exp(noted->log_mean), 50.0 / 36 * 300, 1e-9);
  EXPECT_EQ(noted->log_sigma, 0.05);

  TrackRequest request = RequestFor(lens);
  request.focal_35mm_mm = 24;
  const auto requested = LoadSceneInputs(request).ForTracker().focal_prior;
  ASSERT_TRUE(requested);
  EXPECT_NEAR(std::exp(requested->log_mean), 24.0 / 36 * 300, 1e-9) << "before what the file says";
}

TEST(SceneInputs, ALensBesideAKnownCameraIsRefused) {
  for (const int which : {0, 1, 2}) {
    TrackRequest request = RequestFor("clip.mp4");
    request.focal_35mm_mm = 26;
    CheckTrackRequest(request);
    if (which == 0) request.cameras = "camera.json";
    if (which == 1) request.focal_px = 900;
    if (which == 2) request.camera = "weak";
    EXPECT_THROW(CheckTrackRequest(request), RequestError) << which;
  }
}

}  // namespace
}  // namespace bodyloom::scene_inputs_test
