// SPDX-License-Identifier: Apache-2.0
// Parts of the pose-guided renderer without networks: pose maps, masking in training, coherent maps.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "neural/base/image_tensor.h"
#include "neural/guided/choose_photos.h"
#include "neural/guided/complete_maps.h"
#include "neural/guided/guided_batches.h"
#include "neural/metrics/lpips.h"
#include "neural/metrics/person_scores.h"
#include "render/texture/complete/body_part_map.h"
#include "tests/neural/guided/guided_toy.h"
#include "tests/neural/metrics/named_features.h"

namespace bodyloom::guided_maps_test {
namespace {

TEST(BodyPartMap, LeftAndRightAreTheSameLimb) {
  // DensePose's charts 0 to 24.
  const int limbs[] = {0, 1, 1, 3, 3, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6, 7, 7, 7, 7, 8, 8, 8, 8, 2, 2};
  for (int chart = 0; chart < 25; ++chart) EXPECT_EQ(LimbOf(chart), limbs[chart]) << chart;
  EXPECT_EQ(LimbOf(23), kHeadLimb);
  EXPECT_THROW(LimbOf(25), std::invalid_argument);
}

TEST(BodyPartMap, FourteenPartsThatAreFarApart) {
  std::set<int> parts;
  for (int chart = 1; chart < 25; ++chart) parts.insert(BodyPartOf(chart));
  EXPECT_EQ(parts.size(), 14U);
  EXPECT_FALSE(parts.contains(0));
  EXPECT_EQ(BodyPartOf(0), 0);
  // Front and back of the torso, both halves of the head; right and left are different parts.
  EXPECT_EQ(BodyPartOf(1), BodyPartOf(2));
  EXPECT_EQ(BodyPartOf(23), BodyPartOf(24));
  for (const auto& [a, b] : {std::pair{3, 4}, {5, 6}, {7, 8}, {11, 12}, {15, 16}, {19, 20}}) {
    EXPECT_NE(BodyPartOf(a), BodyPartOf(b));
  }
  EXPECT_EQ(BodyPartOf(7), BodyPartOf(9));
  EXPECT_EQ(BodyPartOf(15), BodyPartOf(17));
  for (int a = 0; a < kBodyParts; ++a) {
    for (int b = 0; b < a; ++b) {
      float largest = 0;
      for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(BodyPartColour(a)[c] - BodyPartColour(b)[c]));
      EXPECT_GE(largest, 0.5F) << a << " and " << b;
    }
  }
  const std::vector<uint8_t> charts = {0, 2, 4};
  const std::vector<float> map = BodyPartMap(charts);
  ASSERT_EQ(map.size(), 9U);
  EXPECT_EQ(map[0] + map[3] + map[6], 0);
  EXPECT_EQ(map[1] + map[4] + map[7], 3);
  EXPECT_THROW(BodyPartMap(std::vector<uint8_t>{25}), std::invalid_argument);
}

TEST(GuidedPlan, SamplesAreFunctionsOfTheStep) {
  PhotoSource source;
  source.num_frames = {5, 1, 3};
  const std::vector<int>& frames = source.num_frames;
  std::set<int> people;
  std::set<std::pair<int, int>> pairs;
  for (int64_t step = 0; step < 400; ++step) {
    const GuidedSample a = GuidedSampleOf(7, step, 1, source), b = GuidedSampleOf(7, step, 1, source);
    EXPECT_EQ(a.person, b.person);
    EXPECT_EQ(a.source, b.source);
    EXPECT_EQ(a.target, b.target);
    EXPECT_LT(a.target, frames[a.person]);
    EXPECT_EQ(a.source == a.target, frames[a.person] == 1);
    people.insert(a.person);
    if (a.person == 0) pairs.insert({a.source, a.target});
  }
  EXPECT_EQ(people.size(), 3U);
  EXPECT_EQ(pairs.size(), 20U);
  EXPECT_THROW(GuidedSampleOf(1, 0, 0, {}), std::invalid_argument);
}

TEST(GuidedPlan, ATargetIsOfAnotherPoseAndAnotherView) {
  PhotoSource source;
  source.num_frames = {6};
  source.places = {{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}}};  // three poses in two views
  std::set<std::pair<int, int>> pairs;
  for (int64_t step = 0; step < 400; ++step) {
    const GuidedSample sample = GuidedSampleOf(7, step, 0, source);
    EXPECT_NE(sample.source % 3, sample.target % 3) << "the same pose";
    EXPECT_NE(sample.source / 3, sample.target / 3) << "the same view";
    pairs.insert({sample.source, sample.target});
  }
  EXPECT_EQ(pairs.size(), 12U) << "all that differ in both are drawn";
}

