// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/avatar/motion_maps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/geometry/rotation.h"
#include "bodyloom/render/track_world.h"

namespace bodyloom {
namespace {

constexpr int kStride = 10;  ///< frames whose velocities are averaged
constexpr int kLookedBack = AvatarMotionMaps::kSingle + kStride * AvatarMotionMaps::kStrides;

std::vector<int> FramesBack(const Track& track, double fps) {
  const double rate = MotionRate(track);
  std::vector<int> back;
  back.reserve(kLookedBack);
  for (int k = 0; k < kLookedBack; ++k) back.push_back(static_cast<int>(std::lround(k * rate / fps)));
  return back;
}

PersonFramesOptions MapOptions(int side, int past, std::vector<int> shown, int num_threads) {
  PersonFramesOptions options;
  options.uv_size = side;
  options.past = past;
  options.shown = std::move(shown);
  options.num_threads = num_threads;
  return options;
}

}  // namespace

double MotionRate(const Track& track) {
  const double fps = FrameRateWithoutGaps(track.motion);
  return fps > 0 ? fps : 30;
}

AvatarMotionMaps::AvatarMotionMaps(const BodyModel& body, const Track& track, int side, double fps,
                                   std::vector<int> shown, int num_threads)
    : track_(track),
      shown_(shown),
      up_(WorldOfTracks({&track}, track.joints).up_in_camera().cast<float>()),
      back_(FramesBack(track, fps)),
      frames_(body, track, MapOptions(side, back_.back() + 1, std::move(shown), num_threads)),
      all_(static_cast<size_t>(frames_.channels()) * side * side) {}

Eigen::Matrix3f AvatarMotionMaps::PelvisFromCamera(int t) const {
  const int frame = shown_.empty() ? t : shown_[t];
  if (!track_.motion.HasPose(frame)) return Eigen::Matrix3f::Zero();
  return RotationFromAxisAngle(track_.motion.poses.row(frame).head<3>().transpose()).transpose().cast<float>();
}

void AvatarMotionMaps::Maps(int t, std::span<float> maps) {
  frames_.MotionMaps(t, all_);
  const size_t texels = all_.size() / frames_.channels(), three = 3 * texels;
  const auto velocity = [&](int k) { return all_.begin() + static_cast<ptrdiff_t>(three * (1 + back_[k])); };
  std::copy_n(all_.begin(), three, maps.begin());
  for (int k = 0; k < kSingle; ++k) {
    std::copy_n(velocity(k), three, maps.begin() + static_cast<ptrdiff_t>(three * (1 + k)));
  }
  for (int stride = 0; stride < kStrides; ++stride) {
    float* mean = maps.data() + three * (1 + kSingle + stride);
    std::fill_n(mean, three, 0.0F);
    for (int k = kSingle + stride * kStride; k < kSingle + (stride + 1) * kStride; ++k) {
      const auto v = velocity(k);
      for (size_t i = 0; i < three; ++i) mean[i] += v[static_cast<ptrdiff_t>(i)] / kStride;
    }
  }
  float* up = maps.data() + three * (kChannels / 3 - 1);
  for (size_t i = 0; i < three; ++i) up[i] = up_[static_cast<Eigen::Index>(i / texels)];
  const Eigen::Matrix3f turn = PelvisFromCamera(t);
  for (float* map = maps.data(); map <= up; map += three) {
    for (size_t i = 0; i < texels; ++i) {
      const Eigen::Vector3f v = turn * Eigen::Vector3f(map[i], map[texels + i], map[2 * texels + i]);
      for (int c = 0; c < 3; ++c) map[c * texels + i] = v[c];
    }
  }
}

}  // namespace bodyloom
