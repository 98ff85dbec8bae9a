// SPDX-License-Identifier: Apache-2.0
#include "render/splat/splat_image.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"

namespace bodyloom {

using splat_internal::kTileSize;
using splat_internal::Splat;
using splat_internal::SplatList;
using splat_internal::SplatTile;

bool SplatImageOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("stop_transmittance", stop_transmittance, 0, 1) && in_range("num_threads", num_threads, 1, 1024);
}

void SplatImage::DrawTile(int index, const Splat* other_splats, FloatColumns* planes) const {
  const PixelBox box = tiles_.BoxOf(index), pixels = tiles_.PixelsOf(index);
  SplatTile tile;
  tile.x = box.x_begin, tile.y = box.y_begin;
  tile.stop = options_.stop_transmittance;
  std::fill_n(tile.transmittance, splat_internal::kTilePixels, 1.0F);
  for (float* colour : {tile.colour[0], tile.colour[1], tile.colour[2]}) {
    std::fill_n(colour, splat_internal::kTilePixels, 0.0F);
  }
  for (int chunk = 0; chunk < tiles_.num_chunks() && tile.alive != 0; ++chunk) {
    SplatList list = tiles_.ListOf(index, chunk);
    if (other_splats != nullptr) list.splats = other_splats;
    if (list.count > 0) DrawSplats(list, &tile);
  }
  float row[kTileSize];
  const auto* const from = row + (pixels.x_begin - box.x_begin);
  for (int y = pixels.y_begin; y < pixels.y_end; ++y) {
    const size_t to = window_.IndexOf(pixels.x_begin, y);
    for (int c = 0; c < 3; ++c) {
      splat_internal::RowFromTile(tile.colour[c], y - box.y_begin, row);
      splat_internal::CopyPixels(from, pixels.width(), planes->column(c) + to);
    }
    if (other_splats != nullptr) continue;
    splat_internal::RowFromTile(tile.transmittance, y - box.y_begin, row);
    for (float& t : row) t = 1 - t;
    splat_internal::CopyPixels(from, pixels.width(), planes->column(kAlpha) + to);
  }
}

void SplatImage::Draw(const ScreenGaussians& screen, const PixelBox& window, const SplatImageOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "splat image: ", why);
  constexpr int kFarthest = 1 << 20;
  BODYLOOM_CHECK(window.empty() || (std::min(window.x_begin, window.y_begin) >= -kFarthest &&
                                    std::max(window.x_end, window.y_end) <= kFarthest && window.area() <= 1U << 27),
                 "splat image: the window is [", window.x_begin, ", ", window.x_end, ") x [", window.y_begin, ", ",
                 window.y_end, "), expected it within ±2^20 and of at most 2^27 pixels");
  options_ = options;
  window_ = window.empty() ? PixelBox{} : window;
  num_gaussians_ = screen.size();
  planes_.Resize(kNumPlanes, static_cast<int>(window_.area()));
  const Stopwatch watch;
  RunPhases(options.num_threads, {{[&] {
                                     tiles_.Begin(screen, window_);
                                     return tiles_.num_batches();
                                   },
                                   [&](int i) { tiles_.PackRows(screen, i); }},
                                  {[&] {
                                     tiles_.Order(screen);
                                     return tiles_.num_chunks();
                                   },
                                   [&](int i) { tiles_.SortChunk(i); }},
                                  {[&] {
                                     tiles_.End();
                                     summary_.sort_seconds = watch.seconds();
                                     return tiles_.num_tiles();
                                   },
                                   [&](int i) { DrawTile(i, nullptr, &planes_); }}});
  summary_.raster_seconds = watch.seconds() - summary_.sort_seconds;
  summary_.drawn = static_cast<int>(tiles_.order().size());
  summary_.meetings = tiles_.num_slots();
}

void SplatImage::DrawValues(const FloatColumns& values, FloatColumns* planes) {
  BODYLOOM_CHECK(values.columns() == 3 && values.rows() == num_gaussians_, "splat image: values are ", values.rows(),
                 " by ", values.columns(), ", expected ", num_gaussians_, " by 3");
  const auto order = tiles_.order();
  with_values_ = tiles_.splats();
  for (const int row : order) {
    Splat& splat = with_values_[row];
    splat.red = values(row, 0), splat.green = values(row, 1), splat.blue = values(row, 2);
    const float maximum = std::max({std::abs(values(row, 0)), std::abs(values(row, 1)), std::abs(values(row, 2))});
    BODYLOOM_CHECK(
        maximum <= ScreenGaussians::kLargestColour && std::isfinite(values(row, 0) + values(row, 1) + values(row, 2)),
        "splat image: values of Gaussian ", row, " are ", values(row, 0), ", ", values(row, 1), ", ", values(row, 2),
        ", expected finite ones within ±", ScreenGaussians::kLargestColour);
  }
  planes->Resize(3, static_cast<int>(window_.area()));
  ParallelFor(tiles_.num_tiles(), options_.num_threads, [&](int i) { DrawTile(i, with_values_.data(), planes); });
}

}  // namespace bodyloom
