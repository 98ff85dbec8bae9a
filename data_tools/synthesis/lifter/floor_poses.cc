// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/lifter/floor_poses.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "data_tools/synthesis/lifter/fast_random.h"

namespace bodyloom {

using Eigen::Quaternionf;
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

constexpr float kQuarter = static_cast<float>(M_PI_2);

struct Span {
  float low, high;
  [[nodiscard]] float Draw(HashRandom* random) const { return static_cast<float>(random->Uniform(low, high)); }
};

/// `thigh`: its angle to the world's downward direction, forwards positive, so that π/2 lies along the floor; `turn`:
/// the thigh's rotation outwards about the trunk's axis; `twist`: about itself, outwards. The knee bends by `knee` +
/// follow · (thigh − π/2): with follow about 2 the foot stays on the floor under a raised knee.
struct LegPose {
  Span thigh, out, turn, twist, knee;
  float follow;
};

/// Upper arm in the trunk's frame: `turn` from sideways (0) to the front (π/2), `up` from down (−π/2) to overhead.
struct ArmPose {
  Span turn, up, elbow;
};

struct FloorPose {
  const char* name;
  float weight;
  Span pitch;  ///< of the pelvis, forwards; −π/2 lies on the back
  Span roll;   ///< about the trunk's own axis, before it
  LegPose legs[2];
  float same_legs;  ///< probability that both legs have the same pose
  ArmPose arms;
  Span spine, neck;
  float settle;  ///< maximum rotation of settling
};

constexpr Span kNone{0, 0}, kSmall{-.15F, .15F};
constexpr LegPose Leg(Span thigh, Span out, Span knee, float follow = 0) {
  return {thigh, out, kNone, kSmall, knee, follow};
}
constexpr LegPose kKneeling = {{-.15F, .2F}, {-.05F, .3F}, kNone, kSmall, {1.4F, 1.65F}, 0};
constexpr LegPose kFootForward = {{1.35F, 1.65F}, {-.05F, .3F}, kNone, kSmall, {1.4F, 1.7F}, 0};
constexpr LegPose kCrossed = {{1.35F, 1.6F}, {0, .1F}, {.6F, 1.0F}, {1.1F, 1.5F}, {2.0F, 2.4F}, 0};
constexpr LegPose kLegStraightDown = Leg({1.45F, 1.62F}, {-.05F, .35F}, {0, .2F});
constexpr LegPose kLegDrawnUp = Leg({1.75F, 2.5F}, {-.1F, .4F}, {-.1F, .15F}, 1.95F);
constexpr LegPose kLegInAir = Leg({2.2F, 3.4F}, {-.2F, .8F}, {0, 1.7F});
constexpr LegPose kLegBehind = Leg({-1.75F, -1.5F}, {-.05F, .5F}, {0, .25F});
constexpr LegPose kShinInAir = Leg({-1.7F, -1.5F}, {-.05F, .4F}, {.5F, 2.1F});
constexpr ArmPose kArmsAnywhere = {{-.2F, 1.6F}, {-1.4F, 1.4F}, {0, 2.2F}},
                  kArmsDownFront = {{1.3F, 1.65F}, {-.4F, .05F}, {0, .3F}};

constexpr FloorPose kPoses[] = {
    {"back, legs straight",
     1,
     {-1.6F, -1.5F},
     {-.25F, .25F},
     {kLegStraightDown, kLegStraightDown},
     .5F,
     kArmsAnywhere,
     {-.1F, .1F},
     {-.2F, .5F},
     .4F},
    {"back, knees up",
     1.2F,
     {-1.6F, -1.45F},
     {-.3F, .3F},
     {kLegDrawnUp, kLegDrawnUp},
     .6F,
     kArmsAnywhere,
     {-.05F, .15F},
     {-.2F, .6F},
     .4F},
    {"back, a leg in the air",
     .8F,
     {-1.6F, -1.35F},
     {-.3F, .3F},
     {kLegInAir, kLegDrawnUp},
     .5F,
     kArmsAnywhere,
     {-.05F, .25F},
     {-.1F, .7F},
     .4F},
    {"belly",
     1,
     {1.5F, 1.6F},
     {-.25F, .25F},
     {kLegBehind, kLegBehind},
     .7F,
     {{-.1F, .9F}, {-1.4F, 1.4F}, {.1F, 2.2F}},
     {-.15F, .05F},
     {-.7F, .1F},
     .4F},
    {"belly, shins in the air",
     .4F,
     {1.5F, 1.6F},
     {-.2F, .2F},
     {kShinInAir, kLegBehind},
     .6F,
     {{.8F, 1.5F}, {-.6F, .8F}, {1.2F, 2.3F}},
     {-.3F, 0},
     {-.8F, 0},
     .4F},
    {"side",
     1.2F,
     {-1.65F, -1.5F},
     {1.1F, 2.0F},
     {Leg({1.4F, 3.0F}, {-.1F, .3F}, {0, 1.9F}), Leg({1.4F, 3.0F}, {-.1F, .3F}, {0, 1.9F})},
     .6F,
     {{.5F, 1.7F}, {-1.0F, 1.2F}, {0, 2.2F}},
     {-.1F, .3F},
     {-.3F, .5F},
     .4F},
    {"sitting, legs straight",
     1,
     {-.4F, .2F},
     kSmall,
     {kLegStraightDown, kLegStraightDown},
     .7F,
     {{0, 1.5F}, {-1.4F, -.3F}, {0, 1.5F}},
     {0, .25F},
     {-.3F, .4F},
     .12F},
    {"sitting, knees up",
     1.2F,
     {-.5F, .1F},
     kSmall,
     {kLegDrawnUp, kLegDrawnUp},
     .7F,
     {{.6F, 1.6F}, {-1.0F, -.2F}, {0, 1.8F}},
     {0, .3F},
     {-.3F, .4F},
     .12F},
    {"sitting, leaning back",
     .8F,
     {-.7F, -.3F},
     kSmall,
     {kLegDrawnUp, kLegStraightDown},
     .5F,
     {{-1.3F, -.6F}, {-1.2F, -.7F}, {0, .5F}},
     {0, .2F},
     {-.2F, .5F},
     .3F},
    {"sitting, crossed legs",
     1,
     {-.2F, .25F},
     kSmall,
     {kCrossed, kCrossed},
     1,
     {{.5F, 1.5F}, {-1.2F, -.4F}, {.2F, 1.6F}},
     {0, .25F},
     {-.2F, .4F},
     .12F},
    {"kneeling", 1, {-.1F, .25F}, kSmall, {kKneeling, kKneeling}, .8F, kArmsAnywhere, {-.05F, .2F}, {-.3F, .4F}, .12F},
    {"kneeling, on the heels",
     .8F,
     {-.1F, .4F},
     kSmall,
     {Leg({1.2F, 1.45F}, {-.05F, .35F}, {2.4F, 2.65F}), Leg({1.2F, 1.45F}, {-.05F, .35F}, {2.4F, 2.65F})},
     .9F,
     {{.6F, 1.6F}, {-1.3F, -.3F}, {.2F, 1.6F}},
     {0, .25F},
     {-.2F, .4F},
     .12F},
    {"kneeling, one foot forward",
     .8F,
     {-.05F, .3F},
     kSmall,
     {kKneeling, kFootForward},
     0,
     kArmsAnywhere,
     {-.05F, .25F},
     {-.3F, .4F},
     .12F},
    {"hands and knees",
     1.6F,
     {1.15F, 1.5F},
     kSmall,
     {kKneeling, kKneeling},
     .5F,
     kArmsDownFront,
     {-.15F, .15F},
     {-.6F, .2F},
     .3F},
    {"elbows and knees",
     .5F,
     {1.35F, 1.7F},
     kSmall,
     {kKneeling, kKneeling},
     .6F,
     {{1.2F, 1.6F}, {-.3F, .3F}, {1.2F, 1.7F}},
     {-.1F, .15F},
     {-.6F, .2F},
     .3F},
    {"plank",
     .8F,
     {1.2F, 1.5F},
     kSmall,
     {Leg({-1.5F, -1.2F}, {0, .25F}, {0, .15F}), Leg({-1.5F, -1.2F}, {0, .25F}, {0, .15F})},
     .8F,
     {{1.0F, 1.65F}, {-.35F, .1F}, {0, 1.7F}},
     {-.1F, .1F},
     {-.5F, .2F},
     .4F},
    {"folded over the knees",
     .5F,
     {1.2F, 1.55F},
     kSmall,
     {Leg({1.0F, 1.4F}, {0, .4F}, {2.4F, 2.65F}), Leg({1.0F, 1.4F}, {0, .4F}, {2.4F, 2.65F})},
     .9F,
     {{.6F, 1.6F}, {-.6F, 1.4F}, {0, 1.6F}},
     {.05F, .3F},
     {-.1F, .5F},
     .3F},
    {"bear",
     .7F,
     {1.6F, 2.2F},
     kSmall,
     {Leg({-.4F, .3F}, {0, .3F}, {0, .9F}), Leg({-.4F, .3F}, {0, .3F}, {0, .9F})},
     .4F,
     {{1.35F, 1.65F}, {0, .7F}, {0, .3F}},
     {-.05F, .2F},
     {-.5F, .3F},
     .4F},
    {"crab",
     .6F,
     {-1.25F, -.85F},
     kSmall,
     {Leg({1.25F, 1.7F}, {0, .3F}, {1.3F, 1.6F}), Leg({1.25F, 1.7F}, {0, .3F}, {1.3F, 1.6F})},
     .5F,
     {{-1.4F, -.9F}, {-.8F, -.3F}, {0, .3F}},
     {-.1F, .1F},
     {0, .6F},
     .4F},
    {"deep squat",
     1,
     {.15F, .7F},
     kSmall,
     {Leg({1.7F, 2.1F}, {.1F, .6F}, {2.2F, 2.6F}), Leg({1.7F, 2.1F}, {.1F, .6F}, {2.2F, 2.6F})},
     .9F,
     kArmsAnywhere,
     {0, .3F},
     {-.5F, .3F},
     .12F},
    {"upside down",
     .5F,
     {2.5F, 3.6F},
     {-.4F, .4F},
     {Leg({-4.0F, -2.2F}, {0, .8F}, {0, 1.9F}), Leg({-4.0F, -2.2F}, {0, .8F}, {0, 1.9F})},
     .4F,
     {{.7F, 1.65F}, {.6F, 1.5F}, {0, 1.7F}},
     {-.15F, .2F},
     {-.4F, .3F},
     .1F},
};

Vector3f X(float angle) { return {angle, 0, 0}; }
Vector3f Y(float angle) { return {0, angle, 0}; }
Vector3f Z(float angle) { return {0, 0, angle}; }

int DrawKind(HashRandom* random) {
  double sum = 0;
  for (const FloorPose& pose : kPoses) sum += pose.weight;
  double at = random->Uniform() * sum;
  for (int i = 0; i + 1 < NumFloorPoses(); ++i) {
    if ((at -= kPoses[i].weight) < 0) return i;
  }
  return NumFloorPoses() - 1;
}

struct Angles {
  float thigh, out, turn, twist, knee;
};

Angles Draw(const LegPose& leg, HashRandom* random) {
  Angles a{};
  a.thigh = leg.thigh.Draw(random);
  a.out = leg.out.Draw(random);
  a.turn = leg.turn.Draw(random);
  a.twist = leg.twist.Draw(random);
  a.knee = std::clamp(leg.knee.Draw(random) + leg.follow * (a.thigh - kQuarter), 0.0F, 2.65F);
  return a;
}

/// Closest point to `target` of the convex hull of the points, in the plane. Few points: all triangles and edges.
Vector2f ClosestInHull(const std::vector<Vector2f>& points, const Vector2f& target) {
  const auto cross = [](const Vector2f& a, const Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); };
  const size_t n = points.size();
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = i + 1; j < n; ++j) {
      for (size_t k = j + 1; k < n; ++k) {
        const float a = cross(points[j] - points[i], target - points[i]),
                    b = cross(points[k] - points[j], target - points[j]),
                    c = cross(points[i] - points[k], target - points[k]);
        if ((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0)) return target;
      }
    }
  }
  Vector2f best = points[0];
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = i; j < n; ++j) {
      const Vector2f edge = points[j] - points[i];
      const float length2 = edge.squaredNorm();
      const float at = length2 > 0 ? std::clamp((target - points[i]).dot(edge) / length2, 0.0F, 1.0F) : 0.0F;
      const Vector2f x = points[i] + at * edge;
      if ((x - target).squaredNorm() < (best - target).squaredNorm()) best = x;
    }
  }
  return best;
}

