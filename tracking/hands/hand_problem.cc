// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/hand_problem.h"

#include <ceres/solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "tracking/solvers/chain/chain_factor.h"
#include "tracking/solvers/residuals/ceres_functions.h"

namespace bodyloom {

using Eigen::Map;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Unknowns of a frame in this order, then one of padding: ChainFactor takes multiples of three.
constexpr int kWristAt = kFingerCoordinates, kForearmAt = kWristAt + 3, kPlaceAt = kForearmAt + 1,
              kHandUnknowns = kPlaceAt + 2, kHandColumns = kHandUnknowns + 1;
static_assert(kHandColumns % 3 == 0);

/// σ of a point that has none, as HandOf() gives it (tracking/detection/hand_landmarks.h), for two looks that differ by
/// as much as the level on the finger gives.
double UsualSigmaPx(int k, double length_px) {
  constexpr std::array<double, 4> kOfLevel = {0.06, 0.08, 0.10, 0.13};
  const double c = k == 0 ? kOfLevel[0] : kOfLevel[size_t(k - 1) % 4];
  return std::hypot(std::sqrt(2.0) * c * length_px, 0.8);
}

}  // namespace

struct HandProblem::Memory {
  Memory(const BodyModel& body, const HandSkeleton& hand, const Eigen::VectorXd& betas)
      : kinematics(body, hand, betas) {}

  struct Frame {
    int t = 0;  ///< of the track
    HandFrame arm;
    Matrix3d elbow;
    std::array<double, kHandUnknowns> values{};
  };
  struct Point {
    size_t frame = 0;
    int k = 0;
    Eigen::Vector2d pixel;
  };

  HandKinematics kinematics;
  std::string name;
  int elbow_joint = -1;
  std::vector<int> frame_of;  ///< T: index into `frames`, −1 in lost frames
  std::vector<Frame> frames;
  std::vector<char> cut_before;  ///< of `frames`
  double log_size = 0;
  std::vector<Point> points;
  std::vector<std::pair<int, double>> lengths_px;  ///< with the track's frame
  std::unique_ptr<ceres::Problem> problem;

  double* Block(int t, int at) {
    const int i = frame_of.at(size_t(t));
    return i < 0 ? nullptr : frames[size_t(i)].values.data() + at;
  }
  void AddFrames(const BodyModel& body, const Track& track, const std::vector<char>& cuts,
                 const std::vector<char>& used);
  void Observe(const HandObservation& seen, double weight, const HandFitOptions& options, Frame* frame);
  void StartFrom(const HandObservation& seen, const Matrix3d& ray, Frame* frame);
};

void HandProblem::Memory::AddFrames(const BodyModel& body, const Track& track, const std::vector<char>& cuts,
                                    const std::vector<char>& used) {
  const HandSkeleton& hand = kinematics.hand();
  elbow_joint = body.parents()[size_t(hand.wrist)];
  const MatrixX3d rest = body.RestJoints(track.motion.betas);
  const Vector3d axis = (rest.row(hand.wrist) - rest.row(elbow_joint)).transpose().normalized();
  frame_of.assign(size_t(track.num_frames()), -1);
  bool cut = true;
  for (int t = 0; t < track.num_frames(); ++t) {
    cut = cut || (!cuts.empty() && cuts[size_t(t)] != 0);
    if (!track.HasResult(t) || (!used.empty() && used[size_t(t)] == 0)) continue;
    const BodyPose pose = PoseFromAxisAngle(body, track.motion.poses.row(t), track.motion.trans.row(t));
    const PosedSkeleton skeleton = PoseSkeleton(body, rest, pose);
    Frame frame;
    frame.t = t;
    frame.arm.camera = track.CameraAt(t);
    frame.arm.camera_from_elbow = skeleton.world_rotations[size_t(elbow_joint)];
    frame.arm.forearm_axis = axis;
    frame.arm.wrist = pose.rotations[size_t(hand.wrist)];
    frame.arm.wrist_in_camera = skeleton.joints.row(hand.wrist);
    if (track.HasMovingCamera()) {
      const CameraPose& camera = track.camera_from_scene[size_t(t)];
      frame.arm.camera_from_elbow = camera.camera_from_world_rotation * frame.arm.camera_from_elbow;
      frame.arm.wrist_in_camera =
          camera.camera_from_world_rotation * frame.arm.wrist_in_camera + camera.camera_from_world_translation;
    }
    frame.elbow = pose.rotations[size_t(elbow_joint)];
    frame_of[size_t(t)] = static_cast<int>(frames.size());
    frames.push_back(frame);
    cut_before.push_back(cut ? 1 : 0);
    cut = false;
  }
}

