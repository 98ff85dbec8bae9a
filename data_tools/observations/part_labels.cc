// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/part_labels.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"
#include "data_tools/observations/observations_npz.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Runs describe more pixels than they take bytes, so their sizes are bounded before memory is allocated: boxes of at
/// most 67 megapixels (8K video has 33), and beyond 1 GiB together no more than 16384 pixels a run, where a person's
/// outline has some hundreds.
constexpr int64_t kMaxPixelsOfBox = int64_t{1} << 26, kMaxPixelsAnyway = int64_t{1} << 30, kMaxPixelsOfRun = 16384;

std::vector<int64_t> WholeNumbers(const NpzArrays& arrays, const std::string& name, const std::vector<int64_t>& shape,
                                  const std::string& where) {
  const NdArray& array = RequireArray(arrays, name, where);
  bool fits = array.is_number() && array.shape.size() == shape.size();
  std::string expected;
  for (size_t i = 0; i < shape.size(); ++i) {
    fits = fits && (shape[i] < 0 || array.shape[i] == shape[i]);
    expected += (i > 0 ? " x " : "") + (shape[i] < 0 ? std::string("any number") : std::to_string(shape[i]));
  }
  if (!fits) throw std::runtime_error(where + ": " + name + ": shape " + array.ShapeText() + ", expected " + expected);
  try {
    return array.ToInts();
  } catch (const std::invalid_argument&) {
    throw std::runtime_error(where + ": " + name + ": expected whole numbers");
  }
}

/// The labels of a box, or an error in words.
std::string Unpack(std::span<const int64_t> runs, LabelImage* image) {
  const int64_t pixels = int64_t{image->width} * image->height;
  int64_t sum = 0;
  for (const int64_t run : runs) {
    if (run < 0 || run > pixels - sum) return Concatenate("runs that are not the box's ", pixels, " pixels");
    sum += run;
  }
  if (sum != pixels) return Concatenate("runs of ", sum, " pixels for a box of ", pixels);
  image->labels.reserve(static_cast<size_t>(pixels));
  for (size_t i = 0; i < runs.size(); ++i) {
    image->labels.insert(image->labels.end(), static_cast<size_t>(runs[i]), static_cast<uint8_t>(i % 2));
  }
  return "";
}

constexpr const char *kMaskKind = "person", *kDensePoseKind = "densepose";

enum class LabelKind { kNotSaid, kMask, kDensePose };
/// The person in masks of images of eight bits.
constexpr uint8_t kMaskWhite = 255;

LabelKind KindOfLabels(const NpzArrays& arrays, const std::string& where) {
  const auto found = arrays.find("label_kind");
  if (found == arrays.end()) return LabelKind::kNotSaid;
  const std::string kind =
      found->second.is_text() && found->second.num_elements() == 1 ? found->second.ToStrings()[0] : "";
  if (kind != kMaskKind && kind != kDensePoseKind) {
    throw std::runtime_error(where + ": label_kind: '" + PrintableText(kind) + "', expected the text \"" + kMaskKind +
                             "\" or \"" + kDensePoseKind + "\"");
  }
  return kind == kMaskKind ? LabelKind::kMask : LabelKind::kDensePose;
}

/// Distance of two boxes in pixels, 0 if they touch.
int Gap(const cv::Rect& a, const cv::Rect& b) {
  const int dx = std::max({0, b.x - (a.x + a.width), a.x - (b.x + b.width)});
  const int dy = std::max({0, b.y - (a.y + a.height), a.y - (b.y + b.height)});
  return std::max(dx, dy);
}

/// The most frequent person label among a pixel's eight neighbours that are not unknown; unknown when there is none.
uint8_t Majority(const cv::Mat& labels, int x, int y) {
  std::array<int, 256> votes{};
  uint8_t best = PartLabelSequence::kUnknown;
  for (int v = std::max(0, y - 1); v <= std::min(labels.rows - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(labels.cols - 1, x + 1); ++u) {
      const uint8_t label = labels.at<uint8_t>(v, u);
      if (label == PartLabelSequence::kBackground || label == PartLabelSequence::kUnknown) continue;
      if (++votes[label] > votes[best]) best = label;
    }
  }
  return best;
}

