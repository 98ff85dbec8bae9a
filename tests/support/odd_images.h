// SPDX-License-Identifier: Apache-2.0
/// Image files that are not 8-bit RGB.
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "render/image/image.h"
#include "render/image/image_mat.h"

namespace bodyloom {

inline void WriteBytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

inline void WritePng(const std::string& path, const cv::Mat& pixels) {
  std::vector<uchar> bytes;
  cv::imencode(".png", pixels, bytes);
  WriteBytes(path, std::string(bytes.begin(), bytes.end()));
}

inline void WriteGreyPng(const std::string& path, const Image& image) {
  cv::Mat grey;
  cv::cvtColor(MatOf(image), grey, cv::COLOR_BGR2GRAY);
  WritePng(path, grey);
}

inline void WriteDeepPng(const std::string& path, const Image& image) {
  cv::Mat deep;
  MatOf(image).convertTo(deep, CV_16U, 257);
  WritePng(path, deep);
}

/// `alpha` has a value a pixel.
inline void WriteTransparentPng(const std::string& path, const Image& image, const std::vector<uint8_t>& alpha) {
  cv::Mat whole;
  cv::cvtColor(MatOf(image), whole, cv::COLOR_BGR2BGRA);
  for (size_t i = 0; i < alpha.size(); ++i) whole.data[4 * i + 3] = alpha[i];
  WritePng(path, whole);
}

/// A baseline JPEG (ITU-T T.81) of `blocks_x` × `blocks_y` blocks of 8 × 8 pixels, each of one colour, which is decoded
/// exactly: `value` gives component c of block (x, y). Four components are inks as Adobe's programs write them,
/// inverted: 255 is none. Blocks have only DC coefficients, so that a table of twelve codes suffices.
inline std::string FlatJpeg(int blocks_x, int blocks_y, int components,
                            const std::function<uint8_t(int x, int y, int c)>& value) {
  std::string bytes = "\xFF\xD8";
  const auto put = [&](std::initializer_list<int> values) {
    for (const int v : values) bytes += static_cast<char>(v);
  };
  if (components == 4) {
    put({0xFF, 0xEE, 0, 14, 'A', 'd', 'o', 'b', 'e', 0, 100, 0, 0, 0, 0, 0});
  }
  put({0xFF, 0xDB, 0, 67, 0});  // all quantised by 8, which is a mean's unit
  for (int i = 0; i < 64; ++i) put({8});
  put({0xFF, 0xC0, 0, 8 + 3 * components, 8, blocks_y >> 5, blocks_y * 8 & 255, blocks_x >> 5, blocks_x * 8 & 255,
       components});
  for (int c = 0; c < components; ++c) put({c + 1, 0x11, 0});
  put({0xFF, 0xC4, 0, 31, 0, 0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  put({0xFF, 0xC4, 0, 20, 0x10, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});  // one code: end of block
  put({0xFF, 0xDA, 0, 6 + 2 * components, components});
  for (int c = 0; c < components; ++c) put({c + 1, 0});
  put({0, 63, 0});
  int bit_count = 0, byte = 0;
  const auto push = [&](int bits, int length) {
    for (int i = length - 1; i >= 0; --i) {
      byte = byte << 1 | (bits >> i & 1);
      if (++bit_count < 8) continue;
      put({byte});
      if (byte == 0xFF) put({0});
      bit_count = byte = 0;
    }
  };
  constexpr std::array<std::pair<int, int>, 9> kCodes = {
      {{0, 2}, {2, 3}, {3, 3}, {4, 3}, {5, 3}, {6, 3}, {14, 4}, {30, 5}, {62, 6}}};
  std::vector<int> last(components, 0);
  for (int y = 0; y < blocks_y; ++y) {
    for (int x = 0; x < blocks_x; ++x) {
      for (int c = 0; c < components; ++c) {
        const int mean = value(x, y, c) - 128, difference = mean - last[c];
        last[c] = mean;
        int size = 0;
        while ((std::abs(difference) >> size) != 0) ++size;
        push(kCodes[size].first, kCodes[size].second);
        push(difference < 0 ? difference + (1 << size) - 1 : difference, size);
        push(0, 1);
      }
    }
  }
  push(0x7F, 7);
  put({0xFF, 0xD9});
  return bytes;
}

}  // namespace bodyloom