TEST(GuidedPlan, OnlyTheBareBodyIsKnownAndNotAllOfIt) {
  const PhotoFrame frame = ToyPhotoFrame(0, {}, true);
  int body = 0, known_in_all = 0, whole = 0;
  for (const uint8_t part : frame.parts) body += part != 0 ? 1 : 0;
  std::set<std::vector<uint8_t>> masks;
  for (int64_t step = 0; step < 100; ++step) {
    const std::vector<uint8_t> known = KnownPixels(3, step, 0, kToySide, frame.parts);
    EXPECT_EQ(known, KnownPixels(3, step, 0, kToySide, frame.parts));
    int count = 0;
    for (size_t i = 0; i < known.size(); ++i) {
      if (known[i] == 0) continue;
      ++count;
      EXPECT_NE(frame.parts[i], 0);
    }
    known_in_all += count;
    whole += count == body ? 1 : 0;
    masks.insert(known);
  }
  EXPECT_GT(masks.size(), 60U);
  EXPECT_GT(whole, 0);
  EXPECT_LT(whole, 40);
  EXPECT_GT(known_in_all, 100 * body / 3);
  EXPECT_LT(known_in_all, 100 * body * 9 / 10);
}

TEST(CoherentMaps, AColourStaysTheSameWhereverThePersonGoes) {
  const PhotoFrame source = ToyPhotoFrame(4, {}, true);
  CoherentMaps maps = EmptyMaps(kToyTexels, ToyTexelParts());
  EXPECT_EQ(FillEmptyTexels(source, OwnImage(source), 1, {}, &maps), 128);
  // Moved by whole pixels, the pixel of a point is the pixel of that point in every frame.
  std::vector<PseudoImage> images;
  for (const auto& [dx, dy] : {std::pair{0, 0}, {3, 2}, {-4, 1}, {5, -3}}) {
    const PhotoFrame frame = ToyPhotoFrame(4, {dx, dy, false}, true);
    images.push_back(LookUp(maps, frame));
    const PseudoImage& shown = images.back();
    for (int y = 6; y < 26; ++y) {
      for (int x = 8; x < 24; ++x) {
        const int here = (y + dy) * kToySide + x + dx, first = y * kToySide + x;
        EXPECT_EQ(shown.known[here], images[0].known[first]);
        EXPECT_EQ(shown.labels[here], images[0].labels[first]);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(shown.image[c * 1024 + here], images[0].image[c * 1024 + first], 2e-7);
        }
        if (frame.parts[here] == 0) {
          EXPECT_EQ(shown.known[here], 0);
        }
      }
    }
  }
  // And it is the colour that the photo has there.
  double error = 0;
  int count = 0;
  for (int i = 0; i < 1024; ++i) {
    if (images[0].known[i] == 0) continue;
    ++count;
    for (int c = 0; c < 3; ++c) error += std::abs(images[0].image[c * 1024 + i] - source.image[c * 1024 + i]);
    EXPECT_TRUE(images[0].labels[i] == source.labels[i] || source.labels[i + 32] != source.labels[i] ||
                source.labels[i - 32] != source.labels[i]);
  }
  EXPECT_EQ(count, 64 + 144);
  EXPECT_LT(error / (3 * count), 0.03);
}

