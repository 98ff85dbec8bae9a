// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/lifter/pose_augmentation.h"

#include <algorithm>
#include <cmath>

#include "data_tools/motion/motion_tools.h"
#include "data_tools/synthesis/lifter/fast_random.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "tracking/terms/joint_limits.h"

namespace bodyloom {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr double kFloorShare = 0.1;  // share of the frames in which the body reaches below its floor

// Feet of retargeted motion hover by a few centimetres; such clearances become zero, slightly larger ones are reduced.
constexpr float kHover = 0.02F, kSurelyOff = 0.08F;

struct Instant {
  int before, after;
  float part;
};

/// Reflects `time_s` into the clip.
Instant At(const LifterClip& clip, double time_s) {
  const double period = 2 * clip.duration_s;
  double t = std::fmod(time_s, period);
  if (t < 0) t += period;
  if (t > clip.duration_s) t = period - t;
  const double at = t * clip.rate;
  const int before = std::clamp(static_cast<int>(at), 0, clip.poses.num_frames - 2);
  return {before, before + 1, static_cast<float>(std::clamp(at - before, 0.0, 1.0))};
}

Vector3f AboutX(float angle) { return {angle, 0, 0}; }
Vector3f AboutZ(float angle) { return {0, 0, angle}; }

float Draw(HashRandom* random, double low, double high) { return static_cast<float>(random->Uniform(low, high)); }

/// A leg flexed by `hip` and out by `out` in the pelvis' frame, its knee by `knee`, the foot turned back towards the
/// floor by as much of it as `level_foot` says.
void FlexLeg(int side, float hip, float out, float knee, float level_foot, int t, PoseSequence* poses) {
  Quaternionf& q = poses->at(t, kLeftHip + side);
  q = TurnBy(AboutZ(side == 0 ? out : -out)) * TurnBy(AboutX(-hip)) * q;
  Quaternionf& k = poses->at(t, kLeftKnee + side);
  k = k * TurnBy(AboutX(knee));
  Quaternionf& a = poses->at(t, kLeftAnkle + side);
  a = a * TurnBy(AboutX(level_foot * std::clamp(hip - knee, -0.7F, 0.7F)));
}

/// A squat, with the trunk forward for balance, or a lunge.
void Squat(const LifterWindowOptions& options, HashRandom* random, PoseSequence* poses) {
  const bool lunge = random->Uniform() < options.lunge_share;
  float hip[2], knee[2], out[2];
  hip[0] = Draw(random, 0.2, 1.9);
  knee[0] = std::min(2.5F, hip[0] * Draw(random, 0.5, 1.8));
  out[0] = out[1] = Draw(random, -0.1, 0.6);
  hip[1] = hip[0];
  knee[1] = knee[0];
  if (lunge) {
    hip[1] = Draw(random, -0.5, 0.6);
    knee[1] = Draw(random, 0.2, 1.6);
  }
  const int first = random->Uniform() < 0.5 ? 0 : 1;
  const float lean = Draw(random, -0.05, 0.45) * hip[0];
  const std::vector<float> hump = RandomHump(poses->num_frames, options.rate, 0.3, 1.5, random);
  for (int t = 0; t < poses->num_frames; ++t) {
    if (hump[t] == 0) continue;
    poses->at(t, kPelvis) = poses->at(t, kPelvis) * TurnBy(AboutX(hump[t] * lean));
    for (int i = 0; i < 2; ++i) {
      FlexLeg(first ^ i, hump[t] * (hip[i] + lean), hump[t] * out[i], hump[t] * knee[i], 1, t, poses);
    }
  }
}

/// One leg up, forwards, sideways or back; or a quick kick.
void RaiseLeg(const LifterWindowOptions& options, bool kick, HashRandom* random, PoseSequence* poses) {
  const int side = random->Uniform() < 0.5 ? 0 : 1;
  float hip = Draw(random, 0.3, 2.0), out = Draw(random, -0.2, 0.8), knee = Draw(random, 0, 1.9);
  if (random->Uniform() < 0.3) {  // back
    hip = Draw(random, -0.7, 0.1);
    knee = Draw(random, 0, 2.1);
  }
  if (kick) {
    hip = Draw(random, 0.8, 2.3);
    out = Draw(random, -0.2, 1.2);
    knee = Draw(random, 0, 0.3);
  }
  const std::vector<float> hump = kick ? RandomHump(poses->num_frames, options.rate, 0.15, 0.4, random)
                                       : RandomHump(poses->num_frames, options.rate, 0.25, 1.2, random);
  for (int t = 0; t < poses->num_frames; ++t) {
    if (hump[t] == 0) continue;
    // A kick bends the knee on its way up and down.
    const float bent = kick ? hump[t] * knee + 4 * hump[t] * (1 - hump[t]) * 1.2F : hump[t] * knee;
    FlexLeg(side, hump[t] * hip, hump[t] * out, bent, 0, t, poses);
  }
}

/// Sets the arm of a side along a direction of the trunk's frame, given for the left (x to the left, y up, z to the
/// front), with a rotation about itself and a bent elbow.
struct StretchedArm {
  Quaternionf shoulder, elbow;
};
StretchedArm ArmAlong(int side, const Vector3f& direction, float about_itself, float bent, float twist) {
  StretchedArm arm{Quaternionf::FromTwoVectors(Vector3f::UnitX(), direction) * TurnBy(AboutX(about_itself)),
                   TurnBy({0, -bent, 0}) * TurnBy(AboutX(twist))};
  if (side == 1) arm = {MirrorRotation(arm.shoulder), MirrorRotation(arm.elbow)};
  return arm;
}

void MoveArm(int side, const StretchedArm& arm, float share, int t, PoseSequence* poses) {
  poses->at(t, kLeftShoulder + side) = Between(poses->at(t, kLeftShoulder + side), arm.shoulder, share);
  poses->at(t, kLeftElbow + side) = Between(poses->at(t, kLeftElbow + side), arm.elbow, share);
}

/// Moves an arm to a random direction, with its elbow bent.
void RaiseArm(const LifterWindowOptions& options, int side, HashRandom* random, PoseSequence* poses) {
  // On the sphere, in the trunk's frame, not across the trunk's far side and not far behind it.
  const float turn = Draw(random, -0.6, 1.9), up = Draw(random, -1.0, 1.5);
  const Vector3f direction(std::cos(up) * std::cos(turn), std::sin(up), std::cos(up) * std::sin(turn));
  const float about_itself = Draw(random, -1, 1), twist = Draw(random, -0.7, 0.7), bent = Draw(random, 0, 2.3);
  const StretchedArm arm = ArmAlong(side, direction, about_itself, bent, twist);
  const std::vector<float> hump = RandomHump(poses->num_frames, options.rate, 0.25, 1.2, random);
  for (int t = 0; t < poses->num_frames; ++t) {
    if (hump[t] > 0) MoveArm(side, arm, hump[t], t, poses);
  }
}

/// Stretches one or both arms out to the front, high or low, followed by shoulder and trunk.
void Reach(const LifterWindowOptions& options, HashRandom* random, PoseSequence* poses) {
  const int first = random->Uniform() < 0.5 ? 0 : 1;
  const bool both = random->Uniform() < 0.35;
  const float up = Draw(random, -0.8, 1.3), inwards = Draw(random, -0.9, 0.35);
  const float bent = Draw(random, 0, 0.6), about_itself = Draw(random, -1, 1), twist = Draw(random, -0.7, 0.7);
  const float collar = Draw(random, 0, 0.4), spine = both ? 0 : Draw(random, 0, 0.2), bow = Draw(random, -0.05, 0.15);
  const float other_up = up + Draw(random, -0.2, 0.2), other_inwards = inwards + Draw(random, -0.2, 0.2);
  const auto arm = [&](int side) {
    const float height = side == first ? up : other_up, turn = side == first ? inwards : other_inwards;
    return ArmAlong(side, {-std::cos(height) * std::sin(turn), std::sin(height), std::cos(height) * std::cos(turn)},
                    about_itself, bent, twist);
  };
  const std::array<StretchedArm, 2> arms = {arm(0), arm(1)};
  const std::vector<float> hump = RandomHump(poses->num_frames, options.rate, 0.25, 1.2, random);
  for (int t = 0; t < poses->num_frames; ++t) {
    if (hump[t] == 0) continue;
    for (int side = 0; side < 2; ++side) {
      if (side != first && !both) continue;
      MoveArm(side, arms[side], hump[t], t, poses);
      const float forwards = side == 0 ? -collar : collar;  // about the vertical
      poses->at(t, kLeftCollar + side) = TurnBy({0, hump[t] * forwards, 0}) * poses->at(t, kLeftCollar + side);
    }
    const Quaternionf trunk = TurnBy({hump[t] * bow, hump[t] * (first == 0 ? -spine : spine), 0});
    for (const int j : {kSpine1, kSpine2, kSpine3}) poses->at(t, j) = poses->at(t, j) * trunk;
  }
}

/// Bends the trunk forward (or slightly back) with fixed legs.
void Bend(const LifterWindowOptions& options, HashRandom* random, PoseSequence* poses) {
  const float pelvis = Draw(random, -0.2, 1.3), spine = Draw(random, -0.1, 0.4);
  const std::vector<float> hump = RandomHump(poses->num_frames, options.rate, 0.3, 1.5, random);
  for (int t = 0; t < poses->num_frames; ++t) {
    if (hump[t] == 0) continue;
    poses->at(t, kPelvis) = poses->at(t, kPelvis) * TurnBy(AboutX(hump[t] * pelvis));
    for (int side = 0; side < 2; ++side) {
      Quaternionf& q = poses->at(t, kLeftHip + side);
      q = TurnBy(AboutX(-hump[t] * pelvis)) * q;
    }
    for (const int j : {kSpine1, kSpine2, kSpine3}) poses->at(t, j) = poses->at(t, j) * TurnBy(AboutX(hump[t] * spine));
  }
}

}  // namespace

