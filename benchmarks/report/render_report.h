// SPDX-License-Identifier: Apache-2.0
/// Renders a benchmark's JSON into the documentation, as Markdown tables.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/report/saved_report.h"

namespace bodyloom {

/// One group as a table, followed by a line with command, commit and machine. Columns without numbers are left out.
std::string MarkdownTable(const SavedReport& saved, const std::string& group);

/// Replaces in `page` the text between "<!-- benchmark: GROUP -->" and the next "<!-- /benchmark -->" by the table of
/// that group, and between "<!-- benchmark: notes: WORD -->" … by a list of the notes that begin with that word, for
/// every marked group that `saved` has. The rest is unchanged. `rendered`, if given, collects the names of the replaced
/// groups. Throws std::runtime_error with `page_name` when a mark is not closed.
std::string RenderIntoPage(const std::string& page, const std::string& page_name, const SavedReport& saved,
                           std::vector<std::string>* rendered = nullptr);

}  // namespace bodyloom