/// Rough centre of mass: shares of trunk, head, thighs, shins, upper and lower arms.
Vector3f CentreOfMass(const PosedPerson& posed) {
  const auto& j = posed.joint;
  Vector3f sum = 0.25F * j[kPelvis] + 0.25F * j[kSpine3] + 0.08F * j[kHead];
  for (int side = 0; side < 2; ++side) {
    sum += 0.05F * (j[kLeftHip + side] + j[kLeftKnee + side]) + 0.03F * (j[kLeftKnee + side] + j[kLeftAnkle + side]) +
           0.014F * (j[kLeftShoulder + side] + j[kLeftElbow + side]) +
           0.01F * (j[kLeftElbow + side] + j[kLeftWrist + side]);
  }
  return sum / (0.58F + 4 * (0.05F + 0.03F + 0.014F + 0.01F));
}

/// Rotates the pose about the edge of its support until the support grows, by at most `allowed` in total.
void Settle(const LifterBody& body, const LifterPerson& person, float allowed, std::vector<Quaternionf>* pose) {
  PosedPerson posed;
  std::array<Vector3f, LifterBody::kNumBalls> bottoms;
  for (int step = 0; step < 5 && allowed > 0.01F; ++step) {
    body.Pose(person, pose->data(), Vector3f::Zero(), &posed);
    body.BallBottoms(person, posed, &bottoms);
    float floor = bottoms[0].y();
    for (const Vector3f& b : bottoms) floor = std::min(floor, b.y());
    std::vector<Vector2f> support;
    for (const Vector3f& b : bottoms) {
      if (b.y() < floor + 0.012F) support.emplace_back(b.x(), b.z());
    }
    const Vector3f mass = CentreOfMass(posed);
    const Vector2f target(mass.x(), mass.z()), pivot = ClosestInHull(support, target);
    const float away = (target - pivot).norm();
    if (away < 0.02F) return;
    const Vector2f fall = (target - pivot) / away;
    float turn = allowed;
    for (const Vector3f& b : bottoms) {
      const float along = (Vector2f(b.x(), b.z()) - pivot).dot(fall);
      if (along > 0.02F && b.y() > floor + 0.012F) turn = std::min(turn, std::atan2(b.y() - floor, along));
    }
    // y × fall: what is above the pivot moves towards the centre of mass.
    (*pose)[0] = TurnBy(turn * Vector3f(fall.y(), 0, -fall.x())) * (*pose)[0];
    allowed -= turn;
  }
}

}  // namespace

