// SPDX-License-Identifier: Apache-2.0
/// A person who shows hand poses to a camera, with the truth, and what detectors see of both hands.
///
/// The built-in body with fingers stands in a T-pose with the forearms upright. Points are landmarks of its skinned
/// mesh in pixels, with noise of the standard deviations that HandOf() states (tracking/detection/hand_landmarks.h) and
/// a correlation of 150 ms from frame to frame, and in metres along the viewing ray. The track is as a solve without
/// hands leaves it: fingers at rest, wrists and forearms turned by ten degrees and wrists two centimetres off.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/biomechanics/hand_limits.h"
#include "geometry/biomechanics/hand_prior.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/track.h"
#include "tracking/hands/hand_problem.h"

namespace bodyloom {

struct SyntheticHandsOptions {
  std::string pose = "flat";  ///< SyntheticHandPoses()
  double yaw_deg = 0;         ///< by which the person is turned about the vertical; 0: the palms face the camera
  double size_px = 100;       ///< of a hand in the image, from wrist to the tip of the middle finger
  double noise = 1;           ///< times the standard deviations
  double blurred = 0;         ///< share of frames whose noise and stated σ are three times as large
  int frames = 45;
  int unseen_from = 1 << 30;  ///< frames from here on show no hands
  unsigned seed = 1;
};

struct SyntheticHands {
  Track track;
  HandsAndFaceSequence seen;
  std::array<std::vector<HandAngleVector>, 2> angles;  ///< the truth, by HandsAndFace::Side and frame
};

namespace synthetic_hands_internal {

constexpr double kDegree = M_PI / 180;
/// Of the network's points in metres, right, down and away from the camera (docs/lab/hands.md).
inline const Eigen::Vector3d kNetworkNoiseM(0.006, 0.006, 0.012);

/// Flexions of index, middle, ring and little finger (MCP, PIP, DIP), thumb's CMC flexion and radial angle, MCP and IP.
inline HandAngleVector Pose(const std::array<std::array<double, 3>, 4>& fingers, const std::array<double, 4>& thumb,
                            double spread_deg) {
  HandAngleVector angles = HandAngleVector::Zero();
  constexpr std::array<int, 4> kFinger = {0, 1, 3, 2};  // of SMPL-H
  constexpr std::array<double, 4> kOutwards = {1, 0.1, -0.6, -1.2};
  for (size_t f = 0; f < 4; ++f) {
    for (int k = 0; k < 3; ++k) angles[9 * kFinger[f] + 3 * k] = kDegree * fingers[f][size_t(k)];
    angles[9 * kFinger[f] + 1] = kDegree * spread_deg * kOutwards[f];
  }
  angles[36] = kDegree * thumb[0], angles[37] = kDegree * thumb[1];
  angles[39] = kDegree * thumb[2], angles[42] = kDegree * thumb[3];
  return angles;
}

}  // namespace synthetic_hands_internal

/// Key poses by name, which are taken one after another.
inline const std::map<std::string, std::vector<HandAngleVector>>& SyntheticHandPoses() {
  using synthetic_hands_internal::Pose;
  using Finger = std::array<double, 3>;
  constexpr Finger kOut = {3, 6, 4}, kIn = {78, 95, 55};
  constexpr std::array<double, 4> kThumbOut = {-5, 25, 5, 5}, kThumbIn = {25, 15, 45, 40};
  const auto counted = [&](int n) {  // of thumb, index, …
    return Pose({n > 1 ? kOut : kIn, n > 2 ? kOut : kIn, n > 3 ? kOut : kIn, n > 4 ? kOut : kIn},
                n > 0 ? kThumbOut : kThumbIn, n > 1 ? 6 : 0);
  };
  static const std::map<std::string, std::vector<HandAngleVector>> poses = {
      {"flat", {Pose({kOut, kOut, kOut, kOut}, kThumbOut, 10)}},
      {"fist", {Pose({kIn, kIn, kIn, kIn}, kThumbIn, 0)}},
      {"pointing", {Pose({kOut, kIn, kIn, kIn}, kThumbIn, 0)}},
      {"pinch",
       {Pose({Finger{40, 55, 30}, Finger{25, 35, 20}, Finger{20, 30, 18}, Finger{18, 28, 15}}, {20, 45, 20, 25}, 3)}},
      {"counting", {counted(1), counted(2), counted(3), counted(4), counted(5)}},
  };
  return poses;
}

/// 1.5 s for a pose that is taken once, 0.6 s for each of several.
inline int FramesOf(const std::string& pose) {
  return std::max(45, 18 * static_cast<int>(SyntheticHandPoses().at(pose).size()));
}

inline SyntheticHands MakeSyntheticHands(const SyntheticHandsOptions& options) {
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  using synthetic_hands_internal::kDegree;
  using synthetic_hands_internal::kNetworkNoiseM;
  constexpr double kFps = 30, kDistanceM = 3, kErrorsLast_s = 0.15;
  const BodyModel& body = BuiltinBodyWithHands();
  const std::array<HandSkeleton, 2> hand = {FindHand(body, HandSide::kLeft).value(),
                                            FindHand(body, HandSide::kRight).value()};
  const std::vector<HandAngleVector>& keys = SyntheticHandPoses().at(options.pose);
  std::mt19937 random(options.seed);
  std::normal_distribution<double> normal;
  const auto draw3 = [&](double sigma) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vector3d(sigma * Vector3d(x, y, z));
  };

