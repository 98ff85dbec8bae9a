// SPDX-License-Identifier: Apache-2.0
// Error of relit images: `bodyloom_bench_relit --truth other --results a,b`, single-person datasets of one person and
// motion: the truth rendered by `bodyloom synth-person --light-seed`, and results of `bodyloom animate motion --relight
// --full-size --set` from images in the original light.
//
// Over the pixels that are person in both. Images do not show the new light's brightness relative to the old one, so
// PSNR is also given after the best single gain for the clip; channels in [0, 255].
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <string>

#include "benchmarks/accuracy/bench_arguments.h"
#include "data_tools/datasets/single_person_dataset.h"

namespace bodyloom {
namespace {

/// Sums over the pixels of a clip.
struct Comparison {
  double aa = 0, ab = 0, bb = 0;  ///< of result a and truth b
  double degrees = 0;
  long values = 0, normals = 0;

  [[nodiscard]] double gain() const { return aa > 0 ? ab / aa : 1; }
  [[nodiscard]] double Psnr(double by) const {
    const double mse = (by * by * aa - 2 * by * ab + bb) / double(std::max(1L, values));
    return 10 * std::log10(255.0 * 255.0 / mse);
  }
};

Eigen::Vector3d NormalAt(const Image& normals, size_t i) {
  const uint8_t* const code = &normals.bgr[3 * i];
  if (code[0] + code[1] + code[2] == 0) return Eigen::Vector3d::Zero();
  return {NormalOfCode(code[2]), NormalOfCode(code[1]), NormalOfCode(code[0])};
}

void AddFrame(const PersonFrame& result, const PersonFrame& truth, Comparison* sums) {
  for (size_t i = 0; i < truth.rgb.bgr.size() / 3; ++i) {
    if (result.labels.bgr[3 * i] == 0 || truth.labels.bgr[3 * i] == 0) continue;
    for (size_t c = 0; c < 3; ++c) {
      const double a = result.rgb.bgr[3 * i + c], b = truth.rgb.bgr[3 * i + c];
      sums->aa += a * a, sums->ab += a * b, sums->bb += b * b;
      ++sums->values;
    }
    const Eigen::Vector3d n = NormalAt(result.normals, i), m = NormalAt(truth.normals, i);
    if (n.norm() < 0.5 || m.norm() < 0.5) continue;
    sums->degrees += std::acos(std::clamp(n.normalized().dot(m.normalized()), -1.0, 1.0)) * 180 / std::numbers::pi;
    ++sums->normals;
  }
}

void Run(const BenchArguments& arguments, const std::string& command) {
  const SinglePersonDataset truth(arguments.Text("truth"));
  std::printf("%s\n\n| images | normals, degrees | gain | PSNR dB | PSNR dB after the gain | pixels |\n",
              command.c_str());
  std::printf("|---|---|---|---|---|---|\n");
  for (const std::string& path : arguments.List("results")) {
    const SinglePersonDataset result(path);
    if (result.info().num_frames != truth.info().num_frames || result.info().width != truth.info().width ||
        result.info().height != truth.info().height || !result.info().has.labels || !result.info().has.normals) {
      throw std::runtime_error(path + ": expected frames, labels and normals as " + truth.path() + " has them");
    }
    Comparison sums;
    for (int t = 0; t < truth.info().num_frames; ++t) {
      const RenderedPeople wanted = {true, true, false, false};
      AddFrame(result.Read(t, wanted), truth.Read(t, wanted), &sums);
    }
    std::printf("| %s | %.2f | %.3f | %.2f | %.2f | %ld |\n", path.c_str(), sums.degrees / std::max(1L, sums.normals),
                sums.gain(), sums.Psnr(1), sums.Psnr(sums.gain()), sums.values / 3);
  }
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_relit", argc, argv, {{"truth", "other"}, {"results", "relit"}},
                             bodyloom::Run);
}
