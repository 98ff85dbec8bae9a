// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/image_terms.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/tracking/residuals/dense_whitening.h"
#include "bodyloom/tracking/track_result.h"

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

std::string WhyNoSilhouette(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (input.part_labels == nullptr) return "no part labels or masks in the input";
  return options.part_labels.silhouette_weight == 0 ? "switched off" : "";
}

std::string WhyNoParts(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (input.part_labels == nullptr) return "no part labels in the input";
  if (!input.body->has_parts()) return "the body has no charts";
  return options.part_labels.part_weight == 0 ? "switched off" : "";
}

double PersonHeightPx(const FrameLayout& layout, const FrameState& state, double stature_m) {
  if (layout.knowledge == CameraKnowledge::kWeak) return std::exp(state.translation[0]) * stature_m;
  return layout.camera.fy * stature_m / std::max(state.translation.z(), 0.3);
}

ImageTerms::ImageTerms(const TrackSequenceInput& input, const TrackSequenceOptions& options, const FrameLayout& layout,
                       int num_threads)
    : input_(input), num_threads_(num_threads) {
  const BodyModel& model = *layout.model;
  Eigen::VectorXd unused;
  stature_m_ = StatureOfMeanShape(model, 0, &unused);
  whitens_ = input.dense != nullptr && input.dense->uv_sigma > 0 && model.data().face_iuv.rows() > 0;
  const bool uv = WhyNoRenderedUv(input, options).empty();
  const bool labels = WhyNoSilhouette(input, options).empty() || WhyNoParts(input, options).empty();
  if (!uv && !labels && !whitens_) return;
  skinner_ = std::make_shared<const Skinner>(model);
  if (uv) {
    for (const std::vector<DenseKeypoint>& frame : input.dense->frames) {
      rendered_uv_.push_back(std::make_unique<RenderedUvTerm>(model, skinner_, frame, options.rendered_uv));
    }
  }
  if (labels) {
    part_labels_.resize(input.part_labels->num_frames());
    ParallelFor(input.part_labels->num_frames(), num_threads, [&](int t) {
      part_labels_[t] = std::make_unique<PartLabelTerm>(*input.part_labels, t, skinner_, options.part_labels);
    });
  }
}

void ImageTerms::StartDenseRound(const std::vector<int>& frames, SequenceProblem* problem) const {
  if (!has_dense_rounds()) return;
  ParallelFor(static_cast<int>(frames.size()), num_threads_, [&](int i) {
    FrameData& frame = problem->frames[i];
    const FrameState& state = problem->states[i];
    thread_local VisibleSurface surface;
    const bool seen =
        surface.Render(skinner_, *problem->layout.model, problem->betas, state.rotations,
                       problem->layout.BodyTranslation(state), problem->layout.CameraAt(state, problem->log_focal));
    frame.dense_whitening =
        WhitenDense(problem->layout, state, problem->betas, problem->log_focal, *frame.dense, input_.dense->uv_sigma,
                    input_.dense->pixel_sigma_px, seen ? &surface.buffer() : nullptr);
    if (rendered_uv_.empty()) return;
    frame.rendered_uv = rendered_uv_[frames[i]].get();
    frame.rendered_uv->SetWhitening(frame.dense_whitening);
  });
}

void ImageTerms::StartPartLabelRound(const std::vector<int>& frames, double kernel, SequenceProblem* problem) const {
  if (!has_part_labels()) return;
  ParallelFor(static_cast<int>(frames.size()), num_threads_, [&](int i) {
    thread_local VisibleSurface surface;
    PartLabelTerm& term = *part_labels_[frames[i]];
    const double height_px = PersonHeightPx(problem->layout, problem->states[i], stature_m_);
    term.Correspond(problem->layout, problem->states[i], problem->betas, problem->log_focal, height_px, kernel,
                    &surface);
    problem->frames[i].part_labels = &term;
  });
}

void ImageTerms::Summarise(const SequenceProblem& problem, TrackSequenceSummary* summary) const {
  FrameResiduals residuals;
  FrameEvaluator evaluator;
  FrameSystem system;
  for (size_t t = 0; t < problem.frames.size(); ++t) {
    evaluator.Evaluate(problem.layout, problem.frames[t], problem.states[t], problem.betas, problem.log_focal, false,
                       &system, &residuals);
    if (problem.frames[t].part_labels != nullptr)
      summary->num_observations += problem.frames[t].part_labels->num_rows();
  }
  const auto add = [&](const char* term, const std::vector<double>& px, int unmatched) {
    summary->terms.push_back(SummarizeTerm(term, px, unmatched));
  };
  if (!rendered_uv_.empty()) add("rendered UV", residuals.rendered_uv_px, residuals.rendered_uv_unmatched);
  if (has_part_labels()) {
    add("silhouette", residuals.silhouette_px, residuals.silhouette_unmatched);
    add("part labels", residuals.part_px, residuals.part_unmatched);
  }
}

}  // namespace bodyloom
