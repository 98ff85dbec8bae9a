// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/synthesis/people/dressed_person.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/hash_random.h"
#include "bodyloom/geometry/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

BodyPose RestPose(const BodyModel& body) {
  return {std::vector<Matrix3d>(body.num_joints(), Matrix3d::Identity()), Vector3d::Zero()};
}

BodyPose Between(const BodyPose& a, const BodyPose& b, double share) {
  BodyPose pose;
  pose.trans = a.trans + share * (b.trans - a.trans);
  pose.rotations.reserve(a.rotations.size());
  for (size_t j = 0; j < a.rotations.size(); ++j) {
    pose.rotations.push_back(InterpolateRotation(a.rotations[j], b.rotations[j], share));
  }
  return pose;
}

/// Half the way from the middle to the elbows: arms of a T-pose are further out, the trunk is not.
double ArmX(const MatrixX3d& joints) { return 0.5 * (joints(16, 0) + joints(18, 0)); }

}  // namespace

DressedPerson::DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, GarmentKind kind, uint64_t seed)
    : body_(body), skinner_(body), shape_(skinner_.Shape(betas)), outfit_(body, kind, seed) {
  const MatrixX3d bare = BareVertices(RestPose(body));
  const MatrixX3d clothed = Clothed(bare, VertexNormals(bare, body.data().faces));
  obstacles_ = std::make_unique<BodyObstacles>(body, clothed, shape_.rest_joints);
  const LooseGarmentOptions options = LooseGarmentOf(outfit_, shape_.rest_joints, seed);
  if (options.length_m <= 0) return;
  garment_ = CutLooseGarment(clothed, body.data().faces, ArmX(shape_.rest_joints), options);
  // A perfectly regular cone would balance instead of falling into folds.
  HashRandom random(seed, {0x666f6c64});
  for (int v = 0; v < garment_.cloth.num_vertices(); ++v) {
    if (garment_.cloth.mass_kg[v] == 0) continue;
    for (int c = 0; c < 3; ++c) garment_.sewn[v][c] += 0.002 * random.Normal();
  }
}

MatrixX3d DressedPerson::BareVertices(const BodyPose& pose) const {
  MatrixX3d vertices(body_.num_vertices(), 3);
  skinner_.Skin(shape_, {&pose, 1}, {vertices.data(), size_t(vertices.size())});
  return vertices;
}

MatrixX3d DressedPerson::Clothed(const MatrixX3d& bare, const MatrixX3f& normals) const {
  MatrixX3d clothed = bare;
  for (int v = 0; v < clothed.rows(); ++v) {
    if (outfit_.offsets_m()[v] > 0) clothed.row(v) += outfit_.offsets_m()[v] * normals.row(v).cast<double>();
  }
  return clothed;
}

ClothRun::ClothRun(const DressedPerson& person, Motion motion, const ClothRunOptions& options)
    : person_(person), motion_(std::move(motion)), options_(options) {
  CheckMotion(motion_, "ClothRun");
  BODYLOOM_CHECK(motion_.num_frames() > 0, "ClothRun: a motion without frames");
  for (int t = 1; t < motion_.num_frames(); ++t) {
    BODYLOOM_CHECK(motion_.timestamps[t] > motion_.timestamps[t - 1], "ClothRun: timestamp ", t, " is ",
                   motion_.timestamps[t], " s after ", motion_.timestamps[t - 1], " s, expected later");
  }
  BODYLOOM_CHECK(std::abs(options.up.norm() - 1) < 1e-6 && options.tick_s > 0 && options.move_in_s > 0 &&
                     options.settle_s >= 0 && options.cut_speed > 0 && options.cut_pause_s > 0,
                 "ClothRun: up, times and speeds must be positive, up a unit vector");
  if (person.garment().empty()) return;
  options_.cloth.gravity = -9.81 * options.up;
  if (options.has_floor) {
    double low = std::numeric_limits<double>::infinity();
    for (int t = 0; t < motion_.num_frames(); ++t) {
      const PosedSkeleton skeleton = PoseSkeleton(person.body(), person.rest_joints(), PoseAt(t));
      low = std::min(low, (skeleton.joints * options.up).minCoeff());
    }
    constexpr double kSole_m = 0.03;  // feet reach about this far below their joints
    options_.cloth.floor = FloorPlane{(low - kSole_m) * options.up, options.up};
  }
}

BodyPose ClothRun::PoseAt(int t) const {
  return PoseFromAxisAngle(person_.body(), motion_.poses.row(t).transpose(), motion_.trans.row(t).transpose());
}

