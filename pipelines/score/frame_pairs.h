// SPDX-License-Identifier: Apache-2.0
/// The frames of two sides that CompareResults compares, a few at a time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/evaluation/image_metrics.h"
#include "render/image/image.h"

namespace bodyloom {

/// One frame of both sides, of equal size.
struct FramePair {
  std::string name;   ///< file name without extension; videos: six digits of the frame's index
  std::string where;  ///< the result's file (and frame), for messages
  /// Whether the frame before shows the moment before: false for the first, after a cut and where a frame is left out.
  bool follows = false;
  Image truth, result;
  std::optional<PixelMask> mask;
};

/// Two folders of pictures matched by name without extension, or two videos (or a video and a folder) frame by frame.
class FramePairs {
 public:
  /// `mask` may be empty. Names that only one side has are an error unless `common_only`; a missing mask always is.
  /// `runs`: of a clip with cuts, by frame the number of the gap-free run that it lies in; empty: nobody knows of any.
  /// Pictures of a folder follow each other where their names' numbers do (FrameNumberFromName; every fifth frame of a
  /// clip is no gap of four) and where those numbers lie in one run; names without numbers as they are sorted. Of
  /// videos without `runs` every frame follows: a cut in the pictures alone is not looked for.
  /// Throws std::runtime_error naming the path: nothing there, no pictures, two files of one name, no common name.
  static std::unique_ptr<FramePairs> Open(const std::string& truth, const std::string& result, const std::string& mask,
                                          bool common_only, const std::vector<int>& runs = {});
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
