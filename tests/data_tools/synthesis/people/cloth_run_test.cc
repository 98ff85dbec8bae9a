// SPDX-License-Identifier: Apache-2.0
// A synthetic person's skirt along motions.
#include "geometry/cloth/cloth_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/synthesis/people/dressed_render.h"
#include "data_tools/synthesis/people/make_single_person_dataset.h"
#include "geometry/body/normals.h"
#include "geometry/cloth/cloth_simulation.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/synthesis/people/turning_motion.h"
#include "tests/support/paths.h"

namespace bodyloom::cloth_run_test {
namespace {

using Eigen::Vector3d;

/// Mean distance of the hem from the vertical through the pelvis.
double HemRadius(const DressedPerson& person, const std::vector<Vector3d>& cloth) {
  double sum = 0;
  const int n = person.garment().columns;
  for (int j = 0; j < n; ++j) sum += std::hypot(cloth[cloth.size() - n + j].x(), cloth[cloth.size() - n + j].z());
  return sum / n;
}

TEST(ClothRun, ASpinFlaresTheSkirt) {
  const DressedPerson person(BuiltinBody(), Eigen::VectorXd::Zero(10), GarmentKind::kSkirt, 1);
  ClothRun run(person, Turning(60, 30, [](double t) { return 4.0 * t * std::min(t, 1.0); }), {});
  const double at_rest = HemRadius(person, run.Next());
  double widest = 0;
  for (int t = 1; t < 60; ++t) widest = std::max(widest, HemRadius(person, run.Next()));
  EXPECT_GT(widest, at_rest + 0.06);
  EXPECT_EQ(run.num_cuts(), 0);
}

double MeanDistance(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).norm();
  return sum / double(a.size());
}

/// Extrema of the hem's distance from the vertical through the pelvis, going around it: two a fold.
int HemTurns(const DressedPerson& person, const std::vector<Vector3d>& cloth) {
  const int n = person.garment().columns;
  std::vector<double> radius;
  for (int j = 0; j < n; ++j) {
    const Vector3d& p = cloth[cloth.size() - n + j];
    radius.push_back(std::hypot(p.x(), p.z()));
  }
  int turns = 0;
  for (int j = 0; j < n; ++j) {
    const double here = radius[j], before = radius[(j + n - 1) % n], after = radius[(j + 1) % n];
    turns += (here - before) * (after - here) < 0;
  }
  return turns;
}

TEST(ClothRun, LightStuffFallsIntoMoreFoldsThanHeavyStuff) {
  int turns[2];
  for (const ClothMaterial material : {ClothMaterial::kSilk, ClothMaterial::kDenim}) {
    const DressedPerson person(BuiltinBody(), Eigen::VectorXd::Zero(10), GarmentKind::kSkirt, 1,
                               ClothesStyle::kPatterned, material);
    ClothRunOptions options;
    options.cloth = ClothOptionsFor(material, options.cloth);
    ClothRun run(person, Turning(30, 30, [](double t) { return 2.0 * std::sin(4 * t); }), options);
    std::vector<Vector3d> cloth;
    for (int t = 0; t < 30; ++t) cloth = run.Next();
    for (const Vector3d& p : cloth) ASSERT_TRUE(p.allFinite());
    turns[material == ClothMaterial::kDenim] = HemTurns(person, cloth);
  }
  EXPECT_GE(turns[0], turns[1] + 4) << turns[1];
}

TEST(ClothRun, RestDampingBringsItToRest) {
  const DressedPerson person(BuiltinBody(), Eigen::VectorXd::Zero(10), GarmentKind::kSkirt, 1);
  const auto run_with = [&](std::optional<double> rest_damping, bool moves) {
    ClothRunOptions options;
    options.move_in_s = options.settle_s = 0.8, options.rest_damping = rest_damping;
    ClothRun run(person, Turning(10, 30, [&](double t) { return moves ? 3 * t : 0; }), options);
    double speed = 0;
    (void)run.Next();
    for (const Vector3d& v : run.simulation()->velocities()) speed += v.norm();
    std::vector<Vector3d> cloth;
    for (int t = 1; t < 10; ++t) cloth = run.Next();
    return std::pair(speed / double(cloth.size()), cloth);
  };
  const double by_itself = run_with({}, false).first;
  EXPECT_GT(by_itself, 0.04) << "otherwise this shows nothing";
  EXPECT_LT(run_with(4, false).first, 0.4 * by_itself);
  EXPECT_EQ(run_with(ClothOptions().damping, true), run_with({}, true));
  EXPECT_GT(MeanDistance(run_with(4, true).second, run_with(4, false).second), 0.02) << "then it moves as ever";
}

/// The cloth of the last frame, in the body's frame of that pose.
std::vector<Vector3d> LastCloth(const DressedPerson& person, const Motion& motion) {
  ClothRun run(person, motion, {});
  std::vector<Vector3d> cloth;
  for (int t = 0; t < motion.num_frames(); ++t) cloth = run.Next();
  return cloth;
}

TEST(ClothRun, TheSamePoseAtAnotherSpeedGivesOtherCloth) {
  const DressedPerson person(BuiltinBody(), Eigen::VectorXd::Zero(10), GarmentKind::kSkirt, 1);
  const auto swing = [](double phase) { return 0.8 * std::sin(phase); };
  // Both end in the middle of a swing: same pose, 3.6 and 0.6 rad/s.
  const auto end_at = [&](double rate) {
    const int frames = static_cast<int>(std::lround(2 * M_PI / rate * 60)) + 1;
    return Turning(frames, 60, [&](double t) { return swing(rate * t); });
  };
  const std::vector<Vector3d> fast = LastCloth(person, end_at(4.5)), again = LastCloth(person, end_at(4.5)),
                              slow = LastCloth(person, end_at(0.75));
  EXPECT_EQ(fast, again);
  EXPECT_GT(MeanDistance(fast, slow), 0.02);
}

/// Largest depth in the body and stretch over a run.
struct Extremes {
  double depth_m = 0, stretch = 0;
};

Extremes RunAll(const DressedPerson& person, const Motion& motion, int* cuts = nullptr) {
  ClothRun run(person, motion, {});
  Extremes extremes;
  for (int t = 0; t < motion.num_frames(); ++t) {
    const std::vector<Vector3d>& cloth = run.Next();
    for (const Vector3d& p : cloth) EXPECT_TRUE(p.allFinite());
    const BodyPose pose =
        PoseFromAxisAngle(person.body(), motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    const MatrixX3i& faces = person.body().data().faces;
    const MatrixX3d bare = person.BareVertices(pose), clothed = person.Clothed(bare, VertexNormals(bare, faces));
    const MatrixX3d joints = PoseSkeleton(person.body(), person.rest_joints(), pose).joints;
    extremes.depth_m = std::max(
        extremes.depth_m, LargestDepth(cloth, person.obstacles().At(clothed, VertexNormals(clothed, faces), joints)));
    extremes.stretch = std::max(extremes.stretch, LargestStretch(person.garment().cloth, cloth));
  }
  if (cuts != nullptr) *cuts = run.num_cuts();
  return extremes;
}

TEST(ClothRun, StaysOutsideTheBodyAndKeepsItsLength) {
  // A march with high knees, which lift the skirt.
  const auto march = [](double fps) {
    Motion motion = Turning(static_cast<int>(2 * fps), fps, [](double) { return 0.0; });
    for (int t = 0; t < motion.num_frames(); ++t) {
      const double phase = 2 * M_PI * 0.8 * t / fps;
      motion.poses(t, 3) = -0.9 * std::max(0.0, std::sin(phase)),
                      motion.poses(t, 6) = 0.9 * std::min(0.0, std::sin(phase));
      motion.poses(t, 12) = -motion.poses(t, 3), motion.poses(t, 15) = -motion.poses(t, 6);
    }
    return motion;
  };
  for (const GarmentKind kind : {GarmentKind::kSkirt, GarmentKind::kCoat}) {
    const DressedPerson person(BuiltinBody(), Eigen::VectorXd::Zero(10), kind, 1);
    for (const double fps : {5.0, 60.0}) {
      const Extremes extremes = RunAll(person, march(fps));
      EXPECT_LT(extremes.depth_m, 0.01) << ToString(kind) << " at " << fps;
      EXPECT_LT(extremes.stretch, 0.6) << ToString(kind) << " at " << fps;
    }
  }
}

TEST(ClothRun, SettlesAgainAfterACut) {
  const DressedPerson person(BuiltinBody(), Eigen::VectorXd::Zero(10), GarmentKind::kSkirt, 1);
  Motion motion = Turning(12, 30, [](double t) { return t < 0.2 ? 0.0 : 2.5; });
  for (int t = 6; t < 12; ++t) motion.trans.row(t) << 3, 0, -2;
  int cuts = 0;
  const Extremes extremes = RunAll(person, motion, &cuts);
  EXPECT_EQ(cuts, 1);
  EXPECT_LT(extremes.depth_m, 0.005);
  EXPECT_LT(extremes.stretch, 0.1);
}

TEST(ClothRun, ACutForgetsWhatWas) {
  const DressedPerson person(BuiltinBody(), Eigen::VectorXd::Zero(10), GarmentKind::kSkirt, 1);
  Motion alone = Turning(8, 30, [](double t) { return 2 * t; });
  alone.poses.col(3).setConstant(-0.5);
  Motion after = Turning(20, 30, [](double t) { return 9 * t; });
  after.poses.bottomRows(8) = alone.poses, after.trans.bottomRows(8) = alone.trans;
  for (int t = 0; t < 8; ++t)
    after.timestamps[12 + t] = after.timestamps[11] + ClothRunOptions().cut_pause_s + t / 30.0;
  ClothRunOptions options;
  options.has_floor = false;  // which would be that of the whole motion
  ClothRun run(person, after, options), fresh(person, alone, options);
  for (int t = 0; t < 12; ++t) (void)run.Next();
  for (int t = 0; t < 8; ++t) {
    const std::vector<Vector3d>&a = run.Next(), &b = fresh.Next();
    double furthest = 0;
    for (size_t v = 0; v < a.size(); ++v) furthest = std::max(furthest, (a[v] - b[v]).norm());
    EXPECT_LT(furthest, 1e-9) << t;
  }
  EXPECT_EQ(run.num_cuts(), 1);
}

TEST(ClothRun, LegsComeBackIntoTheSkirt) {
  // A kick above the head goes through the skirt (as long as it lasts); after it the leg must come back in.
  const std::string path = SharedDir() + "/data/motion/cmu_bvh/05_08.bvh.gz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no recording at " << path;
  LoadMotionOptions load;
  load.resample_fps = 30;
  MakeSinglePersonDatasetOptions options;
  options.garment = GarmentKind::kSkirt, options.seed = 3;
  SynthCamera camera;
  const Motion motion = TrackInView(BuiltinBody(), TakeFrames(LoadMotion(path, load), 30, 90), options, &camera).motion;
  const DressedPerson person(BuiltinBody(), motion.betas, options.garment, options.seed);
  ClothRunOptions run_options;
  run_options.up = camera.up_in_camera;
  ClothRun run(person, motion, run_options);
  EXPECT_EQ(run.legs_through(), 0) << "before the first frame";
  int frames = 0;
  for (int t = 0; t < motion.num_frames(); ++t) {
    (void)run.Next();
    if (t < 60) frames += run.legs_through() > 0;
    EXPECT_EQ(t < 60 ? 0 : run.legs_through(), 0) << t;
  }
  EXPECT_GT(frames, 0) << "otherwise this shows nothing";
}

TEST(ClothRun, ChecksItsContract) {
  const DressedPerson person(BuiltinBody(), Eigen::VectorXd::Zero(10), GarmentKind::kSuit, 1);
  Motion motion = Turning(2, 30, [](double) { return 0.0; });
  ClothRun run(person, motion, {});
  EXPECT_TRUE(run.Next().empty()) << "a suit has no cloth";
  (void)run.Next();
  EXPECT_THROW((void)run.Next(), std::invalid_argument);
  motion.timestamps[1] = 0;
  EXPECT_THROW(ClothRun(person, motion, {}), std::invalid_argument);
  motion.timestamps[1] = 1;
  for (const double damping : {-1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    ClothRunOptions options;
    options.rest_damping = damping;
    EXPECT_THROW(ClothRun(person, motion, options), std::invalid_argument) << damping;
  }
  motion.poses(1, 5) = NAN;
  EXPECT_THROW(ClothRun(person, motion, {}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::cloth_run_test
