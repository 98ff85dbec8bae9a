// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/lifter/lifter_body.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "tracking/problem/body_points.h"

namespace bodyloom {

using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr float kSmallWeight = 0.03F;  // bones below it are merged with the landmark's main bone

/// A ball that fills a part of the body: around a landmark (or the middle of a pair) or a joint; metres, mean body.
struct Ball {
  enum Kind { kLandmark, kPair, kJoint } kind;
  int index;
  float radius;
};
constexpr float kSole = -1;  // marks a radius that is the distance to the sole, which depends on the body
constexpr Ball kBalls[LifterBody::kNumBalls] = {
    {Ball::kLandmark, kLifterLeftBigToe, kSole},
    {Ball::kLandmark, kLifterLeftBigToe + 1, kSole},
    {Ball::kLandmark, kLifterLeftHeel, kSole},
    {Ball::kLandmark, kLifterLeftHeel + 1, kSole},
    {Ball::kLandmark, kLifterLeftAnkle, .045F},
    {Ball::kLandmark, kLifterLeftAnkle + 1, .045F},
    {Ball::kLandmark, kLifterLeftKnee, .055F},
    {Ball::kLandmark, kLifterLeftKnee + 1, .055F},
    {Ball::kLandmark, kLifterLeftHip, .095F},
    {Ball::kLandmark, kLifterLeftHip + 1, .095F},
    {Ball::kLandmark, kLifterLeftShoulder, .06F},
    {Ball::kLandmark, kLifterLeftShoulder + 1, .06F},
    {Ball::kLandmark, kLifterLeftElbow, .042F},
    {Ball::kLandmark, kLifterLeftElbow + 1, .042F},
    {Ball::kLandmark, kLifterLeftWrist, .03F},
    {Ball::kLandmark, kLifterLeftWrist + 1, .03F},
    {Ball::kJoint, kLeftHand, .025F},
    {Ball::kJoint, kLeftHand + 1, .025F},
    {Ball::kJoint, kPelvis, .105F},
    {Ball::kJoint, kSpine3, .11F},
    {Ball::kPair, kLifterLeftEar, .095F},
    {Ball::kLandmark, kLifterNose, .01F},
};

/// The half of the body that a joint's bone belongs to in the table of bone spreads.
struct StretchGroup {
  double sd;
  std::array<int, 5> joints;  ///< −1: none
  int axis;                   ///< 3: all
};
constexpr StretchGroup kStretches[] = {
    {.06, {kLeftHip, kLeftHip + 1, kLeftKnee, kLeftKnee + 1, -1}, 1},
    {.06, {kLeftShoulder, kLeftShoulder + 1, kLeftElbow, kLeftElbow + 1, -1}, 0},
    {.06, {kPelvis, kSpine1, kSpine2, kSpine3, -1}, 1},
    {.07, {kSpine3, kLeftCollar, kLeftCollar + 1, -1, -1}, 0},
    {.08, {kPelvis, -1, -1, -1, -1}, 0},
    {.10, {kNeck, kHead, -1, -1, -1}, 3},
    {.06, {kLeftAnkle, kLeftAnkle + 1, kLeftFoot, kLeftFoot + 1, -1}, 2},
};
constexpr double kOwnStretch = 0.02;  // of each bone besides its group

}  // namespace

