// SPDX-License-Identifier: Apache-2.0
// Time of a frame and of a training step of the motion-dependent renderer, and the convolution throughput of the
// machine. `bodyloom_bench_motion --profile cpu --threads 1`; the same networks in PyTorch:
// benchmarks/peers/motion_torch.py.
#include <torch/torch.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/speed/moving_body.h"
#include "neural/base/runtime.h"
#include "neural/motion/motion_model.h"
#include "neural/motion/person_box.h"
#include "neural/motion/roll_out.h"
#include "neural/motion/train_motion.h"
#include "neural/networks/architecture_card.h"
#include "neural/networks/blocks.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// A window of width × height in which an ellipse of person_width × person_height stands for the person.
struct ToyWindow {
  int width, height, person_width, person_height;
};

/// The person fills most of the window.
ToyWindow Filled(int width, int height) { return {width, height, width * 3 / 5, height * 9 / 10}; }

/// `t` changes everything that may change.
void ToyFrame(const MotionConfig& config, const ToyWindow& window, int t, bool with_truth, MotionFrame* frame) {
  const int width = window.width, height = window.height;
  *frame = {};
  frame->width = width, frame->height = height;
  const size_t area = size_t(width) * height, texels = size_t(config.profile.uv_size) * config.profile.uv_size;
  frame->motion.resize(config.motion_channels * texels);
  for (size_t i = 0; i < frame->motion.size(); ++i) {
    frame->motion[i] = std::sin(0.001F * static_cast<float>(i) + 0.1F * static_cast<float>(t));
  }
  frame->uv.assign(2 * area, 0);
  frame->body.assign(area, 0);
  if (with_truth) {
    frame->image.assign(3 * area, 0);
    frame->labels.assign(area, 0);
    frame->normals.assign(3 * area, 0);
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5F) / static_cast<float>(width);
      const float v = (static_cast<float>(y) + 0.5F) / static_cast<float>(height);
      if (std::hypot((u - 0.5F) * 2 * float(width) / float(window.person_width),
                     (v - 0.5F) * 2 * float(height) / float(window.person_height)) > 1) {
        continue;
      }
      const size_t i = size_t(y) * width + x;
      frame->uv[i] = u, frame->uv[area + i] = v, frame->body[i] = 1;
      if (!with_truth) continue;
      frame->labels[i] = static_cast<uint8_t>(1 + static_cast<int>(6 * v) % 6);
      for (int c = 0; c < 3; ++c) frame->image[c * area + i] = 0.5F + 0.4F * std::sin(20 * u + 9 * v + float(c));
      frame->normals[2 * area + i] = -1;
    }
  }
}

/// 10⁹ multiply–adds a second of a 3×3 convolution of 64 channels at 256².
double Peak() {
  const torch::NoGradGuard no_grad;
  torch::nn::Conv2d conv(torch::nn::Conv2dOptions(64, 64, 3).padding(1));
  const torch::Tensor x = torch::randn({1, 64, 256, 256});
  const Milliseconds ms = Time(15, [&] { conv(x); });
  const double peak = 1e-9 * 64 * 64 * 9 * 256 * 256 / (1e-3 * ms.minimum);
  Print("3x3 convolution 64 -> 64 at 256x256", ms, std::to_string(peak) + " GMAC/s");
  return peak;
}

std::string ShareText(double multiply_adds, Milliseconds ms, double peak) {
  char text[128];
  std::snprintf(text, sizeof text, "%.2f GMAC, %.0f %% of the peak", 1e-9 * multiply_adds,
                100 * 1e-9 * multiply_adds / (1e-3 * ms.median) / peak);
  return text;
}