TEST(CoherentMaps, TheFirstImageOfATexelStays) {
  const PhotoFrame front = ToyPhotoFrame(1, {}, true), behind = ToyPhotoFrame(2, {2, 1, true}, true);
  const PhotoFrame other = ToyPhotoFrame(3, {1, 1, false}, true);
  CoherentMaps maps = EmptyMaps(kToyTexels, ToyTexelParts());
  FillEmptyTexels(front, OwnImage(front), 1, {}, &maps);
  const CoherentMaps before = maps;
  EXPECT_EQ(FillEmptyTexels(other, OwnImage(other), 2, {}, &maps), 0);
  EXPECT_EQ(maps.appearance, before.appearance);
  // Two views: the union.
  EXPECT_EQ(FillEmptyTexels(behind, OwnImage(behind), 3, {}, &maps), 128);
  for (int t = 0; t < 256; ++t) {
    EXPECT_EQ(maps.from[t], t % 16 < 8 ? 1 : 3);
    if (before.from[t] != 0) {
      EXPECT_EQ(maps.appearance[t], before.appearance[t]);
    }
  }
  // Texels of the person that the photo does not show remain empty.
  PhotoFrame empty = front;
  empty.labels.assign(empty.labels.size(), 0);
  CoherentMaps none = EmptyMaps(kToyTexels, ToyTexelParts());
  EXPECT_EQ(FillEmptyTexels(empty, OwnImage(empty), 1, {}, &none), 0);
  EXPECT_THROW(FillEmptyTexels(ToyPhotoFrame(0, {}, false), RenderedPerson{}, 1, {}, &none), std::invalid_argument);
}

/// Draws what it was given, as if nothing were to be completed.
RenderedPerson Repeat(const PhotoFrame& frame, const PseudoImage& pseudo) {
  RenderedPerson rendered{frame.size, pseudo.image, std::vector<float>(pseudo.known.size()), pseudo.labels};
  for (size_t i = 0; i < pseudo.known.size(); ++i) rendered.alpha[i] = pseudo.known[i] != 0 ? 1.0F : 0.0F;
  return rendered;
}

TEST(CompleteMaps, TheBackIsTheFrontWithoutItsFace) {
  const PhotoFrame source = ToyPhotoFrame(1, {1, 1, false}, true);
  CoherentMaps maps = EmptyMaps(kToyTexels, ToyTexelParts());
  FillEmptyTexels(source, OwnImage(source), 1, {}, &maps);
  const std::vector<RenderedPerson> images = CompleteMaps(ToyViews(), Repeat, 2, &maps);
  ASSERT_EQ(images.size(), 6U);
  int back = 0, shirt = 0, hair = 0, faces = 0;
  for (int r = 0; r < kToyTexels; ++r) {
    for (int c = 0; c < kToyTexels; ++c) {
      const int t = r * kToyTexels + c;
      faces += maps.labels[t] == 3 ? 1 : 0;
      EXPECT_EQ(maps.from[t], c < 8 ? 1 : 3);  // the back view is number 2 + 1
      if (c < 8) continue;
      ++back;
      EXPECT_NE(maps.labels[t], 3);
      shirt += maps.labels[t] == 1 ? 1 : 0;
      hair += maps.labels[t] == 4 ? 1 : 0;
      if (r < 8 || r == 13 || r == 14) continue;  // head; where shirt and skin meet, the colours mix
      // A texel of the back lies behind the one of the front that has the same place across the body.
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(maps.appearance[k * 256 + t], maps.appearance[k * 256 + t - 8], 0.03) << r << " " << c;
      }
    }
  }
  EXPECT_EQ(back, 128);
  EXPECT_EQ(hair, 64);
  EXPECT_EQ(shirt, 48);
  EXPECT_GT(faces, 30);
}

TEST(CompleteMaps, NobodyPutsAFaceOnTheBack) {
  // A parser that takes the back of a head for a face.
  PhotoFrame behind = ToyPhotoFrame(1, {0, 0, true}, true);
  for (uint8_t& label : behind.labels) {
    if (label == 4) label = 3;
  }
  const std::vector<PhotoFrame> views = ToyViews();
  const std::vector<uint8_t> no_face = TexelsOfTheBack(views[kViewFront], views[kViewBack]);
  CoherentMaps maps = EmptyMaps(kToyTexels, ToyTexelParts());
  EXPECT_EQ(FillEmptyTexels(behind, OwnImage(behind), 1, no_face, &maps), 64);
  const auto all_face = [](const PhotoFrame& frame, const PseudoImage& pseudo) {
    RenderedPerson rendered = Repeat(frame, pseudo);
    for (size_t i = 0; i < rendered.labels.size(); ++i) {
      if (frame.parts[i] == 0) continue;
      rendered.labels[i] = 3;
      rendered.alpha[i] = 1;
    }
    return rendered;
  };
  CompleteMaps(views, all_face, 2, &maps);
  int faces_in_front = 0;
  for (int t = 0; t < 256; ++t) {
    if (t % 16 >= 8) {
      EXPECT_NE(maps.labels[t], 3);
      EXPECT_NE(maps.from[t], 0) << "what the mirrored front gave stays";
    } else {
      faces_in_front += maps.labels[t] == 3 ? 1 : 0;
    }
  }
  EXPECT_EQ(faces_in_front, 128);
  EXPECT_THROW(CompleteMaps(std::span(views).first(5), Repeat, 2, &maps), std::invalid_argument);
}

