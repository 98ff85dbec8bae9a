// SPDX-License-Identifier: Apache-2.0
/// Metrics of one kind of picture: a row a frame, a column a metric.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/evaluation/speed_reaction.h"
#include "pipelines/score/frame_metric.h"

namespace bodyloom {

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

/// Compares all frames, num_threads at a time; the table is the same for any number.
MetricTable CompareFrames(const std::string& kind, FramePairs* frames, const std::vector<FrameMetric>& metrics,
                          int num_threads, const std::function<void(double fraction)>& progress = {});

// The report of a comparison of two sets of pictures: as text, as JSON, and as a table of frames.

struct CompareResultsReport {
  std::string truth, result, mask, preset;
  std::vector<MetricTable> tables;
  std::vector<std::string> only_one_side;  ///< kinds that one side alone has, not compared
  std::optional<SpeedReaction> reaction;
  double seconds = 0;
};

/// A line a column: mean, standard deviation, frames.
std::string ToText(const CompareResultsReport& report);
/// The same as one JSON object (docs/image_metrics.md); what is not finite is null.
std::string ToJson(const CompareResultsReport& report);
/// A line a frame, all kinds side by side; empty where a kind lacks the frame; nan and inf as such.
std::string ToCsv(const CompareResultsReport& report);

}  // namespace bodyloom
