// SPDX-License-Identifier: Apache-2.0
#include "render/uv_maps/descriptor_frames.h"

#include <algorithm>
#include <cstring>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "render/uv_maps/descriptor_maps.h"

namespace bodyloom {

using describe_internal::DescriptorMaps;
using describe_internal::kFramesInFlight;

class DescriptorFrames::Impl {
 public:
  Impl(const BodyModel& body, const Track& track, const DescriptorOptions& options)
      : num_threads_(options.num_threads), num_frames_(track.num_frames()), maps_(body, track, options) {}

  void Planes(std::span<const int> frames, std::span<float> planes) {
    const size_t size = maps_.channels() * maps_.plane_size();
    BODYLOOM_CHECK(planes.size() == size * frames.size(), "descriptor frames: room for ", planes.size(),
                   " values, expected ", size * frames.size());
    for (size_t i = 0; i < frames.size(); ++i) {
      BODYLOOM_CHECK(frames[i] >= 0 && frames[i] < num_frames_, "descriptor frames: frame ", frames[i],
                     ", expected 0 to ", num_frames_ - 1);
      BODYLOOM_CHECK(i == 0 || frames[i] > frames[i - 1], "descriptor frames: frame ", frames[i], " after frame ",
                     frames[i - 1], ", expected rising ones");
    }
    for (size_t first = 0; first < frames.size(); first += kFramesInFlight) {
      const auto chunk = frames.subspan(first, std::min<size_t>(kFramesInFlight, frames.size() - first));
      maps_.PoseFor(chunk);
      maps_.Make();
      ParallelFor(static_cast<int>(chunk.size()), num_threads_, [&](int i) {
        float* to = &planes[size * (first + i)];
        maps_.Use(i, [&](std::span<const std::span<const char>> maps, const DescriptorMaps::FrameSummary&) {
          for (const std::span<const char> map : maps) {
            std::memcpy(to, map.data(), map.size());
            to += map.size() / sizeof(float);
          }
        });
      });
    }
  }

  [[nodiscard]] const DescriptorMaps& maps() const { return maps_; }
  [[nodiscard]] int num_frames() const { return num_frames_; }

 private:
  int num_threads_, num_frames_;
  DescriptorMaps maps_;
};

DescriptorFrames::DescriptorFrames(const BodyModel& body, const Track& track, const DescriptorOptions& options)
    : impl_(std::make_unique<Impl>(body, track, options)) {}
DescriptorFrames::~DescriptorFrames() = default;
DescriptorFrames::DescriptorFrames(DescriptorFrames&&) noexcept = default;
DescriptorFrames& DescriptorFrames::operator=(DescriptorFrames&&) noexcept = default;

int DescriptorFrames::num_frames() const { return impl_->num_frames(); }
int DescriptorFrames::channels() const { return impl_->maps().channels(); }
int DescriptorFrames::height() const { return texels().height; }
int DescriptorFrames::width() const { return texels().width; }
size_t DescriptorFrames::frame_size() const { return channels() * impl_->maps().plane_size(); }
const UvTexelTable& DescriptorFrames::texels() const { return impl_->maps().texels(); }
bool DescriptorFrames::HasFit(int t) const {
  BODYLOOM_CHECK(t >= 0 && t < num_frames(), "descriptor frames: frame ", t, ", expected 0 to ", num_frames() - 1);
  return impl_->maps().HasFit(t);
}
void DescriptorFrames::Planes(int t, std::span<float> planes) { impl_->Planes(std::span(&t, 1), planes); }
void DescriptorFrames::Planes(std::span<const int> frames, std::span<float> planes) { impl_->Planes(frames, planes); }

}  // namespace bodyloom
