// SPDX-License-Identifier: Apache-2.0
/// The split of a motion library, read from a text file: class of each clip, and training or test.
///
/// Text format, one line per clip: `name  class  train|test  [performer=…] [fps=…]`, separated by blanks; `#` starts a
/// comment. The name is the clip's path without the extensions of its format (.gz, .bvh, .amc, …), or its last
/// parts: `05_02` names `cmu_bvh/05_02.bvh.gz` and `05_02.amc` alike, `cmu_bvh/05_02` only the first. A `*` in a name
/// stands for any characters: `49_*`. The longest part of the path with a match counts; of the names that match it, one
/// without `*` precedes patterns, and a longer pattern a shorter one.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom {

struct MotionSplitEntry {
  std::string motion_class;
  bool test = false;
  std::string performer;  ///< if not evident from the clip's name; else empty
  double fps = 0;         ///< capture rate, if missing or wrong in the clip's file; 0: that of the file
};

class MotionSplit {
 public:
  /// Returns the entry of a clip by its path ('/' separators); nullptr if no name matches. `name`, when given, receives
  /// the matching name.
  [[nodiscard]] const MotionSplitEntry* Find(const std::string& path, std::string* name = nullptr) const;
  [[nodiscard]] const std::map<std::string, MotionSplitEntry>& entries() const { return entries_; }

 private:
  [[nodiscard]] const MotionSplitEntry* FindPart(const std::string& part) const;

  friend MotionSplit MotionSplitFromText(const std::string& text, const std::string& where);
  std::map<std::string, MotionSplitEntry> entries_;
};

/// Names of the classes: walk run jump dance kick punch sport climb sit reach exercise floor acrobatic other.
const std::vector<std::string>& MotionClasses();

/// Throws std::runtime_error "where: line N: …" for a line with fewer than three words, an unknown class, a third word
/// that is neither train nor test, other words after it, a rate outside 1 to 1000, and a repeated name.
MotionSplit MotionSplitFromText(const std::string& text, const std::string& where);
MotionSplit ReadMotionSplit(const std::string& path);

/// The built-in split (assets/lifter/motion_split.txt, embedded), and its text.
const MotionSplit& BuiltinMotionSplit();
const std::string& BuiltinMotionSplitText();

/// A path without the extensions of motion files: "a/05_02.bvh.gz" → "a/05_02".
std::string WithoutMotionExtension(const std::string& path);

}  // namespace bodyloom
