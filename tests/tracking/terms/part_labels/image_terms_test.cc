// SPDX-License-Identifier: Apache-2.0
// The tracker with rendered UV, silhouettes and part labels: from input to summary.
#include "tracking/clip/clip_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/perturbed_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/body/posed_body.h"
#include "render/raster/visibility_buffer.h"
#include "tracking/clip/track_plan.h"

namespace bodyloom::image_terms_test {
namespace {

SynthClip Clip(int frames, double uv_sigma) {
  SynthClipOptions options;
  options.camera.width = 480;
  options.camera.height = 360;
  options.keypoints = false;
  options.dense_per_frame = 200;
  options.dense.pixel_sigma_px = 0.5;
  options.dense.uv_sigma = uv_sigma;
  options.initialiser_error_px = 15;
  options.num_threads = 2;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), frames, 15), options);
}

PartLabelSequence LabelsOf(const SynthClip& clip) {
  const Motion& motion = clip.truth.motion;
  PartLabelSequence labels;
  labels.timestamps = motion.timestamps;
  labels.image_width = clip.truth.camera.width;
  labels.image_height = clip.truth.camera.height;
  VisibilityBuffer buffer;
  for (int t = 0; t < motion.num_frames(); ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(BuiltinBody(), motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    buffer.Render(PoseVertices(BuiltinBody(), motion.betas, pose), BuiltinBody().data().faces, clip.truth.camera);
    // Only the rectangle that shows the person.
    const PixelBox& box = buffer.box();
    LabelImage image{box.x_begin, box.y_begin, box.width(), box.height(), {}};
    for (const int32_t face : buffer.faces()) {
      image.labels.push_back(face < 0 ? 0 : BuiltinBody().data().face_part[face]);
    }
    labels.frames.emplace_back(image);
  }
  return labels;
}

TrackSequenceInput InputOf(const SynthClip& clip) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.initialiser = &clip.initialiser;
  input.prior = &BuiltinPosePrior();
  input.camera = clip.truth.camera;
  return input;
}

/// Mean per-vertex distance of the projections, pixels of the clip.
double ProjectionErrorPx(const SynthClip& clip, const Motion& motion) {
  return MeanProjectionError(BuiltinBody(), clip.truth.camera, clip.truth.motion, motion, 2) * clip.truth.camera.width /
         512;
}

const TermSummary& Term(const TrackSequenceSummary& summary, const std::string& name) {
  for (const TermSummary& term : summary.terms) {
    if (term.term == name) return term;
  }
  throw std::runtime_error("no term " + name);
}

bool Runs(const std::vector<PlanEntry>& plan, const std::string& what) {
  for (const PlanEntry& entry : plan) {
    if (entry.what == what) return entry.runs;
  }
  throw std::runtime_error("the plan does not mention " + what);
}

TEST(ImageTerms, RenderedUvTracksAndReportsItself) {
  const SynthClip clip = Clip(8, 0.02);
  TrackSequenceInput input = InputOf(clip);
  input.dense = &clip.dense;
  TrackSequenceOptions options;
  options.num_threads = 2;
  options.rendered_uv.weight = 1;
  const TrackSequenceResult result = FitClip(input, options);
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_TRUE(Runs(result.summary.plan, "rendered UV (L_r)"));
  const TermSummary& term = Term(result.summary, "rendered UV");
  EXPECT_GT(term.observations, 8 * 120);
  EXPECT_EQ(term.observations + term.unmatched, 8 * 200);
  EXPECT_GT(term.median_px, 0.2);
  EXPECT_LT(term.median_px, 4);
  EXPECT_LT(ProjectionErrorPx(clip, result.track.motion), 2);
  EXPECT_NE(result.summary.BriefReport().find("rendered UV"), std::string::npos);

  options.rendered_uv.weight = 0;
  const TrackSequenceResult without = FitClip(input, options);
  EXPECT_FALSE(Runs(without.summary.plan, "rendered UV (L_r)"));
  EXPECT_THROW((void)Term(without.summary, "rendered UV"), std::runtime_error);
  EXPECT_NE(without.track.motion.poses, result.track.motion.poses);
}

