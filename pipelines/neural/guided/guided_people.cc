// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/guided/guided_people.h"

#include <filesystem>
#include <string>

#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/datasets/multi_person_dataset.h"
#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/pipelines/neural/guided/virtual_views.h"

namespace bodyloom {

namespace fs = std::filesystem;

namespace {

/// `track`: as GivenOfPeople has it.
Eigen::VectorXd BetasOf(const std::string& clip, const std::string& track) {
  return track.empty() ? SinglePersonDataset(clip).track().motion.betas
                       : ReadTrack((fs::path(clip) / track).string()).motion.betas;
}

}  // namespace

GuidedPeople::GuidedPeople(const PeopleDataRequest& request)
    : request_(request), data_(request), body_(BodyOrBuiltin(request.body)) {
  if (IsSinglePersonDataset(request.data)) {
    betas_.push_back(BetasOf(request.data, request.given.track));
    return;
  }
  const MultiPersonDataset set = ReadMultiPersonDataset(request.data);
  for (const DatasetPerson& person : set.people) {
    if (person.test != request.test) continue;
    betas_.push_back(BetasOf((fs::path(set.path) / person.clips.front()).string(), request.given.track));
  }
}

std::vector<PhotoFrame> GuidedPeople::VirtualViewsOf(int person) const {
  return VirtualViews(*body_, betas_.at(person), request_.size, request_.texture_size);
}

}  // namespace bodyloom
