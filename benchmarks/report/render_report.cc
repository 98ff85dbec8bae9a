// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/report/render_report.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

const std::string kOpen = "<!-- benchmark: ", kOpenEnd = " -->", kClose = "<!-- /benchmark -->", kNotes = "notes: ";

std::string Words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// The notes that begin with `word`, as a list.
std::string Notes(const SavedReport& saved, const std::string& word) {
  std::string text;
  for (const std::string& note : saved.report.notes) {
    if (note.starts_with(word)) text += "- " + note + "\n";
  }
  return text;
}

}  // namespace

std::string MarkdownTable(const SavedReport& saved, const std::string& group) {
  const BenchReport& report = saved.report;
  std::vector<const BenchRow*> rows;
  for (const BenchRow& row : report.rows) {
    if (row.group == group) rows.push_back(&row);
  }
  std::vector<size_t> columns;
  for (size_t c = 0; c < report.value_columns.size(); ++c) {
    const bool shown =
        std::any_of(rows.begin(), rows.end(), [c](const BenchRow* r) { return std::isfinite(r->values[c]); });
    if (shown) columns.push_back(c);
  }
  std::string head = "|", rule = "|", body;
  for (const std::string& label : report.label_columns) {
    head += " " + Words(label) + " |";
    rule += "---|";
  }
  for (size_t c : columns) {
    head += " " + Words(report.value_columns[c]) + " |";
    rule += "---|";
  }
  for (const BenchRow* row : rows) {
    body += "|";
    for (const std::string& label : row->labels) body += " " + label + " |";
    for (size_t c : columns) body += " " + BenchNumber(row->values[c]) + " |";
    body += "\n";
  }
  return Concatenate(head, "\n", rule, "\n", body, "\n`", report.command, "`, commit ", saved.environment.at("commit"),
                     ", ", saved.environment.at("processor"), ", ", saved.environment.at("cores"), " cores.\n");
}

std::string RenderIntoPage(const std::string& page, const std::string& page_name, const SavedReport& saved,
                           std::vector<std::string>* rendered) {
  const auto has_group = [&](const std::string& name) {
    return std::any_of(saved.report.rows.begin(), saved.report.rows.end(),
                       [&](const BenchRow& row) { return row.group == name; });
  };
  std::string result;
  size_t at = 0;
  while (true) {
    const size_t open = page.find(kOpen, at);
    if (open == std::string::npos) return result + page.substr(at);
    const size_t name_at = open + kOpen.size(), name_end = page.find(kOpenEnd, name_at);
    const size_t close = page.find(kClose, name_at);
    const std::string name = name_end == std::string::npos ? "" : page.substr(name_at, name_end - name_at);
    if (name_end == std::string::npos || close == std::string::npos || name_end > close ||
        page.find(kOpen, name_at) < close) {
      throw std::runtime_error(Concatenate(page_name, ": the mark \"", page.substr(open, 60),
                                           "\" is not closed, expected \"", kClose, "\" after it"));
    }
    result += page.substr(at, name_end + kOpenEnd.size() - at);
    const std::string notes = name.starts_with(kNotes) ? Notes(saved, name.substr(kNotes.size())) : "";
    if (!notes.empty() || has_group(name)) {
      result += "\n" + (notes.empty() ? MarkdownTable(saved, name) : notes);
      if (rendered != nullptr) rendered->push_back(name);
    } else {
      result += page.substr(name_end + kOpenEnd.size(), close - name_end - kOpenEnd.size());
    }
    result += kClose;
    at = close + kClose.size();
  }
}

}  // namespace bodyloom
