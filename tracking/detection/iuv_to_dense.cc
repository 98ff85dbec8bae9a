// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/iuv_to_dense.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/observations_npz.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr int kDenseParts = 24;
constexpr const char* kIuvEnding = "_IUV.png";

/// Bits of x and y interleaved: pixels near each other on the curve are near each other in the image.
uint64_t Morton(uint32_t x, uint32_t y) {
  const auto spread = [](uint64_t v) {
    v = (v | v << 16) & 0x0000FFFF0000FFFF;
    v = (v | v << 8) & 0x00FF00FF00FF00FF;
    v = (v | v << 4) & 0x0F0F0F0F0F0F0F0F;
    v = (v | v << 2) & 0x3333333333333333;
    return (v | v << 1) & 0x5555555555555555;
  };
  return spread(x) | spread(y) << 1;
}

/// Number of pixels of each part, `total` in all: proportional to area, by largest remainders.
std::array<size_t, kDenseParts + 1> Quotas(const std::array<std::vector<uint32_t>, kDenseParts + 1>& pixels,
                                           size_t total) {
  size_t all = 0;
  for (const auto& list : pixels) all += list.size();
  std::array<size_t, kDenseParts + 1> quota{};
  if (total == 0 || total >= all) {
    for (int p = 0; p <= kDenseParts; ++p) quota[p] = pixels[p].size();
    return quota;
  }
  std::array<double, kDenseParts + 1> remainder{};
  size_t given = 0;
  for (int p = 0; p <= kDenseParts; ++p) {
    const double share = static_cast<double>(total) * static_cast<double>(pixels[p].size()) / static_cast<double>(all);
    quota[p] = static_cast<size_t>(share);
    remainder[p] = share - std::floor(share);
    given += quota[p];
  }
  std::array<int, kDenseParts + 1> order;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return remainder[a] > remainder[b]; });
  for (int k = 0; given < total; k = (k + 1) % (kDenseParts + 1)) {
    if (quota[order[k]] < pixels[order[k]].size()) ++quota[order[k]], ++given;
  }
  return quota;
}

/// A rectangle of an image: its top-left pixel, its width, and how many pixels it has.
struct Rectangle {
  int x_begin, y_begin, width;
  size_t num_pixels;
};

/// The dense keypoints of a rectangle whose pixel i shows part(i) at uv(i).
template <class Part, class Uv>
std::vector<DenseKeypoint> SampleChart(const Rectangle& rectangle, const Part& part_of, const Uv& uv_of,
                                       const ChartLookup& charts, const IuvToDenseOptions& options) {
  BODYLOOM_CHECK(options.per_frame >= 0 && options.sigma_px > 0 && options.max_gap >= 0, "IuvToDense: per_frame ",
                 options.per_frame, ", sigma_px ", options.sigma_px, ", max_gap ", options.max_gap);
  std::array<std::vector<uint32_t>, kDenseParts + 1> pixels;
  for (size_t i = 0; i < rectangle.num_pixels; ++i) {
    const uint8_t part = part_of(i);
    if (part > 0 && part <= kDenseParts) pixels[part].push_back(static_cast<uint32_t>(i));
  }
  const std::array<size_t, kDenseParts + 1> quota = Quotas(pixels, static_cast<size_t>(options.per_frame));
  const auto width = static_cast<uint32_t>(rectangle.width);
  std::vector<DenseKeypoint> points;
  for (int part = 1; part <= kDenseParts; ++part) {
    std::vector<uint32_t>& list = pixels[part];
    std::sort(list.begin(), list.end(),
              [width](uint32_t a, uint32_t b) { return Morton(a % width, a / width) < Morton(b % width, b / width); });
    for (size_t k = 0; k < quota[part]; ++k) {
      // The middle of the k-th of quota equal stretches.
      const uint32_t i = list[(2 * k + 1) * list.size() / (2 * quota[part])];
      double gap = 0;
      const SurfacePoint point = charts.Find(part, uv_of(i), &gap);
      if (point.face < 0 || !(gap <= options.max_gap)) continue;
      const Eigen::Vector2f pixel(static_cast<float>(rectangle.x_begin + static_cast<int>(i % width)),
                                  static_cast<float>(rectangle.y_begin + static_cast<int>(i / width)));
      points.push_back({point.face, point.barycentric.cast<float>(), pixel, static_cast<float>(options.sigma_px)});
    }
  }
  return points;
}

