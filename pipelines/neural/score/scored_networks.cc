// SPDX-License-Identifier: Apache-2.0
// The renderers that were trained.
#include <string>
#include <utility>

#include "geometry/base/parallel.h"
#include "neural/guided/guided_renderer.h"
#include "neural/photo/photo_renderer.h"
#include "neural/training/training_run.h"
#include "pipelines/neural/guided/guided_people.h"
#include "pipelines/neural/score/scored_renderer.h"
#include "pipelines/runs/run_config.h"
#include "render/texture/complete/partial_texture.h"

namespace bodyloom {
namespace {

/// In windows of the profile's size.
template <typename Run>
PeopleDataRequest PeopleOf(const ScorePeopleRequest& request, const Run& run) {
  return {request.data, request.body, run.config.profile.image_size, run.config.profile.texture_size,
          true,         request.given};
}

class ScoredGuided : public ScoredRenderer {
 public:
  explicit ScoredGuided(const ScorePeopleRequest& request) : ScoredGuided(request, ReadGuidedRun(request.run)) {}

  [[nodiscard]] const PeopleData& people() const override { return people_.data(); }
  [[nodiscard]] bool DrawsLabels() const override { return true; }
  double SetPhotos(int person, std::span<const int> /*frames*/, std::span<const PhotoFrame> photos) override {
    std::vector<PhotoFrame> views;
    if (renderer_.completion() == MapCompletion::kVirtualViews) views = people_.VirtualViewsOf(person);
    renderer_.SetSource(photos, {people_.source().texel_parts, views, &neighbours_});
    return ShareSeen(renderer_.maps(), photos.size());
  }
  GuidedPicture Render(int /*frame*/, const PhotoFrame& pose) override { return renderer_.Render(pose); }
  [[nodiscard]] std::vector<float> ShownOf(const PhotoFrame& pose) const override {
    return LookUp(renderer_.maps(), pose).image;
  }

 private:
  ScoredGuided(const ScorePeopleRequest& request, const GuidedRun& run)
      : renderer_(CheckpointPath(request.run), run.config,
                  {request.anywhere ? 0 : run.reach, request.completion, ThreadsFor(request.threads), request.device}),
        people_(PeopleOf(request, run)),
        neighbours_(people_.source().texture_size, people_.source().texel_parts, people_.source().texel_places) {}

  GuidedRenderer renderer_;
  GuidedPeople people_;
  TexelNeighbours neighbours_;
};

class ScoredPhoto : public ScoredRenderer {
 public:
  explicit ScoredPhoto(const ScorePeopleRequest& request) : ScoredPhoto(request, ReadPhotoRun(request.run)) {}

  [[nodiscard]] const PeopleData& people() const override { return people_; }
  double SetPhotos(int /*person*/, std::span<const int> /*frames*/, std::span<const PhotoFrame> photos) override {
    std::vector<PartialTexture> textures;
    for (const PhotoFrame& photo : photos) textures.push_back(PartialTextureOf(photo));
    PartialTexture texture = UnionOf(textures);
    const double share = VisibleShare(texture, people_.source().texel_parts);
    shown_ = MapsOf(photos, people_.source());
    if (guesses_) GuessTexture(neighbours_, &texture);
    renderer_.Encode(texture);
    return share;
  }
  GuidedPicture Render(int /*frame*/, const PhotoFrame& pose) override {
    PhotoPicture drawn = renderer_.Render(pose);
    GuidedPicture picture = {drawn.size, std::move(drawn.image), std::move(drawn.alpha), {}};
    picture.labels = SomebodyOf(picture.alpha);
    return picture;
  }
  [[nodiscard]] std::vector<float> ShownOf(const PhotoFrame& pose) const override { return LookUp(shown_, pose).image; }

 private:
  ScoredPhoto(const ScorePeopleRequest& request, const PhotoRun& run)
      : guesses_(run.config.GuessesUnseen()),
        renderer_(CheckpointPath(request.run), run.config,
                  {request.anywhere ? -1 : run.reach, ThreadsFor(request.threads), request.device}),
        people_(PeopleOf(request, run)),
        neighbours_(people_.source().texture_size, people_.source().texel_parts, people_.source().texel_places) {}

  bool guesses_;
  PhotoRenderer renderer_;
  PeopleData people_;
  TexelNeighbours neighbours_;
  CoherentMaps shown_;
};

}  // namespace

std::unique_ptr<ScoredRenderer> MakeScoredPhoto(const ScorePeopleRequest& request) {
  return std::make_unique<ScoredPhoto>(request);
}
std::unique_ptr<ScoredRenderer> MakeScoredGuided(const ScorePeopleRequest& request) {
  return std::make_unique<ScoredGuided>(request);
}

}  // namespace bodyloom
