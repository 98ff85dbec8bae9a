// SPDX-License-Identifier: Apache-2.0
// Time of a frame of the two one-photo renderers after encoding the photo, in the whole window and in the person's
// part. `bodyloom_bench_photo --profile cpu --threads 1`; the same networks in PyTorch:
// benchmarks/peers/photo_torch.py. Processor time is given beside wall time, as it is comparable on a busy machine.
#include <torch/torch.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "geometry/base/stopwatch.h"
#include "neural/base/runtime.h"
#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_model.h"
#include "neural/networks/architecture_card.h"
#include "neural/photo/photo_model.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr int kRepetitions = 15;

void Print(const std::string& what, const std::function<void()>& work) {
  const torch::NoGradGuard no_grad;
  const auto multiply_adds = static_cast<double>(CountMultiplyAdds(work));  // and plans the convolutions
  std::vector<double> processor_ms, clock_ms;
  for (int i = 0; i < kRepetitions; ++i) {
    const Stopwatch watch;
    const std::clock_t processor = std::clock();
    work();
    processor_ms.push_back(1e3 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
    clock_ms.push_back(1e3 * watch.seconds());
  }
  std::sort(processor_ms.begin(), processor_ms.end());
  std::sort(clock_ms.begin(), clock_ms.end());
  std::printf("| %-44s | %7.1f | %7.1f | %7.1f | %6.2f |\n", what.c_str(), processor_ms[kRepetitions / 2],
              processor_ms[0], clock_ms[kRepetitions / 2], 1e-9 * multiply_adds);
  std::fflush(stdout);
}

/// B×1×h×w, an ellipse.
Tensor Body(int64_t width, int64_t height) {
  const Tensor x = torch::linspace(-1, 1, width).square().view({1, 1, 1, width}),
               y = torch::linspace(-1, 1, height).square().view({1, 1, height, 1});
  return (x / 0.36 + y / 0.81 < 1).to(torch::kFloat);
}

struct Window {
  int64_t width, height;
  const char* what;
};

std::vector<Window> WindowsOf(int side) {
  return {{side, side, "a frame, the whole window"}, {side * 5 / 8, side, "the person's window"}};
}

std::string Named(const char* renderer, const Window& window) {
  return std::string(renderer) + ": " + window.what + ", " + std::to_string(window.width) + "x" +
         std::to_string(window.height);
}

void PhotoRenderer(const PhotoConfig& config) {
  PhotoModel model(config);
  model->eval();
  const int side = config.profile.image_size, texels = config.profile.texture_size;
  const Tensor features = torch::randn({1, config.TextureChannels(), texels, texels});
  const Tensor colour = torch::rand({1, 3, texels, texels}) * 2 - 1;
  const TextureTensors texture = {colour, torch::ones({1, 1, texels, texels}),
                                  config.GuessesUnseen() ? torch::zeros_like(colour) : Tensor()};
  for (const Window& window : WindowsOf(side)) {
    const PoseTensors pose = {torch::rand({1, 2, window.height, window.width}), {}, Body(window.width, window.height)};
    Print(Named("photo", window), [&] { model->Render(model->Project(features, pose), pose.body); });
  }
  Print("photo: the photo encoded, once", [&] { model->Complete(texture); });
}

void GuidedRenderer(const GuidedConfig& config) {
  GuidedModel model(config);
  model->eval();
  const int side = config.profile.image_size, multiple = config.Multiple();
  const auto classes = [](int64_t width, int64_t height) {
    return torch::randint(0, 7, {1, 1, height, width}).to(torch::kFloat);
  };
  const GuidedTensors photo = {torch::rand({1, 3, side, side}), Body(side, side), classes(side, side),
                               torch::rand({1, 3, side, side})};
  GuidedSource source;
  {
    const torch::NoGradGuard no_grad;
    source = model->EncodeSource(photo);
  }
  for (const Window& window : WindowsOf(side)) {
    const Tensor body = Body(window.width, window.height);
    const Tensor pose = body * torch::rand({1, 3, window.height, window.width});
    const Tensor labels = body * classes(window.width, window.height);
    const GuidedPseudo pseudo = {labels, body * torch::rand_like(pose), body, labels,
                                 torch::cat({0.1 * body, body}, 1)};
    const CodeBox box = {0, 0, window.width / multiple, window.height / multiple};
    Print(Named("guided", window), [&] { model->forward(source, pose, pseudo, box); });
  }
  // A body of two fifths of the window, as wide as a person with arms out.
  PhotoFrame frame;
  frame.size = side;
  frame.parts.assign(size_t(side) * side, 0);
  frame.uv.assign(2 * frame.parts.size(), 0.5F);
  for (int y = side / 10; y < side - side / 10; ++y) {
    std::fill_n(frame.parts.begin() + size_t(y) * side + side / 4, side / 2, uint8_t{2});
  }
  CoherentMaps maps =
      EmptyMaps(config.profile.texture_size,
                std::vector<uint8_t>(size_t(config.profile.texture_size) * config.profile.texture_size, 2));
  std::fill(maps.from.begin(), maps.from.end(), uint8_t{1});
  if (config.profile.contour_hints) maps.clothes_offset.assign(maps.from.size(), 0.1F);
  Print("guided: pseudo inputs of a frame", [&] { LookUp(maps, frame); });
  Print("guided: the photo encoded, once", [&] { model->EncodeSource(photo); });
}

void Run(const BenchArguments& arguments, const std::string&) {
  const std::string& profile = arguments.Text("profile");
  const int threads = arguments.Integer("threads");
  StartNeuralRuntime(threads);
  torch::manual_seed(1);
  std::printf("\n## one-photo renderers, profile %s, %d threads\n\n", profile.c_str(), threads);
  std::printf("| what | processor ms | least | clock ms | G multiply-adds |\n|---|---|---|---|---|\n");
  PhotoRenderer({PhotoProfileNamed(profile)});
  GuidedRenderer({GuidedProfileNamed(profile)});
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_photo", argc, argv, {{"profile", "cpu"}, {"threads", "1"}}, bodyloom::Run);
}