/// Replaces labels thinner than 3 px by their neighbours', one ring of pixels at a time.
void MendStrays(cv::Mat* labels) {
  const cv::Mat kernel = cv::Mat::ones(3, 3, CV_8U);
  std::array<bool, 256> present{};
  for (int y = 0; y < labels->rows; ++y) {
    for (int x = 0; x < labels->cols; ++x) present[labels->at<uint8_t>(y, x)] = true;
  }
  cv::Mat solid = cv::Mat::zeros(labels->size(), CV_8U), opened;
  for (int label = 1; label < PartLabelSequence::kUnknown; ++label) {
    if (!present[label]) continue;
    cv::morphologyEx(*labels == label, opened, cv::MORPH_OPEN, kernel);
    solid |= opened;
  }
  const cv::Mat strays = (*labels > 0) & (solid == 0);
  labels->setTo(PartLabelSequence::kUnknown, strays);
  std::vector<cv::Point> open;
  cv::findNonZero(strays, open);
  constexpr int kRings = 4;
  for (int ring = 0; ring < kRings && !open.empty(); ++ring) {
    std::vector<uint8_t> found;  // by open point; written at the end, so a ring does not depend on itself
    found.reserve(open.size());
    for (const cv::Point& pixel : open) found.push_back(Majority(*labels, pixel.x, pixel.y));
    std::vector<cv::Point> left;
    for (size_t i = 0; i < open.size(); ++i) {
      labels->at<uint8_t>(open[i]) = found[i];
      if (found[i] == PartLabelSequence::kUnknown) left.push_back(open[i]);
    }
    open = std::move(left);
  }
}

/// Returns true if a mask is one connected component; following its outlines is far cheaper than labelling its pixels.
bool IsOnePiece(const cv::Mat& mask) {
  std::vector<std::vector<cv::Point>> outlines;
  std::vector<cv::Vec4i> hierarchy;  // of two levels: components, and their holes
  cv::findContours(mask, outlines, hierarchy, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
  return std::count_if(hierarchy.begin(), hierarchy.end(), [](const cv::Vec4i& outline) { return outline[3] < 0; }) ==
         1;
}

/// Sets pixels off the person to background, by the components of `mask`, and returns the person's box.
cv::Rect DropOthers(const cv::Mat& mask, const ReadPartLabelsOptions& options, cv::Mat* labels, int64_t* dropped) {
  cv::Mat blob, stats, centroids;
  const int count = cv::connectedComponentsWithStats(mask, blob, stats, centroids, 8, CV_32S, cv::CCL_BBDT);
  int largest = 1;
  for (int i = 2; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) > stats.at<int>(largest, cv::CC_STAT_AREA)) largest = i;
  }
  const auto box_of = [&](int i) {
    return cv::Rect(stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                    stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
  };
  const cv::Rect main = box_of(largest);
  const double max_gap = options.max_gap * std::max(main.width, main.height);
  const double min_area = options.min_share * stats.at<int>(largest, cv::CC_STAT_AREA);
  std::vector<char> kept(count, 1);
  cv::Rect box = main;
  for (int i = 1; i < count; ++i) {
    kept[i] = stats.at<int>(i, cv::CC_STAT_AREA) >= min_area || Gap(main, box_of(i)) <= max_gap;
    if (kept[i]) {
      box |= box_of(i);
    } else if (dropped != nullptr) {
      *dropped += stats.at<int>(i, cv::CC_STAT_AREA);
    }
  }
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      if (!kept[blob.at<int>(y, x)]) labels->at<uint8_t>(y, x) = PartLabelSequence::kBackground;
    }
  }
  return box;
}

/// The labels of one H×W image within the person's box.
LabelImage CutPerson(const cv::Mat& image, const ReadPartLabelsOptions& options, int64_t* dropped) {
  cv::Rect box = cv::boundingRect(image);
  if (box.empty()) return {};
  cv::Mat labels = image(box).clone();
  const cv::Mat mask = labels > 0;
  if (!IsOnePiece(mask)) {
    const cv::Rect within = DropOthers(mask, options, &labels, dropped);
    labels = labels(within).clone();
    box = cv::Rect(box.x + within.x, box.y + within.y, within.width, within.height);
  }
  if (options.mend_strays) MendStrays(&labels);
  return {box.x, box.y, box.width, box.height, {labels.datastart, labels.dataend}};
}

