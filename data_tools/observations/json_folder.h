// SPDX-License-Identifier: Apache-2.0
/// Folders with one JSON file per frame, as detectors write them for each image.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data_tools/formats/json_reader.h"
#include "data_tools/observations/people.h"

namespace bodyloom {

/// Names of a folder's .json files (or of its folders), sorted, without those that begin with a dot: AppleDouble files
/// ("._a.json") and hidden ones. Throws std::runtime_error naming the folder.
std::vector<std::string> JsonFilesOf(const std::string& folder);
std::vector<std::string> FoldersOf(const std::string& folder);

/// Calls take(document) for the first whole document of these names that is neither null nor empty, if there is one.
void ReadFirstFrame(const std::string& folder, const std::vector<std::string>& names,
                    const std::function<void(const JsonNode& document)>& take);

/// Calls take(index, document) for each file of these names, in turn. A file that is empty or cut, or otherwise no
/// JSON, is passed over, as a frame without detections; `warnings`, when requested, gets a line with their number and
/// the first one's name. Throws the first one's std::runtime_error if they are more than half of the files, and for a
/// file that cannot be read or has more than 64 MiB.
void ReadJsonFrames(const std::string& folder, const std::vector<std::string>& names,
                    const std::function<void(size_t index, const JsonNode& document)>& take,
                    std::vector<std::string>* warnings = nullptr);

/// The people of one image, from its document. `convention` is null until the first person sets it.
using PeopleOfJson =
    std::function<std::vector<DetectedPerson>(const JsonNode& document, const KeypointConvention** convention)>;

/// Reads files of one image each by ReadJsonFrames(); frame numbers by NumbersOrOrder(), people by PeopleOnGrid().
PeopleSequence ReadPeopleFrames(const std::string& folder, const std::vector<std::string>& names, double fps,
                                const PeopleOfJson& people_of, std::vector<std::string>* warnings);

}  // namespace bodyloom
