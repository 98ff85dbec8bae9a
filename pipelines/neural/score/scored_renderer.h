// SPDX-License-Identifier: Apache-2.0
/// A renderer of people from photos, as pipelines/neural/score/score_people.h measures it.
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
  /// From now on this is the person: `photos` are its pictures `frames`. Returns the share of the atlas that they fill.
  virtual double SetPhotos(int person, std::span<const int> frames, std::span<const PhotoFrame> photos) = 0;
  /// Whether the photos showed enough for a person; without one, nobody is drawn.
  [[nodiscard]] virtual bool HasPerson() const { return true; }
  /// `pose` is frame `frame` of that person.
  virtual PersonPicture Render(int frame, const PhotoFrame& pose) = 0;
  /// What the photos show of a pose, 3 planes.
  [[nodiscard]] virtual std::vector<float> ShownOf(const PhotoFrame& pose) const = 0;
};

/// Throw as ScorePeople().
std::unique_ptr<ScoredRenderer> MakeScoredRun(const ScorePeopleRequest& request, PersonRendererKind kind);
std::unique_ptr<ScoredRenderer> MakeScoredPerson(const ScorePeopleRequest& request);
std::unique_ptr<ScoredRenderer> MakeScoredWarp(const ScorePeopleRequest& request);

}  // namespace bodyloom
