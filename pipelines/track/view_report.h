// SPDX-License-Identifier: Apache-2.0
/// Report of one camera of several: as text for a reader, and as JSON for a program.
#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/scene/rig.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// One camera of a track from several (TrackViewsClip(), TrackPeopleInVideos()).
struct ViewReport {
  RigCamera camera;        ///< as given or estimated, relative to the first; name
  std::string video;       ///< of people who were detected in it
  std::string detections;  ///< file
  std::string left_out;    ///< the reason if the view was not used, in which case only the name is set of `camera`
  std::string doubt;       ///< the reason to doubt that a view that was used shows the first one's motion; empty: none
  int frames = 0;          ///< of the first view's clip that it shows, too
  double repeat_s = std::numeric_limits<double>::quiet_NaN();  ///< as of ViewSummary
  double fps = 0;                                              ///< median
  double reprojection_median_px = 0;
};

/// The first view as the fit of all has it; `middle_s`: of its clip.
ViewReport ReportOnFirstView(const TrackSequenceSummary& joint, const Camera& camera, double middle_s);
/// A further view as the fit found it. `clock`: where it was known; else it has no clock.
ViewReport ReportOnView(const ViewSummary& found, const RigCamera& clock, double middle_s);
/// The reason to doubt that the view shows the first one's motion; empty if there is none.
std::string DoubtAbout(const ViewReport& view, const ViewReport& first);

/// Warns of views that may show something else, `whom` as "another person", and of clocks that may be others.
void WarnAboutViews(const std::vector<ViewReport>& views, const std::string& whom, const PipelineCallbacks& callbacks);

/// Cameras and clocks of the views that were used.
std::vector<RigCamera> RigOf(const std::vector<ViewReport>& views);

/// One line for each view.
std::string ToText(const std::vector<ViewReport>& views);
/// An object:
///   name, detections, used, fps, video (of people who were detected in it)
///   left_out   the reason, if the view was not used; the keys below are then missing
///   doubt      the reason to doubt that the view shows the first one's motion, if there is one
///   repeat_s   how much later its clock may be, where the motion repeats itself
///   frames (in common with the first), rotation_deg, distance_m (from the first), focal_px, offset_s, offset_frames,
///   rate (clock), reprojection_median_px
///   rotation_sigma_deg, translation_sigma_m, focal_log_sigma, offset_sigma_s, rate_sigma   0: given, null: not known
nlohmann::ordered_json ToJson(const ViewReport& view);

}  // namespace bodyloom
