// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/photo_file.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"

namespace bodyloom {
namespace {

constexpr size_t kMaxFileBytes = size_t{1} << 28;

struct Jpeg {
  int components = 3;  ///< 1 grey, 3 colours, 4 inks
  bool ends = false;   ///< an end-of-image marker comes after the first scan began
};

/// Of a file's bytes; nullopt when it is no JPEG. Source: ITU-T T.81, Annex B.
std::optional<Jpeg> JpegOf(const std::string& bytes) {
  const auto byte = [&](size_t i) { return i < bytes.size() ? static_cast<uint8_t>(bytes[i]) : uint8_t{0}; };
  if (byte(0) != 0xFF || byte(1) != 0xD8) return std::nullopt;
  Jpeg jpeg;
  for (size_t at = 2; at + 3 < bytes.size();) {
    if (byte(at) != 0xFF) return jpeg;  // no marker where one should be: the decoder will judge
    const uint8_t marker = byte(at + 1);
    if (marker == 0xFF) {  // filling
      ++at;
      continue;
    }
    const size_t length = size_t{byte(at + 2)} << 8 | byte(at + 3);
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) jpeg.components = byte(at + 9);
    at += 2 + length;
    if (marker != 0xDA) continue;
    // Coded data never hold this pair but as the marker; a thumbnail's own lies before the scan.
    jpeg.ends = bytes.find("\xFF\xD9", at) != std::string::npos;
    return jpeg;
  }
  return jpeg;
}

bool HasNoColours(const Image& image) {
  for (size_t i = 0; i < image.bgr.size(); i += 3) {
    if (image.bgr[i] != image.bgr[i + 1] || image.bgr[i] != image.bgr[i + 2]) return false;
  }
  return true;
}

/// The file's depth is said, its transparency laid over white.
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
  double least = 0, most = 0;
  cv::minMaxLoc(alpha, &least, &most);
  if (least == 255 || most == 0) return;
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
  const std::string bytes = ReadFileBytes(path, kMaxFileBytes);
  const std::optional<Jpeg> jpeg = JpegOf(bytes);
  const bool png = bytes.rfind("\x89PNG", 0) == 0;
  if ((jpeg && !jpeg->ends) || (png && bytes.find("IEND") == std::string::npos)) {
    throw std::runtime_error(path + (jpeg ? ": a JPEG" : ": a PNG") +
                             " that ends before its picture does, expected a whole one; copy it again");
  }
  PhotoFile photo;
  photo.image = ReadImage(path);
  if (jpeg && jpeg->components == 4)
    photo.notes.emplace_back("CMYK: read as RGB without its profile, colours may be off");
  if (HasNoColours(photo.image)) photo.notes.emplace_back("grey-scale: the person stays grey");
  if (!jpeg) KeepTransparency(bytes, &photo);
  return photo;
}

}  // namespace bodyloom
