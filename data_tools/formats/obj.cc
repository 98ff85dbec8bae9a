// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/obj.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kMaxFile = size_t{1} << 30;

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  ObjMesh Parse() {
    mesh_.face_begin.push_back(0);
    size_t at = 0;
    while (at < text_.size()) {
      const size_t end = std::min(text_.find('\n', at), text_.size());
      line_ = text_.substr(at, end - at);
      at = end + 1;
      ++line_number_;
      const std::string_view keyword = Word();
      if (keyword == "v") ReadNumbers(3, &positions_);
      if (keyword == "vt") ReadNumbers(2, &uv_);
      if (keyword == "f") ReadFace();
    }
    mesh_.positions = Eigen::Map<const MatrixX3d>(positions_.data(), Count(positions_, 3), 3);
    mesh_.uv = Eigen::Map<const MatrixX2d>(uv_.data(), Count(uv_, 2), 2);
    return std::move(mesh_);
  }

 private:
  static int Count(const std::vector<double>& values, int columns) { return static_cast<int>(values.size()) / columns; }

  [[noreturn]] void Fail(const std::string& message) const {
    throw std::runtime_error(Concatenate(where_, ": line ", line_number_, ": ", message));
  }

  /// The next word of the line; empty at its end.
  std::string_view Word() {
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    size_t begin = 0;
    while (begin < line_.size() && is_space(line_[begin])) ++begin;
    size_t end = begin;
    while (end < line_.size() && !is_space(line_[end])) ++end;
    const std::string_view word = line_.substr(begin, end - begin);
    line_.remove_prefix(end);
    return word;
  }

  void ReadNumbers(int n, std::vector<double>* out) {
    for (int i = 0; i < n; ++i) {
      std::string_view word = Word();
      if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);  // from_chars takes no plus
      double value = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
        Fail(Concatenate("'", PrintableText(word), "', expected ", n, " finite numbers"));
      }
      out->push_back(value);
    }
  }

  /// A 1-based index, or a negative one that counts back from the last.
  int Index(std::string_view text, int count, const char* what) const {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      Fail(Concatenate("'", PrintableText(text), "', expected the number of a ", what));
    }
    const int index = value < 0 ? count + value : value - 1;
    if (value == 0 || index < 0 || index >= count) {
      Fail(Concatenate("a face names ", what, " ", value, ", expected 1..", count));
    }
    return index;
  }

  void ReadFace() {
    const size_t first = mesh_.corner_position.size();
    for (std::string_view word = Word(); !word.empty(); word = Word()) {
      const size_t slash = word.find('/');
      mesh_.corner_position.push_back(Index(word.substr(0, slash), Count(positions_, 3), "vertex"));
      int uv = -1;
      if (slash != std::string_view::npos) {
        const std::string_view text = word.substr(slash + 1, word.find('/', slash + 1) - slash - 1);
        if (!text.empty()) uv = Index(text, Count(uv_, 2), "texture coordinate");
      }
      mesh_.corner_uv.push_back(uv);
    }
    if (mesh_.corner_position.size() < first + 3) Fail("a face of fewer than three corners");
    mesh_.face_begin.push_back(static_cast<int>(mesh_.corner_position.size()));
  }

  std::string_view text_, line_;
  const std::string& where_;
  size_t line_number_ = 0;
  std::vector<double> positions_, uv_;
  ObjMesh mesh_;
};

}  // namespace

ObjMesh ReadObjBytes(std::string_view text, const std::string& where) {
  if (text.size() > kMaxFile) {
    throw std::runtime_error(Concatenate(where, ": ", text.size(), " bytes, expected at most ", kMaxFile));
  }
  return ObjParser(text, where).Parse();
}

ObjMesh ReadObj(const std::string& path) { return ReadObjBytes(ReadFileBytes(path, kMaxFile), path); }

}  // namespace bodyloom