int NumFloorPoses() { return static_cast<int>(std::size(kPoses)); }
const char* FloorPoseName(int kind) { return kPoses[kind].name; }

std::vector<Quaternionf> RandomFloorPose(int kind, const LifterBody& body, const LifterPerson& person,
                                         HashRandom* random) {
  const FloorPose& row = kPoses[kind];
  std::vector<Quaternionf> pose(kPoseJoints, Quaternionf::Identity());
  const float pitch = row.pitch.Draw(random);
  const float to_right = row.roll.Draw(random);
  const float roll = random->Uniform() < 0.5 ? -to_right : to_right;
  pose[kPelvis] = TurnBy(X(pitch)) * TurnBy(Y(roll));
  const int first = random->Uniform() < 0.5 ? 0 : 1;
  Angles angles[2] = {Draw(row.legs[0], random), Draw(row.legs[1], random)};
  if (random->Uniform() < row.same_legs) angles[1] = angles[0];
  for (int i = 0; i < 2; ++i) {
    const Angles& a = angles[i];
    const float flex = std::clamp(a.thigh + pitch, -0.6F, 2.35F);
    Quaternionf hip = TurnBy(Y(a.turn)) * TurnBy(Z(a.out)) * TurnBy(X(-flex)) * TurnBy(Y(a.twist));
    const int side = first ^ i;
    pose[kLeftHip + side] = side == 0 ? hip : MirrorRotation(hip);
    pose[kLeftKnee + side] = TurnBy(X(a.knee));
    // Feet without load point down; they lie flat where shin and floor form an angle.
    const float shin = a.thigh - a.knee;
    pose[kLeftAnkle + side] = TurnBy(X(std::clamp(shin < -0.9F ? 0.7F : shin, -0.7F, 0.8F)));
  }
  for (int side = 0; side < 2; ++side) {
    const float turn = row.arms.turn.Draw(random), up = row.arms.up.Draw(random);
    const Vector3f direction(std::cos(up) * std::cos(turn), std::sin(up), std::cos(up) * std::sin(turn));
    const float twist = static_cast<float>(random->Uniform(-0.5, 0.5));
    const Quaternionf shoulder = Quaternionf::FromTwoVectors(Vector3f::UnitX(), direction) * TurnBy(X(twist));
    const Quaternionf elbow = TurnBy(Y(-row.arms.elbow.Draw(random)));
    pose[kLeftShoulder + side] = side == 0 ? shoulder : MirrorRotation(shoulder);
    pose[kLeftElbow + side] = side == 0 ? elbow : MirrorRotation(elbow);
  }
  const float spine = row.spine.Draw(random), side_bend = static_cast<float>(random->Uniform(-0.1, 0.1));
  for (const int j : {kSpine1, kSpine2, kSpine3}) pose[j] = TurnBy({spine, side_bend, side_bend});
  const float neck = row.neck.Draw(random), look = static_cast<float>(random->Uniform(-0.5, 0.5));
  for (const int j : {kNeck, kHead}) pose[j] = TurnBy({0.5F * neck, 0.5F * look, 0});
  Settle(body, person, row.settle, &pose);
  return pose;
}

