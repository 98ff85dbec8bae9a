// SPDX-License-Identifier: Apache-2.0
#include "pipelines/demo/run_demo.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/truth_evaluation.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "geometry/scene/track.h"
#include "pipelines/files.h"
#include "pipelines/page/report_page.h"
#include "pipelines/report_text.h"
#include "pipelines/synthesis/synthesize_clip.h"
#include "pipelines/track/track_clip.h"
#include "render/image/image.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

// The one-page summary that RunDemo writes.

struct DemoPageContent {
  TrackReport report;
  Evaluation evaluation;              ///< against the known truth
  std::vector<double> times_s;        ///< T
  std::vector<double> error_mm;       ///< T: mean joint error, pelvis aligned; NaN where a frame is lost
  std::string image_jpeg;             ///< stills of the overlay, encoded
  std::string overlay;                ///< file name of the overlay video, beside the page
  std::vector<std::string> commands;  ///< the same steps as command lines
};

constexpr int kStills = 8, kStillHeightPx = 300;

/// A few frames of a video in one picture. Throws std::runtime_error when it cannot be read.
Image VideoStills(const std::string& path) {
  VideoReader reader(path);
  const std::vector<int> frames = EvenlySpreadFrames(std::max(1, reader.info().num_frames), kStills);
  std::vector<Image> stills;
  for (const int frame : frames) {
    reader.Skip(frame - reader.next_frame());
    Image image;
    if (reader.Read(&image)) {
      stills.push_back(std::move(image));
    }
  }
  ContactSheetOptions options;
  options.columns = 2;
  options.cell_height_px = kStillHeightPx;
  return ContactSheet(stills, options);
}

/// Mean distance of the joints of two tracks with aligned pelvis, millimetres; one per frame. Throws
/// std::invalid_argument when the tracks differ in frames or joints.
std::vector<double> JointErrorByFrameMm(const Track& track, const Track& truth) {
  BODYLOOM_CHECK(track.joints.size() == truth.joints.size(), "the track has joints of ", track.joints.size(),
                 " frames, the truth of ", truth.joints.size());
  std::vector<double> errors;
  for (size_t t = 0; t < track.joints.size(); ++t) {
    const MatrixX3d &a = track.joints[t], &b = truth.joints[t];
    BODYLOOM_CHECK(a.rows() == b.rows() && a.rows() > 0, "frame ", t, ": ", a.rows(), " joints against ", b.rows());
    const MatrixX3d difference = (a.rowwise() - a.row(0)) - (b.rowwise() - b.row(0));
    errors.push_back(1e3 * difference.rowwise().norm().mean());
  }
  return errors;
}

/// Renders the page as HTML.
std::string DemoPage(const DemoPageContent& content) {
  const TrackReport& report = content.report;
  const TrackSequenceSummary& solve = report.solve;
  const Evaluation& evaluation = content.evaluation;
  ReportPage page("A person tracked, and how well",
                  "bodyloom demo: " + std::to_string(report.num_frames) +
                      " frames made on the spot with the built-in body, so that the truth is known");
  page.AddParagraph(
      "The clip holds what detectors would have seen: 2D joints with a detector's noise, gaps and left-right swaps, "
      "and "
      "dense surface keypoints with UV noise, 8-bit quantisation, outliers and missing parts. The tracker saw nothing "
      "else but the camera's intrinsics: no initial pose, no shape.");
  page.AddFigures(
      {{Fixed(evaluation.Value("projection_mean_px"), 2) + " px", "projection error of a vertex, image of 512 px"},
       {Fixed(evaluation.Value("mpjpe_mm"), 1) + " mm", "joint error, pelvis aligned"},
       {Fixed(evaluation.Value("pa_mpjpe_mm"), 1) + " mm", "joint error after one similarity a frame"},
       {Fixed(report.total_seconds, 1) + " s", "for everything, overlay video included"}});
  page.AddHeading("What it looks like");
  page.AddImage(
      content.image_jpeg, "image/jpeg",
      "Left: the estimated body over the clip. Right: from its side, where errors in depth show, the estimate "
      "beside the truth.");
  page.AddVideo(content.overlay, "The whole clip: " + content.overlay);
  page.AddHeading("Where the error lies");
  page.AddCurve(content.times_s, content.error_mm, "time in seconds", "Joint error in mm, pelvis aligned,");
  std::vector<std::vector<std::string>> rows = {{"what", "value", "meaning"}};
  for (const EvaluationValue& value : evaluation.values) {
    rows.push_back({value.name, Fixed(value.value, 2), value.meaning});
  }
  page.AddTable(rows);
  page.AddHeading("What ran");
  rows = {{"stage", "seconds"}};
  for (const auto& [stage, seconds] : StagesOf(report)) {
    rows.push_back({stage, Fixed(seconds, 2)});
  }
  page.AddTable(rows);
  rows = {{"step", "done", "why"}};
  for (const PlanEntry& entry : solve.plan) {
    rows.push_back({entry.what, entry.runs ? "yes" : "skipped", entry.why});
  }
  page.AddTable(rows);
  page.AddHeading("The same by hand");
  page.AddCode(content.commands);
  return page.ToHtml();
}

