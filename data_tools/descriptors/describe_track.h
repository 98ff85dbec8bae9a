// SPDX-License-Identifier: Apache-2.0
/// The motion descriptor of every frame of a track, streamed to a file: what the renderers learn from.
///
/// Frame t holds, as maps over the body's UV atlas, the unit normals of the posed surface and the velocities of the
/// surface in this and the past frames:
///   [ N_t (3), V_t (3), V_{t−1} (3), …, V_{t−past+1} (3) ],     33 channels for past = 10
/// with N = ∂p/∂X and V = ∂p/∂t of Yoon et al., "Learning Motion-Dependent Appearance for High-Fidelity Rendering of
/// Dynamic Humans from a Single Camera", eq. 4–5. V_{t−k} is the velocity that the surface had at frame t−k, in that
/// frame's own axes, so it is the very map that frame t−k holds as its V: each velocity map is baked once and copied
/// `past` times (skippable skip: reuse_past).
///
/// Before the first frame of a gap-free run (geometry/velocity_stencil.h) the person is taken to have stood still:
/// zero. Frames without a fit are zero throughout and listed. Never NaN.
///
/// Files: OUT.npy, float32 or float16, frames × channels × height × width, to be mapped into memory; OUT.json beside it
/// says what it holds (docs/descriptors.md lists the keys). Both are written whole or not at all.
///
/// Memory does not grow with the clip: 32 frames are in flight. Same bytes for any number of threads.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/geometry/normals.h"
#include "bodyloom/geometry/surface_velocity.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/geometry/uv_texels.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

struct DescribeTrackOptions {
  UvTexelOptions texels;
  int past = 10;        ///< velocity maps a frame, its own included; 0 to 1000
  bool normals = true;  ///< the three channels of N
  VelocityStencilOptions velocity;
  bool analytic = false;  ///< velocities by the body model's derivative instead of differences of vertices
  SurfaceFrame frame = SurfaceFrame::kCamera;
  CameraPose camera_pose;  ///< for SurfaceFrame::kWorld
  NormalWeighting weighting = NormalWeighting::kArea;
  bool half = false;  ///< float16
  int every = 1;      ///< describes frames 0, every, 2·every, …; velocities are of consecutive frames all the same
  bool seen_only = false;  ///< texels that the frame's camera does not see are zero
  int num_threads = 1;
  bool reuse_past = true;  ///< false: bakes all velocity maps of a frame anew; same bytes, for comparison
  int preview_frames = 0;  ///< rows of the preview, 0: none
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct DescribeTrackSummary {
  int frames = 0;  ///< records written
  int channels = 0;
  std::vector<int> frames_without_fit;  ///< of the track
  int frames_without_velocity = 0;      ///< alone in their run
  int runs = 0;                         ///< gap-free runs of frames
  double noise_gain = 0;                ///< median over frames: m/s a metre of noise
  NormalSummary normals;
  int normal_texels_cancelled = 0;  ///< texels whose corners' normals cancelled out, over all frames
  UvTexelTable texels;              ///< with its counts
  int frames_skinned = 0, normal_maps = 0, velocity_maps = 0;  ///< what was computed
  double mean_seen = 0;                                        ///< seen_only: share of the texels, mean over frames
  size_t bytes = 0;                                            ///< of OUT.npy
  std::vector<std::pair<std::string, double>> seconds;         ///< by stage
  Image preview;
};

/// Called now and then with the share done; may throw to stop (nothing is left behind).
using DescribeProgress = std::function<void(double)>;

/// Throws std::runtime_error naming the file that cannot be written, std::invalid_argument when options are not valid,
/// the track is not this body's, its times do not grow (naming the frame), or the body has no UV map.
DescribeTrackSummary DescribeTrack(const BodyModel& body, const Track& track, const std::string& out_npy,
                                   const DescribeTrackOptions& options = {}, const DescribeProgress& progress = {});

/// The header's place: out_npy with .json for its extension.
std::string DescriptorHeaderPath(const std::string& out_npy);

}  // namespace bodyloom
