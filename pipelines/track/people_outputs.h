// SPDX-License-Identifier: Apache-2.0
/// Outputs of a run on everybody in a video, or in several.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/stopwatch.h"
#include "geometry/body/body_model.h"
#include "pipelines/page/write_clip_page.h"
#include "pipelines/track/track_people_report.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// person_I.npz in the folder.
std::string TrackFileIn(const std::string& folder, int number);

/// Writes the usable tracks, in the order of report->people, whose `track` become these files.
void WriteTracks(const std::string& folder, const std::vector<TrackSequenceResult>& people, TrackPeopleReport* report);

/// The people whose tracks were written, with the body of each. Points into report and people.
std::vector<PersonOnPage> PeopleOnPage(const TrackPeopleReport& report, const std::vector<const BodyModel*>& bodies,
                                       const std::vector<TrackSequenceResult>& people);

/// Ends the clock and puts its stages and the memory into the report.
void EndReport(StageClock* clock, TrackPeopleReport* report);
/// The same, and writes the report as summary.json in the folder.
void WriteSummary(const std::string& folder, StageClock* clock, TrackPeopleReport* report);

}  // namespace bodyloom
