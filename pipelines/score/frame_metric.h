// SPDX-License-Identifier: Apache-2.0
/// Metrics of a frame against its truth: PSNR and SSIM of pictures, overlap of labels, angles of normals.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data_tools/evaluation/ssim.h"
#include "pipelines/score/frame_pairs.h"

namespace bodyloom {

struct MetricColumn {
  std::string name;     ///< ends in its unit where it has one: "psnr_db"
  std::string meaning;  ///< one line
};

/// Something computed of every frame: one value a column, NaN where there is nothing to measure. `before` is the frame
/// before in the sequence, nullptr where there is none to follow: at the first, and after a cut (FramePair::follows).
/// Called from several threads at once.
struct FrameMetric {
  std::vector<MetricColumn> columns;
  std::function<std::vector<double>(const FramePair& frame, const FramePair* before)> compute;
};

/// PSNR and SSIM of colour pictures, with a mask also PSNR inside it.
FrameMetric ImageMetric(SsimPreset preset, bool has_mask);
/// Overlap of the seven labels of a single-person dataset (grey pictures of 0..6), of all but the background, and
/// accuracy.
FrameMetric LabelMetric();
/// Angle between normals, n = 2c/255 − 1; inside the mask where there is one.
FrameMetric NormalMetric();

}  // namespace bodyloom