void HandProblem::Memory::StartFrom(const HandObservation& seen, const Matrix3d& ray, Frame* frame) {
  // The palm is rigid: the wrist that turns it to the network's. Half a turn away the body is the surer one.
  constexpr std::array<int, 5> kPalm = {0, 5, 9, 13, 17};
  MatrixX3d own(kPalm.size(), 3), network(kPalm.size(), 3);
  for (size_t i = 0; i < kPalm.size(); ++i) {
    own.row(Eigen::Index(i)) = kinematics.Point(kPalm[i], FingerCoordinates::Zero(), nullptr);
    network.row(Eigen::Index(i)) = ray * seen.metres[size_t(kPalm[i])].cast<double>();
  }
  own.rowwise() -= own.colwise().mean().eval();
  network.rowwise() -= network.colwise().mean().eval();
  const Matrix3d camera_from_wrist = NearestRotation(network.transpose() * own);
  const HandTurn body(frame->arm, std::array<double, 3>{}.data(), 0);
  const Vector3d w = AxisAngleFromRotation(body.camera_from_wrist.transpose() * camera_from_wrist);
  if (w.allFinite() && w.norm() < M_PI / 2) Map<Vector3d>(frame->values.data() + kWristAt) = w;
}

void HandProblem::Memory::Observe(const HandObservation& seen, double weight, const HandFitOptions& options,
                                  Frame* frame) {
  const HandTurn turn(frame->arm, frame->values.data() + kWristAt, 0);
  const Vector3d middle = frame->arm.wrist_in_camera + kinematics.length_m() * Vector3d::UnitX();
  Eigen::Vector2d a, b;
  if (!frame->arm.camera.Project(frame->arm.wrist_in_camera, &a) || !frame->arm.camera.Project(middle, &b)) return;
  const double length_px = (b - a).norm();
  if (length_px < options.min_length_px) return;
  const Keypoint& wrist = seen.points[0];
  const bool elsewhere = (Eigen::Vector2d(wrist.x, wrist.y) - a).norm() > options.max_wrist_lengths * length_px;
  if (wrist.confidence > 0 && elsewhere) return;
  lengths_px.emplace_back(frame->t, length_px);
  double* values = frame->values.data();
  const auto loss = [&] {
    return new ceres::ScaledLoss(new GemanMcClureLoss(options.kernel), weight, ceres::TAKE_OWNERSHIP);
  };
  for (int k = 0; k < kHandPoints; ++k) {
    const Keypoint& point = seen.points[size_t(k)];
    const double known = seen.sigma_px[size_t(k)];
    if (!(point.confidence > 0) || !std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    if (known <= 0 && point.confidence < options.min_confidence) continue;
    const Eigen::Vector2d pixel(point.x, point.y);
    problem->AddResidualBlock(
        new HandPointCost(&kinematics, &frame->arm, k, pixel, known > 0 ? known : UsualSigmaPx(k, length_px)), loss(),
        {values, values + kWristAt, values + kForearmAt, values + kPlaceAt, &log_size});
    points.push_back({size_t(frame - frames.data()), k, pixel});
  }
  const bool weak = frame->arm.camera.model == CameraModel::kWeakPerspective;
  const Matrix3d ray =
      weak ? Matrix3d::Identity().eval() : RotationBetweenDirections(Vector3d::UnitZ(), frame->arm.wrist_in_camera);
  bool in_metres = true;
  for (const auto& [from, to] : HandBones()) {
    const Vector3d bone = (seen.metres[size_t(to)] - seen.metres[size_t(from)]).cast<double>();
    if (!bone.allFinite() || !(bone.norm() > 0)) {
      in_metres = false;
      continue;
    }
    problem->AddResidualBlock(
        new HandBoneCost(&kinematics, &frame->arm, from, to, ray * bone.normalized(), options.bone_sigma), loss(),
        {values, values + kWristAt, values + kForearmAt});
  }
  if (in_metres) StartFrom(seen, ray, frame);
}

HandProblem::HandProblem(const BodyModel& body, const HandSkeleton& hand, const Track& track,
                         const HandsAndFaceSequence& seen, const std::vector<char>& cut_before,
                         const HandFitOptions& options, const std::vector<char>& used)
    : memory_(std::make_unique<Memory>(body, hand, track.motion.betas)) {
  BODYLOOM_CHECK(seen.num_frames() == track.num_frames(), "hands of ", seen.num_frames(), " frames, a track of ",
                 track.num_frames());
  BODYLOOM_CHECK(used.empty() || used.size() == size_t(track.num_frames()), used.size(),
                 " flags of frames that are used, a track of ", track.num_frames());
  Memory& m = *memory_;
  m.name = body.data().joint_names.empty() ? SmplJointNames()[size_t(hand.wrist)]
                                           : body.data().joint_names[size_t(hand.wrist)];
  m.AddFrames(body, track, cut_before, used);
  ceres::Problem::Options of_problem;
  of_problem.enable_fast_removal = true;
  m.problem = std::make_unique<ceres::Problem>(of_problem);
  std::vector<double> times;
  std::vector<double*> fingers, wrists, forearms, places;
  for (Memory::Frame& frame : m.frames) {
    double* values = frame.values.data();
    fingers.push_back(values), wrists.push_back(values + kWristAt);
    forearms.push_back(values + kForearmAt), places.push_back(values + kPlaceAt);
    times.push_back(track.motion.timestamps[size_t(frame.t)]);
    m.problem->AddResidualBlock(new HandLimitCost(&m.kinematics), nullptr, values);
  }
  AddSteadyPrior({1, options.fingers_last_s}, fingers, kFingerCoordinates, times, m.cut_before, m.problem.get());
  AddSteadyPrior(options.wrist, wrists, 3, times, m.cut_before, m.problem.get());
  AddSteadyPrior(options.forearm, forearms, 1, times, m.cut_before, m.problem.get());
  AddSteadyPrior(options.place, places, 2, times, m.cut_before, m.problem.get());
  m.problem->AddResidualBlock(
      new LinearCost(RowMatrixXd::Constant(1, 1, 1 / options.log_size_sigma), Eigen::VectorXd::Zero(1)), nullptr,
      &m.log_size);
  const size_t side = hand.side == HandSide::kLeft ? HandsAndFace::kLeft : HandsAndFace::kRight;
  for (size_t i = 0; i < m.frames.size(); ++i) {
    const auto& parts = seen.frames[size_t(m.frames[i].t)];
    if (parts == nullptr || !parts->hands[side]) continue;
    m.Observe(*parts->hands[side], IndependentShare(i, times, m.cut_before, options.errors_last_s), options,
              &m.frames[i]);
  }
}

HandProblem::~HandProblem() = default;

ceres::Problem& HandProblem::problem() { return *memory_->problem; }
double* HandProblem::fingers(int t) { return memory_->Block(t, 0); }
double* HandProblem::wrist(int t) { return memory_->Block(t, kWristAt); }
double* HandProblem::forearm(int t) { return memory_->Block(t, kForearmAt); }
double* HandProblem::place(int t) { return memory_->Block(t, kPlaceAt); }
double* HandProblem::log_size() { return &memory_->log_size; }
const HandKinematics& HandProblem::kinematics() const { return memory_->kinematics; }

std::vector<double> HandProblem::LengthsPx(int begin, int end) const {
  std::vector<double> lengths;
  for (const auto& [t, length_px] : memory_->lengths_px) {
    if (t >= begin && t < end) lengths.push_back(length_px);
  }
  return lengths;
}

std::string HandProblem::NameOf(const double* block) const {
  if (block == &memory_->log_size) return "log size of " + memory_->name;
  for (const Memory::Frame& frame : memory_->frames) {
    for (const auto& [what, at] :
         {std::pair{"fingers", 0}, {"wrist", kWristAt}, {"forearm", kForearmAt}, {"place", kPlaceAt}}) {
      if (block == frame.values.data() + at) return Concatenate(what, " of ", memory_->name, ", frame ", frame.t);
    }
  }
  return "";
}

std::string HandProblem::Solve(int max_iterations, int* iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-4;
  options.num_threads = 1;  // Ceres' own threads sum in the order in which they finish
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, memory_->problem.get(), &summary);
  if (iterations != nullptr) *iterations = static_cast<int>(summary.iterations.size()) - 1;
  return summary.IsSolutionUsable() ? "" : "Ceres: " + summary.message;
}

