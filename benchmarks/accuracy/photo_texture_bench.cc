// SPDX-License-Identifier: Apache-2.0
// Quality of photo textures without networks: completions of what a photo does not show, and unions of two photos,
// against the person's other images. `bodyloom_bench_photo_texture --data people`, a multi-person dataset (bodyloom
// synth-people), whose true labels and bodies are used.
//
// The truth of a texel is its colour in a third image that sees it at a cosine of at least 0.7; the light differs
// between images, so that no error can be 0. Mean absolute differences of RGB in [0, 1].
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "pipelines/neural/photo/people_data.h"
#include "render/texture/complete/guess_unseen.h"
#include "render/texture/complete/partial_texture.h"

namespace bodyloom {
namespace {

constexpr float kSeenWell = 0.7F;
constexpr double kNear = 0.05;

/// Mean absolute difference, of all texels and of those of the head, and the share of texels nearer than kNear.
class Error {
 public:
  void Add(const std::vector<float>& colours, const PartialTexture& truth, size_t texel, bool of_head) {
    const size_t texels = truth.visible.size();
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) sum += std::abs(colours[c * texels + texel] - truth.colour[c * texels + texel]) / 3;
    sum_ += sum, ++count_;
    near_ += sum < kNear ? 1 : 0;
    if (!of_head) return;
    head_sum_ += sum, ++head_count_;
    head_near_ += sum < kNear ? 1 : 0;
  }
  void Print(const char* what) const {
    const double all = double(std::max(1L, count_)), head = double(std::max(1L, head_count_));
    std::printf("| %-44s | %.4f | %5.1f %% | %.4f | %5.1f %% | %9ld |\n", what, sum_ / all, 100 * double(near_) / all,
                head_sum_ / head, 100 * double(head_near_) / head, count_);
  }

 private:
  double sum_ = 0, head_sum_ = 0;
  long count_ = 0, near_ = 0, head_count_ = 0, head_near_ = 0;
};

struct Errors {
  Error any_label, same_label;
  Error first, best, blend;
};

/// Colours of both, weighted by cosines² where both see a texel.
std::vector<float> Blend(const PartialTexture& a, const PartialTexture& b) {
  const size_t texels = a.visible.size();
  std::vector<float> colours(a.colour.size());
  for (size_t i = 0; i < colours.size(); ++i) {
    const float of_a = a.cosine[i % texels] * a.cosine[i % texels], of_b = b.cosine[i % texels] * b.cosine[i % texels];
    if (of_a + of_b > 0) colours[i] = (of_a * a.colour[i] + of_b * b.colour[i]) / (of_a + of_b);
  }
  return colours;
}

void MeasureGuess(const TexelNeighbours& neighbours, const std::vector<PartialTexture>& shown, size_t photo,
                  Errors* errors) {
  PartialTexture guessed = shown[photo];
  std::vector<float> any_label = guessed.colour;
  neighbours.FillUnseen(guessed.visible, 3, any_label);
  GuessTexture(neighbours, &guessed);
  for (size_t k = 0; k < shown.size(); ++k) {
    for (size_t i = 0; i < guessed.visible.size(); ++i) {
      if (guessed.guessed[i] == 0 || shown[k].cosine[i] < kSeenWell) continue;
      errors->any_label.Add(any_label, shown[k], i, neighbours.head()[i] != 0);
      errors->same_label.Add(guessed.colour, shown[k], i, neighbours.head()[i] != 0);
    }
  }
}

void MeasureUnion(const TexelNeighbours& neighbours, const std::vector<PartialTexture>& shown, size_t a, size_t b,
                  Errors* errors) {
  const std::vector<PartialTexture> pair = {shown[a], shown[b]};
  const std::vector<float> best = UnionOf(pair).colour, blend = Blend(pair[0], pair[1]);
  for (size_t k = 0; k < shown.size(); ++k) {
    if (k == a || k == b) continue;
    for (size_t i = 0; i < pair[0].visible.size(); ++i) {
      if (pair[0].visible[i] == 0 || pair[1].visible[i] == 0 || shown[k].cosine[i] < kSeenWell) continue;
      const bool of_head = neighbours.head()[i] != 0;
      errors->first.Add(pair[0].colour, shown[k], i, of_head);
      errors->best.Add(best, shown[k], i, of_head);
      errors->blend.Add(blend, shown[k], i, of_head);
    }
  }
}

void Run(const BenchArguments& arguments, const std::string& command) {
  PeopleDataRequest request;
  request.data = arguments.Text("data");
  request.size = request.texture_size = arguments.Integer("size");
  const PeopleData people(request);
  const PhotoSource& source = people.source();
  const TexelNeighbours neighbours(source.texture_size, source.texel_parts, source.texel_places);
  Errors errors;
  for (const int person : Everybody(source)) {
    std::vector<PartialTexture> shown;
    for (int f = 0; f < source.num_frames[person]; ++f) {
      PhotoFrame frame;
      source.fill(person, f, &frame);
      shown.push_back(PartialTextureOf(frame));
    }
    for (size_t a = 0; a < shown.size(); ++a) {
      MeasureGuess(neighbours, shown, a, &errors);
      for (size_t b = 0; b < shown.size(); ++b) {
        if (a != b) MeasureUnion(neighbours, shown, a, b, &errors);
      }
    }
  }
  std::printf("%s\n\n| %-44s | %-6s | %-7s | %-6s | %-7s | %-9s |\n|---|---|---|---|---|---|\n", command.c_str(),
              "colour of a texel", "L1", "near", "head", "near", "texels");
  errors.any_label.Print("guess, whatever the label");
  errors.same_label.Print("guess, of the same label");
  errors.first.Print("seen by two photos: the first");
  errors.best.Print("seen by two photos: the larger cosine");
  errors.blend.Print("seen by two photos: weighted by cosine^2");
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_photo_texture", argc, argv, {{"data", "people"}, {"size", "256"}},
                             bodyloom::Run);
}
