// SPDX-License-Identifier: Apache-2.0
#include "render/garment/person_cloth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "geometry/cloth/body_with_garment.h"
#include "geometry/cloth/cloth_run.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/photo_avatar/animate_person.h"
#include "pipelines/photo_avatar/person_folder.h"
#include "render/view/overlay.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::person_cloth_test {
namespace {

/// The built-in body in a skirt, grey all over.
PhotoPerson InASkirt() {
  PhotoPerson person;
  person.bare = person.clothed = BodyOrBuiltin("");
  person.cut.waist_y_m = person.bare->joint_template()(3, 1), person.cut.length_m = 0.6, person.cut.fullness = 0.4;
  person.cut.spacing_m = 0.05;
  person.garment = CutGarment(*person.clothed, &person.cut);
  person.body = std::make_shared<const BodyModel>(BodyWithGarment(*person.clothed, person.garment));
  person.betas = Eigen::VectorXd::Zero(2);
  person.texture = Image(16, 16, Colour{120, 120, 120});
  person.tracks = {ShortTrack()};
  person.tracks[0].motion.betas = person.betas;
  return person;
}

double Furthest(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double furthest = 0;
  for (size_t i = 0; i < a.size(); ++i) furthest = std::max(furthest, (a[i] - b[i]).norm());
  return furthest;
}

TEST(PersonCloth, HangsAroundTheHipsAndMovesOn) {
  const PhotoPerson person = InASkirt();
  const Track moved = MovedByPerson(person, ShortTrack(12));
  PersonCloth cloth(*person.clothed, person.garment, moved);
  std::vector<Eigen::Vector3d> before;
  for (int t = 0; t < 6; ++t) {
    const std::vector<Eigen::Vector3d> now = cloth.At(t);
    ASSERT_EQ(now.size(), person.garment.sewn.size());
    const MatrixX3d body = TrackVertices(*person.clothed, moved, t);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : now) mean += p / double(now.size());
    EXPECT_LT((mean - body.colwise().mean().transpose()).norm(), 0.4);
    EXPECT_EQ(Furthest(cloth.At(t), now), 0) << "a frame requested again is the same";
    EXPECT_TRUE(t == 0 || Furthest(now, before) > 0.002) << t;
    before = now;
  }
  EXPECT_THROW(cloth.At(3), std::invalid_argument);
}

TEST(PersonCloth, WaitsWhereTheTrackIsLost) {
  const PhotoPerson person = InASkirt();
  Track moved = MovedByPerson(person, ShortTrack(12));
  for (const int t : {0, 4, 5}) {
    moved.motion.poses.row(t).setConstant(std::numeric_limits<double>::quiet_NaN());
    moved.frame_status[t] = FrameStatus::kLost;
  }
  PersonCloth cloth(*person.clothed, person.garment, moved);
  for (int t = 0; t < 8; ++t) {
    for (const Eigen::Vector3d& p : cloth.At(t)) ASSERT_TRUE(p.allFinite()) << t;
  }
  moved.motion.poses.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(PersonCloth(*person.clothed, person.garment, moved), std::invalid_argument);
}

TEST(PersonCloth, BeginsAtRest) {
  const PhotoPerson person = InASkirt();
  const Track still = FramesInOrder(MovedByPerson(person, ShortTrack(30)), std::vector<int>{5, 5});
  PersonCloth cloth(*person.clothed, person.garment, still);
  const std::vector<Eigen::Vector3d> first = cloth.At(0), next = cloth.At(1);
  double way = 0;
  for (size_t i = 0; i < first.size(); ++i) way += (next[i] - first[i]).norm() / double(first.size());
  const double speed = way / (still.motion.timestamps[1] - still.motion.timestamps[0]);
  EXPECT_LT(speed, 0.04) << "metres a second";
}

TEST(PersonCloth, OtherRunsFallElsewhere) {
  const PhotoPerson person = InASkirt();
  const Track moved = MovedByPerson(person, ShortTrack(12));
  const auto last = [&](int run) {
    PersonCloth cloth(*person.clothed, person.garment, moved, {.run = run});
    return cloth.At(11);
  };
  const std::vector<Eigen::Vector3d> first = PersonCloth(*person.clothed, person.garment, moved).At(11);
  EXPECT_EQ(Furthest(last(0), first), 0);
  for (int run = 1; run < kMaxClothRuns; ++run) {
    const std::vector<Eigen::Vector3d> other = last(run);
    EXPECT_GT(Furthest(other, first), 1e-3) << run;
    EXPECT_LT(Furthest(other, first), 0.15) << run;
    EXPECT_EQ(Furthest(other, last(run)), 0) << run;
  }
  EXPECT_THROW(last(kMaxClothRuns), std::invalid_argument);
  EXPECT_THROW(last(-1), std::invalid_argument);
}

TEST(PersonCloth, NoGarmentNoCloth) {
  PhotoPerson person = InASkirt();
  person.garment = {};
  person.body = person.clothed;
  EXPECT_TRUE(PersonCloth(*person.clothed, person.garment, person.tracks[0]).At(0).empty());
  EXPECT_EQ(StillVertices(person, person.tracks[0]).rows(), person.body->num_vertices());
}

TEST(PersonCloth, AKeptPersonWearsTheSameGarment) {
  const ScratchFolder folder;
  const PhotoPerson person = InASkirt();
  WritePhotoPerson(folder / "", person);
  const PhotoPerson kept = ReadPhotoPerson(folder / "", "");
  EXPECT_EQ(kept.garment.columns, person.garment.columns);
  EXPECT_EQ(kept.garment.rings, person.garment.rings);
  EXPECT_EQ(kept.clothed->num_vertices(), person.clothed->num_vertices());
  const MatrixX3d difference = StillVertices(kept, kept.tracks[0]) - StillVertices(person, person.tracks[0]);
  EXPECT_LT(difference.topRows(person.clothed->num_vertices()).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT(difference.rowwise().norm().mean(), 0.005) << "the body is rounded by 1e-5 m, and cloth is soft";
  WriteFileAtomically(folder / "person.json", R"({"garment": {"waist_y_m": 9, "length_m": 0.6, "fullness": 0.4,
                                                 "spacing_m": 0.05, "columns": 40}})");
  EXPECT_THROW(ReadPhotoPerson(folder / "", ""), std::runtime_error);
  WriteFileAtomically(folder / "person.json", "{}");
  EXPECT_THROW(ReadPhotoPerson(folder / "", ""), std::runtime_error) << "a body with more vertices than it should have";
}

TEST(PersonCloth, IsAnimatedFromAnySideAndFrozen) {
  const ScratchFolder folder;
  WritePhotoPerson(folder / "", InASkirt());
  WriteTrack(folder / "track.npz", ShortTrack());
  AnimatePersonRequest request;
  request.person = folder / "";
  request.track = folder / "track.npz";
  request.view_yaw = "0:90";
  request.freeze = "3:4";
  request.pictures = folder / "pictures";
  const AnimatePersonSummary summary = AnimatePerson(request);
  EXPECT_EQ(summary.frames, ShortTrack().num_frames() + 4);
  EXPECT_EQ(summary.frames_without_fit, 0);
}

}  // namespace
}  // namespace bodyloom::person_cloth_test
