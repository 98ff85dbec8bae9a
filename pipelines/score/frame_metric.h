// SPDX-License-Identifier: Apache-2.0
/// Metrics of a frame against its truth: PSNR and SSIM of images, overlap of labels, angles of normals.
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
