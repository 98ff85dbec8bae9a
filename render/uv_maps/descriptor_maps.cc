// SPDX-License-Identifier: Apache-2.0
#include "render/uv_maps/descriptor_maps.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <set>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/camera_path.h"
#include "geometry/uv_maps/uv_bake_simd.h"
#include "render/texture/texel_visibility.h"

namespace bodyloom::describe_internal {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Returns `track` after checking the arguments; used in the initialiser list.
const Track& Checked(const BodyModel& body, const Track& track, const DescriptorOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "describe: ", why);
  BODYLOOM_CHECK(track.num_frames() > 0, "describe: the track has no frames");
  BODYLOOM_CHECK(track.motion.poses.cols() <= 3 * body.num_joints(), "describe: the track has ",
                 track.motion.poses.cols() / 3, " joints, the body '", body.name(), "' has ", body.num_joints());
  BODYLOOM_CHECK(!options.seen_only || (track.camera.width > 0 && track.camera.height > 0),
                 "describe: only seen texels were requested, but the track does not say how large its images are");
  return track;
}

}  // namespace

DescriptorMaps::DescriptorMaps(const BodyModel& body, const Track& track, const DescriptorOptions& options,
                               const DescriptorMapsOptions& how)
    : body_(body),
      track_(Checked(body, track, options)),
      options_(options),
      how_(how),
      poses_(PosesInFrame(body, track, options.frame, options.camera_pose)),
      surface_(body, options.texels, options.weighting, options.normals),
      skinner_(body, {.num_threads = options.num_threads, .vertices = {}, .skip_resting_joints = true}),
      shape_(skinner_.Shape(track.motion.betas)),
      velocity_skinner_(body),
      scratch_(body.num_vertices(), static_cast<int>(plane_size())),
      item_size_(how.half ? 2 : 4),
      map_bytes_(3 * plane_size() * item_size_),
      zero_map_(map_bytes_, 0),
      maps_(map_bytes_),
      posed_(skinner_, shape_, poses_, body.num_vertices(), kFramesInFlight),
      velocity_maps_(track.num_frames()) {
  std::vector<char> usable(track.num_frames());
  for (int t = 0; t < track.num_frames(); ++t) usable[t] = HasFit(t);
  stencils_ = VelocityStencils(track.motion.timestamps, usable, options.velocity);
}

/// The frame whose velocities are V_{t−k} of frame t; −1: none, velocities are zero.
int DescriptorMaps::PastFrame(int t, int k) const {
  const int s = t - k;
  return s >= 0 && stencils_[s].segment >= 0 && stencils_[s].segment == stencils_[t].segment &&
                 !stencils_[s].weights.empty()
             ? s
             : -1;
}

void DescriptorMaps::PoseFor(std::span<const int> frames) {
  for (Map& map : normal_maps_) maps_.Return(&map);
  frames_.assign(frames.begin(), frames.end());
  normal_maps_.resize(frames.size());
  std::set<int> vertices, maps;
  for (const int t : frames) {
    if (!HasFit(t)) continue;
    if (options_.normals || options_.seen_only) vertices.insert(t);
    for (int k = 0; k < options_.past; ++k) {
      const int s = PastFrame(t, k);
      if (s >= 0) maps.insert(s);
    }
  }
  for (const int s : held_) {
    if (!maps.contains(s)) maps_.Return(&velocity_maps_[s]);
  }
  new_velocity_maps_.clear();
  held_.clear();
  for (const int s : maps) {
    if (!how_.reuse_past || velocity_maps_[s].empty()) new_velocity_maps_.push_back(s);
    if (how_.reuse_past) held_.push_back(s);
  }
  if (!options_.analytic) {
    for (const int s : new_velocity_maps_) {
      for (size_t k = 0; k < stencils_[s].weights.size(); ++k) vertices.insert(stencils_[s].first_frame + int(k));
    }
  }
  counts_.frames_posed += posed_.Need(std::vector<int>(vertices.begin(), vertices.end()));
}

/// Stores as a map the three planes of floats that `bake` writes.
template <typename Bake>
Map DescriptorMaps::Baked(Scratch* scratch, const Bake& bake) {
  Map map = maps_.Take();
  if (how_.half) {
    bake(std::span<float>(scratch->planes));
    uv_bake_internal::HalfFromFloat(scratch->planes.data(), static_cast<int64_t>(scratch->planes.size()),
                                    reinterpret_cast<uint16_t*>(map.data()));
  } else {
    bake(std::span<float>(reinterpret_cast<float*>(map.data()), scratch->planes.size()));
  }
  return map;
}

