// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/guided_people.h"

#include <algorithm>
#include <filesystem>

#include "apps/neural/virtual_views.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/datasets/people_set.h"
#include "bodyloom/data_tools/datasets/person_set.h"

namespace bodyloom {

namespace fs = std::filesystem;

namespace {

bool IsPersonSet(const std::string& path) { return fs::exists(fs::path(path) / "person.json"); }

}  // namespace

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

bool HasTestPeople(const PeopleDataRequest& request) {
  if (IsPersonSet(request.data)) return false;
  const PeopleSet set = ReadPeopleSet(request.data);
  return std::any_of(set.people.begin(), set.people.end(), [](const SetPerson& person) { return person.test; });
}

}  // namespace bodyloom
