// SPDX-License-Identifier: Apache-2.0
// The renderers that were trained.
#include <memory>

#include "pipelines/neural/person/person_renderer.h"
#include "pipelines/neural/score/scored_renderer.h"

namespace bodyloom {
namespace {

class ScoredRun : public ScoredRenderer {
 public:
  ScoredRun(const ScorePeopleRequest& request, PersonRendererKind kind)
      : renderer_(OpenPersonRenderer(
            {kind, request.run, request.whole_window, request.completion, request.threads, request.device})),
        people_({request.data, request.body, renderer_->size(), renderer_->texture_size(), true, request.given}),
        neighbours_(people_.source().texture_size, people_.source().texel_parts, people_.source().texel_places) {}

  [[nodiscard]] const PeopleData& people() const override { return people_; }
  double SetPhotos(int person, std::span<const int> /*frames*/, std::span<const PhotoFrame> photos) override {
    const std::vector<uint8_t>& texel_parts = people_.source().texel_parts;
    if (renderer_->maps() == nullptr) shown_ = MapsOf(photos, texel_parts);
    return renderer_->SetPerson(
        {photos, {}, texel_parts, &neighbours_, people_.body().get(), people_.BodyOf(person, 0).motion.betas});
  }
  RenderedPerson Render(int /*frame*/, const PhotoFrame& pose) override { return renderer_->Render(pose); }
  [[nodiscard]] std::vector<float> ShownOf(const PhotoFrame& pose) const override {
    return LookUp(renderer_->maps() != nullptr ? *renderer_->maps() : shown_, pose).image;
  }

 private:
  std::unique_ptr<PersonRenderer> renderer_;
  PeopleData people_;
  TexelNeighbours neighbours_;
  CoherentMaps shown_;  ///< by the photos, where the renderer keeps no maps
};

}  // namespace

std::unique_ptr<ScoredRenderer> MakeScoredRun(const ScorePeopleRequest& request, PersonRendererKind kind) {
  return std::make_unique<ScoredRun>(request, kind);
}

}  // namespace bodyloom
