// SPDX-License-Identifier: Apache-2.0
// Error of labels and normals derived from a tracked body (data_tools/datasets/body_truth.h): those of the true body
// within the true outline, against the truth. `bodyloom_bench_body_truth --data a,b --step 5`, single-person datasets,
// every fifth frame. Outline and body are exact, so this is a lower bound of the error.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/body_truth.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/descriptors/person_frames.h"

namespace bodyloom {
namespace {

struct Counts {
  std::array<long, kNumPersonLabels> both{}, either{};
  long person = 0, same = 0, on_body = 0, normals = 0;
  double degrees = 0;
};

Eigen::Vector3d NormalAt(const Image& normals, size_t i) {
  return {NormalOfCode(normals.bgr[3 * i + 2]), NormalOfCode(normals.bgr[3 * i + 1]), NormalOfCode(normals.bgr[3 * i])};
}

void AddFrame(const PersonFrames& frames, const PersonFrame& truth, int t, Counts* counts) {
  const std::vector<uint8_t> labels = CutLabels(truth.labels, frames.window(), t);
  const Image normals = CutWindow(truth.normals, frames.window(), t);
  const BodySurface surface = frames.Surface(t);
  const BodyTruth own = BodyTruthOf(surface, labels);
  for (size_t i = 0; i < labels.size(); ++i) {
    for (int k = 1; k < kNumPersonLabels; ++k) {
      counts->both[k] += labels[i] == k && own.labels[i] == k ? 1 : 0;
      counts->either[k] += labels[i] == k || own.labels[i] == k ? 1 : 0;
    }
    if (labels[i] == 0) continue;
    ++counts->person;
    counts->same += labels[i] == own.labels[i] ? 1 : 0;
    counts->on_body += surface.parts[i] != 0 ? 1 : 0;
    const Eigen::Vector3d n = NormalAt(normals, i), m = NormalAt(own.normals, i);
    if (n.norm() > 1.1 || n.norm() < 0.9) continue;  // background: (−1, −1, −1)
    ++counts->normals;
    counts->degrees += std::acos(std::clamp(n.normalized().dot(m.normalized()), -1.0, 1.0)) * 180 / std::numbers::pi;
  }
}

void Run(const BenchArguments& arguments, const std::string& command) {
  std::printf("%s\n\n| dataset | garment | of the person on the body | same class |", command.c_str());
  for (int k = 1; k < kNumPersonLabels; ++k) std::printf(" IoU %s |", kPersonLabelNames[k]);
  std::printf(" normals, degrees |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& path : arguments.List("data")) {
    const SinglePersonDataset set(path);
    const Track track = set.track();
    PersonFramesOptions options;
    options.uv_size = 16;
    options.past = 0;
    options.window.scale = 1;
    const PersonFrames frames(BuiltinBody(), track, options);
    Counts counts;
    for (int t = 0; t < set.info().num_frames; t += arguments.Integer("step")) {
      AddFrame(frames, set.Read(t, {true, true, false, false}), t, &counts);
    }
    const double person = double(std::max(1L, counts.person));
    std::printf("| %s | %s | %.3f | %.3f |", path.c_str(), set.info().garment.c_str(), counts.on_body / person,
                counts.same / person);
    for (int k = 1; k < kNumPersonLabels; ++k) {
      std::printf(" %.3f |", counts.both[k] / double(std::max(1L, counts.either[k])));
    }
    std::printf(" %.2f |\n", counts.degrees / double(std::max(1L, counts.normals)));
  }
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_body_truth", argc, argv, {{"data", "person"}, {"step", "5"}},
                             bodyloom::Run);
}
