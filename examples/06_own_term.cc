// SPDX-License-Identifier: Apache-2.0
// A term of your own, as a plain Ceres cost function: the left wrist 15 cm above where the clip shows it.
#include <ceres/autodiff_cost_function.h>

#include <cstdio>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/synthesis/clips/demo_motion.h"
#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/tracking/track_sequence.h"

using namespace bodyloom;
struct PullTo {
  Eigen::Vector3d target_m;
  template <typename T>
  bool operator()(const T* x, T* r) const {
    for (int c = 0; c < 3; ++c) r[c] = (x[c] - target_m[c]) / 0.02;  // σ 2 cm
    return true;
  }
};
int main() {
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 12, 15), {});
  TrackSequenceInput input;
  input.body = &BuiltinBody(), input.keypoints = &clip.keypoints, input.camera = clip.truth.camera;
  input.initialiser = &clip.truth.motion;
  TrackSequenceOptions options;
  options.max_iterations = 500, options.function_tolerance = 1e-11;
  const Track before = TrackSequence(input, options).track;
  options.own_terms.push_back(OwnTerm::OnLandmarks("wrist", {"left_wrist"}, [&](int t) {
    const Eigen::Vector3d target_m = before.coco17[t].row(9) - Eigen::RowVector3d(0, 0.15, 0);  // y is down
    return std::make_shared<ceres::AutoDiffCostFunction<PullTo, 3, 3>>(new PullTo{target_m});
  }));
  for (const SequenceSolver solver : {SequenceSolver::kChain, SequenceSolver::kCeres}) {
    options.solver = solver;
    const auto [track, summary] = TrackSequence(input, options);
    const double up_m = (before.coco17[6] - track.coco17[6])(9, 1);
    std::printf("%s: cost %.9g, wrist %.3f m higher\n", summary.solver.c_str(), summary.final_cost, up_m);
  }
}
