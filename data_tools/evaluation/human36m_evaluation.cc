// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/human36m_evaluation.h"

#include <algorithm>
#include <array>
#include <limits>

#include "data_tools/evaluation/global_errors.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/formats/npz.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom {
namespace {

constexpr int kHuman36mJoints = 17, kHeadTop = 10;
/// SMPL's joints in the places of Human3.6M's; −1: none.
constexpr std::array<int, kHuman36mJoints> kSmplOfHuman36m = {-1, 2,  5,  8,  1,  4,  7,  -1, 12,
                                                              -1, -1, 16, 18, 20, 17, 19, 21};
constexpr std::array<int, 14> kLsp14 = {1, 2, 3, 4, 5, 6, 8, 10, 11, 12, 13, 14, 15, 16};

std::vector<MatrixX3d> Chosen(const std::vector<MatrixX3d>& joints, const std::vector<int>& columns) {
  std::vector<MatrixX3d> chosen;
  for (const MatrixX3d& frame : joints) {
    MatrixX3d points(Eigen::Index(columns.size()), 3);
    for (size_t k = 0; k < columns.size(); ++k) points.row(Eigen::Index(k)) = frame.row(columns[k]);
    chosen.push_back(std::move(points));
  }
  return chosen;
}

std::vector<int> Lsp14() { return {kLsp14.begin(), kLsp14.end()}; }

/// Joints without alignment and moved root onto root, of prediction and truth.
struct JointSets {
  std::vector<MatrixX3d> joints, truth, relative, true_relative;
};

JointSets SetsOf(const std::vector<MatrixX3d>& joints, const std::vector<MatrixX3d>& truth,
                 const std::vector<int>& columns) {
  return {Chosen(joints, columns), Chosen(truth, columns),
          Chosen(RelativeTo(joints, RootPositions(joints, {0})), columns),
          Chosen(RelativeTo(truth, RootPositions(truth, {0})), columns)};
}

}  // namespace

RowMatrixXd ReadJointRegressor(const std::string& path, const BodyModel& body) {
  constexpr double kMaxOff = 1e-3;
  const NdArray array = ReadNpy(path);
  const bool is_table = array.is_number() && array.shape.size() == 2 && array.shape[0] == kHuman36mJoints;
  if (!is_table || array.shape[1] != body.num_vertices()) {
    ThrowFileError(path, Concatenate(array.ShapeText(), ", expected 17x", body.num_vertices(), ", the vertices of '",
                                     body.name(), "'"));
  }
  RowMatrixXd regressor = array.ToMatrix();
  for (Eigen::Index j = 0; j < regressor.rows(); ++j) {
    const double sum = regressor.row(j).sum();
    if (!(std::abs(sum - 1) < kMaxOff))
      ThrowFileError(path, Concatenate("row ", j, " has the sum ", sum, ", expected 1"));
  }
  return regressor;
}

MatrixX3d Human36mJoints(const BodyModel& body, const Motion& motion, int t, const RowMatrixXd& regressor) {
  constexpr int kSmplBody = 22;
  BODYLOOM_CHECK(body.num_joints() >= kSmplBody, "joints of Human3.6M: the body '", body.name(), "' has ",
                 body.num_joints(), " joints, expected SMPL's 22 and more");
  const BodyPose pose = PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
  if (regressor.size() > 0) return regressor * PoseVertices(body, motion.betas, pose);
  MatrixX3d joints = MatrixX3d::Constant(kHuman36mJoints, 3, std::numeric_limits<double>::quiet_NaN());
  const MatrixX3d own = PoseSkeleton(body, body.RestJoints(motion.betas), pose).joints;
  for (int j = 0; j < kHuman36mJoints; ++j) {
    if (kSmplOfHuman36m[size_t(j)] >= 0) joints.row(j) = own.row(kSmplOfHuman36m[size_t(j)]);
  }
  joints.row(0) = 0.5 * (own.row(1) + own.row(2));
  Eigen::Index crown = 0;
  body.data().v_template.col(1).maxCoeff(&crown);
  const std::array<int, 1> vertices = {int(crown)};
  joints.row(kHeadTop) = PoseVertices(body, motion.betas, pose, vertices);
  return joints;
}