SynthesizeClipRequest SynthesisStep(const DemoRequest& demo) {
  SynthesizeClipRequest synthesis;
  synthesis.motion.name = "demo";
  synthesis.motion.num_frames = demo.num_frames;
  synthesis.out = demo.out;
  synthesis.realistic = true;
  synthesis.video = true;
  synthesis.clip.seed = demo.seed;
  synthesis.clip.num_threads = demo.num_threads;
  synthesis.clip.camera.elevation_deg = 0;  // a level camera, so that the side view's floor is level too
  return synthesis;
}

TrackRequest TrackStep(const DemoRequest& demo, const SynthClipFiles& files) {
  const std::filesystem::path folder = demo.out;
  TrackRequest track;
  track.detections = files.observations;
  track.cameras = files.camera;
  track.video = files.video;
  track.reference = files.truth;
  track.side_view = true;
  track.out = (folder / "track.npz").string();
  track.overlay = (folder / "overlay.mp4").string();
  track.json = (folder / "summary.json").string();
  track.solve.num_threads = demo.num_threads;
  return track;
}

std::vector<std::string> CommandLines(const DemoRequest& demo, const SynthClipFiles& files, const TrackRequest& track) {
  return {"bodyloom synth --motion demo --realistic --video --elevation 0 --seed " + std::to_string(demo.seed) +
              " --out " + demo.out,
          "bodyloom track --detections " + files.observations + " --cameras " + files.camera + " --video " +
              files.video + " --out " + track.out + " --overlay " + track.overlay + " --side-view --reference " +
              files.truth,
          "bodyloom evaluate --track " + track.out + " --truth " + files.truth};
}

}  // namespace

DemoReport RunDemo(const DemoRequest& request, const PipelineCallbacks& callbacks) {
  const std::filesystem::path folder = request.out;
  RequireWritableFolder(request.out);

  callbacks.Message("1. A clip with known truth: the built-in body walks, turns, waves and kicks.");
  const SynthClipFiles files = SynthesizeClip(SynthesisStep(request), callbacks).files;

  callbacks.Message("2. The tracker sees 2D joints and dense keypoints, with the faults that detectors have.");
  const TrackRequest track_step = TrackStep(request, files);
  DemoPageContent content;
  content.report = TrackClip(track_step, callbacks);

  callbacks.Message("3. The estimate against the truth.");
  callbacks.Message("");
  const Track track = ReadTrack(track_step.out), truth = ReadTrack(files.truth);
  content.evaluation = EvaluateAgainstTruth(track, truth, BuiltinBody());
  WriteFileAtomically((folder / "evaluation.json").string(), EvaluationJson(content.evaluation));
  content.times_s = track.motion.timestamps;
  content.error_mm = JointErrorByFrameMm(track, truth);
  content.overlay = std::filesystem::path(track_step.overlay).filename().string();
  const std::string image = (folder / "overlay.jpg").string();
  WriteImage(image, VideoStills(track_step.overlay));
  content.image_jpeg = ReadFileBytes(image);
  content.commands = CommandLines(request, files, track_step);
  DemoReport report;
  report.page = (folder / "summary.html").string();
  WriteFileAtomically(report.page, DemoPage(content));
  report.overlay_path = track_step.overlay;
  report.track_path = track_step.out;
  report.track = std::move(content.report);
  report.evaluation = std::move(content.evaluation);
  return report;
}

std::string ToText(const DemoReport& report) {
  std::ostringstream text;
  text << ToText(report.track) << "\n"
       << "projection error of a vertex, image of 512 px   " << report.evaluation.Value("projection_mean_px") << " px\n"
       << "joint error, pelvis aligned                     " << report.evaluation.Value("mpjpe_mm") << " mm\n\n"
       << "Look at:  " << report.page << "      the summary on one page\n"
       << "          " << report.overlay_path << "       the overlay video\n"
       << "          " << report.track_path << "         the track\n"
       << "Your own: bodyloom track --help\n";
  return text.str();
}

}  // namespace bodyloom
