// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/clips/demo_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "data_tools/synthesis/clips/smooth_curve.h"
#include "data_tools/synthesis/pose_joints.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Matrix3d TurnX(double degrees) { return RotationFromAxisAngle(Vector3d(degrees * kDegree, 0, 0)); }
Matrix3d TurnY(double degrees) { return RotationFromAxisAngle(Vector3d(0, degrees * kDegree, 0)); }
Matrix3d TurnZ(double degrees) { return RotationFromAxisAngle(Vector3d(0, 0, degrees * kDegree)); }

/// Lengths below are for a person with legs of this length (hip to ankle), and scale with the body's.
constexpr double kReferenceLeg_m = 0.80;

// ---- Path of the walk. Heading: degrees about y, 0 = towards +z, positive towards +x.

double HeadingAt(double path_m) { return 68 - 74 * SmoothStep((path_m - 0.95) / 1.15); }

/// Point (x, z) of the path at a length along it; the end of the walk is the origin.
Vector2d PathPoint(double path_m) {
  constexpr double kEnd_m = 2.22, kStep_m = 0.01;
  Vector2d point = Vector2d::Zero();
  const double direction = path_m < kEnd_m ? -1 : 1;
  for (double u = kEnd_m; direction * (path_m - u) > 1e-12;) {
    const double step = direction * std::min(kStep_m, std::abs(path_m - u));
    const double heading = HeadingAt(u + 0.5 * step) * kDegree;
    point += step * Vector2d(std::sin(heading), std::cos(heading));
    u += step;
  }
  return point;
}

/// A foot is carried from one place to the next between lifting and landing.
struct Step {
  double lift_s, land_s, path_m;
};

struct FootPlan {
  double side;  ///< +1 left, −1 right
  double start_path_m;
  std::vector<Step> steps;
};

const FootPlan& PlanOf(bool left) {
  static const FootPlan kLeft{+1, 0.0, {{0.93, 1.36, 0.92}, {1.84, 2.26, 1.93}, {2.80, 3.18, 2.22}}};
  static const FootPlan kRight{-1, 0.0, {{0.46, 0.90, 0.40}, {1.39, 1.81, 1.47}, {2.29, 2.74, 2.24}}};
  return left ? kLeft : kRight;
}

/// A foot flat on the floor at `ground`, then turned: heel up about the ball, toes up about the heel, pointed about the
/// ankle; the toes bent back by toes_deg; all of it lifted.
struct FootState {
  Vector2d ground;  ///< (x, z) of the ankle when flat
  double yaw_deg = 0, heel_up_deg = 0, toes_up_deg = 0, pointed_deg = 0, toes_deg = 0, lift_m = 0;
  [[nodiscard]] double PitchDeg() const { return heel_up_deg - toes_up_deg + pointed_deg; }
};

FootState WalkingFoot(const FootPlan& plan, double t) {
  const auto place = [&](double path_m) {
    const double heading = HeadingAt(path_m) * kDegree;
    return Vector2d(PathPoint(path_m) + plan.side * 0.085 * Vector2d(std::cos(heading), -std::sin(heading)));
  };
  double from = plan.start_path_m;
  FootState foot{place(from), HeadingAt(from)};
  for (const Step& step : plan.steps) {
    const double length = step.path_m - from;
    const double stride = std::clamp(length / 1.0, 0.15, 1.0);  // long steps roll over the foot, short ones stay flat
    const double swing = (t - step.lift_s) / (step.land_s - step.lift_s);
    const double carry = SmoothStep(swing);
    foot.ground += carry * (place(step.path_m) - place(from));
    foot.yaw_deg += carry * (HeadingAt(step.path_m) - HeadingAt(from));
    foot.lift_m += (0.035 + 0.055 * stride) * Bump((swing - 0.45) / 0.5);
    const double heel_up = 58 * stride * Bump((t - (step.lift_s + 0.04)) / 0.27);
    const double toes_up = 17 * stride * Bump((t - (step.land_s - 0.01)) / 0.16);
    foot.heel_up_deg += heel_up;
    foot.toes_up_deg += toes_up;
    foot.toes_deg += heel_up * (1 - SmoothStep(swing / 0.35));  // toes stay on the floor until it lifts
    from = step.path_m;
  }
  return foot;
}