std::vector<double> HandProblem::ErrorsPx(int begin, int end) const {
  std::vector<double> px;
  for (const Memory::Point& point : memory_->points) {
    const Memory::Frame& frame = memory_->frames[point.frame];
    if (frame.t < begin || frame.t >= end) continue;
    const double* values = frame.values.data();
    const std::array<const double*, 5> blocks = {values, values + kWristAt, values + kForearmAt, values + kPlaceAt,
                                                 &memory_->log_size};
    Eigen::Vector2d residual;
    HandPointCost(&memory_->kinematics, &frame.arm, point.k, point.pixel, 1)
        .Evaluate(blocks.data(), residual.data(), nullptr);
    px.push_back(residual.norm());
  }
  return px;
}

void HandProblem::SetPose(int t, BodyPose* pose) const {
  const int i = memory_->frame_of.at(size_t(t));
  if (i < 0) return;
  const Memory::Frame& frame = memory_->frames[size_t(i)];
  const HandSkeleton& hand = memory_->kinematics.hand();
  const double* values = frame.values.data();
  pose->rotations[size_t(memory_->elbow_joint)] =
      frame.elbow * RotationFromAxisAngle(values[kForearmAt] * frame.arm.forearm_axis);
  pose->rotations[size_t(hand.wrist)] = frame.arm.wrist * RotationFromAxisAngle(Map<const Vector3d>(values + kWristAt));
  const HandAngleVector angles = memory_->kinematics.Angles(Map<const FingerCoordinates>(values));
  for (int j = 0; j < kHandJoints; ++j) {
    pose->rotations[size_t(hand.joint[size_t(j)])] = HandRotation(hand, j, angles.segment<3>(Eigen::Index{3} * j));
  }
}