Map DescriptorMaps::NormalMap(int t, Scratch* scratch, NormalSummary* summary, int* cancelled) {
  const PosedSkeleton skeleton = PoseSkeleton(body_, shape_.rest_joints, *poses_[t]);
  return Baked(scratch, [&](std::span<float> planes) {
    *cancelled = surface_.Normals(posed_.Vertices(t), skeleton, scratch, summary, planes);
    TurnToCamera(t, planes);
  });
}

/// `velocities`: of the vertices; empty: computed by finite differences.
Map DescriptorMaps::VelocityMap(int s, std::span<const float> velocities, Scratch* scratch) {
  if (velocities.empty()) {
    const VelocityStencil& stencil = stencils_[s];
    std::vector<const float*> frames;
    for (size_t k = 0; k < stencil.weights.size(); ++k) {
      frames.push_back(posed_.Vertices(stencil.first_frame + static_cast<int>(k)).data());
    }
    DifferenceVertices(stencil, frames, posed_.roots().subspan(stencil.first_frame, frames.size()), scratch->vertices);
    velocities = scratch->vertices;
  }
  return Baked(scratch, [&](std::span<float> planes) {
    surface_.Velocities(velocities, scratch, planes);
    TurnToCamera(s, planes);
  });
}

std::vector<float> DescriptorMaps::AnalyticVelocities(std::span<const int> frames) const {
  std::vector<BodyPose> poses;
  std::vector<PoseRates> rates;
  for (const int s : frames) {
    std::vector<const BodyPose*> around;
    for (size_t k = 0; k < stencils_[s].weights.size(); ++k) {
      around.push_back(&*poses_[stencils_[s].first_frame + static_cast<int>(k)]);
    }
    poses.push_back(*poses_[s]);
    rates.push_back(RatesOf(stencils_[s], around, poses.back()));
  }
  std::vector<float> velocities(Stride() * frames.size());
  velocity_skinner_.Velocities(shape_, poses, rates, velocities, options_.num_threads);
  return velocities;
}

void DescriptorMaps::TurnToCamera(int t, std::span<float> planes) const {
  if (!track_.HasMovingCamera() || options_.frame != SurfaceFrame::kCamera) return;
  const Eigen::Matrix3f R = track_.camera_from_scene[size_t(t)].camera_from_world_rotation.cast<float>();
  Eigen::Map<Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::RowMajor>> vectors(planes.data(), 3,
                                                                               Eigen::Index(planes.size() / 3));
  vectors = (R * vectors).eval();
}

/// The frame's vertices in its camera frame.
MatrixX3d DescriptorMaps::VerticesInCamera(int t) const {
  const Vector3d rest_root = shape_.rest_joints.row(0).transpose();
  BodyPose in_camera =
      PoseFromAxisAngle(body_, track_.motion.poses.row(t).transpose(), track_.motion.trans.row(t).transpose());
  if (track_.HasMovingCamera()) in_camera = MovedPose(track_.camera_from_scene[size_t(t)], rest_root, in_camera);
  const Vector3d root = rest_root + in_camera.trans;
  const Matrix3d camera_from_frame = in_camera.rotations[0] * poses_[t]->rotations[0].transpose();
  const Eigen::Map<const MatrixX3f> from_root(posed_.Vertices(t).data(), body_.num_vertices(), 3);
  return (from_root.cast<double>() * camera_from_frame.transpose()).rowwise() + root.transpose();
}

Map DescriptorMaps::OnlySeen(int t, Maps maps, VisibilityBuffer* buffer, double* share) const {
  const SeenTexels sight = FindSeenTexels(texels(), body_, VerticesInCamera(t), track_.CameraAt(t), buffer);
  *share = sight.share;
  return KeepSeen(texels(), sight.seen, maps, item_size_);
}

void DescriptorMaps::Make() {
  const int num_normals = options_.normals ? static_cast<int>(frames_.size()) : 0;
  const int num_velocities = how_.reuse_past ? static_cast<int>(new_velocity_maps_.size()) : 0;
  const std::vector<float> analytic =
      options_.analytic && num_velocities > 0 ? AnalyticVelocities(new_velocity_maps_) : std::vector<float>();
  std::vector<NormalSummary> normal_summaries(num_normals);
  std::vector<int> cancelled(num_normals, 0);
  ParallelFor(num_normals + num_velocities, options_.num_threads, [&](int i) {
    std::unique_ptr<SightScratch> scratch = scratch_.Take();
    if (i < num_normals) {
      const int t = frames_[i];
      if (HasFit(t)) normal_maps_[i] = NormalMap(t, scratch.get(), &normal_summaries[i], &cancelled[i]);
    } else {
      const size_t j = static_cast<size_t>(i - num_normals);
      const std::span<const float> velocities =
          analytic.empty() ? std::span<const float>() : std::span(analytic).subspan(Stride() * j, Stride());
      velocity_maps_[new_velocity_maps_[j]] = VelocityMap(new_velocity_maps_[j], velocities, scratch.get());
    }
    scratch_.Return(std::move(scratch));
  });
  for (int i = 0; i < num_normals; ++i) {
    counts_.normals += normal_summaries[i];
    counts_.normal_texels_cancelled += cancelled[i];
    counts_.normal_maps += !normal_maps_[i].empty();
  }
  counts_.velocity_maps += num_velocities;
}

