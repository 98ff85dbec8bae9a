// SPDX-License-Identifier: Apache-2.0
/// Motion descriptors of a body tracked live: planes are computed pose by pose, without delay.
///
/// The planes are those of descriptor_frames.h with velocities by backward differences, the only scheme that needs no
/// later frame: V_t = (x_t − x_{t−1}) / (t_t − t_{t−1}). They lag half a frame.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>

#include "geometry/body/body_model.h"
#include "geometry/body/normals.h"
#include "geometry/body/posed_body.h"
#include "geometry/uv_maps/uv_texels.h"

namespace bodyloom {

struct LiveDescriptorsOptions {
  UvTexelOptions texels;
  int past = 10;        ///< velocity maps per frame, its own included; 0 to 1000
  bool normals = true;  ///< the three channels of N
  NormalWeighting weighting = NormalWeighting::kArea;
  double longest_step_s = 0.1;  ///< no differences across longer steps between frames
  /// False with the reason when a field is out of range.
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Time and memory per frame are bounded. Not for use by two threads at once.
class LiveDescriptors {
 public:
  /// Borrows the body. Throws std::invalid_argument when options are not valid or the body has no UV map.
  explicit LiveDescriptors(const BodyModel& body, const LiveDescriptorsOptions& options = {});
  ~LiveDescriptors();
  LiveDescriptors(LiveDescriptors&&) noexcept;
  LiveDescriptors& operator=(LiveDescriptors&&) noexcept;

  [[nodiscard]] int channels() const;
  [[nodiscard]] const UvTexelTable& texels() const;
  /// Number of values per frame: channels · height · width.
  [[nodiscard]] size_t frame_size() const;

  /// Computes the planes (C×H×W) of the pose at `timestamp` seconds, in the axes of the pose. `pose` null: the person
  /// is lost; all planes are zero, and the next pose starts a run with zero velocity. The shape may change from frame
  /// to frame, as a live tracker refines it: both poses of a difference use the newer one.
  /// Throws std::invalid_argument, and changes nothing, when the timestamp does not increase, the pose is not the
  /// body's or not finite, or `planes` is not of frame_size().
  void Push(double timestamp, const BodyPose* pose, const Eigen::VectorXd& betas, std::span<float> planes);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
