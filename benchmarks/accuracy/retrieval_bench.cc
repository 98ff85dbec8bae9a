// SPDX-License-Identifier: Apache-2.0
/// Discriminative power of descriptors of motion (Yoon et al., CVPR 2022, Fig. 4): a person repeatedly turns left and
/// right before one camera; each moment of the first cycle is searched for in the following cycles.
///
///   bodyloom_bench_retrieval [--cycles 6] [--period 2] [--amplitude 60] [--variation 0.1] [--noise_px 0,2]
///                            [--noise_deg 0,1] [--uv 32] [--window 48] [--seeds 3] [--threads 2] [--json F]
///
/// Rows of the table (docs/lab/retrieval.md): COCO-17 trajectories, atlas coordinates as seen by the camera, the 3D
/// motion descriptor; the first with noise in pixels, the others from a track with noise in degrees; then the same of a
/// hand, the torso and a leg alone, where image-space descriptors count while the region is visible. The JSON holds a
/// plot (benchmarks/report/draw_plots.py): for the moment at which the person of the first seed, without noise, passes
/// the middle of the first cycle's first half, its correlation with all later frames.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/motion_retrieval.h"
#include "benchmarks/accuracy/region_retrieval.h"
#include "data_tools/body/builtin_body.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kPast = 10;

struct NamedDescriptor {
  std::string name;
  DescriptorRows rows;
  std::vector<bool> defined;  ///< frames; empty: all
};
using NamedDescriptors = std::vector<NamedDescriptor>;

NamedDescriptors DescriptorsOf(const TurningPerson& person, double noise_px, const BenchArguments& arguments) {
  PersonFramesOptions options;
  options.uv_size = arguments.Integer("uv");
  options.past = kPast;
  options.window.max_side = arguments.Integer("window");
  options.num_threads = arguments.Integer("threads");
  const PersonFrames frames(BuiltinBody(), person.track, options);
  NamedDescriptors all = {
      {"2D keypoints, 10 frames", KeypointTrajectories(BuiltinBody(), person.track, kPast, noise_px, 1), {}},
      {"2D dense UV, 1 frame", DenseCoordinates(frames, 1), {}},
      {"2D dense UV, 10 frames", DenseCoordinates(frames, kPast), {}},
      {"3D normals alone", MotionDescriptors(frames, 0), {}},
      {"3D motion descriptor", MotionDescriptors(frames, kPast), {}}};
  const DescriptorRows keypoints = all.front().rows, motion = all.back().rows;
  for (const RetrievedRegion where : {RetrievedRegion::kHand, RetrievedRegion::kTorso, RetrievedRegion::kLeg}) {
    const RegionOfBody region = MakeRegion(BuiltinBody(), where, options.uv_size);
    const std::string name = RegionName(where);
    const std::vector<bool> seen = RegionSeen(frames, region, kPast);
    all.push_back({name + ": 2D keypoints, 10 frames", KeypointsOfRegion(keypoints, region), seen});
    all.push_back({name + ": 2D dense UV, 10 frames", DenseCoordinatesOfRegion(frames, region, kPast), seen});
    all.push_back({name + ": 3D motion descriptor", MotionOfRegion(motion, region), {}});
  }
  return all;
}

/// The correlation of one moment, at which the person faces the camera, with all frames after the first cycle: a curve
/// for each descriptor of the whole body.
Plot PlotCorrelations(const TurningPerson& person, const NamedDescriptors& descriptors) {
  const std::vector<int> turning = TurningFrames(person, true);
  // Facing the camera: the middle of the first half turn.
  const int query =
      *std::min_element(turning.begin(), turning.begin() + std::ptrdiff_t(turning.size() / 2),
                        [&](int a, int b) { return std::abs(person.yaw_deg[a]) < std::abs(person.yaw_deg[b]); });
  const auto first =
      static_cast<int>(std::upper_bound(person.cycle.begin(), person.cycle.end(), 0) - person.cycle.begin());
  const int count = static_cast<int>(person.cycle.size()) - first;
  Plot plot;
  plot.file = "retrieval";
  plot.title = "Correlation of one moment with the cycles that follow";
  plot.x_label = "frames";
  plot.y_label = "normalised cross-correlation";
  plot.log_x = plot.log_y = false;
  for (const NamedDescriptor& descriptor : descriptors) {
    if (descriptor.name.find(": ") != std::string::npos) continue;  // of a region alone
    const Eigen::MatrixXf correlation =
        NormalisedCrossCorrelation(descriptor.rows.bottomRows(count), descriptor.rows.row(query));
    PlotLine& line = plot.lines.emplace_back();
    line.name = descriptor.name;
    for (int i = 0; i < count; ++i) line.points.push_back({double(i), double(correlation.data()[i])});
  }
  return plot;
}

void Run(const BenchArguments& arguments, const std::string& command) {
  BenchReport report;
  report.command = command;
  report.title = "Retrieval by normalised cross-correlation, a person turning left and right";
  report.label_columns = {"descriptor", "seed"};
  report.value_columns = {"peaks_a_cycle", "one_peak_%", "direction_right_%", "yaw_error_deg", "answered_%"};
  const std::vector<std::string> noise_px = arguments.List("noise_px"), noise_deg = arguments.List("noise_deg");
  BODYLOOM_CHECK(noise_px.size() == noise_deg.size(), "--noise_px and --noise_deg: lists of one length");
  for (size_t n = 0; n < noise_px.size(); ++n) {
    std::vector<BenchRow> rows;
    for (int seed = 1; seed <= arguments.Integer("seeds"); ++seed) {
      TurningPersonOptions options;
      options.cycles = arguments.Integer("cycles");
      options.period_s = std::stod(arguments.Text("period"));
      options.amplitude_deg = std::stod(arguments.Text("amplitude"));
      options.variation = std::stod(arguments.Text("variation"));
      options.pose_noise_deg = std::stod(noise_deg[n]);
      options.seed = static_cast<uint64_t>(seed);
      const TurningPerson person = MakeTurningPerson(BuiltinBody(), options);
      const NamedDescriptors descriptors = DescriptorsOf(person, std::stod(noise_px[n]), arguments);
      for (const auto& [name, values, defined] : descriptors) {
        const RetrievalScores s = ScoreRetrieval(person, values, defined);
        rows.push_back({Concatenate(name, " (noise ", noise_px[n], " px, ", noise_deg[n], " deg)"),
                        {name, std::to_string(seed)},
                        {s.peaks_a_cycle, 100 * s.one_peak_share, 100 * s.direction_share, s.yaw_error_deg,
                         100 * s.answered_share}});
      }
      if (n == 0 && seed == 1) report.plots.push_back(PlotCorrelations(person, descriptors));
    }
    std::stable_sort(rows.begin(), rows.end(), [](const BenchRow& a, const BenchRow& b) { return a.group < b.group; });
    report.rows.insert(report.rows.end(), rows.begin(), rows.end());
  }
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_retrieval", argc, argv,
                             {{"cycles", "6"},
                              {"period", "2"},
                              {"amplitude", "60"},
                              {"variation", "0.1"},
                              {"noise_px", "0,2"},
                              {"noise_deg", "0,1"},
                              {"uv", "32"},
                              {"window", "48"},
                              {"seeds", "3"},
                              {"threads", "2"},
                              {"json", ""}},
                             bodyloom::Run);
}
