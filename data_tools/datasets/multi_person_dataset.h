// SPDX-License-Identifier: Apache-2.0
/// A multi-person dataset: a folder with clips of many people, the training data of the one-photo renderers.
///
///   DIR/people.json   {"format": "bodyloom people set", "version": 1, "size": S,
///                      "people": [{"name": "p000", "split": "train" or "test", "clips": ["p000/a0_v0", …]}, …]}
///                     and, as information, "seed" and "command"
///   DIR/p000/a0_v0/   a single-person dataset (single_person_dataset.h): person 0 in action 0 seen by view 0; its
///                     frames need not be consecutive
/// All clips of a person show the same body in the same clothes. people.json is written last: a folder without it is
/// not a dataset, or an unfinished one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

struct DatasetPerson {
  std::string name;
  bool test = false;               ///< kept for testing
  std::vector<std::string> clips;  ///< folders of single-person datasets, below the dataset's own
};

struct MultiPersonDataset {
  std::string path;
  int size = 0;  ///< side of the images, pixels
  std::vector<DatasetPerson> people;
  // Information only.
  uint64_t seed = 0;
  std::string command;
};

/// Throws std::runtime_error naming the file and place: no people.json, another format, no people, a clip whose folder
/// is outside the dataset or missing.
MultiPersonDataset ReadMultiPersonDataset(const std::string& path);

/// Action and view of a clip by its name: clips of one action show the same poses frame by frame, clips of one view
/// were taken from the same side. For "p000/a0_v1": "p000/a0" and "v1"; a clip whose name does not end in _v and a
/// number is an action and a view of its own.
struct ClipPlace {
  std::string action, view;
};
ClipPlace PlaceOfClip(const std::string& clip);

/// Writes people.json alone. Throws std::runtime_error "path: why".
void WriteMultiPersonDataset(const MultiPersonDataset& set);

// A contact sheet of a multi-person dataset: a row per person, images of evenly spread clips side by side.

/// At most `rows` people, evenly spread over the dataset. Throws as ReadMultiPersonDataset and SinglePersonDataset.
Image PeopleSheet(const std::string& dataset, int rows = 8, int columns = 8, int cell_height_px = 160);

}  // namespace bodyloom
