// SPDX-License-Identifier: Apache-2.0
/// Benchmarks' JSON: written and read back, compared, and rendered into a page.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "benchmarks/report/compare_reports.h"
#include "benchmarks/report/render_report.h"
#include "data_tools/formats/atomic_file.h"

namespace bodyloom::report_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Two groups; times of the first are `factor` as long.
BenchReport Report(double factor) {
  BenchReport report;
  report.title = "Toy";
  report.command = "toy --json F";
  report.label_columns = {"problem", "engine"};
  report.value_columns = {"ms", "ms_spread_percent", "error"};
  report.summarise = false;
  report.rows = {{"small", {"1 frame", "a"}, {2 * factor, 3, 0.5}},
                 {"small", {"1 frame", "b"}, {8 * factor, 4, 0.25}},
                 {"large", {"100 frames", "a"}, {30, kNaN, kNaN}}};
  report.notes = {"first", "second"};
  report.plots = {{"toy_plot", "A title", "x", "y", true, false, {{"a", {{1, 2}, {10, 3}}, true, false}}}};
  return report;
}

class Reports : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("bodyloom_report_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  SavedReport Save(const BenchReport& report, const std::string& name = "a.json") {
    WriteFileAtomically(folder_ / name, BenchJson(report));
    return ReadSavedReport(folder_ / name);
  }
  std::filesystem::path folder_;
};

TEST_F(Reports, JsonComesBackAsItWas) {
  const BenchReport report = Report(1);
  const SavedReport saved = Save(report);
  EXPECT_EQ(saved.report.title, report.title);
  EXPECT_EQ(saved.report.command, report.command);
  EXPECT_EQ(saved.report.label_columns, report.label_columns);
  EXPECT_EQ(saved.report.value_columns, report.value_columns);
  EXPECT_EQ(saved.report.notes, report.notes);
  ASSERT_EQ(saved.report.rows.size(), report.rows.size());
  for (size_t i = 0; i < report.rows.size(); ++i) {
    EXPECT_EQ(saved.report.rows[i].group, report.rows[i].group);
    EXPECT_EQ(saved.report.rows[i].labels, report.rows[i].labels);
    for (size_t c = 0; c < 3; ++c) {
      const double expected = report.rows[i].values[c], found = saved.report.rows[i].values[c];
      EXPECT_TRUE(std::isnan(expected) ? std::isnan(found) : expected == found) << i << " " << c;
    }
  }
  EXPECT_FALSE(saved.environment.at("commit").empty());
  EXPECT_NE(BenchJson(report).find("\"file\": \"toy_plot\""), std::string::npos);
}

TEST_F(Reports, ComparisonGivesRatiosWithTheirSpread) {
  const Comparison comparison = CompareReports(Save(Report(1)), Save(Report(0.5), "b.json"));
  ASSERT_EQ(comparison.values.size(), 5U);  // two rows of time and error, one of time; spreads are not compared
  const ComparedValue& first = comparison.values[0];
  EXPECT_EQ(first.column, "ms");
  EXPECT_EQ(first.labels, "1 frame, a");
  EXPECT_DOUBLE_EQ(first.ratio, 0.5);
  EXPECT_NEAR(first.spread_percent, std::hypot(3, 3), 1e-12);
  EXPECT_TRUE(first.Stands());
  EXPECT_DOUBLE_EQ(comparison.values[1].ratio, 1);  // the error
  EXPECT_FALSE(comparison.values[1].Stands());      // no spread is known
  const ComparedValue& last = comparison.values.back();
  EXPECT_EQ(last.group, "large");
  EXPECT_TRUE(std::isnan(last.spread_percent));
  ASSERT_EQ(comparison.columns.size(), 3U);
  EXPECT_EQ(comparison.columns[0].rows, 2);
  EXPECT_NEAR(comparison.columns[0].ratio, 0.5, 1e-12);
  EXPECT_NEAR(comparison.columns[0].spread_percent, 0, 1e-5);
  EXPECT_EQ(comparison.only_before + comparison.only_after, 0);
  EXPECT_TRUE(comparison.warnings.empty());
}

