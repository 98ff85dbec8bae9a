// SPDX-License-Identifier: Apache-2.0
// Paths of cameras that go from place to place, from points whose camera is known.
#include "tracking/camera_motion/background_structure.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/base/units.h"
#include "geometry/scene/camera_path.h"
#include "tests/tracking/camera_motion/synthetic_background.h"
#include "tracking/camera_motion/camera_motion.h"

namespace bodyloom::background_structure_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Errors of a path: centres after one similarity from the true ones, rotations after its rotation.
struct PathError {
  double place = 0;         ///< rms, as a share of the true path's length
  double rotation_deg = 0;  ///< rms
  double scale = 0;         ///< true over found
};
PathError ErrorOf(const SyntheticBackground& scene, const std::vector<double>& seconds,
                  const std::vector<CameraPose>& poses) {
  Eigen::Matrix3Xd found(3, Eigen::Index(poses.size())), truth(3, Eigen::Index(poses.size()));
  double length = 0;
  for (size_t i = 0; i < poses.size(); ++i) {
    found.col(Eigen::Index(i)) = CentreOf(poses[i]);
    truth.col(Eigen::Index(i)) = CentreOf(scene.pose(seconds[i]));
    if (i > 0) length += (truth.col(Eigen::Index(i)) - truth.col(Eigen::Index(i) - 1)).norm();
  }
  const Eigen::Matrix4d similarity = Eigen::umeyama(found, truth, true);
  const double scale = similarity.col(0).head<3>().norm();
  PathError error;
  error.scale = scale;
  // Rotations tell the scene's turn better than centres on a line do.
  Matrix3d sum = Matrix3d::Zero();
  for (size_t i = 0; i < poses.size(); ++i) {
    sum += scene.pose(seconds[i]).camera_from_world_rotation.transpose() * poses[i].camera_from_world_rotation;
  }
  const Matrix3d turn = NearestRotation(sum);
  for (size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d at = (similarity * found.col(Eigen::Index(i)).homogeneous()).head<3>();
    error.place += (at - truth.col(Eigen::Index(i))).squaredNorm();
    const Matrix3d expected = scene.pose(seconds[i]).camera_from_world_rotation * turn;
    error.rotation_deg += std::pow(RotationAngleBetween(expected, poses[i].camera_from_world_rotation) / kDegree, 2);
  }
  error.place = std::sqrt(error.place / double(poses.size())) / length;
  error.rotation_deg = std::sqrt(error.rotation_deg / double(poses.size()));
  return error;
}
PathError ErrorOf(const SyntheticBackground& scene, const BackgroundStructure& structure) {
  std::vector<double> seconds;
  for (const int frame : structure.frames) seconds.push_back(frame / scene.fps);
  return ErrorOf(scene, seconds, structure.camera_from_first);
}

CameraPose Placed(const CameraPose& turned, const Vector3d& centre) {
  return {turned.camera_from_world_rotation, -turned.camera_from_world_rotation * centre};
}

/// Things 3 to 9 m away; new anchors every 20 frames.
SyntheticBackground Room() {
  SyntheticBackground scene;
  scene.nearest_m = 3;
  scene.farthest_m = 9;
  scene.frames_of_anchor = 20;
  scene.noise_px = 0;
  return scene;
}
CameraPose HandHeld(double t) {
  return Placed(Tremor(t, 1.5), 0.08 * Vector3d(std::sin(2.3 * t), std::sin(1.9 * t + 1) - std::sin(1.0),
                                                std::sin(1.3 * t + 2) - std::sin(2.0)));
}
CameraPose Walking(double t) { return Placed(Tremor(t, 1.5), {0.9 * t, 0.03 * std::sin(11 * t), 0.2 * std::sin(t)}); }
CameraPose Forwards(double t) { return Placed(Tremor(t, 0.5), {0, 0.02 * std::sin(10 * t), 0.6 * t}); }
/// A quarter circle of 3 m, looking at its centre.
CameraPose Orbit(double t) {
  const double angle = M_PI / 6 * t;
  const Matrix3d turn = RotationFromAxisAngle({0, angle, 0});
  const Vector3d centre = Vector3d(0, 0, 3) - turn.transpose() * Vector3d(0, 0, 3);
  return Placed({Tremor(t, 0.5).camera_from_world_rotation * turn, Vector3d::Zero()}, centre);
}

