// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/work_precision/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <utility>

#include "benchmarks/accuracy/dense_clips.h"
#include "benchmarks/work_precision/autodiff_peer.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/npz.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/normals.h"
#include "geometry/body/skinning.h"
#include "geometry/uv_maps/surface_velocity.h"

namespace bodyloom {

Engine ChainEngine(int threads, int early_dense) {
  Engine engine{early_dense > 0 ? "chain, early points" : "chain", {}};
  engine.options.solver = SequenceSolver::kChain;
  engine.options.num_threads = threads;
  engine.options.chain.early_dense = early_dense;
  return engine;
}

Engine ReusingEngine(int threads) {
  Engine engine = ChainEngine(threads, 0);
  engine.name = "chain, reused linearisation";
  engine.options.chain.reuse_linearisation = kTrackerReuse;
  return engine;
}

Engine FreezingEngine(int threads) {
  Engine engine = ReusingEngine(threads);
  engine.name = "chain, reused and frozen frames";
  engine.options.chain.frozen_share = kTrackerFrozenShare;
  return engine;
}

Engine TrackerEngine(int threads) {
  Engine engine = FreezingEngine(threads);
  engine.name = "chain, as the tracker";
  engine.options.chain.early_dense = kTrackerEarlyDense;
  return engine;
}

Engine CeresEngine(int threads) {
  Engine engine{"ceres", {}};
  engine.options.num_threads = threads;
  return engine;
}

Engine AutoDiffEngine(int threads) {
  Engine engine{"ceres AutoDiff", {}};
  engine.options.num_threads = threads;
  engine.solve = SolveWithAutoDiff;
  return engine;
}

TimeMs TimeMs::Of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  TimeMs time;
  if (values.empty()) return time;
  time.median = values[values.size() / 2];
  if (values.size() > 1) time.spread_percent = 50 * (values.back() - values.front()) / time.median;
  return time;
}

std::vector<EngineRun> MeasureEngines(const WorkProblem& work, const std::vector<Engine>& engines, int repeat) {
  std::vector<EngineRun> runs(engines.size());
  std::vector<std::vector<double>> wall(engines.size()), cpu(engines.size());
  const auto T = static_cast<double>(work.problem.states.size());
  for (int round = 0; round < repeat; ++round) {
    for (size_t i = 0; i < engines.size(); ++i) {
      SequenceProblem problem = work.problem;
      const std::clock_t start = std::clock();
      const SolveReport report = engines[i].solve(&problem, engines[i].options);
      cpu[i].push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / T);
      wall[i].push_back(1e3 * report.seconds / T);
      if (round > 0) continue;
      runs[i].iterations = report.iterations;
      if (report.status != SolveStatus::kFailure) runs[i].cost = report.final_cost;
      runs[i].error_px = ProjectionErrorPx(work, problem.states, problem.betas);
      runs[i].answer = std::move(problem);
    }
  }
  for (size_t i = 0; i < engines.size(); ++i) {
    runs[i].wall = TimeMs::Of(wall[i]);
    runs[i].cpu = TimeMs::Of(cpu[i]);
  }
  return runs;
}

Timing MeasureAction(const std::function<void()>& action, int repeat, double divisor) {
  std::vector<double> wall, cpu;
  for (int round = 0; round < repeat; ++round) {
    const std::clock_t cpu_start = std::clock();
    const Stopwatch watch;
    action();
    wall.push_back(1e3 * watch.seconds() / divisor);
    cpu.push_back(1e3 * static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC / divisor);
  }
  return {TimeMs::Of(wall), TimeMs::Of(cpu)};
}

double BoundPx(const WorkProblem& work) {
  DenseBoundOptions options;
  options.smooth = work.problem.states.size() > 2;
  return DenseBound(BuiltinBody(), work.clip, options).mean_px;
}

double PeakMegabytes() {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void ResetPeak() { std::ofstream("/proc/self/clear_refs") << "5"; }

WorkProblemOptions WorkBench::Options(int frames, int dense) const {
  WorkProblemOptions options;
  options.motion = arguments.List("motions")[0];
  options.frames = frames;
  options.dense = dense;
  return options;
}

void WorkBench::AddRow(const std::string& group, const std::string& problem, const std::string& engine,
                       std::vector<double> values) {
  values.resize(kWorkColumns.size(), std::numeric_limits<double>::quiet_NaN());
  std::fprintf(stderr, "%s, %s, %s: %s ms wall, %s ms processor, error %s\n", group.c_str(), problem.c_str(),
               engine.c_str(), BenchNumber(values[0]).c_str(), BenchNumber(values[2]).c_str(),
               BenchNumber(values[5]).c_str());
  report.rows.push_back({group, {problem, engine}, std::move(values)});
}

void WorkBench::Add(const std::string& group, const std::string& problem, const std::vector<Engine>& engines,
                    const std::vector<EngineRun>& runs, double bound_px, double peak_mb) {
  double best = std::numeric_limits<double>::infinity();
  for (const EngineRun& run : runs) best = std::fmin(best, run.cost);
  for (size_t i = 0; i < runs.size(); ++i) {
    const EngineRun& run = runs[i];
    AddRow(group, problem, engines[i].name,
           {run.wall.median, run.wall.spread_percent, run.cpu.median, run.cpu.spread_percent, double(run.iterations),
            run.error_px, bound_px, run.cost / best - 1, peak_mb});
  }
}

namespace {

constexpr int kFaceStep = 10;

Eigen::Vector3d At(const std::vector<float>& values, int v) {
  return {values[3 * static_cast<size_t>(v)], values[3 * static_cast<size_t>(v) + 1],
          values[3 * static_cast<size_t>(v) + 2]};
}

/// Three planes from `plane` on at a point of the map.
Eigen::Vector3d Lookup(const float* plane, int size, const Eigen::Vector2d& uv) {
  const double x = uv[0] * size - 0.5, y = (1 - uv[1]) * size - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const int column = std::clamp(x0 + dx, 0, size - 1), row = std::clamp(y0 + dy, 0, size - 1);
      const double weight = (dx == 0 ? 1 - (x - x0) : x - x0) * (dy == 0 ? 1 - (y - y0) : y - y0);
      for (int c = 0; c < 3; ++c) {
        sum[c] += weight * double{plane[(static_cast<size_t>(c) * size + row) * size + column]};
      }
    }
  }
  return sum;
}

}  // namespace