/// The kick of the right foot: keyed forward and upward of where the foot stood.
void AddKick(double t, double heading_deg, FootState* foot) {
  static const SmoothCurve kForward({{4.62, 0}, {4.90, -0.24}, {5.20, 0.85}, {5.46, 0.34}, {5.78, 0}}, 0.11);
  static const SmoothCurve kUp({{4.53, 0}, {4.70, 0.13}, {4.90, 0.20}, {5.20, 0.86}, {5.46, 0.36}, {5.78, 0}}, 0.11);
  static const SmoothCurve kPitch({{4.66, 0}, {4.90, 62}, {5.20, -38}, {5.46, 30}, {5.78, 0}});
  const double heading = heading_deg * kDegree;
  foot->ground += kForward(t) * Vector2d(std::sin(heading), std::cos(heading));
  foot->lift_m += std::max(0.0, kUp(t));
  foot->pointed_deg += kPitch(t);
}

// ---- The body above the feet.

struct Torso {
  Vector2d ground;                                 ///< (x, z) of the pelvis
  double drop_m = 0;                               ///< below standing height
  double yaw_deg = 0, lean_deg = 0, tilt_deg = 0;  ///< of the pelvis; lean forward positive
  double walks = 0;                                ///< 1 while walking, 0 while standing
};

/// +1 while the left foot carries the body, −1 while the right one does, 0 between.
double SupportAt(double t) {
  double support = 0;
  for (const bool left : {true, false}) {
    for (const Step& step : PlanOf(left).steps) {
      const double middle = 0.5 * (step.lift_s + step.land_s), half = 0.62 * (step.land_s - step.lift_s);
      support += (left ? -1 : 1) * Bump((t - middle) / half);
    }
  }
  return support + Bump((t - 5.18) / 0.72);
}

Torso TorsoAt(double t) {
  static const SmoothCurve kPath({{0.0, 0.0},
                                  {0.30, 0.0},
                                  {0.68, 0.12},
                                  {0.92, 0.36},
                                  {1.38, 0.90},
                                  {1.83, 1.47},
                                  {2.28, 1.95},
                                  {2.75, 2.17},
                                  {3.15, 2.225},
                                  {3.4, 2.225}});
  static const SmoothCurve kLean(
      {{0.2, 1}, {0.7, 5}, {2.2, 5}, {2.9, 1}, {4.55, 1}, {4.9, 6}, {5.2, -13}, {5.5, -3}, {5.9, 1}});
  static const SmoothCurve kWalks({{0.3, 0}, {0.8, 1}, {2.3, 1}, {2.9, 0}});
  const double path = kPath(t), heading = HeadingAt(path) * kDegree, support = SupportAt(t);
  const double kick = Bump((t - 5.18) / 0.72), walks = kWalks(t);
  Torso torso;
  const Vector2d to_left(std::cos(heading), -std::sin(heading));
  torso.ground = PathPoint(path) + (0.028 + 0.042 * kick) * support * to_left;
  torso.drop_m = 0.002 + 0.010 * walks + 0.022 * walks * (1 - support * support) + 0.012 * kick;
  torso.lean_deg = kLean(t);
  // The hip of the swinging leg comes forward with it.
  torso.yaw_deg = HeadingAt(path) + 5 * walks * std::sin(M_PI * (t - 0.68) / 0.455) + 10 * Bump((t - 5.25) / 0.4);
  torso.tilt_deg = 2.5 * support;
  torso.walks = walks;
  return torso;
}