BackgroundStructureOptions KnownFocal(const SyntheticBackground& scene) {
  return {.focal = {.log_mean = std::log(scene.focal_px)}, .focal_known = true};
}

struct NamedPath {
  std::string name;
  CameraPose (*pose)(double);
};
const std::vector<NamedPath> kPaths = {
    {"hand-held", HandHeld}, {"walking", Walking}, {"forwards", Forwards}, {"orbit", Orbit}};

TEST(BackgroundStructure, WithoutNoiseThePathIsExact) {
  for (const NamedPath& path : kPaths) {
    SyntheticBackground scene = Room();
    scene.pose = path.pose;
    const BackgroundStructure structure = ReconstructBackground(TracksOf(scene), KnownFocal(scene));
    ASSERT_TRUE(structure.solved) << path.name << ": " << structure.why;
    EXPECT_EQ(structure.frames.size(), size_t(scene.frames)) << path.name;
    const PathError error = ErrorOf(scene, structure);
    EXPECT_LT(error.place, 1e-4) << path.name;
    EXPECT_LT(error.rotation_deg, 2e-3) << path.name;
    EXPECT_GT(structure.explained, 0.99) << path.name;
    EXPECT_TRUE(structure.camera_from_first.front().camera_from_world_rotation.isIdentity(1e-9)) << path.name;
  }
}

TEST(BackgroundStructure, WithNoiseAndWanderersThePathIsFound) {
  for (const NamedPath& path : kPaths) {
    for (uint64_t seed = 1; seed <= 2; ++seed) {
      SyntheticBackground scene = Room();
      scene.pose = path.pose;
      scene.noise_px = 0.3;
      scene.wanderers = 0.15;
      scene.seed = seed;
      const BackgroundStructure structure = ReconstructBackground(TracksOf(scene), KnownFocal(scene));
      ASSERT_TRUE(structure.solved) << path.name << ": " << structure.why;
      const PathError error = ErrorOf(scene, structure);
      EXPECT_LT(error.place, 0.02) << path.name;
      EXPECT_LT(error.rotation_deg, 0.1) << path.name;
    }
  }
}

TEST(BackgroundStructure, AnUnknownFocalLengthIsFound) {
  for (const NamedPath& path : kPaths) {
    SyntheticBackground scene = Room();
    scene.pose = path.pose;
    scene.noise_px = 0.3;
    scene.wanderers = 0.15;
    const BackgroundStructure structure =
        ReconstructBackground(TracksOf(scene), {.focal = FocalPrior::ForImage(scene.width, scene.height)});
    ASSERT_TRUE(structure.solved) << path.name << ": " << structure.why;
    const double off = structure.log_focal - std::log(scene.focal_px);
    EXPECT_LT(std::abs(off), 4 * structure.log_focal_sigma) << path.name;
    EXPECT_LT(std::abs(off), 0.1) << path.name;
    EXPECT_LT(ErrorOf(scene, structure).place, 0.03) << path.name;
  }
}

TEST(BackgroundStructure, AWallAloneIsEnough) {
  for (const NamedPath& path : kPaths) {
    if (path.name == "orbit") continue;  // the wall is seen from its edge
    SyntheticBackground scene = Room();
    scene.pose = path.pose;
    scene.flat = true;
    scene.nearest_m = scene.farthest_m = 4;
    scene.noise_px = 0.3;
    scene.wanderers = 0.15;
    const BackgroundStructure structure = ReconstructBackground(TracksOf(scene), KnownFocal(scene));
    ASSERT_TRUE(structure.solved) << path.name << ": " << structure.why;
    const PathError error = ErrorOf(scene, structure);
    EXPECT_LT(error.place, 0.02) << path.name;
    // A wall tells a turn from a step aside by its perspective alone.
    EXPECT_LT(error.rotation_deg, 0.3) << path.name;
  }
}

