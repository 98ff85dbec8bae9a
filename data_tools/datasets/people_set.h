// SPDX-License-Identifier: Apache-2.0
/// A people set: a folder with clips of many people, what the one-photo renderers train on.
///
///   DIR/people.json   {"format": "bodyloom people set", "version": 1, "size": S,
///                      "people": [{"name": "p000", "split": "train" or "test", "clips": ["p000/a0_v0", …]}, …]}
///                     and, as information, "seed" and "command"
///   DIR/p000/a0_v0/   a person set (person_set.h): person 0 in action 0 seen by view 0; its frames need not follow
///                     each other closely
/// All clips of a person show the same body in the same clothes. people.json is written last: a folder without it is no
/// set, or an unfinished one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom {

struct SetPerson {
  std::string name;
  bool test = false;               ///< kept for testing
  std::vector<std::string> clips;  ///< folders of person sets, below the set's own
};

struct PeopleSet {
  std::string path;
  int size = 0;  ///< pixels of the pictures' sides
  std::vector<SetPerson> people;
  // Information only.
  uint64_t seed = 0;
  std::string command;
};

/// Throws std::runtime_error naming the file and place: no people.json, another format, no people, a clip whose folder
/// leads out of the set or is not there.
PeopleSet ReadPeopleSet(const std::string& path);

/// Writes people.json alone. Throws std::runtime_error "path: why".
void WritePeopleSet(const PeopleSet& set);

}  // namespace bodyloom
