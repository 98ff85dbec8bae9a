// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "data_tools/formats/csv_lines.h"
#include "data_tools/formats/printable.h"
#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

enum class Coordinate { kX, kY, kLikelihood };

/// Meaning of a cell of each row.
struct Column {
  int individual = 0, landmark = 0;
  Coordinate coordinate = Coordinate::kX;
};

struct Header {
  size_t num_index_cells = 1;   ///< of the frame's name or number, in front of the values
  std::vector<Column> columns;  ///< of the values; landmark −1: left out
  std::vector<std::string> names;
  int num_individuals = 0;
};

int IndexIn(const std::string& name, std::vector<std::string>* names) {
  const auto found = std::find(names->begin(), names->end(), name);
  if (found != names->end()) return static_cast<int>(found - names->begin());
  names->push_back(name);
  return static_cast<int>(names->size()) - 1;
}

Coordinate CoordinateOf(std::string_view text, const CsvLines& lines) {
  if (text == "x") return Coordinate::kX;
  if (text == "y") return Coordinate::kY;
  if (text == "likelihood") return Coordinate::kLikelihood;
  lines.Fail("found '" + PrintableText(text) + "', expected x, y or likelihood");
}

Header ReadHeader(CsvLines* lines) {
  std::map<std::string, CsvCells, std::less<>> rows;
  CsvCells cells;
  while (rows.find("coords") == rows.end()) {
    if (!lines->Next(&cells)) lines->Fail("the file ends, expected the row 'coords'");
    const std::string_view name = cells[0];
    if (name != "scorer" && name != "individuals" && name != "bodyparts" && name != "coords") {
      lines->Fail("found '" + PrintableText(name) + "', expected scorer, individuals, bodyparts or coords");
    }
    rows[std::string(name)] = cells;
  }
  const CsvCells& coords = rows["coords"];
  const CsvCells bodyparts = rows["bodyparts"], individuals = rows["individuals"];
  if (bodyparts.size() != coords.size() || (!individuals.empty() && individuals.size() != coords.size())) {
    lines->Fail(Concatenate(coords.size(), " cells, expected as many as in the other rows of the header"));
  }
  Header header;
  while (header.num_index_cells < coords.size() && coords[header.num_index_cells].empty()) ++header.num_index_cells;
  std::vector<std::string> people;
  const auto is_single = [](std::string_view individual) { return individual == "single"; };
  const bool has_others =
      !individuals.empty() &&
      !std::all_of(individuals.begin() + std::ptrdiff_t(header.num_index_cells), individuals.end(), is_single);
  for (size_t c = header.num_index_cells; c < coords.size(); ++c) {
    Column column{0, -1, CoordinateOf(coords[c], *lines)};
    if (individuals.empty() || !has_others || !is_single(individuals[c])) {
      column.individual = individuals.empty() ? 0 : IndexIn(std::string(individuals[c]), &people);
      column.landmark = IndexIn(LandmarkNameFrom(bodyparts[c]), &header.names);
    }
    header.columns.push_back(column);
  }
  header.num_individuals = std::max(1, static_cast<int>(people.size()));
  if (header.names.size() * static_cast<size_t>(header.num_individuals) > 2 * header.columns.size()) {
    lines->Fail(Concatenate(people.size(), " individuals and ", header.names.size(),
                            " body parts, expected the same body parts for each individual"));
  }
  if (std::none_of(header.names.begin(), header.names.end(), IsPersonLandmark)) {
    lines->Fail("body parts " + PrintableList(header.names) +
                ", none of which is a person's; expected names such as nose, left_shoulder, right_knee");
  }
  return header;
}

/// The people of one row: those with a landmark.
std::vector<DetectedPerson> PeopleOfRow(const CsvCells& cells, const Header& header, const CsvLines& lines) {
  struct Values {
    double x = std::numeric_limits<double>::quiet_NaN(), y = x, confidence = 1;
  };
  const size_t K = header.names.size();
  std::vector<Values> values(K * static_cast<size_t>(header.num_individuals));
  for (size_t c = 0; c < header.columns.size(); ++c) {
    const Column& column = header.columns[c];
    const double value = lines.Number(cells[header.num_index_cells + c]);
    if (column.landmark < 0) continue;
    Values& point = values[static_cast<size_t>(column.individual) * K + static_cast<size_t>(column.landmark)];
    (column.coordinate == Coordinate::kX   ? point.x
     : column.coordinate == Coordinate::kY ? point.y
                                           : point.confidence) = value;
  }
  std::vector<DetectedPerson> people;
  for (int i = 0; i < header.num_individuals; ++i) {
    DetectedPerson person;
    person.identity = i;
    bool any = false;
    for (size_t k = 0; k < K; ++k) {
      const Values& point = values[static_cast<size_t>(i) * K + k];
      person.points.push_back(DetectedKeypoint(point.x, point.y, point.confidence));
      any = any || person.points.back().confidence > 0;
    }
    if (any) people.push_back(std::move(person));
  }
  return people;
}

}  // namespace

bool IsDeepLabCutCsv(std::string_view text) { return WithoutByteOrderMark(text).starts_with("scorer,"); }

PeopleSequence DeepLabCutFromCsv(std::string_view text, const std::string& where, double fps) {
  CsvLines lines(text, where);
  const Header header = ReadHeader(&lines);
  std::vector<std::vector<DetectedPerson>> frames;
  std::vector<std::string> names;
  CsvCells cells;
  while (lines.Next(&cells)) {
    if (cells.size() != header.num_index_cells + header.columns.size()) {
      lines.Fail(Concatenate(cells.size(), " cells, expected ", header.num_index_cells + header.columns.size(),
                             " as in the header"));
    }
    names.emplace_back(cells[header.num_index_cells - 1]);
    frames.push_back(PeopleOfRow(cells, header, lines));
  }
  const KeypointConvention convention = ConventionOfNames(header.names);
  return PeopleOnGrid(std::move(frames), NumbersOrOrder(names), &convention, fps, where);
}

}  // namespace bodyloom
