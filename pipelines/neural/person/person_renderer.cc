// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/person/person_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "geometry/base/parallel.h"
#include "neural/guided/guided_renderer.h"
#include "neural/photo/photo_renderer.h"
#include "neural/training/training_run.h"
#include "pipelines/neural/guided/virtual_views.h"
#include "pipelines/runs/run_config.h"
#include "render/texture/complete/partial_texture.h"
#include "render/texture/planar_image.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr std::array<Colour, 6> kViewColours = {
    {{230, 60, 60}, {60, 160, 230}, {80, 200, 90}, {240, 180, 40}, {180, 80, 220}, {60, 210, 200}}};

Image OriginImage(const CoherentMaps& maps, int num_photos) {
  Image image(maps.size, maps.size);
  for (size_t i = 0; i < maps.from.size(); ++i) {
    const int number = maps.from[i] - 1;
    if (number < 0) continue;
    const int grey = std::max(90, 230 - 45 * number);
    const Colour colour = number < num_photos ? Colour{uint8_t(grey), uint8_t(grey), uint8_t(grey)}
                                              : kViewColours[(number - num_photos) % kViewColours.size()];
    image.bgr[3 * i] = colour.blue;
    image.bgr[3 * i + 1] = colour.green;
    image.bgr[3 * i + 2] = colour.red;
  }
  return image;
}

/// Pictures for visual inspection of the pose-guided renderer.
/// Appearance, labels and sources of the texels (photos in greys, synthesised ones in colours, empty black); below, the
/// images of the virtual views, then their labels.
Image GuidedMapsSheet(const CoherentMaps& maps, std::span<const RenderedPerson> virtual_images, int num_photos) {
  std::vector<Image> images = {ImageFromPlanes(maps.appearance, maps.size, maps.size),
                               LabelsImage(maps.labels, maps.size, maps.size), OriginImage(maps, num_photos)};
  for (const RenderedPerson& p : virtual_images) images.push_back(ImageFromPlanes(p.image, p.size, p.size));
  for (const RenderedPerson& p : virtual_images) images.push_back(LabelsImage(p.labels, p.size, p.size));
  ContactSheetOptions options;
  options.columns = 3;
  options.cell_height_px = maps.size;
  return ContactSheet(images, options);
}

class OnePhotoPerson : public PersonRenderer {
 public:
  OnePhotoPerson(const PersonRendererRequest& request, const PhotoRun& run)
      : config_(run.config),
        renderer_(CheckpointPath(request.run), run.config,
                  {request.whole_window ? -1 : run.reach, ThreadsFor(request.threads), request.device}) {}

  [[nodiscard]] int size() const override { return config_.profile.image_size; }
  [[nodiscard]] int texture_size() const override { return config_.profile.texture_size; }

  double SetPerson(const SourcePerson& person) override {
    std::vector<PartialTexture> textures;
    for (const PhotoFrame& photo : person.photos) textures.push_back(PartialTextureOf(photo));
    PartialTexture texture;
    if (person.lent_parts.empty()) {
      texture = UnionOf(textures);
    } else {
      const PartialTexture lent = std::move(textures.back());
      textures.pop_back();
      texture = WithParts(UnionOf(textures), lent, person.texel_parts, person.lent_parts);
    }
    const double share = VisibleShare(texture, person.texel_parts);
    seen_ = texture.colour;
    if (config_.GuessesUnseen()) GuessTexture(*person.neighbours, &texture);
    renderer_.Encode(texture);
    return share;
  }
  RenderedPerson Render(const PhotoFrame& pose) override { return renderer_.Render(pose); }

  [[nodiscard]] Image SurfaceImage() const override { return TextureImage(renderer_.CompletedTexture()); }
  [[nodiscard]] std::vector<Image> SheetBegin(const PhotoFrame& photo) const override {
    return {ImageFromPlanes(photo.image, size(), size()), TextureImage(seen_), SurfaceImage()};
  }
  [[nodiscard]] int sheet_columns() const override { return 3; }
  [[nodiscard]] std::vector<Image> SheetRow(const PhotoFrame& /*photo*/, const PhotoFrame& /*frame*/,
                                            const RenderedPerson& /*rendered*/, const Image& composed) const override {
    return {composed};
  }
  [[nodiscard]] Stages stages() const override { return {"prepare", "encode the photo", "render"}; }
  [[nodiscard]] nlohmann::ordered_json Report() const override { return {{"variant", ToText(config_.variant)}}; }

 private:
  [[nodiscard]] Image TextureImage(std::span<const float> colours) const {
    return ImageFromPlanes(colours, texture_size(), texture_size());
  }