LifterClip CompactClip(const Motion& motion, bool has_floor, const LifterBody& body) {
  CheckMotion(motion, "lifter windows");
  BODYLOOM_CHECK(motion.num_frames() >= 2, "lifter windows: a motion of ", motion.num_frames(),
                 " frames, expected at least two");
  BODYLOOM_CHECK(motion.poses.cols() >= 3 * kPoseJoints, "lifter windows: a motion of ", motion.poses.cols() / 3,
                 " joints, expected at least 24");
  BODYLOOM_CHECK(motion.up == Motion::Up::kY, "lifter windows: expected a motion with y up");
  const double rate = FrameRate(motion);
  BODYLOOM_CHECK(rate > 0, "lifter windows: expected a motion with a regular clock");
  const Motion at_rate = rate > 1.01 * kLifterClipRate ? ResampleMotion(motion, kLifterClipRate) : motion;
  LifterClip clip;
  clip.rate = rate > 1.01 * kLifterClipRate ? kLifterClipRate : rate;
  PoseSequence& poses = clip.poses;
  poses.num_frames = at_rate.num_frames();
  poses.has_floor = has_floor;
  BODYLOOM_CHECK(poses.num_frames >= 2, "lifter windows: a motion of ", motion.num_frames(), " frames at ", rate,
                 " a second, expected two at ", kLifterClipRate);
  clip.duration_s = (poses.num_frames - 1) / clip.rate;
  poses.rotations.resize(static_cast<size_t>(poses.num_frames) * kPoseJoints);
  poses.trans.resize(poses.num_frames);
  poses.clearance.assign(poses.num_frames, 0);
  const LifterPerson person = body.Person(motion.betas);
  PosedPerson posed;
  std::vector<float> lowest(poses.num_frames);
  for (int t = 0; t < poses.num_frames; ++t) {
    for (int j = 0; j < kPoseJoints; ++j) {
      const Eigen::Vector3d w = at_rate.poses.block<1, 3>(t, 3 * j);
      poses.at(t, j) = Eigen::Quaterniond(RotationFromAxisAngle(w)).cast<float>();
    }
    poses.trans[t] = at_rate.trans.row(t).cast<float>();
    body.Pose(person, &poses.at(t, 0), poses.trans[t], &posed);
    lowest[t] = body.Lowest(person, posed) / person.size;
    poses.trans[t] /= person.size;
  }
  if (!has_floor) return clip;
  std::vector<float> sorted = lowest;
  const auto low = sorted.begin() + static_cast<long>(kFloorShare * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), low, sorted.end());
  for (int t = 0; t < poses.num_frames; ++t) {
    const float height = lowest[t] - *low;
    poses.clearance[t] = height * std::clamp((height - kHover) / (kSurelyOff - kHover), 0.0F, 1.0F);
  }
  return clip;
}