  // Upright, facing the camera, which looks along z with y down.
  BodyPose still;
  still.rotations.assign(size_t(body.num_joints()), Matrix3d::Identity());
  const Matrix3d facing = Eigen::AngleAxisd(M_PI, Vector3d::UnitX()).toRotationMatrix();
  still.rotations[0] = facing * Eigen::AngleAxisd(options.yaw_deg * kDegree, Vector3d::UnitY()).toRotationMatrix();
  for (size_t side = 0; side < 2; ++side) {
    const int elbow = body.parents()[size_t(hand[side].wrist)];
    still.rotations[size_t(elbow)] =
        Eigen::AngleAxisd((side == 0 ? 1 : -1) * M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();
  }
  const MatrixX3d rest = body.RestJoints({});
  const MatrixX3d tip_and_wrist = (MatrixX3d(2, 3) << PoseLandmarks(body, {}, still, {"left_middle_tip"}),
                                   PoseSkeleton(body, rest, still).joints.row(hand[0].wrist))
                                      .finished();
  still.trans = Vector3d(0, 0.4, kDistanceM);
  SyntheticHands made;
  Track& track = made.track;
  const double focal = options.size_px * kDistanceM / (tip_and_wrist.row(1) - tip_and_wrist.row(0)).norm();
  track.camera = MakePinhole(4000, 4000, focal);
  track.motion.body = body.name();
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses.resize(options.frames, 3 * body.num_joints());
  track.motion.trans.resize(options.frames, 3);
  track.motion.betas = Eigen::VectorXd::Zero(body.num_betas());
  track.joint_sigma.setConstant(options.frames, body.num_joints(), 0.02);
  made.seen.image_width = made.seen.image_height = 4000;

  std::array<Vector3d, 2> wrist_off, wrist_turn;
  std::array<double, 2> twist{};
  for (size_t side = 0; side < 2; ++side) {
    wrist_off[side] = draw3(0.02 / std::sqrt(3.0));
    wrist_turn[side] = draw3(10 * kDegree / std::sqrt(3.0));
    twist[side] = 10 * kDegree * normal(random);
  }
  std::array<std::array<Vector3d, kHandPoints>, 2> pixel_noise, metre_noise;
  for (auto* all : {&pixel_noise, &metre_noise}) {
    for (auto& one : *all) {
      for (Vector3d& noise : one) noise = draw3(1);
    }
  }
  const double alike = std::exp(-1 / (kFps * kErrorsLast_s));
  std::uniform_real_distribution<double> uniform;
  for (int t = 0; t < options.frames; ++t) {
    // From rest to each key in turn, half of the time on the way.
    const double at = double(t) / options.frames * double(keys.size());
    const auto key = std::min(size_t(at), keys.size() - 1);
    const double u = std::min(1.0, 2 * (at - double(key))), way = u * u * (3 - 2 * u);
    const HandAngleVector from = key == 0 ? BuiltinHandPrior().mean : keys[key - 1];
    const HandAngleVector angles = from + way * (keys[key] - from);
    const double blur = uniform(random) < options.blurred ? 3 : 1;
    BodyPose truth = still, solved = still;
    auto frame = std::make_shared<HandsAndFace>();
    for (size_t side = 0; side < 2; ++side) {
      made.angles[side].push_back(angles);
      for (int j = 0; j < kHandJoints; ++j) {
        truth.rotations[size_t(hand[side].joint[size_t(j)])] = HandRotation(hand[side], j, angles.segment<3>(3 * j));
      }
      const auto wrist = size_t(hand[side].wrist), elbow = size_t(body.parents()[wrist]);
      const Vector3d along = (rest.row(Eigen::Index(wrist)) - rest.row(Eigen::Index(elbow))).transpose().normalized();
      solved.rotations[wrist] = still.rotations[wrist] * RotationFromAxisAngle(wrist_turn[side]);
      solved.rotations[elbow] = still.rotations[elbow] * RotationFromAxisAngle(twist[side] * along);
    }
    const PosedSkeleton skeleton = PoseSkeleton(body, rest, truth);
    for (size_t side = 0; side < 2; ++side) {
      const auto& names = HandLandmarkNames(hand[side].side);
      MatrixX3d places(kHandPoints, 3);
      places << skeleton.joints.row(hand[side].wrist),
          PoseLandmarks(body, {}, truth, std::vector<std::string>(names.begin() + 1, names.end()));
      const Vector3d wrist = places.row(0);
      const Matrix3d ray = RotationBetweenDirections(Vector3d::UnitZ(), wrist);
      const double length_px = focal / wrist.z() * (places.row(9) - places.row(0)).norm();
      HandObservation seen;
      for (int k = 0; k < kHandPoints; ++k) {
        constexpr std::array<double, 4> kOfLevel = {0.06, 0.08, 0.10, 0.13};
        const double c = k == 0 ? kOfLevel[0] : kOfLevel[size_t(k - 1) % 4];
        const double sigma = blur * std::hypot(length_px * std::hypot(c, 0.8 * 0.05), 0.8);
        Vector3d& in_pixels = pixel_noise[side][size_t(k)];
        Vector3d& in_metres = metre_noise[side][size_t(k)];
        in_pixels = alike * in_pixels + std::sqrt(1 - alike * alike) * draw3(1);
        in_metres = alike * in_metres + std::sqrt(1 - alike * alike) * draw3(1);
        // The body's solve has the wrist wrist_off away: the truth moves instead.
        const Vector3d place = places.row(k).transpose() + wrist_off[side];
        Eigen::Vector2d pixel;
        track.camera.Project(place, &pixel);
        pixel += options.noise * sigma * in_pixels.head<2>();
        seen.points[size_t(k)] = {float(pixel.x()), float(pixel.y()), 0.9F};
        seen.sigma_px[size_t(k)] = float(sigma);
        const Vector3d noise_m = options.noise * kNetworkNoiseM.cwiseProduct(in_metres);
        seen.metres[size_t(k)] =
            (ray.transpose() * (places.row(k) - places.row(9)).transpose() + noise_m).cast<float>();
      }
      if (t < options.unseen_from) frame->hands[side] = seen;
    }
    made.seen.frames.push_back(frame->empty() ? nullptr : frame);
    made.seen.timestamps.push_back(t / kFps);
    track.motion.timestamps.push_back(t / kFps);
    track.motion.poses.row(t) = AxisAngleFromPose(body, solved).transpose();
    track.motion.trans.row(t) = solved.trans.transpose();
    track.frame_status.push_back(FrameStatus::kTracked);
    track.joints.push_back(PoseSkeleton(body, rest, solved).joints);
    track.coco17.push_back(PoseLandmarks(body, {}, solved, CocoNames()));
  }
  return made;
}

/// Errors of the angles that are free, from a frame on; of both hands.
struct FingerErrors {
  std::array<double, 5> mean_deg{};       ///< mean error of the flexions of a finger's joints, by FingerNames()
  double within_one = 0, within_two = 0;  ///< shares of the errors below one and two standard deviations
  double sigma_deg = 0;                   ///< mean standard deviation of a flexion
};

inline FingerErrors FitSyntheticHands(const SyntheticHands& made, const HandFitOptions& options, int from_frame) {
  const BodyModel& body = BuiltinBodyWithHands();
  FingerErrors errors;
  double count = 0;
  std::array<double, 5> of_finger{};
  for (size_t side = 0; side < 2; ++side) {
    const HandSkeleton hand = FindHand(body, side == 0 ? HandSide::kLeft : HandSide::kRight).value();
    HandProblem problem(body, hand, made.track, made.seen, {}, options);
    problem.Solve(options.max_iterations);
    const HandProblem::Sigma sigma = problem.FindSigma();
    for (int t = from_frame; t < made.track.num_frames(); ++t) {
      const HandAngleVector found =
          problem.kinematics().Angles(Eigen::Map<const FingerCoordinates>(problem.fingers(t)));
      for (int i = 0; i < kFingerCoordinates; ++i) {
        const int angle = FreeHandAngles()[size_t(i)], finger = angle / 9;
        const double error = std::abs(found[angle] - made.angles[side][size_t(t)][angle]);
        errors.within_one += error < sigma.angles(t, i) ? 1 : 0;
        errors.within_two += error < 2 * sigma.angles(t, i) ? 1 : 0;
        count += 1;
        if (angle % 3 != 0) continue;
        errors.mean_deg[size_t(finger)] += error / synthetic_hands_internal::kDegree;
        errors.sigma_deg += sigma.angles(t, i) / synthetic_hands_internal::kDegree;
        of_finger[size_t(finger)] += 1;
      }
    }
  }
  errors.within_one /= count, errors.within_two /= count;
  double flexions = 0;
  for (size_t f = 0; f < 5; ++f) errors.mean_deg[f] /= of_finger[f], flexions += of_finger[f];
  errors.sigma_deg /= flexions;
  return errors;
}

}  // namespace bodyloom