/// World rotation of a bone whose rest direction is `rest` and whose hinge is along x at rest: takes rest to `posed`
/// and x as near as possible to `hinge`.
Matrix3d AimBone(const Vector3d& rest, const Vector3d& posed, const Vector3d& hinge) {
  const auto frame = [](const Vector3d& bone, const Vector3d& axis) {
    Matrix3d F;
    F.col(1) = bone.normalized();
    F.col(0) = (axis - axis.dot(F.col(1)) * F.col(1)).normalized();
    F.col(2) = F.col(0).cross(F.col(1));
    return F;
  };
  return frame(posed, hinge) * frame(rest, Vector3d::UnitX()).transpose();
}

class Choreography {
 public:
  explicit Choreography(const BodyModel& body) : rest_(body.RestJoints(Eigen::VectorXd())) {
    floor_ = body.data().v_template.col(1).minCoeff();
    scale_ = (Bone(kLeftHip, kLeftKnee).norm() + Bone(kLeftKnee, kLeftAnkle).norm()) / kReferenceLeg_m;
  }

  /// Joint rotations and translation of the instant t in [0, kDemoMotionSeconds].
  BodyPose At(double t, int num_joints) const {
    BodyPose pose;
    pose.rotations.assign(num_joints, Matrix3d::Identity());
    const Torso torso = TorsoAt(t);
    FootState feet[2] = {WalkingFoot(PlanOf(true), t), WalkingFoot(PlanOf(false), t)};
    AddKick(t, HeadingAt(2.22), &feet[1]);

    const Matrix3d pelvis = TurnY(torso.yaw_deg) * TurnX(torso.lean_deg) * TurnZ(torso.tilt_deg);
    Vector3d position(scale_ * torso.ground.x(), StandingHeight() - scale_ * torso.drop_m, scale_ * torso.ground.y());
    Vector3d ankles[2];
    Matrix3d soles[2];
    for (int side = 0; side < 2; ++side) PlaceFoot(feet[side], side, &ankles[side], &soles[side]);
    position.y() -= ExcessReach(position, pelvis, ankles, torso.walks);
    pose.trans = position - rest_.row(kPelvis).transpose();
    pose.rotations[kPelvis] = pelvis;
    for (int side = 0; side < 2; ++side) {
      BendLeg(side, position, pelvis, ankles[side], soles[side], feet[side], &pose);
    }
    MoveUpperBody(t, torso, &pose);
    return pose;
  }

 private:
  [[nodiscard]] Vector3d Rest(int joint) const { return rest_.row(joint).transpose(); }
  [[nodiscard]] Vector3d Bone(int from, int to) const { return Rest(to) - Rest(from); }
  [[nodiscard]] double StandingHeight() const { return Rest(kPelvis).y() - floor_; }

  void PlaceFoot(const FootState& foot, int side, Vector3d* ankle, Matrix3d* sole) const {
    const Vector3d rest_ankle = Rest(kLeftAnkle + side) - Vector3d(0, floor_, 0);
    // Pivots relative to the ankle: the ball of the foot, and the heel behind it.
    const Vector3d to_ball = Vector3d(0, -rest_ankle.y(), Bone(kLeftAnkle + side, kLeftFoot + side).z());
    const Vector3d to_heel = Vector3d(0, -rest_ankle.y(), -0.45 * to_ball.z());
    const Vector3d by_heel = to_ball - TurnX(foot.heel_up_deg) * to_ball;
    const Vector3d by_toes = to_heel - TurnX(-foot.toes_up_deg) * to_heel;
    // Toes that are bent back less than the heel is raised would penetrate the floor.
    const double dig = 0.6 * to_ball.z() * std::sin(std::max(0.0, foot.heel_up_deg - foot.toes_deg) * kDegree);
    *sole = TurnY(foot.yaw_deg) * TurnX(foot.PitchDeg());
    const Vector3d flat(scale_ * foot.ground.x(), rest_ankle.y() + scale_ * foot.lift_m + dig,
                        scale_ * foot.ground.y());
    *ankle = flat + TurnY(foot.yaw_deg) * (by_heel + by_toes);
  }

