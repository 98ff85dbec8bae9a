// SPDX-License-Identifier: Apache-2.0
#include "pipelines/score/compare_results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "geometry/uv_maps/velocity_stencil.h"
#include "pipelines/files.h"
#include "pipelines/report_text.h"
#include "render/image/palette.h"
#include "render/view/caption.h"

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

namespace fs = std::filesystem;

/// DIR/kind if it exists; images may also be in DIR itself.
std::optional<std::string> FolderOf(const std::string& path, const std::string& kind) {
  const fs::path below = fs::path(path) / kind;
  if (fs::is_directory(below)) return below.string();
  if (kind == "images") return path;
  return std::nullopt;
}

/// Gap-free run of each frame, by the clock of the single-person dataset that is compared or contains the images; empty
/// without one.
std::vector<int> RunsOf(const std::string& truth) {
  const fs::path path = fs::path(truth).lexically_normal();
  for (const fs::path& place : {path, path.filename() == "images" ? path.parent_path() : path}) {
    if (!IsSinglePersonDataset(place.string())) continue;
    const Track track = SinglePersonDataset(place.string()).track();
    const std::vector<char> usable(track.num_frames(), 1);
    std::vector<int> runs;
    for (const VelocityStencil& frame : VelocityStencils(track.motion.timestamps, usable)) {
      runs.push_back(frame.segment);
    }
    return runs;
  }
  return {};
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

namespace {

nlohmann::ordered_json NumberOrNull(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

const char* NameOf(PersonLabel label) { return kPersonLabelNames[static_cast<size_t>(label)]; }

std::string ToText(const SpeedResponse& reaction) {
  std::string text = std::string("reaction of \"") + NameOf(reaction.label) +
                     "\" to the speed: " + std::to_string(reaction.pairs) + " pairs of equal poses\n";
  char line[200];
  std::snprintf(line, sizeof line, "  IoU between the speeds: truth %.4f, result %.4f\n", reaction.truth_iou,
                reaction.result_iou);
  text += line;
  for (size_t k = 0; k < reaction.extents.size(); ++k) {
    const SpeedResponse::OfExtent& extent = reaction.extents[k];
    std::snprintf(line, sizeof line,
                  "  %-9s changes by ±%.4f, in the result by ±%.4f; correlation %6.3f, slope %6.3f\n",
                  LabelExtent::kNames[k], extent.truth_std, extent.result_std, extent.correlation, extent.slope);
    text += line;
  }
  text += "  by how much the truth differs, a quarter of the pairs each:\n";
  for (const SpeedResponse::Quarter& quarter : reaction.quarters) {
    std::snprintf(line, sizeof line,
                  "  truth's IoU between the speeds %.4f: result's IoU with the truth %.4f, at the other speed %.4f\n",
                  quarter.between_speeds, quarter.iou, quarter.other_iou);
    if (quarter.pairs > 0) text += line;
  }
  return text;
}

nlohmann::ordered_json ReactionJson(const SpeedResponse& reaction) {
  nlohmann::ordered_json extents = nlohmann::ordered_json::object();
  for (size_t k = 0; k < reaction.extents.size(); ++k) {
    const SpeedResponse::OfExtent& extent = reaction.extents[k];
    extents[LabelExtent::kNames[k]] = {{"truth_std", extent.truth_std},
                                       {"result_std", extent.result_std},
                                       {"correlation", NumberOrNull(extent.correlation)},
                                       {"slope", NumberOrNull(extent.slope)}};
  }
  nlohmann::ordered_json quarters = nlohmann::ordered_json::array();
  for (const SpeedResponse::Quarter& quarter : reaction.quarters) {
    quarters.push_back({{"pairs", quarter.pairs},
                        {"between_speeds", quarter.between_speeds},
                        {"iou", quarter.iou},
                        {"other_iou", quarter.other_iou}});
  }
  return {{"label", NameOf(reaction.label)},   {"pairs", reaction.pairs}, {"truth_iou", reaction.truth_iou},
          {"result_iou", reaction.result_iou}, {"extents", extents},      {"quarters", quarters}};
}

}  // namespace

std::string ToText(const CompareResultsReport& report) {
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

std::string ToJson(const CompareResultsReport& report) {
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
  if (report.reaction) json["reaction"] = ReactionJson(*report.reaction);
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string ToCsv(const CompareResultsReport& report) {
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

CompareResultsReport CompareResults(const CompareResultsRequest& request, const PipelineCallbacks& callbacks) {
  const Stopwatch watch;
  RequireReadable(request.truth, "truth");
  RequireReadable(request.result, "result");
  RequireReadable(request.mask, "mask");
  RequireReadable(request.other_truth, "truth at another speed");
  RequireReadable(request.other_result, "result at another speed");
  RequireDistinct({request.truth, request.result, request.mask, request.other_truth, request.other_result},
                  {request.json, request.csv, request.pictures});
  RequireWritable(request.json);
  RequireWritable(request.csv);
  if (!request.pictures.empty()) RequireWritableFolder(request.pictures);
  const int num_threads = ThreadsFor(request.num_threads);
  CompareResultsReport report;
  report.truth = request.truth;
  report.result = request.result;
  report.mask = request.mask;
  report.preset = ToText(request.preset);

  std::vector<FrameMetric> of_images = {ImageMetric(request.preset, !request.mask.empty())};
  of_images.insert(of_images.end(), request.more.begin(), request.more.end());
  if (!request.pictures.empty()) of_images.push_back(ErrorImages(request.pictures, request.error_maximum));
  const std::vector<std::pair<std::string, std::vector<FrameMetric>>> kinds = {
      {"images", of_images}, {"labels", {LabelMetric()}}, {"normals", {NormalMetric()}}};
  callbacks.Begin("metrics");
  if (!request.other_truth.empty()) {  // first: datasets that do not fit are refused before an hour of comparing
    callbacks.Update("reaction", 0);
    report.reaction = MeasureSpeedResponse(SinglePersonDataset(request.truth), SinglePersonDataset(request.result),
                                           SinglePersonDataset(request.other_truth),
                                           SinglePersonDataset(request.other_result), request.reacting, num_threads);
  }
  const std::vector<int> runs = RunsOf(request.truth);
  for (const auto& [kind, metrics] : kinds) {
    const auto truth = FolderOf(request.truth, kind), result = FolderOf(request.result, kind);
    if (truth.has_value() != result.has_value()) report.only_one_side.push_back(kind);
    if (!truth || !result) continue;
    const std::string mask = kind == "labels" ? "" : request.mask;  // labels are compared everywhere
    const auto frames = FramePairs::Open(*truth, *result, mask, request.common_only, runs);
    report.tables.push_back(CompareFrames(kind, frames.get(), metrics, num_threads,
                                          [&, stage = kind](double fraction) { callbacks.Update(stage, fraction); }));
  }
  report.seconds = watch.seconds();
  if (!request.json.empty()) WriteFileAtomically(request.json, ToJson(report));
  if (!request.csv.empty()) WriteFileAtomically(request.csv, ToCsv(report));
  return report;
}

std::vector<float> PixelErrors(const Image& truth, const Image& result) {
  BODYLOOM_CHECK(truth.width == result.width && truth.height == result.height, "PixelErrors: ", result.width, "x",
                 result.height, " pixels, the truth has ", truth.width, "x", truth.height);
  std::vector<float> errors(truth.bgr.size() / 3);
  for (size_t i = 0; i < errors.size(); ++i) {
    int squares = 0;
    for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const int difference = int{truth.bgr[c]} - int{result.bgr[c]};
      squares += difference * difference;
    }
    errors[i] = std::sqrt(static_cast<float>(squares) / 3);
  }
  return errors;
}

Image ErrorImage(const Image& truth, const Image& result, const ErrorScale& scale) {
  const std::vector<float> errors = PixelErrors(truth, result);
  Image error(truth.width, truth.height);
  for (int y = 0; y < error.height; ++y) {
    for (int x = 0; x < error.width; ++x) {
      const Colour c = ErrorColour(errors[static_cast<size_t>(y) * error.width + x] / scale.maximum);
      uint8_t* p = error.pixel(x, y);
      p[0] = c.blue, p[1] = c.green, p[2] = c.red;
    }
  }
  constexpr int kGap = 6;
  // Cells of small images are wide enough for the captions.
  const int cell = std::max(truth.width, 150), step = cell + kGap;
  const double cap = std::clamp(cell / 36.0, 7.0, 16.0);
  const int words = static_cast<int>(std::lround(2.4 * cap)), below = ErrorLegendHeight(cap) + kGap;
  Image image(3 * cell + 4 * kGap, words + truth.height + kGap + below, kInkColour);
  const Image* const images[] = {&truth, &result, &error};
  const char* const names[] = {"truth", "result", "error"};
  for (int i = 0; i < 3; ++i) {
    const int x = kGap + i * step;
    DrawWords(names[i], x, static_cast<int>(std::lround(1.7 * cap)), cap, kPaperColour, &image);
    Paste(*images[i], x, words, &image);
  }
  DrawErrorLegend(scale, kGap + 2 * step, words + truth.height + kGap, cell, cap, &image);
  return image;
}

FrameMetric ErrorImages(const std::string& folder, double maximum) {
  FrameMetric metric;
  metric.compute = [folder, maximum](const FramePair& frame, const FramePair*) -> std::vector<double> {
    const ErrorScale scale{maximum, "grey levels", "error of a pixel"};
    WriteImage((std::filesystem::path(folder) / (frame.name + ".png")).string(),
               ErrorImage(frame.truth, frame.result, scale));
    return {};
  };
  return metric;
}

}  // namespace bodyloom
