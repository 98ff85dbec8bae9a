// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/speed/moving_body.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/track_io.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "geometry/uv_maps/descriptor_options.h"
#include "geometry/uv_maps/surface_velocity.h"

namespace bodyloom {

using Eigen::Vector3d;

namespace {

/// Velocities of all vertices by frame, V×3 m/s; empty where the frame has none.
std::vector<std::vector<float>> VertexVelocities(const BodyModel& body, const Track& track,
                                                 const SurfaceMotion& motion) {
  const auto poses = PosesInFrame(body, track, motion.frame, motion.camera_pose);
  const int T = track.num_frames();
  std::vector<char> usable(T);
  std::vector<BodyPose> all(T);
  for (int t = 0; t < T; ++t) {
    usable[t] = poses[t].has_value();
    all[t] = usable[t] != 0 ? *poses[t] : PoseFromAxisAngle(body, Eigen::VectorXd::Zero(3), Vector3d::Zero());
  }
  const std::vector<VelocityStencil> stencils = VelocityStencils(track.motion.timestamps, usable, motion.velocity);
  const Skinner skinner(body, {.num_threads = 2, .vertices = {}, .skip_resting_joints = true});
  const VelocitySkinner velocity_skinner(body);
  const ShapedBody shape = skinner.Shape(track.motion.betas);
  const size_t stride = 3 * size_t(body.num_vertices());
  std::vector<float> vertices(stride * T);
  MatrixX3d root_rows;
  skinner.SkinFromRoot(shape, all, vertices, &root_rows);
  std::vector<Vector3d> roots;
  roots.reserve(T);
  for (int t = 0; t < T; ++t) roots.push_back(root_rows.row(t).transpose());
  std::vector<std::vector<float>> velocities(T);
  for (int t = 0; t < T; ++t) {
    const VelocityStencil& stencil = stencils[t];
    const size_t n = stencil.weights.size();
    if (n == 0) continue;
    velocities[t].resize(stride);
    if (motion.analytic) {
      std::vector<const BodyPose*> around;
      for (size_t k = 0; k < n; ++k) around.push_back(&all[stencil.first_frame + k]);
      const PoseRates rates = RatesOf(stencil, around, all[t]);
      velocity_skinner.Velocities(shape, std::span(&all[t], 1), std::span(&rates, 1), velocities[t], 1);
    } else {
      std::vector<const float*> frames;
      for (size_t k = 0; k < n; ++k) frames.push_back(&vertices[stride * (stencil.first_frame + k)]);
      DifferenceVertices(stencil, frames, std::span(roots).subspan(stencil.first_frame, n), velocities[t]);
    }
  }
  return velocities;
}

/// Deviation of the middle frame from a cubic fitted to seven frames, divided by √(2/3), which independent noise of
/// standard deviation σ leaves as σ √(2/3). Motion that is not cubic adds to it, so the results are upper bounds.
struct Jitter {
  double joint_deg = 0, pelvis_mm = 0;  ///< rms over joints and frames, a component
};

Jitter JitterOf(const Track& track) {
  const double smooth[7] = {-2.0 / 21, 3.0 / 21, 6.0 / 21, 7.0 / 21, 6.0 / 21, 3.0 / 21, -2.0 / 21};
  const double longest = 1.5 / FrameRateWithoutGaps(track.motion), left = std::sqrt(2.0 / 3);
  const int J = static_cast<int>(track.motion.poses.cols() / 3);
  double angles = 0, places = 0;
  int64_t count = 0;
  for (int t = 3; t + 3 < track.num_frames(); ++t) {
    bool whole = true;
    for (int s = t - 3; s <= t + 3; ++s) {
      whole = whole && track.HasResult(s) &&
              (s == t - 3 || track.motion.timestamps[s] - track.motion.timestamps[s - 1] <= longest);
    }
    if (!whole) continue;
    Vector3d place = track.motion.trans.row(t).transpose();
    for (int k = -3; k <= 3; ++k) place -= smooth[k + 3] * track.motion.trans.row(t + k).transpose();
    places += place.squaredNorm() / 3;
    for (int j = 0; j < J; ++j) {
      const Eigen::Matrix3d at = RotationFromAxisAngle(track.motion.poses.block<1, 3>(t, 3 * j).transpose());
      Vector3d turn = Vector3d::Zero();
      for (int k = -3; k <= 3; ++k) {
        const Eigen::Matrix3d there = RotationFromAxisAngle(track.motion.poses.block<1, 3>(t + k, 3 * j).transpose());
        turn += smooth[k + 3] * AxisAngleFromRotation(at.transpose() * there);
      }
      angles += turn.squaredNorm() / (3 * J);
    }
    ++count;
  }
  const double n = static_cast<double>(std::max<int64_t>(1, count));
  return {std::sqrt(angles / n) / left * 180 / M_PI, 1000 * std::sqrt(places / n) / left};
}

void PrintJitter(const std::string& path, const Track& track) {
  const Jitter jitter = JitterOf(track);
  std::printf("%s: %d frames at %.1f a second, jitter of a joint %.3f deg, of the pelvis %.2f mm\n", path.c_str(),
              track.num_frames(), FrameRateWithoutGaps(track.motion), jitter.joint_deg, jitter.pelvis_mm);
}

/// The frame of `truth` at that time, −1: none.
int FrameAt(const Track& truth, double time) {
  const std::vector<double>& times = truth.motion.timestamps;
  const auto after = std::lower_bound(times.begin(), times.end(), time - 1e-4);
  return after != times.end() && *after - time < 1e-4 ? static_cast<int>(after - times.begin()) : -1;
}

}  // namespace

void BenchTracked(const BodyModel& body, const std::string& track_path, const std::string& truth_path) {
  const Track track = ReadTrack(track_path);
  std::printf("\n## Velocities of a track\n\n");
  PrintJitter(track_path, track);
  if (truth_path.empty()) return;
  const Track truth = ReadTrack(truth_path);
  PrintJitter(truth_path, truth);
  std::printf(
      "\n| axes | velocities | rms error, m/s | rms of the truth, m/s | rms error of the truth's own frames, m/s |\n"
      "|---|---|---|---|---|\n");
  // Error of the scheme on error-free frames at the track's rate.
  Track at_rate = truth;
  at_rate.motion.timestamps.clear();
  at_rate.frame_status.clear();
  std::vector<int> frames;
  std::vector<int> in_track;
  for (int t = 0; t < track.num_frames(); ++t) {
    const int s = FrameAt(truth, track.motion.timestamps[t]);
    if (s < 0) continue;
    frames.push_back(s);
    in_track.push_back(t);
  }
  BODYLOOM_CHECK(!frames.empty(), truth_path, " has no frame at a time of ", track_path);
  at_rate.motion.poses.resize(static_cast<Eigen::Index>(frames.size()), truth.motion.poses.cols());
  at_rate.motion.trans.resize(static_cast<Eigen::Index>(frames.size()), 3);
  for (size_t i = 0; i < frames.size(); ++i) {
    at_rate.motion.poses.row(static_cast<Eigen::Index>(i)) = truth.motion.poses.row(frames[i]);
    at_rate.motion.trans.row(static_cast<Eigen::Index>(i)) = truth.motion.trans.row(frames[i]);
    at_rate.motion.timestamps.push_back(truth.motion.timestamps[frames[i]]);
    at_rate.frame_status.push_back(FrameStatus::kTracked);
  }
  for (const std::string& axes : {std::string("camera"), std::string("body")}) {
    SurfaceMotion motion;
    motion.frame = SurfaceFrameNamed(axes);
    SetVelocity("analytic", &motion);
    motion.velocity.window_s = 0.05;  // of a truth at a finer rate
    const auto true_velocities = VertexVelocities(body, truth, motion);
    motion = {};
    motion.frame = SurfaceFrameNamed(axes);
    for (const std::string& name : VelocityNames()) {
      SetVelocity(name, &motion);
      const auto found = VertexVelocities(body, track, motion), own = VertexVelocities(body, at_rate, motion);
      double error = 0, own_error = 0, square = 0, count = 0;
      for (size_t i = 0; i < frames.size(); ++i) {
        const std::vector<float>&expected = true_velocities[frames[i]], &v = found[in_track[i]], &o = own[i];
        if (expected.empty() || v.empty() || o.empty()) continue;
        for (size_t k = 0; k < expected.size(); ++k) {
          error += std::pow(double{v[k]} - expected[k], 2);
          own_error += std::pow(double{o[k]} - expected[k], 2);
          square += std::pow(double{expected[k]}, 2);
        }
        count += body.num_vertices();
      }
      std::printf("| %s | %s | %.4f | %.3f | %.4f |\n", axes.c_str(), name.c_str(), std::sqrt(error / count),
                  std::sqrt(square / count), std::sqrt(own_error / count));
      std::fflush(stdout);
    }
  }
}

}  // namespace bodyloom
