// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/turn_head.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <random>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/procrustes.h"
#include "geometry/math/rotation.h"

namespace bodyloom::turn_head_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

/// Yaw to the person's left, pitch down, roll to the left shoulder, of a head at rest.
Matrix3d HeadTurned(double yaw_deg, double pitch_deg, double roll_deg) {
  return (Eigen::AngleAxisd(yaw_deg * kDegree, Vector3d::UnitY()) *
          Eigen::AngleAxisd(pitch_deg * kDegree, Vector3d::UnitX()) *
          Eigen::AngleAxisd(roll_deg * kDegree, Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// Vertices of the built-in body's face nearest to the mean face when nose, eyes and chin are laid onto its own.
std::vector<int> FaceVertices(const BodyModel& body) {
  BodyPose rest;
  rest.rotations.assign(body.num_joints(), Matrix3d::Identity());
  const MatrixX3d& vertices = body.data().v_template;
  const MatrixX3d nose_and_eyes = PoseLandmarks(body, {}, rest, {"nose", "left_eye", "right_eye"});
  Eigen::Index chin = -1;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {  // of the middle of the head, farthest forward and down
    const bool of_middle = std::abs(vertices(v, 0)) < 0.006 && vertices(v, 1) > nose_and_eyes(0, 1) - 0.1;
    if (!of_middle) continue;
    if (chin < 0 || vertices(v, 2) - vertices(v, 1) > vertices(chin, 2) - vertices(chin, 1)) chin = v;
  }
  MatrixX3d own(4, 3), four(4, 3);
  own << nose_and_eyes, vertices.row(chin);
  four << MeanFace().row(30), MeanFace().middleRows(42, 6).colwise().mean(),
      MeanFace().middleRows(36, 6).colwise().mean(), MeanFace().row(8);
  const MatrixX3d laid = AlignPoints(four, own).target_from_source.Apply(MeanFace());
  std::vector<int> nearest_vertices;
  for (int k = 0; k < kFacePoints; ++k) {
    Eigen::Index nearest = 0;
    (vertices.rowwise() - laid.row(k)).rowwise().squaredNorm().minCoeff(&nearest);
    nearest_vertices.push_back(static_cast<int>(nearest));
  }
  return nearest_vertices;
}

struct SyntheticHead {
  Track track;  ///< by the body: the head looks straight on
  HandsAndFaceSequence seen;
};

/// The built-in body faces the camera and turns its head alone.
SyntheticHead MakeSyntheticHead(const Matrix3d& head_turn, double noise_px, int frames = 20) {
  const BodyModel& body = BuiltinBody();
  const int head = body.FindJoint("head");
  static const std::vector<int> vertices = FaceVertices(body);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  SyntheticHead made;
  Track& track = made.track;
  track.camera = MakePinhole(1000, 1000, 1200);
  track.motion.poses.resize(frames, 3 * body.num_joints());
  track.motion.trans.resize(frames, 3);
  track.motion.betas = Eigen::VectorXd::Zero(body.num_betas());
  for (int t = 0; t < frames; ++t) {
    BodyPose pose;
    pose.rotations.assign(body.num_joints(), Matrix3d::Identity());
    pose.rotations[0] = RotationFromAxisAngle({M_PI, 0, 0});
    pose.trans = {0.5, 0.7, 2.5};
    track.motion.poses.row(t) = AxisAngleFromPose(body, pose).transpose();
    track.motion.trans.row(t) = pose.trans.transpose();
    track.motion.timestamps.push_back(t / 30.0);
    track.frame_status.push_back(FrameStatus::kTracked);
    track.joints.push_back(PoseSkeleton(body, body.RestJoints({}), pose).joints);
    track.coco17.push_back(PoseLandmarks(body, {}, pose, CocoNames()));
    pose.rotations[head] = head_turn;
    const MatrixX3d face = PoseVertices(body, {}, pose, vertices);
    const Vector3d middle = face.colwise().mean();
    const Matrix3d along_ray = RotationBetweenDirections(middle, Vector3d::UnitZ());
    FaceObservation seen;
    for (int k = 0; k < kFacePoints; ++k) {
      // Pixels of the picture; depth along the ray, in its scale.
      Eigen::Vector2d pixel;
      track.camera.Project(face.row(k), &pixel);
      const double depth = (along_ray * (face.row(k).transpose() - middle)).z() * 1200 / middle.z();
      const double dx = normal(random), dy = normal(random), dz = normal(random);
      seen.points[k] = {float(pixel.x() + noise_px * dx), float(pixel.y() + noise_px * dy), 0.9F};
      seen.depth_px[k] = float(depth + 2 * noise_px * dz);
    }
    auto parts = std::make_shared<HandsAndFace>();
    parts->face = seen;
    made.seen.frames.push_back(parts);
    made.seen.timestamps.push_back(t / 30.0);
  }
  return made;
}

Matrix3d HeadOf(const Track& track, int t) {
  const int head = BuiltinBody().FindJoint("head");
  return RotationFromAxisAngle(track.motion.poses.row(t).segment<3>(3 * head));
}

TEST(TurnHead, MeanFaceIsSymmetricAndUpright) {
  const MatrixX3d& face = MeanFace();
  EXPECT_NEAR(std::sqrt(face.rowwise().squaredNorm().mean()), 1, 2e-3);
  EXPECT_LT(face.colwise().mean().norm(), 2e-3);
  for (const auto& [left, right] : {std::pair{16, 0}, {45, 36}, {26, 17}, {54, 48}, {35, 31}}) {
    EXPECT_LT((face.row(left) - face.row(right).cwiseProduct(Eigen::RowVector3d(-1, 1, 1))).norm(), 2e-3);
    EXPECT_GT(face(left, 0), 0) << "left is the person's";
  }
  EXPECT_GT(face(8, 1), face(30, 1)) << "the chin is below the nose";
  EXPECT_LT(face(30, 2), face(27, 2)) << "whose tip is nearer than its bridge";
}

TEST(TurnHead, LaysTheFaceOnTheHead) {
  for (const BodyModel* body : {&BuiltinBody(), &BuiltinBodyWithHands()}) {
    const auto turn = FaceFromHead(*body, {});
    ASSERT_TRUE(turn);
    const Matrix3d upright = Eigen::Vector3d(1, -1, -1).asDiagonal();
    EXPECT_LT(RotationAngleBetween(*turn, upright), 12 * kDegree);
    EXPECT_LT(std::abs((*turn * Vector3d::UnitX()).y()), 0.01) << "no roll";
    EXPECT_LT(std::abs((*turn * Vector3d::UnitX()).z()), 0.01) << "no yaw";
  }
}

TEST(TurnHead, FindsYawPitchAndRollWithinFiveDegrees) {
  int turns = 0;
  for (const auto& [yaw, pitch, roll] : {std::array{0.0, 0.0, 0.0},
                                         {40, 0, 0},
                                         {-40, 0, 0},
                                         {0, 25, 0},
                                         {0, -25, 0},
                                         {0, 0, 20},
                                         {30, 15, -10},
                                         {-25, -15, 10}}) {
    SyntheticHead made = MakeSyntheticHead(HeadTurned(yaw, pitch, roll), 1);
    const PartFitSummary summary = TurnHead(BuiltinBody(), made.seen, {}, {}, &made.track);
    EXPECT_TRUE(summary.ran) << summary.why;
    EXPECT_EQ(summary.why, "face seen in 20 of 20 frames");
    const Matrix3d found = HeadOf(made.track, 10);
    EXPECT_LT(RotationAngleBetween(found, HeadTurned(yaw, pitch, roll)), 5 * kDegree)
        << yaw << " " << pitch << " " << roll << ": " << AxisAngleFromRotation(found).transpose() / kDegree;
    ++turns;
  }
  EXPECT_EQ(turns, 8);
}

/// The face as other programs write it: without depth and σ.
HandsAndFaceSequence WithoutDepth(HandsAndFaceSequence seen) {
  for (auto& frame : seen.frames) {
    auto flat = std::make_shared<HandsAndFace>(*frame);
    flat->face->depth_px.fill(std::nanf(""));
    flat->face->sigma_px = 0;
    frame = flat;
  }
  return seen;
}

TEST(TurnHead, FindsThemWithoutDepthAndJawWithinTenDegrees) {
  double sum = 0;
  int turns = 0;
  for (const double yaw : {-60.0, -30.0, 0.0, 30.0, 60.0}) {
    for (const double pitch : {-25.0, 0.0, 25.0}) {
      SyntheticHead made = MakeSyntheticHead(HeadTurned(yaw, pitch, 10), 1);
      made.seen = WithoutDepth(std::move(made.seen));
      for (auto& frame : made.seen.frames) {
        auto no_jaw = std::make_shared<HandsAndFace>(*frame);
        for (int k = 0; k < 17; ++k) no_jaw->face->points[k].x += 40;  // it may lie anywhere
        frame = no_jaw;
      }
      EXPECT_EQ(WhyNoHead(BuiltinBody(), &made.seen), "");
      EXPECT_TRUE(TurnHead(BuiltinBody(), made.seen, {}, {}, &made.track).ran);
      const double off = RotationAngleBetween(HeadOf(made.track, 10), HeadTurned(yaw, pitch, 10));
      EXPECT_LT(off, 10 * kDegree) << yaw << " " << pitch << ": " << off / kDegree;
      sum += off / kDegree;
      ++turns;
    }
  }
  EXPECT_EQ(turns, 15);
  EXPECT_LT(sum / turns, 6);
}

TEST(TurnHead, PointsThatAreNoFaceTurnNothing) {
  SyntheticHead made = MakeSyntheticHead(HeadTurned(30, 0, 0), 1, 6);
  made.seen = WithoutDepth(std::move(made.seen));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> anywhere(0, 100);
  for (auto& frame : made.seen.frames) {
    auto scattered = std::make_shared<HandsAndFace>(*frame);
    for (Keypoint& point : scattered->face->points) point.x = anywhere(random), point.y = 300;
    for (Keypoint& point : scattered->face->points) point.y += anywhere(random);
    frame = scattered;
  }
  EXPECT_EQ(WhyNoHead(BuiltinBody(), &made.seen), "too few points of the faces are known, or they lie on no face");
  const Track before = made.track;
  EXPECT_FALSE(TurnHead(BuiltinBody(), made.seen, {}, {}, &made.track).ran);
  EXPECT_EQ(made.track.motion.poses, before.motion.poses);
}

TEST(TurnHead, ChangesTheHeadAlone) {
  SyntheticHead made = MakeSyntheticHead(HeadTurned(30, 10, 0), 1, 6);
  const Track before = made.track;
  TurnHead(BuiltinBody(), made.seen, {}, {}, &made.track);
  const int head = BuiltinBody().FindJoint("head");
  for (int t = 0; t < 6; ++t) {
    for (int j = 0; j < BuiltinBody().num_joints(); ++j) {
      const bool same =
          made.track.motion.poses.row(t).segment<3>(3 * j) == before.motion.poses.row(t).segment<3>(3 * j);
      EXPECT_EQ(same, j != head) << j;
    }
    EXPECT_EQ(made.track.joints[t], before.joints[t]) << "no joint lies beyond it";
    EXPECT_GT((made.track.coco17[t].row(0) - before.coco17[t].row(0)).norm(), 0.02) << "the nose turns with it";
    EXPECT_EQ(made.track.coco17[t].bottomRows(12), before.coco17[t].bottomRows(12));
  }
}

TEST(TurnHead, UnseenFramesReturnToTheBodys) {
  SyntheticHead made = MakeSyntheticHead(HeadTurned(40, 0, 0), 1, 90);
  for (int t = 20; t < 90; ++t) made.seen.frames[t] = nullptr;
  const PartFitSummary summary = TurnHead(BuiltinBody(), made.seen, {}, {}, &made.track);
  EXPECT_EQ(summary.frames_seen, 20);
  EXPECT_GT(RotationAngleBetween(HeadOf(made.track, 10), Matrix3d::Identity()), 35 * kDegree);
  EXPECT_LT(RotationAngleBetween(HeadOf(made.track, 89), Matrix3d::Identity()), 2 * kDegree);
}

TEST(TurnHead, SaysWhyNot) {
  SyntheticHead made = MakeSyntheticHead(Matrix3d::Identity(), 0, 2);
  EXPECT_EQ(WhyNoHead(BuiltinBody(), &made.seen), "");
  EXPECT_EQ(WhyNoHead(BuiltinBody(), nullptr), "no faces in the input");
  HandsAndFaceSequence unsure = WithoutDepth(made.seen);
  for (auto& frame : unsure.frames) {
    auto few = std::make_shared<HandsAndFace>(*frame);
    for (size_t k = 40; k < few->face->points.size(); ++k) few->face->points[k].confidence = 0.1F;
    frame = few;
  }
  EXPECT_EQ(WhyNoHead(BuiltinBody(), &unsure), "too few points of the faces are known, or they lie on no face");
  for (auto& frame : made.seen.frames) frame = nullptr;
  EXPECT_EQ(WhyNoHead(BuiltinBody(), &made.seen), "no face is seen");
  const Track before = made.track;
  EXPECT_FALSE(TurnHead(BuiltinBody(), made.seen, {}, {}, &made.track).ran);
  EXPECT_EQ(made.track.motion.poses, before.motion.poses);
}

TEST(TurnHead, DerivativesMatchDifferences) {
  const HeadTurnCost cost(HeadTurned(20, -10, 5), HeadTurned(-15, 30, 0), 0.08);
  const ceres::GradientChecker checker(&cost, static_cast<std::vector<const ceres::Manifold*>*>(nullptr), {});
  for (const Vector3d& h : {Vector3d(0.3, -0.4, 0.2), Vector3d(0, 0, 0), Vector3d(1, 1, -0.5)}) {
    ceres::GradientChecker::ProbeResults probe;
    const double* block = h.data();
    EXPECT_TRUE(checker.Probe(&block, 1e-6, &probe)) << probe.error_log;
  }
}

}  // namespace
}  // namespace bodyloom::turn_head_test
