// SPDX-License-Identifier: Apache-2.0
// Training of the pose-guided renderer on toy people, resuming, and rendering.
#include <gtest/gtest.h>
#include <torch/cuda.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "neural/base/runtime.h"
#include "neural/guided/guided_batches.h"
#include "neural/guided/guided_model.h"
#include "neural/guided/guided_renderer.h"
#include "neural/guided/guided_tensors.h"
#include "neural/guided/train_guided.h"
#include "tests/neural/guided/guided_toy.h"
#include "tests/neural/training/last_metrics.h"
#include "tests/support/test_files.h"

namespace bodyloom::guided_training_test {
namespace {

namespace fs = std::filesystem;

const std::vector<uint8_t> kTexelParts = ToyTexelParts();
const std::vector<PhotoFrame> kViews = ToyViews();

TrainGuidedOptions ToyOptions(const std::string& name) {
  TrainGuidedOptions options;
  options.config = ToyGuided();
  options.validation = ToyPeople(2, 4);
  options.validation_views = [](int) { return ToyViews(); };
  options.batch = 2;
  options.steps = 8;
  options.balance_steps = 3;
  options.num_threads = 1;
  options.reach = 2;
  options.report_every = options.checkpoint_every = options.validate_every = 4;
  options.run_dir = EmptyFolder(name);
  return options;
}

/// The toy's window within one of twice its side, its upper left corner at (left, top).
PhotoFrame InLargerWindow(const PhotoFrame& toy, int left, int top) {
  const int side = toy.size, size = 2 * side;
  const size_t toy_area = size_t(side) * side, area = size_t(size) * size;
  PhotoFrame frame = toy;
  frame.size = size;
  frame.uv.assign(2 * area, 0), frame.image.assign(3 * area, 0);
  frame.parts.assign(area, 0), frame.labels.assign(area, 0);
  for (size_t i = 0; i < toy_area; ++i) {
    const size_t at = (i / side + top) * size + i % side + left;
    frame.parts[at] = toy.parts[i], frame.labels[at] = toy.labels[i];
    for (size_t c = 0; c < 2; ++c) frame.uv[c * area + at] = toy.uv[c * toy_area + i];
    for (size_t c = 0; c < 3; ++c) frame.image[c * area + at] = toy.image[c * toy_area + i];
  }
  for (size_t i = 0; i < toy.texel_cosine.size(); ++i) {
    if (toy.texel_cosine[i] == 0) continue;
    frame.texel_pixels[i] += static_cast<float>(left);
    frame.texel_pixels[toy.texel_cosine.size() + i] += static_cast<float>(top);
  }
  return frame;
}

/// Instance norms see at work the window of one frame: in training the same window, as large as the largest of a batch.
TEST(GuidedBatches, EveryTargetIsInItsOwnWindow) {
  // A person below on the left, and the same above on the right.
  PhotoSource people = ToyPeople(1, 2);
  people.fill = [](int, int frame, PhotoFrame* out) {
    const PhotoFrame toy = ToyPhotoFrame(0, {}, true);
    *out = frame == 0 ? InLargerWindow(toy, 0, toy.size) : InLargerWindow(toy, toy.size, 0);
  };
  people.size = 2 * kToySide;
  GuidedConfig config = ToyGuided();
  config.profile.image_size = people.size;
  const int multiple = config.Multiple();
  std::set<int64_t> lefts;
  for (int64_t step = 0; step < 6; ++step) {
    const GuidedBatch batch = MakeGuidedBatch(people, config, 3, step, 2, 0);
    ASSERT_EQ(batch.boxes.size(), 2U);
    for (int b = 0; b < 2; ++b) {
      const GuidedSample sample = GuidedSampleOf(3, step, b, people);
      PhotoFrame frame;
      people.fill(0, sample.target, &frame);
      const CodeBox own = PersonBox(frame, multiple, 0), &box = batch.boxes[b];
      EXPECT_EQ(box.x, own.x);
      EXPECT_EQ(box.y, own.y);
      EXPECT_EQ(box.width, own.width) << "both are of one size here";
      const GuidedTensors whole = TensorsOf(std::span(&frame, 1));
      EXPECT_TRUE(torch::equal(batch.target.image[b], CroppedPixels(whole.image, box, multiple)[0]));
      EXPECT_TRUE(torch::equal(batch.target.classes[b], CroppedPixels(whole.classes, box, multiple)[0]));
      lefts.insert(box.x);
    }
    EXPECT_EQ(batch.target.pose.size(3), batch.Whole().width * multiple);
  }
  EXPECT_EQ(lefts.size(), 2U);
}

TEST(GuidedTraining, LearnsAPairByHeart) {
  TrainGuidedOptions options = ToyOptions("guided_learns");
  // One person in two poses: it is tested on what it has learned.
  options.validation = ToyPeople(1, 2);
  options.steps = 260;
  options.batch = 2;
  options.learning_rate = 5e-3;
  options.gan_share = 0;
  options.validate_every = 260;
  std::vector<GuidedPreview> previews;
  options.preview = [&](int, const std::vector<GuidedPreview>& made) { previews = made; };
  const TrainGuidedSummary summary = TrainGuided(ToyPeople(1, 2), options);
  ASSERT_EQ(summary.status, TrainingStatus::kFinished) << summary.message;
  // An untrained network sees half a person everywhere, in grey.
  EXPECT_GT(summary.scores.silhouette_iou, 0.9);
  EXPECT_GT(summary.scores.label_iou, 0.7);
  EXPECT_LT(summary.scores.image_l1, 0.1);
  EXPECT_TRUE(summary.perceptual_random_features);
  ASSERT_EQ(summary.loss_weights.size(), 4U);
  EXPECT_EQ(summary.loss_weights[2], 0);  // nothing was judged
  ASSERT_EQ(previews.size(), 1U);
  EXPECT_EQ(previews[0].frame, 1);

  // The same networks from their file; two views fill what one leaves open, and the same pose is not drawn again.
  GuidedRenderer renderer(CheckpointPath(options.run_dir), options.config, {2, {}, 1});
  const std::vector<PhotoFrame> photos = {ToyPhotoFrame(0, ToyPoseOf(0), true), ToyPhotoFrame(0, {0, 0, true}, true)};
  EXPECT_THROW(renderer.Render(photos[0]), std::invalid_argument);
  renderer.SetSource(std::span(photos).first(1), {kTexelParts, kViews});
  EXPECT_EQ(renderer.virtual_images().size(), 6U);
  const RenderedPerson rendered = renderer.Render(ToyPhotoFrame(0, ToyPoseOf(1), false));
  PersonScorer scorer;
  scorer.Add(rendered, ToyPhotoFrame(0, ToyPoseOf(1), true));
  EXPECT_NEAR(scorer.Scores().image_l1, summary.scores.image_l1, 1e-6);
  EXPECT_EQ(renderer.Render(ToyPhotoFrame(0, ToyPoseOf(1), false)).image, rendered.image);
  EXPECT_EQ(renderer.frames_kept(), 1);
  int back_of_one = 0, back_of_two = 0, faces_behind = 0;
  const auto count = [&](int* back) {
    for (int t = 0; t < kToyTexels * kToyTexels; ++t) {
      if (t % 16 < 8) continue;
      *back += renderer.maps().from[t] == 2 ? 1 : 0;
      faces_behind += renderer.maps().labels[t] == 3 ? 1 : 0;
    }
  };
  count(&back_of_one);  // number 2 is the first virtual view: the front
  renderer.SetSource(photos, {kTexelParts, kViews});
  count(&back_of_two);  // number 2 is the second photo
  EXPECT_EQ(back_of_one, 0);
  EXPECT_EQ(back_of_two, 128);
  EXPECT_EQ(faces_behind, 0);
  EXPECT_EQ(renderer.Render(ToyPhotoFrame(0, {100, 0, false}, false)).alpha, std::vector<float>(1024, 0.0F));
}

TEST(GuidedTraining, AResumedRunEndsWithTheSameBytes) {
  // Spectral norm has a state of its own, as the loss weights have, which are still measured at the second stop.
  const struct {
    bool spectral;
    int balance_steps;
    GuidedConfig config;
  } cases[] = {{false, 3, ToyGuided()}, {true, 6, ToyGuided()}, {false, 3, ToyGuidedWithGuesses()}};
  for (const auto& [spectral, balance_steps, config] : cases) {
    TrainGuidedOptions whole = ToyOptions("guided_whole"), parts = ToyOptions("guided_parts");
    for (TrainGuidedOptions* options : {&whole, &parts}) {
      options->config = config;
      options->config.profile.spectral_norm = spectral;
      options->balance_steps = balance_steps;
    }
    ASSERT_EQ(TrainGuided(ToyPeople(3, 4), whole).status, TrainingStatus::kFinished);
    parts.progress = [](const TrainingProgress& progress) { return progress.step < 4; };
    const TrainGuidedSummary stopped = TrainGuided(ToyPeople(3, 4), parts);
    EXPECT_EQ(stopped.status, TrainingStatus::kStopped);
    EXPECT_EQ(stopped.steps, 4);
    parts.progress = nullptr;
    parts.resume = true;
    ASSERT_EQ(TrainGuided(ToyPeople(3, 4), parts).status, TrainingStatus::kFinished);
    EXPECT_EQ(FileBytes(CheckpointPath(parts.run_dir)), FileBytes(CheckpointPath(whole.run_dir))) << spectral;
  }
}

TEST(GuidedTraining, EveryAblationTrainsAndDraws) {
  for (const auto& parts : std::vector<std::vector<std::string>>{
           {"sil", "gar"}, {"sil"}, {"gar", "latent"}, {"kl", "uv-appearance"}, {"pseudo-image"}}) {
    TrainGuidedOptions options = ToyOptions("guided_without");
    for (const std::string& part : parts) LeaveOut(part, &options.config);
    options.steps = 5;
    options.predicted_from = 0.6;
    options.labels_by_cross_entropy = false;
    options.config.profile.spectral_norm = true;
    options.config.profile.one_hot_labels = false;
    const TrainGuidedSummary summary = TrainGuided(ToyPeople(2, 4), options);
    ASSERT_EQ(summary.status, TrainingStatus::kFinished) << parts[0] << ": " << summary.message;
    EXPECT_EQ(summary.scores.frames, 6) << parts[0];
    GuidedRenderer renderer(CheckpointPath(options.run_dir), options.config, {0, {}, 1});
    const PhotoFrame photo = ToyPhotoFrame(0, {}, true);
    renderer.SetSource(std::span(&photo, 1), {kTexelParts, kViews});
    EXPECT_EQ(renderer.virtual_images().empty(), !options.config.uv_appearance);
    for (const float value : renderer.Render(ToyPhotoFrame(0, {1, 1, false}, false)).image) {
      ASSERT_TRUE(value >= 0 && value <= 1);
    }
  }
}

/// Names of the losses of a run's metrics.csv that are 0 in its last row.
std::set<std::string> LossesAtZero(const std::string& run_dir) {
  std::set<std::string> zero;
  for (const auto& [name, value] : LastMetrics(run_dir)) {
    if (name != "step" && name.rfind("validation_", 0) != 0 && value == 0) zero.insert(name);
  }
  return zero;
}

/// L_Sil and L_Gar stand by themselves (eq. 3 and 6); the losses of RenderNet have λ_1 … λ_4 "empirically chosen that
/// all the losses have comparable scale": once measured all but the divergence are as large as L_rec.
TEST(GuidedTraining, LossesAreWeightedAsPublished) {
  const TrainGuidedOptions published;
  EXPECT_EQ(published.perceptual_share, 1);
  EXPECT_EQ(published.contextual_share, 1);
  EXPECT_EQ(published.gan_share, 1);
  EXPECT_EQ(published.kl_share, 0.01);
  TrainGuidedOptions options = ToyOptions("guided_weights");
  options.validation = {};
  options.steps = options.report_every = options.checkpoint_every = 4;
  options.balance_steps = 2;
  std::vector<double> totals;
  options.progress = [&](const TrainingProgress& progress) {
    totals.push_back(progress.At("loss"));
    return true;
  };
  const TrainGuidedSummary summary = TrainGuided(ToyPeople(2, 4), options);
  ASSERT_EQ(summary.status, TrainingStatus::kFinished);
  std::map<std::string, double> last = LastMetrics(options.run_dir);
  const std::vector<double>& weights = summary.loss_weights;
  ASSERT_EQ(weights.size(), 4U);
  const double render = last["image"] + weights[0] * last["perceptual"] + weights[1] * last["contextual"] +
                        weights[2] * last["generator"] + 0.01 * weights[3] * last["kl"];
  EXPECT_NEAR(last["render"], render, 1e-4 * render);
  EXPECT_NEAR(totals.back(), last["silhouette"] + last["labels"] + render, 1e-4 * totals.back());
}

TEST(GuidedTraining, AnAblationTakesAwayItsTermAlone) {
  const struct {
    std::vector<std::string> parts;
    std::set<std::string> zero;  ///< "outline": the silhouette that RenderNet draws where no other network does
  } cases[] = {{{}, {"outline"}},
               {{"sil"}, {"outline", "silhouette"}},
               {{"gar"}, {"outline", "labels"}},
               {{"sil", "gar"}, {"silhouette", "labels"}},
               {{"source-silhouette"}, {"outline"}},
               {{"source-labels"}, {"outline"}},
               {{"latent"}, {"outline", "kl"}},
               {{"kl"}, {"outline", "kl"}},
               {{"pseudo-image"}, {"outline"}},
               {{"uv-appearance"}, {"outline"}}};
  for (const auto& [parts, zero] : cases) {
    TrainGuidedOptions options = ToyOptions("guided_terms");
    for (const std::string& part : parts) LeaveOut(part, &options.config);
    EXPECT_EQ(LeftOut(options.config), parts);
    options.validation = {};
    options.steps = options.report_every = options.checkpoint_every = 4;
    options.balance_steps = 2;
    const TrainGuidedSummary summary = TrainGuided(ToyPeople(2, 4), options);
    ASSERT_EQ(summary.status, TrainingStatus::kFinished);
    const std::string name = parts.empty() ? "full" : parts.back();
    EXPECT_EQ(LossesAtZero(options.run_dir), zero) << name;
    ASSERT_EQ(summary.loss_weights.size(), 4U);
    for (size_t loss = 0; loss < 4; ++loss) {
      EXPECT_EQ(summary.loss_weights[loss] == 0, loss == 3 && zero.contains("kl")) << name << ", loss " << loss;
    }
  }
}

TEST(GuidedTraining, CompletesTheMapsByTheirNeighbours) {
  TrainGuidedOptions options = ToyOptions("guided_nearest");
  options.config = ToyGuidedWithGuesses();
  options.validation_views = nullptr;  // nobody draws them
  const PhotoSource people = ToyPeople(3, 4);
  const TrainGuidedSummary summary = TrainGuided(people, options);
  ASSERT_EQ(summary.status, TrainingStatus::kFinished) << summary.message;
  const TexelNeighbours neighbours(kToyTexels, people.texel_parts, people.texel_places);
  GuidedRenderer renderer(CheckpointPath(options.run_dir), options.config, {2, {}, 1});
  const PhotoFrame photo = ToyPhotoFrame(0, {}, true), pose = ToyPhotoFrame(0, {2, 1, true}, false);
  EXPECT_THROW(renderer.SetSource(std::span(&photo, 1), {kTexelParts, kViews}), std::invalid_argument)
      << "no neighbours";
  renderer.SetSource(std::span(&photo, 1), {kTexelParts, {}, &neighbours});
  EXPECT_TRUE(renderer.virtual_images().empty());
  for (const uint8_t from : renderer.maps().from) EXPECT_NE(from, 0);
  const RenderedPerson guessed = renderer.Render(pose);
  // The same networks and the paper's completion, and none.
  for (const MapCompletion completion : {MapCompletion::kVirtualViews, MapCompletion::kNone}) {
    GuidedRenderer other(CheckpointPath(options.run_dir), options.config, {2, completion, 1});
    other.SetSource(std::span(&photo, 1), {kTexelParts, kViews, &neighbours});
    EXPECT_EQ(other.virtual_images().empty(), completion == MapCompletion::kNone);
    EXPECT_NE(other.Render(pose).image, guessed.image);
  }
  PhotoSource placeless = people;
  placeless.texel_places.clear();
  EXPECT_THROW(TrainGuided(placeless, options), std::invalid_argument);
}

TEST(GuidedTraining, ALossThatIsNotANumberKeepsTheLastCheckpoint) {
  TrainGuidedOptions options = ToyOptions("guided_nan");
  options.checkpoint_every = 1;
  options.validation = {};
  options.steps = 60;
  PhotoSource people = ToyPeople(4, 3);
  people.fill = [](int person, int frame, PhotoFrame* out) {
    *out = ToyPhotoFrame(person, ToyPoseOf(frame), true);
    if (person == 3 && frame == 1) out->image[16 * kToySide + 16] = std::numeric_limits<float>::quiet_NaN();
  };
  const TrainGuidedSummary summary = TrainGuided(people, options);
  ASSERT_EQ(summary.status, TrainingStatus::kNotFinite);
  EXPECT_NE(summary.message.find("checkpoint.bin holds step " + std::to_string(summary.steps)), std::string::npos)
      << summary.message;
  if (summary.steps == 0) return;
  GuidedRenderer renderer(CheckpointPath(options.run_dir), options.config, {0, MapCompletion::kNone, 1});
  const PhotoFrame photo = ToyPhotoFrame(0, {}, true);
  renderer.SetSource(std::span(&photo, 1), {kTexelParts, {}});
  for (const float value : renderer.Render(photo).image) ASSERT_TRUE(std::isfinite(value));
}

TEST(GuidedTraining, RefusesWhatDoesNotFit) {
  TrainGuidedOptions options = ToyOptions("guided_refuses");
  EXPECT_THROW(TrainGuided({}, options), std::invalid_argument);
  options.batch = 0;
  EXPECT_THROW(TrainGuided(ToyPeople(1, 2), options), std::invalid_argument);
  options = ToyOptions("guided_refuses");
  options.steps = 1;
  options.validation = {};
  PhotoSource bare = ToyPeople(1, 2);
  bare.fill = [](int, int, PhotoFrame* out) { *out = ToyPhotoFrame(0, {}, false); };
  EXPECT_THROW(TrainGuided(bare, options), std::invalid_argument);
  ASSERT_EQ(TrainGuided(ToyPeople(1, 2), options).status, TrainingStatus::kFinished);
  const std::string path = CheckpointPath(options.run_dir);
  GuidedConfig other = ToyGuided();
  LeaveOut("gar", &other);
  EXPECT_THROW(GuidedRenderer(path, other, {0, {}, 1}), std::runtime_error);
  GuidedRenderer renderer(path, ToyGuided(), {0, {}, 1});
  const PhotoFrame photo = ToyPhotoFrame(0, {}, true), pose = ToyPhotoFrame(0, {}, false);
  const std::vector<uint8_t> few(4);
  EXPECT_THROW(renderer.SetSource({}, {kTexelParts, kViews}), std::invalid_argument);
  EXPECT_THROW(renderer.SetSource(std::span(&pose, 1), {kTexelParts, kViews}), std::invalid_argument);
  EXPECT_THROW(renderer.SetSource(std::span(&photo, 1), {kTexelParts, {}}), std::invalid_argument);
  EXPECT_THROW(renderer.SetSource(std::span(&photo, 1), {few, kViews}), std::invalid_argument);
  fs::resize_file(path, fs::file_size(path) / 2);
  try {
    GuidedRenderer broken(path, ToyGuided(), {0, {}, 1});
    FAIL() << "took half a checkpoint";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path, 0), 0U) << error.what();
  }
}

TEST(GuidedTraining, DoesTheSameOnACard) {
  if (!torch::cuda::is_available()) GTEST_SKIP() << "no CUDA card here";
  const TrainGuidedSummary here = TrainGuided(ToyPeople(3, 4), ToyOptions("guided_cpu"));
  TrainGuidedOptions options = ToyOptions("guided_cuda");
  options.device = "cuda";
  const TrainGuidedSummary there = TrainGuided(ToyPeople(3, 4), options);
  ASSERT_EQ(there.status, TrainingStatus::kFinished) << there.message;
  EXPECT_NEAR(there.scores.image_l1, here.scores.image_l1, 1e-3);
  UseNeuralDevice("cpu");
}

}  // namespace
}  // namespace bodyloom::guided_training_test
