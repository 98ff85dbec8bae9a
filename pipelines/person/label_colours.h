// SPDX-License-Identifier: Apache-2.0
/// Clothes that have the face's colour are skin, and skin that has the clothes' colour is clothes: a network that has seen
/// few people knows a garment's usual edges better than where this one ends.
///
/// Colours are (L/2, a, b) of CIE L*a*b*: shade counts half. With m_k the median colour of the pixels with label k and
/// d_k = |colour − m_k|,
///   top or bottom becomes skin   where d_face < r d_own
///   skin becomes top or bottom   where d_that < r d_face, the nearer of both
/// r = ½. A bare chest that is called a top stays one: its own colour is as near.
#pragma once

#include <cstdint>
#include <span>

#include "bodyloom/render/image.h"

namespace bodyloom {

/// `labels`: PersonLabel, one a pixel. Nothing changes without 50 pixels of a face; of clothes with fewer than 50 pixels
/// nothing is known. Throws std::invalid_argument when sizes differ.
void RelabelByColour(const Image& picture, std::span<uint8_t> labels);

}  // namespace bodyloom
