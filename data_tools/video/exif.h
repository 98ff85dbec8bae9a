// SPDX-License-Identifier: Apache-2.0
/// What a camera noted of its lens in a photograph.
#pragma once

#include <string_view>

namespace bodyloom {

/// FocalLengthIn35mmFilm (tag 0xA405), millimetres: the focal length that has the same diagonal angle of view on film of
/// 36 mm × 24 mm. Of the TIFF structure that an Exif segment holds; 0 when it has none, says that it is not known, or is
/// damaged. Source: Exif 2.32 (CIPA DC-008), 4.6.
double ReadExifFocal35mm(std::string_view tiff);

}  // namespace bodyloom
