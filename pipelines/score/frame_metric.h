// SPDX-License-Identifier: Apache-2.0
/// Metrics of a frame against its truth: PSNR and SSIM of images, overlap of labels, angles of normals.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/evaluation/image_metrics.h"
#include "data_tools/evaluation/ssim.h"
#include "render/image/image.h"

namespace bodyloom {

// Reads the frames of two sequences for CompareResults, a few at a time.

/// One frame of both sequences, of equal size.
struct FramePair {
  std::string name;   ///< file name without extension; videos: six digits of the frame's index
  std::string where;  ///< the result's file (and frame), for messages
  /// True if the previous frame directly precedes this one: false for the first, after a cut and after an omitted
  /// frame.
  bool follows = false;
  Image truth, result;
  std::optional<PixelMask> mask;
};

/// Two folders of images matched by name without extension, or two videos (or a video and a folder) frame by frame.
class FramePairs {
 public:
  /// `mask` may be empty. Names on one side only are an error unless `common_only`; a missing mask always is. `runs`:
  /// for a clip with cuts, the number of the gap-free run of each frame; empty: no known cuts. Images of a folder
  /// follow each other if the numbers in their names are consecutive at the folder's step (FrameNumberFromName; every
  /// fifth frame of a clip is not a gap) and lie in one run; names without numbers follow in sorted order. In videos
  /// without `runs` every frame follows: cuts are not detected from the images. Throws std::runtime_error naming the
  /// path: missing, no images, two files of one name, no common name.
  static std::unique_ptr<FramePairs> Open(const std::string& truth, const std::string& result, const std::string& mask,
                                          bool common_only, const std::vector<int>& runs = {});
  virtual ~FramePairs() = default;

  /// The next frames, at most `count`, decoded on up to num_threads threads; empty at the end. Throws
  /// std::runtime_error naming the file: not decodable, size different from the truth's, videos of different lengths.
  virtual std::vector<FramePair> Next(int count, int num_threads) = 0;
  /// Total number of frames; 0: unknown (a video that does not state it).
  [[nodiscard]] virtual int num_frames() const = 0;
  /// Number of names left out because one side lacks them.
  [[nodiscard]] virtual int num_left_out() const { return 0; }
};

struct MetricColumn {
  std::string name;     ///< ends in its unit where it has one: "psnr_db"
  std::string meaning;  ///< one line
};

/// A metric of a frame: one value per column, NaN where nothing can be measured. `before` is the previous frame of the
/// sequence; nullptr for the first frame and after a cut (FramePair::follows). Called from several threads at once.
struct FrameMetric {
  std::vector<MetricColumn> columns;
  std::function<std::vector<double>(const FramePair& frame, const FramePair* before)> compute;
};

/// PSNR and SSIM of colour images, with a mask also PSNR inside it.
FrameMetric ImageMetric(SsimPreset preset, bool has_mask);
/// Mean IoU of the labels of a single-person dataset (grey images of 0..6), accuracy, IoU of all but the background,
/// and IoU of each label.
FrameMetric LabelMetric();
/// Angle between normals, n = 2c/255 − 1; inside the mask where there is one.
FrameMetric NormalMetric();

}  // namespace bodyloom