ClothRun::Place ClothRun::PlaceAt(const BodyPose& pose) {
  const MatrixX3i& faces = person_.body().data().faces;
  const MatrixX3d bare = person_.BareVertices(pose);
  const MatrixX3d clothed = person_.Clothed(bare, bare_normals_.Compute(bare, faces));
  const PosedSkeleton skeleton = PoseSkeleton(person_.body(), person_.rest_joints(), pose);
  return {person_.obstacles().At(clothed, clothed_normals_.Compute(clothed, faces), skeleton.joints),
          PinnedPlaces(person_.garment().pins, clothed, faces)};
}

void ClothRun::MoveTo(const BodyPose& from, const BodyPose& to, double seconds) {
  const int ticks = std::max(1, static_cast<int>(std::ceil(seconds / options_.tick_s - 1e-9)));
  for (int i = 1; i <= ticks; ++i) {
    Place place = PlaceAt(i == ticks ? to : Between(from, to, double(i) / ticks));
    simulation_->Step(seconds / ticks, std::move(place.obstacles), place.pinned);
  }
}

/// The garment as sewn around the body, which then goes from its T-pose to the pose and rests. After a cut too: what a
/// motion has done to the cloth (a fold that caught somewhere) is not carried into another one.
void ClothRun::StartIn(const BodyPose& pose) {
  const LooseGarment& garment = person_.garment();
  BodyPose start = RestPose(person_.body());
  start.rotations[0] = pose.rotations[0], start.trans = pose.trans;
  const Vector3d pelvis = person_.rest_joints().row(0).transpose();
  std::vector<Vector3d> sewn;
  sewn.reserve(garment.sewn.size());
  for (const Vector3d& p : garment.sewn) sewn.push_back(pose.rotations[0] * (p - pelvis) + pelvis + pose.trans);
  Place place = PlaceAt(start);
  if (simulation_) {
    simulation_->Restart(std::move(sewn), std::move(place.obstacles));
  } else {
    simulation_.emplace(garment.cloth, std::move(sewn), std::move(place.obstacles), person_.obstacles().surface_faces(),
                        options_.cloth);
  }
  MoveTo(start, pose, options_.move_in_s);
  if (options_.settle_s > 0) MoveTo(pose, pose, options_.settle_s);
}

bool ClothRun::IsCut(int t) const {
  const MatrixX3d& rest = person_.rest_joints();
  const MatrixX3d before = PoseSkeleton(person_.body(), rest, PoseAt(t - 1)).joints,
                  after = PoseSkeleton(person_.body(), rest, PoseAt(t)).joints;
  const double dt = motion_.timestamps[t] - motion_.timestamps[t - 1];
  return dt >= options_.cut_pause_s * (1 - 1e-9) || (after - before).rowwise().norm().mean() > options_.cut_speed * dt;
}

const std::vector<Vector3d>& ClothRun::Next() {
  BODYLOOM_CHECK(next_ < motion_.num_frames(), "ClothRun: ", motion_.num_frames(), " frames, one more was requested");
  const int t = next_++;
  if (person_.garment().empty()) return none_;
  const BodyPose pose = PoseAt(t);
  if (t > 0 && !IsCut(t)) {
    MoveTo(PoseAt(t - 1), pose, motion_.timestamps[t] - motion_.timestamps[t - 1]);
  } else {
    cuts_ += t > 0;
    StartIn(pose);
  }
  return simulation_->positions();
}

int ClothRun::legs_through() const {
  if (!simulation_ || next_ == 0) return 0;
  return LegsThroughCloth(simulation_->mesh().faces, simulation_->positions(),
                          PoseSkeleton(person_.body(), person_.rest_joints(), PoseAt(next_ - 1)).joints);
}

int LegsThroughCloth(const MatrixX3i& faces, const std::vector<Vector3d>& cloth, const MatrixX3d& joints) {
  int through = 0;
  for (const int hip : {1, 2}) {
    int crossings = 0;
    for (const int from : {hip, hip + 3}) {
      crossings += CrossingsOfSegment(faces, cloth, joints.row(from).transpose(), joints.row(from + 3).transpose());
    }
    through += crossings % 2;
  }
  return through;
}

double LargestDepth(const std::vector<Vector3d>& cloth, const ClothObstacles& obstacles) {
  constexpr double kReach_m = 0.06;
  double deepest = 0;
  for (const Vector3d& p : cloth) {
    Eigen::Index nearest;
    const double distance2 = (obstacles.points.rowwise() - p.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    if (distance2 > kReach_m * kReach_m) continue;
    const Vector3d d = p - obstacles.points.row(nearest).transpose();
    deepest = std::max(deepest, -obstacles.normals.row(nearest).cast<double>().dot(d));
  }
  return deepest;
}

}  // namespace bodyloom
