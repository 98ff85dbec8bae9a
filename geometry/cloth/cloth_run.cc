// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/cloth/cloth_simulation.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/track.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

BodyPose Between(const BodyPose& a, const BodyPose& b, double share) {
  BodyPose pose;
  pose.trans = a.trans + share * (b.trans - a.trans);
  pose.rotations.reserve(a.rotations.size());
  for (size_t j = 0; j < a.rotations.size(); ++j) {
    pose.rotations.push_back(InterpolateRotation(a.rotations[j], b.rotations[j], share));
  }
  return pose;
}

}  // namespace

ClothRun::ClothRun(const ClothCollisionBody& wearer, Motion motion, const ClothRunOptions& options)
    : wearer_(wearer),
      motion_(std::move(motion)),
      options_(options),
      bare_normals_(wearer.mesh_normals()),
      clothed_normals_(wearer.mesh_normals()) {
  CheckMotion(motion_, "ClothRun");
  BODYLOOM_CHECK(motion_.num_frames() > 0, "ClothRun: a motion without frames");
  for (int t = 1; t < motion_.num_frames(); ++t) {
    BODYLOOM_CHECK(motion_.timestamps[t] > motion_.timestamps[t - 1], "ClothRun: timestamp ", t, " is ",
                   motion_.timestamps[t], " s after ", motion_.timestamps[t - 1], " s, expected later");
  }
  BODYLOOM_CHECK(std::abs(options.up.norm() - 1) < 1e-6 && options.tick_s > 0 && options.move_in_s > 0 &&
                     options.settle_s >= 0 && options.cut_speed > 0 && options.cut_pause_s > 0,
                 "ClothRun: up, times and speeds must be positive, up a unit vector");
  BODYLOOM_CHECK(options.rest_damping.value_or(0) >= 0 && std::isfinite(options.rest_damping.value_or(0)),
                 "ClothRun: rest_damping ", *options.rest_damping, ", expected 0 or more");
  if (wearer.garment().empty()) return;
  options_.cloth.gravity = -9.81 * options.up;
  if (options.has_floor) {
    double low = std::numeric_limits<double>::infinity();
    for (int t = 0; t < motion_.num_frames(); ++t) {
      const PosedSkeleton skeleton = PoseSkeleton(wearer.body(), wearer.rest_joints(), PoseAt(t));
      low = std::min(low, (skeleton.joints * options.up).minCoeff());
    }
    constexpr double kSole_m = 0.03;  // feet reach about this far below their joints
    options_.cloth.floor = FloorPlane{(low - kSole_m) * options.up, options.up};
  }
}

BodyPose ClothRun::PoseAt(int t) const {
  return PoseFromAxisAngle(wearer_.body(), motion_.poses.row(t).transpose(), motion_.trans.row(t).transpose());
}

ClothRun::Place ClothRun::PlaceAt(const BodyPose& pose) {
  const MatrixX3i& faces = wearer_.body().data().faces;
  MatrixX3d clothed = wearer_.BareVertices(pose);
  if (wearer_.has_offsets()) clothed = wearer_.Clothed(clothed, bare_normals_.Compute(clothed, faces));
  const PosedSkeleton skeleton = PoseSkeleton(wearer_.body(), wearer_.rest_joints(), pose);
  return {wearer_.obstacles().At(clothed, clothed_normals_.Compute(clothed, faces), skeleton.joints),
          PinnedPlaces(wearer_.garment().pins, clothed, faces)};
}

int ClothRun::NumTicks(double seconds) const {
  return std::max(1, static_cast<int>(std::ceil(seconds / options_.tick_s - 1e-9)));
}

void ClothRun::MoveTo(const BodyPose& from, const BodyPose& to, double seconds) {
  const int ticks = NumTicks(seconds);
  for (int i = 1; i <= ticks; ++i) {
    Place place = PlaceAt(i == ticks ? to : Between(from, to, double(i) / ticks));
    simulation_->Step(seconds / ticks, std::move(place.obstacles), place.pinned);
  }
}

void ClothRun::Rest(const BodyPose& pose, double seconds) {
  const int ticks = NumTicks(seconds);
  const Place place = PlaceAt(pose);
  for (int i = 0; i < ticks; ++i) simulation_->Step(seconds / ticks, place.obstacles, place.pinned);
}

/// The garment as sewn around the body, which then goes from its T-pose to the pose and rests. After a cut too: what a
/// motion has done to the cloth (a fold that caught somewhere) is not carried into another one.
void ClothRun::StartIn(const BodyPose& pose) {
  const LooseGarment& garment = wearer_.garment();
  BodyPose start = RestPose(wearer_.body());
  start.rotations[0] = pose.rotations[0], start.trans = pose.trans;
  const Vector3d pelvis = wearer_.rest_joints().row(0).transpose();
  std::vector<Vector3d> sewn;
  sewn.reserve(garment.sewn.size());
  for (const Vector3d& p : garment.sewn) sewn.push_back(pose.rotations[0] * (p - pelvis) + pelvis + pose.trans);
  Place place = PlaceAt(start);
  if (simulation_) {
    simulation_->Restart(std::move(sewn), std::move(place.obstacles));
  } else {
    simulation_.emplace(garment.cloth, std::move(sewn), std::move(place.obstacles), wearer_.obstacles().surface_faces(),
                        options_.cloth);
  }
  simulation_->set_damping(options_.rest_damping.value_or(options_.cloth.damping));
  MoveTo(start, pose, options_.move_in_s);
  if (options_.settle_s > 0) Rest(pose, options_.settle_s);
  simulation_->set_damping(options_.cloth.damping);
}

bool ClothRun::IsCut(int t) const {
  const MatrixX3d& rest = wearer_.rest_joints();
  const MatrixX3d before = PoseSkeleton(wearer_.body(), rest, PoseAt(t - 1)).joints,
                  after = PoseSkeleton(wearer_.body(), rest, PoseAt(t)).joints;
  const double dt = motion_.timestamps[t] - motion_.timestamps[t - 1];
  return dt >= options_.cut_pause_s * (1 - 1e-9) || (after - before).rowwise().norm().mean() > options_.cut_speed * dt;
}

const std::vector<Vector3d>& ClothRun::Next() {
  BODYLOOM_CHECK(next_ < motion_.num_frames(), "ClothRun: ", motion_.num_frames(), " frames, one more was requested");
  const int t = next_++;
  if (wearer_.garment().empty()) return none_;
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
                          PoseSkeleton(wearer_.body(), wearer_.rest_joints(), PoseAt(next_ - 1)).joints);
}

namespace {

/// Of ln of a value: friction and, the other way, damping; air density.
constexpr double kApart[kMaxClothRuns][2] = {{0, 0}, {0.1, 0.1}, {-0.1, -0.1}, {0.1, -0.1}, {-0.1, 0.1}};

}  // namespace

ClothOptions PerturbedOptions(ClothOptions options, int run) {
  BODYLOOM_CHECK(run >= 0 && run < kMaxClothRuns, "cloth: run ", run, ", expected 0 to ", kMaxClothRuns - 1);
  options.friction *= std::exp(kApart[run][0]);
  options.damping *= std::exp(-kApart[run][0]);
  options.air_density *= std::exp(kApart[run][1]);
  return options;
}

}  // namespace bodyloom
