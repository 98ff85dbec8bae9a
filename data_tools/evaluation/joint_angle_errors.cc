// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/joint_angle_errors.h"

#include <cmath>
#include <span>
#include <utility>

#include "data_tools/evaluation/metrics.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/biomechanics/landmark_angles.h"
#include "geometry/biomechanics/track_angles.h"

namespace bodyloom {

using Eigen::Vector3d;

namespace {

constexpr double kUndetermined_deg = 30;  // from 90° of adduction

struct CoordinateGroup {
  const char* name;
  bool in_gait;
  std::vector<std::string> coordinates;
};

const std::vector<CoordinateGroup>& CoordinateGroups() {
  static const std::vector<CoordinateGroup> groups = {
      {"pelvis", true, {"pelvis_tilt", "pelvis_list", "pelvis_rotation"}},
      {"hips",
       true,
       {"hip_flexion_r", "hip_adduction_r", "hip_rotation_r", "hip_flexion_l", "hip_adduction_l", "hip_rotation_l"}},
      {"knees", true, {"knee_angle_r", "knee_angle_l"}},
      {"ankles", true, {"ankle_angle_r", "ankle_angle_l"}},
      {"lumbar", true, {"lumbar_extension", "lumbar_bending", "lumbar_rotation"}},
      {"arms", false, {"arm_flex_r", "arm_add_r", "arm_rot_r", "arm_flex_l", "arm_add_l", "arm_rot_l"}},
      {"elbows", false, {"elbow_flex_r", "elbow_flex_l"}}};
  return groups;
}

double WrappedDeg(double degrees) { return degrees - 360 * std::round(degrees / 360); }

/// Mean that leaves out what is not finite.
double MeanOfKnown(const std::vector<double>& values) { return Summarize(values).mean; }

RowMatrixXd RowsOf(const RowMatrixXd& values, const std::vector<int>& rows) {
  RowMatrixXd result(static_cast<Eigen::Index>(rows.size()), values.cols());
  for (size_t t = 0; t < rows.size(); ++t) result.row(static_cast<Eigen::Index>(t)) = values.row(rows[t]);
  return result;
}

EvaluationBreakdown BreakdownOf(const std::string& name, const std::vector<std::string>& labels,
                                const Eigen::VectorXd& values) {
  return {name, labels, {values.data(), values.data() + values.size()}};
}

RowMatrixXd AnglesOfLandmarks(const std::vector<MatrixX3d>& clip) {
  RowMatrixXd angles(static_cast<Eigen::Index>(clip.size()), kNumLandmarkAngles);
  for (size_t t = 0; t < clip.size(); ++t) angles.row(static_cast<Eigen::Index>(t)) = LandmarkAngles(clip[t]);
  return angles;
}

}  // namespace

AngleErrors CompareAngles(const RowMatrixXd& track, const RowMatrixXd& truth) {
  BODYLOOM_CHECK(track.rows() == truth.rows() && track.cols() == truth.cols(), "angles: ", track.rows(), "x",
                 track.cols(), " of the track, ", truth.rows(), "x", truth.cols(), " of the truth");
  AngleErrors errors;
  errors.mean_abs_deg.resize(track.cols());
  errors.bias_deg.resize(track.cols());
  for (Eigen::Index c = 0; c < track.cols(); ++c) {
    std::vector<double> differences, sizes;
    for (Eigen::Index t = 0; t < track.rows(); ++t) {
      differences.push_back(WrappedDeg(track(t, c) - truth(t, c)));
      sizes.push_back(std::abs(differences.back()));
    }
    errors.mean_abs_deg[c] = MeanOfKnown(sizes);
    errors.bias_deg[c] = MeanOfKnown(differences);
  }
  return errors;
}

RowMatrixXd NearestTriples(const RowMatrixXd& track, const RowMatrixXd& truth) {
  RowMatrixXd nearest = track;
  for (const char* first : {"hip_flexion_r", "hip_flexion_l", "lumbar_extension", "arm_flex_r", "arm_flex_l"}) {
    const int c = FindCoordinate(first);
    const bool is_arm = std::string(first).starts_with("arm");
    for (Eigen::Index t = 0; t < track.rows(); ++t) {
      const Vector3d own = track.row(t).segment<3>(c).transpose(), other(own.x() + 180, 180 - own.y(), own.z() + 180);
      const Vector3d truly = truth.row(t).segment<3>(c).transpose();
      const auto distance = [&](const Vector3d& triple) {
        return (triple - truly).unaryExpr(&WrappedDeg).squaredNorm();
      };
      if (distance(other) < distance(own)) nearest.row(t).segment<3>(c) = other.transpose();
      if (is_arm && std::abs(std::cos(truly.y() * kDegree)) < std::sin(kUndetermined_deg * kDegree)) {
        nearest(t, c) = nearest(t, c + 2) = kNotMeasured;
      }
    }
  }
  return nearest;
}

void AddCoordinateErrors(const Track& track, const std::vector<int>& source, const Track& truth, const BodyModel& body,
                         const WorldFrame& true_world, Evaluation* evaluation) {
  if (!HasJointAngles(body)) return;
  const RowMatrixXd own = RowsOf(AnglesOfTrack(body, track, track.world.value_or(true_world)).values, source);
  const RowMatrixXd truly =
      AnglesOfTrack(body, truth, true_world).values.topRows(static_cast<Eigen::Index>(source.size()));
  const AngleErrors errors = CompareAngles(NearestTriples(own, truly), truly);
  std::vector<double> gait, arms;
  EvaluationBreakdown groups{"coordinate_group_err_deg", {}, {}}, each{"coordinate_err_deg", {}, {}},
      bias{"coordinate_bias_deg", {}, {}};
  for (const CoordinateGroup& group : CoordinateGroups()) {
    std::vector<double> values;
    for (const std::string& name : group.coordinates) values.push_back(errors.mean_abs_deg[FindCoordinate(name)]);
    groups.labels.emplace_back(group.name);
    groups.values.push_back(MeanOfKnown(values));
    std::vector<double>& all = group.in_gait ? gait : arms;
    all.insert(all.end(), values.begin(), values.end());
  }
  for (int c = 0; c < kNumCoordinates; ++c) {
    if (!IsAngle(c)) continue;
    each.labels.push_back(CoordinateNames()[size_t(c)]);
    each.values.push_back(errors.mean_abs_deg[c]);
    bias.labels.push_back(CoordinateNames()[size_t(c)]);
    bias.values.push_back(errors.bias_deg[c]);
  }
  evaluation->Add("gait_angle_err_deg", MeanOfKnown(gait),
                  "OpenSim's coordinates of pelvis, hips, knees, ankles and lumbar, mean absolute");
  evaluation->Add("arm_angle_err_deg", MeanOfKnown(arms), "of arms and elbows");
  evaluation->breakdowns.push_back(std::move(groups));
  evaluation->breakdowns.push_back(std::move(each));
  evaluation->breakdowns.push_back(std::move(bias));
}

void AddLandmarkAngleErrors(const std::vector<MatrixX3d>& track, const std::vector<MatrixX3d>& truth,
                            Evaluation* evaluation) {
  const AngleErrors errors = CompareAngles(AnglesOfLandmarks(track), AnglesOfLandmarks(truth));
  const std::span<const double> all(errors.mean_abs_deg.data(), size_t(errors.mean_abs_deg.size()));
  evaluation->Add("landmark_angle_err_deg", Summarize(all).mean,
                  "angles between COCO's landmarks at hips, knees, trunk, arms and elbows, mean absolute");
  evaluation->breakdowns.push_back(BreakdownOf("landmark_angle_err_deg", LandmarkAngleNames(), errors.mean_abs_deg));
  evaluation->breakdowns.push_back(BreakdownOf("landmark_angle_bias_deg", LandmarkAngleNames(), errors.bias_deg));
}

}  // namespace bodyloom
