// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/room_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "data_tools/evaluation/global_errors.h"
#include "data_tools/evaluation/metrics.h"
#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/base/units.h"
#include "geometry/biomechanics/landmark_angles.h"
#include "geometry/math/procrustes.h"
#include "geometry/math/rotation.h"
#include "tracking/initialise/ground_plane.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int kRoomWindow = 100, kRoomFirstFrames = 2;
constexpr double kStandingAnkleMps = 0.1;
constexpr int kNumFacePoints = 5;  // of COCO's landmarks, the first ones

struct Bone {
  const char* name;
  std::array<int, 2> from, to;  ///< two landmarks each, whose middle counts
};
/// COCO: 5, 6 shoulders, 7, 8 elbows, 9, 10 wrists, 11, 12 hips, 13, 14 knees, 15, 16 ankles.
constexpr std::array<Bone, 11> kBones = {{{"left upper arm", {5, 5}, {7, 7}},
                                          {"right upper arm", {6, 6}, {8, 8}},
                                          {"left forearm", {7, 7}, {9, 9}},
                                          {"right forearm", {8, 8}, {10, 10}},
                                          {"left thigh", {11, 11}, {13, 13}},
                                          {"right thigh", {12, 12}, {14, 14}},
                                          {"left shank", {13, 13}, {15, 15}},
                                          {"right shank", {14, 14}, {16, 16}},
                                          {"trunk", {11, 12}, {5, 6}},
                                          {"shoulders", {5, 5}, {6, 6}},
                                          {"hips", {11, 11}, {12, 12}}}};
constexpr int kLimbBones = 8;  // those that set the scale

Vector3d Middle(const MatrixX3d& points, int a, int b) { return 0.5 * (points.row(a) + points.row(b)).transpose(); }

Vector3d Hip(const MatrixX3d& points) { return Middle(points, 11, 12); }

Vector3d Trunk(const MatrixX3d& points) { return Middle(points, 5, 6) - Hip(points); }

double MedianLength(const std::vector<MatrixX3d>& frames, const Bone& bone) {
  std::vector<double> lengths;
  for (const MatrixX3d& points : frames) {
    lengths.push_back((Middle(points, bone.from[0], bone.from[1]) - Middle(points, bone.to[0], bone.to[1])).norm());
  }
  return Percentile(lengths, 50);
}

/// Degrees between two vectors.
double AngleDeg(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0)) / kDegree;
}

double KneeFlexionDeg(const MatrixX3d& points, int side) {
  return FlexionDeg(points.row(11 + side), points.row(13 + side), points.row(15 + side));
}

double LowerAnkle(const MatrixX3d& points) { return std::min(points(15, 1), points(16, 1)); }

/// The rotation about y that minimises Σ ‖Y a_i − b_i‖².
Matrix3d YawBetween(const MatrixX3d& a, const MatrixX3d& b) {
  const double c = a.col(0).dot(b.col(0)) + a.col(2).dot(b.col(2));
  const double s = a.col(2).dot(b.col(0)) - a.col(0).dot(b.col(2));
  return RotationFromAxisAngle(Vector3d(0, std::atan2(s, c), 0));
}

MatrixX3d MovedByYaw(const MatrixX3d& points, const MatrixX3d& fitted, const MatrixX3d& target) {
  const Eigen::RowVector3d centre = fitted.colwise().mean(), to = target.colwise().mean();
  const Matrix3d yaw = YawBetween(fitted.rowwise() - centre, target.rowwise() - to);
  return ((points.rowwise() - centre) * yaw.transpose()).rowwise() + to;
}

/// Frames that both have, the track's scaled.
struct Compared {
  std::vector<MatrixX3d> track, truth;
  std::vector<double> times;
  std::vector<double> levels;  ///< heights over the track's ground, its own size
  std::vector<int> landmarks;  ///< whose places are compared; the others may be NaN
};

/// Landmarks of the face that nine tenths of the frames have, and all from the shoulders down.
std::vector<int> LandmarksOfMost(const std::vector<MatrixX3d>& truth) {
  std::array<int, 17> seen{};
  int frames = 0;
  for (const MatrixX3d& points : truth) {
    if (points.rows() != 17) continue;
    ++frames;
    for (int k = 0; k < 17; ++k) seen[size_t(k)] += points.row(k).allFinite() ? 1 : 0;
  }
  std::vector<int> landmarks;
  for (int k = 0; k < 17; ++k) {
    if (k >= kNumFacePoints || 10 * seen[size_t(k)] >= 9 * frames) landmarks.push_back(k);
  }
  return landmarks;
}

std::vector<MatrixX3d> RowsOf(const std::vector<MatrixX3d>& frames, const std::vector<int>& rows) {
  std::vector<MatrixX3d> chosen;
  for (const MatrixX3d& points : frames) chosen.emplace_back(points(rows, Eigen::all));
  return chosen;
}

