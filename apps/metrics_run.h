// SPDX-License-Identifier: Apache-2.0
/// What `bodyloom metrics` does: two sets of pictures compared frame by frame, any number of metrics side by side.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/metrics_frames.h"
#include "bodyloom/data_tools/evaluation/speed_reaction.h"
#include "bodyloom/data_tools/evaluation/ssim.h"

namespace bodyloom {

struct MetricColumn {
  std::string name;     ///< ends in its unit where it has one: "psnr_db"
  std::string meaning;  ///< one line
};

/// Something computed of every frame: one value a column, NaN where there is nothing to measure. `before` is the frame
/// before in the sequence, nullptr at the first. Called from several threads at once.
struct FrameMetric {
  std::vector<MetricColumn> columns;
  std::function<std::vector<double>(const FramePair& frame, const FramePair* before)> compute;
};

struct MetricRow {
  std::string frame;
  std::vector<double> values;  ///< as many as columns
};

/// One kind of picture: "images", "labels" or "normals".
struct MetricTable {
  std::string kind;
  std::vector<MetricColumn> columns;
  std::vector<MetricRow> rows;
  int left_out = 0;  ///< frames that only one side has
};

struct ColumnSummary {
  double mean = 0, std = 0;  ///< over the finite values (std of the population); NaN when there are none
  int finite = 0;
  int infinite = 0;   ///< PSNR of equal pictures
  int undefined = 0;  ///< NaN: nothing to measure
};
ColumnSummary Summarise(const MetricTable& table, size_t column);

struct MetricsCommand {
  std::string truth, result, mask, json, csv;
  std::string other_truth, other_result;        ///< person sets of the same poses at another speed; empty: none
  PersonLabel reacting = PersonLabel::kBottom;  ///< whose reaction to the speed is measured
  SsimPreset preset = SsimPreset::kWang2004;
  bool common_only = false;
  int num_threads = 0;  ///< 0: all cores
  bool quiet = false;
  std::vector<FrameMetric> more;  ///< further metrics of images, after PSNR and SSIM
};

struct MetricsReport {
  std::string truth, result, mask, preset;
  std::vector<MetricTable> tables;
  std::vector<std::string> only_one_side;  ///< kinds that one side alone has, not compared
  std::optional<SpeedReaction> reaction;
  double seconds = 0;
};

/// PSNR and SSIM of colour pictures, with a mask also PSNR inside it.
FrameMetric ImageMetric(SsimPreset preset, bool has_mask);
/// Overlap of the seven labels of a person set (grey pictures of 0..6), of all but the background, and accuracy.
FrameMetric LabelMetric();
/// Angle between normals, n = 2c/255 − 1; inside the mask where there is one.
FrameMetric NormalMetric();

/// Compares all frames, num_threads at a time; the table is the same for any number.
MetricTable CompareFrames(const std::string& kind, FramePairs* frames, const std::vector<FrameMetric>& metrics,
                          int num_threads, const std::function<void(double fraction)>& progress = {});

/// Pictures in both folders, or in images/, labels/ and normals/ below both, or two videos; writes the files asked for.
/// Throws std::runtime_error naming a file that cannot be used; nothing is left behind then.
MetricsReport RunMetrics(const MetricsCommand& command);

/// A line a column: mean, standard deviation, frames.
std::string ToText(const MetricsReport& report);
/// The same as one JSON object (docs/image_metrics.md); what is not finite is null.
std::string ToJson(const MetricsReport& report);
/// A line a frame, all kinds side by side; empty where a kind lacks the frame; nan and inf as such.
std::string ToCsv(const MetricsReport& report);

}  // namespace bodyloom
