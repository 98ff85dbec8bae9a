// SPDX-License-Identifier: Apache-2.0
/// The page that shows a body live (live_server.h): the script of a clip's page (assets/page/viewer.js) without a clip.
#pragma once

#include <Eigen/Core>
#include <string>

#include "geometry/body/body_model.h"

namespace bodyloom {

/// One HTML file, which needs nothing but the server's /body.glb and /events.
std::string LivePageHtml(const std::string& title);

/// The body in T-pose as .glb, for the page to pose: nodes and names as in glb_writer.h, one person, "person_0".
std::string LiveBodyGlb(const BodyModel& body, const Eigen::VectorXd& betas);

}  // namespace bodyloom