TEST(ImageTerms, RenderedUvRunsByItselfOnlyForNoiseOnTheSurface) {
  SynthClip clip = Clip(2, 0.02);
  TrackSequenceInput input = InputOf(clip);
  input.dense = &clip.dense;
  TrackSequenceOptions options;
  EXPECT_TRUE(Runs(PlanTrackSequence(input, options), "rendered UV (L_r)"));
  clip.dense.uv_sigma = 0;
  EXPECT_FALSE(Runs(PlanTrackSequence(input, options), "rendered UV (L_r)"));
  options.rendered_uv.only_with_uv_noise = false;
  EXPECT_TRUE(Runs(PlanTrackSequence(input, options), "rendered UV (L_r)"));
  BodyModelData without_charts = BuiltinBody().data();
  without_charts.face_part.clear();
  without_charts.face_iuv.resize(0, 6);
  const BodyModel plain(without_charts);
  input.body = &plain;
  EXPECT_FALSE(Runs(PlanTrackSequence(input, options), "rendered UV (L_r)"));
}

TEST(ImageTerms, PartLabelsAloneTrackFromAStart) {
  const SynthClip clip = Clip(8, 0);
  const PartLabelSequence labels = LabelsOf(clip);
  TrackSequenceInput input = InputOf(clip);
  input.part_labels = &labels;
  TrackSequenceOptions options;
  options.num_threads = 2;
  const TrackSequenceResult result = FitClip(input, options);
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_EQ(result.summary.frames_by_status.at("tracked"), 8);
  EXPECT_GT(result.summary.num_observations, 8 * 100);
  const double before = ProjectionErrorPx(clip, clip.initialiser), after = ProjectionErrorPx(clip, result.track.motion);
  EXPECT_GT(before, 12);
  EXPECT_LT(after, 0.25 * before);
  EXPECT_LT(Term(result.summary, "silhouette").median_px, 1.5);
  EXPECT_LT(Term(result.summary, "part labels").median_px, 2);
  EXPECT_TRUE(Runs(result.summary.plan, "silhouette"));
  EXPECT_TRUE(Runs(result.summary.plan, "part labels"));
}

TEST(ImageTerms, SameBytesForAnyNumberOfThreads) {
  const SynthClip clip = Clip(5, 0.02);
  const PartLabelSequence labels = LabelsOf(clip);
  TrackSequenceInput input = InputOf(clip);
  input.dense = &clip.dense;
  input.part_labels = &labels;
  TrackSequenceOptions options;
  options.rendered_uv.weight = 1;
  options.max_iterations = 5;
  options.num_threads = 1;
  const TrackSequenceResult one = FitClip(input, options);
  options.num_threads = 4;
  const TrackSequenceResult four = FitClip(input, options);
  ASSERT_TRUE(one.summary.IsUsable());
  EXPECT_EQ(one.track.motion.poses, four.track.motion.poses);
  EXPECT_EQ(one.track.motion.trans, four.track.motion.trans);
  EXPECT_EQ(one.summary.final_cost, four.summary.final_cost);
}

TEST(ImageTerms, FramesWithoutLabelsAreCarried) {
  const SynthClip clip = Clip(6, 0);
  PartLabelSequence labels = LabelsOf(clip);
  labels.frames[2] = LabelImage();
  LabelImage unknown = labels.frames[3].Unpacked();
  std::fill(unknown.labels.begin(), unknown.labels.end(), PartLabelSequence::kUnknown);
  labels.frames[3] = unknown;
  TrackSequenceInput input = InputOf(clip);
  input.part_labels = &labels;
  TrackSequenceOptions options;
  options.num_threads = 2;
  options.part_labels.rounds = 2;
  const TrackSequenceResult result = FitClip(input, options);
  ASSERT_TRUE(result.summary.IsUsable());
  EXPECT_EQ(result.summary.frames_by_status.at("tracked"), 4);
  EXPECT_EQ(result.track.frame_status[2], FrameStatus::kInterpolated);
  EXPECT_EQ(result.track.frame_status[3], FrameStatus::kInterpolated);
  EXPECT_TRUE(result.track.motion.poses.allFinite());
}

double CostOf(const TrackSequenceResult& result, const std::string& term) {
  for (const TermCost& cost : result.summary.costs) {
    if (cost.term == term) return cost.cost;
  }
  throw std::runtime_error("no cost of " + term);
}

