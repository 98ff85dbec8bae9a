// SPDX-License-Identifier: Apache-2.0
// Training of the one-photo renderer on toy people, and rendering.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/cuda.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>

#include "geometry/base/check.h"
#include "neural/base/runtime.h"
#include "neural/networks/sphereface.h"
#include "neural/photo/photo_renderer.h"
#include "neural/photo/photo_window.h"
#include "tests/neural/photo/toy_photo_training.h"
#include "tests/neural/training/last_metrics.h"

namespace bodyloom::photo_training_test {
namespace {

using ::testing::HasSubstr;

TEST(PhotoTraining, LearnsTwoPeopleByHeart) {
  const PhotoSource source = ToyPhotos(2, 2);
  TrainPhotoOptions options = ToyOptions("photo_learns");
  options.validation = {0, 1};
  options.validation_pairs = 2;
  options.steps = 400;
  options.learning_rate = 5e-3;
  options.gan_weight = 0;
  options.validate_every = options.checkpoint_every = 400;
  std::vector<PhotoPreview> previews;
  options.preview = [&](int, const std::vector<PhotoPreview>& made) { previews = made; };
  const TrainPhotoSummary summary = TrainPhoto(source, options);
  ASSERT_EQ(summary.status, TrainingStatus::kFinished) << summary.message;
  EXPECT_EQ(summary.scores.frames, 4);
  // An untrained network paints grey, 0.25 off, and is half transparent everywhere.
  EXPECT_LT(summary.scores.image_l1, 0.1);
  EXPECT_GT(summary.scores.silhouette_iou, 0.95);
  EXPECT_TRUE(summary.perceptual_random_features);
  ASSERT_EQ(summary.losses_off.size(), 1U);
  EXPECT_THAT(summary.losses_off[0], HasSubstr("SphereFace"));
  ASSERT_EQ(previews.size(), 4U);

  // The same network from its file: the completed texture keeps the colours of what the source picture shows.
  PhotoRenderer renderer(CheckpointPath(options.run_dir), options.config, {options.reach, 1});
  PhotoFrame front, back;
  source.fill(1, 0, &front);
  source.fill(1, 1, &back);
  EXPECT_THROW((void)renderer.Render(back), std::invalid_argument) << "nobody to render";
  renderer.Encode(PartialTextureOf(front));
  const std::vector<float> completed = renderer.CompletedTexture();
  double error = 0;
  for (int r = 0; r < kToyTexture; ++r) {
    for (int c = 0; c < kToyTexture / 2; ++c) {
      const float u = (static_cast<float>(c) + 0.5F) / kToyTexture,
                  v = 1 - (static_cast<float>(r) + 0.5F) / kToyTexture;
      for (int channel = 0; channel < 3; ++channel) {
        error += std::abs(completed[(channel * kToyTexture + r) * kToyTexture + c] - ToyColour(1, u, v, channel));
      }
    }
  }
  EXPECT_LT(error / (1.5 * kToyTexture * kToyTexture), 0.1);
  const RenderedPerson rendered = renderer.Render(back);
  for (const PhotoPreview& preview : previews) {
    if (preview.pair.person != 1 || preview.pair.source != 0) continue;
    EXPECT_EQ(preview.rendered.image, rendered.image) << "training's validation rendered another image";
  }
}

TEST(PhotoTraining, AResumedRunEndsWithTheSameBytes) {
  const PhotoSource source = ToyPhotos(3, 3);
  // kInpaint has two stages: one run is stopped in the first, one in the second. The discriminator joins before the
  // stop, right at it, and after it.
  const struct {
    PhotoVariant variant;
    int stop;
    double gan_from;
  } cases[] = {{PhotoVariant::kFull, 3, 0},
               {PhotoVariant::kFull, 3, 0.5},
               {PhotoVariant::kFull, 3, 0.8},
               {PhotoVariant::kInpaint, 3, 0.5},
               {PhotoVariant::kInpaint, 9, 0}};
  for (const auto& [variant, stop, gan_from] : cases) {
    SCOPED_TRACE(Concatenate(ToText(variant), " stopped at ", stop, ", judged from ", gan_from));
    TrainPhotoOptions whole = ToyOptions("photo_whole", variant);
    whole.gan_from = gan_from;
    ASSERT_EQ(TrainPhoto(source, whole).status, TrainingStatus::kFinished);
    TrainPhotoOptions parts = ToyOptions("photo_parts", variant);
    parts.gan_from = gan_from;
    parts.progress = [stop = stop](const TrainingProgress& progress) { return progress.step < stop; };
    const TrainPhotoSummary stopped = TrainPhoto(source, parts);
    EXPECT_EQ(stopped.status, TrainingStatus::kStopped);
    EXPECT_EQ(stopped.steps, stop);
    parts.progress = nullptr;
    parts.resume = true;
    const TrainPhotoSummary finished = TrainPhoto(source, parts);
    ASSERT_EQ(finished.status, TrainingStatus::kFinished);
    EXPECT_EQ(finished.steps, whole.TotalSteps());
    EXPECT_EQ(FileBytes(CheckpointPath(parts.run_dir)), FileBytes(CheckpointPath(whole.run_dir)));
  }
}

/// λ_VGG = 10, λ_face = 5, λ_tex = λ_GAN = 1 (Section 3.5), and alpha's loss, which is not in the paper; Adam at 2e-4.
TEST(PhotoTraining, LossesAreWeightedAsPublished) {
  const TrainPhotoOptions published;
  EXPECT_EQ(published.perceptual_weight, 10);
  EXPECT_EQ(published.face_weight, 5);
  EXPECT_EQ(published.texture_weight, 1);
  EXPECT_EQ(published.gan_weight, 1);
  EXPECT_EQ(published.alpha_weight, 1);
  EXPECT_EQ(published.learning_rate, 2e-4);
  TrainPhotoOptions options = ToyOptions("photo_weights");
  options.validation.clear();
  options.gan_from = 0;
  ASSERT_EQ(TrainPhoto(ToyPhotos(2, 3), options).status, TrainingStatus::kFinished);
  std::map<std::string, double> last = LastMetrics(options.run_dir);
  for (const char* term : {"perceptual", "texture", "generator", "alpha"}) EXPECT_GT(last[term], 0) << term;
  const double loss = 10 * last["perceptual"] + last["texture"] + last["generator"] + last["alpha"];
  EXPECT_NEAR(last["loss"], loss, 1e-4 * loss);
}

TEST(PhotoTraining, TheDiscriminatorJoinsWhenItIsTold) {
  const PhotoSource source = ToyPhotos(2, 3);
  /// The checkpoint after six steps, and the cells of metrics.csv under "discriminator".
  const auto train = [&](double gan_from, double gan_weight, std::vector<std::string>* cells) {
    TrainPhotoOptions options = ToyOptions("photo_joins");
    options.validation.clear();
    options.gan_from = gan_from;
    options.gan_weight = gan_weight;
    options.report_every = 1;
    EXPECT_EQ(TrainPhoto(source, options).status, TrainingStatus::kFinished);
    std::istringstream lines(FileBytes(options.run_dir + "/metrics.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_THAT(line, HasSubstr("step,learning_rate,loss,perceptual,face,texture,generator,alpha,discriminator"));
    while (std::getline(lines, line)) {
      std::istringstream columns(line);
      for (int i = 0; i < 9; ++i) std::getline(columns, line, ',');
      cells->push_back(line);
    }
    return FileBytes(CheckpointPath(options.run_dir));
  };
  std::vector<std::string> first, half, never, none;
  const std::string from_first = train(0, 1, &first), from_half = train(0.5, 1, &half),
                    from_never = train(1, 1, &never);
  EXPECT_EQ(std::count(first.begin(), first.end(), ""), 0);
  ASSERT_EQ(half.size(), 6U);
  for (int step = 0; step < 6; ++step) EXPECT_EQ(half[step].empty(), step < 3) << step;
  EXPECT_EQ(std::count(never.begin(), never.end(), ""), 6);
  EXPECT_NE(from_first, from_half);
  EXPECT_NE(from_half, from_never);
  EXPECT_EQ(from_never, train(0, 0, &none)) << "one that never joins is none";
  TrainPhotoOptions options = ToyOptions("photo_joins", PhotoVariant::kInpaint);
  EXPECT_EQ(options.FirstJudgedStep(), 9) << "half of the second stage";
  options.gan_from = 0;
  EXPECT_EQ(options.FirstJudgedStep(), 6);
}

TEST(PhotoTraining, EveryVariantTrainsAndWorks) {
  const PhotoSource source = ToyPhotos(3, 3);
  for (const PhotoVariant variant : {PhotoVariant::kNoInt, PhotoVariant::kWarp, PhotoVariant::kWarpCond}) {
    SCOPED_TRACE(ToText(variant));
    TrainPhotoOptions options = ToyOptions("photo_variant", variant);
    options.steps = 2;
    const TrainPhotoSummary summary = TrainPhoto(source, options);
    ASSERT_EQ(summary.status, TrainingStatus::kFinished);
    EXPECT_EQ(summary.losses_off.size(), variant == PhotoVariant::kNoInt ? 2U : 1U);
    PhotoRenderer renderer(CheckpointPath(options.run_dir), options.config, {2, 1});
    PhotoFrame frame;
    source.fill(2, 0, &frame);
    renderer.Encode(PartialTextureOf(frame));
    EXPECT_EQ(renderer.CompletedTexture().size(), 3U * kToyTexture * kToyTexture);
    for (const float value : renderer.Render(frame).image) ASSERT_TRUE(value >= 0 && value <= 1);
  }
}

TEST(PhotoTraining, InpaintingTrainsOneNetworkAfterTheOther) {
  const PhotoSource source = ToyPhotos(2, 3);
  TrainPhotoOptions options = ToyOptions("photo_stages", PhotoVariant::kInpaint);
  options.validation.clear();
  options.inpaint_steps = 3;
  ASSERT_EQ(options.TotalSteps(), 9);
  PhotoFrame frame;
  source.fill(0, 0, &frame);
  std::vector<std::vector<float>> textures, images;
  const auto look = [&] {
    PhotoRenderer renderer(CheckpointPath(options.run_dir), options.config, {2, 1});
    renderer.Encode(PartialTextureOf(frame));
    textures.push_back(renderer.CompletedTexture());
    images.push_back(renderer.Render(frame).image);
  };
  for (const int stop : {3, 6, 9}) {
    options.progress = [stop](const TrainingProgress& progress) { return progress.step < stop; };
    (void)TrainPhoto(source, options);
    look();
    options.resume = true;
  }
  EXPECT_EQ(textures[0], textures[1]) << "the first network was not fixed";
  EXPECT_EQ(textures[1], textures[2]);
  EXPECT_NE(images[0], images[1]) << "the second network did not learn";
}

/// The face's column of a run's metrics.csv, summed.
double FaceLossOf(const std::string& run_dir) {
  std::istringstream lines(FileBytes(run_dir + "/metrics.csv"));
  std::string line;
  std::getline(lines, line);
  const auto cell = [](const std::string& row, int column) {
    std::istringstream cells(row);
    std::string value;
    for (int c = 0; c <= column; ++c) std::getline(cells, value, ',');
    return value;
  };
  int column = 0;
  while (cell(line, column) != "face") ++column;
  double sum = 0;
  while (std::getline(lines, line)) sum += std::stod(cell(line, column));
  return sum;
}

TEST(PhotoTraining, FacesCountThatLookAtTheCamera) {
  torch::manual_seed(5);
  for (const int side : {0, 1}) {  // the toy's fronts, its backs
    PhotoSource source = ToyPhotos(3, 3);
    source.texel_parts.assign(source.texel_parts.size(), 23);
    source.fill = [side](int person, int frame, PhotoFrame* photo) {
      FillToyPhoto(person, 2 * frame + side, photo);
      for (uint8_t& part : photo->parts) part = part != 0 ? 23 : 0;
    };
    TrainPhotoOptions options = ToyOptions("photo_faces");
    options.steps = options.report_every = options.checkpoint_every = options.validate_every = 1;
    options.sphereface = {ExportWeights(*SphereFace()), "faces.pth"};
    ASSERT_EQ(TrainPhoto(source, options).status, TrainingStatus::kFinished);
    EXPECT_EQ(FaceLossOf(options.run_dir) > 0, side == 0);
  }
}

TEST(PhotoTraining, ALossThatIsNotANumberKeepsTheLastCheckpoint) {
  PhotoSource source = ToyPhotos(2, 8);
  source.fill = [](int person, int frame, PhotoFrame* photo) {
    FillToyPhoto(person, frame, photo);
    if (person == 1 && frame == 7) photo->image[30 * kToySize + 30] = std::numeric_limits<float>::quiet_NaN();
  };
  TrainPhotoOptions options = ToyOptions("photo_nan");
  options.checkpoint_every = 1;
  options.validation.clear();
  options.steps = 60;
  const TrainPhotoSummary summary = TrainPhoto(source, options);
  ASSERT_EQ(summary.status, TrainingStatus::kNotFinite);
  ASSERT_GT(summary.steps, 0);
  EXPECT_THAT(summary.message, HasSubstr("checkpoint.bin holds step " + std::to_string(summary.steps)));
  PhotoRenderer renderer(CheckpointPath(options.run_dir), options.config, {2, 1});
  PhotoFrame frame;
  source.fill(0, 0, &frame);
  renderer.Encode(PartialTextureOf(frame));
  for (const float value : renderer.Render(frame).image) ASSERT_TRUE(std::isfinite(value));
}

TEST(PhotoTraining, RefusesWhatDoesNotFit) {
  const PhotoSource source = ToyPhotos(3, 3);
  const auto refuses = [&](auto change) {
    TrainPhotoOptions options = ToyOptions("photo_refuses");
    change(&options);
    EXPECT_THROW(TrainPhoto(source, options), std::invalid_argument);
  };
  refuses([](TrainPhotoOptions* o) { o->train.clear(); });
  refuses([](TrainPhotoOptions* o) { o->train = {3}; });
  refuses([](TrainPhotoOptions* o) { o->validation = {-1}; });
  refuses([](TrainPhotoOptions* o) { o->config.profile.image_size = 128; });
  refuses([](TrainPhotoOptions* o) { o->steps = 0; });
  refuses([](TrainPhotoOptions* o) { o->gan_weight = NAN; });
  refuses([](TrainPhotoOptions* o) { o->gan_from = 1.5; });
  refuses([](TrainPhotoOptions* o) { o->gan_from = NAN; });

  TrainPhotoOptions options = ToyOptions("photo_refuses");
  options.steps = 1;
  options.validation.clear();
  ASSERT_EQ(TrainPhoto(source, options).status, TrainingStatus::kFinished);
  const std::string path = CheckpointPath(options.run_dir);
  const auto fails = [&](const PhotoConfig& config) {
    try {
      const PhotoRenderer renderer(path, config, {2, 1});
      ADD_FAILURE() << "took it";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).rfind(path, 0), 0U) << error.what();
    }
  };
  fails(ToyPhotoConfig(PhotoVariant::kNoInt));  // the same shapes, another meaning
  fails(ToyPhotoConfig(PhotoVariant::kWarp));
  PhotoConfig other = ToyPhotoConfig();
  other.profile.render_width = 8;
  fails(other);
  // A renderer is for pictures of its size.
  PhotoRenderer renderer(path, options.config, {2, 1});
  PhotoFrame frame;
  source.fill(0, 0, &frame);
  PartialTexture texture = PartialTextureOf(frame);
  renderer.Encode(texture);
  frame.size = 32;
  EXPECT_THROW((void)renderer.Render(frame), std::invalid_argument);
  texture.size = 8;
  EXPECT_THROW(renderer.Encode(texture), std::invalid_argument);
  // A file cut off anywhere.
  const std::string whole = FileBytes(path);
  for (size_t size = 0; size < whole.size(); size += whole.size() / 23 + 1) {
    std::ofstream(path, std::ios::binary | std::ios::trunc).write(whole.data(), static_cast<std::streamsize>(size));
    fails(options.config);
  }
}

TEST(PhotoRenderer, ComputesOnlyWhatIsNearTheBody) {
  const PhotoSource source = ToyPhotos(2, 3);
  TrainPhotoOptions options = ToyOptions("photo_window");
  options.steps = 1;
  options.validation.clear();
  ASSERT_EQ(TrainPhoto(source, options).status, TrainingStatus::kFinished);
  const std::string path = CheckpointPath(options.run_dir);
  PhotoRenderer near(path, options.config, {2, 1}), everywhere(path, options.config, {-1, 1});
  PhotoFrame frame;
  source.fill(0, 1, &frame);
  near.Encode(PartialTextureOf(frame));
  everywhere.Encode(PartialTextureOf(frame));
  const RenderedPerson cut = near.Render(frame), whole = everywhere.Render(frame);
  const PhotoWindow window = WindowAround(frame, 2, options.config.SmallestSide());
  ASSERT_LT(window.width, kToySize);
  for (int y = 0; y < kToySize; ++y) {
    for (int x = 0; x < kToySize; ++x) {
      const size_t i = static_cast<size_t>(y) * kToySize + x;
      const bool inside = x >= window.x && x < window.x + window.width && y >= window.y && y < window.y + window.height;
      // An untrained network is half transparent everywhere.
      ASSERT_EQ(cut.alpha[i] > 0, inside) << x << ' ' << y;
      ASSERT_GT(whole.alpha[i], 0);
    }
  }
  frame.parts.assign(frame.parts.size(), 0);
  const RenderedPerson nobody = near.Render(frame);
  EXPECT_EQ(*std::max_element(nobody.alpha.begin(), nobody.alpha.end()), 0);
}

TEST(PhotoTraining, DoesTheSameOnACard) {
  if (!torch::cuda::is_available()) GTEST_SKIP() << "no CUDA card here";
  const PhotoSource source = ToyPhotos(3, 2);
  const TrainPhotoSummary here = TrainPhoto(source, ToyOptions("photo_cpu"));
  TrainPhotoOptions options = ToyOptions("photo_cuda");
  options.device = "cuda";
  const TrainPhotoSummary there = TrainPhoto(source, options);
  ASSERT_EQ(there.status, TrainingStatus::kFinished) << there.message;
  EXPECT_NEAR(there.scores.image_l1, here.scores.image_l1, 1e-3);
  PhotoFrame frame;
  source.fill(1, 0, &frame);
  RenderedPerson images[2];
  for (const char* device : {"cpu", "cuda"}) {
    PhotoRenderer renderer(CheckpointPath(options.run_dir), options.config, {2, 1, device});
    renderer.Encode(PartialTextureOf(frame));
    images[device[1] == 'u'] = renderer.Render(frame);
  }
  EXPECT_THAT(images[1].image, ::testing::Pointwise(::testing::FloatNear(1e-3F), images[0].image));
  UseNeuralDevice("cpu");
}

}  // namespace
}  // namespace bodyloom::photo_training_test
