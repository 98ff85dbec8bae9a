// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_split.h"

#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"

// Made by bodyloom_embed() in data_tools/CMakeLists.txt.
extern "C" {
extern const char bodyloom_motion_split_begin[], bodyloom_motion_split_end[];
}

namespace bodyloom {
namespace {

constexpr size_t kMaxSplitBytes = size_t{1} << 26;
constexpr double kMaxFps = 1000;

/// Parses a word after train or test; false for anything else.
bool ReadDetail(const std::string& word, MotionSplitEntry* entry) {
  if (word.starts_with("performer=")) {
    entry->performer = word.substr(10);
    return !entry->performer.empty();
  }
  if (!word.starts_with("fps=")) return false;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data() + 4, end, entry->fps);
  return error == std::errc() && stop == end && entry->fps >= 1 && entry->fps <= kMaxFps;
}

}  // namespace

const std::vector<std::string>& MotionClasses() {
  static const std::vector<std::string> classes = {"walk",  "run", "jump",  "dance",    "kick",  "punch",     "sport",
                                                   "climb", "sit", "reach", "exercise", "floor", "acrobatic", "other"};
  return classes;
}

std::string WithoutMotionExtension(const std::string& path) {
  std::string name = path;
  const auto drop = [&name](const std::string& extension) {
    const bool ends = name.size() > extension.size() && name.ends_with(extension);
    if (ends) name.resize(name.size() - extension.size());
    return ends;
  };
  drop(".gz");
  for (const char* extension : {".bvh", ".amc", ".npz", ".npy", ".pkl", ".json", ".txt"}) {
    if (drop(extension)) break;
  }
  return name;
}

const MotionSplitEntry* MotionSplit::FindPart(const std::string& part) const {
  if (const auto found = entries_.find(part); found != entries_.end()) return &found->second;
  const MotionSplitEntry* best = nullptr;
  size_t longest = 0;
  for (const auto& [name, entry] : entries_) {
    if (name.size() <= longest || name.find('*') == std::string::npos) continue;
    if (fnmatch(name.c_str(), part.c_str(), FNM_PATHNAME | FNM_NOESCAPE) != 0) continue;
    best = &entry;
    longest = name.size();
  }
  return best;
}

const MotionSplitEntry* MotionSplit::Find(const std::string& path, std::string* name) const {
  // From the whole path to its last part, so that the longest name is found first.
  for (std::string rest = WithoutMotionExtension(path);;) {
    if (const MotionSplitEntry* found = FindPart(rest)) {
      if (name != nullptr) *name = rest;
      return found;
    }
    const size_t slash = rest.find('/');
    if (slash == std::string::npos) return nullptr;
    rest.erase(0, slash + 1);
  }
}

MotionSplit MotionSplitFromText(const std::string& text, const std::string& where) {
  MotionSplit split;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error(where + ": line " + std::to_string(number) + ": " + what);
    };
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<std::string> found;
    for (std::string word; words >> word;) found.push_back(word);
    if (found.empty()) continue;
    if (found.size() < 3) {
      fail("found " + std::to_string(found.size()) + " words, expected at least 3: name, class, train or test");
    }
    const std::vector<std::string>& classes = MotionClasses();
    if (std::find(classes.begin(), classes.end(), found[1]) == classes.end()) {
      std::string known;
      for (const std::string& name : classes) known += (known.empty() ? "" : ", ") + name;
      fail("found class '" + PrintableText(found[1]) + "', expected one of " + known);
    }
    if (found[2] != "train" && found[2] != "test")
      fail("found '" + PrintableText(found[2]) + "', expected train or test");
    MotionSplitEntry entry{found[1], found[2] == "test", "", 0};
    for (size_t i = 3; i < found.size(); ++i) {
      if (!ReadDetail(found[i], &entry)) {
        fail("found '" + PrintableText(found[i]) + "', expected performer=NAME or fps=RATE of 1 to 1000");
      }
    }
    if (!split.entries_.try_emplace(found[0], entry).second) {
      fail("'" + PrintableText(found[0]) + "' a second time, expected one line a clip");
    }
  }
  return split;
}

MotionSplit ReadMotionSplit(const std::string& path) {
  return MotionSplitFromText(ReadFileBytes(path, kMaxSplitBytes), path);
}

const MotionSplit& BuiltinMotionSplit() {
  static const MotionSplit split =
      MotionSplitFromText(BuiltinMotionSplitText(), "assets/lifter/motion_split.txt (built in)");
  return split;
}

const std::string& BuiltinMotionSplitText() {
  static const std::string text(bodyloom_motion_split_begin, bodyloom_motion_split_end);
  return text;
}

}  // namespace bodyloom