namespace {

/// The Gauss–Newton matrix of a hand, JᵀJ.
class HandMatrix : public ChainSource {
 public:
  explicit HandMatrix(size_t num_frames) : frames_(num_frames) {
    for (OfFrame& frame : frames_) {
      frame.A.setZero();
      frame.A(kHandUnknowns, kHandUnknowns) = 1;  // padding
      frame.B.setZero();
      frame.next.fill(0), frame.second.fill(0);
    }
  }
  /// Columns are kHandUnknowns a frame, then the size.
  void AddRow(const std::vector<std::pair<int, double>>& row) {
    const int size_column = static_cast<int>(frames_.size()) * kHandUnknowns;
    for (const auto& [a, x] : row) {
      if (a == size_column) {
        size_ += x * x;
        continue;
      }
      const int t = a / kHandUnknowns, i = a % kHandUnknowns;
      OfFrame& frame = frames_[size_t(t)];
      for (const auto& [b, y] : row) {
        if (b == size_column) {
          frame.B[i] += x * y;
          continue;
        }
        const int u = b / kHandUnknowns, j = b % kHandUnknowns;
        if (u == t) frame.A(i, j) += x * y;
        if (u == t + 1) frame.next[BlockEntry(i, j)] += x * y;
        if (u == t + 2) frame.second[BlockEntry(i, j)] += x * y;
      }
    }
  }
  void AddFrame(int t, double* a, int64_t a_stride, double* b, int64_t b_stride) const override {
    const OfFrame& frame = frames_[size_t(t)];
    for (int i = 0; i < kHandColumns; ++i) {
      for (int j = i; j < kHandColumns; ++j) a[i * a_stride + j] += frame.A(i, j);
      b[i * b_stride] += frame.B[i];
    }
  }
  [[nodiscard]] const double* Next(int t) const override { return frames_[size_t(t)].next.data(); }
  [[nodiscard]] const double* Second(int t) const override { return frames_[size_t(t)].second.data(); }
  [[nodiscard]] double size() const { return size_; }

