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
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 12, 15), {.dense_per_frame = 0});
  TrackSequenceInput input{.body = &BuiltinBody(), .keypoints = &clip.keypoints, .camera = clip.truth.camera};
  TrackSequenceOptions options{.max_iterations = 500, .function_tolerance = 1e-11};
  const Track before = TrackSequence(input, options).track;
  const auto wrist = [](const Track& track, int t) { return Eigen::Vector3d(track.coco17[t].row(9)); };
  options.own_terms.push_back(OwnTerm::OnLandmarks("wrist", {"left_wrist"}, [&](int t) {
    return std::make_shared<ceres::AutoDiffCostFunction<PullTo, 3, 3>>(
        new PullTo{wrist(before, t) - 0.15 * Eigen::Vector3d::UnitY()});  // y is down
  }));
  for (const SequenceSolver solver : {SequenceSolver::kChain, SequenceSolver::kCeres}) {
    options.solver = solver;
    const TrackSequenceResult after = TrackSequence(input, options);
    std::printf("%s: cost %.9g, of it the term %.4g; the wrist of frame 6 is %.1f cm higher\n",
                ToString(solver).c_str(), after.summary.final_cost, after.summary.own_terms[0].cost,
                100 * (wrist(before, 6) - wrist(after.track, 6)).y());
  }
}
