// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/motion/motion_preview.h"

#include "bodyloom/pipelines/people/planar_picture.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {

Image MotionPreviewSheet(const std::vector<MotionPreview>& previews) {
  std::vector<Image> pictures;
  ContactSheetOptions options;
  for (const MotionPreview& p : previews) {
    const size_t before = pictures.size();
    pictures.push_back(PictureOf(p.true_image, p.width, p.height));
    pictures.push_back(PictureOf(p.image, p.width, p.height));
    if (!p.labels.empty()) {
      pictures.push_back(p.true_labels.empty() ? Image(p.width, p.height)
                                               : LabelsPicture(p.true_labels, p.width, p.height));
      pictures.push_back(LabelsPicture(p.labels, p.width, p.height));
    }
    if (!p.normals.empty()) {
      pictures.push_back(p.true_normals.empty() ? Image(p.width, p.height)
                                                : NormalPicture(p.true_normals, p.width, p.height));
      pictures.push_back(NormalPicture(p.normals, p.width, p.height));
    }
    options.columns = static_cast<int>(pictures.size() - before);
    options.cell_height_px = p.height;
  }
  return ContactSheet(pictures, options);
}

}  // namespace bodyloom
