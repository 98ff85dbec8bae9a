// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_fingers: errors of finger angles, and of their standard deviations, on synthetic hands of known pose.
///
///   bodyloom_bench_fingers [--sizes 40,70,100,150] [--yaws 0,120] [--seeds 1] [--blurred 0.2]
///
/// Hands, poses and noise: tests/support/synthetic_hands.h. By pose and by size of the hand in the image: mean error of
/// each finger's flexions after the first half second, the share of angles whose error is below one and two standard
/// deviations, and the time of the fit a frame of two hands.
#include <array>
#include <cstdio>
#include <string>

#include "benchmarks/accuracy/bench_arguments.h"
#include "geometry/base/stopwatch.h"
#include "tests/support/synthetic_hands.h"

namespace bodyloom {
namespace {

/// Means over clips.
struct FingerSums {
  FingerErrors sum;
  int clips = 0;
  void Add(const FingerErrors& errors) {
    for (size_t f = 0; f < 5; ++f) sum.mean_deg[f] += errors.mean_deg[f];
    sum.within_one += errors.within_one, sum.within_two += errors.within_two, sum.sigma_deg += errors.sigma_deg;
    ++clips;
  }
  void Print(const std::string& what) const {
    std::printf("%-14s", what.c_str());
    for (const size_t f : {size_t{4}, size_t{0}, size_t{1}, size_t{3}, size_t{2}}) {
      std::printf("%7.1f", sum.mean_deg[f] / clips);
    }
    std::printf("%9.1f%8.2f%7.2f\n", sum.sigma_deg / clips, sum.within_one / clips, sum.within_two / clips);
  }
};

void RunFingers(const BenchArguments& arguments, const std::string& command) {
  constexpr int kFromFrame = 15;
  std::printf("# %s\n%-14s  thumb  index middle   ring little   sigma  1 sigma     2   (degrees, shares)\n",
              command.c_str(), "");
  double seconds = 0;
  int frames = 0;
  for (const std::string& size : arguments.List("sizes")) {
    FingerSums of_size;
    for (const auto& [pose, keys] : SyntheticHandPoses()) {
      FingerSums of_pose;
      for (const std::string& yaw : arguments.List("yaws")) {
        for (int seed = 1; seed <= arguments.Integer("seeds"); ++seed) {
          const SyntheticHands made = MakeSyntheticHands({.pose = pose,
                                                          .yaw_deg = std::stod(yaw),
                                                          .size_px = std::stod(size),
                                                          .blurred = std::stod(arguments.Text("blurred")),
                                                          .frames = FramesOf(pose),
                                                          .seed = static_cast<unsigned>(seed)});
          const Stopwatch watch;
          const FingerErrors errors = FitSyntheticHands(made, {}, kFromFrame);
          seconds += watch.seconds();
          frames += FramesOf(pose);
          of_pose.Add(errors), of_size.Add(errors);
        }
      }
      of_pose.Print(size + " " + pose);
    }
    of_size.Print(size + " all");
  }
  std::printf("%.1f ms a frame of two hands\n", 1e3 * seconds / frames);
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_fingers", argc, argv,
                             {{"sizes", "40,70,100,150"}, {"yaws", "0,120"}, {"seeds", "1"}, {"blurred", "0.2"}},
                             bodyloom::RunFingers);
}