TEST(CompleteMaps, WithoutHairTheBackOfTheHeadIsSkin) {
  PhotoFrame front = ToyPhotoFrame(1, {}, true);
  for (uint8_t& label : front.labels) {
    if (label == 4) label = 3;
  }
  CoherentMaps maps = EmptyMaps(kToyTexels, ToyTexelParts());
  const PhotoFrame behind = ToyPhotoFrame(1, {0, 0, true}, false);
  const PseudoImage back = MirroredFront(ToyPhotoFrame(1, {}, false), OwnImage(front), behind, maps);
  int skin = 0;
  for (size_t i = 0; i < back.labels.size(); ++i) {
    EXPECT_NE(back.labels[i], 3);
    EXPECT_NE(back.labels[i], 4);
    skin += back.labels[i] == 5 && i < size_t{14} * kToySide ? 1 : 0;
  }
  EXPECT_EQ(skin, 64);
  // Unless a photo showed some of its back.
  maps.labels[9] = 4, maps.from[9] = 1;
  for (int k = 0; k < 3; ++k) maps.appearance[k * kToyTexels * kToyTexels + 9] = 0.25F * static_cast<float>(k + 1);
  const PseudoImage haired = MirroredFront(ToyPhotoFrame(1, {}, false), OwnImage(front), behind, maps);
  int hair = 0;
  for (size_t i = 0; i < haired.labels.size(); ++i) {
    if (haired.labels[i] != 4) continue;
    ++hair;
    for (int k = 0; k < 3; ++k) EXPECT_FLOAT_EQ(haired.image[k * 1024 + i], 0.25F * static_cast<float>(k + 1));
  }
  EXPECT_EQ(hair, 64);
}

TEST(ChoosePhotos, AFaceFirstThenWhatIsMissing) {
  PhotoSource people = ToyPeople(1, 4);
  people.fill = [](int, int frame, PhotoFrame* out) {
    // From behind; half out of the window; whole; whole again.
    const ToyPose poses[4] = {{0, 0, true}, {14, 0, false}, {0, 0, false}, {1, 0, false}};
    *out = ToyPhotoFrame(0, poses[frame], true);
  };
  EXPECT_EQ(ChoosePhotos(people, 0, 1), (std::vector<int>{2}));
  EXPECT_EQ(ChoosePhotos(people, 0, 2), (std::vector<int>{2, 0}));
  EXPECT_EQ(ChoosePhotos(people, 0, 9).size(), 4U);
}

TEST(GuidedScores, AreWhatTheyShouldBe) {
  const PhotoFrame truth = ToyPhotoFrame(1, {}, true);
  RenderedPerson rendered = OwnImage(truth);
  PersonScorer perfect(LikenessScoring()), off;
  perfect.Add(rendered, truth);
  EXPECT_EQ(perfect.Scores().image_l1, 0);
  EXPECT_EQ(perfect.Scores().silhouette_iou, 1);
  EXPECT_EQ(perfect.Scores().label_iou, 1);
  EXPECT_NEAR(perfect.Scores().lpips, 0, 1e-9);
  // A quarter lighter on the person, all of it shirt, and as many pixels again taken for the person.
  double people = 0, shirt = 0;
  for (size_t i = 0; i < rendered.labels.size(); ++i) {
    if (truth.labels[i] == 0) continue;
    people += 1;
    shirt += truth.labels[i] == 1 ? 1 : 0;
    rendered.labels[i] = 1;
    for (size_t c = 0; c < 3; ++c) rendered.image[c * 1024 + i] += 0.25F;
  }
  int added = 0;
  for (size_t i = 0; added < people; ++i) {
    if (truth.labels[i] != 0) continue;
    rendered.labels[i] = 2;
    ++added;
  }
  off.Add(rendered, truth);
  EXPECT_NEAR(off.Scores().image_l1, 0.25, 1e-6);
  EXPECT_NEAR(off.Scores().psnr_db, -20 * std::log10(0.25), 1e-4);
  EXPECT_NEAR(off.Scores().silhouette_iou, 0.5, 1e-9);
  EXPECT_NEAR(off.Scores().label_iou, shirt / people / 4, 1e-9);
  EXPECT_TRUE(std::isnan(off.Scores().lpips));
  EXPECT_THROW(off.Add(rendered, ToyPhotoFrame(1, {}, false)), std::invalid_argument);
}