  PhotoConfig config_;
  PhotoRenderer renderer_;
  std::vector<float> seen_;  ///< what the photos show of the texture
};

class GuidedPerson : public PersonRenderer {
 public:
  GuidedPerson(const PersonRendererRequest& request, const GuidedRun& run)
      : config_(run.config),
        renderer_(
            CheckpointPath(request.run), run.config,
            {request.whole_window ? 0 : run.reach, request.completion, ThreadsFor(request.threads), request.device}) {}

  [[nodiscard]] int size() const override { return config_.profile.image_size; }
  [[nodiscard]] int texture_size() const override { return config_.profile.texture_size; }

  double SetPerson(const SourcePerson& person) override {
    std::vector<PhotoFrame> views;
    if (renderer_.completion() == MapCompletion::kVirtualViews) {
      views = VirtualViews(*person.body, person.betas, size(), texture_size());
    }
    std::vector<uint8_t> lent;
    if (!person.lent_parts.empty()) lent = TexelsOf(person.lent_parts, person.texel_parts);
    renderer_.SetSource(person.photos, {person.texel_parts, views, person.neighbours, lent});
    num_photos_ = person.photos.size();
    return ShareFilled(renderer_.maps(), num_photos_);
  }
  RenderedPerson Render(const PhotoFrame& pose) override { return renderer_.Render(pose); }

  [[nodiscard]] const CoherentMaps* maps() const override { return &renderer_.maps(); }
  [[nodiscard]] Image SurfaceImage() const override {
    return GuidedMapsSheet(renderer_.maps(), renderer_.virtual_images(), static_cast<int>(num_photos_));
  }
  [[nodiscard]] std::vector<Image> SheetBegin(const PhotoFrame& /*photo*/) const override { return {}; }
  [[nodiscard]] int sheet_columns() const override { return 5; }
  [[nodiscard]] std::vector<Image> SheetRow(const PhotoFrame& photo, const PhotoFrame& frame,
                                            const RenderedPerson& rendered, const Image& composed) const override {
    const int S = size();
    return {ImageFromPlanes(photo.image, S, S), ImageFromPlanes(LookUp(renderer_.maps(), frame).image, S, S),
            LabelsImage(rendered.labels, S, S), ImageFromPlanes(rendered.image, S, S),
            frame.image.empty() ? composed : ImageFromPlanes(frame.image, S, S)};
  }
  [[nodiscard]] Stages stages() const override { return {"read", "source", "frames"}; }
  [[nodiscard]] nlohmann::ordered_json Report() const override {
    return {{"completion", ToText(renderer_.completion())}};
  }
  [[nodiscard]] int64_t frames_kept() const override { return renderer_.frames_kept(); }
  [[nodiscard]] std::optional<double> computed_share() const override { return renderer_.computed_share(); }

 private:
  GuidedConfig config_;
  GuidedRenderer renderer_;
  size_t num_photos_ = 0;
};

}  // namespace

std::unique_ptr<PersonRenderer> OpenPersonRenderer(const PersonRendererRequest& request) {
  if (request.kind == PersonRendererKind::kGuided) {
    return std::make_unique<GuidedPerson>(request, ReadGuidedRun(request.run));
  }
  return std::make_unique<OnePhotoPerson>(request, ReadPhotoRun(request.run));
}

std::vector<uint8_t> TexelsOf(std::span<const int> parts, std::span<const uint8_t> texel_parts) {
  std::vector<uint8_t> texels(texel_parts.begin(), texel_parts.end());
  for (uint8_t& part : texels) part = std::find(parts.begin(), parts.end(), int{part}) != parts.end() ? 1 : 0;
  return texels;
}

nlohmann::ordered_json ToJson(const PersonScores& s) {
  nlohmann::ordered_json json = {
      {"frames", s.frames}, {"image_l1", s.image_l1}, {"psnr_db", s.psnr_db}, {"silhouette_iou", s.silhouette_iou}};
  if (!std::isnan(s.label_iou)) json["label_iou"] = s.label_iou;
  json[LpipsName("lpips", s.lpips_random_features)] = s.lpips;
  json[LpipsName("lpips_deviation", s.lpips_random_features)] = s.lpips_deviation;
  if (!std::isnan(s.contextual)) {
    json[s.contextual_random_features ? "contextual_quarter_random_features" : "contextual_vgg19"] = s.contextual;
  }
  json[LpipsName("lpips_of_people", s.lpips_random_features)] = s.lpips_of_people;
  return json;
}

}  // namespace bodyloom