void SampleClip(const LifterClip& clip, double start_s, double step_s, int num_frames, PoseSequence* poses) {
  poses->num_frames = num_frames;
  poses->has_floor = clip.poses.has_floor;
  poses->rotations.resize(static_cast<size_t>(num_frames) * kPoseJoints);
  poses->trans.resize(num_frames);
  poses->clearance.resize(num_frames);
  for (int t = 0; t < num_frames; ++t) {
    const Instant at = At(clip, start_s + t * step_s);
    for (int j = 0; j < kPoseJoints; ++j)
      poses->at(t, j) = Between(clip.poses.at(at.before, j), clip.poses.at(at.after, j), at.part);
    poses->trans[t] = (1 - at.part) * clip.poses.trans[at.before] + at.part * clip.poses.trans[at.after];
    poses->clearance[t] = (1 - at.part) * clip.poses.clearance[at.before] + at.part * clip.poses.clearance[at.after];
  }
}

void SampleJoints(const LifterClip& clip, double start_s, double step_s, const std::vector<int>& source,
                  const std::vector<int>& target, bool mirror, PoseSequence* poses) {
  for (int t = 0; t < poses->num_frames; ++t) {
    const Instant at = At(clip, start_s + t * step_s);
    for (size_t i = 0; i < source.size(); ++i) {
      const Quaternionf q = Between(clip.poses.at(at.before, source[i]), clip.poses.at(at.after, source[i]), at.part);
      poses->at(t, target[i]) = mirror ? MirrorRotation(q) : q;
    }
  }
}