Evaluation EvaluateHuman36m(const Track& track, const std::vector<MatrixX3d>& true_joints,
                            const std::vector<int>& frames, const CameraPose& pose, const BodyModel& body,
                            const RowMatrixXd& regressor) {
  BODYLOOM_CHECK(int(frames.size()) == track.num_frames(), "Human3.6M: ", frames.size(), " frames, the track has ",
                 track.num_frames());
  Evaluation result;
  result.protocol = "h36m";
  result.description =
      "Joints of Human3.6M, camera frame: LSP's 14 after moving the middle of the hips onto the true one (MPJPE, "
      "protocol 1 of HMR over all cameras), and after one similarity a frame (PA-MPJPE, protocol 2 of HMR on the "
      "frontal "
      "camera). ";
  result.description += regressor.size() > 0
                            ? "The body's joints are regressed from its vertices."
                            : "The body's joints are its own and the top of its head, which are not exactly the data "
                              "set's: give --joint-regressor for the field's numbers.";
  const std::vector<int> nearest = NearestFramesWithResult(HasResults(track, track.num_frames()));
  std::vector<MatrixX3d> joints, truth;
  std::vector<double> times;
  for (int t = 0; t < track.num_frames(); ++t) {
    const MatrixX3d& known = true_joints[size_t(frames[size_t(t)])];
    if (known.rows() == 0) continue;
    ++result.frames;
    if (nearest.empty()) continue;
    result.frames_without_result += nearest[size_t(t)] == t ? 0 : 1;
    joints.push_back(Human36mJoints(body, track.motion, nearest[size_t(t)], regressor));
    truth.push_back(MovedPoints(pose, known));
    times.push_back(track.motion.timestamps[size_t(t)]);
  }
  BODYLOOM_CHECK(result.frames > 0, "the truth tells no joints at the track's times");
  if (joints.empty()) {
    result.frames_without_result = result.frames;
    return result;
  }
  const JointSets lsp = SetsOf(joints, truth, Lsp14());
  const PositionError mpjpe = MeanPositionError(lsp.relative, lsp.true_relative);
  const PositionError pa = ProcrustesPositionError(lsp.joints, lsp.truth);
  result.Add("mpjpe_mm", mpjpe.mean * kMmPerMetre, "LSP's 14 joints, mid-hip aligned");
  result.Add("pa_mpjpe_mm", pa.mean * kMmPerMetre, "the same after one similarity a frame");
  result.Add("pa_p95_mm", pa.frames.p95 * kMmPerMetre, "95th percentile of frames");
  result.Add("pa_over_120_percent", PercentAbove(pa.of_frame, kAnotherPose_m), "frames in which it is above 120 mm");
  if (regressor.size() > 0) {
    std::vector<int> all(kHuman36mJoints);
    for (int j = 0; j < kHuman36mJoints; ++j) all[size_t(j)] = j;
    const JointSets sets = SetsOf(joints, truth, all);
    result.Add("mpjpe_17_mm", MeanPositionError(sets.relative, sets.true_relative).mean * kMmPerMetre,
               "all 17 joints, the root included, mid-hip aligned");
    result.Add("pa_mpjpe_17_mm", ProcrustesPositionError(sets.joints, sets.truth).mean * kMmPerMetre,
               "the same after one similarity a frame");
  }
  const MotionError acceleration = AccelerationError(lsp.joints, lsp.truth, times);
  result.Add("accel_err_ms2", acceleration.mean, "acceleration error, m/s2");
  result.Add("gt_accel_ms2", acceleration.mean_truth, "true acceleration, m/s2");
  const MatrixX3d roots = RootPositions(joints, {0}), true_roots = RootPositions(truth, {0});
  const bool has_depth = track.camera.model == CameraModel::kPinhole;
  const RootError root = has_depth ? RootPositionError(roots, true_roots) : RootError{};
  result.Add("root_err_mm", root.distance.mean * kMmPerMetre, "mid-hip error");
  result.Add("root_lateral_err_mm", root.lateral * kMmPerMetre, "its part across the viewing direction");
  result.Add("root_depth_err_mm", root.depth * kMmPerMetre, "its part in depth");
  const GlobalErrors world = has_depth ? MeasureGlobalErrors(lsp.joints, lsp.truth, roots, true_roots)
                                       : GlobalErrors{kNotMeasured, kNotMeasured, kNotMeasured};
  result.Add("w_mpjpe_100_mm", world.w_mpjpe_100_m * kMmPerMetre,
             "100 frames after a similarity of their first two (EMDB)");
  result.Add("wa_mpjpe_100_mm", world.wa_mpjpe_100_m * kMmPerMetre,
             "100 frames after a similarity of all of them (EMDB)");
  result.Add("rte_percent", 100 * world.rte, "mid-hip error after a rigid motion / length of its path (EMDB)");
  EvaluationBreakdown joint{"mpjpe_mm", {}, {}};
  for (size_t k = 0; k < kLsp14.size(); ++k) {
    joint.labels.push_back(Human36m17().names[size_t(kLsp14[k])]);
    joint.values.push_back(mpjpe.per_point[Eigen::Index(k)] * kMmPerMetre);
  }
  result.breakdowns.push_back(std::move(joint));
  return result;
}

void AddRegressedJoints(const Track& track, const std::vector<int>& source, const Track& truth, const BodyModel& body,
                        const BodyModel& true_body, const RowMatrixXd& regressor, Evaluation* evaluation) {
  std::vector<MatrixX3d> joints, true_joints;
  for (size_t t = 0; t < source.size(); ++t) {
    joints.push_back(Human36mJoints(body, track.motion, source[t], regressor));
    true_joints.push_back(Human36mJoints(true_body, truth.motion, int(t), regressor));
  }
  const bool has_frames = !source.empty();
  const JointSets lsp = has_frames ? SetsOf(joints, true_joints, Lsp14()) : JointSets();
  evaluation->Add("lsp14_mpjpe_mm",
                  has_frames ? MeanPositionError(lsp.relative, lsp.true_relative).mean * kMmPerMetre : kNotMeasured,
                  "LSP's 14 joints of Human3.6M's regressor, mid-hip aligned");
  evaluation->Add("lsp14_pa_mpjpe_mm",
                  has_frames ? ProcrustesPositionError(lsp.joints, lsp.truth).mean * kMmPerMetre : kNotMeasured,
                  "the same after one similarity a frame");
}

}  // namespace bodyloom