 private:
  /// Neighbours' coordinates couple each with itself (SteadyPrior), so that 3×3 blocks of the diagonal hold all.
  static size_t BlockEntry(int i, int j) { return size_t(9 * (i / 3) + 3 * (i % 3) + j % 3); }
  struct OfFrame {
    Eigen::Matrix<double, kHandColumns, kHandColumns> A;
    Eigen::Matrix<double, kHandColumns, 1> B;
    std::array<double, 3 * kHandColumns> next, second;
  };
  std::vector<OfFrame> frames_;
  double size_ = 0;
};

}  // namespace

HandProblem::Sigma HandProblem::FindSigma() {
  Memory& m = *memory_;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Sigma sigma;
  sigma.angles.setConstant(Eigen::Index(m.frame_of.size()), kFingerCoordinates, kNan);
  sigma.joints_m.setConstant(Eigen::Index(m.frame_of.size()), kHandJoints, kNan);
  if (m.frames.empty()) return sigma;
  ceres::Problem::EvaluateOptions evaluate;
  for (Memory::Frame& frame : m.frames) {
    double* values = frame.values.data();
    for (double* block : {values, values + kWristAt, values + kForearmAt, values + kPlaceAt}) {
      evaluate.parameter_blocks.push_back(block);
    }
  }
  evaluate.parameter_blocks.push_back(&m.log_size);
  ceres::CRSMatrix J;
  if (!m.problem->Evaluate(evaluate, nullptr, nullptr, nullptr, &J)) return sigma;
  HandMatrix matrix(m.frames.size());
  std::vector<std::pair<int, double>> row;
  for (int r = 0; r < J.num_rows; ++r) {
    row.clear();
    for (int at = J.rows[size_t(r)]; at < J.rows[size_t(r) + 1]; ++at) {
      if (J.values[size_t(at)] != 0) row.emplace_back(J.cols[size_t(at)], J.values[size_t(at)]);
    }
    matrix.AddRow(row);
  }
  ChainFactor factor(kHandColumns, 1, m.cut_before);
  Eigen::VectorXd step, shared_step;
  if (!factor.Solve(matrix, Eigen::MatrixXd::Constant(1, 1, matrix.size()), Eigen::VectorXd::Zero(1), 1, &step,
                    &shared_step)) {
    return sigma;
  }
  factor.VisitInverse(0, static_cast<int>(m.frames.size()), 1, [&](int i, const Eigen::MatrixXd& P) {
    const Memory::Frame& frame = m.frames[size_t(i)];
    const auto& L = m.kinematics.by_coordinates();
    const auto of_fingers = P.topLeftCorner<kFingerCoordinates, kFingerCoordinates>();
    sigma.angles.row(frame.t) = (L * of_fingers * L.transpose()).diagonal().cwiseSqrt().transpose();
    const Map<const FingerCoordinates> y(frame.values.data());
    const HandTurn turn(frame.arm, frame.values.data() + kWristAt, frame.values[kForearmAt]);
    for (int k = 1; k < kHandPoints; ++k) {
      const int joint = HandJointAt(k);
      if (joint < 0) continue;
      ByFingers by_fingers;
      const Vector3d q = m.kinematics.Point(k, y, &by_fingers);
      Eigen::Matrix<double, 3, kPlaceAt> by_unknowns;  // in the wrist's axes
      by_unknowns << by_fingers, -Skew(q) * turn.by_wrist, -Skew(q) * turn.by_forearm;
      const double variance =
          (by_unknowns * P.topLeftCorner<kPlaceAt, kPlaceAt>() * by_unknowns.transpose()).trace() / 3;
      sigma.joints_m(frame.t, joint) = std::sqrt(variance);
    }
  });
  return sigma;
}

}  // namespace bodyloom