void MirrorPoses(PoseSequence* poses) {
  for (int t = 0; t < poses->num_frames; ++t) {
    for (int j = 0; j < kPoseJoints; ++j) {
      const int twin = MirrorJoint(j);
      if (twin < j) continue;
      const Quaternionf own = MirrorRotation(poses->at(t, j));
      poses->at(t, j) = MirrorRotation(poses->at(t, twin));
      poses->at(t, twin) = own;
    }
    poses->trans[t].x() *= -1;
  }
}

PoseLimits::PoseLimits(const BodyModel& body) {
  for (const JointLimits::Range& range : JointLimits::ForBody(body).ranges) {
    // Joints beyond the wrists move no landmark.
    if (range.joint >= kLeftWrist) continue;
    ranges_[range.joint] = {true, range.lower.cast<float>().array(), range.upper.cast<float>().array()};
  }
}

void PoseLimits::Apply(PoseSequence* poses) const {
  for (int j = 0; j < kPoseJoints; ++j) {
    const Range& range = ranges_[j];
    if (!range.limited) continue;
    const bool knee = j == kLeftKnee || j == kLeftKnee + 1;
    const int elbow = j == kLeftElbow ? -1 : j == kLeftElbow + 1 ? 1 : 0;  // sign of flexion about y
    for (int t = 0; t < poses->num_frames; ++t) {
      Quaternionf& q = poses->at(t, j);
      const Eigen::Array3f w = AxisAngleOf(q).array();
      Eigen::Array3f inside = w;
      if (knee) inside.x() = std::abs(inside.x());
      if (elbow != 0) inside.y() = static_cast<float>(elbow) * std::abs(inside.y());
      inside = inside.max(range.lower).min(range.upper);
      if ((inside != w).any()) q = TurnBy(inside.matrix());
    }
  }
}

ClipChoice::ClipChoice(const std::vector<LifterClip>& clips) {
  double sum = 0;
  for (const LifterClip& clip : clips) up_to_.push_back(sum += std::sqrt(clip.duration_s));
}

size_t ClipChoice::operator()(HashRandom* random) const {
  const double at = random->Uniform() * up_to_.back();
  const auto it = std::upper_bound(up_to_.begin(), up_to_.end(), at);
  return std::min(static_cast<size_t>(it - up_to_.begin()), up_to_.size() - 1);
}

void ExchangeLimbs(const std::vector<LifterClip>& clips, const ClipChoice& choice, const LifterWindowOptions& options,
                   double step_s, HashRandom random, PoseSequence* poses) {
  const auto exchange = [&](double probability, std::vector<int> joints) {
    const bool wanted = random.Uniform() < probability, mirror = random.Uniform() < options.mirror;
    const LifterClip& clip = clips[choice(&random)];
    const double start_s = random.Uniform(0, clip.duration_s);
    if (!wanted) return;
    std::vector<int> source = joints;
    if (mirror) std::transform(joints.begin(), joints.end(), source.begin(), MirrorJoint);
    SampleJoints(clip, start_s, step_s, source, joints, mirror, poses);
  };
  for (int side = 0; side < 2; ++side) {
    exchange(options.arm_exchange,
             {kLeftCollar + side, kLeftShoulder + side, kLeftElbow + side, kLeftWrist + side, kLeftHand + side});
    exchange(options.leg_exchange, {kLeftHip + side, kLeftKnee + side, kLeftAnkle + side, kLeftFoot + side});
  }
  exchange(options.spine_exchange, {kSpine1, kSpine2, kSpine3, kNeck, kHead});
}

