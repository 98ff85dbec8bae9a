// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/body_estimate.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double FocalOf(const Camera& camera) { return std::sqrt(camera.fx * camera.fy); }

int FrameOf(const PersonEstimate& person, size_t i, int num_frames) {
  const int t = person.frames[i];
  BODYLOOM_CHECK(t >= 0 && t < num_frames, "frame ", t, " of an estimate, expected 0 to ", num_frames - 1);
  return t;
}

/// A pelvis and what turns with it, in another camera than the one it was seen in.
struct Placed {
  Vector3d pelvis;
  Eigen::Matrix3d turn;
};

std::optional<Placed> PlaceIn(const Camera& camera, const std::optional<PelvisInImage>& seen) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole, "an estimate can be brought into a pinhole camera only");
  if (!seen) return std::nullopt;
  const Vector2d ray = camera.Unproject(seen->pixel);
  if (!ray.allFinite()) return std::nullopt;
  return Placed{FocalOf(camera) / seen->px_per_metre * Vector3d(ray.x(), ray.y(), 1),
                RotationBetweenDirections(Vector3d(seen->ray.x(), seen->ray.y(), 1).normalized(),
                                          Vector3d(ray.x(), ray.y(), 1).normalized())};
}

/// Pelvis position by frame t's landmarks, and the reach around it.
struct SeenPelvis {
  Vector2d pixel = Vector2d::Zero();
  double reach_m = 0;
};

std::optional<SeenPelvis> PelvisAmong(const KeypointSequence& keypoints, int t, int left, int right) {
  constexpr double kHipsReach_m = 0.35, kMiddleReach_m = 0.8;
  constexpr float kSeen = 0.3F;
  const auto pixel = [&](int k) { return Vector2d(keypoints.at(t, k).x, keypoints.at(t, k).y); };
  if (std::max(left, right) < keypoints.num_points() && keypoints.at(t, left).confidence >= kSeen &&
      keypoints.at(t, right).confidence >= kSeen) {
    return SeenPelvis{0.5 * (pixel(left) + pixel(right)), kHipsReach_m};
  }
  SeenPelvis middle{Vector2d::Zero(), kMiddleReach_m};
  int seen = 0;
  for (int k = 0; k < keypoints.num_points(); ++k) {
    if (!(keypoints.at(t, k).confidence >= kSeen)) continue;
    middle.pixel += pixel(k);
    ++seen;
  }
  if (seen == 0) return std::nullopt;
  middle.pixel /= seen;
  return middle;
}

/// Names of PersonEstimate::landmarks.
std::vector<std::string> EstimateLandmarkNames() {
  std::vector<std::string> names = CocoNames();
  names.insert(names.end(), {"left_big_toe", "right_big_toe", "left_heel", "right_heel"});
  return names;
}

/// A frame's skeleton moved onto the rays of the detections.
struct SkeletonOnRays {
  Vector3d moved;
  double off_m = 0;
};

std::optional<SkeletonOnRays> OnRays(const MatrixX3d& landmarks, const KeypointSequence& keypoints, int t,
                                     const std::vector<int>& columns, const Camera& camera) {
  constexpr float kSeen = 0.3F;
  constexpr size_t kFewest = 5;
  std::vector<std::pair<Eigen::Index, Vector2d>> rays;
  for (size_t k = 0; k < columns.size(); ++k) {
    if (columns[k] < 0 || !(keypoints.at(t, columns[k]).confidence >= kSeen)) continue;
    const Keypoint& point = keypoints.at(t, columns[k]);
    const Vector2d ray = camera.Unproject({point.x, point.y});
    if (ray.allFinite()) rays.emplace_back(Eigen::Index(k), ray);
  }
  if (rays.size() < kFewest) return std::nullopt;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * Eigen::Index(rays.size()), 3);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index i = 0; i < Eigen::Index(rays.size()); ++i) {
    const auto& [k, ray] = rays[size_t(i)];
    A.block<2, 2>(2 * i, 0).setIdentity();
    A.block<2, 1>(2 * i, 2) = -ray;
    b.segment<2>(2 * i) = landmarks(k, 2) * ray - landmarks.row(k).head<2>().transpose();
  }
  const Eigen::VectorXd t_xyz = A.colPivHouseholderQr().solve(b);
  if (!t_xyz.allFinite() || !(t_xyz[2] + landmarks.col(2).minCoeff() > Camera::kMinDepth)) return std::nullopt;
  return SkeletonOnRays{t_xyz, (A * t_xyz - b).norm() / std::sqrt(double(rays.size()))};
}

}  // namespace