LifterBody::LifterBody(const BodyModel& body) {
  BODYLOOM_CHECK(body.num_joints() >= kPoseJoints &&
                     std::equal(SmplParents().begin(), SmplParents().begin() + 22, body.parents().begin()),
                 "lifter body: expected SMPL's joints, '", body.name(), "' has ", body.num_joints(), " of its own");
  num_betas_ = body.num_betas();
  for (int j = 0; j < kPoseJoints; ++j) parent_[j] = SmplParents()[j];
  rest_joint_.resize(3 * kPoseJoints);
  for (int j = 0; j < kPoseJoints; ++j) rest_joint_.segment<3>(3 * j) = body.joint_template().row(j).cast<float>();
  joint_shape_ = body.joint_shapedirs().topRows(3 * kPoseJoints).cast<float>();

  std::vector<Vector3f> local;
  std::vector<Eigen::MatrixXf> local_shape;
  for (int k = 0; k < kLifterPoints; ++k) {
    const std::string& name = LifterPointNames()[k];
    const int landmark = body.FindLandmark(name);
    BODYLOOM_CHECK(landmark >= 0, "lifter body: the body '", body.name(), "' has no landmark ", name);
    const Landmark& l = body.data().landmarks[landmark];
    CompiledPoint point = CompilePoint(body, l.vertices, l.weights, num_betas_);
    // Joints beyond SMPL's 24 (fingers, jaw) move none of these landmarks by more than a trace.
    auto& compiled = point.bones;
    const auto main = std::max_element(compiled.begin(), compiled.end(),
                                       [](const auto& a, const auto& b) { return a.weight < b.weight; });
    BODYLOOM_CHECK(main->joint < kPoseJoints, "lifter body: joint ", main->joint, " moves the landmark ", name,
                   ", expected one of the first 24");
    main_bone_[k] = main->joint;
    for (auto& bone : compiled) {
      if (&bone == &*main || (bone.weight >= kSmallWeight && bone.joint < kPoseJoints)) continue;
      main->weight += bone.weight;
      main->q0 += bone.q0;
      main->Q += bone.Q;
      bone.weight = 0;
    }
    for (const auto& bone : compiled) {
      if (bone.weight == 0) continue;
      const float w = static_cast<float>(bone.weight);
      bones_[k].push_back({bone.joint, w, static_cast<int>(3 * local.size())});
      local.emplace_back(bone.q0.cast<float>() - w * rest_joint_.segment<3>(3 * bone.joint));
      local_shape.emplace_back(bone.Q.cast<float>() - w * joint_shape_.middleRows<3>(3 * bone.joint));
    }
  }
  local_.resize(static_cast<Eigen::Index>(3 * local.size()));
  local_shape_.resize(static_cast<Eigen::Index>(3 * local.size()), num_betas_);
  for (size_t i = 0; i < local.size(); ++i) {
    local_.segment<3>(static_cast<Eigen::Index>(3 * i)) = local[i];
    local_shape_.middleRows<3>(static_cast<Eigen::Index>(3 * i)) = local_shape[i];
  }

  const LifterPerson mean = Person({});
  mean_length_ = mean.reference_length;
  std::vector<Quaternionf> straight(kPoseJoints, Quaternionf::Identity());
  PosedPerson posed;
  Pose(mean, straight.data(), Vector3f::Zero(), &posed);
  const auto sole = static_cast<float>(body.data().v_template.col(1).minCoeff());
  toe_radius_ = std::max(0.0F, posed.point[kLifterLeftBigToe].y() - sole);
  heel_radius_ = std::max(0.0F, posed.point[kLifterLeftHeel].y() - sole);
}

LifterPerson LifterBody::Build(const Eigen::VectorXf& betas, const std::array<Vector3f, kPoseJoints>& stretch,
                               const std::array<Vector3f, kLifterPoints>& offsets) const {
  LifterPerson person;
  const Eigen::VectorXf joints = rest_joint_ + joint_shape_ * betas, local = local_ + local_shape_ * betas;
  person.pelvis = joints.head<3>();
  for (int j = 1; j < kPoseJoints; ++j) {
    person.offset[j] = stretch[parent_[j]].cwiseProduct(joints.segment<3>(3 * j) - joints.segment<3>(3 * parent_[j]));
  }
  person.offset[0].setZero();
  person.local.resize(static_cast<size_t>(local.size()) / 3);
  for (int k = 0; k < kLifterPoints; ++k) {
    for (const Bone& bone : bones_[k]) {
      person.local[bone.column / 3] =
          stretch[bone.joint].cwiseProduct(local.segment<3>(bone.column)) + bone.weight * offsets[k];
    }
  }
  person.detector.fill(Vector3f::Zero());
  const std::vector<Quaternionf> straight(kPoseJoints, Quaternionf::Identity());
  PosedPerson posed;
  Pose(person, straight.data(), Vector3f::Zero(), &posed);
  person.reference_length = LifterReferenceLength({posed.point[0].data(), 3 * static_cast<size_t>(kLifterPoints)});
  person.size = person.reference_length / mean_length_;
  return person;
}