/// The labels as bytes: any integers or booleans from 0 to 255. Throws "where: labels: …" for others.
std::string BytesOfLabels(const NdArray& array, const std::string& where) {
  if (array.dtype == DType::kU8) return array.bytes;
  const bool is_float = array.dtype == DType::kF16 || array.dtype == DType::kF32 || array.dtype == DType::kF64;
  if (!array.is_number() || is_float) {
    ThrowFileError(where, "labels",
                   std::string(is_float ? "numbers with a fraction" : "no numbers") +
                       ", expected uint8 or another type of whole numbers (labels.astype(np.uint8))");
  }
  const std::vector<int64_t> values = array.ToInts();
  std::string bytes(values.size(), '\0');
  for (size_t i = 0; i < values.size(); ++i) {
    if (values[i] < 0 || values[i] > 255) {
      ThrowFileError(where, "labels", Concatenate("element ", i, " is ", values[i], ", expected 0 to 255"));
    }
    bytes[i] = static_cast<char>(values[i]);
  }
  return bytes;
}

/// Refuses height × width × frames, which shows in the number of timestamps, or in images far longer than wide (or the
/// reverse) of which the first two sides would make usual ones.
void RequireFramesFirst(const NdArray& array, const NpzArrays& arrays, const std::string& where) {
  const int64_t T = array.shape[0], H = array.shape[1], W = array.shape[2];
  constexpr double kUsualSides = 2.4, kLongSides = 4;
  const auto ratio = [](int64_t a, int64_t b) { return double(std::max(a, b)) / double(std::min(a, b)); };
  const auto times = arrays.find("timestamps");
  const int64_t num_times = times == arrays.end() ? 0 : times->second.num_elements();
  const bool is_last =
      num_times > 0 ? num_times == W && num_times != T : ratio(H, W) > kLongSides && ratio(T, H) < kUsualSides;
  if (!is_last) return;
  ThrowFileError(where, "labels",
                 "shape " + array.ShapeText() +
                     ", which looks like height x width x frames; expected frames first (np.moveaxis(labels, -1, 0))");
}

/// The one label beside 0; 0 if there is none or several.
uint8_t OnlyLabel(const std::string& bytes) {
  char only = 0;
  for (const char byte : bytes) {
    if (byte == 0 || byte == only) continue;
    if (only != 0) return 0;
    only = byte;
  }
  return static_cast<uint8_t>(only);
}

/// Reads `labels`, one image per frame, as a mask if they are said to be one or can only be one.
PartLabelSequence FromImages(const NpzArrays& arrays, const std::string& where, const ReadPartLabelsOptions& options,
                             int64_t* dropped_pixels, LabelKind* kind) {
  const NdArray& array = RequireArray(arrays, "labels", where);
  const auto fail = [&](const std::string& message) { ThrowFileError(where, "labels", message); };
  if (array.shape.size() != 3) fail("shape " + array.ShapeText() + ", expected frames x height x width");
  const int64_t T = array.shape[0], H = array.shape[1], W = array.shape[2];
  if (T < 1 || H < 1 || W < 1 || std::max(H, W) > kMaxLabelPixelsASide) {
    fail(Concatenate("shape ", array.ShapeText(), ", expected at least one frame and at most ", kMaxLabelPixelsASide,
                     " pixels a side"));
  }
  RequireFramesFirst(array, arrays, where);
  std::string converted;
  const std::string* labels_bytes = &array.bytes;
  if (array.dtype != DType::kU8) {
    converted = BytesOfLabels(array, where);
    labels_bytes = &converted;
  }
  // DensePose's part 1 is a half of the trunk: labels of which it is the only one are a mask, as 0 and 255 are.
  const uint8_t only = *kind == LabelKind::kDensePose ? 0 : OnlyLabel(*labels_bytes);
  if (only == 1 || only == kMaskWhite) *kind = LabelKind::kMask;
  if (only == kMaskWhite) {
    converted = *labels_bytes;
    std::replace(converted.begin(), converted.end(), static_cast<char>(kMaskWhite), '\x01');
    labels_bytes = &converted;
  }
  PartLabelSequence sequence;
  sequence.image_width = static_cast<int>(W);
  sequence.image_height = static_cast<int>(H);
  const auto* bytes = reinterpret_cast<const uint8_t*>(labels_bytes->data());
  for (int64_t t = 0; t < T; ++t) {
    const uint8_t* first = bytes + t * H * W;
    const uint8_t* wrong =
        std::find_if(first, first + H * W, [&](uint8_t label) { return label > options.highest_label; });
    if (wrong != first + H * W) {
      fail(Concatenate("frame ", t, ", pixel (", (wrong - first) % W, ", ", (wrong - first) / W, ") is ", int(*wrong),
                       ", expected 0 to ", int(options.highest_label)));
    }
    const cv::Mat labels(static_cast<int>(H), static_cast<int>(W), CV_8U, const_cast<uint8_t*>(first));
    sequence.frames.push_back(CutPerson(labels, options, dropped_pixels));
  }
  return sequence;
}