/// The INDS image beside an IUV image; empty when there is none.
std::string InstancePath(const std::string& iuv_path) {
  if (!iuv_path.ends_with(kIuvEnding)) return "";
  const std::string path = iuv_path.substr(0, iuv_path.size() - std::string(kIuvEnding).size()) + "_INDS.png";
  std::error_code ignored;
  return fs::exists(path, ignored) ? path : "";
}

/// Follows one person through instance images.
class InstanceFollower {
 public:
  explicit InstanceFollower(int person) : person_(person) {}

  /// Marks the person's pixels; all zeros when nobody is there.
  std::vector<uint8_t> Select(const std::vector<uint8_t>& instance, const std::vector<uint8_t>& part,
                              const std::string& where) {
    std::array<size_t, 256> area{}, overlap{};
    for (size_t i = 0; i < instance.size(); ++i) {
      if (part[i] == 0) continue;
      ++area[instance[i]];
      if (i < last_.size()) overlap[instance[i]] += last_[i];
    }
    std::vector<int> present;
    for (int k = 1; k < 256; ++k) {
      if (area[k] > 0) present.push_back(k);
    }
    std::vector<uint8_t> mask(instance.size(), 0);
    if (present.empty()) return mask;
    std::stable_sort(present.begin(), present.end(), [&](int a, int b) { return area[a] > area[b]; });
    int chosen = present[0];
    if (last_.empty()) {
      if (person_ >= static_cast<int>(present.size())) {
        throw std::runtime_error(where + ": person " + std::to_string(person_) + " requested, but only " +
                                 std::to_string(present.size()) + " are in this frame (0 is the largest)");
      }
      chosen = present[person_];
    } else {
      for (const int k : present) {
        if (overlap[k] > overlap[chosen]) chosen = k;
      }
    }
    for (size_t i = 0; i < mask.size(); ++i) mask[i] = instance[i] == chosen && part[i] != 0;
    last_ = mask;
    return mask;
  }

 private:
  int person_;
  std::vector<uint8_t> last_;
};

std::vector<std::string> IuvFilesOf(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.ends_with(kIuvEnding) && !name.starts_with('.')) names.push_back(name);  // "._a": AppleDouble
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool IsNpz(const std::string& path) { return path.ends_with(".npz"); }

DenseSequence DenseFromImages(const std::string& folder, const std::vector<std::string>& names, const BodyModel& body,
                              const LoadDenseOptions& options) {
  std::vector<int64_t> numbers;
  numbers.reserve(names.size());
  for (const std::string& name : names) {
    numbers.push_back(FrameNumberFromName(name.substr(0, name.size() - std::string(kIuvEnding).size())));
  }
  if (std::find(numbers.begin(), numbers.end(), -1) != numbers.end()) {
    std::iota(numbers.begin(), numbers.end(), 0);  // some name has no number: their order
  }
  FrameGrid grid = MakeFrameGrid(numbers, options.fps, folder);
  // Frames in time order, so that a person can be followed.
  std::vector<size_t> order(names.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return grid.index[a] < grid.index[b]; });

  const ChartLookup charts(body);
  InstanceFollower follower(options.person);
  DenseSequence dense;
  dense.timestamps = std::move(grid.timestamps);
  dense.frames.resize(dense.timestamps.size());
  dense.uv_sigma = kDensePoseUvSigma;
  dense.pixel_sigma_px = kPixelWidthSigma;
  IuvOrder channel_order = options.order;
  size_t num_points = 0;
  for (const size_t i : order) {
    const std::string path = (fs::path(folder) / names[i]).string();
    const IuvImage iuv = ReadIuvImage(path, channel_order);
    if (channel_order == IuvOrder::kDetect) channel_order = iuv.order;
    if (dense.image_width > 0 && (iuv.width != dense.image_width || iuv.height != dense.image_height)) {
      throw std::runtime_error(path + ": " + std::to_string(iuv.width) + "x" + std::to_string(iuv.height) +
                               " pixels, expected " + std::to_string(dense.image_width) + "x" +
                               std::to_string(dense.image_height) + " as in the frames before");
    }
    dense.image_width = iuv.width;
    dense.image_height = iuv.height;
    std::vector<uint8_t> mask;
    if (const std::string instances = InstancePath(path); !instances.empty()) {
      mask = follower.Select(ReadInstanceImage(instances, iuv.width, iuv.height), iuv.part, instances);
    }
    dense.frames[grid.index[i]] = IuvToDense(iuv, charts, options.sampling, mask);
    num_points += dense.frames[grid.index[i]].size();
  }
  if (num_points == 0) {
    throw std::runtime_error(folder + ": no pixel of " + std::to_string(names.size()) +
                             " IUV images shows a part of this body");
  }
  return dense;
}

