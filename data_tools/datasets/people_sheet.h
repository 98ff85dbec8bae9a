// SPDX-License-Identifier: Apache-2.0
/// A contact sheet of a multi-person dataset: a row a person, pictures of evenly spread clips side by side.
#pragma once

#include <string>

#include "bodyloom/render/image.h"

namespace bodyloom {

/// At most `rows` people, evenly spread over the dataset. Throws as ReadMultiPersonDataset and SinglePersonDataset.
Image PeopleSheet(const std::string& dataset, int rows = 8, int columns = 8, int cell_height_px = 160);

}  // namespace bodyloom
