// SPDX-License-Identifier: Apache-2.0
/// Tables of metrics, with one row per frame and one column per metric, and the report made of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/evaluation/speed_response.h"
#include "pipelines/score/frame_metric.h"

namespace bodyloom {

struct MetricRow {
  std::string frame;
  std::vector<double> values;  ///< as many as columns
};

/// Table of one kind of image: "images", "labels" or "normals".
struct MetricTable {
  std::string kind;
  std::vector<MetricColumn> columns;
  std::vector<MetricRow> rows;
  int left_out = 0;  ///< frames that only one side has
};

struct ColumnSummary {
  double mean = 0, std = 0;  ///< over the finite values (std of the population); NaN when there are none
  int finite = 0;
  int infinite = 0;   ///< PSNR of equal images
  int undefined = 0;  ///< NaN: nothing to measure
};
ColumnSummary Summarise(const MetricTable& table, size_t column);

/// Compares all frames, num_threads at a time; the table is the same for any number.
MetricTable CompareFrames(const std::string& kind, FramePairs* frames, const std::vector<FrameMetric>& metrics,
                          int num_threads, const std::function<void(double fraction)>& progress = {});

// Report of a comparison of two sets of images: as text, as JSON, and as a table of frames.

struct CompareResultsReport {
  std::string truth, result, mask, preset;
  std::vector<MetricTable> tables;
  std::vector<std::string> only_one_side;  ///< kinds present on one side only, not compared
  std::optional<SpeedResponse> reaction;
  double seconds = 0;
};

/// One line per column: mean, standard deviation, frames.
std::string ToText(const CompareResultsReport& report);
/// The same as one JSON object (docs/image_metrics.md); non-finite values are null.
std::string ToJson(const CompareResultsReport& report);
/// One line per frame, all kinds side by side; empty where a kind lacks the frame; nan and inf are written as such.
std::string ToCsv(const CompareResultsReport& report);

}  // namespace bodyloom