/// The name as in the file.
DenseSequence ReadDense(const std::string& path, const BodyModel& body, const LoadDenseOptions& options) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    const std::vector<std::string> names = IuvFilesOf(path);
    if (names.empty()) throw std::runtime_error(path + ": no files *_IUV.png, expected one DensePose image a frame");
    return DenseFromImages(path, names, body, options);
  }
  if (IsNpz(path)) {
    const NpzArrays arrays = ReadNpz(path);
    if (!HasDense(arrays)) throw std::runtime_error(path + ": an .npz without dense keypoints ('dense_frame')");
    DenseSequence dense = DenseFromNpz(arrays, path);
    for (int t = 0; t < dense.num_frames(); ++t) {
      for (const DenseKeypoint& point : dense.frames[t]) {
        if (point.face < body.num_faces()) continue;
        throw std::runtime_error(path + ": frame " + std::to_string(t) + " names face " + std::to_string(point.face) +
                                 ", but the body has " + std::to_string(body.num_faces()) +
                                 " faces; was it made for another body?");
      }
    }
    return dense;
  }
  if (!path.ends_with(kIuvEnding)) {
    throw std::runtime_error(path + ": expected a folder of *_IUV.png, one such image, or an .npz of dense keypoints");
  }
  return DenseFromImages(fs::path(path).parent_path().string(), {fs::path(path).filename().string()}, body, options);
}

}  // namespace

std::vector<DenseKeypoint> IuvToDense(const IuvImage& iuv, const ChartLookup& charts, const IuvToDenseOptions& options,
                                      const std::vector<uint8_t>& mask) {
  BODYLOOM_CHECK(mask.empty() || mask.size() == iuv.part.size(), "IuvToDense: mask of ", mask.size(),
                 " pixels, image of ", iuv.part.size());
  const auto part = [&](size_t i) { return mask.empty() || mask[i] != 0 ? iuv.part[i] : uint8_t{0}; };
  const auto uv = [&](size_t i) {
    return Eigen::Vector2d(std::min(1.0, (iuv.u[i] + 0.5) / 255), std::min(1.0, (iuv.v[i] + 0.5) / 255));
  };
  return SampleChart({0, 0, iuv.width, iuv.part.size()}, part, uv, charts, options);
}

std::vector<DenseKeypoint> IuvToDense(const ChartImage& image, const ChartLookup& charts,
                                      const IuvToDenseOptions& options) {
  return SampleChart(
      {image.x_begin, image.y_begin, image.width, image.part.size()}, [&](size_t i) { return image.part[i]; },
      [&](size_t i) { return Eigen::Vector2d(image.u[i], image.v[i]); }, charts, options);
}

bool HoldsDenseKeypoints(const std::string& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return !IuvFilesOf(path).empty();
  if (path.ends_with(kIuvEnding)) return fs::exists(path, ignored);
  if (!IsNpz(path)) return false;
  try {
    return HasDense(ReadNpz(path));
  } catch (const std::exception&) {
    return false;  // the next reader reports the error
  }
}

DenseSequence LoadDense(const std::string& path, const BodyModel& body, const LoadDenseOptions& options) {
  BODYLOOM_CHECK(options.person >= 0, "person ", options.person, " must not be negative");
  BODYLOOM_CHECK(!options.uv_sigma || (*options.uv_sigma >= 0 && std::isfinite(*options.uv_sigma)), "uv_sigma ",
                 options.uv_sigma.value_or(0), " must be finite and not negative");
  DenseSequence dense = ReadDense(path, body, options);
  if (options.uv_sigma) dense.uv_sigma = *options.uv_sigma;
  return dense;
}

}  // namespace bodyloom
