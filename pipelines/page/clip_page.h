// SPDX-License-Identifier: Apache-2.0
/// A tracked clip as one HTML file that opens from disk: the video beside the bodies in their world, turned and
/// scrubbed by hand, a timeline of residuals, statuses and uncertainty, text, and files to take away. Nothing is
/// fetched from elsewhere: scene, video and the script that shows them (assets/page/viewer.js) are in the page.
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
  std::vector<FrameStatus> status;       ///< N; kLost also where the person's track has no frame
  std::vector<double> residual_px;       ///< N; NaN where nothing is known
  RowMatrixXd joint_sigma_m;             ///< N×J; NaN likewise
  std::vector<PlanEntry> plan;           ///< what ran and why
  std::vector<TermCost> costs;           ///< of each term at the answer
  std::optional<WorstStretch> worst_stretch;
};

/// A file that the page gives away.
struct ClipPageFile {
  std::string name, mime_type, bytes;
};

struct ClipPageContent {
  std::string title, subtitle;
  std::vector<double> seconds;  ///< N, from the scene's start, ascending: when each frame is shown
  double fps = 30;
  Camera camera;  ///< a width of 0: not known, no frustum is drawn
  WorldFrame world;
  std::vector<CameraPose> world_from_cameras;  ///< N of a camera that moves, or empty
  std::vector<ClipPagePerson> people;
  std::string glb;                  ///< the scene (data_tools/export/glb_writer.h)
  std::string video_mp4;            ///< a picture for each of the N frames, evenly `fps` a second; empty: no video
  std::string summary;              ///< lines
  std::vector<ClipPageFile> files;  ///< beside the glTF
};

/// Throws std::invalid_argument when there is no frame or nobody, or lengths differ from N and J.
std::string ClipPageHtml(const ClipPageContent& content);

}  // namespace bodyloom
