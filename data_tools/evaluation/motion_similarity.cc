// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/motion_similarity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

DescriptorRows Standardised(const DescriptorRows& rows) {
  DescriptorRows result = rows.colwise() - rows.rowwise().mean();
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    const float norm = result.row(t).norm();
    if (norm > 0) result.row(t) /= norm;
  }
  return result;
}

DescriptorRows Described(const BodyModel& body, const Track& track, int past, int num_threads,
                         const SurfaceMotion& motion) {
  PersonFramesOptions options;
  options.motion = motion;
  options.uv_size = 32;
  options.past = past;
  options.num_threads = num_threads;
  return MotionDescriptors(PersonFrames(body, track, options), past);
}

}  // namespace

DescriptorRows MotionDescriptors(const PersonFrames& frames, int past) {
  BODYLOOM_CHECK(past >= 0 && past <= frames.options().past, "motion descriptors: ", past, " past frames of ",
                 frames.options().past);
  const size_t texels = size_t(frames.options().uv_size) * frames.options().uv_size;
  const size_t size = (3 + 3 * size_t(past)) * texels;
  DescriptorRows rows(frames.num_frames(), Eigen::Index(size));
  std::vector<float> maps(frames.channels() * texels);
  for (int t = 0; t < frames.num_frames(); ++t) {
    frames.MotionMaps(t, maps);
    std::copy_n(maps.begin(), size, rows.row(t).data());
  }
  return rows;
}

Eigen::MatrixXf NormalisedCrossCorrelation(const DescriptorRows& a, const DescriptorRows& b) {
  BODYLOOM_CHECK(a.cols() == b.cols(), "descriptors of ", a.cols(), " and ", b.cols(), " values");
  return Standardised(a) * Standardised(b).transpose();
}

std::vector<float> SimilarityToNearest(const BodyModel& body, const Track& track, const Track& others, int past,
                                       int num_threads, const SurfaceMotion& motion, std::span<const char> counts) {
  BODYLOOM_CHECK(counts.empty() || static_cast<int>(counts.size()) == others.num_frames(),
                 "motion similarity: ", counts.size(), " flags of ", others.num_frames(), " frames");
  const Eigen::MatrixXf similarity = NormalisedCrossCorrelation(Described(body, track, past, num_threads, motion),
                                                                Described(body, others, past, num_threads, motion));
  std::vector<float> nearest(track.num_frames(), std::numeric_limits<float>::quiet_NaN());
  for (int t = 0; t < track.num_frames(); ++t) {
    if (!track.HasResult(t)) continue;
    for (int s = 0; s < others.num_frames(); ++s) {
      if (!others.HasResult(s) || (!counts.empty() && counts[s] == 0)) continue;
      nearest[t] = std::isnan(nearest[t]) ? similarity(t, s) : std::max(nearest[t], similarity(t, s));
    }
  }
  return nearest;
}

}  // namespace bodyloom
