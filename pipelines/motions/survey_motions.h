// SPDX-License-Identifier: Apache-2.0
/// Motions collected for training: quality, classes, split and pictures (data_tools/motion/motion_library.h).
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/motion_quality.h"
#include "data_tools/motion/motion_library.h"
#include "data_tools/motion/motion_sheet.h"
#include "geometry/base/callbacks.h"

namespace bodyloom {

struct SurveyMotionsRequest {
  std::vector<std::string> motions;  ///< motion files, or folders of them; at least one
  MotionLibraryOptions options;
  std::string json;            ///< ToJson(SurveyMotionsReport); empty: none
  std::string sheet;           ///< stick figures of every clip, .png; empty: none
  MotionSheetOptions picture;  ///< of the sheet
};

struct SurveyedClip {
  LibraryClip clip;  ///< without its motion
  MotionQuality quality;
};

struct SurveyMotionsReport {
  std::vector<SurveyedClip> clips;
  MotionLibrarySummary library;
};

/// Reads, cleans and measures every motion, and writes what was requested. Throws std::runtime_error naming a file that
/// cannot be used, also when no file holds a motion; Cancelled.
SurveyMotionsReport SurveyMotions(const SurveyMotionsRequest& request, const PipelineCallbacks& callbacks = {});

/// A line a clip, then minutes by class and by source, what was cleaned and what was left out.
std::string ToText(const SurveyMotionsReport& report);
/// The same as one JSON object.
std::string ToJson(const SurveyMotionsReport& report);

}  // namespace bodyloom
