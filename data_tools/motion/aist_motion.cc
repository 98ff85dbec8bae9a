// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_readers.h"

#include <cmath>
#include <stdexcept>

#include "data_tools/motion/skeleton_motion.h"
#include "geometry/base/units.h"

namespace bodyloom {
namespace {

double ScalingOf(const PickleValue& file, const std::string& where) {
  const PickleValue* value = file.Find("smpl_scaling");
  double scaling = NAN;
  if (value != nullptr && value->kind == PickleValue::Kind::kFloat) scaling = value->real;
  if (value != nullptr && value->kind == PickleValue::Kind::kArray && value->array.is_number() &&
      value->array.num_elements() == 1) {
    scaling = value->array.ToDoubles()[0];
  }
  if (!(scaling > 0) || !std::isfinite(scaling)) {
    throw std::runtime_error(where + ": smpl_scaling: expected one positive number");
  }
  return scaling;
}

}  // namespace

double AistBodyScale(const PickleValue& file, const std::string& where) { return kCentimetre * ScalingOf(file, where); }

bool IsAistMotion(const PickleValue& file) { return file.Find("smpl_poses") != nullptr; }

Motion AistMotionFromPickle(const PickleValue& file, const std::string& where, double fps) {
  const NdArray& poses = RequireNumbers(file, "smpl_poses", where);
  const bool is_flat = poses.shape.size() == 2 && poses.shape[1] == 72;
  const bool is_nested = poses.shape.size() == 3 && poses.shape[1] == 24 && poses.shape[2] == 3;
  if ((!is_flat && !is_nested) || poses.shape[0] == 0) {
    throw std::runtime_error(where + ": smpl_poses: shape " + poses.ShapeText() +
                             ", expected frames x 72 or frames x 24 x 3");
  }
  const int64_t T = poses.shape[0];
  const NdArray& trans = RequireNumbers(file, "smpl_trans", where);
  if (trans.shape != std::vector<int64_t>{T, 3}) {
    throw std::runtime_error(where + ": smpl_trans: shape " + trans.ShapeText() + ", expected " + std::to_string(T) +
                             "x3");
  }
  Motion motion;
  motion.body = "smpl";
  motion.up = Motion::Up::kY;
  motion.poses = poses.ToMatrix();
  motion.trans = trans.ToMatrix() / ScalingOf(file, where);
  if (!motion.poses.allFinite() || !motion.trans.allFinite()) {
    throw std::runtime_error(where + ": smpl_poses or smpl_trans is not finite");
  }
  motion.timestamps = RegularTimestamps(static_cast<int>(T), 1 / fps);
  return motion;
}

}  // namespace bodyloom
