// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_readers.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/object_npy.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Kind = PickleValue::Kind;

constexpr size_t kMaxJoints = 1000;

const PickleValue& Require(const PickleValue& table, const std::string& key, Kind kind, const std::string& where) {
  const PickleValue* value = table.Find(key);
  if (value == nullptr || value->kind != kind)
    ThrowFileError(where, "no '" + key + "' of the right kind, expected a SkeletonMotion");
  return *value;
}

/// table[key]["arr"] with that shape; −1 stands for any size.
const NdArray& RequireArr(const PickleValue& table, const std::string& key, const std::vector<int64_t>& shape,
                          const std::string& where) {
  const NdArray& array = Require(Require(table, key, Kind::kDict, where), "arr", Kind::kArray, where).array;
  bool is_right = array.is_number() && array.shape.size() == shape.size();
  for (size_t i = 0; is_right && i < shape.size(); ++i) is_right = shape[i] < 0 || array.shape[i] == shape[i];
  if (!is_right) {
    NdArray expected;
    expected.shape = shape;
    ThrowFileError(where,
                   key + ": shape " + array.ShapeText() + ", expected " + expected.ShapeText() + " numbers (-1: any)");
  }
  return array;
}

}  // namespace

SkeletonMotion AmpFromNpyBytes(const std::string& bytes, const std::string& where) {
  const PicklePtr file = ReadObjectNpy(bytes, where);
  if (file->kind != Kind::kDict)
    ThrowFileError(where, "the pickled object is no dictionary, expected a SkeletonMotion");

  const PickleValue& tree = Require(*file, "skeleton_tree", Kind::kDict, where);
  const PickleValue& names = Require(tree, "node_names", Kind::kList, where);
  SkeletonMotion motion;
  for (const PicklePtr& name : names.items) motion.names.push_back(name->text);
  const auto J = static_cast<int64_t>(motion.names.size());
  if (J == 0 || motion.names.size() > kMaxJoints) ThrowFileError(where, "node_names: " + std::to_string(J) + " joints");
  const std::vector<int64_t> parents =
      WholeNumbers(RequireArr(tree, "parent_indices", {J}, where), "parent_indices", where);
  for (int64_t j = 0; j < J; ++j) {
    if (j == 0 ? parents[j] != -1 : (parents[j] < 0 || parents[j] >= j)) {
      ThrowFileError(where, "parent_indices[" + std::to_string(j) + "] is " + std::to_string(parents[j]) +
                                ", expected -1 for the first joint and an earlier joint for the others");
    }
    motion.parents.push_back(static_cast<int>(parents[j]));
  }
  motion.offsets = RequireArr(tree, "local_translation", {J, 3}, where).ToMatrix();

  const NdArray& rotation = RequireArr(*file, "rotation", {-1, J, 4}, where);
  const int64_t T = rotation.shape[0];
  if (T == 0) ThrowFileError(where, "rotation: no frames");
  if (static_cast<size_t>(T * J) > kMaxRotations)
    ThrowFileError(where, "rotation: " + std::to_string(T) + " frames are too many");
  motion.root_positions = RequireArr(*file, "root_translation", {T, 3}, where).ToMatrix();
  if (!motion.root_positions.allFinite() || !motion.offsets.allFinite()) {
    ThrowFileError(where, "root_translation or local_translation is not finite");
  }
  const PickleValue* is_local = file->Find("is_local");
  const bool are_local = is_local == nullptr || is_local->kind != Kind::kBool || is_local->boolean;
  const std::vector<double> q = rotation.ToDoubles();
  motion.rotations.resize(T * J);
  for (int64_t i = 0; i < T * J; ++i) {
    const Eigen::Quaterniond quaternion(q[4 * i + 3], q[4 * i], q[4 * i + 1], q[4 * i + 2]);
    if (!(quaternion.norm() > 0.5 && quaternion.norm() < 2)) {
      ThrowFileError(where, "rotation of frame " + std::to_string(i / J) + ", joint '" +
                                PrintableText(motion.names[i % J]) + "': a quaternion of length " +
                                std::to_string(quaternion.norm()) + ", expected 1");
    }
    motion.rotations[i] = quaternion.normalized().toRotationMatrix();
  }
  for (int64_t t = 0; !are_local && t < T; ++t) {  // world rotations → relative, leaves first
    Eigen::Matrix3d* frame = motion.rotations.data() + t * J;
    for (int64_t j = J; --j > 0;) frame[j] = frame[motion.parents[j]].transpose() * frame[j];
  }
  const double fps = NumberOf(file->Find("fps"));
  if (!(fps > 0 && fps < 1e5)) ThrowFileError(where, "fps is " + std::to_string(fps) + ", expected a positive number");
  motion.timestamps = RegularTimestamps(static_cast<int>(T), 1 / fps);
  return motion;
}

}  // namespace bodyloom
