// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/track_summary.h"

#include <cstdio>
#include <sstream>

#include "geometry/base/percentile.h"

namespace bodyloom {

TermSummary SummarizeTerm(const std::string& term, const std::vector<double>& px, int unmatched) {
  TermSummary summary{term, static_cast<int>(px.size()), unmatched, 0, 0};
  if (px.empty()) return summary;
  const std::vector<double> sorted = SortedFinite(px);
  summary.median_px = SortedPercentile(sorted, 50), summary.p95_px = SortedPercentile(sorted, 95);
  return summary;
}

std::string WorstStretch::BriefReport() const {
  char text[200];
  std::snprintf(text, sizeof text, "%.1f to %.1f s, at %.1f times the mean cost: %s pulls (%.0f %% of it)", begin_s,
                end_s, cost_ratio, term.c_str(), 100 * term_share);
  return text;
}

std::string FlightSummary::BriefReport() const {
  if (flights == 0) return "";
  char text[200];
  std::snprintf(text, sizeof text, "%d %s that the person is %.2f m +- %.2f m tall; %.2f m was assumed", flights,
                flights == 1 ? "jump says" : "jumps say", stature_m, sigma_m, assumed_m);
  return text;
}

std::string TrackSequenceSummary::FramesReport() const {
  std::ostringstream out;
  for (const auto& [name, count] : frames_by_status) {
    if (count > 0) out << (out.tellp() > 0 ? ", " : "") << count << ' ' << name;
    if (name == ToString(FrameStatus::kLost) && lost_in_holes > 0) {
      out << " (" << lost_in_holes << " in holes of more than " << kLongestHole_s << " s)";
    }
  }
  return out.str();
}

std::string TrackSequenceSummary::BriefReport() const {
  std::ostringstream out;
  out << ToString(status) << " after " << iterations << " iterations, cost " << initial_cost << " -> " << final_cost;
  if (!frames_by_status.empty()) out << "\nframes: " << FramesReport();
  if (reprojection_median_px > 0) {
    out << "\n2D joints: median " << reprojection_median_px << " px, 95 % below " << reprojection_p95_px << " px";
  }
  if (dense_median_px > 0) out << "\ndense keypoints: median " << dense_median_px << " px";
  for (const TermSummary& term : terms) {
    if (term.term == "2D joints" || term.term == "dense keypoints") continue;
    out << '\n'
        << term.term << ": median " << term.median_px << " px, 95 % below " << term.p95_px << " px, "
        << term.observations << " matched, " << term.unmatched << " not";
  }
  return out.str();
}

}  // namespace bodyloom