TEST(GuidedScores, TrainedWeightsMeasureWhereTheyAreGiven) {
  const PhotoFrame truth = ToyPhotoFrame(1, {}, true);
  RenderedPerson darker = OwnImage(truth);
  for (float& value : darker.image) value *= 0.8F;
  const auto scores = [&](const LikenessWeights& weights) {
    PersonScorer scorer(LikenessScoring(weights));
    scorer.Add(darker, truth);
    return scorer.Scores();
  };
  const FeatureTrunk vgg = FeatureTrunk::kVgg19;
  const LikenessWeights weights = {{AlexNetWeights(), "alexnet.pth"},
                                   {HeadWeights(), "lpips_alex.pth"},
                                   {TrunkWeights(vgg, FeatureLayers(vgg, {"relu4_2"})[0]), "vgg19.pth"}};
  const PersonScores trained = scores(weights), random = scores({});
  const Image rendered = ToImage(torch::tensor(darker.image).view({3, 32, 32}));
  const Image true_image = ToImage(torch::tensor(truth.image).view({3, 32, 32}));
  EXPECT_FALSE(trained.lpips_random_features || trained.contextual_random_features);
  EXPECT_NEAR(trained.lpips, LpipsFrom(weights.alexnet, weights.lpips_heads).Distance(rendered, true_image).value,
              1e-4 * trained.lpips);
  ContextualMetric contextual;
  contextual.Load(weights.vgg19.weights, "vgg19.pth");
  EXPECT_NEAR(trained.contextual, contextual(rendered, true_image).distance, 1e-4 * trained.contextual);
  EXPECT_TRUE(random.lpips_random_features && random.contextual_random_features);
  // The substitute is that of every other renderer.
  EXPECT_NEAR(random.lpips, Lpips().Distance(rendered, true_image).value, 1e-4 * random.lpips);
  // Either without the other.
  const PersonScores half = scores({weights.alexnet, weights.lpips_heads, {}});
  EXPECT_TRUE(!half.lpips_random_features && half.contextual_random_features);
}

TEST(GuidedScores, StabilityIsWithinAPerson) {
  const PhotoFrame truth = ToyPhotoFrame(1, {}, true);
  RenderedPerson darker = OwnImage(truth), darkest = darker;
  for (float& value : darker.image) value *= 0.8F;
  for (float& value : darkest.image) value *= 0.5F;
  const auto distance = [&](const RenderedPerson& rendered) {
    PersonScorer scorer(LikenessScoring());
    scorer.Add(rendered, truth);
    EXPECT_EQ(scorer.Scores().lpips_deviation, 0) << "one frame";
    return scorer.Scores().lpips;
  };
  const double a = distance(darker), b = distance(darkest);
  ASSERT_GT(std::abs(a - b), 1e-4);
  // Two people who are each drawn the same in every frame, one of them badly: steady.
  PersonScorer steady(LikenessScoring()), unsteady(LikenessScoring());
  for (const RenderedPerson* person : {&darker, &darkest}) {
    for (int k = 0; k < 3; ++k) steady.Add(*person, truth);
    steady.NextPerson();
  }
  EXPECT_NEAR(steady.Scores().lpips, 0.5 * (a + b), 1e-12);
  EXPECT_NEAR(steady.Scores().lpips_deviation, 0, 1e-12);
  // One person, now well and now badly, after a steady one: two frames off their mean by half the difference.
  for (int k = 0; k < 2; ++k) unsteady.Add(darker, truth);
  unsteady.NextPerson();
  unsteady.Add(darker, truth);
  unsteady.Add(darkest, truth);
  EXPECT_NEAR(unsteady.Scores().lpips_deviation, std::sqrt(2 * 0.25 * (a - b) * (a - b) / 4), 1e-9);
  EXPECT_EQ(unsteady.Scores().lpips_of_people, (std::vector<std::vector<double>>{{a, a}, {a, b}}));
}

}  // namespace
}  // namespace bodyloom::guided_maps_test
