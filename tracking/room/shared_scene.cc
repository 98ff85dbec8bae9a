// SPDX-License-Identifier: Apache-2.0
#include "tracking/room/shared_scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "render/view/floor.h"
#include "tracking/initialise/support_levels.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kUpFloorDeg = 2;  ///< of the spread of a person's vertical

int TrackedFrames(const TrackSequenceSummary& person) {
  const auto it = person.frames_by_status.find("tracked");
  return it == person.frames_by_status.end() ? 0 : it->second;
}

void JoinFocalLengths(const std::vector<const TrackSequenceSummary*>& people, bool alone, const FocalPrior& prior,
                      SharedScene* scene) {
  std::vector<FocalFit> fits;
  for (const TrackSequenceSummary* person : people) {
    const double sigma = person->focal_log_sigma;
    if (sigma == 0 || (alone && sigma > 0)) {
      scene->focal_px = person->focal_px;
      scene->focal_log_sigma = sigma == 0 || person->focal_fit ? sigma : std::hypot(sigma, kFocalFitLogSigma);
      return;
    }
    if (!(sigma > 0) || !(person->focal_px > 0)) continue;
    fits.push_back(person->focal_fit.value_or(FocalFit{std::log(person->focal_px), sigma}));
  }
  if (fits.empty()) return;
  const FocalFit joined = JoinFocalFits(fits, prior);
  scene->focal_px = std::exp(joined.log_px);
  scene->focal_log_sigma = joined.log_sigma;
}

void JoinVerticals(const std::vector<const TrackSequenceSummary*>& people, SharedScene* scene) {
  Vector3d sum = Vector3d::Zero();
  for (const TrackSequenceSummary* person : people) {
    const GroundSummary& ground = person->ground;
    if (ground.has_up) sum += TrackedFrames(*person) / std::pow(ground.up_spread_deg + kUpFloorDeg, 2) * ground.up;
  }
  scene->has_up = sum.norm() > 0;
  if (!scene->has_up) return;
  scene->ground.up = sum.normalized();
  // The lifter's errors are common to all people: σ of the mean is not smaller than the smallest σ.
  bool given = true;
  for (const TrackSequenceSummary* person : people) {
    if (!person->ground.has_up) continue;
    given = given && person->ground.given;
    scene->ground.up_sigma_deg = std::fmin(scene->ground.up_sigma_deg, person->ground.up_sigma_deg);
  }
  scene->source = given ? WorldSource::kGiven : WorldSource::kVertical;
}

/// Stances of everybody; none of those who are left out. A person who is seen at depth z with one focal length is seen
/// as large at z f'/f with another, f'.
std::vector<StandingPerson> StandingPeople(const std::vector<TrackSequenceSummary>& people, double focal_px) {
  std::vector<StandingPerson> standing(people.size());
  for (size_t i = 0; i < people.size(); ++i) {
    if (!people[i].IsUsable()) continue;
    standing[i].size_known = people[i].stature_m > 0;
    standing[i].stances = people[i].ground.stances;
    if (!(focal_px > 0) || !(people[i].focal_px > 0)) continue;
    for (StandingFoot& stance : standing[i].stances) stance.place_m.z() *= focal_px / people[i].focal_px;
  }
  return standing;
}

void JoinGrounds(const std::vector<TrackSequenceSummary>& people, const CommonGroundOptions& options,
                 SharedScene* scene) {
  const CommonGround common = FindCommonGround(StandingPeople(people, scene->focal_px), scene->ground.up, options);
  scene->why = common.why;
  if (common.found) {
    scene->ground = common.ground;
    if (scene->source != WorldSource::kGiven) scene->source = WorldSource::kPeople;
    scene->size = common.size;
    return;
  }
  // The plane of a single standing person is used unless the others stand elsewhere for longer.
  double total_s = 0, alone_s = 0;
  const GroundSummary* alone = nullptr;
  for (size_t i = 0; i < people.size(); ++i) {
    double seconds = 0;
    for (const StandingFoot& stance : people[i].ground.stances) seconds += stance.seconds;
    if (people[i].IsUsable()) total_s += seconds;
    if (common.stands[i]) alone = &people[i].ground, alone_s = seconds;
  }
  if (alone == nullptr || 2 * alone_s <= total_s) return;
  if (!alone->has_plane) {
    scene->why = alone->why;
    return;
  }
  scene->ground.has_plane = true;
  scene->ground.camera_height_m = alone->camera_height_m;
  scene->ground.height_sigma_m = alone->height_sigma_m;
  if (scene->source != WorldSource::kGiven) scene->source = WorldSource::kGround;
  scene->why = Concatenate("feet of ", alone->contact_frames, " frames stand on it");
}

