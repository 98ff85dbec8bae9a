// SPDX-License-Identifier: Apache-2.0
// Time and error of everything from posed vertices to descriptor files and textures, on the built-in body:
//   build/release/benchmarks/bodyloom_bench_descriptors [--section NAME] [--folder DIR] [--track NPZ [--truth NPZ]]
// NAME: normals, velocities, tracked, bake, seams, stream, texture or all. `tracked` is of --track: its jitter, and the
// velocities' errors against --truth (bodyloom synth … --fps 120); without --track it is left out. DIR (default: the
// system's temporary folder) takes the files that are timed, and the textures to look at. Times are the median and the
// minimum of many repetitions, one thread unless stated.
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/speed/moving_body.h"
#include "data_tools/body/builtin_body.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

void Run(const BenchArguments& arguments, const std::string&) {
  const std::string &only = arguments.Text("section"), &folder = arguments.Text("folder");
  const BodyModel& body = BuiltinBody();
  const std::vector<std::pair<std::string, std::function<void()>>> sections = {
      {"normals", [&] { BenchNormals(body); }},
      {"velocities", [&] { BenchVelocities(body); }},
      {"tracked",
       [&] {
         if (!arguments.Text("track").empty()) BenchTracked(body, arguments.Text("track"), arguments.Text("truth"));
       }},
      {"bake", [&] { BenchBake(body); }},
      {"seams", [&] { BenchSeams(body); }},
      {"stream", [&] { BenchStream(body, folder); }},
      {"texture", [&] { BenchTexture(body, folder); }}};
  bool known = false;
  for (const auto& [name, bench] : sections) {
    if (only != "all" && only != name) continue;
    known = true;
    bench();
  }
  BODYLOOM_CHECK(known, "--section is '", only,
                 "', expected normals, velocities, tracked, bake, seams, stream, texture or all");
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain(
      "bodyloom_bench_descriptors", argc, argv,
      {{"folder", std::filesystem::temp_directory_path().string()}, {"section", "all"}, {"track", ""}, {"truth", ""}},
      bodyloom::Run);
}
