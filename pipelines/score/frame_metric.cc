// SPDX-License-Identifier: Apache-2.0
#include "pipelines/score/frame_metric.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/observations/frame_numbers.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

template <typename Pixels>
void RequireSize(const Pixels& image, const Image& truth, const std::string& where) {
  if (image.width == truth.width && image.height == truth.height) return;
  throw std::runtime_error(Concatenate(where, ": ", image.width, "x", image.height, " pixels, expected ", truth.width,
                                       "x", truth.height, " as the truth has"));
}

using FilesByName = std::map<std::string, std::string>;

FilesByName FilesOf(const std::string& folder) {
  FilesByName files;
  for (const std::string& path : ImageFilesOf(folder)) {
    const auto [it, is_new] = files.emplace(fs::path(path).stem().string(), path);
    if (!is_new) throw std::runtime_error(path + ": a second image of this name beside " + it->second);
  }
  return files;
}

/// Number of names of `of` missing in `in`, and the first of them.
std::pair<int, std::string> Missing(const FilesByName& of, const FilesByName& in) {
  std::pair<int, std::string> missing;
  for (const auto& [name, path] : of) {
    if (in.count(name) > 0) continue;
    if (missing.first++ == 0) missing.second = name;
  }
  return missing;
}

/// Returns true if frames `before` and `now` are in one run, or if either is unknown to the runs.
bool InOneRun(const std::vector<int>& runs, int64_t before, int64_t now) {
  const auto count = static_cast<int64_t>(runs.size());
  return before < 0 || now < 0 || before >= count || now >= count || runs[before] == runs[now];
}

/// By name: whether it follows the one before it (FramePairs::Open).
std::vector<char> FollowersAmong(const std::vector<std::string>& names, const std::vector<int>& runs) {
  std::vector<int64_t> numbers;
  numbers.reserve(names.size());
  for (const std::string& name : names) numbers.push_back(FrameNumberFromName(name));
  const auto numbered = [&](size_t i) { return numbers[i] >= 0 && numbers[i - 1] >= 0; };
  int64_t step = 0;
  for (size_t i = 1; i < names.size(); ++i) {
    if (numbered(i)) step = std::gcd(step, numbers[i] - numbers[i - 1]);
  }
  std::vector<char> follows(names.size());
  for (size_t i = 1; i < names.size(); ++i) {
    follows[i] = !numbered(i) || (numbers[i] - numbers[i - 1] == step && InOneRun(runs, numbers[i - 1], numbers[i]));
  }
  return follows;
}

class FolderPairs : public FramePairs {
 public:
  FolderPairs(const std::string& truth, const std::string& result, const std::string& mask, bool common_only,
              const std::vector<int>& runs)
      : truth_(FilesOf(truth)), result_(FilesOf(result)) {
    const auto missing_result = Missing(truth_, result_), missing_truth = Missing(result_, truth_);
    left_out_ = missing_result.first + missing_truth.first;
    for (const std::string& path : ImageFilesOf(truth)) {  // in the order of numbers
      const std::string name = fs::path(path).stem().string();
      if (result_.count(name) > 0) names_.push_back(name);
    }
    if (names_.empty()) {
      throw std::runtime_error(result + ": no image has the name of one in " + truth + " ('" + truth_.begin()->first +
                               "', …)");
    }
    follows_ = FollowersAmong(names_, runs);
    if (!common_only) {
      RequireNone(missing_result, result, truth);
      RequireNone(missing_truth, truth, result);
    }
    if (mask.empty()) return;
    mask_ = FilesOf(mask);
    FilesByName compared;
    for (const std::string& name : names_) compared.emplace(name, "");
    const auto missing_mask = Missing(compared, mask_);
    if (missing_mask.first > 0) {
      throw std::runtime_error(Concatenate(mask, ": no mask '", missing_mask.second, "' (", missing_mask.first, " of ",
                                           names_.size(), " frames have none)"));
    }
  }

