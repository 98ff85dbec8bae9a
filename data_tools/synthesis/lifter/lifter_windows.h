// SPDX-License-Identifier: Apache-2.0
/// Random training windows for the lifter: recorded motion with augmentation, a random camera and simulated detections.
/// Contents and rationale: docs/lab/lifter.md, "Training data".
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "data_tools/synthesis/lifter/floor_poses.h"
#include "data_tools/synthesis/lifter/lifter_detections.h"
#include "data_tools/synthesis/lifter/lifter_window_options.h"
#include "data_tools/synthesis/lifter/pose_augmentation.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// T frames. Targets are in each frame's virtual camera as MakeLifterInput computes it from these detections; if the
/// focal length is unknown, features are from rays with a wrong one and targets in the virtual camera of the true one,
/// from which the detections look the same.
struct LifterWindow {
  std::vector<float> features;    ///< T·kLifterInputs
  std::vector<float> points;      ///< T·21·3 relative to the mid-hip, in units of Lref
  std::vector<float> up;          ///< T·3 unit
  std::vector<float> contact;     ///< T·2 left, right: 0 or 1
  std::vector<float> confidence;  ///< T·21 of the detections, 0: missing
};

class LifterWindowGenerator {
 public:
  /// `motions`: 24 joints, y up, on a flat floor where has_floor says so; copied into a compact form (24 quaternions a
  /// frame at 60 frames a second). Throws std::invalid_argument, naming the motion by its index, for motions that
  /// cannot be used, when there are none, when has_floor has another length, and for options that are not valid.
  LifterWindowGenerator(const std::vector<Motion>& motions, const std::vector<char>& has_floor, const BodyModel& body,
                        const LifterWindowOptions& options);

  /// The same seed gives the same window. Thread-safe.
  void Generate(uint64_t seed, LifterWindow* window) const;

  /// The steps of Generate(), one after the other, for tests and plots.
  [[nodiscard]] PoseSequence MakePoses(uint64_t seed, const LifterPerson& person) const;
  [[nodiscard]] LifterPerson MakePerson(uint64_t seed) const;
  [[nodiscard]] LifterScene MakeScene(uint64_t seed, const LifterPerson& person, const PoseSequence& poses) const;
  [[nodiscard]] LifterFrames Detect(uint64_t seed, const LifterScene& scene) const;
  void MakeWindow(uint64_t seed, const LifterScene& scene, const LifterFrames& frames, LifterWindow* window) const;

  [[nodiscard]] const LifterBody& body() const { return body_; }
  [[nodiscard]] const LifterWindowOptions& options() const { return options_; }

 private:
  LifterWindowOptions options_;
  LifterBody body_;
  PoseLimits limits_;
  std::vector<LifterClip> clips_;
  ClipChoice choice_;
};

}  // namespace bodyloom
