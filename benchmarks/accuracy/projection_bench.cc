// SPDX-License-Identifier: Apache-2.0
/// Per-vertex projection error at 512 px on AIST++, as paper A's Table 4 has it: tracks of one camera's observations
/// against the SMPL motion that the recording publishes of itself (data_tools/evaluation/aist_evaluation.h), on one
/// body.
///
///   bodyloom_bench_projection --data AISTPP [--sequences A,B] [--views c01,c03] [--inputs joints,dense,…] [--frames 0]
///                             [--dense 300] [--threads 2] [--json F]
///
/// Inputs:
/// the 17 joints that a detector found in the real images (AIST++'s keypoints2d)
///   rendered-joints  the same landmarks of the published motion's body, with detector-like noise
///   dense            surface keypoints of that body with noise `densepose` (dense_clips.h), from a start 14.8 px off
///   dense+joints     both, the joints the detector's; started from the joints
///   labels           that body's part labels and nothing else: joints are read off them for a start
/// All but `joints` show the truth's own body: what they leave is the tracker's error, not the model's.
#include <algorithm>
#include <cstdio>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/dense_clips.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/vertex_errors.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/base/units.h"
#include "tests/support/paths.h"
#include "tests/support/rendered_labels.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/lifter/given_landmarks.h"

namespace bodyloom {
namespace {

constexpr double kInitialError_px = 14.8;  // VIBE's of the table

/// Inputs of the tracker for a view, and their truth.
struct View {
  const RigView* recorded = nullptr;
  PseudoTruth truth;
  SynthClip seen;  ///< dense keypoints, joints and a start, of the truth's body
};

struct Observations {
  KeypointSequence joints;
  DenseSequence dense;
  PartLabelSequence labels;
  Motion start;
};

View MakeView(const MultiViewClip& clip, const RigView& recorded, const BenchArguments& arguments) {
  View view;
  view.recorded = &recorded;
  view.truth = MakePseudoTruth(clip, recorded, BuiltinBody(), PseudoTruthShape::kFitted);
  Track& truth = view.truth.track;
  truth.motion = FirstFrames(truth.motion, arguments.Integer("frames"));
  truth.frame_status.resize(size_t(truth.motion.num_frames()));
  SynthClipOptions synth;
  synth.dense_per_frame = arguments.Integer("dense");
  synth.dense = DenseFaults("densepose");
  synth.initialiser_error_px = kInitialError_px;
  synth.num_threads = arguments.Integer("threads");
  SynthCamera camera;
  camera.camera = recorded.camera;
  view.seen = MakeSynthClip(BuiltinBody(), truth.motion, camera, synth);
  return view;
}

BenchRow TrackAndScore(const std::string& kind, const std::string& clip, const View& view, int threads) {
  const Track& truth = view.truth.track;
  const int frames = truth.motion.num_frames();
  Observations seen;
  TrackSequenceInput input;
  TrackSequenceOptions options;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.camera = truth.camera;
  options.num_threads = threads;
  if (kind == "dense" || kind == "dense+joints") {
    seen.dense = view.seen.dense;
    input.dense = &seen.dense;
  }
  if (kind == "dense") {
    seen.start = view.seen.initialiser;
    input.initialiser = &seen.start;
  } else if (kind == "labels") {
    seen.labels = RenderPartLabels(BuiltinBody(), truth);
    seen.joints = KeypointsFromPartLabels(seen.labels);
    input.part_labels = &seen.labels;
    options.part_labels = PartLabelOptions::LabelsAlone();
  } else if (kind == "rendered-joints") {
    seen.joints = view.seen.keypoints;
  } else {
    BODYLOOM_CHECK(kind == "joints" || kind == "dense+joints", "--inputs has '", kind,
                   "', expected joints, rendered-joints, dense, dense+joints or labels");
    seen.joints = FirstFrames(view.recorded->detections, frames);
  }
  if (kind != "dense") {
    input.keypoints = &seen.joints;
    input.lifter = &BuiltinLifter();
  }
  const Stopwatch watch;
  const Track track = FitClip(input, options).track;
  const double seconds = watch.seconds();

  const VertexErrors errors =
      CompareVertices(track, NearestFramesWithResult(HasResults(track, frames)), truth, BuiltinBody());
  return {kind,
          {clip.substr(0, 3), view.recorded->name},
          {errors.projection.mean_px, errors.projection.std_frames_px, errors.projection.std_vertices_px,
           errors.projection.frames_px.p95, kMmPerMetre * errors.position.mean,
           kMmPerMetre * view.truth.landmark_error_m, 1e3 * seconds / frames}};
}

void Run(const BenchArguments& arguments, const std::string& command) {
  BenchReport report;
  report.title = "AIST++: per-vertex projection error at 512 px against the published SMPL motion";
  report.command = command;
  report.label_columns = {"clip", "camera"};
  report.value_columns = {"projection_px", "std_frames_px",     "std_vertices_px", "p95_px",
                          "pve_mm",        "truth_landmark_mm", "ms_per_frame"};
  report.notes = {
      "protocol aist-held-out, known focal length; built-in body, whose shape and place are fitted to the "
      "clip's 3D landmarks with the published rotations",
      "truth_landmark: how far the truth's own landmarks are from the recording's",
      "paper A, Table 4, from images, on SMPL: SPIN 21.0 +- 5.2, VIBE 14.8 +- 3.4, SMPLify-X 11.9 +- 4.5, "
      "theirs 10.5 +- 2.1",
      Concatenate("threads: ", arguments.Integer("threads"))};
  for (const std::string& sequence : arguments.List("sequences")) {
    const MultiViewClip clip = ReadAistClip(arguments.Text("data"), arguments.Text("data") + "/cameras", sequence);
    const std::vector<std::string> wanted = arguments.List("views");
    for (const RigView& recorded : clip.views) {
      if (std::find(wanted.begin(), wanted.end(), recorded.name) == wanted.end()) continue;
      const View view = MakeView(clip, recorded, arguments);
      for (const std::string& kind : arguments.List("inputs")) {
        report.rows.push_back(TrackAndScore(kind, sequence, view, arguments.Integer("threads")));
        std::fprintf(stderr, "%s %s %s: %.2f px\n", sequence.c_str(), recorded.name.c_str(), kind.c_str(),
                     report.rows.back().values[0]);
      }
    }
  }
  std::stable_sort(report.rows.begin(), report.rows.end(),
                   [](const BenchRow& a, const BenchRow& b) { return a.group < b.group; });
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_projection", argc, argv,
                             {{"data", bodyloom::SharedDir() + "/data/aistpp"},
                              {"sequences", "gBR_sBM_cAll_d06_mBR2_ch06,gJS_sBM_cAll_d03_mJS2_ch07"},
                              {"views", "c01,c03,c05,c07,c08"},
                              {"inputs", "joints,rendered-joints,dense,dense+joints,labels"},
                              {"dense", "300"},
                              {"frames", "0"},
                              {"threads", "2"},
                              {"json", ""}},
                             bodyloom::Run);
}
