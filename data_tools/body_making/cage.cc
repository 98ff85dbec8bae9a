// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/cage.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>

#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kMaxVertices = 100'000;
constexpr double kMaxCoordinate = 100;  // metres

std::vector<std::string_view> Split(std::string_view line, const char* separators) {
  std::vector<std::string_view> fields;
  size_t begin = line.find_first_not_of(separators);
  while (begin != std::string_view::npos) {
    const size_t end = line.find_first_of(separators, begin);
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(separators, end);
  }
  return fields;
}

class Parser {
 public:
  explicit Parser(const std::string& where) : where_(where) {}

  void ReadLine(std::string_view line) {
    ++line_number_;
    line = line.substr(0, line.find('#'));
    const std::vector<std::string_view> fields = Split(line, " \t\r");
    if (fields.empty()) return;
    if (fields[0] == "v") {
      ReadVertex(fields);
    } else if (fields[0] == "f") {
      ReadQuad(fields);
    } else {
      Fail("starts with '" + PrintableText(fields[0]) + "', expected v, f or #");
    }
  }

  /// Left half in file order, then its mirror image.
  Cage Finish() const {
    if (positions_.empty() || quads_.empty()) {
      throw std::runtime_error(where_ + ": " + std::to_string(positions_.size()) + " vertices and " +
                               std::to_string(quads_.size()) + " quads, expected a cage (v and f lines)");
    }
    Cage cage;
    const int num_left = static_cast<int>(positions_.size());
    cage.num_left_vertices = num_left;
    cage.num_left_quads = static_cast<int>(quads_.size());
    cage.vertex_names = names_;
    cage.mirror.resize(num_left);
    for (int v = 0; v < num_left; ++v) {
      if (positions_[v].x() == 0) {
        cage.mirror[v] = v;
        continue;
      }
      cage.mirror[v] = static_cast<int>(cage.vertex_names.size());
      cage.mirror.push_back(v);
      cage.vertex_names.push_back(names_[v] + "'");
    }
    cage.vertices.resize(static_cast<Eigen::Index>(cage.mirror.size()), 3);
    for (int v = 0; v < num_left; ++v) {
      cage.vertices.row(v) = positions_[v].transpose();
      if (cage.mirror[v] != v) {
        cage.vertices.row(cage.mirror[v]) << -positions_[v].x(), positions_[v].y(), positions_[v].z();
      }
    }
    cage.quads = quads_;
    cage.child_charts = charts_;
    for (size_t q = 0; q < quads_.size(); ++q) {
      Quad mirrored;
      std::array<std::string, 4> charts;
      for (int k = 0; k < 4; ++k) {
        mirrored[k] = cage.mirror[quads_[q][3 - k]];
        charts[k] = charts_[q][3 - k];
      }
      cage.quads.push_back(mirrored);
      cage.child_charts.push_back(charts);
    }
    CheckClosed(cage);
    return cage;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw std::runtime_error(where_ + ": line " + std::to_string(line_number_) + ": " + what);
  }

