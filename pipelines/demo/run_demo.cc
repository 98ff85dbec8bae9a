// SPDX-License-Identifier: Apache-2.0
#include "pipelines/demo/run_demo.h"

#include <filesystem>
#include <sstream>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/truth_evaluation.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "pipelines/demo/demo_page.h"
#include "pipelines/files.h"
#include "pipelines/synthesis/synthesize_clip.h"
#include "pipelines/track/track_clip.h"

namespace bodyloom {
namespace {

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
