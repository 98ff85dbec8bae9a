// SPDX-License-Identifier: Apache-2.0
/// Reads DensePose's IUV images: one PNG per frame with, for every pixel, the body part I (1..24, 0: background) and
/// the chart coordinates U, V in [0, 1] as 8-bit integers, rounded down.
///
/// Two channel orders are in use. The original program wrote B=I, G=U, R=V (OpenCV's order of an array I,U,V); others
/// store R=I, G=U, B=V. They are distinguished by value: I never exceeds 24. Beside "<image>_IUV.png" there may be
/// "<image>_INDS.png", whose pixels number the people from 1. Source: facebookresearch/DensePose, vis.py and notebooks;
/// detectron2 DensePose, chart results.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom {

enum class IuvOrder { kDetect, kBlueIsPart, kRedIsPart };

/// Rows from top to bottom; u and v are the bytes of the file.
struct IuvImage {
  int width = 0, height = 0;
  std::vector<uint8_t> part, u, v;
  IuvOrder order = IuvOrder::kDetect;  ///< as detected; kDetect if the image is empty and leaves it open
};

/// Throws std::runtime_error naming the file: not a PNG of 8-bit colour, or no channel (or not the chosen one) holds
/// parts 0..24. When both could be parts (a tiny or empty figure), blue is taken.
IuvImage ReadIuvImage(const std::string& path, IuvOrder order = IuvOrder::kDetect);

/// Number of the person each pixel belongs to (0: nobody). Throws std::runtime_error when the size is not width×height.
std::vector<uint8_t> ReadInstanceImage(const std::string& path, int width, int height);

}  // namespace bodyloom
