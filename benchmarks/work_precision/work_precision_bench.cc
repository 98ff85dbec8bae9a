// SPDX-License-Identifier: Apache-2.0
/// Work-precision benchmark: error against time of the solvers of a sequence and of alternatives on the same problems,
/// and of every stage.
///
///   bodyloom_bench_work_precision [--sections
///   set,tolerance,counts,lengths,threads,peers,track,describe,evaluate,whole]
///                                 [--threads 2] [--repeat 3] [--lengths 1,10,100,600] [--peer_frames 1,20]
///                                 [--pytorch adam:0.02:300,lbfgs:1:100] [--autodiff_frames 20] [--set_autodiff 1]
///                                 [--json F]
///
/// Time is given twice: wall, and processor time of the process, which a busy machine disturbs less. Each is the median
/// over `repeat` solves, engines taking turns; the spread is half the range over it. cost_excess: final cost over the
/// lowest that any engine found on the problem, minus one. The JSON holds tables and plots; `./dev bench --render` puts
/// both into the documentation, `./dev bench --compare` tells two of them apart.
#include <algorithm>
#include <iterator>
#include <utility>

#include "benchmarks/work_precision/sections.h"
#include "geometry/base/check.h"
#include "tests/support/paths.h"

namespace bodyloom {
namespace {

void RunSections(const BenchArguments& arguments, const std::string& command) {
  WorkBench bench{arguments, {}, arguments.Integer("threads"), arguments.Integer("repeat")};
  bench.report.title = "Run time against error";
  bench.report.command = command;
  bench.report.label_columns = {"problem", "engine"};
  bench.report.value_columns = kWorkColumns;
  bench.report.summarise = false;
  bench.report.notes = {"times: milliseconds a frame, medians of wall and processor time",
                        "error and bound: mean projection error, pixels at 512, unless the heading says otherwise"};
  const std::pair<const char*, void (*)(WorkBench*)> sections[] = {
      {"set", SetSection},           {"tolerance", ToleranceSection},
      {"counts", CountSection},      {"lengths", LengthSection},
      {"threads", ThreadSection},    {"peers", PeerSection},
      {"track", TrackSection},       {"describe", DescribeSection},
      {"evaluate", EvaluateSection}, {"evaluation", EvaluationSection},
      {"whole", WholeSection}};
  for (const std::string& name : arguments.List("sections")) {
    const auto* found = std::find_if(std::begin(sections), std::end(sections),
                                     [&](const auto& section) { return section.first == name; });
    BODYLOOM_CHECK(found != std::end(sections), "--sections names '", name, "'");
    found->second(&bench);
  }
  HandOver(bench.report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  const std::string data = bodyloom::SharedDir() + "/data/aistpp/motions/";
  return bodyloom::BenchMain(
      "bodyloom_bench_work_precision", argc, argv,
      {{"motions", data + "gBR_sBM_cAll_d06_mBR2_ch06.pkl," + data + "gJS_sBM_cAll_d03_mJS2_ch07.pkl"},
       {"sections", "set,tolerance,counts,lengths,threads,peers,track,describe,evaluate,whole"},
       {"threads", "2"},
       {"repeat", "3"},
       {"lengths", "1,10,100,600"},
       {"peer_frames", "1,20"},
       {"pytorch", "adam:0.02:300,adam:0.05:300,lbfgs:1:100"},
       {"autodiff_frames", "20"},
       {"set_autodiff", "1"},
       {"json", ""}},
      bodyloom::RunSections);
}
