// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/avatar/alpha_png.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/refuse.h"

namespace bodyloom {

void WriteAlphaPng(const std::string& path, int width, int height, std::span<const uint8_t> bgra) {
  BODYLOOM_CHECK(width > 0 && height > 0 && bgra.size() == 4 * static_cast<size_t>(width) * height, "writing ", path,
                 ": ", bgra.size(), " bytes for ", width, "x", height, " pixels");
  const cv::Mat picture(height, width, CV_8UC4, const_cast<uint8_t*>(bgra.data()));
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 2})) Refuse(path, "cannot be encoded");
  WriteFileAtomically(path, std::string(bytes.begin(), bytes.end()));
}

}  // namespace bodyloom
