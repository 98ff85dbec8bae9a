// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <span>

#include "benchmarks/speed/moving_body.h"
#include "data_tools/descriptors/describe_track.h"
#include "data_tools/formats/npz.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/normals.h"
#include "geometry/body/normals_simd.h"
#include "geometry/uv_maps/uv_bake.h"
#include "geometry/uv_maps/uv_charts.h"
#include "render/texture/uv_sample.h"

namespace bodyloom {

using Eigen::Vector3d;

void BenchBake(const BodyModel& body) {
  Title("Baking");
  std::mt19937 random(2);
  std::vector<float> values(33 * size_t(body.num_vertices()));
  for (float& x : values) x = static_cast<float>(random() / 2147483648.0 - 1);
  const std::vector<float> grouped = InterleaveChannels(values, body.num_vertices(), 33);
  for (const int size : {128, 256}) {
    UvTexelTable table;
    const Milliseconds table_ms = Time(5, [&] { table = BuildUvTexelTable(body, {.width = size, .height = size}); });
    Print("texel table " + std::to_string(size) + "², once a body", table_ms,
          Format("%.0f texels, %.0f of them gutter", double(table.size()), double(table.num_gutter)));
    const UvBaker baker(table, body.data().faces);
    for (const int channels : {3, 33}) {
      std::vector<float> maps(channels * size_t(size) * size, 0.0F);
      const std::span<const float> attributes =
          std::span(grouped).first(4 * size_t((channels + 3) / 4) * body.num_vertices());
      const Milliseconds ms = Time(300, [&] { baker.Bake(attributes, body.num_vertices(), channels, maps); });
      double worst = 0;
      for (size_t i = 0; i < table.size(); ++i) {
        for (int c = 0; c < channels; ++c) {
          double exact = 0;
          for (int k = 0; k < 3; ++k) {
            exact += double{table.barycentric[i][k]} * values[size_t(body.data().faces(table.face[i], k)) * 33 + c];
          }
          worst = std::max(worst, std::abs(maps[size_t(c) * size * size + table.pixel[i]] - exact));
        }
      }
      Print("bake " + std::to_string(channels) + " channels, " + std::to_string(size) + "²", ms,
            Format("max %.1e of values up to 1", worst));
    }
  }
}

void BenchSeams(const BodyModel& body) {
  Title("Normals looked up in the baked map, against the surface itself");
  const UvCharts charts = FindUvCharts(body);
  const MatrixX3f normals = TemplateNormals(body);
  std::vector<float> padded(4 * size_t(body.num_vertices()));
  normals_internal::PadVertices(normals.data(), body.num_vertices(), 1, padded.data());
  for (const int size : {128, 256, 512}) {
    for (const int gutter : {0, 1}) {
      const UvTexelTable table = BuildUvTexelTable(body, charts, {.width = size, .height = size, .gutter = gutter});
      const UvBaker baker(table, body.data().faces);
      std::vector<float> maps(3 * size_t(size) * size, 0.0F);
      const Milliseconds ms = Time(50, [&] { baker.BakeUnit(padded, maps); });
      std::vector<double> near_seam, inside;
      for (int h = 0; h < 3 * body.num_faces(); ++h) {
        const int k = h % 3;
        Vector3d b = Vector3d::Zero();
        b[k] = 0.55;
        b[(k + 1) % 3] = 0.4;
        b[(k + 2) % 3] = 0.05;
        Vector3d exact = Vector3d::Zero(), found = Vector3d::Zero();
        for (int c = 0; c < 3; ++c) exact += b[c] * normals.row(body.data().faces(h / 3, c)).transpose().cast<double>();
        const UvTaps taps = TapsAt(table, UvPointAt(body, charts, h / 3, b));
        for (int i = 0; i < taps.count; ++i) {
          for (int c = 0; c < 3; ++c) found[c] += taps.weight[i] * maps[size_t(c) * size * size + taps.pixel[i]];
        }
        const double angle = taps.count > 0 ? AngleBetweenDeg(exact, found) : 90;
        (charts.is_seam[h] ? near_seam : inside).push_back(angle);
      }
      const auto at = [](std::vector<double>& x, double share) {
        std::sort(x.begin(), x.end());
        return x[static_cast<size_t>(share * static_cast<double>(x.size() - 1))];
      };
      Print(std::to_string(size) + "², " + (gutter > 0 ? "gutter across the seam" : "no gutter (charts checked)"), ms,
            Format("at seams median %.2f deg, 95 %% %.2f deg; ", at(near_seam, 0.5), at(near_seam, 0.95)) +
                Format("elsewhere %.2f, %.2f", at(inside, 0.5), at(inside, 0.95)));
    }
  }
}

namespace {

/// Compares the visible texels of maps limited to them with those of the whole maps.
void CompareSeenTexels(const BodyModel& body, const std::string& path) {
  const Track track = TrackOf(body, 40, 30, 0.8, 0.002);
  DescribeTrackOptions options;
  options.num_threads = 2;
  DescribeTrack(body, track, path, options);
  const std::vector<float> all = ReadNpy(path).ToFloats();
  options.seen_only = true;
  const DescribeTrackSummary summary = DescribeTrack(body, track, path, options);
  const std::vector<float> seen = ReadNpy(path).ToFloats();
  size_t kept = 0, differing = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    kept += seen[i] != 0;
    differing += seen[i] != 0 && seen[i] != all[i];
  }
  std::printf(
      "\nOnly texels seen: %.1f %% of the texels, %zu of their %zu values differ from those of the whole maps\n",
      100 * summary.mean_seen, differing, kept);
}

}  // namespace