void AddFloorPoses(const LifterBody& body, const LifterPerson& person, const LifterWindowOptions& options,
                   HashRandom random, PoseSequence* poses) {
  const int T = poses->num_frames;
  std::vector<Quaternionf> key[2];
  const int kind = DrawKind(&random), next = DrawKind(&random);
  key[0] = RandomFloorPose(kind, body, person, &random);
  key[1] = RandomFloorPose(random.Uniform() < 0.5 ? kind : next, body, person, &random);
  const float heading = static_cast<float>(random.Uniform(0, 2 * M_PI)),
              turn = static_cast<float>(0.6 * random.Normal());
  key[0][0] = TurnBy(Y(heading)) * key[0][0];
  key[1][0] = TurnBy(Y(heading + turn)) * key[1][0];

  // From one pose to the other in 0.4 to 2 s, and, in some windows, from or to the recorded motion.
  const auto ramp = [&](double min_s, double max_s) {
    return RandomRamp(T, options.rate, min_s, max_s, -0.3, 1.0, &random);
  };
  const std::vector<float> second = ramp(0.4, 2.0);
  std::vector<float> down = ramp(0.3, 2.0);  // a fall takes a third of a second
  const double manner = random.Uniform();
  for (float& d : down) d = manner < 0.2 ? d : manner < 0.35 ? 1 - d : 1;

  // Share of the recorded movement kept in the limbs; small for poses that stand on their limbs.
  const float kept_limbs = static_cast<float>(random.Uniform(0, 0.3)),
              kept_head = static_cast<float>(random.Uniform(0, 0.6));
  const bool rolls = random.Uniform() < 0.15, crawls = random.Uniform() < 0.25;
  const float roll_rate = rolls ? static_cast<float>(random.Normal() * 1.5 / options.rate) : 0;  // rad a frame
  const float stride = crawls ? static_cast<float>(random.Uniform(0.1, 0.45)) : 0;
  const float pace = static_cast<float>(2 * M_PI * random.Uniform(0.3, 1.2) / options.rate);
  FastNormal normal(random);
  std::vector<float> drift_x, drift_z;
  SmoothNoise(T, static_cast<float>(options.rate), &normal, &drift_x);
  SmoothNoise(T, static_cast<float>(options.rate), &normal, &drift_z);
  Vector3f rest = poses->trans[0];
  for (int t = 0; t < T; ++t) {
    if (down[t] < 0.5F || t == 0) rest = poses->trans[t];
  }
  if (manner >= 0.35) rest = poses->trans[0];
  for (int t = 0; t < T; ++t) {
    const float w = down[t];
    poses->clearance[t] *= 1 - w;
    if (w == 0) continue;
    for (int j = 0; j < kPoseJoints; ++j) {
      Quaternionf q = Between(key[0][j], key[1][j], second[t]);
      const bool head = j == kNeck || j == kHead;
      if (j != kPelvis) q = Between(q, poses->at(t, j), head ? kept_head : kept_limbs);
      const int swing_sign = (j == kLeftHip || j == kLeftShoulder + 1)   ? 1
                             : (j == kLeftHip + 1 || j == kLeftShoulder) ? -1
                                                                         : 0;
      if (swing_sign != 0 && stride > 0)
        q = TurnBy(X(static_cast<float>(swing_sign) * stride * std::sin(pace * static_cast<float>(t)))) * q;
      if (j == kPelvis && rolls) q = q * TurnBy(Y(roll_rate * static_cast<float>(t)));
      poses->at(t, j) = Between(poses->at(t, j), q, w);
    }
    const float creep = crawls ? 0.02F * stride * static_cast<float>(t) : 0;
    const Vector3f place = rest + Vector3f(0.12F * drift_x[t] + creep * std::sin(heading), 0,
                                           0.12F * drift_z[t] + creep * std::cos(heading));
    poses->trans[t] = (1 - w) * poses->trans[t] + w * place;
  }
  poses->has_floor = true;
}

}  // namespace bodyloom
