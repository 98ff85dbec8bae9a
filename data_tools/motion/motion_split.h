// SPDX-License-Identifier: Apache-2.0
/// The written-down division of a motion library: what each clip shows and whether it is kept for testing.
///
/// A text file, one line a clip: `name  class  train|test  [performer=…] [fps=…]`, separated by blanks; `#` hides the
/// rest of a line. The name is the clip's path without the extensions of its format (.gz, .bvh, .amc, …), or its last
/// parts: `05_02` names `cmu_bvh/05_02.bvh.gz` and `05_02.amc` alike, `cmu_bvh/05_02` only the first. A `*` in a name
/// stands for any characters: `49_*`. The longest part of the path that is named counts; of the names that fit it, one
/// without `*` before patterns, a longer pattern before a shorter one.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom {

struct MotionSplitEntry {
  std::string motion_class;
  bool test = false;
  std::string performer;  ///< where the clip's name does not tell; else empty
  double fps = 0;         ///< at which the clip was captured, where its file says nothing or otherwise; 0: as it says
};

class MotionSplit {
 public:
  /// The entry for a clip by its path ('/' separators); nullptr when it is not named. `name`, when given, receives the
  /// name by which it was found.
  [[nodiscard]] const MotionSplitEntry* Find(const std::string& path, std::string* name = nullptr) const;
  [[nodiscard]] const std::map<std::string, MotionSplitEntry>& entries() const { return entries_; }

 private:
  [[nodiscard]] const MotionSplitEntry* FindPart(const std::string& part) const;

  friend MotionSplit MotionSplitFromText(const std::string& text, const std::string& where);
  std::map<std::string, MotionSplitEntry> entries_;
};

/// What a clip may show: walk run jump dance kick punch sport climb sit reach exercise floor
/// acrobatic other.
const std::vector<std::string>& MotionClasses();

/// Throws std::runtime_error "where: line N: …" for a line with less than three words, an unknown class, a third word
/// that is neither train nor test, other words after it, a rate outside 1 to 1000, and a name that came before.
MotionSplit MotionSplitFromText(const std::string& text, const std::string& where);
MotionSplit ReadMotionSplit(const std::string& path);

/// The project's own (assets/lifter/motion_split.txt, embedded), and its text.
const MotionSplit& BuiltinMotionSplit();
const std::string& BuiltinMotionSplitText();

/// A path without the extensions of motion files: "a/05_02.bvh.gz" → "a/05_02".
std::string WithoutMotionExtension(const std::string& path);

}  // namespace bodyloom
