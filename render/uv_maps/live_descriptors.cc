// SPDX-License-Identifier: Apache-2.0
#include "render/uv_maps/live_descriptors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/body/skinning.h"
#include "geometry/uv_maps/surface_maps.h"
#include "geometry/uv_maps/surface_velocity.h"
#include "render/uv_maps/descriptor_frames.h"

namespace bodyloom {

using describe_internal::Scratch;
using describe_internal::ScratchPool;
using describe_internal::SurfaceMaps;

class LiveDescriptors::Impl {
 public:
  Impl(const BodyModel& body, const LiveDescriptorsOptions& options)
      : body_(body),
        options_(Checked(options)),
        maps_(body, options.texels, options.weighting, options.normals),
        skinner_(body),
        scratch_(ScratchPool<Scratch>(body.num_vertices(), static_cast<int>(maps_.num_pixels())).Take()),
        vertices_(6 * static_cast<size_t>(body.num_vertices())) {}

  void Push(double timestamp, const BodyPose* pose, const Eigen::VectorXd& betas, std::span<float> planes) {
    BODYLOOM_CHECK(planes.size() == frame_size(), "live descriptors: room for ", planes.size(), " values, expected ",
                   frame_size());
    BODYLOOM_CHECK(std::isfinite(timestamp) && timestamp > last_s_, "live descriptors: time ", timestamp, " after ",
                   last_s_, ", expected a later one");
    if (pose != nullptr) CheckPose(*pose);
    std::optional<ShapedBody> shape;
    if (pose != nullptr) shape = skinner_.Shape(betas);
    if (pose == nullptr || timestamp - last_s_ > options_.longest_step_s) {
      before_.reset();
      velocities_.clear();
    }
    std::fill(planes.begin(), planes.end(), 0.0F);
    if (pose != nullptr) Describe(timestamp, *pose, *shape, planes);
    last_s_ = timestamp;
  }

  [[nodiscard]] int channels() const { return 3 * (options_.normals ? 1 : 0) + 3 * options_.past; }
  [[nodiscard]] size_t frame_size() const { return channels() * maps_.num_pixels(); }
  [[nodiscard]] const UvTexelTable& texels() const { return maps_.texels(); }

 private:
  static const LiveDescriptorsOptions& Checked(const LiveDescriptorsOptions& options) {
    std::string why;
    BODYLOOM_CHECK(options.IsValid(&why), "live descriptors: ", why);
    return options;
  }

  void CheckPose(const BodyPose& pose) const {
    BODYLOOM_CHECK(static_cast<int>(pose.rotations.size()) == body_.num_joints(), "live descriptors: a pose of ",
                   pose.rotations.size(), " joints, the body '", body_.name(), "' has ", body_.num_joints());
    BODYLOOM_CHECK(pose.trans.allFinite() && std::all_of(pose.rotations.begin(), pose.rotations.end(),
                                                         [](const Eigen::Matrix3d& r) { return r.allFinite(); }),
                   "live descriptors: the pose is not finite");
  }

  void Describe(double timestamp, const BodyPose& pose, const ShapedBody& shape, std::span<float> planes) {
    const size_t stride = 3 * static_cast<size_t>(body_.num_vertices()), map = 3 * maps_.num_pixels();
    std::vector<BodyPose> poses;
    if (before_) poses.push_back(*before_);
    poses.push_back(pose);
    MatrixX3d roots;
    skinner_.SkinFromRoot(shape, poses, std::span(vertices_).first(stride * poses.size()), &roots);
    if (options_.normals) {
      NormalSummary summary;
      const std::span<const float> now = std::span(vertices_).subspan(stride * (poses.size() - 1), stride);
      maps_.Normals(now, PoseSkeleton(body_, shape.rest_joints, pose), scratch_.get(), &summary, planes.first(map));
    }
    if (options_.past > 0 && before_) {
      const std::array<double, 2> times = {last_s_, timestamp};
      VelocityStencil stencil;
      stencil.weights = DerivativeWeights(times, timestamp, 1);
      const std::array<const float*, 2> frames = {vertices_.data(), vertices_.data() + stride};
      const std::array<Eigen::Vector3d, 2> places = {roots.row(0).transpose(), roots.row(1).transpose()};
      DifferenceVertices(stencil, frames, places, scratch_->vertices);
      std::vector<float> newest(map, 0.0F);
      if (static_cast<int>(velocities_.size()) == options_.past) {
        newest = std::move(velocities_.back());
        velocities_.pop_back();
      }
      maps_.Velocities(scratch_->vertices, scratch_.get(), newest);
      velocities_.push_front(std::move(newest));
    }
    size_t at = options_.normals ? map : 0;
    for (const std::vector<float>& velocity : velocities_) {
      std::copy(velocity.begin(), velocity.end(), planes.begin() + static_cast<std::ptrdiff_t>(at));
      at += map;
    }
    before_ = pose;
  }

  const BodyModel& body_;
  LiveDescriptorsOptions options_;
  SurfaceMaps maps_;
  Skinner skinner_;
  std::unique_ptr<Scratch> scratch_;
  std::vector<float> vertices_;  ///< of the previous and the current frame
  double last_s_ = -std::numeric_limits<double>::infinity();
  std::optional<BodyPose> before_;             ///< of the previous frame, if no gap lies between
  std::deque<std::vector<float>> velocities_;  ///< maps, newest first
};

bool LiveDescriptorsOptions::IsValid(std::string* why) const {
  DescriptorOptions same;
  same.texels = texels;
  same.past = past;
  same.normals = normals;
  if (!same.IsValid(why)) return false;
  if (!(longest_step_s > 0)) {
    *why = Concatenate("longest_step_s is ", longest_step_s, ", expected more than 0");
    return false;
  }
  return true;
}

LiveDescriptors::LiveDescriptors(const BodyModel& body, const LiveDescriptorsOptions& options)
    : impl_(std::make_unique<Impl>(body, options)) {}
LiveDescriptors::~LiveDescriptors() = default;
LiveDescriptors::LiveDescriptors(LiveDescriptors&&) noexcept = default;
LiveDescriptors& LiveDescriptors::operator=(LiveDescriptors&&) noexcept = default;

int LiveDescriptors::channels() const { return impl_->channels(); }
const UvTexelTable& LiveDescriptors::texels() const { return impl_->texels(); }
size_t LiveDescriptors::frame_size() const { return impl_->frame_size(); }
void LiveDescriptors::Push(double timestamp, const BodyPose* pose, const Eigen::VectorXd& betas,
                           std::span<float> planes) {
  impl_->Push(timestamp, pose, betas, planes);
}

}  // namespace bodyloom
