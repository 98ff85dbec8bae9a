// SPDX-License-Identifier: Apache-2.0
// The demo takes the very steps that its page lists as command lines: synth, track, evaluate.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/demo_page.h"
#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/synth_run.h"
#include "apps/track_run.h"
#include "apps/verbs.h"
#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/evaluation/truth_evaluation.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

struct DemoCommand {
  std::string out = "demo";
  int num_frames = 0, num_threads = 0;
  uint64_t seed = 1;
};

SynthCommand SynthStep(const DemoCommand& demo) {
  SynthCommand synth;
  synth.motion = "demo";
  synth.out = demo.out;
  synth.num_frames = demo.num_frames;
  synth.realistic = true;
  synth.video = true;
  synth.clip.seed = demo.seed;
  synth.clip.num_threads = demo.num_threads;
  synth.clip.camera.elevation_deg = 0;  // a level camera, so that the side view's floor is level too
  return synth;
}

TrackCommand TrackStep(const DemoCommand& demo, const SynthFiles& files) {
  const std::filesystem::path folder = demo.out;
  TrackCommand track;
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

void RunDemo(const DemoCommand& demo) {
  const std::filesystem::path folder = demo.out;
  RequireWritableFolder(demo.out);

  std::cout << "1. A clip with known truth: the built-in body walks, turns, waves and kicks." << std::endl;
  const SynthCommand synth = SynthStep(demo);
  const SynthFiles files = SynthFilesIn(synth);
  RunSynth(synth);
  ThrowIfInterrupted();

  std::cout << "2. The tracker sees 2D joints and dense keypoints, with the faults that detectors have." << std::endl;
  const TrackCommand track_step = TrackStep(demo, files);
  DemoPageContent content;
  content.report = RunTrack(track_step);

  std::cout << "3. The estimate against the truth.\n" << std::endl;
  const Track track = ReadTrack(track_step.out), truth = ReadTrack(files.truth);
  content.evaluation = EvaluateAgainstTruth(track, truth, BuiltinBody());
  WriteFileAtomically((folder / "evaluation.json").string(), EvaluationJson(content.evaluation));
  content.times_s = track.motion.timestamps;
  content.error_mm = JointErrorByFrameMm(track, truth);
  content.overlay = std::filesystem::path(track_step.overlay).filename().string();
  const std::string picture = (folder / "overlay.jpg").string(), page = (folder / "summary.html").string();
  WriteImage(picture, VideoStills(track_step.overlay));
  content.picture_jpeg = ReadFileBytes(picture);
  content.commands = {"bodyloom synth --motion demo --realistic --video --elevation 0 --seed " +
                          std::to_string(demo.seed) + " --out " + demo.out,
                      "bodyloom track --detections " + files.observations + " --cameras " + files.camera + " --video " +
                          files.video + " --out " + track_step.out + " --overlay " + track_step.overlay +
                          " --side-view --reference " + files.truth,
                      "bodyloom evaluate --track " + track_step.out + " --truth " + files.truth};
  WriteFileAtomically(page, DemoPage(content));

  std::cout << ToText(content.report) << "\n"
            << "projection error of a vertex, image of 512 px   " << content.evaluation.Value("projection_mean_px")
            << " px\n"
            << "joint error, pelvis aligned                     " << content.evaluation.Value("mpjpe_mm") << " mm\n\n"
            << "Look at:  " << page << "      the summary on one page\n"
            << "          " << track_step.overlay << "       the overlay video\n"
            << "          " << track_step.out << "         the track\n"
            << "Your own: bodyloom track --help\n";
}

}  // namespace

void AddDemoVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("demo", "Everything at once: a clip is made, tracked, evaluated and shown");
  verb->footer(std::string("Writes summary.html, overlay.mp4, track.npz and what they came from into one folder.\n"
                           "Example:\n  bodyloom demo --out demo\n\n") +
               kExitCodeHelp);
  auto command = std::make_shared<DemoCommand>();
  DemoCommand& c = *command;
  verb->add_option("--out", c.out, "folder")->capture_default_str()->type_name("DIR");
  verb->add_option("--frames", c.num_frames, "only the first N frames (0: all 6 seconds)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--seed", c.seed, "of the faults")->capture_default_str();
  verb->add_option("--threads", c.num_threads, "0: all cores")->check(CLI::NonNegativeNumber)->capture_default_str();
  verb->callback([command, action] { *action = [command] { RunDemo(*command); }; });
}

}  // namespace bodyloom