  /// Distance by which the pelvis must be lowered so that both ankles are within reach of nearly straight legs. Moving
  /// legs are kept further from straight, where the knee's angle changes infinitely fast with the distance.
  double ExcessReach(const Vector3d& position, const Matrix3d& pelvis, const Vector3d (&ankles)[2],
                     double walks) const {
    double excess = 0;
    for (int side = 0; side < 2; ++side) {
      const Vector3d hip = position + pelvis * Bone(kPelvis, kLeftHip + side);
      const double reach =
          0.992 * (Bone(kLeftHip + side, kLeftKnee + side).norm() + Bone(kLeftKnee + side, kLeftAnkle + side).norm());
      const Vector3d away = ankles[side] - hip;
      const double level = std::min(std::hypot(away.x(), away.z()), 0.9 * reach);
      const double height = std::sqrt(reach * reach - level * level);
      const double soft = (0.003 + 0.011 * walks) * scale_, over = (-away.y() - height) / soft;
      excess += soft * (over > 30 ? over : std::log1p(std::exp(over)));  // soft maximum with 0
    }
    return excess;
  }

  void BendLeg(int side, const Vector3d& position, const Matrix3d& pelvis, const Vector3d& ankle, const Matrix3d& sole,
               const FootState& foot, BodyPose* pose) const {
    const Vector3d thigh = Bone(kLeftHip + side, kLeftKnee + side), shin = Bone(kLeftKnee + side, kLeftAnkle + side);
    const double a = thigh.norm(), b = shin.norm();
    const Vector3d hip = position + pelvis * Bone(kPelvis, kLeftHip + side);
    Vector3d reach = ankle - hip;
    const double distance = std::clamp(reach.norm(), 0.35 * (a + b), 0.9995 * (a + b));
    reach = distance * reach.normalized();
    // The knee bends in the plane across the leg's hinge, which points to the left of both pelvis and foot.
    Vector3d hinge = (pelvis * Vector3d::UnitX() + TurnY(foot.yaw_deg) * Vector3d::UnitX());
    const Vector3d d = reach.normalized();
    hinge = (hinge - hinge.dot(d) * d).normalized();
    const double along = (a * a - b * b + distance * distance) / (2 * distance);
    const Vector3d knee = along * d + std::sqrt(std::max(0.0, a * a - along * along)) * d.cross(hinge);
    const Matrix3d upper = AimBone(thigh, knee, hinge), lower = AimBone(shin, reach - knee, hinge);
    pose->rotations[kLeftHip + side] = pelvis.transpose() * upper;
    pose->rotations[kLeftKnee + side] = upper.transpose() * lower;
    pose->rotations[kLeftAnkle + side] = lower.transpose() * sole;
    pose->rotations[kLeftFoot + side] = TurnX(-foot.toes_deg);
  }

