// SPDX-License-Identifier: Apache-2.0
// Fits to masks of a skirt in motion, whose cloth is finer, heavier and stiffer than the fit's.
#include "render/garment/clip_clothes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "render/gaussian_avatar/worn_garment.h"
#include "tests/render/garment/skirt_scene.h"

namespace bodyloom::clip_clothes_test {
namespace {

constexpr int kFrames = 8;
constexpr double kLength_m = 0.55, kFullness = 0.7;

/// Someone who turns to and fro.
Track Turning() {
  Track track = StandingPhoto(0);
  Motion& motion = track.motion;
  const RowMatrixXd pose = motion.poses, place = motion.trans;
  motion.poses.resize(kFrames, pose.cols()), motion.trans.resize(kFrames, 3);
  motion.timestamps.clear(), track.frame_status.clear();
  for (int t = 0; t < kFrames; ++t) {
    motion.poses.row(t) = StandingPhoto(0.8 * std::sin(0.6 * t)).motion.poses.row(0);
    motion.trans.row(t) = place.row(0);
    motion.timestamps.push_back(t / 15.0);
    track.frame_status.push_back(FrameStatus::kTracked);
  }
  return track;
}

class ClipClothesTest : public ::testing::Test {
 protected:
  /// Of the body alone, or in the skirt as it swings.
  [[nodiscard]] std::vector<LabelImage> Masks(bool skirt) const {
    ClothCollisionBody wearer(body_, track_.motion.betas, {});
    WearSkirt(kLength_m, kFullness, &wearer);
    ClothRunOptions options;
    options.up = SwungUp(track_, 0);
    ClothRun run(wearer, track_.motion, options);
    const BodyModel both(BodyWithGarment(body_, wearer.garment()));
    std::vector<LabelImage> masks;
    for (int t = 0; t < kFrames; ++t) {
      MatrixX3d vertices = TrackVertices(skirt ? both : body_, track_, t);
      if (skirt) PlaceGarment(wearer.garment(), run.Next(), &vertices);
      masks.push_back(MaskOf(vertices, (skirt ? both : body_).data().faces, track_.camera));
    }
    return masks;
  }
  [[nodiscard]] ClipClothes Fit(const std::vector<LabelImage>& masks, int threads) const {
    std::vector<int> all(kFrames);
    std::iota(all.begin(), all.end(), 0);
    return FitClipClothes(body_, track_, all, [&](int t) { return masks[t]; }, threads, {});
  }

  const BodyModel& body_ = BuiltinBody();
  const Track track_ = Turning();
};

TEST_F(ClipClothesTest, FindsTheSkirtOfSomeoneWhoMoves) {
  const std::vector<LabelImage> masks = Masks(true);
  const ClipClothes clothes = Fit(masks, 2);
  ASSERT_GT(clothes.garment.length_m, 0) << clothes.mask_error_tight << " " << clothes.mask_error_with_garment;
  EXPECT_NEAR(clothes.garment.waist_y_m - clothes.garment.length_m, body_.joint_template()(3, 1) - kLength_m, 0.04);
  EXPECT_NEAR(clothes.garment.fullness, kFullness, 0.17);
  EXPECT_LT(clothes.mask_error_with_garment, 0.05);
  EXPECT_LT(clothes.mask_error_with_garment, clothes.mask_error_tight);
  EXPECT_EQ(clothes.frames, 2);
  EXPECT_EQ(clothes.found_in, 2);

  const ClipClothes again = Fit(masks, 1);
  EXPECT_EQ(again.garment.length_m, clothes.garment.length_m);
  EXPECT_EQ(again.garment.fullness, clothes.garment.fullness);
  EXPECT_EQ(again.offsets_m, clothes.offsets_m);
  EXPECT_EQ(again.mask_error_with_garment, clothes.mask_error_with_garment);

  // Stored and cut anew it is the same garment, for this body alone.
  const Eigen::VectorXd betas = track_.motion.betas, others = Eigen::VectorXd::Constant(2, 1);
  const AvatarGarment garment = GarmentOf(body_, betas, clothes);
  const WornGarment worn = CutAnew(body_, betas, garment, "run/avatar.npz");
  EXPECT_EQ(worn.nodes().size(), garment.num_nodes());
  EXPECT_THROW(CutAnew(body_, others, garment, "run/avatar.npz"), std::runtime_error);
  const GarmentBones bones = worn.Along(track_, {});
  ASSERT_EQ(bones.of_frame.size(), static_cast<size_t>(kFrames));
  EXPECT_EQ(bones.of_frame[3].size(), 12 * static_cast<size_t>(garment.num_nodes()));
  EXPECT_NE(bones.of_frame[3], bones.of_frame[4]);
  const std::vector<GarmentBones> runs = worn.RunsAlong(track_, 3, 2, {}), alone = worn.RunsAlong(track_, 3, 1, {});
  EXPECT_EQ(runs[0].of_frame, bones.of_frame);
  for (int r = 0; r < 3; ++r) EXPECT_EQ(runs[r].of_frame, alone[r].of_frame) << r;
  EXPECT_NE(runs[1].of_frame[5], bones.of_frame[5]);
  EXPECT_NE(runs[2].of_frame[5], runs[1].of_frame[5]);
}

TEST_F(ClipClothesTest, FindsNoneOnABareBodyAndInNoFrames) {
  const ClipClothes clothes = Fit(Masks(false), 2);
  EXPECT_EQ(clothes.garment.length_m, 0);
  EXPECT_TRUE(clothes.offsets_m.empty());
  EXPECT_EQ(clothes.found_in, 0);
  EXPECT_EQ(FitClipClothes(body_, track_, {}, [](int) { return LabelImage(); }, 1, {}).garment.length_m, 0);
  // Frames in which the mask is empty say nothing.
  EXPECT_EQ(Fit(std::vector<LabelImage>(kFrames), 1).frames, 0);
}

}  // namespace
}  // namespace bodyloom::clip_clothes_test