  double Number(std::string_view text) const {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= kMaxCoordinate)) {
      Fail("'" + PrintableText(text) + "' is not a coordinate in metres within +-100");
    }
    return value;
  }

  void ReadVertex(const std::vector<std::string_view>& fields) {
    if (fields.size() != 5) Fail("a vertex of " + std::to_string(fields.size()) + " fields, expected: v NAME X Y Z");
    const std::string name(fields[1]);
    const Eigen::Vector3d position(Number(fields[2]), Number(fields[3]), Number(fields[4]));
    if (position.x() < 0) Fail("vertex '" + PrintableText(name) + "' has x < 0, expected the left half (x >= 0)");
    if (positions_.size() >= kMaxVertices) Fail("more than " + std::to_string(kMaxVertices) + " vertices");
    if (!index_of_.emplace(name, static_cast<int>(positions_.size())).second) {
      Fail("vertex '" + PrintableText(name) + "' is defined twice");
    }
    names_.push_back(name);
    positions_.push_back(position);
  }

  void ReadQuad(const std::vector<std::string_view>& fields) {
    if (fields.size() != 6)
      Fail("a quad of " + std::to_string(fields.size()) + " fields, expected: f CHART N1 N2 N3 N4");
    if (quads_.size() >= kMaxVertices) Fail("more than " + std::to_string(kMaxVertices) + " quads");
    const std::vector<std::string_view> charts = Split(fields[1], "|");
    if (charts.size() != 1 && charts.size() != 4) {
      Fail("'" + PrintableText(fields[1]) + "' names " + std::to_string(charts.size()) + " charts, expected 1 or 4");
    }
    Quad quad;
    std::array<std::string, 4> names;
    for (int k = 0; k < 4; ++k) {
      const auto found = index_of_.find(std::string(fields[2 + k]));
      if (found == index_of_.end()) Fail("vertex '" + PrintableText(fields[2 + k]) + "' is not defined above");
      quad[k] = found->second;
      names[k] = std::string(charts[charts.size() == 1 ? 0 : k]);
    }
    if (std::set<int>(quad.begin(), quad.end()).size() != 4) Fail("a quad that uses a vertex twice");
    quads_.push_back(quad);
    charts_.push_back(names);
  }

  /// Every directed edge once and its opposite once: closed, manifold and consistently oriented; no loose vertex.
  void CheckClosed(const Cage& cage) const {
    std::set<std::pair<int, int>> directed;
    std::vector<bool> used(cage.vertex_names.size(), false);
    for (const Quad& quad : cage.quads) {
      for (int k = 0; k < 4; ++k) {
        used[quad[k]] = true;
        if (!directed.emplace(quad[k], quad[(k + 1) % 4]).second) {
          throw std::runtime_error(where_ + ": edge " + PrintableText(cage.vertex_names[quad[k]]) + " -> " +
                                   PrintableText(cage.vertex_names[quad[(k + 1) % 4]]) +
                                   " belongs to two quads in the same direction, expected an oriented manifold");
        }
      }
    }
    for (const auto& [a, b] : directed) {
      if (!directed.contains({b, a})) {
        throw std::runtime_error(where_ + ": edge " + PrintableText(cage.vertex_names[a]) + " -> " +
                                 PrintableText(cage.vertex_names[b]) +
                                 " has a quad on one side only, expected a closed mesh");
      }
    }
    for (size_t v = 0; v < used.size(); ++v) {
      if (!used[v])
        throw std::runtime_error(where_ + ": vertex '" + PrintableText(cage.vertex_names[v]) + "' belongs to no quad");
    }
  }

  std::string where_;
  int line_number_ = 0;
  std::map<std::string, int> index_of_;
  std::vector<std::string> names_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Quad> quads_;
  std::vector<std::array<std::string, 4>> charts_;
};

}  // namespace

Cage ParseCage(const std::string& text, const std::string& where) {
  Parser parser(where);
  std::string_view rest = text;
  while (!rest.empty()) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    parser.ReadLine(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return parser.Finish();
}

Eigen::MatrixXd MirrorCageRows(const Cage& cage, const Eigen::MatrixXd& left_rows) {
  BODYLOOM_CHECK(left_rows.rows() == cage.num_left_vertices && left_rows.cols() % 3 == 0, "cage rows are ",
                 left_rows.rows(), "x", left_rows.cols(), ", expected ", cage.num_left_vertices, " x a multiple of 3");
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(cage.mirror.size()), left_rows.cols());
  rows.topRows(left_rows.rows()) = left_rows;
  for (int v = 0; v < cage.num_left_vertices; ++v) {
    if (cage.mirror[v] == v) continue;
    rows.row(cage.mirror[v]) = left_rows.row(v);
    for (Eigen::Index c = 0; c < left_rows.cols(); c += 3) rows(cage.mirror[v], c) = -left_rows(v, c);
  }
  return rows;
}

}  // namespace bodyloom
