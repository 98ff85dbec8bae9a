// SPDX-License-Identifier: Apache-2.0
/// Synthesises images of one clothed person with known truth: motions in, a single-person dataset out
/// (data_tools/synthesis/people/make_single_person_dataset.h).
#pragma once

#include <string>
#include <vector>

#include "data_tools/synthesis/people/make_single_person_dataset.h"
#include "geometry/base/callbacks.h"
#include "pipelines/synthesis/motion_source.h"

namespace bodyloom {

struct SynthesizePersonRequest {
  std::vector<std::string> motions;            ///< names of MotionSource; several follow each other with a gap
  std::vector<double> speeds = {1};            ///< speeds; each motion is played at each of them
  MotionSource motion{.name = "", .fps = 30};  ///< rate and frames of each motion; `motions` name them
  std::string body;                            ///< empty: the built-in body
  std::string out;                             ///< the folder
  std::string sheet;                           ///< also a contact sheet, .png or .jpg; empty: none
  std::string light;                           ///< also the light, JSON as pipelines/animate/relight_frames.h reads it
  /// progress, look, motion and command are set by SynthesizePerson.
  MakeSinglePersonDatasetOptions set;
};

struct SynthesizePersonReport {
  MakeSinglePersonDatasetSummary set;
  int size_px = 0;                   ///< of the images
  std::vector<std::string> outputs;  ///< the folder, the sheet, the light
};

/// Makes the dataset and its sheet. Throws RequestError for speeds without a rate, std::runtime_error naming a file
/// that cannot be used, Cancelled.
SynthesizePersonReport SynthesizePerson(const SynthesizePersonRequest& request,
                                        const PipelineCallbacks& callbacks = {});

/// Counts and times: some lines for a reader.
std::string ToText(const SynthesizePersonReport& report);

}  // namespace bodyloom
