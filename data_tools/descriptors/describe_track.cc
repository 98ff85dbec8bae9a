// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/descriptors/describe_track.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <span>

#include "bodyloom/data_tools/descriptors/descriptor_header.h"
#include "bodyloom/data_tools/descriptors/descriptor_preview.h"
#include "bodyloom/data_tools/descriptors/map_memory.h"
#include "bodyloom/data_tools/descriptors/posed_frames.h"
#include "bodyloom/data_tools/descriptors/seen_texels.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npy_stream.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/geometry/normals_simd.h"
#include "bodyloom/geometry/skinning.h"
#include "bodyloom/geometry/uv_bake.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using namespace describe_internal;  // NOLINT(google-build-using-namespace)

namespace {

constexpr int kFramesInFlight = 32;

class Describer {
 public:
  Describer(const BodyModel& body, const Track& track, const DescribeTrackOptions& options)
      : body_(body),
        track_(track),
        options_(options),
        poses_(PosesInFrame(body, track, options.frame, options.camera_pose)),
        table_(BuildUvTexelTable(body, options.texels)),
        baker_(table_, body.data().faces),
        skinner_(body, {.num_threads = options.num_threads, .vertices = {}, .skip_resting_joints = true}),
        shape_(skinner_.Shape(track.motion.betas)),
        velocity_skinner_(body),
        normals_(body.data().faces, body.num_vertices(), options.weighting),
        template_normals_(options.normals ? TemplateNormals(body, options.weighting) : MatrixX3f()),
        scratch_(body.num_vertices(), baker_.num_pixels()),
        item_size_(options.half ? 2 : 4),
        map_bytes_(3 * size_t(baker_.num_pixels()) * item_size_),
        zero_map_(map_bytes_, 0),
        maps_(map_bytes_),
        posed_(skinner_, shape_, poses_, body.num_vertices(), kFramesInFlight) {
    const int T = track.num_frames();
    std::vector<char> usable(T);
    for (int t = 0; t < T; ++t) usable[t] = poses_[t].has_value();
    stencils_ = VelocityStencils(track.motion.timestamps, usable, options.velocity);
    for (int t = 0; t < T; t += options.every) outputs_.push_back(t);
    velocity_maps_.resize(T);
  }

  DescribeTrackSummary Run(const std::string& path, const DescribeProgress& progress) {
    Summarise();
    StageClock clock;
    NpyStream stream(path, options_.half ? DType::kF16 : DType::kF32,
                     {static_cast<int64_t>(outputs_.size()), summary_.channels, table_.height, table_.width});
    summary_.bytes = stream.record_bytes() * outputs_.size();
    clock.Book("prepare and reserve");
    DescriptorPreview preview(options_, table_, outputs_, FramesWithFit());
    for (size_t first = 0; first < outputs_.size(); first += kFramesInFlight) {
      if (progress) progress(static_cast<double>(first) / static_cast<double>(outputs_.size()));
      const auto count = static_cast<int>(std::min<size_t>(kFramesInFlight, outputs_.size() - first));
      const std::span<const int> outputs(&outputs_[first], count);
      Chunk chunk = PlanChunk(outputs);
      summary_.frames_skinned += posed_.Need(chunk.needed_vertices);
      clock.Book("skin");
      MakeMaps(&chunk);
      clock.Book("normals, velocities, bake");
      std::vector<double> seen(count, 0);
      std::vector<int> made_again(count, 0);
      ParallelFor(count, options_.num_threads,
                  [&](int i) { made_again[i] = WriteFrame(chunk, i, first + i, &stream, &seen[i]); });
      for (const int maps : made_again) summary_.velocity_maps += maps;
      for (const double share : seen) summary_.mean_seen += share / static_cast<double>(outputs_.size());
      for (int i = 0; i < count; ++i) {
        if (preview.Wants(outputs[i])) AddToPreview(chunk, i, &preview);
      }
      for (Map& map : chunk.normal_maps) maps_.Return(&map);
      clock.Book("write");
    }
    stream.Finish();
    clock.Book("flush to disk");
    summary_.seconds = clock.seconds();
    if (options_.preview_frames > 0) summary_.preview = preview.Picture();
    return summary_;
  }

  [[nodiscard]] const std::vector<int>& outputs() const { return outputs_; }

 private:
  /// Frames described together, and what has to be computed for them.
  struct Chunk {
    std::vector<int> outputs;
    std::vector<int> needed_vertices;    ///< frames
    std::vector<int> new_velocity_maps;  ///< frames
    std::vector<Map> normal_maps;        ///< one an output, empty without a fit
  };

