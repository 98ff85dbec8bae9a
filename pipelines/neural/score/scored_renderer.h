// SPDX-License-Identifier: Apache-2.0
/// Interface of renderers of people from photos that pipelines/neural/score/score_people.h measures.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pipelines/neural/person/person_renderer.h"
#include "pipelines/neural/photo/people_data.h"
#include "pipelines/neural/score/score_people.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

class ScoredRenderer {
 public:
  ScoredRenderer() = default;
  ScoredRenderer(const ScoredRenderer&) = delete;
  ScoredRenderer& operator=(const ScoredRenderer&) = delete;
  virtual ~ScoredRenderer() = default;

  [[nodiscard]] virtual const PeopleData& people() const = 0;
  /// Sets the person; `photos` are its images `frames`. Returns the share of the atlas that they cover.
  virtual double SetPhotos(int person, std::span<const int> frames, std::span<const PhotoFrame> photos) = 0;
  /// True if the photos show enough of the person; otherwise empty images are drawn.
  [[nodiscard]] virtual bool HasPerson() const { return true; }
  /// Renders a pose; `pose` is frame `frame` of that person.
  virtual RenderedPerson Render(int frame, const PhotoFrame& pose) = 0;
  /// The photos warped to a pose, 3 planes.
  [[nodiscard]] virtual std::vector<float> ShownOf(const PhotoFrame& pose) const = 0;
};

/// Factories of the renderers; throw as ScorePeople().
std::unique_ptr<ScoredRenderer> MakeScoredRun(const ScorePeopleRequest& request, PersonRendererKind kind);
std::unique_ptr<ScoredRenderer> MakeScoredPerson(const ScorePeopleRequest& request);
std::unique_ptr<ScoredRenderer> MakeScoredWarp(const ScorePeopleRequest& request);

}  // namespace bodyloom
