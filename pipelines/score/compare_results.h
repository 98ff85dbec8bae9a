// SPDX-License-Identifier: Apache-2.0
/// Compares two sets of images frame by frame with any number of metrics.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/evaluation/speed_response.h"
#include "data_tools/evaluation/ssim.h"
#include "geometry/base/callbacks.h"
#include "pipelines/score/frame_metric.h"
#include "render/image/image.h"
#include "render/view/error_colours.h"

namespace bodyloom {

// Tables of metrics, with one row per frame and one column per metric, and the report made of them.

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

struct CompareResultsRequest {
  std::string truth, result;                    ///< folders or videos
  std::string mask;                             ///< folder or video of masks: pixels of 128 or more count; empty: none
  std::string other_truth, other_result;        ///< datasets of the same poses at a different speed; empty: none
  PersonLabel reacting = PersonLabel::kBottom;  ///< label whose response to the speed is measured
  SsimPreset preset = SsimPreset::kWang2004;
  bool common_only = false;       ///< compares the frames that both sides have, instead of requiring all
  std::vector<FrameMetric> more;  ///< further metrics of images, after PSNR and SSIM
  std::string pictures;           ///< folder for an ErrorImage of each pair of images; empty: none
  double error_maximum = 64;      ///< end of the colour scale of ErrorImage, grey levels
  std::string json, csv;          ///< ToJson and ToCsv of the report; empty: not written
  int num_threads = 0;            ///< 0: all cores; results are the same for any number
};

/// Compares images of two folders, of images/, labels/ and normals/ below both, or of two videos; writes the requested
/// files. Throws std::runtime_error naming a file that cannot be used, Cancelled; only error images may be left then.
CompareResultsReport CompareResults(const CompareResultsRequest& request, const PipelineCallbacks& callbacks = {});

// Visualisation of image errors.

/// Per-pixel distance of two images of equal size, grey levels: √(mean over the three channels of (a − b)²), 0 to 255.
/// The mean of its square is the MSE of psnr_db. Throws std::invalid_argument when the sizes differ.
std::vector<float> PixelErrors(const Image& truth, const Image& result);

/// Truth, result and their distance side by side, each captioned and at its own size, with the legend of the colours
/// below the distance.
Image ErrorImage(const Image& truth, const Image& result, const ErrorScale& scale);

/// A metric without columns that writes the ErrorImage of every frame to FOLDER/NAME.png; the colour scale ends at
/// `maximum` grey levels.
FrameMetric ErrorImages(const std::string& folder, double maximum);

}  // namespace bodyloom
