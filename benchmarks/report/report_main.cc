// SPDX-License-Identifier: Apache-2.0
/// Compares and renders benchmarks' JSON (`./dev bench --render …`, `./dev bench --compare …`).
///
///   bodyloom_report --before A.json --after B.json          ratios of two commits, with their spread
///   bodyloom_report --render F.json[,G.json] [--page docs/lab/run_time_against_error.md]
#include <cstdio>
#include <fstream>
#include <sstream>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/report/compare_reports.h"
#include "benchmarks/report/render_report.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"
#include "tests/support/paths.h"

namespace bodyloom {
namespace {

void Render(const std::string& json, const std::string& page_path) {
  const SavedReport saved = ReadSavedReport(json);
  std::ifstream file(page_path, std::ios::binary);
  if (!file) throw std::runtime_error(page_path + ": cannot be opened, expected a page with marks");
  std::ostringstream page;
  page << file.rdbuf();
  std::vector<std::string> rendered;
  const std::string result = RenderIntoPage(page.str(), page_path, saved, &rendered);
  if (!rendered.empty()) WriteFileAtomically(page_path, result);
  for (const std::string& name : rendered) std::printf("%s: %s\n", page_path.c_str(), name.c_str());
}

void RunReport(const BenchArguments& arguments) {
  const bool compares = !arguments.Text("before").empty() && !arguments.Text("after").empty();
  BODYLOOM_CHECK(compares || !arguments.List("render").empty(),
                 "expected --before A.json --after B.json, or --render F.json");
  if (compares) {
    const SavedReport before = ReadSavedReport(arguments.Text("before")),
                      after = ReadSavedReport(arguments.Text("after"));
    std::fputs(ComparisonText(before, after, CompareReports(before, after)).c_str(), stdout);
  }
  for (const std::string& json : arguments.List("render")) Render(json, arguments.Text("page"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain(
      "bodyloom_report", argc, argv,
      {{"before", ""},
       {"after", ""},
       {"render", ""},
       {"page", bodyloom::SourceDir() + "/docs/lab/run_time_against_error.md"}},
      [](const bodyloom::BenchArguments& arguments, const std::string&) { bodyloom::RunReport(arguments); });
}