Compared FramesOfBoth(const std::vector<MatrixX3d>& track, const std::vector<MatrixX3d>& truth,
                      const std::vector<double>& timestamps, const std::vector<double>& levels) {
  Compared both;
  both.landmarks = LandmarksOfMost(truth);
  const auto known = [&](const MatrixX3d& points) {
    return points.rows() == 17 && points(both.landmarks, Eigen::all).allFinite();
  };
  for (size_t t = 0; t < track.size(); ++t) {
    if (!known(track[t]) || !known(truth[t])) continue;
    both.track.push_back(track[t]);
    both.truth.push_back(truth[t]);
    both.times.push_back(timestamps[t]);
    both.levels.push_back(levels.empty() ? 0 : levels[t]);
  }
  return both;
}

void MeasureBones(Compared* both, RoomErrors* errors) {
  std::vector<double> own, other;
  double sum_own = 0, sum_other = 0;
  for (size_t b = 0; b < kBones.size(); ++b) {
    own.push_back(MedianLength(both->track, kBones[b]));
    other.push_back(MedianLength(both->truth, kBones[b]));
    if (b >= kLimbBones) continue;
    sum_own += own.back();
    sum_other += other.back();
  }
  const double scale = sum_other / sum_own;
  for (size_t b = 0; b < kBones.size(); ++b) {
    errors->bones.emplace_back(kBones[b].name);
    errors->bone_ratio.push_back(scale * own[b] / other[b]);
  }
  for (MatrixX3d& points : both->track) points *= scale;
  for (double& level : both->levels) level *= scale;
}

void MeasurePlaces(const Compared& both, RoomErrors* errors) {
  const size_t T = both.track.size();
  const std::vector<MatrixX3d> track = RowsOf(both.track, both.landmarks), truth = RowsOf(both.truth, both.landmarks);
  std::vector<MatrixX3d> x, g;
  MatrixX3d hips(T, 3), true_hips(T, 3);
  for (size_t t = 0; t < T; ++t) {
    hips.row(static_cast<Eigen::Index>(t)) = Hip(both.track[t]).transpose();
    true_hips.row(static_cast<Eigen::Index>(t)) = Hip(both.truth[t]).transpose();
    x.emplace_back(track[t].rowwise() - Hip(both.track[t]).transpose());
    g.emplace_back(truth[t].rowwise() - Hip(both.truth[t]).transpose());
  }
  const MatrixX3d all_x = StackedFrames(x), all_g = StackedFrames(g);
  const Matrix3d yaw = YawBetween(all_x, all_g);
  errors->g_mpjpe_m = (all_x * yaw.transpose() - all_g).rowwise().norm().mean();
  errors->w_mpjpe_m = WindowError(track, truth, kRoomFirstFrames, MovedByYaw);
  errors->wa_mpjpe_m = WindowError(track, truth, kRoomWindow, MovedByYaw);
  const GlobalErrors global = MeasureGlobalErrors(track, truth, hips, true_hips);
  errors->w_mpjpe_100_m = global.w_mpjpe_100_m;
  errors->wa_mpjpe_100_m = global.wa_mpjpe_100_m;
  errors->rte = global.rte;

  double trunk = 0, lean = 0;
  for (size_t t = 0; t < T; ++t) {
    const Vector3d own = yaw * Trunk(both.track[t]), other = Trunk(both.truth[t]);
    trunk += AngleDeg(own, other);
    lean += AngleDeg(own, Vector3d::UnitY()) - AngleDeg(other, Vector3d::UnitY());
  }
  errors->trunk_err_deg = trunk / static_cast<double>(T);
  errors->trunk_lean_bias_deg = lean / static_cast<double>(T);
}

void MeasureLegs(const Compared& both, RoomErrors* errors) {
  const size_t T = both.track.size();
  std::vector<double> differences;
  std::map<double, std::vector<double>> true_heights;  // by level
  for (size_t t = 0; t < T; ++t) true_heights[both.levels[t]].push_back(LowerAnkle(both.truth[t]));
  std::map<double, double> floors;
  for (const auto& [level, heights] : true_heights) floors[level] = Percentile(heights, 2);
  double height = 0, knee = 0, knee_bias = 0, slide = 0;
  int standing = 0;
  for (size_t t = 0; t < T; ++t) {
    const double level = both.levels[t];
    differences.push_back(LowerAnkle(both.track[t]) - level - kAnkleHeight -
                          (LowerAnkle(both.truth[t]) - floors.at(level)));
    height += std::abs(differences.back());
    for (const int side : {0, 1}) {
      const double difference = KneeFlexionDeg(both.track[t], side) - KneeFlexionDeg(both.truth[t], side);
      knee += std::abs(difference) / 2;
      knee_bias += difference / 2;
      if (t == 0) continue;
      const double seconds = both.times[t] - both.times[t - 1];
      const auto step = [&](const std::vector<MatrixX3d>& clip) {
        return Vector3d((clip[t].row(15 + side) - clip[t - 1].row(15 + side)).transpose() / seconds);
      };
      if (step(both.truth).norm() >= kStandingAnkleMps) continue;
      const Vector3d own = step(both.track);
      slide += std::hypot(own.x(), own.z());
      ++standing;
    }
  }
  const auto count = static_cast<double>(T);
  errors->ankle_height_err_m = height / count;
  errors->ankle_height_bias_m = Percentile(differences, 50);
  errors->knee_err_deg = knee / count;
  errors->knee_bias_deg = knee_bias / count;
  errors->foot_slide_mps = standing > 0 ? slide / standing : kNotMeasured;
}

}  // namespace

