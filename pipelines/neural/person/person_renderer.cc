// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/person/person_renderer.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "geometry/base/parallel.h"
#include "neural/guided/guided_renderer.h"
#include "neural/photo/photo_renderer.h"
#include "neural/training/training_run.h"
#include "pipelines/neural/guided/guided_preview.h"
#include "pipelines/neural/guided/virtual_views.h"
#include "pipelines/runs/run_config.h"
#include "render/texture/complete/partial_texture.h"
#include "render/texture/planar_image.h"

namespace bodyloom {
namespace {

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

}  // namespace bodyloom
