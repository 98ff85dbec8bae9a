// SPDX-License-Identifier: Apache-2.0
/// The frames of two sides that CompareResults compares, a few at a time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bodyloom/data_tools/evaluation/image_metrics.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// One frame of both sides, of equal size.
struct FramePair {
  std::string name;   ///< file name without extension; videos: six digits of the frame's index
  std::string where;  ///< the result's file (and frame), for messages
  Image truth, result;
  std::optional<PixelMask> mask;
};

/// Two folders of pictures matched by name without extension, or two videos (or a video and a folder) frame by frame.
class FramePairs {
 public:
  /// `mask` may be empty. Names that only one side has are an error unless `common_only`; a missing mask always is.
  /// Throws std::runtime_error naming the path: nothing there, no pictures, two files of one name, no common name.
  static std::unique_ptr<FramePairs> Open(const std::string& truth, const std::string& result, const std::string& mask,
                                          bool common_only);
  virtual ~FramePairs() = default;

  /// Up to `count` further frames, decoded on up to num_threads threads; empty at the end. Throws std::runtime_error
  /// naming the file: not decodable, another size than the truth, a video that ends before the other.
  virtual std::vector<FramePair> Next(int count, int num_threads) = 0;
  /// Frames in all; 0: not known (a video that does not say).
  [[nodiscard]] virtual int num_frames() const = 0;
  /// Names left out because one side lacks them.
  [[nodiscard]] virtual int num_left_out() const { return 0; }
};

}  // namespace bodyloom
