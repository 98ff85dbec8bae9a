// SPDX-License-Identifier: Apache-2.0
// Memory of `bodyloom track` against the clip's length.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/usage_error.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::track_long_test {
namespace {

TEST(TrackLong, MemoryGrowsByLittleMoreThanTheTrack) {
  const ScratchFolder folder;
  constexpr int kShort = 2100, kLong = 5100;  // both are solved in windows
  SynthClipOptions synth;
  synth.dense_per_frame = 0;
  synth.camera.width = 240;  // the truth's visibility is rendered for each frame
  synth.camera.height = 180;
  // Fifteen frames a second: all are coarse frames, of which a video of 30 frames a second has half.
  SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), kLong, 15), synth);
  const auto peak_bytes = [&](int frames) {
    clip.keypoints.timestamps.resize(frames);
    clip.keypoints.points.resize(static_cast<size_t>(frames) * clip.keypoints.names.size());
    WriteObservations(folder / "clip.npz", &clip.keypoints, nullptr);
    const CommandResult run =
        RunCommand({"track", "--detections", folder / "clip.npz", "--image-size", "240x180", "--out",
                    folder / "track.npz", "--json", folder / "track.json", "--threads", "2", "--quiet"});
    EXPECT_EQ(run.exit_code, kExitOk) << run.err;
    std::ifstream file(folder / "track.json");
    return nlohmann::json::parse(file).at("peak_memory_bytes").get<double>();
  };
  const double of_long = peak_bytes(kLong), of_short = peak_bytes(kShort);
  const double kb_per_frame = (of_long - of_short) / 1000 / (kLong - kShort);
  // The chain of all coarse frames would take 55 KB each.
  EXPECT_LT(kb_per_frame, 30) << of_short << " and " << of_long << " bytes";
}

}  // namespace
}  // namespace bodyloom::track_long_test