  std::vector<FramePair> Next(int count, int num_threads) override {
    const int n = std::min(count, num_frames() - next_);
    std::vector<FramePair> pairs(n);
    ParallelFor(n, num_threads, [&](int i) {
      FramePair& pair = pairs[i];
      pair.name = names_[next_ + i];
      pair.follows = follows_[next_ + i] != 0;
      pair.where = result_.at(pair.name);
      pair.truth = ReadImage(truth_.at(pair.name));
      pair.result = ReadImage(pair.where);
      RequireSize(pair.result, pair.truth, pair.where);
      if (mask_.empty()) return;
      pair.mask = MaskFrom(ReadImage(mask_.at(pair.name)));
      RequireSize(*pair.mask, pair.truth, mask_.at(pair.name));
    });
    next_ += n;
    return pairs;
  }
  [[nodiscard]] int num_frames() const override { return static_cast<int>(names_.size()); }
  [[nodiscard]] int num_left_out() const override { return left_out_; }

 private:
  static void RequireNone(const std::pair<int, std::string>& missing, const std::string& where,
                          const std::string& other) {
    if (missing.first == 0) return;
    throw std::runtime_error(Concatenate(where, ": no image '", missing.second, "', which ", other, " has (",
                                         missing.first, " are missing; --common compares the common ones alone)"));
  }

  FilesByName truth_, result_, mask_;
  std::vector<std::string> names_;
  std::vector<char> follows_;  ///< by name
  int next_ = 0, left_out_ = 0;
};

class VideoPairs : public FramePairs {
 public:
  VideoPairs(const std::string& truth, const std::string& result, const std::string& mask, std::vector<int> runs)
      : truth_path_(truth),
        result_path_(result),
        mask_path_(mask),
        truth_(truth),
        result_(result),
        runs_(std::move(runs)) {
    if (!mask.empty()) mask_ = std::make_unique<VideoReader>(mask);
  }

  std::vector<FramePair> Next(int count, int) override {
    std::vector<FramePair> pairs;
    for (int i = 0; i < count; ++i) {
      FramePair pair;
      char name[16];
      std::snprintf(name, sizeof name, "%06d", truth_.next_frame());
      pair.name = name;
      const int64_t number = truth_.next_frame();
      pair.follows = number > 0 && InOneRun(runs_, number - 1, number);
      pair.where = result_path_ + ": frame " + std::to_string(result_.next_frame());
      const bool has_truth = truth_.Read(&pair.truth), has_result = result_.Read(&pair.result);
      if (!has_truth && !has_result) break;
      if (has_truth != has_result)
        FailEnd(has_truth ? result_path_ : truth_path_, has_truth ? truth_path_ : result_path_, pair.name);
      RequireSize(pair.result, pair.truth, pair.where);
      if (mask_) {
        Image mask;
        if (!mask_->Read(&mask)) FailEnd(mask_path_, truth_path_, pair.name);
        pair.mask = MaskFrom(mask);
        RequireSize(*pair.mask, pair.truth, mask_path_);
      }
      pairs.push_back(std::move(pair));
    }
    return pairs;
  }
  [[nodiscard]] int num_frames() const override { return truth_.info().num_frames; }

 private:
  [[noreturn]] static void FailEnd(const std::string& ended, const std::string& goes_on, const std::string& name) {
    throw std::runtime_error(ended + ": ends before frame " + name + ", which " + goes_on + " has");
  }

  std::string truth_path_, result_path_, mask_path_;
  VideoReader truth_, result_;
  std::unique_ptr<VideoReader> mask_;
  std::vector<int> runs_;
};

const PixelMask* MaskOf(const FramePair& frame) { return frame.mask ? &*frame.mask : nullptr; }

