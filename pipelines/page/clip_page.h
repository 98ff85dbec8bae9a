// SPDX-License-Identifier: Apache-2.0
/// Writes a tracked clip as one self-contained HTML file that opens from disk: the video beside an interactive view of
/// the bodies in their world, a timeline of residuals, statuses and uncertainty, plots of joint angles, text, and files
/// to download. Scene, video and script (assets/page/viewer.js) are embedded in the page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// One person on the page's clock of N frames.
struct ClipPagePerson {
  std::string name;                      ///< of the person's node in the glTF: "person_0"
  std::vector<std::string> joint_names;  ///< J
  std::vector<FrameStatus> status;       ///< kLost also where the track has no frame
  std::vector<double> residual_px;       ///< NaN where unknown
  RowMatrixXd joint_sigma_m;             ///< N×J; NaN likewise
  /// Plots of joint angles: names (OpenSim's; those that end in _r and _l share a plot) and N×A degrees, NaN likewise;
  /// none: no plots.
  std::vector<std::string> angle_names;
  RowMatrixXd angles_deg;
  std::vector<PlanEntry> plan;  ///< steps that ran or were skipped, with reasons
  std::vector<TermCost> costs;  ///< cost of each term at the solution
  std::optional<WorstStretch> worst_stretch;
};

/// A file that the page offers for download.
struct ClipPageFile {
  std::string name, mime_type, bytes;
};

/// A further camera, which stands still; its video is in step with the first one's.
struct ClipPageView {
  std::string name;
  Camera camera;
  CameraPose camera_from_world;
  std::string video_mp4;  ///< as the first one's; empty: no video
};

struct ClipPageContent {
  std::string title, subtitle;
  std::vector<double> seconds;  ///< N, from the scene's start, ascending: when each frame is shown
  double fps = 30;
  Camera camera;  ///< width 0: unknown, no frustum is drawn
  WorldFrame world;
  std::vector<CameraPose> world_from_cameras;  ///< N of a camera that moves, or empty
  std::string view_name;                       ///< of this camera, where there are further ones
  std::vector<ClipPageView> views;             ///< further ones
  std::vector<ClipPagePerson> people;
  std::string glb;                  ///< the scene (data_tools/export/glb_writer.h)
  std::string video_mp4;            ///< one image per frame, at a constant `fps`; empty: no video
  std::string summary;              ///< lines
  std::vector<ClipPageFile> files;  ///< downloads other than the glTF
};

/// Renders the page. Throws std::invalid_argument without frames or people, or when lengths differ from N and J.
std::string ClipPageHtml(const ClipPageContent& content);

}  // namespace bodyloom
