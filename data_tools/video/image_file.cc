// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/image_file.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_header.h"
#include "geometry/base/check.h"
#include "render/image/image_mat.h"

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

namespace fs = std::filesystem;

constexpr size_t kMaxImageBytes = size_t{1} << 28;

/// True when a comes before b, runs of digits compared by value.
bool NaturalLess(std::string_view a, std::string_view b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      while (i < a.size() && a[i] == '0') ++i;
      while (j < b.size() && b[j] == '0') ++j;
      size_t p = i, q = j;
      while (p < a.size() && is_digit(a[p])) ++p;
      while (q < b.size() && is_digit(b[q])) ++q;
      if (p - i != q - j) return p - i < q - j;
      const int order = a.substr(i, p - i).compare(b.substr(j, q - j));
      if (order != 0) return order < 0;
      i = p, j = q;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;  // frame_1 and frame_01
}

/// Returns true if OpenCV will recognise the file as one of the supported formats. It would try others too, whose
/// libraries terminate the process on damaged files: GDCM takes any other file with "DICM" at byte 128.
bool BeginsAsAnImage(std::string_view bytes) {
  using namespace std::string_view_literals;
  const auto has = [&](size_t at, std::string_view text) {
    return bytes.size() >= at + text.size() && bytes.substr(at, text.size()) == text;
  };
  // libwebp then checks the rest; a damaged file is passed on to the next library.
  if (has(0, "RIFF"sv)) return has(8, "WEBP"sv) && !has(128, "DICM"sv);
  constexpr std::array kBeginnings = {
      "\x89PNG\r\n\x1a\n"sv, "\xFF\xD8\xFF"sv, "BM"sv, "II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv};
  return std::any_of(kBeginnings.begin(), kBeginnings.end(), [&](auto beginning) { return has(0, beginning); });
}

}  // namespace

bool IsImageName(const std::string& path) {
  static const std::vector<std::string> kKnown = {".png", ".jpg", ".jpeg", ".bmp", ".webp", ".tif", ".tiff"};
  return std::find(kKnown.begin(), kKnown.end(), LowerExtension(path)) != kKnown.end();
}

Image ReadImage(const std::string& path) { return DecodeImage(ReadImageBytes(path), path); }

std::string ReadImageBytes(const std::string& path) { return ReadFileBytes(path, kMaxImageBytes); }

namespace {

/// WebP's extended header (RIFF, "WEBP", "VP8X") with the flag of animation (Google, "WebP Container Specification").
bool IsAnimatedWebp(const std::string& bytes) {
  constexpr size_t kFlags = 20;
  constexpr char kAnimation = 0x02;
  return bytes.size() > kFlags && bytes.compare(0, 4, "RIFF") == 0 && bytes.compare(8, 8, "WEBPVP8X") == 0 &&
         (bytes[kFlags] & kAnimation) != 0;
}

}  // namespace

Image DecodeImage(const std::string& bytes, const std::string& path) {
  if (const auto header = ReadImageHeader(bytes); header && header->width * header->height > kMaxImagePixels) {
    throw std::runtime_error(Concatenate(path, ": an image of ", header->width, "x", header->height,
                                         " pixels, expected at most ", kMaxImagePixels, "; scale it down"));
  }
  cv::Mat decoded;
  try {
    if (BeginsAsAnImage(bytes)) {
      const cv::Mat view(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
      decoded = cv::imdecode(view, cv::IMREAD_COLOR);
    }
  } catch (const cv::Exception&) {  // a header with excessive sizes; reported below like any other fault
    decoded.release();
  }
  if (decoded.empty() && IsAnimatedWebp(bytes)) {
    throw std::runtime_error(path +
                             ": an animated WebP, which neither OpenCV nor ffmpeg decodes; convert it to GIF "
                             "or MP4");
  }
  if (decoded.empty() || decoded.total() > size_t{kMaxImagePixels}) {
    throw std::runtime_error(path +
                             ": not an image that can be decoded, expected PNG, JPEG, BMP, WebP or TIFF of at most " +
                             std::to_string(kMaxImagePixels) + " pixels");
  }
  Image image(decoded.cols, decoded.rows);
  cv::Mat target = MatOf(&image);
  decoded.copyTo(target);
  return image;
}

std::string EncodeImage(const Image& image, const std::string& path) {
  BODYLOOM_CHECK(!image.empty(), path, ": the image to write is empty");
  const std::string extension = LowerExtension(path);
  if (extension != ".png" && extension != ".jpg" && extension != ".jpeg") {
    throw std::runtime_error(path + ": extension '" + extension +
                             "' of an image to write, expected .png, .jpg or .jpeg");
  }
  std::vector<uchar> bytes;
  const std::vector<int> parameters = {cv::IMWRITE_JPEG_QUALITY, 95, cv::IMWRITE_PNG_COMPRESSION, 6};
  if (!cv::imencode(extension, MatOf(image), bytes, parameters)) {
    throw std::runtime_error(path + ": cannot encode " + std::to_string(image.width) + "x" +
                             std::to_string(image.height) + " pixels as " + extension);
  }
  return {bytes.begin(), bytes.end()};
}

void WriteImage(const std::string& path, const Image& image) { WriteFileAtomically(path, EncodeImage(image, path)); }

std::vector<std::string> ImageFilesOf(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with(".") || !IsImageName(name)) continue;
    names.push_back(name);
  }
  if (error) throw std::runtime_error(folder + ": cannot list the folder: " + error.message());
  if (names.empty()) {
    throw std::runtime_error(folder + ": the folder holds no images, expected .png, .jpg, .bmp, .webp or .tif files");
  }
  std::sort(names.begin(), names.end(), [](const auto& a, const auto& b) { return NaturalLess(a, b); });
  for (std::string& name : names) name = (fs::path(folder) / name).string();
  return names;
}

void WriteAlphaPng(const std::string& path, int width, int height, std::span<const uint8_t> bgra) {
  BODYLOOM_CHECK(width > 0 && height > 0 && bgra.size() == 4 * static_cast<size_t>(width) * height, "writing ", path,
                 ": ", bgra.size(), " bytes for ", width, "x", height, " pixels");
  const cv::Mat image(height, width, CV_8UC4, const_cast<uint8_t*>(bgra.data()));
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 2})) ThrowFileError(path, "cannot be encoded");
  WriteFileAtomically(path, std::string(bytes.begin(), bytes.end()));
}

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