/// The levels of a track whose world is no longer that of its own fit.
VectorXd LevelsOverWorld(const TrackSequenceResult& person) {
  const Track& track = person.track;
  const GroundSummary& own = person.summary.ground;
  std::map<double, std::vector<double>> heights;  // over the world's ground, by level over the fit's
  for (int t = 0; own.has_plane && t < track.num_frames(); ++t) {
    if (!track.HasResult(t)) continue;
    const Vector3d pelvis = track.joints[static_cast<size_t>(t)].row(0).transpose();
    const double level = track.LevelAt(t), above = own.up.dot(pelvis) + own.camera_height_m - level;
    heights[level].push_back(track.world->PointFromCamera(pelvis - above * own.up).y());
  }
  std::map<double, double> moved;
  for (const auto& [level, over_world] : heights) {
    const double height = Percentile(over_world, 50);
    moved[level] = std::abs(height) < kApartM ? 0 : height;
  }
  VectorXd levels = VectorXd::Zero(track.num_frames());
  for (int t = 0; t < track.num_frames(); ++t) levels[t] = moved[track.LevelAt(t)];
  return levels.isZero(0) ? VectorXd() : levels;
}

}  // namespace

SharedScene JoinScenes(const std::vector<TrackSequenceSummary>& people, const FocalPrior& prior,
                       const CommonGroundOptions& options) {
  std::vector<const TrackSequenceSummary*> usable;
  for (const TrackSequenceSummary& person : people) {
    if (person.IsUsable()) usable.push_back(&person);
  }
  SharedScene scene;
  scene.size.assign(people.size(), 1);
  JoinFocalLengths(usable, people.size() == 1, prior, &scene);
  JoinVerticals(usable, &scene);
  if (scene.has_up) {
    JoinGrounds(people, options, &scene);
  } else {
    scene.why = "the vertical is not clear";
  }
  return scene;
}

WorldFrame WorldOfGround(const GroundSummary& ground, const std::vector<MatrixX3d>& joints) {
  if (!ground.has_up) return AssumedWorld(joints);
  WorldFrame world =
      ground.has_plane ? WorldOverGround(ground.up, ground.camera_height_m) : WorldUnderJoints(ground.up, joints);
  world.source = ground.given ? WorldSource::kGiven : ground.has_plane ? WorldSource::kGround : WorldSource::kVertical;
  world.vertical_sigma_deg = ground.up_sigma_deg;
  world.height_sigma_m = ground.height_sigma_m;
  return world;
}

VectorXd LevelsOverGround(const std::vector<FrameData>& frames, const GroundSummary& ground) {
  VectorXd levels = VectorXd::Zero(static_cast<Eigen::Index>(frames.size()));
  for (size_t t = 0; ground.has_plane && t < frames.size(); ++t) {
    const FrameGround* own = frames[t].ground;
    if (own == nullptr || own->up != ground.up) continue;
    levels[static_cast<Eigen::Index>(t)] = own->level_m + ground.camera_height_m;
  }
  return levels.isZero(0) ? VectorXd() : levels;
}

WorldFrame WorldOfScene(const SharedScene& scene, const std::vector<MatrixX3d>& joints) {
  if (!scene.has_up) return AssumedWorld(joints);
  const KnownGround& ground = scene.ground;
  WorldFrame world =
      ground.has_plane ? WorldOverGround(ground.up, ground.camera_height_m) : WorldUnderJoints(ground.up, joints);
  world.source = scene.source;
  world.vertical_sigma_deg = ground.up_sigma_deg;
  world.height_sigma_m = ground.height_sigma_m;
  return world;
}

void ShareWorld(const SharedScene& scene, std::vector<TrackSequenceResult>* people) {
  std::vector<MatrixX3d> joints;
  for (const TrackSequenceResult& person : *people) {
    joints.insert(joints.end(), person.track.joints.begin(), person.track.joints.end());
  }
  const WorldFrame world = WorldOfScene(scene, joints);
  for (TrackSequenceResult& person : *people) {
    if (!person.summary.IsUsable()) continue;
    person.track.world = world;
    person.track.level_m = scene.ground.has_plane ? LevelsOverWorld(person) : VectorXd();
  }
}

}  // namespace bodyloom
