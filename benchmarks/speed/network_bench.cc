// SPDX-License-Identifier: Apache-2.0
/// Time of a network's run on one thread: `bodyloom_bench_network FILE.onnx|FILE.tflite … [--runs N]` prints for each
/// file the smallest and the median time, and the sum of its first output, to be compared with another runtime's.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <numeric>
#include <string>
#include <vector>

#include "geometry/base/stopwatch.h"
#include "tracking/detection/inference/graph_executor.h"
#include "tracking/detection/inference/onnx_reader.h"
#include "tracking/detection/inference/tflite_reader.h"

namespace bodyloom {
namespace {

void Measure(const std::string& file, int runs) {
  const Stopwatch made;
  const GraphExecutor network(file.ends_with(".onnx") ? ReadOnnxGraph(file) : ReadTfliteGraph(file));
  const double start_ms = 1000 * made.seconds();
  std::vector<float> input(GraphShapeSize(network.input_shape()));
  for (size_t i = 0; i < input.size(); ++i) input[i] = float(std::sin(double(i) * 0.001));
  std::vector<double> times;
  double sum = 0;
  for (int i = 0; i < runs; ++i) {
    const Stopwatch watch;
    const std::vector<GraphTensor> outputs = network.Run(input);
    times.push_back(1000 * watch.seconds());
    sum = std::accumulate(outputs[0].floats.begin(), outputs[0].floats.end(), 0.0);
  }
  std::sort(times.begin(), times.end());
  std::printf("%s: %zu steps, smallest %.2f, median %.2f ms, made in %.0f ms, sum %.6g\n", file.c_str(),
              network.num_steps(), times.front(), times[times.size() / 2], start_ms, sum);
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  try {
    int runs = 15;
    std::vector<std::string> files;
    for (int i = 1; i < argc; ++i) {
      if (std::strcmp(argv[i], "--runs") == 0 && i + 1 < argc) {
        runs = std::max(1, std::stoi(argv[++i]));
      } else {
        files.emplace_back(argv[i]);
      }
    }
    for (const std::string& file : files) bodyloom::Measure(file, runs);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
