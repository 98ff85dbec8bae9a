// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/still_background.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"

namespace bodyloom {
namespace {

constexpr float kNoise = 3, kEdge = 1.0F / 3, kSpreadOfMad = 1.48F;
constexpr uint8_t kRestless = 8;  ///< a larger MAD means that the pixel is not static
constexpr double kMaxRestless = 0.1, kMinKnown = 0.5;

uint8_t Median(std::vector<uint8_t>* values) {
  const auto middle = values->begin() + std::ptrdiff_t(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

/// Colours of a pixel in the images in which nobody covers it.
class PixelHistory {
 public:
  void Gather(std::span<const CoveredImage> images, size_t pixel) {
    for (std::vector<uint8_t>& channel : channels_) channel.clear();
    for (const CoveredImage& seen : images) {
      if (seen.covered[pixel] != 0) continue;
      for (size_t c = 0; c < 3; ++c) channels_[c].push_back(seen.image.bgr[3 * pixel + c]);
    }
  }
  [[nodiscard]] size_t size() const { return channels_[0].size(); }
  /// Writes the median; returns the MAD.
  uint8_t Middle(uint8_t* bgr) {
    uint8_t largest = 0;
    for (size_t c = 0; c < 3; ++c) {
      const uint8_t median = bgr[c] = Median(&channels_[c]);
      for (uint8_t& value : channels_[c]) value = static_cast<uint8_t>(std::abs(value - median));
      largest = std::max(largest, Median(&channels_[c]));
    }
    return largest;
  }

 private:
  std::array<std::vector<uint8_t>, 3> channels_;
};

float StepTo(const Image& image, int x, int y, int dx, int dy) {
  const uint8_t* a = image.pixel(std::max(0, x - dx), std::max(0, y - dy));
  const uint8_t* b = image.pixel(std::min(image.width - 1, x + dx), std::min(image.height - 1, y + dy));
  float step = 0;
  for (int c = 0; c < 3; ++c) step = std::max(step, std::abs(float(a[c]) - float(b[c])) / 2);
  return step;
}

void CheckImages(std::span<const CoveredImage> images, const StillBackgroundOptions& options) {
  BODYLOOM_CHECK(options.fewest >= 1, "still background: fewest images ", options.fewest, ", expected 1 or more");
  for (const CoveredImage& seen : images) {
    const Image &image = seen.image, &first = images.front().image;
    BODYLOOM_CHECK(!image.empty() && image.width == first.width && image.height == first.height &&
                       seen.covered.size() == size_t(image.width) * size_t(image.height),
                   "still background: an image of ", image.width, "x", image.height, " with ", seen.covered.size(),
                   " pixels of people, expected ", first.width, "x", first.height);
  }
}

/// True if the MADs of enough pixels are small, so that the camera is static. `mad`: −1 for pixels not known.
bool StandsStill(const std::vector<int16_t>& mad) {
  const auto known = double(std::count_if(mad.begin(), mad.end(), [](int m) { return m >= 0; }));
  const auto restless = double(std::count_if(mad.begin(), mad.end(), [](int m) { return m > kRestless; }));
  return known >= kMinKnown * double(mad.size()) && restless <= kMaxRestless * known;
}

}  // namespace

std::optional<StillBackground> FindStillBackground(std::span<const CoveredImage> images,
                                                   const StillBackgroundOptions& options) {
  CheckImages(images, options);
  if (int(images.size()) < options.fewest) return std::nullopt;
  const int width = images.front().image.width, height = images.front().image.height;
  StillBackground background;
  background.colours = Image(width, height);
  std::vector<int16_t> mad(size_t(width) * size_t(height), -1);
  ParallelFor(height, options.num_threads, [&](int y) {
    PixelHistory history;
    for (size_t i = size_t(y) * width; i < size_t(y + 1) * width; ++i) {
      history.Gather(images, i);
      if (int(history.size()) >= options.fewest) mad[i] = history.Middle(&background.colours.bgr[3 * i]);
    }
  });
  if (!StandsStill(mad)) return std::nullopt;
  background.sigma.assign(mad.size(), 0);
  ParallelFor(height, options.num_threads, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const size_t i = size_t(y) * width + x;
      if (mad[i] < 0) continue;
      const float spread = kSpreadOfMad * mad[i];
      const float edge =
          kEdge * std::max(StepTo(background.colours, x, y, 1, 0), StepTo(background.colours, x, y, 0, 1));
      background.sigma[i] = std::sqrt(spread * spread + kNoise * kNoise + edge * edge);
    }
  });
  return background;
}

}  // namespace bodyloom