/// Labels of a grey image.
std::vector<uint8_t> LabelsOf(const Image& image, const std::string& where) {
  std::vector<uint8_t> labels(image.bgr.size() / 3);
  for (size_t i = 0; i < labels.size(); ++i) {
    const uint8_t* bgr = &image.bgr[3 * i];
    const size_t x = i % image.width, y = i / image.width;
    if (bgr[0] != bgr[1] || bgr[1] != bgr[2]) {
      throw std::runtime_error(
          Concatenate(where, ": pixel (", x, ", ", y, ") is coloured, expected a grey image of labels"));
    }
    if (bgr[0] >= kNumPersonLabels) {
      throw std::runtime_error(Concatenate(where, ": pixel (", x, ", ", y, "): label ", int{bgr[0]}, ", expected 0 to ",
                                           kNumPersonLabels - 1));
    }
    labels[i] = bgr[0];
  }
  return labels;
}

}  // namespace

std::unique_ptr<FramePairs> FramePairs::Open(const std::string& truth, const std::string& result,
                                             const std::string& mask, bool common_only, const std::vector<int>& runs) {
  const bool folders = fs::is_directory(truth) && fs::is_directory(result) && (mask.empty() || fs::is_directory(mask));
  if (folders) return std::make_unique<FolderPairs>(truth, result, mask, common_only, runs);
  return std::make_unique<VideoPairs>(truth, result, mask, runs);
}

FrameMetric ImageMetric(SsimPreset preset, bool has_mask) {
  FrameMetric metric;
  metric.columns = {{"psnr_db", "10 log10(255^2 / MSE) of the whole image"}};
  if (has_mask) metric.columns.push_back({"psnr_mask_db", "the same of the pixels in the mask"});
  const bool boxed = has_mask && preset == SsimPreset::kNeuralBody;
  metric.columns.push_back({"ssim_" + ToText(preset), boxed ? "SSIM of the mask's box" : "SSIM of the whole image"});
  metric.compute = [preset, has_mask](const FramePair& frame, const FramePair*) {
    std::vector<double> values = {Psnr(frame.truth, frame.result)};
    if (has_mask) values.push_back(Psnr(frame.truth, frame.result, MaskOf(frame)));
    values.push_back(Ssim(frame.truth, frame.result, preset, MaskOf(frame)));
    return values;
  };
  return metric;
}

FrameMetric LabelMetric() {
  FrameMetric metric;
  metric.columns = {{"label_miou", "mean IoU of the labels that either side has"},
                    {"label_accuracy", "share of pixels with the right label"},
                    {"mask_iou", "IoU of everything but the background"}};
  for (const char* name : kPersonLabelNames)
    metric.columns.push_back({std::string("iou_") + name, "IoU of this label"});
  metric.compute = [](const FramePair& frame, const FramePair*) {
    const std::vector<uint8_t> truth = LabelsOf(frame.truth, "the truth of " + frame.where);
    const std::vector<uint8_t> result = LabelsOf(frame.result, frame.where);
    const LabelOverlap overlap = CompareLabels(truth, result, kNumPersonLabels);
    const int width = frame.truth.width, height = frame.truth.height;
    std::vector<double> values = {overlap.mean_iou, overlap.accuracy,
                                  MaskIoU({width, height, truth}, {width, height, result})};
    values.insert(values.end(), overlap.iou.begin(), overlap.iou.end());
    return values;
  };
  return metric;
}

FrameMetric NormalMetric() {
  FrameMetric metric;
  metric.columns = {{"normal_mean_deg", "mean angle where both sides have a normal"},
                    {"normal_median_deg", "median angle there"},
                    {"normal_coverage", "share of the truth's normals where the result has one"}};
  metric.compute = [](const FramePair& frame, const FramePair*) {
    const NormalError error = CompareNormals(frame.truth, frame.result, MaskOf(frame));
    return std::vector<double>{error.mean_deg, error.median_deg, error.coverage};
  };
  return metric;
}

}  // namespace bodyloom
