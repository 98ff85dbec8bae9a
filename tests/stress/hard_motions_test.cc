// SPDX-License-Identifier: Apache-2.0
// Recorded acrobatics: somersaults, cartwheels, spins, at the 16 frames a second that the backflip was recorded with.
#include <cmath>
#include <filesystem>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/load_motion.h"
#include "tests/stress/stress_support.h"
#include "tests/support/paths.h"

namespace bodyloom::stress::hard_motions_test {
namespace {

class HardMotions : public EngineTest {};
BODYLOOM_WITH_EVERY_ENGINE(HardMotions);

struct HardMotion {
  const char* file;
  double from_nothing_mm;  ///< promised without a start and without dense keypoints
  double dense_mm;         ///< and with dense keypoints, from the true poses perturbed by 25 px
};

constexpr HardMotion kMotions[] = {
    {"deepmimic/humanoid3d_cartwheel.txt", 110, 15},  {"deepmimic/humanoid3d_spinkick.txt", 180, 25},
    {"deepmimic/humanoid3d_sideflip.txt", 110, 15},   {"deepmimic/humanoid3d_roll.txt", 100, 15},
    {"deepmimic/humanoid3d_dance_spin.txt", 150, 15}, {"amp_cmu/amp_humanoid_backflip.npy", 180, 15}};

TEST_P(HardMotions, AcrobaticsAt16FramesASecond) {
  const std::string folder = SharedDir() + "/data/motion/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recorded motion: " << folder << " is not there";
  for (const HardMotion& hard : kMotions) {
    SCOPED_TRACE(hard.file);
    LoadMotionOptions at_16_fps;
    at_16_fps.resample_fps = 16;
    const Motion motion = LoadMotion(folder + hard.file, at_16_fps);
    ASSERT_GT(motion.num_frames(), 8);
    SynthClipOptions options;
    options.initialiser_error_px = 25;
    const SynthClip clip = ClipOf(BuiltinBody(), motion, 150, options);
    TrackSequenceInput input = InputOf(BuiltinBody(), clip);
    input.initialiser = &clip.initialiser;
    const TrackSequenceResult dense = Fit(input, OptionsOf(GetParam()));
    ASSERT_TRUE(dense.summary.IsUsable()) << dense.summary.message;
    EXPECT_LT(ErrorMm(dense, clip), hard.dense_mm);
    input.initialiser = nullptr;
    input.dense = nullptr;
    const TrackSequenceResult from_nothing = Fit(input, OptionsOf(GetParam()));
    ASSERT_TRUE(from_nothing.summary.IsUsable()) << from_nothing.summary.message;
    EXPECT_LT(ErrorMm(from_nothing, clip), hard.from_nothing_mm);
  }
}

}  // namespace
}  // namespace bodyloom::stress::hard_motions_test
