// SPDX-License-Identifier: Apache-2.0
#include "apps/metrics_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "apps/fixed_text.h"
#include "apps/interrupt.h"
#include "apps/progress.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

const PixelMask* MaskOf(const FramePair& frame) { return frame.mask ? &*frame.mask : nullptr; }

/// The labels of a grey picture.
std::vector<uint8_t> LabelsOf(const Image& image, const std::string& where) {
  std::vector<uint8_t> labels(image.bgr.size() / 3);
  for (size_t i = 0; i < labels.size(); ++i) {
    const uint8_t* bgr = &image.bgr[3 * i];
    const size_t x = i % image.width, y = i / image.width;
    if (bgr[0] != bgr[1] || bgr[1] != bgr[2]) {
      throw std::runtime_error(
          Concatenate(where, ": pixel (", x, ", ", y, ") is coloured, expected a grey picture of labels"));
    }
    if (bgr[0] >= kNumPersonLabels) {
      throw std::runtime_error(Concatenate(where, ": pixel (", x, ", ", y, "): label ", int{bgr[0]}, ", expected 0 to ",
                                           kNumPersonLabels - 1));
    }
    labels[i] = bgr[0];
  }
  return labels;
}

/// DIR/kind when it is there; pictures may lie in DIR itself.
std::optional<std::string> FolderOf(const std::string& path, const std::string& kind) {
  const fs::path below = fs::path(path) / kind;
  if (fs::is_directory(below)) return below.string();
  if (kind == "images") return path;
  return std::nullopt;
}

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

nlohmann::ordered_json NumberOrNull(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

const char* NameOf(PersonLabel label) { return kPersonLabelNames[static_cast<size_t>(label)]; }

std::string ToText(const SpeedReaction& reaction) {
  std::string text = std::string("reaction of \"") + NameOf(reaction.label) +
                     "\" to the speed: " + std::to_string(reaction.pairs) + " pairs of equal poses\n";
  char line[200];
  std::snprintf(line, sizeof line, "  IoU between the speeds: truth %.4f, result %.4f\n", reaction.truth_iou,
                reaction.result_iou);
  text += line;
  for (size_t k = 0; k < reaction.extents.size(); ++k) {
    const SpeedReaction::OfExtent& extent = reaction.extents[k];
    std::snprintf(line, sizeof line,
                  "  %-9s changes by ±%.4f, in the result by ±%.4f; correlation %6.3f, slope %6.3f\n",
                  LabelExtent::kNames[k], extent.truth_std, extent.result_std, extent.correlation, extent.slope);
    text += line;
  }
  text += "  by how much the truth differs, a quarter of the pairs each:\n";
  for (const SpeedReaction::Quarter& quarter : reaction.quarters) {
    std::snprintf(line, sizeof line,
                  "  truth's IoU between the speeds %.4f: result's IoU with the truth %.4f, at the other speed %.4f\n",
                  quarter.between_speeds, quarter.iou, quarter.other_iou);
    if (quarter.pairs > 0) text += line;
  }
  return text;
}

nlohmann::ordered_json ToJson(const SpeedReaction& reaction) {
  nlohmann::ordered_json extents = nlohmann::ordered_json::object();
  for (size_t k = 0; k < reaction.extents.size(); ++k) {
    const SpeedReaction::OfExtent& extent = reaction.extents[k];
    extents[LabelExtent::kNames[k]] = {{"truth_std", extent.truth_std},
                                       {"result_std", extent.result_std},
                                       {"correlation", NumberOrNull(extent.correlation)},
                                       {"slope", NumberOrNull(extent.slope)}};
  }
  nlohmann::ordered_json quarters = nlohmann::ordered_json::array();
  for (const SpeedReaction::Quarter& quarter : reaction.quarters) {
    quarters.push_back({{"pairs", quarter.pairs},
                        {"between_speeds", quarter.between_speeds},
                        {"iou", quarter.iou},
                        {"other_iou", quarter.other_iou}});
  }
  return {{"label", NameOf(reaction.label)},   {"pairs", reaction.pairs}, {"truth_iou", reaction.truth_iou},
          {"result_iou", reaction.result_iou}, {"extents", extents},      {"quarters", quarters}};
}

}  // namespace

