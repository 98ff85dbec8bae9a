// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/describe_track.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/npy_stream.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/uv_maps/descriptor_maps.h"
#include "render/view/caption.h"

namespace bodyloom {
namespace {

// Preview sheet of a descriptor file: a row per frame, a column per map. Normals are drawn as colours (n + 1)/2,
// velocities grey at rest with a full colour at the largest speed of the sheet.

class DescriptorPreview {
 public:
  /// Chooses options.preview_frames frames among those of `outputs` with a fit, evenly. Borrows everything.
  DescriptorPreview(const DescribeTrackOptions& options, const UvTexelTable& table, const std::vector<int>& outputs,
                    const std::vector<char>& has_fit);

  [[nodiscard]] bool Wants(int frame) const;
  /// The maps of a wanted frame, in the order of the channels, three planes each.
  void Add(int frame, const std::vector<std::span<const char>>& maps);
  [[nodiscard]] Image Draw() const;

 private:
  struct Row {
    int frame;
    std::vector<std::vector<float>> maps;
  };
  const DescribeTrackOptions& options_;
  const UvTexelTable& table_;
  std::vector<int> wanted_;
  std::vector<size_t> columns_;  ///< maps shown
  std::vector<Row> rows_;
};

constexpr int kGap = 4;
constexpr int kSide = 256;  ///< pixels a map
constexpr int kLabel = 36;  ///< above it
constexpr Colour kBackground = {24, 24, 28};

DescriptorPreview::DescriptorPreview(const DescribeTrackOptions& options, const UvTexelTable& table,
                                     const std::vector<int>& outputs, const std::vector<char>& has_fit)
    : options_(options), table_(table) {
  std::vector<int> fitted;
  for (const int t : outputs) {
    if (has_fit[t]) fitted.push_back(t);
  }
  const int rows = std::min(options.preview_frames, static_cast<int>(fitted.size()));
  for (int i = 0; i < rows; ++i) wanted_.push_back(fitted[(2 * i + 1) * fitted.size() / (2 * rows)]);
  if (options.normals) columns_.push_back(0);
  const size_t first = columns_.size();
  for (const int k : {0, options.past / 3, 2 * options.past / 3, options.past - 1}) {
    if (k >= 0 && k < options.past && (columns_.empty() || columns_.back() < first + k)) columns_.push_back(first + k);
  }
}

bool DescriptorPreview::Wants(int frame) const {
  return std::find(wanted_.begin(), wanted_.end(), frame) != wanted_.end();
}

void DescriptorPreview::Add(int frame, const std::vector<std::span<const char>>& maps) {
  Row row{frame, {}};
  for (const size_t column : columns_) {
    NdArray array;
    array.dtype = options_.half ? DType::kF16 : DType::kF32;
    array.item_size = options_.half ? 2 : 4;
    array.shape = {3, table_.height, table_.width};
    array.bytes.assign(maps[column].data(), maps[column].size());
    row.maps.push_back(array.ToFloats());
  }
  rows_.push_back(std::move(row));
}

Image DescriptorPreview::Draw() const {
  const int width = table_.width, height = table_.height, pixels = width * height;
  const auto is_velocity = [&](size_t i) { return !options_.normals || columns_[i] > 0; };
  float fastest = 1e-6F;
  for (const Row& row : rows_) {
    for (size_t i = 0; i < row.maps.size(); ++i) {
      if (!is_velocity(i)) continue;
      for (const float x : row.maps[i]) fastest = std::max(fastest, std::abs(x));
    }
  }
  const double zoom = double(kSide) / std::max(width, height);
  const int side_x = std::max(1, static_cast<int>(width * zoom)), side_y = std::max(1, static_cast<int>(height * zoom));
  Image sheet(static_cast<int>(columns_.size()) * (side_x + kGap) + kGap,
              static_cast<int>(rows_.size()) * (side_y + kLabel + kGap) + kGap, kBackground);
  for (size_t r = 0; r < rows_.size(); ++r) {
    for (size_t i = 0; i < columns_.size(); ++i) {
      Image map(width, height, kBackground);
      const std::vector<float>& values = rows_[r].maps[i];
      for (const int p : table_.pixel) {
        const float scale = is_velocity(i) ? 0.5F / fastest : 0.5F;
        for (int c = 0; c < 3; ++c)
          map.bgr[3 * size_t(p) + 2 - c] = UnitByte(0.5 + scale * values[size_t(c) * pixels + p]);
      }
      const size_t k = columns_[i] - (options_.normals ? 1 : 0);
      const std::string name = is_velocity(i) ? "velocity t" + (k > 0 ? "-" + std::to_string(k) : std::string())
                                              : "normal, frame " + std::to_string(rows_[r].frame);
      Image label(side_x, kLabel, kBackground);
      DrawCaption({{name}}, Corner::kTopLeft, 9, &label);
      const int x = kGap + static_cast<int>(i) * (side_x + kGap);
      const int y = kGap + static_cast<int>(r) * (side_y + kLabel + kGap);
      Paste(label, x, y, &sheet);
      Paste(Resized(map, side_x, side_y), x, y + kLabel, &sheet);
    }
  }
  return sheet;
}

using describe_internal::DescriptorMaps;
using describe_internal::kFramesInFlight;

/// Data prepared before the first map.
DescribeTrackSummary SummaryOf(const DescriptorMaps& maps, int num_frames) {
  DescribeTrackSummary summary;
  summary.channels = maps.channels();
  summary.texels = maps.texels();
  std::vector<double> gains;
  for (int t = 0; t < num_frames; ++t) {
    if (!maps.HasFit(t)) {
      summary.frames_without_fit.push_back(t);
      continue;
    }
    const VelocityStencil& stencil = maps.stencils()[t];
    summary.runs = std::max(summary.runs, stencil.segment + 1);
    if (stencil.weights.empty()) {
      ++summary.frames_without_velocity;
    } else {
      gains.push_back(stencil.NoiseGain());
    }
  }
  if (!gains.empty()) {
    std::nth_element(gains.begin(), gains.begin() + static_cast<std::ptrdiff_t>(gains.size() / 2), gains.end());
    summary.noise_gain = gains[gains.size() / 2];
  }
  return summary;
}

void AddCounts(const DescriptorMaps::Counts& counts, DescribeTrackSummary* summary) {
  summary->frames_skinned += counts.frames_posed;
  summary->normal_maps += counts.normal_maps;
  summary->velocity_maps += counts.velocity_maps;
  summary->normals += counts.normals;
  summary->normal_texels_cancelled += counts.normal_texels_cancelled;
}

/// The maps of a frame, three planes each, separately or contiguous.
std::vector<std::span<const char>> EachMap(DescriptorMaps::Maps maps, size_t map_bytes) {
  std::vector<std::span<const char>> each;
  for (const std::span<const char> several : maps) {
    for (size_t at = 0; at < several.size(); at += map_bytes) each.push_back(several.subspan(at, map_bytes));
  }
  return each;
}

DescribeTrackSummary Describe(const BodyModel& body, const Track& track, const std::string& path,
                              const DescribeTrackOptions& options, const std::vector<int>& outputs,
                              const DescribeProgress& progress) {
  DescriptorMaps maps(body, track, options, {.half = options.half, .reuse_past = options.reuse_past});
  DescribeTrackSummary summary = SummaryOf(maps, track.num_frames());
  StageClock clock;
  const auto num_outputs = static_cast<double>(outputs.size());
  summary.frames = static_cast<int>(outputs.size());
  NpyStream stream(path, options.half ? DType::kF16 : DType::kF32,
                   {summary.frames, summary.channels, summary.texels.height, summary.texels.width});
  summary.bytes = stream.record_bytes() * outputs.size();
  clock.Record("prepare and reserve");
  std::vector<char> has_fit(track.num_frames());
  for (int t = 0; t < track.num_frames(); ++t) has_fit[t] = maps.HasFit(t);
  DescriptorPreview preview(options, maps.texels(), outputs, has_fit);
  for (size_t first = 0; first < outputs.size(); first += kFramesInFlight) {
    if (progress) progress(static_cast<double>(first) / num_outputs);
    const std::span<const int> chunk =
        std::span(outputs).subspan(first, std::min<size_t>(kFramesInFlight, outputs.size() - first));
    maps.PoseFor(chunk);
    clock.Record("skin");
    maps.Make();
    clock.Record("normals, velocities, bake");
    const int count = static_cast<int>(chunk.size());
    std::vector<DescriptorMaps::FrameSummary> frames(count);
    ParallelFor(count, options.num_threads, [&](int i) {
      maps.Use(i, [&](DescriptorMaps::Maps of_frame, const DescriptorMaps::FrameSummary& frame) {
        stream.Write(static_cast<int64_t>(first) + i, of_frame);
        frames[i] = frame;
      });
    });
    for (const DescriptorMaps::FrameSummary& frame : frames) {
      summary.velocity_maps += frame.velocity_maps;
      summary.mean_seen += frame.seen / num_outputs;
    }
    for (int i = 0; i < count; ++i) {
      if (!preview.Wants(chunk[i])) continue;
      maps.Use(i, [&](DescriptorMaps::Maps of_frame, const DescriptorMaps::FrameSummary&) {
        preview.Add(chunk[i], EachMap(of_frame, maps.map_bytes()));
      });
    }
    clock.Record("write");
  }
  stream.Finish();
  clock.Record("flush to disk");
  AddCounts(maps.counts(), &summary);
  summary.seconds = clock.seconds();
  if (options.preview_frames > 0) summary.preview = preview.Draw();
  return summary;
}

}  // namespace

bool DescribeTrackOptions::IsValid(std::string* why) const {
  if (!DescriptorOptions::IsValid(why)) return false;
  if (every < 1) {
    *why = Concatenate("every is ", every, ", expected 1 or more");
    return false;
  }
  if (preview_frames < 0 || preview_frames > 64) {
    *why = Concatenate("preview_frames is ", preview_frames, ", expected 0..64");
    return false;
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
  std::vector<int> outputs;
  for (int t = 0; t < track.num_frames(); t += options.every) outputs.push_back(t);
  DescribeTrackSummary summary = Describe(body, track, out_npy, options, outputs, progress);
  try {
    WriteFileAtomically(DescriptorHeaderPath(out_npy), DescriptorHeaderJson(body, track, options, summary, outputs));
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(out_npy, ignored);  // without its header its contents are unknown
    throw;
  }
  return summary;
}

namespace {

using Json = nlohmann::ordered_json;

Json Rows(const Eigen::Matrix3d& m) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) rows.push_back({m(r, 0), m(r, 1), m(r, 2)});
  return rows;
}

}  // namespace