  [[nodiscard]] std::vector<char> FramesWithFit() const {
    std::vector<char> fit;
    for (const auto& pose : poses_) fit.push_back(pose.has_value());
    return fit;
  }

  void Summarise() {
    summary_.frames = static_cast<int>(outputs_.size());
    summary_.channels = 3 * (options_.normals ? 1 : 0) + 3 * options_.past;
    summary_.texels = table_;
    std::vector<double> gains;
    for (int t = 0; t < track_.num_frames(); ++t) {
      if (!poses_[t]) {
        summary_.frames_without_fit.push_back(t);
        continue;
      }
      summary_.runs = std::max(summary_.runs, stencils_[t].segment + 1);
      if (stencils_[t].weights.empty()) {
        ++summary_.frames_without_velocity;
      } else {
        gains.push_back(stencils_[t].NoiseGain());
      }
    }
    if (!gains.empty()) {
      std::nth_element(gains.begin(), gains.begin() + static_cast<std::ptrdiff_t>(gains.size() / 2), gains.end());
      summary_.noise_gain = gains[gains.size() / 2];
    }
  }

  /// The frame whose velocities are V_{t−k} of frame t; −1: none, they are zero.
  [[nodiscard]] int PastFrame(int t, int k) const {
    const int s = t - k;
    return s >= 0 && stencils_[s].segment >= 0 && stencils_[s].segment == stencils_[t].segment &&
                   !stencils_[s].weights.empty()
               ? s
               : -1;
  }

  Chunk PlanChunk(std::span<const int> outputs) {
    Chunk chunk;
    chunk.outputs.assign(outputs.begin(), outputs.end());
    chunk.normal_maps.resize(outputs.size());
    std::set<int> vertices, maps;
    for (const int t : outputs) {
      if (!poses_[t]) continue;
      if (options_.normals || options_.seen_only) vertices.insert(t);
      for (int k = 0; k < options_.past; ++k) {
        const int s = PastFrame(t, k);
        if (s >= 0) maps.insert(s);
      }
    }
    // Velocity maps of frames that no later output looks back to are let go, and the others made once.
    for (int s = 0; s < static_cast<int>(velocity_maps_.size()) && s < outputs.front(); ++s) {
      if (!maps.contains(s)) maps_.Return(&velocity_maps_[s]);
    }
    for (const int s : maps) {
      if (velocity_maps_[s].empty()) chunk.new_velocity_maps.push_back(s);
    }
    if (!options_.analytic) {
      for (const int s : options_.reuse_past ? chunk.new_velocity_maps : std::vector<int>(maps.begin(), maps.end())) {
        for (size_t k = 0; k < stencils_[s].weights.size(); ++k) vertices.insert(stencils_[s].first_frame + int(k));
      }
    }
    chunk.needed_vertices.assign(vertices.begin(), vertices.end());
    return chunk;
  }

  [[nodiscard]] size_t Stride() const { return 3 * size_t(body_.num_vertices()); }
  /// A map of what `bake` writes into three planes of floats.
  template <typename Bake>
  Map Baked(Scratch* scratch, const Bake& bake) {
    Map map = maps_.Take();
    if (options_.half) {
      bake(std::span<float>(scratch->planes));
      uv_bake_internal::HalfFromFloat(scratch->planes.data(), static_cast<int64_t>(scratch->planes.size()),
                                      reinterpret_cast<uint16_t*>(map.data()));
    } else {
      bake(std::span<float>(reinterpret_cast<float*>(map.data()), scratch->planes.size()));
    }
    return map;
  }

  Map NormalMap(int t, Scratch* scratch, NormalSummary* summary, int* cancelled) {
    const PosedSkeleton skeleton = PoseSkeleton(body_, shape_.rest_joints, *poses_[t]);
    *summary = normals_.Compute(posed_.Vertices(t), scratch->vertices, &scratch->normals,
                                {&body_, &template_normals_, &skeleton});
    normals_internal::PadVertices(scratch->vertices.data(), body_.num_vertices(), 1, scratch->padded.data());
    return Baked(scratch, [&](std::span<float> planes) { *cancelled = baker_.BakeUnit(scratch->padded, planes); });
  }