/// Errors over their stated deviations, root mean square over frames and seeds.
struct StatedErrors {
  double turned = 0, placed = 0;
};
StatedErrors ErrorsOverStated(const NamedPath& path, double noise_lasts_s, int seeds) {
  double turned = 0, placed = 0;
  int count = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    SyntheticBackground scene = Room();
    scene.pose = path.pose;
    scene.noise_px = 0.3;
    scene.noise_lasts_s = noise_lasts_s;
    scene.seed = static_cast<uint64_t>(seed);
    const BackgroundStructure structure = ReconstructBackground(TracksOf(scene), KnownFocal(scene));
    EXPECT_TRUE(structure.solved) << path.name << ": " << structure.why;
    // The farthest camera's distance is held: it tells the unit.
    size_t farthest = 0;
    for (size_t i = 0; i < structure.frames.size(); ++i) {
      const auto far = [&](size_t n) { return CentreOf(structure.camera_from_first[n]).norm(); };
      if (far(i) > far(farthest)) farthest = i;
    }
    const CameraPose first = scene.pose(structure.frames.front() / scene.fps);
    const auto truth = [&](size_t i) { return Compose(scene.pose(structure.frames[i] / scene.fps), Inverse(first)); };
    const double unit = CentreOf(truth(farthest)).norm() / CentreOf(structure.camera_from_first[farthest]).norm();
    for (size_t i = 1; i < structure.frames.size(); ++i) {
      const CameraPose& pose = structure.camera_from_first[i];
      const double off = RotationAngleBetween(truth(i).camera_from_world_rotation, pose.camera_from_world_rotation);
      const double away = (CentreOf(truth(i)) / unit - CentreOf(pose)).norm();
      turned += off * off / (3 * structure.sigma_rad[i] * structure.sigma_rad[i]);
      placed += away * away / (3 * structure.sigma_place[i] * structure.sigma_place[i]);
      ++count;
    }
  }
  return {std::sqrt(turned / count), std::sqrt(placed / count)};
}

TEST(BackgroundStructure, StatedDeviationsAreThoseOfTheErrors) {
  for (const NamedPath& path : kPaths) {
    for (const double noise_lasts_s : {0.0, 0.5}) {
      const StatedErrors errors = ErrorsOverStated(path, noise_lasts_s, 3);
      EXPECT_GT(errors.turned, 0.5) << path.name << ", " << noise_lasts_s;
      EXPECT_LT(errors.turned, 1.6) << path.name << ", " << noise_lasts_s;
      EXPECT_GT(errors.placed, 0.5) << path.name << ", " << noise_lasts_s;
      EXPECT_LT(errors.placed, 1.6) << path.name << ", " << noise_lasts_s;
    }
  }
}

/// The hand-held path with a way of this many metres.
SyntheticBackground Shaken(double metres) {
  SyntheticBackground scene = Room();
  scene.noise_px = 0.3;
  scene.pose = [metres](double t) {
    const CameraPose pose = HandHeld(t);
    return Placed(pose, metres / 0.08 * CentreOf(pose));
  };
  return scene;
}

TEST(BackgroundStructure, AHandThatMovesByCentimetresHasAPath) {
  for (const double metres : {0.08, 0.04}) {
    const SyntheticBackground scene = Shaken(metres);
    const CameraMotion motion =
        FindCameraMotion(TracksOf(scene), {.focal = KnownFocal(scene).focal, .focal_known = true});
    ASSERT_EQ(motion.kind, CameraMotionKind::kMoving) << metres << ": " << motion.why;
    ASSERT_TRUE(motion.has_path()) << motion.why;
    EXPECT_LT(ErrorOf(scene, motion.path.timestamps, motion.path.poses).place, 0.02) << metres;
  }
  const SyntheticBackground scene = Shaken(0.01);
  const CameraMotion motion =
      FindCameraMotion(TracksOf(scene), {.focal = KnownFocal(scene).focal, .focal_known = true});
  EXPECT_EQ(motion.kind, CameraMotionKind::kTurning) << motion.why;
}

