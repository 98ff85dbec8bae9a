// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_readers.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

constexpr int kNumbersPerFrame = 44;

enum class JointKind { kSpherical, kHinge, kFixed };

struct SkeletonJoint {
  const char* name;
  int parent;
  double x, y, z;  ///< offset from the parent, metres
  JointKind kind;
};

constexpr SkeletonJoint kSkeleton[] = {
    {"root", -1, 0, 0, 0, JointKind::kSpherical},
    {"chest", 0, 0, 0.236151, 0, JointKind::kSpherical},
    {"neck", 1, 0, 0.223894, 0, JointKind::kSpherical},
    {"right_hip", 0, 0, 0, 0.084887, JointKind::kSpherical},
    {"right_knee", 3, 0, -0.421546, 0, JointKind::kHinge},
    {"right_ankle", 4, 0, -0.409870, 0, JointKind::kSpherical},
    {"right_shoulder", 1, -0.02405, 0.24350, 0.18311, JointKind::kSpherical},
    {"right_elbow", 6, 0, -0.274788, 0, JointKind::kHinge},
    {"right_wrist", 7, 0, -0.258947, 0, JointKind::kFixed},
    {"left_hip", 0, 0, 0, -0.084887, JointKind::kSpherical},
    {"left_knee", 9, 0, -0.421546, 0, JointKind::kHinge},
    {"left_ankle", 10, 0, -0.409870, 0, JointKind::kSpherical},
    {"left_shoulder", 1, -0.02405, 0.24350, -0.18311, JointKind::kSpherical},
    {"left_elbow", 12, 0, -0.274788, 0, JointKind::kHinge},
    {"left_wrist", 13, 0, -0.258947, 0, JointKind::kFixed},
};
constexpr int kNumJoints = static_cast<int>(std::size(kSkeleton));

}  // namespace

bool IsDeepMimicJson(const JsonNode& document) { return document.Has("Frames"); }

SkeletonMotion DeepMimicFromJson(const JsonNode& document) {
  SkeletonMotion motion;
  motion.offsets.resize(kNumJoints, 3);
  for (int j = 0; j < kNumJoints; ++j) {
    motion.names.emplace_back(kSkeleton[j].name);
    motion.parents.push_back(kSkeleton[j].parent);
    motion.offsets.row(j) << kSkeleton[j].x, kSkeleton[j].y, kSkeleton[j].z;
  }
  const JsonNode frames = document.At("Frames");
  if (!frames.is_array() || frames.size() == 0) frames.Fail("a list of frames that is not empty");
  const size_t num_frames = frames.size();
  motion.rotations.resize(num_frames * kNumJoints, Eigen::Matrix3d::Identity());
  motion.root_positions.resize(static_cast<Eigen::Index>(num_frames), 3);
  double time = 0;
  for (size_t t = 0; t < num_frames; ++t) {
    const JsonNode frame = frames.At(t);
    const std::vector<double> values = frame.Numbers(kNumbersPerFrame);
    motion.timestamps.push_back(time);
    time += values[0];
    if (!(values[0] > 0) && t + 1 < num_frames) {
      throw std::runtime_error(frame.place() + ": duration " + std::to_string(values[0]) + " s, expected positive");
    }
    motion.root_positions.row(t) << values[1], values[2], values[3];
    const double* next = values.data() + 4;
    for (int j = 0; j < kNumJoints; ++j) {
      Eigen::Matrix3d& rotation = motion.rotations[t * kNumJoints + j];
      if (kSkeleton[j].kind == JointKind::kHinge) {
        rotation = RotationFromAxisAngle(Eigen::Vector3d::UnitZ() * *next++);
      } else if (kSkeleton[j].kind == JointKind::kSpherical) {
        const Eigen::Quaterniond q(next[0], next[1], next[2], next[3]);
        next += 4;
        if (!(q.norm() > 0.5 && q.norm() < 2)) {  // some published clips are as far off as 0.85
          throw std::runtime_error(frame.place() + ": quaternion of '" + kSkeleton[j].name + "' has length " +
                                   std::to_string(q.norm()) + ", expected 1");
        }
        rotation = q.normalized().toRotationMatrix();
      }
    }
  }
  return motion;
}

}  // namespace bodyloom
