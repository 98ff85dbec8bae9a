// SPDX-License-Identifier: Apache-2.0
/// The report of a comparison of two sets of pictures: as text, as JSON, and as a table of frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bodyloom/data_tools/evaluation/speed_reaction.h"
#include "bodyloom/pipelines/score/metric_table.h"

namespace bodyloom {

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