RoomErrors MeasureRoomErrors(const std::vector<MatrixX3d>& track, const std::vector<MatrixX3d>& truth,
                             const std::vector<double>& timestamps, const std::vector<double>& levels) {
  BODYLOOM_CHECK(levels.empty() || levels.size() == track.size(), "room errors: ", levels.size(), " levels of ",
                 track.size(), " frames");
  BODYLOOM_CHECK(track.size() == truth.size() && track.size() == timestamps.size(), "room errors: ", track.size(),
                 " frames of the track, ", truth.size(), " of the truth, ", timestamps.size(), " timestamps");
  constexpr double kNone = kNotMeasured;
  RoomErrors errors{0,     kNone, kNone, kNone, kNone, kNone, kNone, kNone,
                    kNone, kNone, kNone, kNone, kNone, kNone, {},    {}};
  Compared both = FramesOfBoth(track, truth, timestamps, levels);
  errors.frames = static_cast<int>(both.track.size());
  if (errors.frames < 2) return errors;
  MeasureBones(&both, &errors);
  MeasurePlaces(both, &errors);
  MeasureLegs(both, &errors);
  return errors;
}

std::vector<MatrixX3d> LandmarksInWorld(const Track& track) {
  std::vector<MatrixX3d> landmarks;
  if (!track.world) return landmarks;
  for (const MatrixX3d& points : track.coco17) landmarks.push_back(track.world->PointsFromCamera(points));
  return landmarks;
}

void AddRoomErrors(const Track& track, const std::vector<MatrixX3d>& truth_in_camera, const Vector3d& up_in_camera,
                   const std::vector<double>& timestamps, Evaluation* evaluation) {
  std::vector<MatrixX3d> landmarks = LandmarksInWorld(track);
  if (landmarks.empty()) return;
  landmarks.resize(truth_in_camera.size());
  const WorldFrame level = WorldOverGround(up_in_camera, 0);
  std::vector<MatrixX3d> truth;
  for (const MatrixX3d& points : truth_in_camera) truth.push_back(level.PointsFromCamera(points));
  std::vector<double> levels;
  if (track.level_m.size() > 0) {
    levels.assign(track.level_m.data(), track.level_m.data() + track.level_m.size());
    levels.resize(truth.size());
  }
  const RoomErrors e = MeasureRoomErrors(landmarks, truth, timestamps, levels);
  const auto add = [&](const char* name, double value, const char* meaning) { evaluation->Add(name, value, meaning); };
  const double mm = kMmPerMetre;
  add("room_g_mpjpe_mm", mm * e.g_mpjpe_m, "landmark error with the stated vertical, mid-hip aligned, one yaw");
  add("room_w_mpjpe_mm", mm * e.w_mpjpe_m, "in the room, 100 frames placed by their first two");
  add("room_wa_mpjpe_mm", mm * e.wa_mpjpe_m, "in the room, 100 frames placed by all of them");
  add("w_mpjpe_100_mm", mm * e.w_mpjpe_100_m, "100 frames after a similarity of their first two (EMDB)");
  add("wa_mpjpe_100_mm", mm * e.wa_mpjpe_100_m, "100 frames after a similarity of all of them (EMDB)");
  add("rte_percent", 100 * e.rte, "mid-hip error after a rigid motion / length of its path (EMDB)");
  add("tilt_deg", AngleDeg(track.world->up_in_camera(), up_in_camera), "angle of the stated vertical to the true one");
  add("ankle_height_err_mm", mm * e.ankle_height_err_m, "height of the lower ankle over the ground");
  add("ankle_height_bias_mm", mm * e.ankle_height_bias_m, "its median, above 0: hovers");
  add("knee_err_deg", e.knee_err_deg, "flexion of the knees");
  add("knee_bias_deg", e.knee_bias_deg, "its mean, above 0: bent too much");
  add("trunk_err_deg", e.trunk_err_deg, "direction of the trunk");
  add("trunk_lean_bias_deg", e.trunk_lean_bias_deg, "lean of the trunk, above 0: leans too much");
  add("foot_slide_mps", e.foot_slide_mps, "speed along the ground of ankles that truly stand, m/s");
  evaluation->breakdowns.push_back({"bone_ratio", e.bones, e.bone_ratio});
}

}  // namespace bodyloom
