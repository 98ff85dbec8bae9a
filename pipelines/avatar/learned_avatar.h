// SPDX-License-Identifier: Apache-2.0
/// A person of Gaussians as `bodyloom train avatar` left it, with the body that it was learned on.
#pragma once

#include <memory>
#include <string>

#include "bodyloom/data_tools/avatar/avatar_file.h"
#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

struct LearnedAvatar {
  std::string run;  ///< the folder or file that it was read from, for messages
  AvatarFile file;
  std::shared_ptr<const BodyModel> body;
};

/// `run`: the folder of a run, or its avatar.npz. `body`: a file; empty: the built-in body. Throws std::runtime_error
/// naming a file that cannot be used, and for another body than the person's.
LearnedAvatar ReadLearnedAvatar(const std::string& run, const std::string& body);

}  // namespace bodyloom