std::string DescriptorHeaderJson(const BodyModel& body, const Track& track, const DescribeTrackOptions& options,
                                 const DescribeTrackSummary& summary, const std::vector<int>& outputs) {
  const UvTexelTable& texels = summary.texels;
  Json channels = Json::array();
  if (options.normals) channels = {"normal.x", "normal.y", "normal.z"};
  for (int k = 0; k < options.past; ++k) {
    for (const char axis : {'x', 'y', 'z'}) {
      channels.push_back("velocity[t" + (k > 0 ? "-" + std::to_string(k) : std::string()) + "]." + axis);
    }
  }
  Json times = Json::array(), status = Json::array();
  for (const int t : outputs) {
    times.push_back(track.motion.timestamps[t]);
    status.push_back(ToString(track.frame_status[t]));
  }
  Json velocity = {{"scheme", VelocityName(options)},
                   {"unit", "m/s"},
                   {"past", options.past},
                   {"before_the_first_frame_of_a_run", 0},
                   {"noise_gain_median", summary.noise_gain},
                   {"runs_without_gap", summary.runs},
                   {"frames_without_velocity", summary.frames_without_velocity}};
  if (options.velocity.scheme == VelocityScheme::kSavitzkyGolay) {
    velocity["window_s"] = options.velocity.window_s;
    velocity["order"] = options.velocity.order;
  }
  Json json = {
      {"format", "bodyloom descriptors 1"},
      {"shape", {summary.frames, summary.channels, texels.height, texels.width}},
      {"dtype", options.half ? "float16" : "float32"},
      {"channels", channels},
      {"frame", ToString(options.frame)},
      {"normal", {{"unit", "1"}, {"weighting", options.weighting == NormalWeighting::kArea ? "area" : "angle"}}},
      {"velocity", velocity},
      {"body", body.name()},
      {"track_frames", outputs},
      {"timestamps", times},
      {"frame_status", status},
      {"frames_without_fit", summary.frames_without_fit},
      {"seen_only", options.seen_only},
      {"uv",
       {{"texel_centre", "u = (column + 0.5) / width, v = 1 - (row + 0.5) / height"},
        {"coverage", texels.Coverage()},
        {"texels_inside", texels.num_inside},
        {"texels_in_gutter", texels.num_gutter},
        {"charts", texels.num_charts},
        {"texels_overlapping", texels.overlapping},
        {"texels_contested", texels.contested},
        {"faces_without_area", texels.faces_without_area},
        {"faces_outside", texels.faces_outside}}},
      {"normal_fallbacks",
       {{"degenerate_faces", summary.normals.degenerate_faces},
        {"vertices_from_neighbours", summary.normals.from_neighbours},
        {"vertices_from_template", summary.normals.from_template},
        {"vertices_undefined", summary.normals.undefined},
        {"texels_cancelled", summary.normal_texels_cancelled}}},
  };
  if (!options.normals) json.erase("normal");
  if (options.past == 0) json.erase("velocity");
  if (options.seen_only) json["seen_mean"] = summary.mean_seen;
  if (options.frame == SurfaceFrame::kWorld) {
    json["camera_from_world_rotation"] = Rows(options.camera_pose.camera_from_world_rotation);
    const Eigen::Vector3d& t = options.camera_pose.camera_from_world_translation;
    json["camera_from_world_translation"] = {t.x(), t.y(), t.z()};
  }
  return json.dump(1) + "\n";
}

}  // namespace bodyloom
