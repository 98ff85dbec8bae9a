// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/guided/guided_people.h"

#include <filesystem>

#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/datasets/people_set.h"
#include "bodyloom/data_tools/datasets/person_set.h"
#include "bodyloom/pipelines/neural/guided/virtual_views.h"

namespace bodyloom {

namespace fs = std::filesystem;

GuidedPeople::GuidedPeople(const PeopleDataRequest& request)
    : request_(request), data_(request), body_(BodyOrBuiltin(request.body)) {
  if (IsPersonSet(request.data)) {
    betas_.push_back(PersonSet(request.data).track().motion.betas);
    return;
  }
  const PeopleSet set = ReadPeopleSet(request.data);
  for (const SetPerson& person : set.people) {
    if (person.test != request.test) continue;
    betas_.push_back(PersonSet((fs::path(set.path) / person.clips.front()).string()).track().motion.betas);
  }
}

std::vector<PhotoFrame> GuidedPeople::VirtualViewsOf(int person) const {
  return VirtualViews(*body_, betas_.at(person), request_.size, request_.texture_size);
}

}  // namespace bodyloom