/// Reads masks as runs, cropped like label images.
PartLabelSequence FromRuns(const NpzArrays& arrays, const std::string& where, const ReadPartLabelsOptions& options,
                           int64_t* dropped_pixels) {
  PartLabelSequence sequence = MaskFromRuns(arrays, where);
  for (PackedLabels& packed : sequence.frames) {
    if (packed.empty()) continue;
    LabelImage frame = packed.Unpacked();
    const cv::Mat labels(frame.height, frame.width, CV_8U, frame.labels.data());
    LabelImage person = CutPerson(labels, options, dropped_pixels);
    if (!person.labels.empty()) person.x_begin += frame.x_begin, person.y_begin += frame.y_begin;
    packed = person;
  }
  return sequence;
}

}  // namespace

void WriteMask(const std::string& path, const PartLabelSequence& mask) {
  BODYLOOM_CHECK(mask.frames.size() == mask.timestamps.size() && !mask.frames.empty(),
                 "WriteMask: ", mask.frames.size(), " frames and ", mask.timestamps.size(), " timestamps");
  NpzArrays arrays = MaskRuns(mask);
  arrays["label_kind"] = NdArray::FromString(kMaskKind);
  arrays["timestamps"] = NdArray::FromDoubles(mask.timestamps.data(), {int64_t(mask.timestamps.size())});
  WriteNpz(path, arrays);
}

bool HasPartLabels(const NpzArrays& arrays) { return arrays.contains("labels") || HasMaskRuns(arrays); }

PartLabelSequence PartLabelsFromNpz(const NpzArrays& arrays, const std::string& where,
                                    const ReadPartLabelsOptions& options, int64_t* dropped_pixels) {
  if (dropped_pixels != nullptr) *dropped_pixels = 0;
  LabelKind kind = KindOfLabels(arrays, where);
  PartLabelSequence sequence = HasMaskRuns(arrays) ? FromRuns(arrays, where, options, dropped_pixels)
                                                   : FromImages(arrays, where, options, dropped_pixels, &kind);
  const size_t T = sequence.frames.size();
  if (arrays.contains("timestamps")) {
    sequence.timestamps = TimestampsFromNpz(arrays, where);
    if (sequence.timestamps.size() != T) {
      throw std::runtime_error(
          Concatenate(where, ": labels: ", T, " frames but ", sequence.timestamps.size(), " timestamps"));
    }
  } else {
    for (size_t t = 0; t < T; ++t) sequence.timestamps.push_back(static_cast<double>(t) / options.fps);
  }
  if (kind == LabelKind::kMask) sequence.AsMask();
  return sequence;
}

PartLabelSequence ReadPartLabels(const std::string& path, const ReadPartLabelsOptions& options,
                                 int64_t* dropped_pixels) {
  const std::string bytes = ReadFileBytes(path);
  const bool is_bare = bytes.starts_with("\x93NUMPY");
  return PartLabelsFromNpz(is_bare ? NpzArrays{{"labels", ReadNpyBytes(bytes, path)}} : ReadNpzBytes(bytes, path), path,
                           options, dropped_pixels);
}

