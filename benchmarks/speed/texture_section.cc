// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/photo.hpp>
#include <utility>

#include "benchmarks/speed/moving_body.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/stopwatch.h"
#include "geometry/uv_maps/surface_velocity.h"
#include "geometry/uv_maps/uv_charts.h"
#include "render/raster/visible_points.h"
#include "render/texture/complete/uv_fill.h"
#include "render/texture/texture_extract.h"
#include "render/texture/uv_sample.h"

namespace bodyloom {

using Eigen::Vector3d;

namespace {

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

}  // namespace

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
    const Image image = ImageOf(ProjectUvMaps(body, charts, fine, paint, 3, points, 640, 640), 640, 640);
    if (t == 3) WriteImage((std::filesystem::path(folder) / "texture_bench_frame.png").string(), image);
    const Stopwatch watch;
    extractor.Add(image, vertices, track.camera, t);
    seconds += watch.seconds();
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
  for (const auto& [number, name] : {std::pair{cv::INPAINT_TELEA, "Telea"}, {cv::INPAINT_NS, "Navier-Stokes"}}) {
    const int method = number;
    const Milliseconds ms_cv = Time(1, [&] { cv::inpaint(source, mask, result, 3, method); });
    std::vector<float> planes(3 * pixels);
    for (size_t p = 0; p < pixels; ++p) {
      for (size_t c = 0; c < 3; ++c) planes[c * pixels + p] = static_cast<float>(result.data[3 * p + c]) / 255;
    }
    Print(std::string("peer: cv::inpaint ") + name + ", 8 bit, knows no seams", ms_cv,
          Format("rmse %.4f", rmse(planes)));
  }
}

}  // namespace bodyloom
