// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/score/metric_table.h"

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"

namespace bodyloom {
namespace {

MetricRow RowOf(const FramePair& frame, const FramePair* before, const std::vector<FrameMetric>& metrics) {
  MetricRow row;
  row.frame = frame.name;
  try {
    for (const FrameMetric& metric : metrics) {
      const std::vector<double> values = metric.compute(frame, before);
      BODYLOOM_CHECK(values.size() == metric.columns.size(), "a metric of ", metric.columns.size(), " columns gave ",
                     values.size(), " values");
      row.values.insert(row.values.end(), values.begin(), values.end());
    }
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(frame.where + ": " + error.what());
  }
  return row;
}

}  // namespace

MetricTable CompareFrames(const std::string& kind, FramePairs* frames, const std::vector<FrameMetric>& metrics,
                          int num_threads, const std::function<void(double fraction)>& progress) {
  MetricTable table;
  table.kind = kind;
  table.left_out = frames->num_left_out();
  for (const FrameMetric& metric : metrics) {
    table.columns.insert(table.columns.end(), metric.columns.begin(), metric.columns.end());
  }
  std::optional<FramePair> last;  // of the batch before
  for (;;) {
    std::vector<FramePair> batch = frames->Next(num_threads, num_threads);
    if (batch.empty()) break;
    const size_t begin = table.rows.size();
    table.rows.resize(begin + batch.size());
    ParallelFor(static_cast<int>(batch.size()), num_threads, [&](int i) {
      const FramePair* before = i > 0 ? &batch[i - 1] : last ? &*last : nullptr;
      table.rows[begin + i] = RowOf(batch[i], batch[i].follows ? before : nullptr, metrics);
    });
    last = std::move(batch.back());
    if (progress && frames->num_frames() > 0) {
      progress(static_cast<double>(table.rows.size()) / frames->num_frames());
    }
  }
  return table;
}

ColumnSummary Summarise(const MetricTable& table, size_t column) {
  ColumnSummary summary;
  double sum = 0;
  for (const MetricRow& row : table.rows) {
    const double value = row.values[column];
    summary.infinite += std::isinf(value);
    summary.undefined += std::isnan(value);
    if (!std::isfinite(value)) continue;
    ++summary.finite;
    sum += value;
  }
  summary.mean = summary.finite > 0 ? sum / summary.finite : std::numeric_limits<double>::quiet_NaN();
  double squares = 0;
  for (const MetricRow& row : table.rows) {
    const double difference = row.values[column] - summary.mean;
    if (std::isfinite(difference)) squares += difference * difference;
  }
  summary.std = summary.finite > 0 ? std::sqrt(squares / summary.finite) : summary.mean;
  return summary;
}

}  // namespace bodyloom
