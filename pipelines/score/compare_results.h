// SPDX-License-Identifier: Apache-2.0
/// Two sets of pictures compared frame by frame, any number of metrics side by side.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/data_tools/evaluation/speed_reaction.h"
#include "bodyloom/data_tools/evaluation/ssim.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/score/compare_report.h"
#include "bodyloom/pipelines/score/frame_metric.h"

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

}  // namespace bodyloom