void AddExercises(const LifterWindowOptions& options, HashRandom random, PoseSequence* poses) {
  if (random.Uniform() < options.squat) Squat(options, &random, poses);
  if (random.Uniform() < options.bend) Bend(options, &random, poses);
  if (random.Uniform() < options.leg_raise) RaiseLeg(options, false, &random, poses);
  if (random.Uniform() < options.kick) RaiseLeg(options, true, &random, poses);
  for (int side = 0; side < 2; ++side) {
    if (random.Uniform() < options.arm_raise) RaiseArm(options, side, &random, poses);
  }
  if (random.Uniform() < options.lean) {
    const float tilt_z = Draw(&random, -0.5, 0.5), tilt_x = Draw(&random, -0.5, 0.5);
    const std::vector<float> hump = RandomHump(poses->num_frames, options.rate, 0.4, 2, &random);
    for (int t = 0; t < poses->num_frames; ++t) {
      if (hump[t] > 0) poses->at(t, kPelvis) = TurnBy({hump[t] * tilt_x, 0, hump[t] * tilt_z}) * poses->at(t, kPelvis);
    }
  }
  if (random.Uniform() < options.reach) Reach(options, &random, poses);
}

void AddTurns(const LifterWindowOptions& options, HashRandom random, PoseSequence* poses) {
  const auto turn = [&](const Vector3f& axis, float angle, double longest_s) {
    const std::vector<float> part = RandomRamp(poses->num_frames, options.rate, 0.4, longest_s, -0.2, 0.9, &random);
    for (int t = 0; t < poses->num_frames; ++t) {
      if (part[t] > 0) poses->at(t, kPelvis) = TurnBy(angle * part[t] * axis) * poses->at(t, kPelvis);
    }
  };
  constexpr auto kRound = static_cast<float>(2 * M_PI);
  if (random.Uniform() < options.spin) {
    const float angle = Draw(&random, 0.15, 2) * kRound;
    turn(Vector3f::UnitY(), random.Uniform() < 0.5 ? -angle : angle, 2.5);
  }
  if (random.Uniform() < options.tumble) {
    const float heading = Draw(&random, 0, kRound);
    const bool around = random.Uniform() < 0.5;
    turn({std::cos(heading), 0, std::sin(heading)}, around ? kRound : Draw(&random, 0.2, 0.5) * kRound, 1.5);
  }
}

void PerturbPoses(const LifterWindowOptions& options, float share, float root_share, HashRandom random,
                  PoseSequence* poses) {
  struct Row {
    int joint;
    Vector3f sd;
  };
  static const std::vector<Row> rows = {
      {kPelvis, {.2F, .2F, .2F}},           {kSpine1, {.1F, .1F, .1F}},          {kSpine2, {.1F, .1F, .1F}},
      {kSpine3, {.1F, .1F, .1F}},           {kNeck, {.15F, .15F, .15F}},         {kHead, {.2F, .2F, .2F}},
      {kLeftHip, {.3F, .3F, .3F}},          {kLeftHip + 1, {.3F, .3F, .3F}},     {kLeftKnee, {.4F, .05F, .05F}},
      {kLeftKnee + 1, {.4F, .05F, .05F}},   {kLeftAnkle, {.2F, .1F, .1F}},       {kLeftAnkle + 1, {.2F, .1F, .1F}},
      {kLeftCollar, {.05F, .1F, .1F}},      {kLeftCollar + 1, {.05F, .1F, .1F}}, {kLeftShoulder, {.5F, .5F, .5F}},
      {kLeftShoulder + 1, {.5F, .5F, .5F}}, {kLeftElbow, {.3F, .5F, .1F}},       {kLeftElbow + 1, {.3F, .5F, .1F}},
  };
  const float level = Draw(&random, 0, options.perturbation);
  const float knot_frames = static_cast<float>(options.rate * random.Uniform(0.35, 1.2));
  FastNormal normal(random);
  std::vector<float> x, y, z;
  for (const Row& row : rows) {
    SmoothNoise(poses->num_frames, knot_frames, &normal, &x);
    SmoothNoise(poses->num_frames, knot_frames, &normal, &y);
    SmoothNoise(poses->num_frames, knot_frames, &normal, &z);
    if (level == 0) continue;
    const Vector3f sd = ((row.joint == kPelvis ? root_share : share) * level) * row.sd;
    for (int t = 0; t < poses->num_frames; ++t) {
      Quaternionf& q = poses->at(t, row.joint);
      q = q * TurnBy(sd.cwiseProduct(Vector3f(x[t], y[t], z[t])));
    }
  }
}

}  // namespace bodyloom
