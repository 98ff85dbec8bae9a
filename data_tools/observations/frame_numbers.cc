// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/frame_numbers.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int64_t kMaxNumbers = 1'000'000;
constexpr size_t kMaxDigits = 15;

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The name without folder, extension and OpenPose's ending.
std::string StemOf(const std::string& file_name) {
  std::string stem = std::filesystem::path(file_name).filename().string();
  const size_t dot = stem.rfind('.');
  // An extension starts with a letter: "cam01.0037" has none.
  if (dot != std::string::npos && dot + 1 < stem.size() && !IsDigit(stem[dot + 1])) stem.resize(dot);
  const std::string ending = "_keypoints";
  if (stem.ends_with(ending)) stem.resize(stem.size() - ending.size());
  return stem;
}

/// The last run of digits before *end, which becomes its begin; −1 if there is none or it is too long.
int64_t TakeLastNumber(const std::string& stem, size_t* end) {
  while (*end > 0 && !IsDigit(stem[*end - 1])) --*end;
  const size_t behind = *end;
  while (*end > 0 && IsDigit(stem[*end - 1])) --*end;
  size_t begin = *end;
  while (begin < behind && stem[begin] == '0' && behind - begin > 1) ++begin;
  if (begin == behind || behind - begin > kMaxDigits) return -1;
  return std::stoll(stem.substr(begin, behind - begin));
}

}  // namespace

int64_t FrameNumberFromName(const std::string& file_name) {
  const std::string stem = StemOf(file_name);
  size_t end = stem.size();
  return TakeLastNumber(stem, &end);
}

std::vector<int64_t> FrameNumbersFromNames(const std::vector<std::string>& names) {
  std::vector<int64_t> numbers;
  std::vector<std::string> stems;
  std::vector<size_t> ends;  // of the part of each stem that is not yet read
  for (const std::string& name : names) {
    stems.push_back(StemOf(name));
    ends.push_back(stems.back().size());
    numbers.push_back(TakeLastNumber(stems.back(), &ends.back()));
  }
  const auto differ = [](const std::vector<int64_t>& all) {
    return std::adjacent_find(all.begin(), all.end(), std::not_equal_to<>()) != all.end();
  };
  const auto none_is_missing = [](const std::vector<int64_t>& all) {
    return std::find(all.begin(), all.end(), -1) == all.end();
  };
  std::vector<int64_t> earlier = numbers;
  while (!earlier.empty() && none_is_missing(earlier) && !differ(earlier)) {
    for (size_t i = 0; i < stems.size(); ++i) earlier[i] = TakeLastNumber(stems[i], &ends[i]);
  }
  return none_is_missing(earlier) ? earlier : numbers;
}

std::vector<int64_t> NumbersOrOrder(const std::vector<std::string>& names) {
  std::vector<int64_t> numbers = FrameNumbersFromNames(names);
  if (std::find(numbers.begin(), numbers.end(), -1) != numbers.end()) {
    for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int64_t>(i);
  }
  return numbers;
}

FrameGrid MakeFrameGrid(const std::vector<int64_t>& numbers, double fps, const std::string& where) {
  BODYLOOM_CHECK(fps > 0 && fps < 1e6, "frame rate ", fps, " must be positive");
  FrameGrid grid;
  if (numbers.empty()) return grid;
  std::vector<int64_t> sorted = numbers;
  std::sort(sorted.begin(), sorted.end());
  int64_t step = 0;
  for (size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] == sorted[i - 1]) {
      throw std::runtime_error(where + ": frame number " + std::to_string(sorted[i]) + " occurs twice");
    }
    step = std::gcd(step, sorted[i] - sorted[i - 1]);
  }
  step = std::max<int64_t>(1, step);
  const int64_t num_frames = (sorted.back() - sorted.front()) / step + 1;
  if (num_frames > kMaxNumbers) {
    throw std::runtime_error(where + ": frame numbers " + std::to_string(sorted.front()) + " to " +
                             std::to_string(sorted.back()) + " span " + std::to_string(num_frames) +
                             " frames, at most " + std::to_string(kMaxNumbers) + " are read");
  }
  grid.index.reserve(numbers.size());
  for (const int64_t number : numbers) grid.index.push_back(static_cast<int>((number - sorted.front()) / step));
  grid.timestamps.reserve(num_frames);
  for (int64_t t = 0; t < num_frames; ++t) {
    grid.timestamps.push_back(static_cast<double>(sorted.front() + t * step) / fps);
  }
  return grid;
}

namespace {

/// Keeps frames [first, last] of what has `each` elements a frame.
template <typename T>
void Cut(int first, int last, int each, std::vector<T>* all) {
  all->erase(all->begin() + std::ptrdiff_t{each} * (last + 1), all->end());
  all->erase(all->begin(), all->begin() + std::ptrdiff_t{each} * first);
}

void CheckSpan(int first, int last, int num_frames) {
  BODYLOOM_CHECK(0 <= first && first <= last && last < num_frames, "frames ", first, " to ", last, " of a clip of ",
                 num_frames);
}

}  // namespace

KeypointSequence CutFrames(KeypointSequence keypoints, int first, int last) {
  CheckSpan(first, last, keypoints.num_frames());
  Cut(first, last, keypoints.num_points(), &keypoints.points);
  Cut(first, last, 1, &keypoints.timestamps);
  return keypoints;
}

HandsAndFaceSequence CutFrames(HandsAndFaceSequence hands_and_face, int first, int last) {
  CheckSpan(first, last, hands_and_face.num_frames());
  Cut(first, last, 1, &hands_and_face.frames);
  Cut(first, last, 1, &hands_and_face.timestamps);
  return hands_and_face;
}

DenseSequence CutFrames(DenseSequence dense, int first, int last) {
  CheckSpan(first, last, dense.num_frames());
  Cut(first, last, 1, &dense.frames);
  Cut(first, last, 1, &dense.timestamps);
  return dense;
}

PartLabelSequence CutFrames(PartLabelSequence labels, int first, int last) {
  CheckSpan(first, last, labels.num_frames());
  Cut(first, last, 1, &labels.frames);
  Cut(first, last, 1, &labels.timestamps);
  return labels;
}

}  // namespace bodyloom
