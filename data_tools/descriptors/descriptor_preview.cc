// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/descriptor_preview.h"

#include <algorithm>
#include <cmath>

#include "data_tools/descriptors/describe_track.h"
#include "data_tools/formats/ndarray.h"
#include "render/image/image.h"
#include "render/view/caption.h"

namespace bodyloom {
namespace {

constexpr int kGap = 4;
constexpr int kSide = 256;  ///< pixels a map
constexpr int kLabel = 36;  ///< above it
constexpr Colour kBackground = {24, 24, 28};

}  // namespace

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

}  // namespace bodyloom