NpzArrays MaskRuns(const PartLabelSequence& mask) {
  const auto T = static_cast<int64_t>(mask.frames.size());
  std::vector<int32_t> runs, counts, boxes;
  for (int64_t t = 0; t < T; ++t) {
    const LabelImage frame = mask.frames[static_cast<size_t>(t)].Unpacked();
    const size_t before = runs.size();
    if (frame.labels.empty()) {
      boxes.insert(boxes.end(), 4, 0);
    } else {
      BODYLOOM_CHECK(frame.x_begin >= 0 && frame.y_begin >= 0 && frame.x_begin + frame.width <= mask.image_width &&
                         frame.y_begin + frame.height <= mask.image_height,
                     "masks: the rectangle of frame ", t, " leaves the image");
      BODYLOOM_CHECK(frame.labels.size() <= size_t{kMaxPixelsOfBox}, "masks: frame ", t, " has ", frame.labels.size(),
                     " pixels, expected at most ", kMaxPixelsOfBox);
      boxes.insert(boxes.end(), {frame.x_begin, frame.y_begin, frame.width, frame.height});
      bool inside = false;
      auto from = frame.labels.begin();
      while (from != frame.labels.end()) {
        const auto to = std::find_if(from, frame.labels.end(), [&](uint8_t label) { return (label != 0) != inside; });
        runs.push_back(static_cast<int32_t>(to - from));
        from = to;
        inside = !inside;
      }
    }
    counts.push_back(static_cast<int32_t>(runs.size() - before));
  }
  const int32_t size[] = {mask.image_width, mask.image_height};
  return {{"mask_runs", NdArray::FromInts32(runs.data(), {static_cast<int64_t>(runs.size())})},
          {"mask_count", NdArray::FromInts32(counts.data(), {T})},
          {"mask_box", NdArray::FromInts32(boxes.data(), {T, 4})},
          {"image_size", NdArray::FromInts32(size, {2})}};
}

bool HasMaskRuns(const NpzArrays& arrays) { return arrays.contains("mask_runs"); }

PartLabelSequence MaskFromRuns(const NpzArrays& arrays, const std::string& where) {
  const std::vector<int64_t> size = WholeNumbers(arrays, "image_size", {2}, where);
  const std::vector<int64_t> counts = WholeNumbers(arrays, "mask_count", {-1}, where);
  const auto T = static_cast<int64_t>(counts.size());
  const std::vector<int64_t> boxes = WholeNumbers(arrays, "mask_box", {T, 4}, where);
  const std::vector<int64_t> runs = WholeNumbers(arrays, "mask_runs", {-1}, where);
  if (T < 1 || std::min(size[0], size[1]) < 1 || std::max(size[0], size[1]) > kMaxLabelPixelsASide) {
    throw std::runtime_error(Concatenate(where, ": image_size ", size[0], " x ", size[1], " of ", T,
                                         " frames, expected at least one frame and 1 to ", kMaxLabelPixelsASide,
                                         " pixels a side"));
  }
  PartLabelSequence mask;
  mask.image_width = static_cast<int>(size[0]);
  mask.image_height = static_cast<int>(size[1]);
  size_t at = 0;
  int64_t pixels = 0;
  for (int64_t t = 0; t < T; ++t) {
    const auto fail = [&](const std::string& found) {
      throw std::runtime_error(Concatenate(where, ": mask of frame ", t, ": ", found));
    };
    const int64_t count = counts[static_cast<size_t>(t)];
    if (count < 0 || count > static_cast<int64_t>(runs.size() - at)) fail("more runs than mask_runs has");
    const int64_t* box = &boxes[static_cast<size_t>(4 * t)];
    LabelImage frame;
    if (box[2] == 0) {
      if (count != 0) fail("runs without a box");
      mask.frames.emplace_back();
      continue;
    }
    // Sides are within the image's before they are added.
    if (box[0] < 0 || box[1] < 0 || box[2] < 1 || box[3] < 1 || box[2] > size[0] || box[3] > size[1] ||
        box[0] > size[0] - box[2] || box[1] > size[1] - box[3]) {
      fail("mask_box leaves the image");
    }
    pixels += box[2] * box[3];
    if (box[2] * box[3] > kMaxPixelsOfBox ||
        pixels > std::max(kMaxPixelsAnyway, kMaxPixelsOfRun * static_cast<int64_t>(runs.size()))) {
      fail(Concatenate("boxes of ", pixels, " pixels by now, too many for ", runs.size(), " runs"));
    }
    frame.x_begin = static_cast<int>(box[0]), frame.y_begin = static_cast<int>(box[1]);
    frame.width = static_cast<int>(box[2]), frame.height = static_cast<int>(box[3]);
    const std::string wrong = Unpack(std::span(runs).subspan(at, static_cast<size_t>(count)), &frame);
    if (!wrong.empty()) fail(wrong);
    mask.frames.emplace_back(frame);
    at += static_cast<size_t>(count);
  }
  if (at != runs.size()) {
    throw std::runtime_error(Concatenate(where, ": mask_runs has ", runs.size(), " runs, mask_count says ", at));
  }
  return mask;
}

}  // namespace bodyloom
