// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_joint_sigma: calibration of joint_sigma against the tracker's errors, and its correlation with them.
///
///   bodyloom_bench_joint_sigma [--motions FOLDER[,FOLDER…]] [--split test|train] [--every 1] [--frames 240]
///                              [--data AISTPP] [--views c01,c03,c05,c07,c08] [--json F]
///
/// Synthetic: each clip of the split (every so-many-th; its first frames at 30 a second), a body of random shape, a
/// camera of known focal length from anywhere around and −5° to 30° from above, a detector's noise on COCO-17
/// (data_tools/synthesis/clips/detection_noise.h). AIST++: its detections in these cameras, known focal length. Errors
/// and standard deviations as in data_tools/evaluation/sigma_reliability.h, of shoulders to ankles in every fourth
/// frame; by class of motion, by clip, and by joint.
#include <algorithm>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/dense_clips.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/sigma_reliability.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/motion_library.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/paths.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom {
namespace {

constexpr int kFrameStep = 4, kFirstLimbLandmark = 5, kLimbLandmarks = 12;

using Judged = std::map<std::pair<std::string, std::string>, std::vector<JudgedSigma>>;  // by (group, label)

/// Pairs of a clip under its own label and under those of its joints, both sides together.
void TrackAndJudge(const std::string& group, const std::string& label, const KeypointSequence& keypoints,
                   const Camera& camera, const std::vector<MatrixX3d>& truth, Judged* judged) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.keypoints = &keypoints;
  input.camera = camera;
  const TrackSequenceResult result = FitClip(input, TrackSequenceOptions());
  if (!result.summary.IsUsable()) return;
  std::vector<int> source;
  std::vector<MatrixX3d> found, expected;
  for (size_t t = kFrameStep / 2; t < std::min(truth.size(), result.track.coco17.size()); t += kFrameStep) {
    source.push_back(static_cast<int>(t));
    found.push_back(result.track.coco17[t]);
    expected.push_back(truth[t]);
  }
  const std::vector<int> hips = {11, 12};
  const std::vector<JudgedSigma> pairs =
      JudgedLandmarks(result.track, source, RelativeTo(found, RootPositions(found, hips)),
                      RelativeTo(expected, RootPositions(expected, hips)));
  auto& of_label = (*judged)[{group, label}];
  of_label.insert(of_label.end(), pairs.begin(), pairs.end());
  for (int k = 0; k < kLimbLandmarks; ++k) {
    const std::string name = CocoNames()[kFirstLimbLandmark + k];
    auto& of_joint = (*judged)[{group + ", by joint", name.substr(name.find('_') + 1)}];
    const auto first = pairs.begin() + static_cast<std::ptrdiff_t>(k * source.size());
    of_joint.insert(of_joint.end(), first, first + static_cast<std::ptrdiff_t>(source.size()));
  }
}

void JudgeMotions(const BenchArguments& arguments, Judged* judged) {
  const std::string split = arguments.Text("split");
  BODYLOOM_CHECK(split == "test" || split == "train", "--split is ", split, ", expected test or train");
  MotionLibraryOptions library;
  library.visit_train = split == "train";
  library.visit_test = split == "test";
  std::mt19937 random(7);
  int visited = 0;
  VisitMotionLibrary(arguments.List("motions"), library, [&](LibraryClip&& clip) {
    if (++visited % std::max(1, arguments.Integer("every")) != 0) return;
    Motion motion = ResampleMotion(clip.motion, 30);
    motion = TakeFrames(motion, 0, std::min(arguments.Integer("frames"), motion.num_frames()));
    motion.betas.setZero(std::min(10, BuiltinBody().num_betas()));
    for (double& beta : motion.betas) beta = std::normal_distribution<double>()(random);
    SynthClipOptions options;
    options.seed = 1000 + static_cast<uint64_t>(visited);
    options.dense_per_frame = 0;
    options.camera.elevation_deg = std::uniform_real_distribution<double>(-5, 30)(random);
    options.camera.yaw_deg = std::uniform_real_distribution<double>(0, 360)(random);
    SynthClip synthetic = MakeSynthClip(BuiltinBody(), motion, options);
    LeaveOutFeet(&synthetic.keypoints);
    TrackAndJudge("motion " + (split == "test" ? std::string("kept for testing") : "for training"), clip.motion_class,
                  synthetic.keypoints, synthetic.truth.camera, synthetic.truth.coco17, judged);
    std::fprintf(stderr, "%s %s\n", clip.motion_class.c_str(), clip.name.c_str());
  });
}

void JudgeAist(const BenchArguments& arguments, Judged* judged) {
  const std::string data = arguments.Text("data");
  for (const std::string& sequence : arguments.List("sequences")) {
    const MultiViewClip clip = ReadAistClip(data, data + "/cameras", sequence);
    for (const std::string& name : arguments.List("views")) {
      LoadDetectionsOptions load;
      load.view = name;
      for (const RigView& view : clip.views) {
        if (view.name != name) continue;
        load.image_width = view.camera.width;
        load.image_height = view.camera.height;
        std::vector<MatrixX3d> truth;
        for (const MatrixX3d& joints : clip.coco17_in_world) truth.push_back(MovedPoints(view.pose, joints));
        TrackAndJudge("AIST++", sequence.substr(0, 3), LoadDetections(data + "/keypoints2d/" + sequence + ".pkl", load),
                      view.camera, truth, judged);
      }
    }
  }
}

void Run(const BenchArguments& arguments, const std::string& command) {
  Judged judged;
  JudgeAist(arguments, &judged);
  JudgeMotions(arguments, &judged);
  BenchReport report;
  report.title = "joint_sigma against the tracker's errors about the mid-hip";
  report.command = command;
  report.label_columns = {"of", "joints"};
  report.value_columns = {"error_mm",        "within_1_percent", "within_2_percent", "within_3_percent",
                          "log_correlation", "surest_90_mm",     "surest_75_mm"};
  report.notes = {"Gaussian errors of these standard deviations: 19.9, 73.9 and 97.1 %"};
  for (const auto& [key, pairs] : judged) {
    const SigmaReliability of = JudgeSigmas(pairs);
    BenchRow row;
    row.group = key.first;
    row.labels = {key.second, std::to_string(of.count)};
    row.values = {1e3 * of.mean_m,    of.within_percent[0], of.within_percent[1], of.within_percent[2],
                  of.log_correlation, 1e3 * of.surest_90_m, 1e3 * of.surest_75_m};
    report.rows.push_back(row);
  }
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_joint_sigma", argc, argv,
                             {{"motions", bodyloom::SharedMotions()},
                              {"split", "test"},
                              {"every", "1"},
                              {"frames", "240"},
                              {"data", bodyloom::SharedDir() + "/data/aistpp"},
                              {"sequences", "gBR_sBM_cAll_d06_mBR2_ch06,gJS_sBM_cAll_d03_mJS2_ch07"},
                              {"views", "c01,c03,c05,c07,c08"},
                              {"json", ""}},
                             bodyloom::Run);
}
