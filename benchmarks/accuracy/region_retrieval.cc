// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/region_retrieval.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "data_tools/descriptors/photo_maps.h"
#include "geometry/base/check.h"
#include "geometry/scene/observations.h"
#include "geometry/uv_maps/uv_texels.h"

namespace bodyloom {
namespace {

constexpr double kMinSeen = 0.25;

struct RegionPlan {
  const char* name;
  std::vector<uint8_t> parts;  // DensePose's numbers
  std::vector<std::string> landmarks;
};

const RegionPlan& PlanOf(RetrievedRegion region) {
  static const std::array<RegionPlan, 3> kPlans = {
      RegionPlan{"hand", {3, 20, 22}, {"right_wrist", "right_elbow"}},
      RegionPlan{"torso", {1, 2}, {"left_shoulder", "right_shoulder", "left_hip", "right_hip"}},
      RegionPlan{"leg", {7, 9, 11, 13}, {"right_knee", "right_ankle"}}};
  return kPlans[static_cast<size_t>(region)];
}

/// Frame t's atlas coordinates, and for each pixel whether it sees the region.
std::vector<bool> SeesRegion(const PersonFrames& frames, const RegionOfBody& region, int t, std::vector<float>* uv,
                             std::vector<float>* mask) {
  const size_t area = mask->size();
  frames.BodyMaps(t, *uv, *mask);
  std::vector<bool> sees(area);
  const auto texel = [&](float x) { return std::clamp(static_cast<int>(x * float(region.side)), 0, region.side - 1); };
  for (size_t p = 0; p < area; ++p) {
    if ((*mask)[p] <= 0) continue;
    const int column = texel((*uv)[p]), row = texel(1 - (*uv)[area + p]);
    sees[p] = region.texels[size_t(row) * size_t(region.side) + size_t(column)];
  }
  return sees;
}

}  // namespace

const char* RegionName(RetrievedRegion region) { return PlanOf(region).name; }

RegionOfBody MakeRegion(const BodyModel& body, RetrievedRegion region, int side) {
  const RegionPlan& plan = PlanOf(region);
  RegionOfBody result;
  for (const std::string& name : plan.landmarks) {
    const auto found = std::find(CocoNames().begin(), CocoNames().end(), name);
    result.landmarks.push_back(static_cast<int>(found - CocoNames().begin()));
  }
  UvTexelOptions options;
  options.width = options.height = result.side = side;
  for (const uint8_t part : PartsOfTexels(body, BuildUvTexelTable(body, options))) {
    result.texels.push_back(std::find(plan.parts.begin(), plan.parts.end(), part) != plan.parts.end());
  }
  return result;
}

DescriptorRows KeypointsOfRegion(const DescriptorRows& whole, const RegionOfBody& region) {
  const auto width = static_cast<Eigen::Index>(2 * CocoNames().size());
  BODYLOOM_CHECK(whole.cols() % width == 0, "keypoints of a region: ", whole.cols(),
                 " columns, expected a multiple of ", width);
  const Eigen::Index past = whole.cols() / width;
  DescriptorRows rows(whole.rows(), static_cast<Eigen::Index>(2 * region.landmarks.size()) * past);
  Eigen::Index column = 0;
  for (Eigen::Index k = 0; k < past; ++k) {
    for (const int landmark : region.landmarks) {
      rows.middleCols(column, 2) = whole.middleCols(k * width + 2 * static_cast<Eigen::Index>(landmark), 2);
      column += 2;
    }
  }
  return rows;
}

DescriptorRows DenseCoordinatesOfRegion(const PersonFrames& frames, const RegionOfBody& region, int past) {
  const size_t area = size_t(frames.window().width) * size_t(frames.window().height);
  std::vector<float> uv(2 * area), mask(area);
  DescriptorRows rows(frames.num_frames(), static_cast<Eigen::Index>(2 * area));
  for (int t = 0; t < frames.num_frames(); ++t) {
    const std::vector<bool> sees = SeesRegion(frames, region, t, &uv, &mask);
    for (size_t p = 0; p < area; ++p) {
      if (!sees[p]) uv[p] = uv[area + p] = 0;
    }
    std::copy(uv.begin(), uv.end(), rows.row(t).data());
  }
  return WithPast(rows, past);
}

DescriptorRows MotionOfRegion(const DescriptorRows& whole, const RegionOfBody& region) {
  const auto area = static_cast<Eigen::Index>(region.texels.size());
  BODYLOOM_CHECK(area > 0 && whole.cols() % area == 0, "motion of a region: maps of ", whole.cols(),
                 " values, expected a multiple of the atlas' ", area);
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < whole.cols(); ++i) {
    if (region.texels[static_cast<size_t>(i % area)]) columns.push_back(i);
  }
  return whole(Eigen::all, columns);
}

std::vector<bool> RegionSeen(const PersonFrames& frames, const RegionOfBody& region, int past) {
  const size_t area = size_t(frames.window().width) * size_t(frames.window().height);
  std::vector<float> uv(2 * area), mask(area);
  std::vector<ptrdiff_t> pixels;
  for (int t = 0; t < frames.num_frames(); ++t) {
    const std::vector<bool> sees = SeesRegion(frames, region, t, &uv, &mask);
    pixels.push_back(std::count(sees.begin(), sees.end(), true));
  }
  std::vector<ptrdiff_t> sorted = pixels;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double minimum = kMinSeen * static_cast<double>(sorted[sorted.size() / 2]);
  std::vector<bool> seen(pixels.size(), true);
  for (size_t t = 0; t < pixels.size(); ++t) {
    for (size_t k = 0; k < size_t(past) && k <= t; ++k) {
      seen[t] = seen[t] && pixels[t - k] > 0 && static_cast<double>(pixels[t - k]) >= minimum;
    }
  }
  return seen;
}

}  // namespace bodyloom