TEST_F(Reports, GeometricMeansSpreadOverTheRows) {
  BenchReport after = Report(1);
  after.rows[0].values[0] *= 2;
  after.rows[1].values[0] *= 0.5;
  const Comparison comparison = CompareReports(Save(Report(1)), Save(after, "b.json"));
  EXPECT_NEAR(comparison.columns[0].ratio, 1, 1e-12);
  EXPECT_NEAR(comparison.columns[0].spread_percent, 100, 1e-9);  // a factor of two either way
}

TEST_F(Reports, ARatioWithinTheSpreadDoesNotStand) {
  const Comparison comparison = CompareReports(Save(Report(1)), Save(Report(1.05), "b.json"));
  EXPECT_FALSE(comparison.values[0].Stands());
}

TEST_F(Reports, RowsWithoutAPartnerAndOtherMachinesAreNamed) {
  BenchReport after = Report(1);
  after.rows[0].labels[1] = "c";
  SavedReport other = Save(after, "b.json");
  other.environment["processor"] = "another";
  const SavedReport before = Save(Report(1));
  const Comparison comparison = CompareReports(before, other);
  EXPECT_EQ(comparison.only_before, 1);
  EXPECT_EQ(comparison.only_after, 1);
  ASSERT_EQ(comparison.warnings.size(), 1U);
  const std::string text = ComparisonText(before, other, comparison);
  EXPECT_NE(text.find("another"), std::string::npos);
  EXPECT_NE(text.find("1 before, 1 after"), std::string::npos);
}

TEST_F(Reports, APageTakesTablesAndKeepsTheRest) {
  const SavedReport saved = Save(Report(1));
  const std::string page =
      "# Page\n<!-- benchmark: small -->\nold\n<!-- /benchmark -->\nbetween\n"
      "<!-- benchmark: unknown -->\nkept\n<!-- /benchmark -->\n<!-- benchmark: notes: sec -->\n<!-- /benchmark "
      "-->\nend\n";
  std::vector<std::string> rendered;
  const std::string result = RenderIntoPage(page, "page.md", saved, &rendered);
  EXPECT_EQ(rendered, (std::vector<std::string>{"small", "notes: sec"}));
  EXPECT_EQ(result.find("old"), std::string::npos);
  EXPECT_NE(result.find("| problem | engine | ms | ms spread percent | error |\n|---|---|---|---|---|\n"
                        "| 1 frame | a | 2 | 3 | 0.500 |\n"),
            std::string::npos)
      << result;
  EXPECT_NE(result.find("\nbetween\n"), std::string::npos);
  EXPECT_NE(result.find("\nkept\n"), std::string::npos);
  EXPECT_NE(result.find("-->\n- second\n<!--"), std::string::npos);
  EXPECT_TRUE(result.ends_with("\nend\n"));
  EXPECT_EQ(RenderIntoPage(result, "page.md", saved), result);  // once more changes nothing
}

TEST_F(Reports, ColumnsWithoutANumberAreLeftOut) {
  const std::string table = MarkdownTable(Save(Report(1)), "large");
  EXPECT_NE(table.find("| problem | engine | ms |\n"), std::string::npos) << table;
}

TEST_F(Reports, AMarkThatIsNotClosedIsNamed) {
  const SavedReport saved = Save(Report(1));
  for (const char* page : {"<!-- benchmark: small -->\n", "<!-- benchmark: small",
                           "<!-- benchmark: a -->\n<!-- benchmark: b -->\n<!-- /benchmark -->\n"}) {
    try {
      RenderIntoPage(page, "page.md", saved);
      ADD_FAILURE() << page;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("page.md: the mark"), std::string::npos) << error.what();
    }
  }
}

TEST_F(Reports, WhatIsNoBenchmarkIsRefused) {
  const std::string good = BenchJson(Report(1));
  for (const std::string& bad : {std::string(), good.substr(0, good.size() / 2), std::string("{}"), std::string("[1]"),
                                 std::string("{\"title\": 3}")}) {
    WriteFileAtomically(folder_ / "bad.json", bad);
    try {
      ReadSavedReport(folder_ / "bad.json");
      ADD_FAILURE() << bad;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("bad.json"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(ReadSavedReport(folder_ / "none.json"), std::runtime_error);
}

}  // namespace
}  // namespace bodyloom::report_test
