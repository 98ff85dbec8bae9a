// SPDX-License-Identifier: Apache-2.0
/// Time a frame and largest error of skinning with correctives, by body size, batch and threads.
///   build/release/benchmarks/skinning_bench --benchmark_repetitions=5
/// Counters: ms_per_frame; max_error_um, the largest distance to PoseVertices (double) over 16 frames, micrometres;
/// skipped, the share of corrective blocks left out because their joint was at rest.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "geometry/body/skinning.h"
#include "tests/geometry/random_body.h"

namespace bodyloom {
namespace {

enum BodyKind { kSmpl, kSmplX, kLocal };

/// SMPL's and SMPL-X's sizes with a block of correctives for every joint and vertex; a body of the built-in one's size
/// where a vertex has one block, about 5 % of them all.
const BodyModel& Body(int kind) {
  static std::map<int, BodyModel> bodies;
  const auto found = bodies.find(kind);
  if (found != bodies.end()) return found->second;
  RandomBodyOptions options;
  options.num_vertices = kind == kSmpl ? 6890 : kind == kSmplX ? 10475 : 7874;
  options.num_joints = kind == kSmplX ? 55 : 24;
  options.correctives_per_vertex = kind == kLocal ? 1 : options.num_joints - 1;
  return bodies.emplace(kind, RandomBody(options)).first->second;
}

std::vector<BodyPose> Poses(const BodyModel& model, int num_frames) {
  std::vector<BodyPose> poses;
  poses.reserve(static_cast<size_t>(num_frames));
  for (int t = 0; t < num_frames; ++t) poses.push_back(RandomPose(model, t, 1.5));
  return poses;
}

double LargestError(const BodyModel& model, const Eigen::VectorXd& betas, const std::vector<BodyPose>& poses,
                    const std::vector<double>& vertices) {
  double largest = 0;
  const int V = model.num_vertices(), T = static_cast<int>(poses.size());
  for (int i = 0; i < std::min(16, T); ++i) {
    const int t = i * (T - 1) / std::max(1, std::min(16, T) - 1);
    const Eigen::Map<const MatrixX3d> fast(vertices.data() + size_t(3) * t * V, V, 3);
    largest = std::max(largest, (fast - PoseVertices(model, betas, poses[t])).rowwise().norm().maxCoeff());
  }
  return largest;
}

void Report(benchmark::State& state, const BodyModel& model, const std::vector<BodyPose>& poses, int num_threads,
            bool skip) {
  const Eigen::VectorXd betas = RandomBetas(model.num_betas(), 1);
  const Skinner skinner(model, {.num_threads = num_threads, .vertices = {}, .skip_resting_joints = skip});
  const ShapedBody body = skinner.Shape(betas);
  std::vector<float> vertices(3 * poses.size() * model.num_vertices());
  MatrixX3d roots;
  SkinningSummary summary;
  for (auto _ : state) {
    summary = skinner.SkinFromRoot(body, poses, vertices, &roots);
    benchmark::ClobberMemory();
  }
  std::vector<double> world(vertices.size());
  skinner.Skin(body, poses, world);
  state.counters["ms_per_frame"] =
      benchmark::Counter(1e-3 * static_cast<double>(poses.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["max_error_um"] = 1e6 * LargestError(model, betas, poses, world);
  const double blocks = static_cast<double>(summary.corrective_blocks + summary.corrective_blocks_skipped);
  state.counters["skipped"] = blocks > 0 ? static_cast<double>(summary.corrective_blocks_skipped) / blocks : 0;
  state.SetLabel(summary.simd_target);
}

void SkinningAll(benchmark::State& state) {
  const BodyModel& model = Body(static_cast<int>(state.range(0)));
  Report(state, model, Poses(model, static_cast<int>(state.range(1))), static_cast<int>(state.range(2)), true);
}
BENCHMARK(SkinningAll)
    ->ArgNames({"body", "frames", "threads"})
    ->ArgsProduct({{kSmpl, kSmplX, kLocal}, {1, 8, 32, 256}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Only the arms move: what skipping the correctives of resting joints saves.
void SkinningArmsOnly(benchmark::State& state) {
  const BodyModel& model = Body(kSmpl);
  std::vector<BodyPose> poses = Poses(model, 256);
  for (BodyPose& pose : poses) {
    for (int j = 0; j < 16; ++j) pose.rotations[j].setIdentity();
  }
  Report(state, model, poses, 1, state.range(0) != 0);
}
BENCHMARK(SkinningArmsOnly)->ArgName("skip")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

/// 300 surface keypoints touch at most 900 vertices: what leaving out the others saves.
void SkinningUsedVertices(benchmark::State& state) {
  const BodyModel& model = Body(static_cast<int>(state.range(0)));
  const std::vector<BodyPose> poses = Poses(model, 256);
  std::vector<int> used;
  used.reserve(900);
  for (int i = 0; i < 900; ++i) used.push_back(static_cast<int>(int64_t{i} * model.num_vertices() / 900));
  const Skinner some(model, {.num_threads = 1, .vertices = used}), all(model);
  const Eigen::VectorXd betas = RandomBetas(model.num_betas(), 1);
  const ShapedBody some_shape = some.Shape(betas), all_shape = all.Shape(betas);
  std::vector<float> some_vertices(3 * poses.size() * used.size()), vertices(3 * poses.size() * model.num_vertices());
  MatrixX3d roots;
  some.SkinFromRoot(some_shape, poses, some_vertices, &roots);
  all.SkinFromRoot(all_shape, poses, vertices, &roots);
  float largest = 0;
  for (size_t t = 0; t < poses.size(); ++t) {
    for (size_t i = 0; i < used.size(); ++i) {
      for (size_t c = 0; c < 3; ++c) {
        largest = std::max(largest, std::abs(some_vertices[3 * (t * used.size() + i) + c] -
                                             vertices[3 * (t * model.num_vertices() + used[i]) + c]));
      }
    }
  }
  const bool skip = state.range(1) != 0;
  for (auto _ : state) {
    if (skip) {
      some.SkinFromRoot(some_shape, poses, some_vertices, &roots);
    } else {
      all.SkinFromRoot(all_shape, poses, vertices, &roots);
    }
    benchmark::ClobberMemory();
  }
  state.counters["ms_per_frame"] =
      benchmark::Counter(1e-3 * static_cast<double>(poses.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["largest_difference_um"] = 1e6 * largest;
}
BENCHMARK(SkinningUsedVertices)
    ->ArgNames({"body", "skip"})
    ->ArgsProduct({{kSmpl, kLocal}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// The single-frame path in double, for comparison.
void SinglePoseVertices(benchmark::State& state) {
  const BodyModel& model = Body(static_cast<int>(state.range(0)));
  const Eigen::VectorXd betas = RandomBetas(model.num_betas(), 1);
  const BodyPose pose = RandomPose(model, 1, 1.5);
  for (auto _ : state) benchmark::DoNotOptimize(PoseVertices(model, betas, pose));
  state.counters["ms_per_frame"] =
      benchmark::Counter(1e-3, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(SinglePoseVertices)->ArgName("body")->Arg(kSmpl)->Arg(kSmplX)->Arg(kLocal)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  std::printf(
      "Bodies: 0 = SMPL's size, 1 = SMPL-X's size (correctives everywhere), 2 = the built-in body's (5 %% of the "
      "blocks).\n"
      "Memory bounds a small batch: SMPL's correctives are 6890 x 207 x 3 floats = 17.1 MB, read once for up to 256\n"
      "frames; at 20 GB/s that is 0.86 ms for a batch of 1, 0.003 ms a frame for 256. The output is 83 kB a frame.\n");
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
