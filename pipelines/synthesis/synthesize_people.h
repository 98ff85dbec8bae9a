// SPDX-License-Identifier: Apache-2.0
/// Synthesises images of many clothed people with known truth
/// (data_tools/synthesis/people/make_multi_person_dataset.h).
#pragma once

#include <string>
#include <vector>

#include "data_tools/synthesis/people/make_multi_person_dataset.h"
#include "geometry/base/callbacks.h"

namespace bodyloom {

struct SynthesizePeopleRequest {
  std::vector<std::string> motions;  ///< folders of motion files, such files, or "demo"
  std::string body;                  ///< empty: the built-in body
  std::string out;                   ///< the folder
  std::string sheet;                 ///< also a contact sheet, .png or .jpg; empty: none
  /// progress and command are set by SynthesizePeople.
  MakeMultiPersonDatasetOptions set;
};

struct SynthesizePeopleReport {
  MakeMultiPersonDatasetSummary set;
  int people = 0;
  int motions_too_short = 0;         ///< for a clip, left out
  std::vector<std::string> outputs;  ///< the folder, and the sheet
};

/// Makes the dataset and its sheet. Throws RequestError when no motion is as long as a clip, std::runtime_error naming
/// a file that cannot be used, Cancelled.
SynthesizePeopleReport SynthesizePeople(const SynthesizePeopleRequest& request,
                                        const PipelineCallbacks& callbacks = {});

/// Counts and times: some lines for a reader.
std::string ToText(const SynthesizePeopleReport& report);

}  // namespace bodyloom
