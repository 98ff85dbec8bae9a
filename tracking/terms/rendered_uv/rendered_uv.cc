// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/rendered_uv/rendered_uv.h"

#include "geometry/base/parallel.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/terms/dense/dense_whitening.h"

namespace bodyloom {

std::string WhyNoRenderedUv(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (input.dense == nullptr) return "no dense keypoints in the input";
  if (options.rendered_uv.weight == 0) return "switched off";
  if (options.rendered_uv.only_with_uv_noise && !(input.dense->uv_sigma > 0)) {
    return "the keypoints do not say that their noise lies on the surface";
  }
  if (!input.body->has_parts() || input.body->data().face_iuv.rows() == 0) return "the body has no charts";
  if (input.camera.width <= 0 && input.dense->image_width <= 0) return "the image size is not known";
  return "";
}

std::vector<PlanEntry> PlanRenderedUv(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string why_not = WhyNoRenderedUv(input, options);
  return {{"rendered UV (L_r)", why_not.empty(),
           why_not.empty() ? "weight " + std::to_string(options.rendered_uv.weight) : why_not}};
}

std::unique_ptr<ClipTerm> MakeDenseRounds(const ClipTermInput& clip) {
  const bool whitens =
      clip.input.dense != nullptr && clip.input.dense->uv_sigma > 0 && clip.layout.model->data().face_iuv.rows() > 0;
  if (!whitens && !WhyNoRenderedUv(clip.input, clip.options).empty()) return nullptr;
  return std::make_unique<DenseRounds>(clip);
}

DenseRounds::DenseRounds(const ClipTermInput& clip)
    : input_(clip.input),
      num_threads_(clip.num_threads),
      rounds_{clip.options.rendered_uv.rounds, clip.options.rendered_uv.max_iterations, "fit dense"},
      skinner_(std::make_shared<const Skinner>(*clip.layout.model)) {
  if (!WhyNoRenderedUv(clip.input, clip.options).empty()) return;
  for (const std::vector<DenseKeypoint>& frame : clip.input.dense->frames) {
    rendered_uv_.push_back(
        std::make_unique<RenderedUvPixels>(*clip.layout.model, skinner_, frame, clip.options.rendered_uv));
  }
}

void DenseRounds::Observe(SequenceProblem* problem) {
  if (rendered_uv_.empty()) return;
  for (FrameData& frame : problem->frames) frame.Get<RenderedUvTerm>();
}

void DenseRounds::StartRound(int /*round*/, const std::vector<int>& frames, SequenceProblem* problem) {
  ParallelFor(static_cast<int>(frames.size()), num_threads_, [&](int i) {
    FrameData& frame = problem->frames[i];
    const FrameState state = StateInCamera(*problem, i);
    thread_local VisibleSurface surface;
    const bool seen =
        surface.Render(skinner_, *problem->layout.model, problem->betas, state.rotations,
                       problem->layout.BodyTranslation(state), problem->layout.CameraAt(state, problem->log_focal));
    DenseTerm& dense = frame.Get<DenseTerm>();
    dense.whitening =
        WhitenDense(problem->layout, state, problem->betas, problem->log_focal, *dense.points, input_.dense->uv_sigma,
                    input_.dense->pixel_sigma_px, seen ? &surface.buffer() : nullptr);
    if (rendered_uv_.empty()) return;
    RenderedUvPixels* term = rendered_uv_[frames[i]].get();
    term->SetWhitening(dense.whitening);
    frame.Get<RenderedUvTerm>().term = term;
    frame.Get<RenderedUvTerm>().kernel = dense.kernel;
    dense.taken = &term->taken();
  });
}

}  // namespace bodyloom
