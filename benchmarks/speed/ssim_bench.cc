// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_ssim: time of SSIM and PSNR of two RGB images on one thread, their values, and the difference from
/// those of the same images as planes of doubles. Values of independent programs:
/// tests/data_tools/evaluation/ssim_test.cc.
#include <algorithm>
#include <cmath>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/speed/moving_body.h"
#include "data_tools/evaluation/ssim.h"

namespace bodyloom {
namespace {

void Fill(Image* truth, Image* result) {
  for (int y = 0; y < truth->height; ++y) {
    for (int x = 0; x < truth->width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int value = (x * 7 + y * 13 + x * y % 31 * 3 + c * 50) % 256;
        truth->pixel(x, y)[2 - c] = static_cast<uint8_t>(value);
        result->pixel(x, y)[2 - c] =
            static_cast<uint8_t>(std::clamp(value + (x * 31 + y * 17 + c * 7) % 41 - 20, 0, 255));
      }
    }
  }
}

void Section(int width, int height, int repetitions) {
  Image truth(width, height), result(width, height);
  Fill(&truth, &result);
  Title(std::to_string(width) + "x" + std::to_string(height) + ", RGB, one thread");
  double value = 0;
  for (const std::string& name : SsimPresetNames()) {
    const SsimPreset preset = SsimPresetFrom(name).value();
    const Milliseconds ms = Time(repetitions, [&] { value = Ssim(truth, result, preset); });
    const double planes = Ssim(PlanarFrom(truth), PlanarFrom(result), preset, 255);
    Print("SSIM " + name, ms, Format("%.6f (planes differ by %.0e)", value, std::abs(value - planes)));
  }
  const Milliseconds ms = Time(repetitions, [&] { value = Psnr(truth, result); });
  Print("PSNR", ms,
        Format("%.4f dB (planes differ by %.0e)", value,
               std::abs(value - Psnr(PlanarFrom(truth), PlanarFrom(result), 255))));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_ssim", argc, argv, {}, [](const auto&, const std::string&) {
    bodyloom::Section(256, 256, 51);
    bodyloom::Section(1920, 1080, 11);
  });
}
