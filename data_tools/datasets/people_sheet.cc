// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/datasets/people_sheet.h"

#include <filesystem>
#include <vector>

#include "bodyloom/data_tools/datasets/multi_person_dataset.h"
#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {

Image PeopleSheet(const std::string& dataset, int rows, int columns, int cell_height_px) {
  const MultiPersonDataset set = ReadMultiPersonDataset(dataset);
  std::vector<Image> cells;
  for (const int p : EvenlySpreadFrames(static_cast<int>(set.people.size()), rows)) {
    const std::vector<std::string>& clips = set.people[p].clips;
    for (int column = 0; column < columns; ++column) {
      // Clips in turn, and through each of them from its first picture to its last.
      const SinglePersonDataset clip((std::filesystem::path(set.path) / clips[column % clips.size()]).string());
      const int round = column / static_cast<int>(clips.size());
      const int rounds = (columns + static_cast<int>(clips.size()) - 1) / static_cast<int>(clips.size());
      cells.push_back(clip.Read(round * clip.info().num_frames / rounds, {false, false, false, false}).rgb);
    }
  }
  return ContactSheet(cells, {.columns = columns, .cell_height_px = cell_height_px, .gap_px = 3});
}

}  // namespace bodyloom
