// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/photo_file.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>

#include "data_tools/video/image_file.h"
#include "data_tools/video/jpeg_header.h"

namespace bodyloom {
namespace {

bool HasNoColours(const Image& image) {
  for (size_t i = 0; i < image.bgr.size(); i += 3) {
    if (image.bgr[i] != image.bgr[i + 1] || image.bgr[i] != image.bgr[i + 2]) return false;
  }
  return true;
}

/// The file's depth is noted, its transparency laid over white.
void KeepTransparency(const std::string& bytes, PhotoFile* photo) {
  const cv::Mat view(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
  cv::Mat whole;
  try {
    whole = cv::imdecode(view, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    return;
  }
  if (whole.empty()) return;
  if (whole.depth() != CV_8U) {
    photo->notes.push_back(std::to_string(8 * whole.elemSize1()) + " bits a channel: read as 8");
  }
  if (whole.channels() != 4 || whole.cols != photo->image.width || whole.rows != photo->image.height) return;
  cv::Mat alpha;
  cv::extractChannel(whole, alpha, 3);
  const double largest = alpha.depth() == CV_8U ? 255 : alpha.depth() == CV_16U ? 65535 : 1;
  alpha.convertTo(alpha, CV_8U, 255 / largest);
  double minimum = 0, maximum = 0;
  cv::minMaxLoc(alpha, &minimum, &maximum);
  if (minimum == 255 || maximum == 0) return;
  photo->alpha.assign(alpha.begin<uchar>(), alpha.end<uchar>());
  for (size_t i = 0; i < photo->alpha.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      uint8_t& value = photo->image.bgr[3 * i + c];
      value = static_cast<uint8_t>((value * photo->alpha[i] + 255 * (255 - photo->alpha[i]) + 127) / 255);
    }
  }
  photo->notes.emplace_back("transparent: white is laid behind it");
}

}  // namespace

PhotoFile ReadPhoto(const std::string& path) {
  const std::string bytes = ReadImageBytes(path);
  const std::optional<JpegHeader> jpeg = ReadJpegHeader(bytes);
  const bool png = bytes.rfind("\x89PNG", 0) == 0;
  if ((jpeg && !jpeg->ends) || (png && bytes.find("IEND") == std::string::npos)) {
    throw std::runtime_error(path + (jpeg ? ": a JPEG" : ": a PNG") +
                             " that ends before its image does, expected a whole one; copy it again");
  }
  PhotoFile photo;
  photo.image = DecodeImage(bytes, path);
  if (jpeg && jpeg->components == 4)
    photo.notes.emplace_back("CMYK: read as RGB without its profile, colours may be off");
  if (HasNoColours(photo.image)) photo.notes.emplace_back("grey-scale: the person stays grey");
  if (!jpeg) KeepTransparency(bytes, &photo);
  return photo;
}

}  // namespace bodyloom
