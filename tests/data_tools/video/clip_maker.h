// SPDX-License-Identifier: Apache-2.0
/// Makes clips with the ffmpeg program, in forms that phones and cameras write and this project's writer does not.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom {

/// An image that encodes its frame index: a bright bar at column 4·index on a soft ramp.
inline Image NumberedImage(int index, int width = 96, int height = 64) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool bar = x / 4 == index;
      uint8_t* p = image.pixel(x, y);
      p[0] = bar ? 250 : 40 + y;
      p[1] = bar ? 250 : 60 + x / 2;
      p[2] = bar ? 250 : 50;
    }
  }
  return image;
}

/// The index of a numbered image, -1 without a bar.
inline int NumberOf(const Image& image) {
  int best = -1, brightest = 180;
  for (int k = 0; k < image.width / 4; ++k) {
    const Colour c = image.at(4 * k + 2, image.height / 2);
    const int minimum = std::min({c.red, c.green, c.blue});
    if (minimum > brightest) brightest = minimum, best = k;
  }
  return best;
}

/// Runs ffmpeg with these arguments in a shell; fails the test when it fails.
inline void Ffmpeg(const std::string& arguments) {
  const std::string command = "ffmpeg -nostdin -v error -y " + arguments;
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// Writes numbered images 0 to frames - 1 into the folder; returns ffmpeg's arguments to read them.
inline std::string NumberedInput(const TemporaryFolder& folder, int frames, const std::string& rate = "30",
                                 int width = 96, int height = 64) {
  for (int i = 0; i < frames; ++i) {
    WriteImage(folder.File(Concatenate("n", 1000 + i, ".png")), NumberedImage(i, width, height));
  }
  return "-framerate " + rate + " -start_number 1000 -i " + folder.File("n%d.png") + " ";
}

inline double MeanDifference(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.empty()) return 255;
  double sum = 0;
  for (size_t i = 0; i < a.bgr.size(); ++i) sum += std::abs(int{a.bgr[i]} - int{b.bgr[i]});
  return sum / static_cast<double>(a.bgr.size());
}

/// Writes a copy of an MP4 or MOV file whose display matrix is {a b 0, c d 0, 0 0 1}.
inline void WriteTurned(const std::string& bytes, const std::array<int, 4>& turn, const std::string& path) {
  const size_t header = bytes.find("tkhd");
  ASSERT_NE(header, std::string::npos);
  std::string copy = bytes;
  const auto put = [&](int index, uint32_t value) {
    for (int i = 0; i < 4; ++i) copy[header + 44 + 4 * index + i] = static_cast<char>(value >> (24 - 8 * i));
  };
  const auto [a, b, c, d] = turn;
  const int matrix[9] = {a * 65536, b * 65536, 0, c * 65536, d * 65536, 0, 0, 0, 1 << 30};
  for (int i = 0; i < 9; ++i) put(i, static_cast<uint32_t>(matrix[i]));
  WriteFileAtomically(path, copy);
}

/// Indices of all frames in reading order, and their times.
struct ReadClip {
  std::vector<int> numbers;
  std::vector<double> times;
  std::string warning;
};

inline ReadClip ReadAll(const std::string& path) {
  ReadClip clip;
  VideoReader reader(path);
  Image frame;
  while (reader.Read(&frame)) {
    clip.numbers.push_back(NumberOf(frame));
    clip.times.push_back(reader.frame_time());
  }
  clip.warning = reader.warning();
  return clip;
}

}  // namespace bodyloom
