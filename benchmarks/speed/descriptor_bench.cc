// SPDX-License-Identifier: Apache-2.0
// Time and error of everything from posed vertices to descriptor files and textures, on the built-in body:
//   build/release/benchmarks/bodyloom_bench_descriptors [FOLDER [SECTION]]
// SECTION: normals, velocities, bake, seams, stream or texture. FOLDER (default: the system's temporary folder) takes
// the files that are timed, and the textures to look at. Times are the median and the minimum of many repetitions, one
// thread unless said.
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/photo.hpp>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/speed/peer_normals.h"
#include "data_tools/builtin_body.h"
#include "data_tools/descriptors/describe_track.h"
#include "data_tools/video/image_file.h"
#include "geometry/normals.h"
#include "geometry/normals_simd.h"
#include "geometry/rotation.h"
#include "geometry/surface_velocity.h"
#include "geometry/uv_bake.h"
#include "geometry/uv_charts.h"
#include "render/texture_extract.h"
#include "render/uv_fill.h"
#include "render/uv_sample.h"
#include "render/visible_points.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

struct Milliseconds {
  double median = 0, least = 0;
};

Milliseconds Time(int repetitions, const std::function<void()>& work) {
  std::vector<double> ms;
  work();
  for (int i = 0; i < repetitions; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    ms.push_back(1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(ms.begin(), ms.end());
  return {ms[ms.size() / 2], ms.front()};
}

void Print(const std::string& what, Milliseconds ms, const std::string& error) {
  std::printf("| %-58s | %8.3f | %8.3f | %s |\n", what.c_str(), ms.median, ms.least, error.c_str());
  std::fflush(stdout);
}

void Title(const std::string& text) {
  std::printf("\n## %s\n\n| what | median ms | least ms | error |\n|---|---|---|---|\n", text.c_str());
}

std::string Format(const char* format, double a, double b = 0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

/// Every joint swings at its own phase, the body walks and turns: smooth, at most `hz`.
BodyPose PoseAt(const BodyModel& body, double time, double hz) {
  BodyPose pose;
  for (int j = 0; j < body.num_joints(); ++j) {
    const Vector3d phase(0.7 * j, 1.9 * j, 2.3 * j);
    const Vector3d swing = (j == 0 ? 0.15 : 0.25) * (2 * M_PI * hz * time + phase.array()).sin();
    pose.rotations.push_back(RotationFromAxisAngle(swing));
  }
  pose.rotations[0] = RotationFromAxisAngle(Vector3d(M_PI, 0, 0)) * RotationFromAxisAngle(Vector3d(0, 0.8 * time, 0)) *
                      pose.rotations[0];
  pose.trans = Vector3d(0.3 * std::sin(2 * M_PI * hz * time), 0.05 * std::cos(4 * time), 3.2 + 0.2 * std::sin(time));
  return pose;
}

Track TrackOf(const BodyModel& body, int T, double fps, double hz, double noise) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Track track;
  track.camera = MakePinhole(640, 640, 900);
  track.motion.poses.resize(T, 3 * body.num_joints());
  track.motion.trans.resize(T, 3);
  track.motion.up = Motion::Up::kCamera;
  for (int t = 0; t < T; ++t) {
    BodyPose pose = PoseAt(body, t / fps, hz);
    for (auto& R : pose.rotations) {
      R *= RotationFromAxisAngle(noise * Vector3d(normal(random), normal(random), normal(random)));
    }
    pose.trans += 0.3 * noise * Vector3d(normal(random), normal(random), normal(random));
    track.motion.poses.row(t) = AxisAngleFromPose(body, pose).transpose();
    track.motion.trans.row(t) = pose.trans.transpose();
    track.motion.timestamps.push_back(t / fps);
  }
  track.frame_status.assign(T, FrameStatus::kTracked);
  return track;
}

double AngleBetween(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

void BenchNormals(const BodyModel& body) {
  Title("Normals of a mesh, 7,874 vertices, 15,744 faces");
  const MatrixX3d vertices = PoseVertices(body, Eigen::VectorXd(), PoseAt(body, 0.3, 1));
  const Vector3d root = body.joint_template().row(0).transpose() + PoseAt(body, 0.3, 1).trans;
  const MatrixX3f from_root = (vertices.rowwise() - root.transpose()).cast<float>();
  const size_t size = static_cast<size_t>(from_root.size());
  MatrixX3d sums[2] = {MatrixX3d::Zero(vertices.rows(), 3), MatrixX3d::Zero(vertices.rows(), 3)};
  for (int f = 0; f < body.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int v = body.data().faces(f, k);
      const Vector3d p = vertices.row(v), a = vertices.row(body.data().faces(f, (k + 1) % 3)).transpose() - p,
                     b = vertices.row(body.data().faces(f, (k + 2) % 3)).transpose() - p, n = a.cross(b);
      sums[0].row(v) += n.transpose();
      sums[1].row(v) += std::atan2(n.norm(), a.dot(b)) * n.normalized().transpose();
    }
  }
  const auto largest = [&](const auto& normals, const MatrixX3d& truth) {
    double worst = 0;
    for (Eigen::Index v = 0; v < truth.rows(); ++v) {
      worst = std::max(worst, AngleBetween(Vector3d(normals.row(v).transpose().template cast<double>()), truth.row(v)));
    }
    return Format("max %.4f deg to the definition in double", worst / kDegree);
  };
  for (const NormalWeighting weighting : {NormalWeighting::kArea, NormalWeighting::kAngle}) {
    const bool area = weighting == NormalWeighting::kArea;
    const MeshNormals normals_of(body.data().faces, body.num_vertices(), weighting);
    MatrixX3f normals(vertices.rows(), 3);
    NormalScratch scratch;
    const Milliseconds ms = Time(400, [&] {
      normals_of.Compute({from_root.data(), size}, {normals.data(), size}, &scratch);
    });
    Print(area ? "area-weighted" : "angle-weighted", ms, largest(normals, sums[area ? 0 : 1]));
    std::vector<float> many(64 * size), out(64 * size);
    for (int t = 0; t < 64; ++t) std::copy(from_root.data(), from_root.data() + size, many.begin() + t * size);
    for (const int threads : {1, 2}) {
      Milliseconds batch = Time(20, [&] { normals_of.ComputeFrames(many, out, threads); });
      Print(std::string(area ? "area" : "angle") + "-weighted, a frame of 64, " + std::to_string(threads) + " threads",
            {batch.median / 64, batch.least / 64}, "same bytes");
    }
  }
  MatrixX3d peer_normals(vertices.rows(), 3);
  const auto openmesh = OpenMeshNormals(body.data().faces, vertices);
  const Milliseconds openmesh_ms = Time(60, [&] { openmesh->Compute(vertices, &peer_normals); });
  Print("peer: OpenMesh, area-weighted", openmesh_ms, largest(peer_normals, sums[0]));
  if (const auto cgal = CgalNormals(body.data().faces, vertices)) {
    const Milliseconds cgal_ms = Time(15, [&] { cgal->Compute(vertices, &peer_normals); });
    Print("peer: CGAL compute_vertex_normals (a definition of its own)", cgal_ms, largest(peer_normals, sums[1]));
  }
}

void BenchVelocities(const BodyModel& body) {
  for (const auto& [hz, noise] : {std::pair{0.8, 0.0}, {0.8, 0.01}, {3.0, 0.0}}) {
    Title("Velocities of a frame at 30 fps, motion of " + Format("%.1f Hz, pose noise %.3f rad", hz, noise));
    constexpr int T = 41, kFirst = 8, kLast = 32;
    const Track track = TrackOf(body, T, 30, hz, noise);
    // The mean over frames 8 … 32, so that one frame's luck does not decide.
    std::vector<MatrixX3d> truth;
    const double h = 1e-4;
    for (int t = kFirst; t <= kLast; ++t) {
      truth.push_back((PoseVertices(body, Eigen::VectorXd(), PoseAt(body, t / 30.0 + h, hz)) -
                       PoseVertices(body, Eigen::VectorXd(), PoseAt(body, t / 30.0 - h, hz))) /
                      (2 * h));
    }
    std::vector<BodyPose> poses;
    for (const auto& pose : PosesInFrame(body, track, SurfaceFrame::kCamera)) poses.push_back(*pose);
    const Skinner skinner(body);
    const ShapedBody shape = skinner.Shape(Eigen::VectorXd());
    const size_t stride = 3 * size_t(body.num_vertices());
    std::vector<float> vertices(stride * T);
    MatrixX3d root_rows;
    skinner.SkinFromRoot(shape, poses, vertices, &root_rows);
    std::vector<Vector3d> roots;
    for (int t = 0; t < T; ++t) roots.push_back(root_rows.row(t).transpose());
    std::vector<float> velocities(stride);
    double error = 0, square = 0;
    const auto add = [&](int t) {
      const Eigen::Map<const MatrixX3f> found(velocities.data(), body.num_vertices(), 3);
      error += (found.cast<double>() - truth[t - kFirst]).squaredNorm();
      square += truth[t - kFirst].squaredNorm();
    };
    const auto rmse = [&] {
      const double n = static_cast<double>(truth.size()) * body.num_vertices();
      const std::string text = Format("rmse %.4f m/s of %.3f m/s rms", std::sqrt(error / n), std::sqrt(square / n));
      error = square = 0;
      return text;
    };
    const std::vector<char> usable(T, 1);
    for (const auto& [scheme, name] : {std::pair{VelocityScheme::kBackward, "backward"},
                                       {VelocityScheme::kCentral, "central"},
                                       {VelocityScheme::kSavitzkyGolay, "savgol"}}) {
      const auto stencils = VelocityStencils(track.motion.timestamps, usable, {.scheme = scheme});
      const auto difference = [&](const VelocityStencil& stencil) {
        std::vector<const float*> frames;
        for (size_t k = 0; k < stencil.weights.size(); ++k) {
          frames.push_back(&vertices[stride * (stencil.first_frame + k)]);
        }
        DifferenceVertices(stencil, frames, std::span(roots).subspan(stencil.first_frame, frames.size()), velocities);
      };
      const Milliseconds ms = Time(300, [&] { difference(stencils[kFirst]); });
      for (int t = kFirst; t <= kLast; ++t) {
        difference(stencils[t]);
        add(t);
      }
      Print(name, ms, rmse() + Format(", noise gain %.1f /s", stencils[kFirst].NoiseGain()));
    }
    const auto stencils = VelocityStencils(track.motion.timestamps, usable);
    std::vector<BodyPose> batch;
    std::vector<PoseRates> rates;
    for (int t = kFirst; t <= kLast; ++t) {
      std::vector<const BodyPose*> around;
      for (size_t k = 0; k < stencils[t].weights.size(); ++k) around.push_back(&poses[stencils[t].first_frame + k]);
      batch.push_back(poses[t]);
      rates.push_back(RatesOf(stencils[t], around, poses[t]));
    }
    const VelocitySkinner velocity_skinner(body);
    std::vector<float> all(batch.size() * stride);
    const Milliseconds ms = Time(10, [&] { velocity_skinner.Velocities(shape, batch, rates, all, 1); });
    for (int t = kFirst; t <= kLast; ++t) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(stride * (t - kFirst));
      velocities.assign(begin, begin + static_cast<std::ptrdiff_t>(stride));
      add(t);
    }
    const double n = static_cast<double>(batch.size());
    Print("analytic, a frame of 25", {ms.median / n, ms.least / n}, rmse());
  }
}

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

/// Error of bilinear lookups in a baked map of normals, next to seams and away from them.
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
        const double angle = taps.count > 0 ? AngleBetween(exact, found) / kDegree : 90;
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
  add("33 channels, float32, past maps baked anew, 2 threads", [](auto* o) { o->reuse_past = false; });
  for (const Row& row : rows) {
    double best = 0, compute = 0, rate = 0;
    int maps = 0;
    for (int repetition = 0; repetition < 3; ++repetition) {
      std::filesystem::remove(path);  // freeing an old file's pages is not part of the work
      const auto start = std::chrono::steady_clock::now();
      const DescribeTrackSummary summary = DescribeTrack(body, track, path, row.options);
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
  std::filesystem::remove(path);
  std::filesystem::remove(DescriptorHeaderPath(path));
}

/// A texture that shows what goes wrong: fine stripes, a colour a chart, smooth shades.
std::vector<float> KnownTexture(const BodyModel& body, const UvTexelTable& table) {
  const size_t pixels = size_t(table.width) * table.height;
  std::vector<float> bgr(3 * pixels, 0.0F);
  for (size_t i = 0; i < table.size(); ++i) {
    Vector3d p = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      p +=
          double{table.barycentric[i][k]} * body.data().v_template.row(body.data().faces(table.face[i], k)).transpose();
    }
    const double stripes = 0.5 + 0.5 * std::sin(2 * M_PI * p.y() / 0.06),
                 rings = 0.5 + 0.5 * std::sin(2 * M_PI * p.x() / 0.09);
    bgr[table.pixel[i]] = static_cast<float>(0.2 + 0.5 * stripes);
    bgr[pixels + table.pixel[i]] = static_cast<float>(0.3 + 0.4 * rings);
    bgr[2 * pixels + table.pixel[i]] = static_cast<float>(0.5 + 0.3 * std::sin(4 * p.y() + 3 * p.z()));
  }
  return bgr;
}

Image ImageOf(const std::vector<float>& planes, int width, int height) {
  Image image(width, height);
  const size_t pixels = size_t(width) * height;
  for (size_t p = 0; p < pixels; ++p) {
    for (size_t c = 0; c < 3; ++c) {
      image.bgr[3 * p + c] = static_cast<uint8_t>(std::clamp(std::lround(255 * planes[c * pixels + p]), 0L, 255L));
    }
  }
  return image;
}

void BenchTexture(const BodyModel& body, const std::string& folder) {
  Title("Texture of a body painted with a known one, 40 frames of 640², atlas 512²");
  const UvCharts charts = FindUvCharts(body);
  const UvTexelTable fine = BuildUvTexelTable(body, charts, {.width = 1024, .height = 1024, .gutter = 2});
  const std::vector<float> paint = KnownTexture(body, fine);
  const Track track = TrackOf(body, 40, 8, 0.3, 0);
  const auto poses = PosesInFrame(body, track, SurfaceFrame::kCamera);
  TextureExtractor extractor(body);
  const UvTexelTable& table = extractor.table();
  const std::vector<float> truth = KnownTexture(body, table);
  double seconds = 0;
  for (int t = 0; t < track.num_frames(); ++t) {
    const MatrixX3d vertices = PoseVertices(body, Eigen::VectorXd(), *poses[t]);
    VisibilityBuffer buffer;
    buffer.Render(vertices, body.data().faces, track.camera);
    const VisiblePoints points = ResolveVisiblePoints(buffer, body, vertices, track.camera);
    const Image picture = ImageOf(ProjectUvMaps(body, charts, fine, paint, 3, points, 640, 640), 640, 640);
    if (t == 3) WriteImage((std::filesystem::path(folder) / "texture_bench_frame.png").string(), picture);
    const auto start = std::chrono::steady_clock::now();
    extractor.Add(picture, vertices, track.camera, t);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  Texture texture = extractor.Merge();
  const size_t pixels = size_t(512) * 512;
  const auto psnr = [&](const std::vector<float>& bgr, bool seen) {
    double squares = 0;
    int count = 0;
    for (size_t i = 0; i < table.size(); ++i) {
      const int p = table.pixel[i];
      if (table.in_gutter[i] || (texture.confidence[p] > 0) != seen) continue;
      ++count;
      for (int c = 0; c < 3; ++c) squares += std::pow(bgr[c * pixels + p] - truth[c * pixels + p], 2);
    }
    return -10 * std::log10(squares / (3.0 * count));
  };
  const double ms = 1e3 * seconds / track.num_frames();
  Print("extraction, a frame", {ms, ms},
        Format("%.1f dB on the %.1f %% of texels seen", psnr(texture.bgr, true),
               100.0 * texture.num_seen / table.num_inside));
  WriteImage((std::filesystem::path(folder) / "texture_bench_truth.png").string(), ImageOf(truth, 512, 512));
  WriteImage((std::filesystem::path(folder) / "texture_bench_seen.png").string(), ImageOf(texture.bgr, 512, 512));

  // Holes for the fillers: what the first frame alone does not show.
  TextureExtractor first(body);
  const MatrixX3d vertices = PoseVertices(body, Eigen::VectorXd(), *poses[0]);
  VisibilityBuffer buffer;
  buffer.Render(vertices, body.data().faces, track.camera);
  first.Add(ImageOf(ProjectUvMaps(body, charts, fine, paint, 3,
                                  ResolveVisiblePoints(buffer, body, vertices, track.camera), 640, 640),
                    640, 640),
            vertices, track.camera, 0);
  // A smooth map, which a filler can hope to continue.
  std::vector<float> smooth(3 * pixels, 0.0F);
  for (size_t i = 0; i < table.size(); ++i) {
    Vector3d p = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      p +=
          double{table.barycentric[i][k]} * body.data().v_template.row(body.data().faces(table.face[i], k)).transpose();
    }
    for (int c = 0; c < 3; ++c) {
      smooth[c * pixels + table.pixel[i]] = static_cast<float>(0.5 + 0.4 * std::sin(3 * p[c] + 2 * p[(c + 1) % 3]));
    }
  }
  texture = first.Merge();
  std::vector<uint8_t> known(pixels);
  int holes = 0;
  std::vector<char> hole(pixels, 0);
  for (size_t i = 0; i < table.size(); ++i) {
    const int p = table.pixel[i];
    known[p] = texture.confidence[p] > 0;
    hole[p] = !table.in_gutter[i] && !known[p];
    holes += hole[p];
  }
  const auto rmse = [&](const std::vector<float>& maps) {
    double squares = 0;
    for (size_t p = 0; p < pixels; ++p) {
      for (int c = 0; hole[p] && c < 3; ++c) squares += std::pow(maps[c * pixels + p] - smooth[c * pixels + p], 2);
    }
    return std::sqrt(squares / (3.0 * holes));
  };
  Title(Format("Filling what one frame does not show (%.0f of %.0f texels, 3 channels, 512²), smooth map", holes,
               table.num_inside));
  const auto with_holes = [&] {
    std::vector<float> maps = smooth;
    for (size_t p = 0; p < maps.size(); ++p) {
      if (!known[p % pixels]) maps[p] = 0;
    }
    return maps;
  };
  std::vector<float> filled;
  const PyramidFill pyramid(body, table);
  Milliseconds fill_ms = Time(7, [&] {
    filled = with_holes();
    pyramid.Fill(known, 3, filled);
  });
  Print("pyramid with seam links", fill_ms, Format("rmse %.4f", rmse(filled)));
  std::unique_ptr<LaplaceFill> laplace;
  const Milliseconds factor_ms = Time(2, [&] { laplace = std::make_unique<LaplaceFill>(body, table, known); });
  Print("Laplacian: graph and factor, once a mask", factor_ms, "");
  fill_ms = Time(5, [&] {
    filled = with_holes();
    laplace->Fill(3, filled);
  });
  Print("Laplacian: solve", fill_ms, Format("rmse %.4f", rmse(filled)));
  const Image holed = ImageOf(with_holes(), 512, 512);
  cv::Mat source(512, 512, CV_8UC3, const_cast<uint8_t*>(holed.bgr.data())), mask(512, 512, CV_8UC1), result;
  for (size_t p = 0; p < pixels; ++p) mask.data[p] = known[p] ? 0 : 255;
  for (const auto& [method, name] : {std::pair{cv::INPAINT_TELEA, "Telea"}, {cv::INPAINT_NS, "Navier-Stokes"}}) {
    const Milliseconds ms_cv = Time(1, [&] { cv::inpaint(source, mask, result, 3, method); });
    std::vector<float> planes(3 * pixels);
    for (size_t p = 0; p < pixels; ++p) {
      for (size_t c = 0; c < 3; ++c) planes[c * pixels + p] = static_cast<float>(result.data[3 * p + c]) / 255;
    }
    Print(std::string("peer: cv::inpaint ") + name + ", 8 bit, knows no seams", ms_cv,
          Format("rmse %.4f", rmse(planes)));
  }
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : std::filesystem::temp_directory_path().string();
  const std::string only = argc > 2 ? argv[2] : "";
  const bodyloom::BodyModel& body = bodyloom::BuiltinBody();
  const auto wanted = [&only](const char* section) { return only.empty() || only == section; };
  if (wanted("normals")) bodyloom::BenchNormals(body);
  if (wanted("velocities")) bodyloom::BenchVelocities(body);
  if (wanted("bake")) bodyloom::BenchBake(body);
  if (wanted("seams")) bodyloom::BenchSeams(body);
  if (wanted("stream")) bodyloom::BenchStream(body, folder);
  if (wanted("texture")) bodyloom::BenchTexture(body, folder);
  return 0;
}
