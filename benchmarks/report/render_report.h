// SPDX-License-Identifier: Apache-2.0
/// A benchmark's JSON as part of the documentation: tables in Markdown.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/report/saved_report.h"

namespace bodyloom {

/// One group as a table, followed by a line with command, commit and machine. Columns without any number are left out.
std::string MarkdownTable(const SavedReport& saved, const std::string& group);

/// `page` with what stands between "<!-- benchmark: GROUP -->" and the next "<!-- /benchmark -->" replaced by the table
/// of that group, and between "<!-- benchmark: notes: WORD -->" … by a list of the notes that begin with that word, for
/// every marked group that `saved` has. Everything else stays as it is. `rendered`, when given, collects the names of
/// the replaced groups. Throws std::runtime_error with `page_name` when a mark is never closed.
std::string RenderIntoPage(const std::string& page, const std::string& page_name, const SavedReport& saved,
                           std::vector<std::string>* rendered = nullptr);

}  // namespace bodyloom