void TransposedConvolutions(const MotionProfile& profile) {
  const torch::NoGradGuard no_grad;
  const int width = profile.decoder_widths.front(), size = profile.image_size / 2;
  torch::nn::ConvTranspose2d layer(torch::nn::ConvTranspose2dOptions(width, width, 4).stride(2).padding(1));
  const torch::Tensor x = torch::randn({1, width, size, size});
  const std::string what = std::to_string(width) + " channels at " + std::to_string(size);
  const double error = (TransposedConv(x, layer->weight, layer->bias, 1, 0) - layer(x)).abs().max().item<double>();
  Print("LibTorch's transposed convolution, " + what, Time(9, [&] { layer(x); }), "");
  Print("as four convolutions", Time(9, [&] { TransposedConv(x, layer->weight, layer->bias, 1, 0); }),
        "differs by " + std::to_string(error));
}

void Inference(const MotionConfig& config, double peak) {
  MotionModel model(config);
  model->eval();
  const int side = config.profile.image_size;
  const int reach = side / 16;
  struct Row {
    const char* what;
    ToyWindow window;
    bool around_body;
  };
  for (const Row& row : {Row{"a frame, the whole image", Filled(side, side), false},
                         Row{"the person's window", Filled(side * 5 / 8, side), false},
                         Row{"a smaller person, the whole window", {side, side, side * 3 / 8, side * 5 / 8}, false},
                         Row{"a smaller person, around the body", {side, side, side * 3 / 8, side * 5 / 8}, true}}) {
    model->config.around_body = row.around_body;
    std::vector<MotionFrame> frames(2);
    for (int t = 0; t < 2; ++t) ToyFrame(config, row.window, t, false, &frames[t]);
    PixelBox seen = {0, 0, row.window.width, row.window.height};
    if (row.around_body) seen = PersonBoxes(std::span(frames).first(1), reach, config.Multiple()).front();
    RollOut roll(model, 0, {reach, /*whole_window=*/true});
    int t = 0;
    const auto next = [&] { roll.Next(frames[t++ % 2]); };
    const auto multiply_adds = static_cast<double>(CountMultiplyAdds(next));
    const Milliseconds moving = Time(15, next);
    const std::string size = std::to_string(seen.width()) + "x" + std::to_string(seen.height());
    Print(std::string(row.what) + ", " + size, moving, ShareText(multiply_adds, moving, peak));
    Print("the same, nothing moved since the frame before", Time(15, [&] { roll.Next(frames[0]); }), "exact");
  }
}

void Training(const MotionConfig& config) {
  TrainMotionOptions options;
  options.config = config;
  options.train = {{0, 64}};
  options.validate_every = options.report_every = options.checkpoint_every = 1 << 20;
  options.run_dir = (fs::temp_directory_path() / "bodyloom_bench_motion").string();
  const int side = config.profile.image_size;
  const auto source = [&](int t, bool with_truth, MotionFrame* frame) {
    ToyFrame(config, Filled(side, side), t, with_truth, frame);
  };
  double seconds[2];
  const int steps[2] = {3, 13};
  for (int i = 0; i < 2; ++i) {
    fs::remove_all(options.run_dir);
    fs::create_directories(options.run_dir);
    options.steps = steps[i];
    seconds[i] = TrainMotion(source, options).seconds;
  }
  fs::remove_all(options.run_dir);
  const double step_ms = 1e3 * (seconds[1] - seconds[0]) / (steps[1] - steps[0]);
  Print("a training step, batch " + std::to_string(options.batch) + ", data and all", {step_ms, step_ms}, "mean of 10");
}

void Run(const BenchArguments& arguments, const std::string&) {
  const std::string& profile = arguments.Text("profile");
  const int threads = arguments.Integer("threads");
  StartNeuralRuntime(threads);
  MotionConfig config;
  config.profile = MotionProfileNamed(profile);
  Title("motion renderer, profile " + profile + ", " + std::to_string(threads) + " threads");
  const double peak = Peak();
  TransposedConvolutions(config.profile);
  Inference(config, peak);
  Training(config);
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_motion", argc, argv, {{"profile", "cpu"}, {"threads", "1"}},
                             bodyloom::Run);
}
