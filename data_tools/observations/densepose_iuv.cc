// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/densepose_iuv.h"

#include <zlib.h>

#include <algorithm>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "render/image/image.h"

namespace bodyloom {
namespace {

constexpr int kMaxPart = 24;
constexpr size_t kMaxIuvBytes = size_t{1} << 28;
constexpr size_t kMaxIuvPixels = size_t{1} << 26;

/// Checks that a PNG has 8 bits, as other depths would be rescaled, and the chunks with their checksums, so that a
/// damaged file is reported with its location and never reaches the decoder, which would print.
void CheckPng(const std::string& path, bool needs_colour) {
  const std::string bytes = ReadFileBytes(path, kMaxIuvBytes);
  const auto byte = [&](size_t i) { return size_t{static_cast<unsigned char>(bytes[i])}; };
  const auto number = [&](size_t i) { return byte(i) << 24 | byte(i + 1) << 16 | byte(i + 2) << 8 | byte(i + 3); };
  if (bytes.size() < 33 || bytes.compare(0, 8, "\x89PNG\r\n\x1a\n") != 0 || bytes.compare(12, 4, "IHDR") != 0) {
    throw std::runtime_error(path + ": not a PNG file, expected DensePose labels");
  }
  const size_t depth = byte(24), type = byte(25);
  const bool is_grey = type == 0 || type == 4;
  if (depth > 8 || (needs_colour && is_grey)) {
    throw std::runtime_error(path + ": " + std::to_string(depth) + " bits a channel, " + (is_grey ? "grey" : "colour") +
                             "; expected 8-bit" + (needs_colour ? " colour (I, U, V)" : ""));
  }
  if (number(16) == 0 || number(20) == 0 || number(16) * number(20) > kMaxIuvPixels) {
    throw std::runtime_error(path + ": " + std::to_string(number(16)) + "x" + std::to_string(number(20)) +
                             " pixels, expected 1 to " + std::to_string(kMaxIuvPixels));
  }
  for (size_t at = 8;;) {  // chunks: length, type, data, checksum of type and data
    if (bytes.size() - at < 12 || number(at) > bytes.size() - at - 12) {
      throw std::runtime_error(path + ": byte " + std::to_string(at) + ": the PNG is cut off");
    }
    const size_t length = number(at);
    const uLong checksum =
        ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()) + at + 4, static_cast<uInt>(length + 4));
    if (checksum != number(at + 8 + length)) {
      throw std::runtime_error(path + ": byte " + std::to_string(at) + ": a chunk of the PNG is damaged");
    }
    if (bytes.compare(at + 4, 4, "IEND") == 0) return;
    at += 12 + length;
  }
}

}  // namespace

IuvImage ReadIuvImage(const std::string& path, IuvOrder order) {
  CheckPng(path, /*needs_colour=*/true);
  const Image image = ReadImage(path);
  int max_blue = 0, max_red = 0;
  for (size_t i = 0; i < image.bgr.size(); i += 3) {
    max_blue = std::max(max_blue, int{image.bgr[i]});
    max_red = std::max(max_red, int{image.bgr[i + 2]});
  }
  const bool could_be_blue = max_blue <= kMaxPart, could_be_red = max_red <= kMaxPart;
  const bool is_blue = order == IuvOrder::kBlueIsPart || (order == IuvOrder::kDetect && could_be_blue);
  if (is_blue ? !could_be_blue : !could_be_red) {
    throw std::runtime_error(path + ": blue reaches " + std::to_string(max_blue) + " and red " +
                             std::to_string(max_red) + ", expected parts 0 to 24 in " +
                             (order == IuvOrder::kDetect ? "one of them"
                              : is_blue                  ? "blue"
                                                         : "red"));
  }
  IuvImage iuv;
  iuv.width = image.width;
  iuv.height = image.height;
  iuv.order = could_be_blue && could_be_red && order == IuvOrder::kDetect ? IuvOrder::kDetect
              : is_blue                                                   ? IuvOrder::kBlueIsPart
                                                                          : IuvOrder::kRedIsPart;
  const size_t num_pixels = image.bgr.size() / 3, part_channel = is_blue ? 0 : 2, v_channel = is_blue ? 2 : 0;
  iuv.part.resize(num_pixels);
  iuv.u.resize(num_pixels);
  iuv.v.resize(num_pixels);
  for (size_t i = 0; i < num_pixels; ++i) {
    iuv.part[i] = image.bgr[3 * i + part_channel];
    iuv.u[i] = image.bgr[3 * i + 1];
    iuv.v[i] = image.bgr[3 * i + v_channel];
  }
  return iuv;
}

std::vector<uint8_t> ReadInstanceImage(const std::string& path, int width, int height) {
  CheckPng(path, /*needs_colour=*/false);
  const Image image = ReadImage(path);
  if (image.width != width || image.height != height) {
    throw std::runtime_error(path + ": " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                             " pixels, expected " + std::to_string(width) + "x" + std::to_string(height) +
                             " as in the IUV image beside it");
  }
  std::vector<uint8_t> instance(image.bgr.size() / 3);
  for (size_t i = 0; i < instance.size(); ++i) instance[i] = image.bgr[3 * i];
  return instance;
}

}  // namespace bodyloom
