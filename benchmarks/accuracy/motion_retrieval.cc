// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/motion_retrieval.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/observations.h"

namespace bodyloom {
namespace {

constexpr double kPeakShare = 0.9, kSlow = 1 / 3.0;
constexpr int kReach = 4;

DescriptorRows Chosen(const DescriptorRows& rows, const std::vector<int>& frames) {
  DescriptorRows chosen(Eigen::Index(frames.size()), rows.cols());
  for (size_t i = 0; i < frames.size(); ++i) chosen.row(Eigen::Index(i)) = rows.row(frames[i]);
  return chosen;
}

}  // namespace

DescriptorRows WithPast(const DescriptorRows& rows, int past) {
  BODYLOOM_CHECK(past >= 1, "descriptors of ", past, " frames");
  DescriptorRows result(rows.rows(), rows.cols() * past);
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    for (int k = 0; k < past; ++k) {
      result.row(t).segment(rows.cols() * k, rows.cols()) = rows.row(std::max<Eigen::Index>(0, t - k));
    }
  }
  return result;
}

DescriptorRows KeypointTrajectories(const BodyModel& body, const Track& track, int past, double noise_px,
                                    uint64_t seed) {
  const int count = static_cast<int>(CocoNames().size());
  DescriptorRows rows(track.num_frames(), 2 * count);
  for (int t = 0; t < track.num_frames(); ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
    const MatrixX3d points = PoseLandmarks(body, track.motion.betas, pose, CocoNames());
    HashRandom noise(seed, {uint64_t(t)});
    Eigen::Matrix2Xd pixels(2, count);
    for (int k = 0; k < count; ++k) {
      Eigen::Vector2d pixel;
      BODYLOOM_CHECK(track.CameraAt(t).Project(points.row(k).transpose(), &pixel), "frame ", t,
                     ": a landmark is behind the camera");
      const double y = noise.Normal(), x = noise.Normal();
      pixels.col(k) = pixel + noise_px * Eigen::Vector2d(x, y);
    }
    pixels.colwise() -= pixels.rowwise().mean().eval();
    rows.row(t) = pixels.reshaped().transpose().cast<float>();
  }
  return WithPast(rows, past);
}

DescriptorRows DenseCoordinates(const PersonFrames& frames, int past) {
  const size_t area = size_t(frames.window().width) * frames.window().height;
  DescriptorRows rows(frames.num_frames(), Eigen::Index(2 * area));
  std::vector<float> mask(area);
  for (int t = 0; t < frames.num_frames(); ++t) frames.BodyMaps(t, {rows.row(t).data(), 2 * area}, mask);
  return WithPast(rows, past);
}

std::vector<int> Peaks(std::span<const float> curve, double share, int reach) {
  std::vector<int> peaks;
  if (curve.empty()) return peaks;
  const double minimum = share * *std::max_element(curve.begin(), curve.end());
  const int count = static_cast<int>(curve.size());
  for (int i = 1; i + 1 < count; ++i) {
    const int begin = std::max(0, i - reach), end = std::min(count, i + reach + 1);
    const auto largest = std::max_element(curve.begin() + begin, curve.begin() + end);
    if (largest - curve.begin() == i && curve[i] >= minimum) peaks.push_back(i);
  }
  return peaks;
}

std::vector<int> TurningFrames(const TurningPerson& person, bool first) {
  double fastest = 0;
  for (const double rate : person.yaw_rate_deg_s) fastest = std::max(fastest, std::abs(rate));
  std::vector<int> frames;
  for (int t = 0; t < static_cast<int>(person.cycle.size()); ++t) {
    const bool counts = first ? person.cycle[t] == 0 : person.cycle[t] > 0;
    if (counts && std::abs(person.yaw_rate_deg_s[t]) > kSlow * fastest) frames.push_back(t);
  }
  return frames;
}

RetrievalScores ScoreRetrieval(const TurningPerson& person, const DescriptorRows& descriptors,
                               const std::vector<bool>& defined) {
  BODYLOOM_CHECK(descriptors.rows() == Eigen::Index(person.cycle.size()), "retrieval: ", descriptors.rows(),
                 " descriptors of ", person.cycle.size(), " frames");
  BODYLOOM_CHECK(defined.empty() || defined.size() == person.cycle.size(), "retrieval: ", defined.size(), " marks of ",
                 person.cycle.size(), " frames");
  const auto is_defined = [&](int t) { return defined.empty() || defined[size_t(t)]; };
  RetrievalScores scores;
  std::vector<int> reference, later;
  for (int t = 0; t < static_cast<int>(person.cycle.size()); ++t) {
    if (person.cycle[t] == 0 && is_defined(t)) reference.push_back(t);
    if (person.cycle[t] > 0) later.push_back(t);
  }
  BODYLOOM_CHECK(!reference.empty() && !later.empty(), "retrieval: expected at least two cycles that are described");
  const int cycles = person.cycle.back();
  // (later × reference): a column is the curve of a frame of the first cycle, a row all that a later frame looks like.
  Eigen::MatrixXf correlation = NormalisedCrossCorrelation(Chosen(descriptors, later), Chosen(descriptors, reference));
  for (size_t q = 0; q < later.size(); ++q) {
    if (!is_defined(later[q])) correlation.row(Eigen::Index(q)).setConstant(-1);
  }
  const std::vector<int> turning = TurningFrames(person, true), queries = TurningFrames(person, false);
  const auto asked = std::count_if(turning.begin(), turning.end(), is_defined);
  for (size_t r = 0; r < reference.size(); ++r) {
    if (!std::binary_search(turning.begin(), turning.end(), reference[r])) continue;
    const auto peaks = Peaks({correlation.col(Eigen::Index(r)).data(), later.size()}, kPeakShare, kReach).size();
    scores.peaks_a_cycle += double(peaks) / cycles / double(asked);
    scores.one_peak_share += (peaks == size_t(cycles) ? 1.0 : 0.0) / double(asked);
  }
  const auto answered = std::count_if(queries.begin(), queries.end(), is_defined);
  scores.queries = static_cast<int>(queries.size());
  scores.answered_share = double(answered) / scores.queries;
  for (size_t q = 0; q < later.size(); ++q) {
    if (!is_defined(later[q]) || !std::binary_search(queries.begin(), queries.end(), later[q])) continue;
    Eigen::Index best = 0;
    correlation.row(Eigen::Index(q)).maxCoeff(&best);
    const int found = reference[best], t = later[q];
    const bool right = (person.yaw_rate_deg_s[found] > 0) == (person.yaw_rate_deg_s[t] > 0);
    scores.direction_share += (right ? 1.0 : 0.0) / double(answered);
    scores.yaw_error_deg += std::abs(person.yaw_deg[found] - person.yaw_deg[t]) / double(answered);
  }
  return scores;
}

}  // namespace bodyloom
