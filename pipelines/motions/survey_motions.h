// SPDX-License-Identifier: Apache-2.0
/// Surveys motions for training: quality, classes, split and a contact sheet (data_tools/motion/motion_library.h).
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

/// Reads, cleans and measures every motion, and writes the requested files. Throws std::runtime_error naming a file
/// that cannot be used, or when no file holds a motion; Cancelled.
SurveyMotionsReport SurveyMotions(const SurveyMotionsRequest& request, const PipelineCallbacks& callbacks = {});

/// One line per clip, then minutes by class and by source, the repairs and the clips left out.
std::string ToText(const SurveyMotionsReport& report);
/// The same as one JSON object.
std::string ToJson(const SurveyMotionsReport& report);

}  // namespace bodyloom
