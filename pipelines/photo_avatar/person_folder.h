// SPDX-License-Identifier: Apache-2.0
/// Reads and writes a person made from photos as a folder:
///   body.npz      the clothed body (data_tools/body/body_io.h); zero betas are the person
///   texture.png   for its atlas, as in even light
///   sources.png   where each texel's colour is from, in colours (PhotoPerson::sources)
///   labels.png    what each texel shows, a label's number in all channels (PersonLabel); absent: nobody knows
///   photo_0.npz   a track of one frame for each photo: the bare body in it, whose betas are the person's
///   person.json   what was seen and what was guessed (PhotoPersonReport), how the garment is cut, where there is one,
///                 and the light of the first photo (27 coefficients: red, green, blue; absent: even light)
#pragma once

#include <string>
#include <vector>

#include "render/photo_avatar/photo_person.h"

namespace bodyloom {

/// The files that WritePhotoPerson() writes for this number of photos.
std::vector<std::string> PhotoPersonFiles(const std::string& folder, int num_photos);

/// Writes the folder, replacing files of these names. Throws std::runtime_error naming a file that cannot be written.
void WritePhotoPerson(const std::string& folder, const PhotoPerson& person);

/// Reads a person. `bare_body`: the body fitted to the photos; empty: the built-in body. The report stays empty. Throws
/// std::runtime_error naming a file that cannot be used, or when the bare body is a different one.
PhotoPerson ReadPhotoPerson(const std::string& folder, const std::string& bare_body);

/// One JSON object.
std::string ToJson(const PhotoPerson& person);

}  // namespace bodyloom
