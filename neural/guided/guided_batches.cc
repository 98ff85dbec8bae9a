// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/guided_batches.h"

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "neural/guided/guided_tensors.h"
#include "neural/guided/source_maps.h"
#include "neural/training/photo_partner.h"

namespace bodyloom {

GuidedBatch MakeGuidedBatch(const PhotoSource& people, const GuidedConfig& config, uint64_t seed, int64_t step,
                            int batch, int reach, const TexelNeighbours* neighbours) {
  std::vector<PhotoFrame> sources(batch), targets(batch);
  std::vector<std::vector<uint8_t>> known;
  for (int b = 0; b < batch; ++b) {
    const GuidedSample sample = GuidedSampleOf(seed, step, b, people);
    people.fill(sample.person, sample.source, &sources[b]);
    people.fill(sample.person, sample.target, &targets[b]);
    known.push_back(KnownPixels(seed, step, b, targets[b].size, targets[b].parts));
  }
  const int multiple = config.Multiple();
  GuidedBatch result;
  result.source = TensorsOf(sources);
  const GuidedTensors target = TensorsOf(targets);
  BODYLOOM_CHECK(result.source.image.defined() && target.image.defined(),
                 "pose-guided training: a frame without image or labels");
  result.boxes = PersonBoxes(targets, multiple, reach);
  result.target = CroppedEach(target, result.boxes, multiple);
  GuidedPseudo pseudo = PseudoOf(target, known);
  if (config.profile.contour_hints) {
    const SourceBody body = {people.texel_parts, {}, neighbours, {}, config.source_labels};
    std::vector<PseudoImage> warped;
    for (int b = 0; b < batch; ++b) {
      const CoherentMaps maps = MapsOfSource(std::span(&sources[b], 1), body, MapCompletion::kNearest, true, {}).maps;
      warped.push_back(LookUp(maps, targets[b]));
    }
    const GuidedPseudo of_source = PseudoOf(warped);
    pseudo.contour_classes = of_source.classes;
    pseudo.clothes_offset = of_source.clothes_offset;
  }
  result.pseudo = CroppedEach(pseudo, result.boxes, multiple);
  return result;
}

namespace {

constexpr int kCharts = 25;
constexpr int kMaxPatches = 6;
constexpr double kSmallest = 0.04, kLargest = 0.3;  ///< sides of patches, as shares of those of the body's box
constexpr double kHidesCharts = 0.35;               ///< share of samples that lose whole charts
constexpr double kHiddenCharts = 0.35;              ///< share of the charts that are lost

/// `purpose` separates the random streams of one place.
std::mt19937_64 Generator(uint64_t seed, int64_t step, int place, uint32_t purpose) {
  std::seed_seq sequence{static_cast<uint32_t>(seed),  static_cast<uint32_t>(seed >> 32),
                         static_cast<uint32_t>(step),  static_cast<uint32_t>(step >> 32),
                         static_cast<uint32_t>(place), purpose};
  return std::mt19937_64(sequence);
}

/// Own implementation, as distributions of the standard library differ between implementations.
double Uniform(std::mt19937_64* random) { return static_cast<double>((*random)() >> 11) * 0x1p-53; }
int Below(int n, std::mt19937_64* random) { return std::min(n - 1, static_cast<int>(Uniform(random) * n)); }

}  // namespace

GuidedSample GuidedSampleOf(uint64_t seed, int64_t step, int place, const PhotoSource& people) {
  const std::vector<int>& num_frames = people.num_frames;
  BODYLOOM_CHECK(!num_frames.empty(), "guided plan: nobody");
  std::mt19937_64 random = Generator(seed, step, place, 0);
  GuidedSample sample;
  sample.person = Below(static_cast<int>(num_frames.size()), &random);
  const int frames = num_frames[sample.person];
  BODYLOOM_CHECK(frames > 0, "guided plan: person ", sample.person, " has no image");
  sample.source = Below(frames, &random);
  sample.target = PartnerOf(people, sample.person, sample.source, PartnerDiffers::kPoseAndView, Uniform(&random));
  return sample;
}

std::vector<uint8_t> KnownPixels(uint64_t seed, int64_t step, int place, int size, std::span<const uint8_t> charts) {
  BODYLOOM_CHECK(size > 0 && charts.size() == size_t(size) * size, "guided plan: ", charts.size(), " pixels of ", size,
                 "x", size);
  std::mt19937_64 random = Generator(seed, step, place, 1);
  std::vector<uint8_t> known(charts.size());
  int left = size, top = size, right = -1, bottom = -1;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const size_t i = size_t(y) * size + x;
      known[i] = charts[i] != 0 ? 1 : 0;
      if (known[i] == 0) continue;
      left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  if (right < 0) return known;
  const int width = right - left + 1, height = bottom - top + 1;
  const int patches = Below(kMaxPatches + 1, &random);
  for (int p = 0; p < patches; ++p) {
    const auto side = [&](int whole) {
      return std::max(1, static_cast<int>(whole * (kSmallest + (kLargest - kSmallest) * Uniform(&random))));
    };
    const int w = side(width), h = side(height);
    const int x0 = left + Below(std::max(1, width - w + 1), &random),
              y0 = top + Below(std::max(1, height - h + 1), &random);
    for (int y = y0; y < y0 + h; ++y) std::fill_n(known.begin() + size_t(y) * size + x0, w, uint8_t{0});
  }
  if (Uniform(&random) < kHidesCharts) {
    std::array<bool, kCharts> hidden{};
    for (bool& chart : hidden) chart = Uniform(&random) < kHiddenCharts;
    for (size_t i = 0; i < known.size(); ++i) {
      if (charts[i] < kCharts && hidden[charts[i]]) known[i] = 0;
    }
  }
  return known;
}

}  // namespace bodyloom