void PlaceByDetections(const KeypointSequence& keypoints, const Camera& camera, const std::string& where,
                       BodyEstimate* estimate) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole, "landmarks can be placed in a pinhole camera only");
  constexpr double kMaxOff_m = 0.2;
  std::vector<int> columns;
  for (const std::string& name : EstimateLandmarkNames()) {
    const auto found = std::find(keypoints.names.begin(), keypoints.names.end(), name);
    columns.push_back(found == keypoints.names.end() ? -1 : int(found - keypoints.names.begin()));
  }
  std::map<int, std::pair<double, PersonEstimate>> nearest;  // by frame; of one frame each
  for (const PersonEstimate& person : estimate->people) {
    for (size_t i = 0; i < person.frames.size(); ++i) {
      const int t = person.frames[i];
      if (t >= keypoints.num_frames()) continue;
      const std::optional<SkeletonOnRays> placed = OnRays(person.landmarks[i], keypoints, t, columns, camera);
      if (!placed || placed->off_m > kMaxOff_m) continue;
      const auto known = nearest.find(t);
      if (known != nearest.end() && known->second.first <= placed->off_m) continue;
      PersonEstimate one;
      one.trans = placed->moved.transpose();
      one.landmarks = {person.landmarks[i]};
      nearest[t] = {placed->off_m, one};
    }
  }
  if (nearest.empty()) {
    ThrowFileError(where, estimate->system +
                              ": in no frame anybody stands as the detections do; are both of the same "
                              "video, frame for frame?");
  }
  PersonEstimate person;
  person.name = "0";
  const auto n = static_cast<Eigen::Index>(nearest.size());
  person.trans.resize(n, 3);
  person.poses.resize(n, 0);
  for (const auto& [t, found] : nearest) {
    person.trans.row(Eigen::Index(person.frames.size())) = found.second.trans.row(0);
    person.frames.push_back(t);
    person.landmarks.push_back(found.second.landmarks[0]);
  }
  person.cameras.assign(person.frames.size(), camera);
  estimate->people = {person};
  estimate->has_places = true;
}

std::optional<PelvisInImage> PelvisOf(const PersonEstimate& person, size_t i, const Vector3d& rest_pelvis) {
  const Camera& camera = person.cameras[i];
  const Vector3d pelvis = rest_pelvis + person.trans.row(static_cast<Eigen::Index>(i)).transpose();
  PelvisInImage seen;
  if (!camera.Project(pelvis, &seen.pixel)) return std::nullopt;
  if (camera.model == CameraModel::kWeakPerspective) {
    seen.px_per_metre = camera.scale;
  } else {
    seen.px_per_metre = FocalOf(camera) / pelvis.z();
    seen.ray = pelvis.head<2>() / pelvis.z();
  }
  if (!seen.pixel.allFinite() || !(seen.px_per_metre > 0) || !std::isfinite(seen.px_per_metre)) return std::nullopt;
  return seen;
}

Motion EstimateInCamera(const PersonEstimate& person, const Camera& camera, int num_frames,
                        const Vector3d& estimate_pelvis, const Vector3d& pelvis) {
  Motion motion;
  motion.body = "smpl";
  motion.up = Motion::Up::kCamera;
  motion.betas = person.betas;
  motion.poses.setConstant(num_frames, 72, std::numeric_limits<double>::quiet_NaN());
  motion.trans.setConstant(num_frames, 3, std::numeric_limits<double>::quiet_NaN());
  for (size_t i = 0; i < person.frames.size(); ++i) {
    const int t = FrameOf(person, i, num_frames);
    const std::optional<Placed> placed = PlaceIn(camera, PelvisOf(person, i, estimate_pelvis));
    if (!placed) continue;
    const auto pose = person.poses.row(static_cast<Eigen::Index>(i));
    motion.poses.row(t) = pose;
    motion.poses.row(t).head<3>() =
        AxisAngleFromRotation(placed->turn * RotationFromAxisAngle(pose.head<3>().transpose())).transpose();
    motion.trans.row(t) = (placed->pelvis - pelvis).transpose();
  }
  return motion;
}

std::vector<MatrixX3d> LandmarksInCamera(const PersonEstimate& person, const Camera& camera, int num_frames) {
  std::vector<MatrixX3d> frames(static_cast<size_t>(num_frames), MatrixX3d(0, 3));
  for (size_t i = 0; i < person.landmarks.size(); ++i) {
    const int t = FrameOf(person, i, num_frames);
    const std::optional<Placed> placed = PlaceIn(camera, PelvisOf(person, i, Vector3d::Zero()));
    if (!placed) continue;
    frames[static_cast<size_t>(t)] =
        (person.landmarks[i] * placed->turn.transpose()).rowwise() + placed->pelvis.transpose();
  }
  return frames;
}

int PersonSeenAs(const BodyEstimate& estimate, const KeypointSequence& keypoints) {
  const auto column = [&](const char* name) {
    return static_cast<int>(std::find(keypoints.names.begin(), keypoints.names.end(), name) - keypoints.names.begin());
  };
  const int left = column("left_hip"), right = column("right_hip");
  int best = -1;
  double maximum = 0;
  for (size_t p = 0; p < estimate.people.size(); ++p) {
    const PersonEstimate& person = estimate.people[p];
    double score = 0;
    for (size_t i = 0; i < person.frames.size(); ++i) {
      if (person.frames[i] >= keypoints.num_frames()) continue;
      const std::optional<SeenPelvis> where = PelvisAmong(keypoints, person.frames[i], left, right);
      const std::optional<PelvisInImage> seen = PelvisOf(person, i, estimate.rest_pelvis);
      if (!where || !seen) continue;
      score += std::max(0.0, 1 - (seen->pixel - where->pixel).norm() / (where->reach_m * seen->px_per_metre));
    }
    if (score > maximum) {
      maximum = score;
      best = static_cast<int>(p);
    }
  }
  return best;
}

}  // namespace bodyloom
