// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/photo/photo_preview.h"

#include "bodyloom/pipelines/people/planar_picture.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {

Image PhotoPreviewSheet(const std::vector<PhotoPreview>& previews) {
  std::vector<Image> pictures;
  ContactSheetOptions options;
  options.columns = 5;
  for (const PhotoPreview& p : previews) {
    const int S = p.picture.size, U = p.source.texture_size;
    pictures.push_back(PictureOf(p.source.image, S, S));
    pictures.push_back(PictureOf(p.partial_texture, U, U));
    pictures.push_back(PictureOf(p.completed_texture, U, U));
    pictures.push_back(PictureOf(p.target.image, S, S));
    pictures.push_back(PictureOf(p.picture.image, S, S));
    options.cell_height_px = S;
  }
  return ContactSheet(pictures, options);
}

}  // namespace bodyloom