  /// `velocities`: of the vertices, or empty to take differences.
  Map VelocityMap(int s, std::span<const float> velocities, Scratch* scratch) {
    if (velocities.empty()) {
      const VelocityStencil& stencil = stencils_[s];
      std::vector<const float*> frames;
      for (size_t k = 0; k < stencil.weights.size(); ++k) {
        frames.push_back(posed_.Vertices(stencil.first_frame + static_cast<int>(k)).data());
      }
      DifferenceVertices(stencil, frames, posed_.roots().subspan(stencil.first_frame, frames.size()),
                         scratch->vertices);
      velocities = scratch->vertices;
    }
    normals_internal::PadVertices(velocities.data(), body_.num_vertices(), 1, scratch->padded.data());
    return Baked(scratch,
                 [&](std::span<float> planes) { baker_.Bake(scratch->padded, body_.num_vertices(), 3, planes); });
  }

  [[nodiscard]] std::vector<float> AnalyticVelocities(std::span<const int> frames) const {
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

  void MakeMaps(Chunk* chunk) {
    const std::vector<int>& velocity_frames = chunk->new_velocity_maps;
    const int num_normals = options_.normals ? static_cast<int>(chunk->outputs.size()) : 0;
    const int num_velocities = options_.reuse_past ? static_cast<int>(velocity_frames.size()) : 0;
    const std::vector<float> analytic =
        options_.analytic && num_velocities > 0 ? AnalyticVelocities(velocity_frames) : std::vector<float>();
    std::vector<NormalSummary> normal_summaries(num_normals);
    std::vector<int> cancelled(num_normals, 0);
    ParallelFor(num_normals + num_velocities, options_.num_threads, [&](int i) {
      std::unique_ptr<Scratch> scratch = scratch_.Take();
      if (i < num_normals) {
        const int t = chunk->outputs[i];
        if (poses_[t]) chunk->normal_maps[i] = NormalMap(t, scratch.get(), &normal_summaries[i], &cancelled[i]);
      } else {
        const size_t j = static_cast<size_t>(i - num_normals);
        const std::span<const float> velocities =
            analytic.empty() ? std::span<const float>() : std::span(analytic).subspan(Stride() * j, Stride());
        velocity_maps_[velocity_frames[j]] = VelocityMap(velocity_frames[j], velocities, scratch.get());
      }
      scratch_.Return(std::move(scratch));
    });
    for (int i = 0; i < num_normals; ++i) {
      summary_.normals += normal_summaries[i];
      summary_.normal_texels_cancelled += cancelled[i];
      summary_.normal_maps += !chunk->normal_maps[i].empty();
    }
    summary_.velocity_maps += num_velocities;
  }

  /// The maps of output i, in the order of the channels.
  [[nodiscard]] std::vector<std::span<const char>> PiecesOf(const Chunk& chunk, int i) const {
    std::vector<std::span<const char>> pieces;
    const int t = chunk.outputs[i];
    if (options_.normals) pieces.emplace_back(poses_[t] ? chunk.normal_maps[i] : zero_map_);
    for (int k = 0; k < options_.past; ++k) {
      const int s = poses_[t] ? PastFrame(t, k) : -1;
      pieces.emplace_back(s >= 0 && !velocity_maps_[s].empty() ? velocity_maps_[s] : zero_map_);
    }
    return pieces;
  }

  void AddToPreview(const Chunk& chunk, int i, DescriptorPreview* preview) {
    std::vector<std::span<const char>> pieces = PiecesOf(chunk, i);
    Map masked;
    if (options_.seen_only) {
      std::unique_ptr<Scratch> scratch = scratch_.Take();
      double share = 0;
      masked = OnlySeen(chunk.outputs[i], pieces, scratch.get(), &share);
      scratch_.Return(std::move(scratch));
      for (size_t k = 0; k < pieces.size(); ++k) pieces[k] = std::span(masked).subspan(k * map_bytes_, map_bytes_);
    }
    preview->Add(chunk.outputs[i], pieces);
  }

  /// Returns the number of maps it had to make.
  int WriteFrame(const Chunk& chunk, int i, size_t record, NpyStream* stream, double* seen) {
    const int t = chunk.outputs[i];
    std::vector<std::span<const char>> pieces = PiecesOf(chunk, i);
    std::vector<Map> own;  // for as long as the pieces are needed
    if (!options_.reuse_past && poses_[t]) {
      std::unique_ptr<Scratch> scratch = scratch_.Take();
      own.reserve(options_.past);
      for (int k = 0; k < options_.past; ++k) {
        const int s = PastFrame(t, k);
        if (s < 0) continue;
        const std::vector<float> velocities =
            options_.analytic ? AnalyticVelocities(std::span(&s, 1)) : std::vector<float>();
        own.push_back(VelocityMap(s, velocities, scratch.get()));
        pieces[k + (options_.normals ? 1 : 0)] = own.back();
      }
      scratch_.Return(std::move(scratch));
    }
    Map masked;
    if (options_.seen_only && poses_[t]) {
      std::unique_ptr<Scratch> scratch = scratch_.Take();
      masked = OnlySeen(t, pieces, scratch.get(), seen);
      scratch_.Return(std::move(scratch));
      pieces = {masked};
    }
    stream->Write(static_cast<int64_t>(record), pieces);
    for (Map& map : own) maps_.Return(&map);
    return static_cast<int>(own.size());
  }

  /// The frame's vertices as its camera sees them.
  [[nodiscard]] MatrixX3d VerticesInCamera(int t) const {
    const Vector3d root = shape_.rest_joints.row(0).transpose() + track_.motion.trans.row(t).transpose();
    const BodyPose in_camera = PoseFromAxisAngle(body_, track_.motion.poses.row(t).transpose(), Vector3d::Zero());
    const Matrix3d camera_from_frame = in_camera.rotations[0] * poses_[t]->rotations[0].transpose();
    const Eigen::Map<const MatrixX3f> from_root(posed_.Vertices(t).data(), body_.num_vertices(), 3);
    return (from_root.cast<double>() * camera_from_frame.transpose()).rowwise() + root.transpose();
  }

  Map OnlySeen(int t, std::span<const std::span<const char>> pieces, Scratch* scratch, double* share) const {
    const SeenTexels sight = FindSeenTexels(table_, body_, VerticesInCamera(t), track_.CameraAt(t), &scratch->buffer);
    *share = sight.share;
    return KeepSeen(table_, sight.seen, pieces, item_size_);
  }

  const BodyModel& body_;
  const Track& track_;
  const DescribeTrackOptions& options_;
  std::vector<std::optional<BodyPose>> poses_;
  UvTexelTable table_;
  UvBaker baker_;
  Skinner skinner_;
  ShapedBody shape_;
  VelocitySkinner velocity_skinner_;
  MeshNormals normals_;
  MatrixX3f template_normals_;
  ScratchPool scratch_;
  size_t item_size_, map_bytes_;
  Map zero_map_;
  MapPool maps_;
  PosedFrames posed_;
  std::vector<VelocityStencil> stencils_;
  std::vector<int> outputs_;
  std::vector<Map> velocity_maps_;  ///< by frame, empty where not held
  DescribeTrackSummary summary_;
};

}  // namespace

bool DescribeTrackOptions::IsValid(std::string* why) const {
  if (!texels.IsValid(why) || !velocity.IsValid(why)) return false;
  const auto no = [why](const std::string& text) {
    *why = text;
    return false;
  };
  if (past < 0 || past > 1000) return no(Concatenate("past is ", past, ", expected 0..1000"));
  if (past == 0 && !normals) return no("neither normals nor velocities asked for");
  if (every < 1) return no(Concatenate("every is ", every, ", expected 1 or more"));
  if (num_threads < 1 || num_threads > 1024)
    return no(Concatenate("num_threads is ", num_threads, ", expected 1..1024"));
  if (preview_frames < 0 || preview_frames > 64) {
    return no(Concatenate("preview_frames is ", preview_frames, ", expected 0..64"));
  }
  return true;
}

std::string DescriptorHeaderPath(const std::string& out_npy) {
  return std::filesystem::path(out_npy).replace_extension(".json").string();
}

DescribeTrackSummary DescribeTrack(const BodyModel& body, const Track& track, const std::string& out_npy,
                                   const DescribeTrackOptions& options, const DescribeProgress& progress) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "describe: ", why);
  BODYLOOM_CHECK(track.num_frames() > 0, "describe: the track has no frames");
  BODYLOOM_CHECK(track.motion.poses.cols() <= 3 * body.num_joints(), "describe: the track has ",
                 track.motion.poses.cols() / 3, " joints, the body '", body.name(), "' has ", body.num_joints());
  BODYLOOM_CHECK(!options.seen_only || (track.camera.width > 0 && track.camera.height > 0),
                 "describe: only seen texels were asked for, but the track does not say how large its images are");
  Describer describer(body, track, options);
  DescribeTrackSummary summary = describer.Run(out_npy, progress);
  try {
    WriteFileAtomically(DescriptorHeaderPath(out_npy),
                        DescriptorHeaderJson(body, track, options, summary, describer.outputs()));
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(out_npy, ignored);  // without its header nobody can tell what it holds
    throw;
  }
  return summary;
}

}  // namespace bodyloom
