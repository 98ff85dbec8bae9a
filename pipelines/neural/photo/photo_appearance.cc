// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/photo/photo_appearance.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "bodyloom/data_tools/datasets/label_of_part.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

std::vector<int> PartsNamed(const std::vector<std::string>& names) {
  const std::pair<const char*, PersonLabel> groups[] = {{"top", PersonLabel::kTop},
                                                        {"bottom", PersonLabel::kBottom},
                                                        {"shoes", PersonLabel::kShoes},
                                                        {"head", PersonLabel::kFace},
                                                        {"arms", PersonLabel::kSkin}};
  std::vector<int> parts;
  for (const std::string& name : names) {
    const size_t before = parts.size();
    for (const auto& [group, label] : groups) {
      for (int part = 1; name == group && part < kPhotoParts; ++part) {
        if (LabelOfPart(part) == label) parts.push_back(part);
      }
    }
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size() && number >= 1 && number < kPhotoParts) {
      parts.push_back(number);
    }
    if (parts.size() == before) {
      throw RequestError("--parts " + name + ": expected top, bottom, shoes, head, arms or a DensePose part, 1 to 24");
    }
  }
  return parts;
}

std::vector<uint8_t> LentTexels(const LentGarment& garment, const Photo& lender, std::span<const uint8_t> texel_parts,
                                std::string* notes) {
  const std::vector<int> parts = PartsNamed(garment.parts);
  std::vector<uint8_t> of_garment(texel_parts.begin(), texel_parts.end());
  for (uint8_t& part : of_garment) part = std::find(parts.begin(), parts.end(), int{part}) != parts.end() ? 1 : 0;
  const double share = VisibleShare(PartialTextureOf(lender.frame), of_garment);
  if (!(share > 0)) {
    throw std::runtime_error("--garment-from " + garment.from + ": nothing of --parts is to be seen there");
  }
  *notes += Concatenate(garment.from, ": shows ", std::lround(100 * share), " % of --parts\n");
  return of_garment;
}

PartialTexture AppearanceOf(std::span<const Photo> photos, const LentGarment& garment,
                            std::span<const uint8_t> texel_parts, std::string* notes) {
  std::vector<PartialTexture> textures;
  for (const Photo& photo : photos) textures.push_back(PartialTextureOf(photo.frame));
  if (garment.from.empty()) return UnionOf(textures);
  const PartialTexture lent = std::move(textures.back());
  textures.pop_back();
  LentTexels(garment, photos.back(), texel_parts, notes);
  return WithParts(UnionOf(textures), lent, texel_parts, PartsNamed(garment.parts));
}

}  // namespace bodyloom