void BenchStream(const BodyModel& body, const std::string& folder) {
  std::printf(
      "\n## Track to descriptor file, 600 frames, 128²\n\n| what | frames/s, all | frames/s without the disk's share | "
      "MB/s | maps baked |\n|---|---|---|---|---|\n");
  const Track track = TrackOf(body, 600, 30, 0.8, 0.002);
  const std::string path = (std::filesystem::path(folder) / "bench_descriptors.npy").string();
  struct Row {
    std::string name;
    DescribeTrackOptions options;
  };
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, const std::function<void(DescribeTrackOptions*)>& change) {
    DescribeTrackOptions options;
    options.num_threads = 2;
    change(&options);
    rows.push_back({name, options});
  };
  add("33 channels, float32, 1 thread", [](auto* o) { o->num_threads = 1; });
  add("33 channels, float32, 2 threads", [](auto*) {});
  add("33 channels, float16, 2 threads", [](auto* o) { o->half = true; });
  add("6 channels (past 1), float32, 2 threads", [](auto* o) { o->past = 1; });
  add("33 channels, float32, analytic, 2 threads", [](auto* o) { o->analytic = true; });
  add("33 channels, float32, past maps baked again, 2 threads", [](auto* o) { o->reuse_past = false; });
  add("33 channels, float32, only texels seen, 2 threads", [](auto* o) { o->seen_only = true; });
  for (const Row& row : rows) {
    double best = 0, compute = 0, rate = 0;
    int maps = 0;
    for (int repetition = 0; repetition < 3; ++repetition) {
      std::filesystem::remove(path);  // freeing an old file's pages is not part of the work
      const Stopwatch watch;
      const DescribeTrackSummary summary = DescribeTrack(body, track, path, row.options);
      const double seconds = watch.seconds();
      double disk = 0;
      for (const auto& [stage, stage_seconds] : summary.seconds) {
        if (stage == "write" && row.options.reuse_past) disk += stage_seconds;
        if (stage == "flush to disk") disk += stage_seconds;
      }
      if (summary.frames / seconds > best) {
        best = summary.frames / seconds;
        rate = 1e-6 * static_cast<double>(summary.bytes) / seconds;
      }
      compute = std::max(compute, summary.frames / (seconds - disk));
      maps = summary.normal_maps + summary.velocity_maps;
    }
    std::printf("| %-56s | %6.0f | %6.0f | %5.0f | %d |\n", row.name.c_str(), best, compute, rate, maps);
    std::fflush(stdout);
  }
  CompareSeenTexels(body, path);
  std::filesystem::remove(path);
  std::filesystem::remove(DescriptorHeaderPath(path));
}

}  // namespace bodyloom
