// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_page.h"

#include <nlohmann/json.hpp>

#include "data_tools/export/export_scene.h"
#include "data_tools/export/glb_writer.h"
#include "pipelines/page/report_page.h"

extern "C" const unsigned char bodyloom_page_viewer_begin[], bodyloom_page_viewer_end[];

namespace bodyloom {
namespace {

constexpr const char* kLiveHtml = R"(<style>
main { max-width: 1280px; }
#stage { height: min(70vh, 720px); border: 1px solid #e2e8f0; border-radius: 6px; overflow: hidden; }
.controls { display: flex; flex-wrap: wrap; gap: 10px; align-items: center; margin: 10px 0; }
button { font: inherit; padding: 3px 12px; border: 1px solid #cbd5e0; border-radius: 6px; background: #fff; cursor: pointer; }
.scale { display: inline-block; width: 120px; height: 10px; border-radius: 5px; }
#place { color: #4a5568; font-size: 15px; min-height: 1.5em; font-variant-numeric: tabular-nums; }
</style>
<div id="stage"></div>
<div id="place">waiting for the first pose</div>
<div class="controls">
<button id="view-front">Front</button><button id="view-side">Side</button><button id="view-back">Back</button>
<button id="view-top">Above</button><button id="view-camera">Camera</button>
<label><input id="show-body" type="checkbox" checked> body</label>
<label hidden><input id="show-texture" type="checkbox"></label>
<label><input id="show-joints" type="checkbox"> joints, σ from 0 <span id="scale" class="scale"></span> to <span id="scale-end"></span></label>
<label><input id="show-camera" type="checkbox" checked> camera</label>
</div>
)";

}  // namespace

std::string LivePageHtml(const std::string& title) {
  ReportPage page(title, "live: the newest pose, in the world that the ground gives");
  page.AddHtml(kLiveHtml);
  const nlohmann::json clip = {
      {"live", true},
      {"fps", 30},
      {"seconds", {0}},
      {"people", {{{"name", "person_0"}, {"joints", SmplJointNames()}, {"sigma_mm", {nullptr}}}}},
      {"world_from_camera", {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};
  page.AddHtml(DataScript("clip", "application/json", clip.dump()));
  page.AddHtml(CodeScript(bodyloom_page_viewer_begin, bodyloom_page_viewer_end));
  return page.ToHtml();
}

std::string LiveBodyGlb(const BodyModel& body, const Eigen::VectorXd& betas) {
  ExportScene scene;
  ExportPerson& person = scene.people.emplace_back();
  person.name = "person_0";
  person.body = &body;
  person.betas = betas;
  person.rest_joints = body.RestJoints(betas);
  person.seconds = {0};
  BodyPose rest;
  rest.rotations.assign(size_t(body.num_joints()), Eigen::Matrix3d::Identity());
  person.poses = {rest};
  SkinSummary exactness;
  return GlbText(scene, {.correctives = 0, .ground = false}, &exactness);
}

}  // namespace bodyloom
