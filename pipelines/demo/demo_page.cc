// SPDX-License-Identifier: Apache-2.0
#include "pipelines/demo/demo_page.h"

#include <algorithm>

#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "pipelines/page/report_page.h"
#include "pipelines/report_text.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kStills = 8, kStillHeightPx = 300;

}  // namespace

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

}  // namespace bodyloom