MapTruth::MapTruth(const BodyModel& body, const Track& truth) {
  const BodyModelData& d = body.data();
  std::vector<int> faces;
  for (int f = 0; f < body.num_faces(); f += kFaceStep) {
    faces.push_back(f);
    Eigen::Vector2d uv = Eigen::Vector2d::Zero();
    for (int k = 0; k < 3; ++k) uv += d.vt.row(d.ft(f, k)).cast<double>().transpose() / 3;
    uv_.push_back(uv);
  }
  std::vector<BodyPose> poses;
  for (const auto& pose : PosesInFrame(body, truth, SurfaceFrame::kCamera)) {
    BODYLOOM_CHECK(pose.has_value(), "the truth has a frame without a pose");
    poses.push_back(*pose);
  }
  const size_t T = poses.size(), V = static_cast<size_t>(body.num_vertices());
  VelocityStencilOptions options;
  options.scheme = VelocityScheme::kCentral;
  const std::vector<char> usable(T, 1);
  const auto stencils = VelocityStencils(truth.motion.timestamps, usable, options);
  std::vector<PoseRates> rates;
  for (size_t t = 0; t < T; ++t) {
    std::vector<const BodyPose*> neighbours;
    for (size_t k = 0; k < stencils[t].weights.size(); ++k) neighbours.push_back(&poses[stencils[t].first_frame + k]);
    rates.push_back(RatesOf(stencils[t], neighbours, poses[t]));
  }
  const Skinner skinner(body);
  const ShapedBody shape = skinner.Shape(truth.motion.betas);
  std::vector<float> vertices(3 * V * T), velocities(3 * V * T), normals(3 * V * T);
  MatrixX3d roots(static_cast<Eigen::Index>(T), 3);
  skinner.SkinFromRoot(shape, poses, vertices, &roots);
  VelocitySkinner(body).Velocities(shape, poses, rates, velocities, 1);
  MeshNormals(d.faces, body.num_vertices()).ComputeFrames(vertices, normals, 1);
  for (size_t t = 0; t < T; ++t) {
    const int first = static_cast<int>(t * V);
    std::vector<Eigen::Vector3d> n, v;
    for (int f : faces) {
      Eigen::Vector3d normal = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        normal += At(normals, first + d.faces(f, k));
        velocity += At(velocities, first + d.faces(f, k)) / 3;
      }
      n.push_back(normal.normalized());
      v.push_back(velocity);
    }
    normals_.push_back(n);
    velocities_.push_back(v);
  }
}

MapError MapTruth::ErrorOf(const std::string& npy_path, int size) const {
  const NdArray array = ReadNpy(npy_path);
  const auto T = static_cast<int64_t>(normals_.size());
  BODYLOOM_CHECK(array.shape == std::vector<int64_t>({T, 6, size, size}), npy_path, ": maps of another shape");
  const std::vector<float> maps = array.ToFloats();
  MapError error;
  double squares = 0;
  size_t count = 0;
  for (size_t t = 0; t < normals_.size(); ++t) {
    const float* record = &maps[t * 6 * static_cast<size_t>(size) * size];
    for (size_t i = 0; i < uv_.size(); ++i, ++count) {
      const Eigen::Vector3d normal = Lookup(record, size, uv_[i]);
      const Eigen::Vector3d velocity = Lookup(record + 3 * static_cast<size_t>(size) * size, size, uv_[i]);
      error.normal_deg += std::atan2(normal.cross(normals_[t][i]).norm(), normal.dot(normals_[t][i])) * 180 / M_PI;
      squares += (velocity - velocities_[t][i]).squaredNorm();
    }
  }
  error.normal_deg /= static_cast<double>(count);
  error.velocity_mm_s = 1e3 * std::sqrt(squares / static_cast<double>(count));
  return error;
}

}  // namespace bodyloom
