// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/score/error_pictures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/render/caption.h"
#include "bodyloom/render/palette.h"

namespace bodyloom {

std::vector<float> PixelErrors(const Image& truth, const Image& result) {
  BODYLOOM_CHECK(truth.width == result.width && truth.height == result.height, "PixelErrors: ", result.width, "x",
                 result.height, " pixels, the truth has ", truth.width, "x", truth.height);
  std::vector<float> errors(truth.bgr.size() / 3);
  for (size_t i = 0; i < errors.size(); ++i) {
    int squares = 0;
    for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const int difference = int{truth.bgr[c]} - int{result.bgr[c]};
      squares += difference * difference;
    }
    errors[i] = std::sqrt(static_cast<float>(squares) / 3);
  }
  return errors;
}

Image ErrorPicture(const Image& truth, const Image& result, const ErrorScale& scale) {
  const std::vector<float> errors = PixelErrors(truth, result);
  Image error(truth.width, truth.height);
  for (int y = 0; y < error.height; ++y) {
    for (int x = 0; x < error.width; ++x) {
      const Colour c = ErrorColour(errors[static_cast<size_t>(y) * error.width + x] / scale.maximum);
      uint8_t* p = error.pixel(x, y);
      p[0] = c.blue, p[1] = c.green, p[2] = c.red;
    }
  }
  constexpr int kGap = 6;
  // Small pictures stand in cells that are wide enough to read the words.
  const int cell = std::max(truth.width, 150), step = cell + kGap;
  const double cap = std::clamp(cell / 36.0, 7.0, 16.0);
  const int words = static_cast<int>(std::lround(2.4 * cap)), below = ErrorLegendHeight(cap) + kGap;
  Image picture(3 * cell + 4 * kGap, words + truth.height + kGap + below, kInkColour);
  const Image* const images[] = {&truth, &result, &error};
  const char* const names[] = {"truth", "result", "error"};
  for (int i = 0; i < 3; ++i) {
    const int x = kGap + i * step;
    DrawWords(names[i], x, static_cast<int>(std::lround(1.7 * cap)), cap, kPaperColour, &picture);
    Paste(*images[i], x, words, &picture);
  }
  DrawErrorLegend(scale, kGap + 2 * step, words + truth.height + kGap, cell, cap, &picture);
  return picture;
}

FrameMetric ErrorPictures(const std::string& folder, double maximum) {
  FrameMetric metric;
  metric.compute = [folder, maximum](const FramePair& frame, const FramePair*) -> std::vector<double> {
    const ErrorScale scale{maximum, "grey levels", "error of a pixel"};
    WriteImage((std::filesystem::path(folder) / (frame.name + ".png")).string(),
               ErrorPicture(frame.truth, frame.result, scale));
    return {};
  };
  return metric;
}

}  // namespace bodyloom
