// SPDX-License-Identifier: Apache-2.0
#include "render/splat/splat_gradient.h"

#include <algorithm>
#include <array>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "render/splat/splat_simd.h"

namespace bodyloom {
namespace {

using splat_internal::kSlotFloats;
using splat_internal::kTilePixels;
using splat_internal::kTileSize;
using splat_internal::SplatList;
using splat_internal::SplatTileBack;
using splat_internal::SplatTiles;

constexpr int kRowsASum = 1024;
constexpr int kRowsAhead = 8;  // prefetch distance: slots of neighbouring rows lie far apart

}  // namespace

void SplatGradient::GoThroughTile(const SplatImage& image, const FloatColumns& by_planes, int index) {
  const SplatTiles& tiles = image.tiles();
  const PixelBox box = tiles.BoxOf(index), pixels = tiles.PixelsOf(index);
  const PixelBox& window = image.window();
  SplatTileBack tile;
  tile.x = box.x_begin, tile.y = box.y_begin;
  tile.stop = image.options().stop_transmittance;
  std::fill_n(tile.transmittance, kTilePixels, 1.0F);
  // Pixels outside the window: derivatives of zero.
  const int left = pixels.x_begin - box.x_begin;
  float by[SplatImage::kNumPlanes][kTileSize] = {}, seen[SplatImage::kNumPlanes][kTileSize] = {}, rest[kTileSize];
  for (int y = 0; y < kTileSize; ++y) {
    const bool is_inside = y + box.y_begin >= pixels.y_begin && y + box.y_begin < pixels.y_end;
    const size_t from = is_inside ? window.IndexOf(pixels.x_begin, y + box.y_begin) : 0;
    for (int p = 0; p < SplatImage::kNumPlanes; ++p) {
      if (is_inside) {
        splat_internal::CopyPixels(by_planes.column(p) + from, pixels.width(), by[p] + left);
        splat_internal::CopyPixels(image.planes().column(p) + from, pixels.width(), seen[p] + left);
      } else {
        std::fill_n(by[p], kTileSize, 0.0F);
      }
      splat_internal::RowToTile(by[p], y, p == SplatImage::kAlpha ? tile.by_alpha : tile.by_colour[p]);
    }
    for (int x = 0; x < kTileSize; ++x) {
      rest[x] = (seen[0][x] * by[0][x] + seen[1][x] * by[1][x]) + (seen[2][x] * by[2][x] + seen[3][x] * by[3][x]);
    }
    splat_internal::RowToTile(rest, y, tile.rest);
  }
  for (int chunk = 0; chunk < tiles.num_chunks(); ++chunk) {
    const SplatList list = tiles.ListOf(index, chunk);
    if (list.count == 0) continue;
    DrawSplatsBackward(list, &tile, sums_.get() + static_cast<size_t>(tiles.first_slot(chunk)) * kSlotFloats);
  }
}

void SplatGradient::SumRows(const SplatImage& image, const ScreenGaussians& screen, int first, int last,
                            FloatColumns* by_screen) const {
  using Screen = ScreenGaussians;
  const FloatColumns& columns = screen.columns;
  FloatColumns& by = *by_screen;
  std::array<std::pair<int, int>, kRowsASum> slots{};
  for (int row = first; row < last; ++row) {
    if (rank_of_[row] >= 0) slots[row - first] = image.tiles().SlotsOf(rank_of_[row]);
  }
  const auto sums_of = [&](int slot) { return sums_.get() + static_cast<size_t>(slot) * kSlotFloats; };
  for (int row = first; row < last; ++row) {
    __builtin_prefetch(sums_of(slots[std::min(row + kRowsAhead, last - 1) - first].first));
    float s[9] = {};
    for (int slot = slots[row - first].first; slot < slots[row - first].second; ++slot) {
      const float* from = sums_of(slot);
      for (int k = 0; k < 9; ++k) s[k] += from[k];
    }
    const float kxx = columns(row, Screen::kConicXx), kxy = columns(row, Screen::kConicXy),
                kyy = columns(row, Screen::kConicYy), opacity = columns(row, Screen::kOpacity);
    by(row, Screen::kMeanX) = kxx * s[1] + kxy * s[2];
    by(row, Screen::kMeanY) = kxy * s[1] + kyy * s[2];
    by(row, Screen::kConicXx) = -0.5F * s[3];
    by(row, Screen::kConicXy) = -s[4];
    by(row, Screen::kConicYy) = -0.5F * s[5];
    by(row, Screen::kOpacity) = opacity > 0 ? s[0] / opacity : 0;
    by(row, Screen::kRed) = s[6], by(row, Screen::kGreen) = s[7], by(row, Screen::kBlue) = s[8];
  }
}

void SplatGradient::Compute(const SplatImage& image, const ScreenGaussians& screen, const FloatColumns& by_planes,
                            int num_threads, FloatColumns* by_screen) {
  const int count = screen.size();
  BODYLOOM_CHECK(num_threads >= 1, "splat gradient: ", num_threads, " threads, expected at least 1");
  BODYLOOM_CHECK(image.num_gaussians() == count, "splat gradient: ", count, " Gaussians, expected the ",
                 image.num_gaussians(), " of the image");
  BODYLOOM_CHECK(by_planes.columns() == SplatImage::kNumPlanes && by_planes.rows() == image.planes().rows(),
                 "splat gradient: derivatives are ", by_planes.rows(), " by ", by_planes.columns(), ", expected ",
                 image.planes().rows(), " by ", static_cast<int>(SplatImage::kNumPlanes));
  const SplatTiles& tiles = image.tiles();
  const size_t size = static_cast<size_t>(tiles.num_slots()) * kSlotFloats;
  if (size > capacity_) {
    capacity_ = 0;
    sums_.reset();
    sums_ = ZeroFloats(size + size / 4);
    capacity_ = size + size / 4;
  }
  by_screen->Resize(ScreenGaussians::kNumGradients, count);
  rank_of_.assign(count, -1);
  for (size_t rank = 0; rank < tiles.order().size(); ++rank) rank_of_[tiles.order()[rank]] = static_cast<int>(rank);
  RunPhases(num_threads,
            {{[&] { return tiles.num_tiles(); }, [&](int i) { GoThroughTile(image, by_planes, i); }},
             {[&] { return (count + kRowsASum - 1) / kRowsASum; },
              [&](int i) { SumRows(image, screen, i * kRowsASum, std::min(count, (i + 1) * kRowsASum), by_screen); }}});
}

}  // namespace bodyloom
