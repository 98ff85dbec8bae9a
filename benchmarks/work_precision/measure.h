// SPDX-License-Identifier: Apache-2.0
/// Measures solvers on one problem: time, memory, error and cost of each.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/work_precision/work_problem.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom {

struct Engine {
  std::string name;
  SolveOptions options;
  std::function<SolveReport(SequenceProblem*, const SolveOptions&)> solve = SolveSequence;
};

Engine ChainEngine(int threads, int early_dense = 0);
/// Reuses the linearisation of frames that hardly move (ChainOptions::reuse_linearisation), as the tracker does.
Engine ReusingEngine(int threads);
/// Also freezes frames with little predicted decrease (ChainOptions::frozen_share), as the tracker does.
Engine FreezingEngine(int threads);
/// Also starts with a subset of the keypoints (ChainOptions::early_dense): all shortcuts of the tracker.
Engine TrackerEngine(int threads);
Engine CeresEngine(int threads);     ///< analytic derivatives, one cost function per frame
Engine AutoDiffEngine(int threads);  ///< autodiff_peer.h

/// Median of a time over repeated runs, and half the range relative to it.
struct TimeMs {
  double median = std::numeric_limits<double>::quiet_NaN(), spread_percent = median;
  static TimeMs Of(std::vector<double> values);
};

struct EngineRun {
  TimeMs wall, cpu;  ///< per frame
  double cost = std::numeric_limits<double>::quiet_NaN(), error_px = cost;
  int iterations = 0;
  SequenceProblem answer;  ///< of the first round
};

/// Runs all engines on one problem, alternating them in `repeat` rounds. A failed solve has no cost.
std::vector<EngineRun> MeasureEngines(const WorkProblem& work, const std::vector<Engine>& engines, int repeat);

/// Runs `action` `repeat` times; wall and processor time of the process divided by `divisor`, milliseconds.
struct Timing {
  TimeMs wall, cpu;
};
Timing MeasureAction(const std::function<void()>& action, int repeat, double divisor);

/// Cramér–Rao bound as mean projection error, pixels at 512, with the smoothness information if there are at least
/// three frames.
double BoundPx(const WorkProblem& work);

/// Maximum resident memory of the process since the last reset, MB.
double PeakMegabytes();
void ResetPeak();

/// State shared by the sections of the benchmark.
struct WorkBench {
  const BenchArguments& arguments;
  BenchReport report;
  int threads = 1, repeat = 1;

  [[nodiscard]] WorkProblemOptions Options(int frames, int dense) const;
  /// Adds one row per engine; cost_excess is relative to the lowest cost of the rows.
  void Add(const std::string& group, const std::string& problem, const std::vector<Engine>& engines,
           const std::vector<EngineRun>& runs, double bound_px,
           double peak_mb = std::numeric_limits<double>::quiet_NaN());
  /// Adds one row of numbers in the order of the value columns (kWorkColumns); missing trailing ones are NaN.
  void AddRow(const std::string& group, const std::string& problem, const std::string& engine,
              std::vector<double> values);
};

inline const std::vector<std::string> kWorkColumns = {"wall_ms",    "wall_ms_spread_percent",
                                                      "cpu_ms",     "cpu_ms_spread_percent",
                                                      "iterations", "error",
                                                      "bound",      "cost_excess",
                                                      "peak_mb",    "wall_over_chain"};

// Error of descriptor maps against the true surface.

struct MapError {
  double normal_deg = 0;     ///< mean angle
  double velocity_mm_s = 0;  ///< root mean square of the vector's difference
};

/// True values at the centre of every tenth face: the unit normal (interpolated from its vertices, as in maps) and the
/// velocity of the surface by the body model's derivative at central differences of the true poses.
class MapTruth {
 public:
  MapTruth(const BodyModel& body, const Track& truth);
  /// Error of maps [N(3), V(3)] of size² texels, one record per frame of the truth, sampled bilinearly at the centres.
  [[nodiscard]] MapError ErrorOf(const std::string& npy_path, int size) const;

 private:
  std::vector<Eigen::Vector2d> uv_;                    ///< one per face
  std::vector<std::vector<Eigen::Vector3d>> normals_;  ///< by frame, one per face
  std::vector<std::vector<Eigen::Vector3d>> velocities_;
};

}  // namespace bodyloom