FrameMetric ImageMetric(SsimPreset preset, bool has_mask) {
  FrameMetric metric;
  metric.columns = {{"psnr_db", "10 log10(255^2 / MSE) of the whole picture"}};
  if (has_mask) metric.columns.push_back({"psnr_mask_db", "the same of the pixels in the mask"});
  const bool boxed = has_mask && preset == SsimPreset::kNeuralBody;
  metric.columns.push_back({"ssim_" + ToText(preset), boxed ? "SSIM of the mask's box" : "SSIM of the whole picture"});
  metric.compute = [preset, has_mask](const FramePair& frame, const FramePair*) {
    std::vector<double> values = {Psnr(frame.truth, frame.result)};
    if (has_mask) values.push_back(Psnr(frame.truth, frame.result, MaskOf(frame)));
    values.push_back(Ssim(frame.truth, frame.result, preset, MaskOf(frame)));
    return values;
  };
  return metric;
}

FrameMetric LabelMetric() {
  FrameMetric metric;
  metric.columns = {{"label_miou", "mean IoU of the labels that either side has"},
                    {"label_accuracy", "share of pixels with the right label"},
                    {"mask_iou", "IoU of everything but the background"}};
  for (const char* name : kPersonLabelNames)
    metric.columns.push_back({std::string("iou_") + name, "IoU of this label"});
  metric.compute = [](const FramePair& frame, const FramePair*) {
    const std::vector<uint8_t> truth = LabelsOf(frame.truth, "the truth of " + frame.where);
    const std::vector<uint8_t> result = LabelsOf(frame.result, frame.where);
    const LabelOverlap overlap = CompareLabels(truth, result, kNumPersonLabels);
    const int width = frame.truth.width, height = frame.truth.height;
    std::vector<double> values = {overlap.mean_iou, overlap.accuracy,
                                  MaskIoU({width, height, truth}, {width, height, result})};
    values.insert(values.end(), overlap.iou.begin(), overlap.iou.end());
    return values;
  };
  return metric;
}

FrameMetric NormalMetric() {
  FrameMetric metric;
  metric.columns = {{"normal_mean_deg", "mean angle where both sides have a normal"},
                    {"normal_median_deg", "median angle there"},
                    {"normal_coverage", "share of the truth's normals where the result has one"}};
  metric.compute = [](const FramePair& frame, const FramePair*) {
    const NormalError error = CompareNormals(frame.truth, frame.result, MaskOf(frame));
    return std::vector<double>{error.mean_deg, error.median_deg, error.coverage};
  };
  return metric;
}

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
      table.rows[begin + i] = RowOf(batch[i], before, metrics);
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

MetricsReport RunMetrics(const MetricsCommand& command) {
  const auto start = std::chrono::steady_clock::now();
  RequireReadable(command.truth, "truth");
  RequireReadable(command.result, "result");
  RequireReadable(command.mask, "mask");
  RequireReadable(command.other_truth, "truth at another speed");
  RequireReadable(command.other_result, "result at another speed");
  RequireDistinct({command.truth, command.result, command.mask, command.other_truth, command.other_result},
                  {command.json, command.csv});
  RequireWritable(command.json);
  RequireWritable(command.csv);
  const int num_threads = command.num_threads > 0 ? command.num_threads
                                                  : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  MetricsReport report;
  report.truth = command.truth;
  report.result = command.result;
  report.mask = command.mask;
  report.preset = ToText(command.preset);

  std::vector<FrameMetric> of_images = {ImageMetric(command.preset, !command.mask.empty())};
  of_images.insert(of_images.end(), command.more.begin(), command.more.end());
  const std::vector<std::pair<std::string, std::vector<FrameMetric>>> kinds = {
      {"images", of_images}, {"labels", {LabelMetric()}}, {"normals", {NormalMetric()}}};
  Progress progress("metrics", command.quiet ? Progress::Style::kSilent : Progress::DefaultStyle());
  if (!command.other_truth.empty()) {  // first: sets that do not fit are said before an hour of comparing
    progress.Update("reaction", 0);
    report.reaction =
        MeasureSpeedReaction(PersonSet(command.truth), PersonSet(command.result), PersonSet(command.other_truth),
                             PersonSet(command.other_result), command.reacting, num_threads);
  }
  for (const auto& [kind, metrics] : kinds) {
    const auto truth = FolderOf(command.truth, kind), result = FolderOf(command.result, kind);
    if (truth.has_value() != result.has_value()) report.only_one_side.push_back(kind);
    if (!truth || !result) continue;
    const std::string mask = kind == "labels" ? "" : command.mask;  // labels are compared everywhere
    const auto frames = FramePairs::Open(*truth, *result, mask, command.common_only);
    report.tables.push_back(CompareFrames(kind, frames.get(), metrics, num_threads, [&](double fraction) {
      ThrowIfInterrupted();
      progress.Update(kind, fraction);
    }));
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!command.json.empty()) WriteFileAtomically(command.json, ToJson(report));
  if (!command.csv.empty()) WriteFileAtomically(command.csv, ToCsv(report));
  return report;
}

