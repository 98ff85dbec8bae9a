// SPDX-License-Identifier: Apache-2.0
/// The one-page summary that RunDemo writes.
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/scene/track.h"
#include "pipelines/track/track_report.h"
#include "render/image/image.h"

namespace bodyloom {

struct DemoPageContent {
  TrackReport report;
  Evaluation evaluation;              ///< against the known truth
  std::vector<double> times_s;        ///< T
  std::vector<double> error_mm;       ///< T: mean joint error, pelvis aligned; NaN where a frame is lost
  std::string image_jpeg;             ///< stills of the overlay, encoded
  std::string overlay;                ///< file name of the overlay video, beside the page
  std::vector<std::string> commands;  ///< the same steps as command lines
};

/// Renders the page as HTML.
std::string DemoPage(const DemoPageContent& content);

/// A few frames of a video in one picture. Throws std::runtime_error when it cannot be read.
Image VideoStills(const std::string& path);

/// Mean distance of the joints of two tracks with aligned pelvis, millimetres; one per frame. Throws
/// std::invalid_argument when the tracks differ in frames or joints.
std::vector<double> JointErrorByFrameMm(const Track& track, const Track& truth);

}  // namespace bodyloom
