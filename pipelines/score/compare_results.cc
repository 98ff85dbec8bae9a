// SPDX-License-Identifier: Apache-2.0
#include "pipelines/score/compare_results.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "geometry/uv_maps/velocity_stencil.h"
#include "pipelines/files.h"
#include "render/image/palette.h"
#include "render/view/caption.h"

namespace bodyloom {
namespace {

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