std::string ToText(const MetricsReport& report) {
  std::string text;
  size_t width = 0;
  for (const MetricTable& table : report.tables) {
    for (const MetricColumn& column : table.columns) width = std::max(width, column.name.size());
  }
  for (const MetricTable& table : report.tables) {
    text += table.kind + ": " + std::to_string(table.rows.size()) + " frames";
    if (table.left_out > 0) text += ", " + std::to_string(table.left_out) + " that one side lacks left out";
    text += "\n";
    for (size_t c = 0; c < table.columns.size(); ++c) {
      const MetricColumn& column = table.columns[c];
      const ColumnSummary summary = Summarise(table, c);
      char line[160];
      if (summary.finite > 0) {
        std::snprintf(line, sizeof line, "  %-*s %10.4f ± %-9.4f", static_cast<int>(width), column.name.c_str(),
                      summary.mean, summary.std);
      } else {
        std::snprintf(line, sizeof line, "  %-*s %10s   %-9s", static_cast<int>(width), column.name.c_str(), "-", "");
      }
      text += line + column.meaning;
      if (summary.infinite > 0) text += "; " + std::to_string(summary.infinite) + " frames equal, left out";
      if (summary.undefined > 0) text += "; nothing to measure in " + std::to_string(summary.undefined) + " frames";
      text += "\n";
    }
  }
  for (const std::string& kind : report.only_one_side) text += kind + ": only one side has them, not compared\n";
  if (report.reaction) text += ToText(*report.reaction);
  return text + Fixed(report.seconds, 1) + " s\n";
}

std::string ToJson(const MetricsReport& report) {
  using nlohmann::ordered_json;
  ordered_json kinds = ordered_json::object();
  for (const MetricTable& table : report.tables) {
    ordered_json columns = ordered_json::object();
    for (size_t c = 0; c < table.columns.size(); ++c) {
      const ColumnSummary summary = Summarise(table, c);
      columns[table.columns[c].name] = {{"mean", NumberOrNull(summary.mean)}, {"std", NumberOrNull(summary.std)},
                                        {"frames", summary.finite},           {"infinite", summary.infinite},
                                        {"undefined", summary.undefined},     {"meaning", table.columns[c].meaning}};
    }
    kinds[table.kind] = {{"frames", table.rows.size()}, {"left_out", table.left_out}, {"metrics", columns}};
  }
  ordered_json json = {{"truth", report.truth},    {"result", report.result},
                       {"mask", report.mask},      {"ssim_preset", report.preset},
                       {"kinds", kinds},           {"only_one_side", report.only_one_side},
                       {"seconds", report.seconds}};
  if (report.reaction) json["reaction"] = ToJson(*report.reaction);
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string ToCsv(const MetricsReport& report) {
  std::vector<std::string> frames;  // in the order of first appearance
  std::vector<std::map<std::string, const MetricRow*>> row_of(report.tables.size());
  std::string text = "frame";
  for (size_t k = 0; k < report.tables.size(); ++k) {
    for (const MetricColumn& column : report.tables[k].columns) text += "," + column.name;
    for (const MetricRow& row : report.tables[k].rows) {
      row_of[k][row.frame] = &row;
      const bool seen = std::any_of(row_of.begin(), row_of.begin() + static_cast<std::ptrdiff_t>(k),
                                    [&](const auto& rows) { return rows.count(row.frame) > 0; });
      if (!seen) frames.push_back(row.frame);
    }
  }
  text += "\n";
  for (const std::string& frame : frames) {
    // Names of files may hold anything; a quoted field holds anything but bare quotes.
    text += "\"";
    for (const char c : frame) text += c == '"' ? "\"\"" : std::string(1, c);
    text += "\"";
    for (size_t k = 0; k < report.tables.size(); ++k) {
      const auto row = row_of[k].find(frame);
      for (size_t c = 0; c < report.tables[k].columns.size(); ++c) {
        char number[32] = "";
        if (row != row_of[k].end()) std::snprintf(number, sizeof number, "%.9g", row->second->values[c]);
        text += std::string(",") + number;
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace bodyloom
