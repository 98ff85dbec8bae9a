// SPDX-License-Identifier: Apache-2.0
/// Two sets of pictures compared frame by frame, any number of metrics side by side.
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/speed_reaction.h"
#include "data_tools/evaluation/ssim.h"
#include "geometry/base/callbacks.h"
#include "pipelines/score/frame_metric.h"
#include "pipelines/score/metric_table.h"
#include "render/image/image.h"
#include "render/view/error_colours.h"

namespace bodyloom {

struct CompareResultsRequest {
  std::string truth, result;                    ///< folders or videos
  std::string mask;                             ///< folder or video of masks: pixels of 128 or more count; empty: none
  std::string other_truth, other_result;        ///< datasets of the same poses at another speed; empty: none
  PersonLabel reacting = PersonLabel::kBottom;  ///< whose reaction to the speed is measured
  SsimPreset preset = SsimPreset::kWang2004;
  bool common_only = false;       ///< compares the frames that both sides have, instead of requiring all
  std::vector<FrameMetric> more;  ///< further metrics of images, after PSNR and SSIM
  std::string pictures;           ///< folder for an ErrorPicture of every pair of images; empty: none
  double error_maximum = 64;      ///< of those: the last colour, grey levels
  std::string json, csv;          ///< ToJson and ToCsv of the report; empty: not written
  int num_threads = 0;            ///< 0: all cores; numbers are the same for any number
};

/// Pictures in both folders, or in images/, labels/ and normals/ below both, or two videos; writes the files requested.
/// Throws std::runtime_error naming a file that cannot be used, Cancelled; nothing but pictures is left behind then.
CompareResultsReport CompareResults(const CompareResultsRequest& request, const PipelineCallbacks& callbacks = {});

// Pictures of where a picture differs from the truth.

/// Distance of two pictures of one size, pixel by pixel, in grey levels: √(mean over the three channels of (a − b)²), 0
/// to 255. The mean of its square is the MSE of psnr_db. Throws std::invalid_argument when the sizes differ.
std::vector<float> PixelErrors(const Image& truth, const Image& result);

/// Truth, result and their distance side by side, each at its own size under its name, and the legend of the colours
/// below the distance.
Image ErrorPicture(const Image& truth, const Image& result, const ErrorScale& scale);

/// A metric without columns that writes the ErrorPicture of every frame to FOLDER/NAME.png, the last colour at
/// `maximum` grey levels.
FrameMetric ErrorPictures(const std::string& folder, double maximum);

}  // namespace bodyloom
