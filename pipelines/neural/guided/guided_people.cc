// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/guided/guided_people.h"

#include <filesystem>

#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/datasets/multi_person_dataset.h"
#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/pipelines/neural/guided/virtual_views.h"

namespace bodyloom {

namespace fs = std::filesystem;

GuidedPeople::GuidedPeople(const PeopleDataRequest& request)
    : request_(request), data_(request), body_(BodyOrBuiltin(request.body)) {
  if (IsSinglePersonDataset(request.data)) {
    betas_.push_back(SinglePersonDataset(request.data).track().motion.betas);
    return;
  }
  const MultiPersonDataset set = ReadMultiPersonDataset(request.data);
  for (const DatasetPerson& person : set.people) {
    if (person.test != request.test) continue;
    betas_.push_back(SinglePersonDataset((fs::path(set.path) / person.clips.front()).string()).track().motion.betas);
  }
}

std::vector<PhotoFrame> GuidedPeople::VirtualViewsOf(int person) const {
  return VirtualViews(*body_, betas_.at(person), request_.size, request_.texture_size);
}

}  // namespace bodyloom