TEST(ImageTerms, AMaskBesideJointsIsUsedInTheCoarseFrames) {
  SynthClipOptions made;
  made.camera.width = 480;
  made.camera.height = 360;
  made.num_threads = 2;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 24, 30), made);
  PartLabelSequence masks = LabelsOf(clip);
  masks.AsMask();
  TrackSequenceInput input = InputOf(clip);
  input.initialiser = nullptr;
  input.keypoints = &clip.keypoints;
  input.part_labels = &masks;
  TrackSequenceOptions options;
  options.num_threads = 2;
  const TrackSequenceResult with_all = FitClip(input, options);
  ASSERT_TRUE(with_all.summary.IsUsable()) << with_all.summary.message;

  PartLabelSequence every_second = masks;
  for (int t = 1; t < 23; t += 2) every_second.frames[size_t(t)] = {};
  input.part_labels = &every_second;
  const TrackSequenceResult with_half = FitClip(input, options);
  EXPECT_EQ(with_half.track.motion.poses, with_all.track.motion.poses);
  EXPECT_EQ(with_half.track.motion.trans, with_all.track.motion.trans);

  // Masks of other frames are used as well: the coarse frames follow them.
  PartLabelSequence odd = masks;
  for (int t = 0; t < 23; t += 2) odd.frames[size_t(t)] = {};
  input.part_labels = &odd;
  const TrackSequenceResult with_odd = FitClip(input, options);
  EXPECT_NEAR(Term(with_odd.summary, "silhouette").observations, Term(with_all.summary, "silhouette").observations,
              0.15 * Term(with_all.summary, "silhouette").observations);

  // A mask counts for the frames between, too.
  input.part_labels = &masks;
  options.coarse_rate = 30;
  const TrackSequenceResult unthinned = FitClip(input, options);
  EXPECT_GT(Term(unthinned.summary, "silhouette").observations,
            1.7 * Term(with_all.summary, "silhouette").observations);
  const auto cost_of_each = [](const TrackSequenceResult& result) {
    return CostOf(result, "silhouette") / Term(result.summary, "silhouette").observations;
  };
  EXPECT_GT(cost_of_each(with_all), 2 * cost_of_each(unthinned));  // 1.6 times if each counted once
}

TEST(ImageTerms, ContradictionsAreNamed) {
  const SynthClip clip = Clip(3, 0);
  const PartLabelSequence good = LabelsOf(clip);
  const auto message =
      [&](const std::function<void(PartLabelSequence*, TrackSequenceInput*, TrackSequenceOptions*)>& spoil)
      -> std::string {
    PartLabelSequence labels = good;
    TrackSequenceInput input = InputOf(clip);
    input.part_labels = &labels;
    TrackSequenceOptions options;
    spoil(&labels, &input, &options);
    try {
      (void)FitClip(input, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  };
  const auto contains = [](const std::string& part) { return ::testing::HasSubstr(part); };
  const auto frame = [](int t, const auto& spoil_image) {
    return [=](PartLabelSequence* labels, auto*, auto*) {
      LabelImage image = labels->frames[t].Unpacked();
      spoil_image(&image);
      labels->frames[t] = image;
    };
  };
  EXPECT_THAT(message([](auto* labels, auto*, auto*) { labels->image_width = 99; }), contains("99x360"));
  EXPECT_THAT(message([](auto* labels, auto*, auto*) { labels->image_width = 0; }), contains("how large"));
  EXPECT_THAT(message([](auto* labels, auto*, auto*) { labels->timestamps.pop_back(); }), contains("2 timestamps"));
  EXPECT_THAT(message(frame(1, [](LabelImage* image) { image->labels.pop_back(); })), contains("frame 1"));
  EXPECT_THAT(message(frame(1, [](LabelImage* image) { image->x_begin = 470; })), contains("outside"));
  EXPECT_THAT(message(frame(2, [](LabelImage* image) { image->labels[0] = 77; })), contains("label 77"));
  EXPECT_THAT(message([](auto*, auto* input, auto*) { input->initialiser = nullptr; }), contains("refine a start"));
  EXPECT_THAT(message([](auto*, auto*, auto* options) { options->camera_knowledge = CameraKnowledge::kWeak; }),
              contains("weak perspective"));
  EXPECT_THAT(message([](auto*, auto*, auto* options) { options->part_labels.sigma_share = -1; }),
              contains("part_labels.sigma_share"));
  EXPECT_THAT(message([](auto*, auto*, auto* options) { options->rendered_uv.weight = std::nan(""); }),
              contains("rendered_uv.weight"));
  EXPECT_EQ(message([](auto*, auto*, auto* options) { options->part_labels.rounds = 1; }), "no error");
}

}  // namespace
}  // namespace bodyloom::image_terms_test