TEST(BackgroundStructure, WhatIsNoSceneHasNoPath) {
  SyntheticBackground scene = Room();
  scene.noise_px = 0.3;
  scene.pose = Walking;
  scene.wanderers = 0.7;
  const CameraMotion leaves = FindCameraMotion(TracksOf(scene), {.focal = KnownFocal(scene).focal});
  EXPECT_FALSE(leaves.has_path()) << leaves.why;
  // Two frames alone, and none.
  scene.wanderers = 0;
  scene.frames = 2;
  const BackgroundStructure two = ReconstructBackground(TracksOf(scene), KnownFocal(scene));
  EXPECT_FALSE(two.solved) << two.parallax / kDegree;
  BackgroundTracks nothing;
  nothing.width = 64, nothing.height = 48;
  const BackgroundStructure none = ReconstructBackground(nothing, KnownFocal(scene));
  EXPECT_FALSE(none.solved);
  EXPECT_NE(none.why, "");
  // A camera that only turns.
  scene.frames = 60;
  scene.pose = [](double t) { return Tremor(t, 2); };
  const BackgroundStructure turning = ReconstructBackground(TracksOf(scene), KnownFocal(scene));
  EXPECT_FALSE(turning.solved) << turning.parallax / kDegree;
}

/// From anchor to anchor a zoom explains nearly all of a camera that goes towards things of like depth.
TEST(BackgroundStructure, ACameraThatGoesTowardsThingsDoesNotZoom) {
  SyntheticBackground scene = Room();
  scene.noise_px = 0.3;
  scene.nearest_m = 4;
  scene.farthest_m = 5;
  scene.frames_of_anchor = 5;
  scene.pose = Forwards;
  const CameraMotion motion = FindCameraMotion(TracksOf(scene), {.focal = KnownFocal(scene).focal});
  EXPECT_EQ(motion.kind, CameraMotionKind::kMoving) << motion.why;
  EXPECT_TRUE(motion.has_path()) << motion.why;
  EXPECT_EQ(motion.zoom, 1);
  EXPECT_NE(motion.why.find("rotations and a zoom explain 98 %"), std::string::npos) << motion.why;
}

TEST(BackgroundStructure, FramesThatAreNotSeenHaveALargerDeviation) {
  SyntheticBackground scene = Room();
  scene.noise_px = 0.3;
  scene.pose = HandHeld;
  BackgroundTracks tracks = TracksOf(scene);
  const auto is_blank = [](int frame) { return frame > 42 && frame < 57; };
  for (BackgroundTracks::Anchor& anchor : tracks.anchors) {
    std::erase_if(anchor.sights, [&](const BackgroundTracks::Sight& sight) { return is_blank(sight.frame); });
  }
  const CameraMotion motion = FindCameraMotion(tracks, {.focal = KnownFocal(scene).focal, .focal_known = true});
  ASSERT_TRUE(motion.has_path()) << motion.why;
  ASSERT_EQ(motion.of_frames.rad.size(), size_t(scene.frames));
  ASSERT_EQ(motion.of_frames.place.size(), size_t(scene.frames));
  EXPECT_GT(motion.of_frames.place[50], 5 * motion.of_frames.place[40]);
  EXPECT_GT(motion.of_frames.rad[50], 5 * motion.of_frames.rad[40]);
  EXPECT_GT(motion.of_frames.rad[50], 2 * motion.of_frames.rad[44]);
}

TEST(BackgroundStructure, AnEndThatIsNotSeenHasALargerDeviation) {
  SyntheticBackground scene = Room();
  scene.noise_px = 0.3;
  scene.pose = Walking;
  BackgroundTracks tracks = TracksOf(scene);
  tracks.anchors.back().sights.resize(3);  // of ten
  const CameraMotion motion = FindCameraMotion(tracks, {.focal = KnownFocal(scene).focal, .focal_known = true});
  ASSERT_TRUE(motion.has_path()) << motion.why;
  EXPECT_EQ(motion.path.timestamps.back(), tracks.timestamps.back());
  const size_t last = motion.path.poses.size() - 1;
  EXPECT_GT(motion.sigma_place[last], 10 * motion.sigma_place[last - 1]);
}

}  // namespace
}  // namespace bodyloom::background_structure_test
