// SPDX-License-Identifier: Apache-2.0
/// Preview sheet of a descriptor file: a row per frame, a column per map. Normals are drawn as colours (n + 1)/2,
/// velocities grey at rest with a full colour at the largest speed of the sheet.
#pragma once

#include <span>
#include <vector>

#include "geometry/uv_maps/uv_texels.h"
#include "render/image/image.h"

namespace bodyloom {

struct DescribeTrackOptions;

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

}  // namespace bodyloom
