// SPDX-License-Identifier: Apache-2.0
// Adds a term of your own, as a plain Ceres cost function: it pulls a point of the left wrist's skin to 15 cm above its
// position in the clip, and the first shape component to 1.
#include <ceres/autodiff_cost_function.h>

#include <cstdio>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/synthesis/clips/demo_motion.h"
#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/tracking/track_sequence.h"

using namespace bodyloom;
struct PullUp {
  Eigen::Vector3d target_m;
  template <typename T>
  bool operator()(const T* x, const T* betas, T* r) const {
    for (int c = 0; c < 3; ++c) r[c] = (x[c] - target_m[c]) / 0.02;  // σ 2 cm
    r[3] = (betas[0] - 1.0) / 0.5;
    return true;
  }
};
int main() {
  const BodyModel& body = BuiltinBody();
  const SynthClip clip = MakeSynthClip(body, DemoMotion(body, 12, 15), {});
  TrackSequenceInput input;
  input.body = &body, input.keypoints = &clip.keypoints, input.camera = clip.truth.camera;
  input.initialiser = &clip.truth.motion;
  TrackSequenceOptions options;
  options.max_iterations = 500, options.function_tolerance = 1e-11;
  const Track before = TrackSequence(input, options).track;
  int face = 0;  // at the wrist
  const Landmark& wrist = body.data().landmarks[body.FindLandmark("left_wrist")];
  while (body.data().faces(face, 0) != wrist.vertices[0]) ++face;
  const SurfacePoint point{face, Eigen::Vector3d::UnitX()};
  options.user_terms.push_back({.name = "wrist", .inputs = {TermInput::Surface(point), TermInput::Betas()}});
  options.user_terms.back().cost = [&](int t) {
    const Eigen::Vector3d target_m = before.coco17[t].row(9) - Eigen::RowVector3d(0, 0.15, 0);  // y is down
    return std::make_shared<ceres::AutoDiffCostFunction<PullUp, 4, 3, 10>>(new PullUp{target_m});
  };
  for (const SequenceSolver solver : {SequenceSolver::kChain, SequenceSolver::kCeres}) {
    options.solver = solver;
    const auto [track, summary] = TrackSequence(input, options);
    const double up_m = (before.coco17[6] - track.coco17[6])(9, 1);
    std::printf("%s: cost %.9g, wrist %.3f m higher, first beta %.3f\n", summary.solver.c_str(), summary.final_cost,
                up_m, track.motion.betas[0]);
  }
}