  static void MoveUpperBody(double t, const Torso& torso, BodyPose* pose) {
    static const SmoothCurve kWave({{2.95, 0}, {3.45, 1}, {4.45, 1}, {4.95, 0}});
    static const SmoothCurve kKick({{4.6, 0}, {4.92, -0.45}, {5.2, 1}, {5.5, 0.35}, {5.9, 0}});
    static const SmoothCurve kEffort({{4.6, 0}, {4.92, 0.45}, {5.2, 1}, {5.5, 0.35}, {5.9, 0}});
    const double walks = torso.walks, wave = kWave(t), kick = kKick(t), effort = kEffort(t),
                 breath = std::sin(2 * M_PI * t / 3.1);
    const double gait = walks * std::sin(M_PI * (t - 0.68) / 0.455);  // +1: right leg in front

    // Shoulders turn against the pelvis, the trunk stays upright over it.
    const double twist = -3.2 * gait - 5 * kick, upright = -0.30 * torso.lean_deg;
    for (const int joint : {kSpine1, kSpine2, kSpine3}) {
      pose->rotations[joint] =
          TurnY(twist) * TurnX(upright + 0.5 * breath + 1.0) * TurnZ(-0.75 * torso.tilt_deg - 1.2 * wave);
    }
    // The head turns towards the viewer, who stands at heading 0.
    const double look =
        std::clamp(-torso.yaw_deg - 3 * twist, -62.0, 62.0) * (0.35 + 0.65 * SmoothStep((t - 0.4) / 1.2));
    pose->rotations[kNeck] = TurnY(0.42 * look) * TurnX(3);
    pose->rotations[kHead] = TurnY(0.42 * look) * TurnX(-1 + 1.5 * breath) * TurnZ(5 * wave);

    for (const bool left : {true, false}) {
      const double s = left ? 1 : -1;
      const double swing = (left ? 1 : -1) * -20 * gait;             // about x: negative brings the arm forward
      const double forward = std::sqrt(swing * swing + 25) - swing;  // smooth
      Matrix3d shoulder = TurnX(swing + (left ? -34 : 30) * kick) * TurnZ(s * (-74 + 2 * breath + 22 * effort));
      shoulder = shoulder * TurnX(-12);  // thumbs a little forward
      Matrix3d elbow = TurnY(-s * (12 + 0.4 * forward + (left ? 38 : 26) * effort));
      Matrix3d wrist = TurnZ(-s * 4);
      double collar = 0;
      if (!left) {
        const double sway =
            std::sin(2 * M_PI * (t - 3.42) / 0.52) * SmoothStep((t - 3.3) / 0.3) * SmoothStep((4.62 - t) / 0.3);
        const Matrix3d raised = TurnY(24) * TurnZ(-16 + 4 * sway) * TurnX(-84);
        shoulder = InterpolateRotation(shoulder, raised, wave);
        elbow = InterpolateRotation(elbow, TurnY(78 - 20 * sway), wave);
        wrist = InterpolateRotation(wrist, TurnY(-13 * sway), wave);
        collar = wave;
      }
      pose->rotations[kLeftCollar + (left ? 0 : 1)] = TurnZ(s * (-3 + 15 * collar));
      pose->rotations[kLeftShoulder + (left ? 0 : 1)] = shoulder;
      pose->rotations[kLeftElbow + (left ? 0 : 1)] = elbow;
      pose->rotations[kLeftWrist + (left ? 0 : 1)] = wrist;
    }
  }

  MatrixX3d rest_;
  double floor_, scale_;
};

/// Plays the motion forwards and backwards in turn.
double PieceTime(double t) {
  const double cycle = std::fmod(t, 2 * kDemoMotionSeconds);
  return cycle <= kDemoMotionSeconds ? cycle : 2 * kDemoMotionSeconds - cycle;
}

}  // namespace

Motion DemoMotion(const BodyModel& body, int num_frames, double fps) {
  BODYLOOM_CHECK(num_frames >= 1, "demo motion: ", num_frames, " frames, expected at least 1");
  BODYLOOM_CHECK(fps > 0 && std::isfinite(fps), "demo motion: ", fps, " frames a second, expected more than 0");
  const int J = body.num_joints();
  BODYLOOM_CHECK(J >= 22 && std::equal(SmplParents().begin(), SmplParents().begin() + 22, body.parents().begin()),
                 "demo motion: the body '", body.name(), "' does not have SMPL's joint tree");
  const Choreography choreography(body);
  Motion motion;
  motion.body = body.name();
  motion.poses = RowMatrixXd::Zero(num_frames, 3 * J);
  motion.trans.resize(num_frames, 3);
  motion.up = Motion::Up::kY;
  for (int i = 0; i < num_frames; ++i) {
    const BodyPose pose = choreography.At(PieceTime(i / fps), J);
    motion.poses.row(i) = AxisAngleFromPose(body, pose).transpose();
    motion.trans.row(i) = pose.trans.transpose();
    motion.timestamps.push_back(i / fps);
  }
  return motion;
}

}  // namespace bodyloom