LifterPerson LifterBody::Person(const Eigen::VectorXd& betas) const {
  Eigen::VectorXf b = Eigen::VectorXf::Zero(num_betas_);
  const Eigen::Index given = std::min<Eigen::Index>(num_betas_, betas.size());
  b.head(given) = betas.head(given).cast<float>();
  std::array<Vector3f, kPoseJoints> stretch;
  stretch.fill(Vector3f::Ones());
  std::array<Vector3f, kLifterPoints> offsets;
  offsets.fill(Vector3f::Zero());
  return Build(b, stretch, offsets);
}

LifterPerson LifterBody::RandomPerson(const LifterPersonSpread& spread, HashRandom random) const {
  const auto normal = [&](double sd) { return static_cast<float>(sd * std::clamp(random.Normal(), -3.0, 3.0)); };
  const auto normals = [&](double sd) {
    const float z = normal(sd), y = normal(sd), x = normal(sd);
    return Vector3f(x, y, z);
  };
  Eigen::VectorXf betas(num_betas_);
  for (float& b : betas) b = normal(spread.shape_sd);
  std::array<Vector3f, kPoseJoints> stretch;
  stretch.fill(Vector3f::Ones());
  for (const StretchGroup& group : kStretches) {
    const float shared = normal(group.sd * spread.bone_noise);
    for (const int j : group.joints) {
      if (j < 0) continue;
      const float factor = 1 + shared + normal(kOwnStretch * spread.bone_noise);
      if (group.axis == 3) {
        stretch[j] *= factor;
      } else {
        stretch[j][group.axis] *= factor;
      }
    }
  }
  std::array<Vector3f, kLifterPoints> offsets;
  for (Vector3f& o : offsets) o = normals(1) * static_cast<float>(spread.landmark_sd_m);
  LifterPerson person = Build(betas, stretch, offsets);
  const bool biased = random.Uniform() < spread.biased_detector;
  for (int k = 0; k < kLifterPoints; k += k == 0 ? 1 : 2) {
    // Hips are where conventions differ most.
    const double sd = (k == kLifterLeftHip ? 2 : 1) * spread.detector_bias_sd_m;
    const Vector3f bias = normals(sd);
    if (!biased) continue;
    person.detector[k] = k == 0 ? Vector3f(0, bias.y(), bias.z()) : bias;
    if (k > 0) person.detector[k + 1] = Vector3f(-bias.x(), bias.y(), bias.z());
  }
  return person;
}

void LifterBody::Pose(const LifterPerson& person, const Quaternionf* rotations, const Vector3f& trans,
                      PosedPerson* posed) const {
  posed->rotation[0] = rotations[0].toRotationMatrix();
  posed->joint[0] = person.pelvis + trans;
  for (int j = 1; j < kPoseJoints; ++j) {
    const int p = parent_[j];
    posed->joint[j] = posed->joint[p] + posed->rotation[p] * person.offset[j];
    posed->rotation[j].noalias() = posed->rotation[p] * rotations[j].toRotationMatrix();
  }
  for (int k = 0; k < kLifterPoints; ++k) {
    Vector3f x = Vector3f::Zero();
    for (const Bone& bone : bones_[k]) {
      x += posed->rotation[bone.joint] * person.local[bone.column / 3] + bone.weight * posed->joint[bone.joint];
    }
    posed->point[k] = x;
  }
}

void LifterBody::BallBottoms(const LifterPerson& person, const PosedPerson& posed,
                             std::array<Vector3f, kNumBalls>* bottoms) const {
  for (int i = 0; i < kNumBalls; ++i) {
    const Ball& ball = kBalls[i];
    float radius = ball.radius;
    if (radius == kSole) radius = ball.index < kLifterLeftHeel ? toe_radius_ : heel_radius_;
    Vector3f x = ball.kind == Ball::kJoint  ? posed.joint[ball.index]
                 : ball.kind == Ball::kPair ? Vector3f(0.5F * (posed.point[ball.index] + posed.point[ball.index + 1]))
                                            : posed.point[ball.index];
    x.y() -= radius * person.size;
    (*bottoms)[i] = x;
  }
}

float LifterBody::Lowest(const LifterPerson& person, const PosedPerson& posed) const {
  std::array<Vector3f, kNumBalls> bottoms;
  BallBottoms(person, posed, &bottoms);
  float lowest = bottoms[0].y();
  for (const Vector3f& b : bottoms) lowest = std::min(lowest, b.y());
  return lowest;
}

}  // namespace bodyloom
