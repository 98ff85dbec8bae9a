// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/people_outputs.h"

#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "geometry/base/check.h"
#include "pipelines/files.h"

namespace bodyloom {

std::string TrackFileIn(const std::string& folder, int number) {
  return (std::filesystem::path(folder) / Concatenate("person_", number, ".npz")).string();
}

void WriteTracks(const std::string& folder, const std::vector<TrackSequenceResult>& people, TrackPeopleReport* report) {
  for (size_t i = 0; i < report->people.size(); ++i) {
    TrackedPerson& person = report->people[i];
    if (!person.solve.IsUsable()) continue;
    person.track = TrackFileIn(folder, person.number);
    WriteTrack(person.track, people[i].track);
    report->outputs.push_back(person.track);
  }
}

std::vector<PersonOnPage> PeopleOnPage(const TrackPeopleReport& report, const std::vector<const BodyModel*>& bodies,
                                       const std::vector<TrackSequenceResult>& people) {
  std::vector<PersonOnPage> on_page;
  for (size_t i = 0; i < report.people.size(); ++i) {
    const TrackedPerson& person = report.people[i];
    if (person.track.empty()) continue;
    on_page.push_back({.number = person.number,
                       .body = bodies[i],
                       .track = &people[i].track,
                       .summary = &person.solve,
                       .track_file = person.track});
  }
  return on_page;
}

void EndReport(StageClock* clock, TrackPeopleReport* report) {
  clock->End();
  report->seconds = clock->seconds();
  report->processor_seconds = clock->processor_seconds();
  report->total_seconds = clock->total();
  report->peak_memory_bytes = PeakMemoryBytes();
}

void WriteSummary(const std::string& folder, StageClock* clock, TrackPeopleReport* report) {
  EndReport(clock, report);
  report->outputs.push_back((std::filesystem::path(folder) / "summary.json").string());
  WriteFileAtomically(report->outputs.back(), ToJson(*report));
}

}  // namespace bodyloom
