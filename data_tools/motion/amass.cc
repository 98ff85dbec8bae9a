// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/amass.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/skeleton_motion.h"
#include "geometry/base/check.h"
#include "geometry/scene/track.h"

namespace bodyloom {
namespace {

constexpr int kBodyColumns = 66, kSmplColumns = 72, kSmplhColumns = 156, kSmplxColumns = 165, kHandColumns = 90;
constexpr int kAmassBetas = 16;

/// One frame, or a clip with a gap, has no frame rate of its own; AMASS readers insist on a number.
double RateForReaders(const Motion& motion) {
  const double fps = FrameRate(motion), seconds = motion.timestamps.back() - motion.timestamps.front();
  if (fps > 0) return fps;
  return seconds > 0 ? (motion.num_frames() - 1) / seconds : 30.0;
}

RowMatrixXd RequireMatrix(const NpzArrays& arrays, const std::string& key, const std::string& where) {
  const NdArray& array = RequireArray(arrays, key, where);
  const bool is_by_joint = array.shape.size() == 3 && array.shape[2] == 3;  // frames × joints × 3
  if (!array.is_number() || (array.shape.size() != 2 && !is_by_joint)) {
    ThrowFileError(where, key, "shape " + array.ShapeText() + ", expected frames x values");
  }
  RowMatrixXd matrix = array.ToMatrix();
  for (Eigen::Index t = 0; t < matrix.rows(); ++t) {
    if (!matrix.row(t).allFinite()) ThrowFileError(where, key, "frame " + std::to_string(t) + " is not finite");
  }
  return matrix;
}

double FrameRateOf(const NpzArrays& arrays, const std::string& where) {
  for (const char* key : {"mocap_framerate", "mocap_frame_rate", "fps"}) {
    const auto found = arrays.find(key);
    if (found == arrays.end()) continue;
    if (!found->second.is_number() || found->second.num_elements() != 1)
      ThrowFileError(where, key, "expected one number");
    const double fps = found->second.ToDoubles()[0];
    if (!(fps > 0 && fps < 1e5)) ThrowFileError(where, key, std::to_string(fps) + ", expected frames a second");
    return fps;
  }
  throw std::runtime_error(where + ": neither 'mocap_framerate' nor 'mocap_frame_rate' nor 'fps' nor 'timestamps'");
}

std::vector<double> TimestampsOf(const NpzArrays& arrays, int num_frames, const std::string& where) {
  const auto found = arrays.find("timestamps");
  if (found == arrays.end()) return RegularTimestamps(num_frames, 1 / FrameRateOf(arrays, where));
  if (!found->second.is_number() || found->second.num_elements() != num_frames) {
    ThrowFileError(where, "timestamps", found->second.ShapeText() + " values, expected " + std::to_string(num_frames));
  }
  std::vector<double> timestamps = found->second.ToDoubles();
  for (int t = 0; t < num_frames; ++t) {
    if (!std::isfinite(timestamps[t]) || (t > 0 && !(timestamps[t] > timestamps[t - 1]))) {
      ThrowFileError(where, "timestamps", "entry " + std::to_string(t) + ": expected finite, increasing seconds");
    }
  }
  return timestamps;
}

/// The body whose shape `betas` of the file cannot state.
void AddSourceBody(const Motion& motion, NpzArrays* arrays) {
  (*arrays)["source_body"] = NdArray::FromString(motion.body);
  (*arrays)["source_betas"] = NdArray::FromDoubles(motion.betas.data(), {motion.betas.size()});
}

Motion::Up UpOf(const NpzArrays& arrays, const std::string& where) {
  if (arrays.find("camera_model") != arrays.end()) return Motion::Up::kCamera;
  const auto found = arrays.find("up_axis");
  if (found == arrays.end()) return Motion::Up::kZ;
  const std::vector<std::string> text =
      found->second.is_text() ? found->second.ToStrings() : std::vector<std::string>();
  if (text.size() != 1 || (text[0] != "y" && text[0] != "z")) ThrowFileError(where, "up_axis", "expected 'y' or 'z'");
  return text[0] == "y" ? Motion::Up::kY : Motion::Up::kZ;
}

/// `poses`, or the root and the body of files that have them in parts.
RowMatrixXd PosesOf(const NpzArrays& arrays, const std::string& where) {
  if (!arrays.contains("poses") && arrays.contains("root_orient")) {
    const RowMatrixXd root = RequireMatrix(arrays, "root_orient", where),
                      body = RequireMatrix(arrays, "pose_body", where);
    if (root.cols() != 3 || body.cols() != kBodyColumns - 3 || root.rows() != body.rows()) {
      ThrowFileError(where, Concatenate("root_orient and pose_body: ", root.rows(), "x", root.cols(), " and ",
                                        body.rows(), "x", body.cols(), ", expected frames x 3 and frames x 63"));
    }
    RowMatrixXd poses(root.rows(), kBodyColumns);
    poses << root, body;
    return poses;
  }
  RowMatrixXd poses = RequireMatrix(arrays, "poses", where);
  const Eigen::Index columns = poses.cols();
  if (columns != kSmplColumns && columns != kSmplhColumns && columns != 162 && columns != kSmplxColumns) {
    ThrowFileError(where, "poses",
                   "shape " + RequireArray(arrays, "poses", where).ShapeText() +
                       ", expected 72 (SMPL), 156 (SMPL-H), 162 or 165 (SMPL-X) columns");
  }
  return poses;
}

/// One shape for the clip: the only row, or the mean of one a frame, which `warnings` says if they differ.
Eigen::VectorXd BetasOf(const NdArray& betas, Eigen::Index num_frames, const std::string& where,
                        std::vector<std::string>* warnings) {
  const bool is_rows = betas.shape.size() == 2 && (betas.shape[0] == 1 || betas.shape[0] == num_frames);
  constexpr Eigen::Index kMaxBetas = 1000;
  if (!betas.is_number() || (betas.shape.size() != 1 && !is_rows) || betas.shape.back() > kMaxBetas) {
    ThrowFileError(where, "betas", "shape " + betas.ShapeText() + ", expected one shape for the clip, or one a frame");
  }
  const std::vector<double> values = betas.ToDoubles();
  const Eigen::Index columns = betas.shape.back(), rows = is_rows ? betas.shape[0] : 1;
  const Eigen::Map<const RowMatrixXd> table(values.data(), rows, columns);
  if (!table.allFinite()) ThrowFileError(where, "betas", "not finite");
  const Eigen::VectorXd first = table.row(0).transpose();
  if ((table.rowwise() - first.transpose()).isZero(0)) return first;
  if (warnings != nullptr) {
    warnings->push_back(Concatenate(where, ": betas: a shape for each of ", rows,
                                    " frames, of which the mean is taken; a motion has one"));
  }
  return table.colwise().mean().transpose();
}

}  // namespace

bool IsAmass(const NpzArrays& arrays) {
  return arrays.contains("trans") &&
         (arrays.contains("poses") || (arrays.contains("root_orient") && arrays.contains("pose_body")));
}

Motion AmassFromNpz(const NpzArrays& arrays, const std::string& where, std::vector<std::string>* warnings) {
  const RowMatrixXd poses = PosesOf(arrays, where);
  const Eigen::Index columns = poses.cols();
  if (poses.rows() == 0) ThrowFileError(where, "poses", "no frames");
  const RowMatrixXd trans = RequireMatrix(arrays, "trans", where);
  if (trans.rows() != poses.rows() || trans.cols() != 3) {
    ThrowFileError(where, "trans",
                   "shape " + RequireArray(arrays, "trans", where).ShapeText() + ", expected " +
                       std::to_string(poses.rows()) + "x3");
  }
  Motion motion;
  motion.body = "smpl";
  motion.poses = RowMatrixXd::Zero(poses.rows(), kSmplColumns);
  const Eigen::Index kept = columns == kSmplColumns ? kSmplColumns : kBodyColumns;
  motion.poses.leftCols(kept) = poses.leftCols(kept);
  motion.trans = trans;
  if (const auto found = arrays.find("betas"); found != arrays.end()) {
    motion.betas = BetasOf(found->second, poses.rows(), where, warnings);
  }
  motion.timestamps = TimestampsOf(arrays, motion.num_frames(), where);
  motion.up = UpOf(arrays, where);
  return motion;
}

void WriteAmass(const std::string& path, const Motion& motion, const Eigen::Vector3d& rest_pelvis,
                const std::string& gender) {
  CheckMotion(motion, "WriteAmass");
  const Eigen::Index columns = motion.poses.cols();
  BODYLOOM_CHECK(columns == kSmplColumns || columns == kSmplhColumns || columns == kSmplxColumns,
                 "WriteAmass: ", columns / 3, " joints, expected 24 (SMPL), 52 (SMPL-H) or 55 (SMPL-X)");
  const Motion z_up = ChangeUp(motion, Motion::Up::kZ, rest_pelvis);
  const int64_t T = motion.num_frames();
  RowMatrixXd poses = RowMatrixXd::Zero(T, kSmplhColumns);
  poses.leftCols(kBodyColumns) = z_up.poses.leftCols(kBodyColumns);
  if (columns != kSmplColumns) poses.rightCols(kHandColumns) = z_up.poses.rightCols(kHandColumns);
  NpzArrays arrays;
  arrays["poses"] = NdArray::FromDoubles(poses.data(), {T, kSmplhColumns});
  const bool own = motion.body == "smpl" || motion.body == "smplh";
  const Eigen::VectorXd betas = own ? motion.betas : Eigen::VectorXd::Zero(kAmassBetas);
  MatrixX3d trans = z_up.trans;
  if (!own) {
    trans.rowwise() += (rest_pelvis - MeanPelvis("smpl")).transpose();
    AddSourceBody(motion, &arrays);
  }
  arrays["trans"] = NdArray::FromDoubles(trans.data(), {T, 3});
  arrays["betas"] = NdArray::FromDoubles(betas.data(), {betas.size()});
  arrays["gender"] = NdArray::FromString(gender);
  arrays["mocap_framerate"] = NdArray::FromDouble(RateForReaders(motion));
  arrays["timestamps"] = NdArray::FromDoubles(motion.timestamps.data(), {T});
  WriteNpz(path, arrays);
}

void WriteAmassSmplx(const std::string& path, const Motion& motion, const Eigen::Vector3d& rest_pelvis,
                     const std::string& gender) {
  CheckMotion(motion, "WriteAmassSmplx");
  const Eigen::Index columns = motion.poses.cols();
  BODYLOOM_CHECK(columns == kSmplColumns || columns == kSmplhColumns || columns == kSmplxColumns,
                 "WriteAmassSmplx: ", columns / 3, " joints, expected 24 (SMPL), 52 (SMPL-H) or 55 (SMPL-X)");
  const Motion z_up = ChangeUp(motion, Motion::Up::kZ, rest_pelvis);
  const int64_t T = motion.num_frames();
  RowMatrixXd poses = RowMatrixXd::Zero(T, kSmplxColumns);
  if (columns == kSmplxColumns) {
    poses = z_up.poses;
  } else {
    poses.leftCols(kBodyColumns) = z_up.poses.leftCols(kBodyColumns);
    if (columns == kSmplhColumns) poses.rightCols(kHandColumns) = z_up.poses.rightCols(kHandColumns);
  }
  const bool own = columns == kSmplxColumns;
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(kAmassBetas);
  if (own)
    betas.head(std::min<Eigen::Index>(kAmassBetas, motion.betas.size())) =
        motion.betas.head(std::min<Eigen::Index>(kAmassBetas, motion.betas.size()));
  MatrixX3d trans = z_up.trans;
  NpzArrays arrays;
  if (!own) {
    trans.rowwise() += (rest_pelvis - MeanPelvis("smplx")).transpose();
    AddSourceBody(motion, &arrays);
  }
  const auto add = [&](const char* key, Eigen::Index first, Eigen::Index count) {
    const RowMatrixXd part = poses.middleCols(first, count);
    arrays[key] = NdArray::FromDoubles(part.data(), {T, count});
  };
  add("poses", 0, kSmplxColumns);
  add("root_orient", 0, 3);
  add("pose_body", 3, kBodyColumns - 3);
  add("pose_jaw", kBodyColumns, 3);
  add("pose_eye", kBodyColumns + 3, 6);
  add("pose_hand", kSmplxColumns - kHandColumns, kHandColumns);
  arrays["trans"] = NdArray::FromDoubles(trans.data(), {T, 3});
  arrays["betas"] = NdArray::FromDoubles(betas.data(), {kAmassBetas});
  const int32_t num_betas[] = {kAmassBetas};
  arrays["num_betas"] = NdArray::FromInts32(num_betas, {});
  arrays["gender"] = NdArray::FromString(gender);
  arrays["surface_model_type"] = NdArray::FromString("smplx");
  const double fps = RateForReaders(motion);
  arrays["mocap_frame_rate"] = NdArray::FromDouble(fps);
  arrays["mocap_framerate"] = NdArray::FromDouble(fps);
  arrays["mocap_time_length"] = NdArray::FromDouble(static_cast<double>(T) / fps);
  arrays["timestamps"] = NdArray::FromDoubles(motion.timestamps.data(), {T});
  WriteNpz(path, arrays);
}

}  // namespace bodyloom
