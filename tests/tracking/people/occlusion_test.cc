// SPDX-License-Identifier: Apache-2.0
// Occlusion of one person by another, with bodies at known positions.
#include "tracking/people/occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "render/view/follow_view.h"
#include "render/view/overlay.h"

namespace bodyloom::occlusion_test {
namespace {

/// A body in its rest pose, upright before the camera, at x and z metres.
Track Standing(double x, double z, const std::vector<double>& timestamps) {
  const BodyModel& body = BuiltinBody();
  Track track;
  track.camera = MakePinhole(640, 480, 500);
  const auto T = Eigen::Index(timestamps.size());
  track.motion.poses = RowMatrixXd::Zero(T, 3 * body.num_joints());
  track.motion.poses.col(0).setConstant(M_PI);  // y up in the body, down in the image
  track.motion.trans = MatrixX3d::Zero(T, 3);
  track.motion.trans.col(0).setConstant(x);
  track.motion.trans.col(2).setConstant(z);
  track.motion.timestamps = timestamps;
  track.motion.up = Motion::Up::kCamera;
  track.frame_status.resize(timestamps.size(), FrameStatus::kTracked);
  track.joints = TrackJoints(body, track);
  return track;
}

/// Both hips and both wrists, each frame, as the body has them.
KeypointSequence Seen(const Track& track) {
  KeypointSequence seen;
  seen.names = {"left_hip", "right_hip", "left_wrist", "right_wrist"};
  seen.timestamps = track.motion.timestamps;
  const BodyModel& body = BuiltinBody();
  for (int t = 0; t < track.num_frames(); ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
    const MatrixX3d points = PoseLandmarks(body, Eigen::VectorXd(), pose, seen.names);
    for (int k = 0; k < points.rows(); ++k) {
      Eigen::Vector2d pixel;
      EXPECT_TRUE(track.camera.Project(points.row(k).transpose(), &pixel));
      seen.points.push_back({float(pixel.x()), float(pixel.y()), 1.0F});
    }
  }
  return seen;
}

PersonInScene InScene(const Track& track, KeypointSequence* keypoints) {
  return {.body = &BuiltinBody(), .track = &track, .keypoints = keypoints};
}

TEST(Occlusion, TheOneBehindKeepsAFifthOfWhatIsHiddenAndTheOneInFrontEverything) {
  // 5 cm to the side and 2 m behind: hips lie behind the other's trunk.
  const Track front = Standing(0, 3, {0, 0.1}), behind = Standing(0.05, 5, {0, 0.1});
  KeypointSequence front_seen = Seen(front), behind_seen = Seen(behind);
  const KeypointSequence before = behind_seen;
  const std::vector<HiddenCounts> counts =
      DownweightOccluded({InScene(front, &front_seen), InScene(behind, &behind_seen)}, 1);
  EXPECT_FALSE(counts[0].any());
  EXPECT_EQ(counts[1].frames, 2);
  EXPECT_TRUE(std::all_of(front_seen.points.begin(), front_seen.points.end(),
                          [](const Keypoint& p) { return p.confidence == 1; }));
  VisibilityBuffer buffer;
  buffer.Render(TrackVertices(BuiltinBody(), front, 0), BuiltinBody().data().faces, front.camera);
  int hidden = 0;
  for (size_t i = 0; i < before.points.size(); ++i) {
    const Keypoint& p = before.points[i];
    const bool covered = buffer.FaceAt(int(std::lround(p.x)), int(std::lround(p.y))) >= 0;
    EXPECT_FLOAT_EQ(behind_seen.points[i].confidence, covered ? 0.2F : 1.0F) << i;
    hidden += covered;
  }
  EXPECT_GE(hidden, 4);  // the hips of both frames at least
  EXPECT_EQ(counts[1].keypoints, hidden);
}

TEST(Occlusion, OtherMomentsPlacesAndPeopleWithoutATrackHideNothing) {
  const Track front = Standing(0, 3, {0, 0.1}), later = Standing(0.05, 5, {0.2, 0.3}), aside = Standing(3, 5, {0, 0.1});
  KeypointSequence a = Seen(front), b = Seen(later), c = Seen(aside);
  const std::vector<PersonInScene> people = {
      InScene(front, &a), InScene(later, &b), InScene(aside, &c), {.body = &BuiltinBody()}};
  for (const HiddenCounts& counts : DownweightOccluded(people, 2)) EXPECT_FALSE(counts.any());
}

TEST(Occlusion, LabelsBehindABodyAreUnknownAndThoseBesideItStay) {
  const Track front = Standing(0, 3, {0}), behind = Standing(0.3, 5, {0});
  PartLabelSequence labels;
  labels.image_width = 640, labels.image_height = 480;
  labels.timestamps = {0};
  VisibilityBuffer own, other;
  const MatrixX3i& faces = BuiltinBody().data().faces;
  own.Render(TrackVertices(BuiltinBody(), behind, 0), faces, behind.camera);
  other.Render(TrackVertices(BuiltinBody(), front, 0), faces, front.camera);
  LabelImage image{own.box().x_begin, own.box().y_begin, own.box().width(), own.box().height(), {}};
  for (const int32_t face : own.faces()) image.labels.push_back(face >= 0);
  labels.frames = {image};
  labels.AsMask();
  const PersonInScene rear{.body = &BuiltinBody(), .track = &behind, .part_labels = &labels};
  const std::vector<HiddenCounts> counts = DownweightOccluded({InScene(front, nullptr), rear}, 1);
  EXPECT_GT(counts[1].pixels, 1000);
  int kept = 0;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      const uint8_t part = labels.PartAt(0, x, y);
      // The margin of 1 % of the person's height, 2 or 3 px, lies around what is hidden.
      bool near = false;
      for (int i = 0; i < 49; ++i) near = near || other.FaceAt(x - 3 + i % 7, y - 3 + i / 7) >= 0;
      if (other.FaceAt(x, y) >= 0) {
        EXPECT_EQ(part, PartLabelSequence::kUnknown) << x << ", " << y;
      } else if (!near) {
        EXPECT_EQ(part, image.At(x, y)) << x << ", " << y;
        kept += part == 1;
      }
    }
  }
  EXPECT_GT(kept, 1000);
}

TEST(Occlusion, IsTheSameForAnyNumberOfThreads) {
  std::vector<double> times;
  times.reserve(9);
  for (int t = 0; t < 9; ++t) times.push_back(0.1 * t);
  const Track front = Standing(0, 3, times), behind = Standing(0.05, 5, times);
  std::vector<float> expected;
  for (const int threads : {1, 2, 5}) {
    KeypointSequence a = Seen(front), b = Seen(behind);
    DownweightOccluded({InScene(front, &a), InScene(behind, &b)}, threads);
    std::vector<float> got;
    for (const Keypoint& p : b.points) got.push_back(p.confidence);
    if (threads == 1) expected = got;
    EXPECT_EQ(got, expected) << threads;
  }
}

}  // namespace
}  // namespace bodyloom::occlusion_test