void DescriptorMaps::Use(int i, const std::function<void(Maps, const FrameSummary&)>& use) {
  const int t = frames_[i];
  FrameSummary summary;
  std::vector<std::span<const char>> maps;
  std::vector<Map> own;  // keeps the maps alive
  own.reserve(options_.past);
  std::unique_ptr<SightScratch> scratch = scratch_.Take();
  if (options_.normals) maps.emplace_back(HasFit(t) ? normal_maps_[i] : zero_map_);
  for (int k = 0; k < options_.past; ++k) {
    const int s = HasFit(t) ? PastFrame(t, k) : -1;
    if (s >= 0 && !how_.reuse_past) {
      const std::vector<float> velocities =
          options_.analytic ? AnalyticVelocities(std::span(&s, 1)) : std::vector<float>();
      own.push_back(VelocityMap(s, velocities, scratch.get()));
      maps.emplace_back(own.back());
    } else {
      maps.emplace_back(s >= 0 ? velocity_maps_[s] : zero_map_);
    }
  }
  summary.velocity_maps = static_cast<int>(own.size());
  Map masked;
  if (options_.seen_only && HasFit(t)) {
    masked = OnlySeen(t, maps, &scratch->buffer, &summary.seen);
    maps = {masked};
  }
  scratch_.Return(std::move(scratch));
  use(maps, summary);
  for (Map& map : own) maps_.Return(&map);
}

SeenTexels FindSeenTexels(const UvTexelTable& table, const BodyModel& body, const MatrixX3d& vertices,
                          const Camera& camera, VisibilityBuffer* buffer) {
  buffer->Render(vertices, body.data().faces, camera);
  const std::vector<TexelVisibility> sights =
      ComputeTexelVisibility(table, body, vertices, camera, *buffer, {.min_cosine = 0, .whole_footprint = false});
  SeenTexels result;
  std::vector<char>& seen = result.seen;
  seen.assign(size_t(table.width) * table.height, 0);
  int num_seen = 0;
  for (size_t i = 0; i < sights.size(); ++i) {
    seen[table.pixel[i]] = sights[i].cosine > 0;
    num_seen += sights[i].cosine > 0;
  }
  result.share = static_cast<double>(num_seen) / table.num_inside;
  // A gutter texel follows the adjacent texels of its chart.
  for (size_t i = 0; i < table.size(); ++i) {
    if (!table.in_gutter[i]) continue;
    const int x = table.pixel[i] % table.width, y = table.pixel[i] / table.width;
    for (int q = std::max(0, y - 1); q <= std::min(table.height - 1, y + 1); ++q) {
      for (int p = std::max(0, x - 1); p <= std::min(table.width - 1, x + 1); ++p) {
        const int beside = q * table.width + p;
        if (seen[beside] == 1 && table.chart_at[beside] == table.chart_at[table.pixel[i]]) {
          seen[table.pixel[i]] = 2;  // 2: not propagated further
        }
      }
    }
  }
  return result;
}

std::vector<char> KeepSeen(const UvTexelTable& table, const std::vector<char>& seen,
                           std::span<const std::span<const char>> maps, size_t item_size) {
  const size_t num_pixels = size_t(table.width) * table.height, map_bytes = 3 * num_pixels * item_size;
  std::vector<char> masked(map_bytes * maps.size(), 0);
  char* out = masked.data();
  for (const std::span<const char>& map : maps) {
    for (int c = 0; c < 3; ++c) {
      const size_t plane = size_t(c) * num_pixels * item_size;
      for (const int pixel : table.pixel) {
        if (!seen[pixel]) continue;
        const size_t at = plane + size_t(pixel) * item_size;
        std::memcpy(out + at, map.data() + at, item_size);
      }
    }
    out += map_bytes;
  }
  return masked;
}

}  // namespace bodyloom::describe_internal
